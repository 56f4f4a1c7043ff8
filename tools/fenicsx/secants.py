"""Steps of Newton's method improved by what the steps before it did to the residual. The tangent of a contact network
is that of contacts that do not slip, so Newton's method with it converges linearly where many slip; secants restore
the difference.

With the last changes dX_k of the displacements and dR_k of the residual, g = argmin |R - sum g_k dR_k|, and

    step = -sum g_k dX_k - K^-1 (R - sum g_k dR_k)

This is Anderson's acceleration (1965, J. ACM 12, 547) in its multisecant form (Fang and Saad 2009, Numer. Linear
Algebra Appl. 16, 197), with the present tangent as the matrix; written down from memory. Without history it is
Newton's step."""
from __future__ import annotations

from typing import Any

import numpy as np

DEPTH = 5


class Secants:
    """Of one increment. `free`: the owned degrees of freedom that are not fixed."""

    def __init__(self, comm: Any, free: np.ndarray) -> None:
        self.comm, self.free = comm, free
        self.moves: list[np.ndarray] = []    # of displacements, with ghosts
        self.changes: list[np.ndarray] = []  # of residuals, owned

    def add(self, move: np.ndarray, change: np.ndarray) -> None:
        self.moves, self.changes = [*self.moves, move][-DEPTH:], [*self.changes, change][-DEPTH:]

    def reduce(self, residual: np.ndarray) -> tuple[np.ndarray | float, np.ndarray]:
        """The part of the step that the moves give, and the residual that is left for the tangent. Collective."""
        if not self.moves:
            return 0.0, residual
        rows = np.array([change[self.free] for change in self.changes])
        products = self.comm.allreduce(np.column_stack([rows @ rows.T, rows @ residual[self.free]]))
        scale = np.sqrt(np.diag(products[:, :-1]))
        matrix, right = products[:, :-1] / np.outer(scale, scale), products[:, -1] / scale
        factors = np.linalg.lstsq(matrix, right, rcond=1e-8)[0] / scale
        # The factors need few digits, since both answers have the same; without the others they are those of any number
        # of ranks.
        factors = np.rint(factors * 4096) / 4096
        move = -sum(factor * each for factor, each in zip(factors, self.moves))
        return move, residual - sum(factor * each for factor, each in zip(factors, self.changes))
