"""The footing of `python3 -m rvelab.fenicsx footing` with Mohr-Coulomb points in the place of RVEs: what the meshes do
to the capacity without any grains (tools/validate fenicsx_footing).

    fenicsx_soil.py PHI,PSI [options of the case]      degrees

Perfectly plastic in the plane, without cohesion, the stress normal to it between the others; stress turns with the
material. With s1 >= s3 the principal stresses (tension positive) and D the elastic moduli of plane strain

    f = s1 - s3 + (s1 + s3) sin phi <= 0,   d eps_p = dg (1 + sin psi, -(1 - sin psi)),   dg = f/(f' D g')

f is linear in the principal stresses, so that the return is exact, and its derivative the tangent; where it would end
at a tensile mean stress it goes to the apex, no stress (de Souza Neto, Peric and Owen 2008, Computational methods for
plasticity, section 8.2; written down from memory)."""
import sys

import numpy as np
from mpi4py import MPI
from rvelab.fenicsx import cases, footing, tensors
from rvelab.fenicsx.points import Response

SLACK = 1e-3  # share of the elastic tangent that iterations get at the apex, whose own is 0
LAME, SHEAR = 40e6, 27e6  # Pa: E = 70 MPa, nu = 0.3, of the order of the packings'


class MohrCoulomb:
    def __init__(self, sigma, phi, psi):
        self.sigma, self.made = sigma, np.zeros(len(sigma), bool)
        self.f = np.array([1 + np.sin(phi), np.sin(phi) - 1])
        self.g = np.array([1 + np.sin(psi), np.sin(psi) - 1])
        self.D = LAME + 2 * SHEAR * np.eye(2)

    def trial(self, dH, tangent=True):
        one = np.eye(2)
        rotation, strain = tensors.polar(one + dH)
        elastic = tensors.rotated(self.sigma + LAME * np.trace(strain, axis1=1, axis2=2)[:, None, None] * one
                                  + 2 * SHEAR * strain, rotation)
        values, axes = np.linalg.eigh(elastic)
        values, axes = values[:, ::-1], axes[:, :, ::-1]
        excess = values @ self.f
        yields = excess > 0
        along = self.D @ self.g
        back = np.where(yields, excess, 0) / (self.f @ along)
        kept = values - back[:, None] * along
        apex = yields & (kept.sum(axis=1) >= 0)
        kept[apex] = 0
        self.new = np.einsum("nia,na,nja->nij", axes, kept, axes)
        normal = np.where(yields[:, None, None], self.D - np.outer(along, self.f @ self.D) / (self.f @ along), self.D)
        shear = SHEAR * np.divide(kept[:, 0] - kept[:, 1], values[:, 0] - values[:, 1], out=np.ones(len(values)),
                                  where=yields)
        normal[apex], shear[apex] = SLACK * self.D, SLACK * SHEAR
        C = np.zeros((len(dH), 2, 2, 2, 2))
        for a in range(2):
            for b in range(2):
                C[:, a, a, b, b] = normal[:, a, b]
        for a, b in ((0, 1), (1, 0)):
            C[:, a, b, a, b] = C[:, a, b, b, a] = shear
        return Response(self.new, tensors.rotated(C, axes), np.zeros(len(dH)), 1.0)

    def commit(self):
        assert (np.trace(self.new, axis1=1, axis2=2) <= 1e-9 * SHEAR).all(), "a tensile mean stress"
        self.sigma = self.new

    def revert(self):
        pass


def main():
    phi, psi = np.radians(np.array(sys.argv[1].split(","), float))
    made = cases.material

    def material(o, comm, body, **given):
        found = made(o, comm, body, **given)
        found.points = MohrCoulomb(given["initial"](found.x), phi, psi)
        found.update()
        found.commit()
        return found

    cases.material = material
    cases.angles = lambda *_: (np.degrees(phi),) * 2
    cases.summary = lambda solver: []
    footing.main(["--grains", "50", "--draws", "1", *sys.argv[2:]], MPI.COMM_WORLD)


main()
