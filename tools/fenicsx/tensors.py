"""Tensors of many points at once, arrays (n, d, d) and (n, d, d, d, d), d = 2 or 3: strain of a deformation, and the
tangent of the nodal forces. Pa, tension positive. The formulas are those of updated Lagrangian elements (Belytschko,
Liu and Moran, Nonlinear Finite Elements, chapter 6; written down from memory and held by finite differences,
tests/fenicsx)."""
from __future__ import annotations

import numpy as np

_VOIGT = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])  # xx yy zz yz xz xy


def polar(F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """F = R U: rotation R and strain U - 1."""
    left, stretch, right = np.linalg.svd(F)
    rotation = left @ right
    return rotation, np.swapaxes(right, 1, 2) @ ((stretch - 1)[:, :, None] * right)


def rotation_angle(rotation: np.ndarray) -> np.ndarray:
    """Radians, (n)."""
    skew = 0.5 * (rotation - np.swapaxes(rotation, 1, 2))
    return np.arcsin(np.minimum(1, np.linalg.norm(skew, axis=(1, 2)) / np.sqrt(2)))


def stiffness_of(tangent: np.ndarray, d: int) -> np.ndarray:
    """C_ijkl (n, d, d, d, d) of tangents (n, 6, 6) of the C interface: columns are of engineering shear."""
    pair = _VOIGT[:d, :d]
    return tangent[:, pair[:, :, None, None], pair[None, None]]


def rotated(tensor: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """R T R^T of tensors of order 2, R R C R^T R^T of those of order 4."""
    if tensor.ndim == 3:
        return rotation @ tensor @ np.swapaxes(rotation, 1, 2)
    return np.einsum("nai,nbj,nck,ndl,nijkl->nabcd", rotation, rotation, rotation, rotation, tensor, optimize=True)


def current_tangent(stiffness: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    """d(J sigma F^-T) for the velocity gradient L at F = 1, as A_ijkl L_kl: sigma follows C : D and the spin W,
    A L = C : D + W sigma - sigma W + sigma tr(L) - sigma L^T. The last four terms are the geometric stiffness."""
    one = np.eye(sigma.shape[1])
    spin = 0.5 * (np.einsum("ik,nlj->nijkl", one, sigma) - np.einsum("il,nkj->nijkl", one, sigma)
                  - np.einsum("nik,lj->nijkl", sigma, one) + np.einsum("nil,kj->nijkl", sigma, one))
    return stiffness + spin + np.einsum("nij,kl->nijkl", sigma, one) - np.einsum("nil,jk->nijkl", sigma, one)


def nominal(sigma: np.ndarray, tangent: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stress P = J sigma F^-T and its tangent dP/d(grad u) on the first mesh, F from there to the present state."""
    inverse, volume = np.linalg.inv(F), np.linalg.det(F)
    stress = volume[:, None, None] * sigma @ np.swapaxes(inverse, 1, 2)
    moved = np.einsum("n,nijkl,nqj,nml->niqkm", volume, tangent, inverse, inverse, optimize=True)
    return stress, moved


def symmetric(tensor: np.ndarray) -> np.ndarray:
    return 0.5 * (tensor + np.swapaxes(tensor, 1, 2))


def deviator(tensor: np.ndarray) -> np.ndarray:
    """sqrt(s : s/2) in the plane, sqrt(3 s : s/2) in space, of the symmetric part, (n)."""
    d = tensor.shape[1]
    s = symmetric(tensor) - np.trace(tensor, axis1=1, axis2=2)[:, None, None] / d * np.eye(d)
    return np.sqrt((0.5 if d == 2 else 1.5) * np.sum(s * s, axis=(1, 2)))
