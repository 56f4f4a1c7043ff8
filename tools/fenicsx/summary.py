"""What a run took, and what its answers are worth."""
from __future__ import annotations

import numpy as np

from . import compat
from .solver import Solver

SAMPLE = 20  # points without an RVE whose error is measured
_WARNINGS = {1: "the error estimate was above the tolerance of the RVE",
             2: "the RVE was not in equilibrium (it flows or collapses)",
             3: "the cell was thinner than four mean diameters",
             4: "the network had no tangent, and the affine one was used"}


def sharing(solver: Solver) -> tuple[int, int, float]:
    """Collective. Points; those without an RVE; the largest error of their stress over the pressure, from trials of the
    shared state at those of largest strain, some on each rank."""
    points, comm = solver.material.points, solver.material.mesh.comm
    worst = 0.0
    for key, shared in points.shared.items():
        unmade = np.flatnonzero(~points.made & (points.group == key))
        if len(unmade):
            size = np.linalg.norm(points.F[unmade] - np.eye(points.d), axis=(1, 2))
            chosen = unmade[np.argsort(-size, kind="stable")[:max(1, SAMPLE // len(points.shared))]]
            worst = max(worst, float((shared.error(points.pool, points.F[chosen]) / shared.p).max()))
    return comm.allreduce(len(points.made)), comm.allreduce(int((~points.made).sum())), max(comm.allgather(worst))


def summary(solver: Solver) -> list[str]:
    """Collective. Lines to print."""
    points, comm, history = solver.material.points, solver.material.mesh.comm, solver.history
    count, unmade, error = sharing(solver)
    work = comm.allreduce(float(points.total))
    moved, tallies = comm.allreduce(points.moved), comm.allgather(points.warned)
    warned = {key: sum(each.get(key, 0) for each in tallies) for key in sorted(set().union(*tallies))}
    if not history:
        return ["no increment was made"]
    steps, seconds = len(history), sum(each.seconds for each in history)
    iterations, trials = sum(each.iterations for each in history), sum(each.trials for each in history)
    coarse = [each for each in history if each.resolved]
    lines = [f"dolfinx {compat.version()}, {comm.size} rank{'s' if comm.size > 1 else ''}, {count} points",
             f"increments {steps}, iterations per increment {iterations / steps:.2f}, trials of a point per increment "
             f"{trials / steps:.2f}, increments refused {sum(each.refused for each in history)}",
             f"seconds per increment and RVE {seconds / steps / count:.2e}, grain-steps per increment and RVE "
             f"{work / steps / count:.3g}",
             f"{len(coarse)} of {steps} increments stopped at what the RVEs resolve, above the tolerance of "
             f"{solver.tolerance:g}; largest residual over the forces {max(each.residual for each in history):.2g}"]
    lines.append(f"{unmade} of {count} points never left the elastic range, and shared RVEs"
                 + (f"; largest error of their stress over the pressure {error:.1e}" if unmade else ""))
    if points.spread:
        off = "" if points.balances else " (switched off)"
        lines.append(f"work of the busiest rank over the mean: mean {np.mean(points.spread):.2f}, largest "
                     f"{max(points.spread):.2f}; RVEs moved between ranks: {moved}{off}")
    lines += [f"{number} trials: {_WARNINGS.get(key, f'status {key}')}" for key, number in warned.items()]
    return lines
