"""Newton's method with the tangent of the contact networks, line search, and increments that grow and shrink."""
from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, Callable, Iterator, Sequence

import numpy as np
from mpi4py import MPI

from .forms import Forms
from .material import Material
from .secants import Secants

MOST_ITERATIONS, MOST_CUTS = 15, 2
# Tangents of RVEs cost more than their increments. They are asked for in the first trial of an increment, and again after
# an iteration that left more than this share of the out-of-balance forces; between them secants mend the stiffness.
SLOW = 0.5
GROW_BELOW, GROWTH = 5, 1.5  # an increment of at most so many iterations lets the next one be larger
# Iterations that the RVEs cannot resolve end by their estimates, but not above so many tolerances: one RVE that collapses
# has an estimate beyond all bounds.
COARSEST = 5
# Displacements are whole multiples of FINEST tolerances times the shortest edge of the mesh (a power of two, m). Strains
# are then off by as much, stresses by that times the stiffness: a hundredth of the tolerance where it is a thousand
# pressures. Of a body that is stiffer than STIFFEST pressures they are finer by as much. The round-off of linear solvers,
# which differs with the number of ranks, is far below, so that RVEs get the same bits on one rank and on more, but where a
# value lies within the round-off of the edge between two multiples. Without it grains magnify the round-off to another path.
FINEST, STIFFEST = 2.0 ** -17, 2.0 ** 14


@dataclass
class Increment:
    """One increment: what it took, and where its iterations stopped."""
    t: float                #: load parameter at its end
    dt: float
    iterations: int         #: solutions of the linear system
    trials: int             #: of each point: iterations, line search, the predictor
    residual: float         #: out-of-balance forces over the forces, Euclidean norms
    resolution: float       #: what the RVEs' error estimates can resolve of it
    resolved: bool          #: stopped by the resolution, above the tolerance
    residuals: list[float]  #: of all accepted iterations
    refused: int            #: larger increments tried before it
    seconds: float = 0.0


class NotConverged(RuntimeError):
    """The smallest increment did not converge; the state is that of the increment before it."""


class Solver:
    """Equilibrium of a Material under loads, all functions of a load parameter t, or constant:

    fix(where, component, value)    displacement m of a component on a part of the boundary: where maps x (3, n) to a mask;
                                    times profile(x) (n), if there is one; what it is at the beginning comes with the first
                                    increment, whole
    pressure(where, value)          Pa on a part of the boundary; at finite strains it follows the boundary
    body_force(value)               N/m^3 of the first mesh, a vector, such as (0, -17e3)

    for step in solver.march(end, first): reaction(where) and material.u are those at step.t."""

    def __init__(self, material: Material, tolerance: float | None = None) -> None:
        self.material, self.tolerance = material, material.tolerance if tolerance is None else tolerance
        if not self.tolerance > 0:
            raise ValueError(f"tolerance is {self.tolerance:g}; allowed are numbers above 0")
        self.forms = Forms(material)
        self.t, self.dt, self.history = 0.0, 0.0, []
        self._last, self._last_dt = None, 0.0  # displacement of the increment before, for the predictor
        self._edge = self.forms.shortest_edge() / max(1, self._stiffness() / STIFFEST)

    def _stiffness(self) -> float:
        """Largest stiffness of the first state over its largest stress. Collective."""
        stress, tangent = (self.material.mesh.comm.allreduce(float(np.max(np.abs(each), initial=0)), MPI.MAX)
                           for each in self.material.values())
        return tangent / stress if stress > 0 else 0.0

    def fix(self, where: Callable[[np.ndarray], np.ndarray], component: int, value: float | Callable[[float], float] = 0.0,
            at: str = "facets", profile: Callable[[np.ndarray], np.ndarray] | None = None) -> None:
        self.forms.fix(where, component, value, at, profile)

    def pressure(self, where: Callable[[np.ndarray], np.ndarray], value: float | Callable[[float], float]) -> None:
        self.forms.pressure(where, value)

    def body_force(self, value: Sequence[float] | Callable[[float], Sequence[float]]) -> None:
        self.forms.body_force(value)

    def reaction(self, where: Callable[[np.ndarray], np.ndarray], at: str = "facets",
                 along: Callable[[np.ndarray], np.ndarray] | None = None) -> np.ndarray | float:
        """(d) N, or N/m in the plane: force that the constraints exert on the soil there. along: function of x (3, n), to
        directions (d, n) of the nodes: the sum of the forces along them, a number. Collective."""
        return self.forms.reaction(where, at, along)

    def march(self, end: float, first: float, least: float | None = None,
              most: float | None = None) -> Iterator[Increment]:
        """Increments of t up to `end`, beginning with `first`. An increment that an RVE refuses, or that does not converge,
        is halved, or cut as the RVE says, down to `least` (first/64); easy ones let the next grow up to `most` (first)."""
        least, most = first / 64 if least is None else least, first if most is None else most
        dt = min(self.dt or first, most)
        self.forms.set_time(self.t)  # compiles the forms, outside of the seconds of an increment
        while self.t < end * (1 - 1e-12):
            refused, begun = 0, time.perf_counter()
            while True:
                tried = min(dt, end - self.t)
                done, share = self._increment(tried)
                if done:
                    break
                refused, dt = refused + 1, tried * share
                if dt < least:
                    raise NotConverged(f"at t = {self.t:.6g} no increment of {least:.3g} or more converges: the body "
                                       "fails under its loads (prescribe displacements to go on), or the tolerance is "
                                       "below what its RVEs resolve")
            done.refused, done.seconds = refused, time.perf_counter() - begun
            if done.iterations <= GROW_BELOW and not refused:
                dt = min(dt * GROWTH, most)
            self.dt = dt
            self.history.append(done)
            yield done

    def _increment(self, dt: float) -> tuple[Increment | None, float]:
        """The increment, with its trials committed; or none, and the share of dt to try."""
        material, forms, start = self.material, self.forms, self.t
        forms.set_time(start + dt)
        target = self._targets = forms.targets()  # increments of the fixed degrees of freedom
        self._grid = 2.0 ** np.floor(np.log2(FINEST * self.tolerance * self._edge))
        array = material.du.x.array
        trials, iterations, residuals, tangent = 0, 0, [], SLOW == 0
        secants = Secants(material.mesh.comm, forms.free)
        if self._last is not None:
            array[:] = self._rounded(self._last * (dt / self._last_dt))
            trials, share = 1, material.update()
            if share < 1:
                return self._refuse(share)
            target = 0 * target
        norm, reference = forms.residual()
        predicted = self._last is not None  # else the tangent of the state before is the predictor
        while True:
            if predicted:
                residuals.append(norm / reference)
                resolution = material.with_errors(forms.internal_norm) / reference
                if norm <= reference * max(self.tolerance, min(resolution, COARSEST * self.tolerance)):
                    break
                if iterations == MOST_ITERATIONS:
                    return self._refuse(0.5)
            move, rest = secants.reduce(forms.out_of_balance)
            step = forms.solve(rest, target) + move
            begin, before, old = array.copy(), forms.out_of_balance, norm
            norm, made, share = self._search(step, norm if predicted else np.inf, tangent or not predicted)
            if share < 1:
                return self._refuse(share)
            tangent = norm > SLOW * old
            if predicted:
                secants.add(array - begin, forms.out_of_balance - before)
            iterations, trials, target, predicted = iterations + 1, trials + made, 0 * target, True
        self._last, self._last_dt = array.copy(), dt
        material.commit()
        self.t = start + dt
        return Increment(self.t, dt, iterations, trials, norm / reference, resolution,
                         norm > self.tolerance * reference, residuals, 0), 1.0

    def _search(self, step: np.ndarray, norm: float, tangent: bool) -> tuple[float, int, float]:
        """Adds the step, or the part of it with the least out-of-balance forces where all of it increases them: their norm,
        trials made, and 1, or the share of the increment to try where every part is refused."""
        array, begin, part = self.material.du.x.array, self.material.du.x.array.copy(), 1.0
        best, best_part, trials = np.inf, 0.0, 0
        for _ in range(1 + MOST_CUTS):
            array[:] = self._rounded(begin + part * step)
            share, trials, tried = self.material.update(tangent), trials + 1, part
            reached = self.forms.residual()[0] if share == 1 else np.inf
            if reached < best:
                best, best_part = reached, part
            if reached < norm:
                break
            if norm == np.inf:  # the predictor: a part of it would miss the prescribed displacements
                return norm, trials, share
            part *= min(share, 0.5)
        if best_part == 0:
            return np.inf, trials, 0.5
        if best_part != tried:
            array[:] = self._rounded(begin + best_part * step)
            self.material.update(tangent)
            best, trials = self.forms.residual()[0], trials + 1
        return best, trials, 1.0

    def _rounded(self, increment: np.ndarray) -> np.ndarray:
        """Increments of the displacement on the grid, with those of fixed degrees of freedom exact."""
        found = self._grid * np.rint(increment / self._grid)
        self.forms.set_fixed(found, self._targets)
        return found

    def _refuse(self, share: float) -> tuple[None, float]:
        self.material.revert()
        self.forms.set_time(self.t)
        return None, min(share, 0.5)
