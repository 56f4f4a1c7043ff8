"""The material of a dolfinx problem: one RVE for each quadrature point."""
from __future__ import annotations

from typing import Any, Callable

import numpy as np
import ufl
from dolfinx import fem

from . import compat, tensors
from .family import Sources, chosen_sources, members
from .nonlocal_average import Average
from .points import Points
from .ranks import together


class Material:
    """Stress and tangent of the quadrature points of a mesh, plane strain (discs, ellipses) or 3D.

    specimens    a specimen file for all points; a list, from which each draws one; {tag: one of both} by cell_tags
    strains      "finite": updated Lagrangian; the increment dH = F_new F_old^-1 - 1 with its rotation goes to the RVEs,
                 stress and tangent are the Cauchy stress and that of the present state, with the geometric stiffness.
                 The integrals are written on the first mesh, which gives the same forces. "small": dH is the symmetric
                 gradient
    degree       of the displacement: 1, or 2 (8 nodes in a quadrilateral, 20 in a hexahedron)
    tolerance    of the host's forces and of the RVEs' stresses, over the pressure (Solver)
    share        points that saw elastic strain alone share one RVE, as long as its tangent errs by less than this share
                 of the pressure; True: the tolerance; 0: each point has its own from the beginning
    initial      function of x (n, 3): stresses (n, d, d) Pa, tension positive, that the specimens are brought to; none:
                 theirs. For soil under its weight: geostatic()
    length       m; 0: none. Stiffness `stiffening` (of the elastic one) of the strain beside its average over this
                 length, which gives bands a width (nonlocal_average.py)
    balance      RVEs move between ranks by their measured cost"""

    def __init__(self, mesh: Any, specimens: Sources, *, cell_tags: Any = None, strains: str = "finite", degree: int = 1,
                 quadrature_degree: int = 2, tolerance: float = 1e-3, share: float | bool = True,
                 initial: Callable[[np.ndarray], np.ndarray] | None = None, length: float = 0,
                 stiffening: float = 0.1, balance: bool = True,
                 tolerance_rel: float = 0.1, workers: int = 1) -> None:
        if strains not in ("finite", "small"):
            raise ValueError(f'strains is {strains!r}; allowed: "finite", "small"')
        if not 1e-6 <= tolerance <= 0.1:
            raise ValueError(f"tolerance is {tolerance:g}; allowed: 1e-6 to 0.1, over the pressure")
        if not 0 <= share <= 0.1 and share is not True:
            raise ValueError(f"share is {share:g}; allowed: 0 (off) to 0.1, over the pressure, or True: the tolerance")
        self.mesh, self.d, self.finite, self.tolerance = mesh, mesh.geometry.dim, strains == "finite", tolerance
        d = self.d
        self.degree, self.quadrature_degree = degree, quadrature_degree
        self.space = compat.lagrange(mesh, degree, (d,))
        self.u, self.du = fem.Function(self.space, name="displacement"), fem.Function(self.space)
        self.stress = fem.Function(compat.quadrature_space(mesh, quadrature_degree, (d, d)))
        self.tangent = fem.Function(compat.quadrature_space(mesh, quadrature_degree, (d * d, d * d)))
        self.dx = ufl.Measure("dx", domain=mesh, metadata={"quadrature_degree": quadrature_degree,
                                                           "quadrature_scheme": "default"})
        reference, self.weights = compat.quadrature(mesh, quadrature_degree)
        topology = mesh.topology
        count = topology.index_map(topology.dim).size_local
        self.cells, nq = np.arange(count, dtype=np.int32), len(reference)
        self._dofs = compat.cell_dofs(self.stress.function_space, count).ravel()
        self._tangent_dofs = compat.cell_dofs(self.tangent.function_space, count).ravel()
        self._gradients = [fem.Expression(ufl.grad(each), reference) for each in (self.u, self.du)]
        self.numbers = (np.asarray(topology.original_cell_index)[:count, None] * nq + np.arange(nq)).ravel()
        corners = compat.cell_corners(mesh, count)
        self.x = np.zeros((count * nq, 3))
        for k in range(count):
            self.x[k * nq:(k + 1) * nq, :d] = compat.push_forward(mesh, reference, corners[k])
        options = dict(workers=workers, tolerance_rel=tolerance_rel, tolerance_abs=tolerance)
        sigma = None if initial is None else np.asarray(initial(self.x), float)
        tags = None
        if cell_tags is not None:
            of_cells = np.zeros(count, np.int64)
            owned = cell_tags.indices < count
            of_cells[cell_tags.indices[owned]] = cell_tags.values[owned]
            tags = np.repeat(of_cells, nq)
        sources = together(mesh.comm, lambda: chosen_sources(specimens, tags, self.numbers))
        group, family, sigma = members(mesh.comm, sources, sigma, d, options)
        share = tolerance if share is True else float(share)
        self.points = Points(mesh.comm, d, group, family, options, share, False, sigma)
        self.renewed = False  # whether the tangents changed since the stiffness was assembled
        self.stiffening, self.C = stiffening, None
        self.average = Average(mesh, reference, self.dx, quadrature_degree, length) if length > 0 else None
        n = len(self.numbers)
        self.F = np.tile(np.eye(d), (n, 1, 1))  # from the first mesh to the committed state
        self.sigma, self.error = np.zeros((n, d, d)), np.zeros(n)  # of the last trial
        self.beside = self._new_beside = np.zeros((n, d, d))  # sum of the increments of strain less their averages
        self._new, self._kept = self.F, None
        draws = [np.random.Generator(np.random.PCG64(int(k))).standard_normal((d, d)) for k in self.numbers]
        drawn = tensors.symmetric(np.reshape(draws, (-1, d, d)))
        self._directions = drawn / np.linalg.norm(drawn, axis=(1, 2))[:, None, None]
        if self.update() < 1:
            raise ValueError("an RVE refuses its initial state: the stresses of `initial` are beyond its strength, or "
                             "the specimen is not at rest")
        self.commit()  # without moves: RVEs begin where their points are, on any number of ranks
        self.points.balances = balance and mesh.comm.size > 1

    def gradient(self, k: int) -> np.ndarray:
        """(n, d, d) of the committed displacement (0) or of its increment (1)."""
        return compat.evaluate(self._gradients[k], self.mesh, self.cells).reshape(-1, self.d, self.d)

    def update(self, tangent: bool = True) -> float:
        """Collective. Trials with the increment du, and their stresses, and if asked for their tangents, in the forms. 1;
        less: an RVE refused, and this is the share of the increment to try."""
        d, increment = self.d, self.gradient(1)
        if self.finite:
            self._new = np.eye(d) + self.gradient(0) + increment
            dH = self._new @ np.linalg.inv(self.F) - np.eye(d)
        else:
            dH = tensors.symmetric(increment)
        found = self.points.trial(dH, tangent)
        if found.scale < 1:
            return found.scale
        self.sigma, self.error = found.sigma, found.error
        stress, stiffness = found.sigma, found.stiffness
        if self.average is not None:
            stress, stiffness = self._with_average(dH, stress, stiffness)
        if self.finite:
            stress, stiffness = tensors.nominal(stress, tensors.current_tangent(stiffness, stress), self._new)
        self.set_values(stress, stiffness if tangent else None)
        return 1.0

    def _with_average(self, dH: np.ndarray, stress: np.ndarray, tangent: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        strain = tensors.symmetric(dH)
        spin = dH - strain
        self._new_beside = self.beside + spin @ self.beside - self.beside @ spin + strain - self.average(strain)
        self.C = tangent.copy() if self.C is None else self.C
        more = self.stiffening * self.C
        return stress + np.einsum("nijkl,nkl->nij", more, self._new_beside), tangent + more

    def commit(self) -> None:
        """Collective. The last trial becomes the state, and u + du the displacement."""
        self.points.commit()
        self.F, self.beside = self._new, self._new_beside
        self.u.x.array[:] += self.du.x.array
        self.du.x.array[:] = 0
        self.keep()

    def values(self) -> tuple[np.ndarray, np.ndarray]:
        """Stress (n, d, d) and tangent (n, d, d, d, d) of the forms."""
        d = self.d
        return (self.stress.x.array.reshape(-1, d, d)[self._dofs],
                self.tangent.x.array.reshape(-1, d, d, d, d)[self._tangent_dofs])

    def keep(self) -> None:
        """The present stress and tangent are those that revert() returns to."""
        self._kept = self.sigma, self.error, self.stress.x.array.copy(), self.tangent.x.array.copy()

    def revert(self) -> None:
        """Stress and tangent of the committed state again."""
        self.points.revert()
        self.du.x.array[:], self.renewed = 0, True
        self.sigma, self.error, self.stress.x.array[:], self.tangent.x.array[:] = self._kept

    def set_values(self, stress: np.ndarray, tangent: np.ndarray | None = None) -> None:
        d = self.d
        self.stress.x.array.reshape(-1, d * d)[self._dofs] = stress.reshape(-1, d * d)
        if tangent is not None:
            self.renewed = True
            self.tangent.x.array.reshape(-1, d ** 4)[self._tangent_dofs] = tangent.reshape(-1, d ** 4)

    def with_errors(self, assemble: Callable[[], Any]) -> Any:
        """What `assemble` returns if each stress is its expected error, half of its estimate, in a direction drawn by
        the number of the point: the forces that the RVEs cannot resolve."""
        held = self.stress.x.array.copy()
        self.set_values(0.5 * self.error[:, None, None] * self._directions)
        found = assemble()
        self.stress.x.array[:] = held
        return found


def geostatic(surface: float, unit_weight: float, at_rest: float, pressure: float,
              d: int = 2) -> Callable[[np.ndarray], np.ndarray]:
    """Stresses of level ground: vertical -(pressure + unit_weight depth), horizontal at_rest times that. surface:
    height of the ground, m; unit_weight: N/m^3; pressure on the ground: Pa, more than zero, since grains without stress
    have no stiffness."""
    if not pressure > 0:
        raise ValueError(f"pressure on the ground is {pressure:g} Pa; allowed: more than 0 (grains without stress have "
                         "no stiffness)")

    def sigma(x: np.ndarray) -> np.ndarray:
        vertical = -(pressure + unit_weight * (surface - x[:, d - 1]))
        found = at_rest * vertical[:, None, None] * np.eye(d)
        found[:, d - 1, d - 1] = vertical
        return found
    return sigma
