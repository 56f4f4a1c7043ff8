"""The state that points share which have seen elastic strain alone: one RVE with the tangent of its contacts."""
from __future__ import annotations

import warnings

import numpy as np
import rvelab

from . import tensors

SMALLEST, LARGEST = 1e-6, 1e-3  # strains between which the range is looked for


class Shared:
    """An RVE at the state of a member of the family, and the strains for which sigma + C : eps stands for its answer:
    where it errs by less than `share` p. They are measured by trials along each component, forwards and backwards."""

    def __init__(self, pool: rvelab.Pool, d: int, snapshot: bytes, share: float) -> None:
        self.d = d
        template = pool.template(snapshot)
        self.id = int(pool.spawn(template)[0])
        pool.release_template(template)
        found = trial(pool, self.id, np.zeros((3, 3)))
        self.sigma = tensors.symmetric(found.sigma[:, :d, :d])[0]
        self.stiffness = tensors.stiffness_of(found.tangent, d)[0]
        self.estimate = float(found.error_estimate[0])
        self.p = float(-np.trace(self.sigma) / d)
        self.allowed = share * self.p
        self.range = self._range(pool) if share > 0 else 0.0
        pool.revert([self.id])

    def _range(self, pool: rvelab.Pool) -> float:
        """Frobenius norm of the largest strain of a doubling series at which all directions are within the tolerance."""
        d, reached, size = self.d, 0.0, SMALLEST
        axes = np.eye(d)
        directions = [np.outer(one, two) + np.outer(two, one) for k, one in enumerate(axes) for two in axes[k:]]
        directions = np.array([sign * each / np.linalg.norm(each) for each in directions for sign in (1, -1)])
        while size <= LARGEST:
            for strain in size * directions:
                dH = np.zeros((3, 3))
                dH[:d, :d] = strain
                try:
                    sigma = tensors.symmetric(trial(pool, self.id, dH).sigma[:, :d, :d])
                except rvelab.Discard:
                    return reached
                change = np.einsum("ijkl,kl->ij", self.stiffness, strain)[None]
                if np.linalg.norm(sigma - self.sigma - change) > self.allowed:
                    return reached
            reached, size = size, 2 * size
        return reached

    def strain_to(self, sigma: np.ndarray) -> np.ndarray:
        """(n, d, d) strains by which the tangent changes the stress of the member to sigma, (n, d, d) Pa."""
        rows, columns = np.triu_indices(self.d)
        twice = np.where(rows == columns, 1.0, 2.0)
        matrix = self.stiffness[rows[:, None], columns[:, None], rows, columns] * twice
        strain = np.zeros_like(sigma)
        found = np.linalg.solve(matrix, (sigma - self.sigma)[:, rows, columns].T).T
        strain[:, rows, columns] = strain[:, columns, rows] = found
        return strain

    def leaves(self, strain: np.ndarray) -> np.ndarray:
        """(n) which of these strains (n, d, d) are outside the range."""
        return np.linalg.norm(strain, axis=(1, 2)) > self.range

    def response(self, strain: np.ndarray, rotation: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """sigma, C and the allowed error, of points that deformed by this strain and then rotated."""
        change = np.einsum("ijkl,nkl->nij", self.stiffness, strain)
        stiffness = np.broadcast_to(self.stiffness, (len(strain), *self.stiffness.shape))
        return (tensors.rotated(self.sigma + change, rotation), tensors.rotated(stiffness, rotation),
                np.full(len(strain), self.estimate))

    def error(self, pool: rvelab.Pool, F: np.ndarray) -> np.ndarray:
        """Pa, (n): what the shared state errs at points of deformation F (n, d, d), by trials of the RVE itself."""
        rotation, strain = tensors.polar(F)
        told, errors = self.response(strain, rotation)[0], []
        for k, each in enumerate(F):
            dH = np.zeros((3, 3))
            dH[:self.d, :self.d] = each - np.eye(self.d)
            sigma = tensors.symmetric(trial(pool, self.id, dH).sigma[:, :self.d, :self.d])[0]
            errors.append(np.linalg.norm(sigma - told[k]))
        pool.revert([self.id])
        return np.array(errors)


def trial(pool: rvelab.Pool, rve: int, dH: np.ndarray) -> rvelab.Batch:
    """One trial, without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rvelab.RvelabWarning)
        return pool.trial([rve], dH[None], want=["tangent", "error_estimate"])
