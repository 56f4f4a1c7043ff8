"""Forces and stiffness of a Material as forms of dolfinx, their constraints, and the linear solver (MUMPS)."""
from __future__ import annotations

from typing import Any, Callable, Sequence

import dolfinx.fem.petsc
import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from petsc4py import PETSc

from . import compat

Where = Callable[[np.ndarray], np.ndarray]


class Forms:
    """Nodal forces: internal ones of the stresses plus those of pressures minus those of weight, compiled at the first
    use. Norms are Euclidean, over the degrees of freedom that are not fixed."""

    def __init__(self, material: Any) -> None:
        self.material, self.mesh, self.space = material, material.mesh, material.space
        self.owned, self.blocks = compat.owned(self.space), self.space.dofmap.index_map_bs
        self.total = self.owned + self.space.dofmap.index_map.num_ghosts * self.blocks
        # (degrees of freedom of this rank with ghosts, value, factor of each)
        self._fixed: list[tuple[np.ndarray, Any, np.ndarray | float]] = []
        self._pressures: list[tuple[np.ndarray, Any, Any]] = []  # (facets, value, constant)
        self._body, self._weight = None, None
        self._ready, self._factored, self.t = False, False, 0.0

    def fix(self, where: Where, component: int, value: Any, at: str, profile: Any) -> None:
        if component not in range(self.material.d):
            raise ValueError(f"component is {component}; allowed: 0 to {self.material.d - 1}")
        nodes, factor = self._located(where, at), 1.0
        if profile is not None:
            factor = np.asarray(profile(self._nodes()[nodes].T), float)
        self._fixed.append((nodes * self.blocks + component, value, factor))

    def pressure(self, where: Where, value: Any) -> None:
        facets = compat.locate(self.mesh, self.material.d - 1, where)
        self._expect(len(facets), "facets")
        self._pressures.append((facets, value, fem.Constant(self.mesh, PETSc.ScalarType(0))))
        self._ready = False

    def body_force(self, value: Any) -> None:
        self._body, self._weight = value, fem.Constant(self.mesh, np.zeros(self.material.d, PETSc.ScalarType))
        self._ready = False

    def _located(self, where: Where, at: str) -> np.ndarray:
        if at not in ("facets", "points"):
            raise ValueError(f'at is {at!r}; allowed: "facets", "points"')
        dimension = self.material.d - 1 if at == "facets" else 0
        entities = compat.locate(self.mesh, dimension, where)
        self._expect(len(entities), at)
        self.mesh.topology.create_connectivity(dimension, self.mesh.topology.dim)
        return fem.locate_dofs_topological(self.space, dimension, entities)

    def _nodes(self) -> np.ndarray:
        """(n, 3) m of the nodes of this rank."""
        try:
            return self.space.tabulate_dof_coordinates()
        except RuntimeError:
            raise ValueError("profile and along need nodes with a place, which quadrilaterals and hexahedra of degree 2 "
                             "lack (their middles are means of edges): take degree 1, or triangles") from None

    def _expect(self, found: int, what: str) -> None:
        if self.mesh.comm.allreduce(found) == 0:
            raise ValueError(f"`where` is true on no {what} of the boundary; a facet needs it at all its nodes and its "
                             "middle (compare coordinates by numpy.isclose)")

    def shortest_edge(self) -> float:
        """m, the least distance between two corners of a cell of the mesh. Collective."""
        corners = compat.cell_corners(self.mesh, len(self.material.cells))
        apart = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=3)
        return self.mesh.comm.allreduce(float(np.min(apart[apart > 0], initial=np.inf)), MPI.MIN)

    def set_time(self, t: float) -> None:
        self.t = t
        self._compile()
        for _, value, constant in self._pressures:
            constant.value = _at(value, t)
        if self._weight is not None:
            self._weight.value[:] = _at(self._body, t)

    def targets(self) -> np.ndarray:
        """Increments of the fixed degrees of freedom from the committed state to the present time, in the order of
        `fixed`."""
        found = np.zeros(self.total)
        for dofs, value, factor in self._fixed:
            found[dofs] = factor * _at(value, self.t) - self.material.u.x.array[dofs]
        return found[self.fixed]

    def set_fixed(self, array: np.ndarray, increments: np.ndarray) -> None:
        array[self.fixed] = increments

    def _compile(self) -> None:
        mask = np.zeros(self.total, bool)
        for dofs, _, _ in self._fixed:
            mask[dofs] = True
        self.fixed = np.flatnonzero(mask)
        self.free = np.flatnonzero(~mask[:self.owned])
        if self._ready:
            return
        material, d = self.material, self.material.d
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        row = lambda function: ufl.as_vector([function[i].dx(j) for i in range(d) for j in range(d)])  # noqa: E731
        internal = ufl.inner(material.stress, ufl.grad(test)) * material.dx
        stiffness = ufl.inner(ufl.dot(material.tangent, row(trial)), row(test)) * material.dx
        external = None
        if self._weight is not None:
            external = -ufl.dot(self._weight, test) * material.dx
        if self._pressures:
            tags = compat.facet_tags(self.mesh, [each[0] for each in self._pressures])
            normal, measure = ufl.FacetNormal(self.mesh), ufl.Measure("ds", domain=self.mesh, subdomain_data=tags)
            for tag, (_, _, constant) in enumerate(self._pressures, 1):
                area = normal
                if material.finite:
                    F = ufl.Identity(d) + ufl.grad(material.u) + ufl.grad(material.du)
                    area = ufl.det(F) * ufl.dot(ufl.inv(F).T, normal)
                load = constant * ufl.dot(area, test) * measure(tag)
                external = load if external is None else external + load
                if material.finite:
                    stiffness += ufl.derivative(load, material.du, trial)
        self.internal, self.stiffness = fem.form(internal), fem.form(stiffness)
        self.external = None if external is None else fem.form(external)
        self.vector = compat.vector(self.space)
        self.matrix = dolfinx.fem.petsc.create_matrix(self.stiffness)
        self.solver = PETSc.KSP().create(self.mesh.comm)
        self.solver.setType("preonly")
        self.solver.getPC().setType("lu")
        self.solver.getPC().setFactorSolverType("mumps")
        self.solution, self.right = self.matrix.createVecs()
        self._ready, self._factored = True, False

    def forces(self) -> tuple[np.ndarray, np.ndarray]:
        """Internal and external nodal forces of this rank's degrees of freedom, N."""
        inside = compat.assemble_into(self.vector, self.internal)[:self.owned].copy()
        outside = np.zeros_like(inside)
        if self.external is not None:
            outside = compat.assemble_into(self.vector, self.external)[:self.owned].copy()
        return inside, outside

    def residual(self) -> tuple[float, float]:
        """Norms of the out-of-balance forces, and of the forces that hold the body: loads and reactions."""
        inside, outside = self.forces()
        self.out_of_balance = inside + outside
        fixed = self.fixed[self.fixed < self.owned]
        return (self._norm(self.out_of_balance[self.free]),
                np.hypot(self._norm(outside), self._norm(self.out_of_balance[fixed])))

    def internal_norm(self) -> float:
        return self._norm(compat.assemble_into(self.vector, self.internal)[:self.owned][self.free])

    def _norm(self, values: np.ndarray) -> float:
        return float(np.sqrt(self.mesh.comm.allreduce(float(values @ values), MPI.SUM)))

    def solve(self, residual: np.ndarray, target: np.ndarray) -> np.ndarray:
        """-K^-1 residual with the tangents that were last asked for, where fixed degrees of freedom move by `target`, which
        is 0 if K is still that of the solution before; with ghosts."""
        fixed = self.fixed < self.owned
        blocks = self.space.dofmap.index_map.local_to_global((self.fixed[fixed] // self.blocks).astype(np.int32))
        rows = np.asarray(blocks) * self.blocks + self.fixed[fixed] % self.blocks
        self.solution.array[:], self.right.array[:] = 0, -residual
        self.solution.array[self.fixed[fixed]] = target[fixed]
        if self.material.renewed or not self._factored:
            self.matrix.zeroEntries()
            dolfinx.fem.petsc.assemble_matrix(self.matrix, self.stiffness)
            self.matrix.assemble()
            self.matrix.zeroRowsColumns(rows.astype(PETSc.IntType), diag=1.0, x=self.solution, b=self.right)
            self.solver.setOperators(self.matrix)
            self.material.renewed, self._factored = False, True
        else:
            self.right.array[self.fixed[fixed]] = 0
        self.solver.solve(self.right, self.solution)
        if self.solver.getConvergedReason() < 0:
            raise RuntimeError("the stiffness has no inverse: a part of the body is not held by its constraints")
        step = dolfinx.fem.Function(self.space)
        step.x.array[:self.owned] = self.solution.array
        step.x.scatter_forward()
        return step.x.array.copy()

    def reaction(self, where: Where, at: str, along: Any) -> np.ndarray | float:
        self.set_time(self.t)
        nodes = self._located(where, at)
        nodes = nodes[nodes * self.blocks < self.owned]
        force = sum(self.forces()).reshape(-1, self.blocks)[nodes]
        if along is not None:
            return self.mesh.comm.allreduce(float(np.sum(force.T * along(self._nodes()[nodes].T))))
        return np.array([self.mesh.comm.allreduce(float(each), MPI.SUM) for each in force.sum(axis=0)])


def _at(value: float | Sequence[float] | Callable[[float], Any], t: float) -> Any:
    return value(t) if callable(value) else value
