"""What the tests of tests/fenicsx share: specimens, meshes, and a law with an exact tangent in the place of RVEs."""
import sys
import tempfile
from pathlib import Path

try:
    import dolfinx  # noqa: F401
except ModuleNotFoundError:
    print("skipped: this Python has no dolfinx (tools/setup fenicsx)")
    sys.exit(77)
import numpy as np
import rvelab
from dolfinx import mesh
from mpi4py import MPI
from rvelab.fenicsx import points, tensors

FOLDER = Path(tempfile.gettempdir())  # set by each test program
P = 100e3


def specimen(name="discs", number=50, recipe="pack_dense", **settings):
    file = FOLDER / f"{name}.h5"
    if not file.exists():
        rvelab.pack(recipe, file, {"pack.number": number, **settings})
    return str(file)


def block(n=(2, 3), size=(1.0, 1.5), cell=mesh.CellType.quadrilateral, distorted=0.0, comm=MPI.COMM_WORLD):
    """A rectangle whose inner nodes are moved by `distorted` of a cell, some to either side."""
    made = mesh.create_rectangle(comm, [(0, 0), size], n, cell)
    x = made.geometry.x
    inside = (x[:, 0] > 1e-9) & (x[:, 0] < size[0] - 1e-9) & (x[:, 1] > 1e-9) & (x[:, 1] < size[1] - 1e-9)
    for k in range(2):
        x[inside, k] += distorted * size[k] / n[k] * np.sin(7 * x[inside, 0] + 11 * x[inside, 1] + k)
    return made


def edges(*sides, size=(1.0, 1.5)):
    """`where` of sides of a block."""
    at = {"left": (0, 0), "right": (0, size[0]), "bottom": (1, 0), "top": (1, size[1])}
    return lambda x: np.any([np.isclose(x[at[side][0]], at[side][1]) for side in sides], axis=0)


class NeoHooke:
    """sigma = (mu (b - 1) + lambda ln J)/J - p, in the place of Points: smooth, with its exact tangent. p holds it at rest."""

    def __init__(self, n, d, p=P, shear=50e6, lame=40e6):
        self.d, self.p, self.shear, self.lame = d, p, shear, lame
        self.F = np.tile(np.eye(d), (n, 1, 1))

    def trial(self, dH, tangent=True):
        d, one = self.d, np.eye(self.d)
        self.new = (one + dH) @ self.F
        J = np.linalg.det(self.new)[:, None, None]
        b = self.new @ np.swapaxes(self.new, 1, 2)
        elastic = (self.shear * (b - one) + self.lame * np.log(J) * one) / J
        dil, sym = np.einsum("ij,kl->ijkl", one, one), 0.5 * (np.einsum("ik,jl->ijkl", one, one)
                                                              + np.einsum("il,jk->ijkl", one, one))
        # Jaumann rate of sigma for D: the Lie derivative of tau over J, plus D sigma + sigma D - sigma tr D.
        c = self.lame * dil / J[..., None, None] + 2 * ((self.shear - self.lame * np.log(J)) / J)[..., None, None] * sym
        c = c + np.einsum("iqkl,nqj->nijkl", sym, elastic) + np.einsum("niq,qjkl->nijkl", elastic, sym)
        c = c - np.einsum("nij,kl->nijkl", elastic, one)
        return points.Response(elastic - self.p * one, c, np.zeros(len(dH)), 1.0)

    def commit(self):
        self.F = self.new

    def revert(self):
        pass


def with_law(material, **options):
    """The material with the law in the place of its RVEs."""
    material.points = NeoHooke(len(material.numbers), material.d, **options)
    material.update()
    material.commit()
    return material


def response(file, dH, tolerance):
    """sigma and C of one RVE as Material makes it: at rest, then dH (d, d)."""
    d = len(dH)
    pool = rvelab.Pool(workers=1, tolerance_rel=0.1, tolerance_abs=tolerance)
    rve = pool.spawn(pool.template(file))
    increment = np.zeros((1, 3, 3))
    pool.trial(rve, increment, want=["tangent", "error_estimate"])
    pool.commit()
    increment[0, :d, :d] = dH
    found = pool.trial(rve, increment, want=["tangent", "error_estimate"])
    return tensors.symmetric(found.sigma[:, :d, :d])[0], tensors.stiffness_of(found.tangent, d)[0]
