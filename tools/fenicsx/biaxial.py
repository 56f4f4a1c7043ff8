"""A block 1 m wide and 2 m high is compressed between plates under a lateral pressure, until a band of shear runs
through it.

Points draw from several specimens, so that the block has weak spots; with --rough the plates hold its ends. Load
parameter: axial strain. The block and its strains are those of Guo and Zhao (2014, IJNME 99, 789), who used 400 discs
for each point. At the end the angle of the band is printed beside those of Coulomb (45 + phi/2), Roscoe (45 + psi/2)
and Arthur (45 + (phi + psi)/4), by phi and psi of the block's own points."""
import numpy as np

from . import cases, tensors
from .material import geostatic
from .solver import Solver

WIDTH, HEIGHT = 1.0, 2.0


def band(material, strain):
    """Angle of the band to the horizontal, degrees, and the share of points in it: the long axis of the points that
    shear more than the mean by a standard deviation."""
    comm = material.mesh.comm
    shear = np.concatenate(comm.allgather(2 * tensors.deviator(strain)))
    x = np.concatenate(comm.allgather(material.x[:, :2]))
    within = shear > shear.mean() + shear.std()
    if within.sum() < 3:
        return np.nan, 0.0
    centred = x[within] - x[within].mean(axis=0)
    axis = np.linalg.eigh(centred.T @ centred)[1][:, -1]
    return np.degrees(np.arctan2(abs(axis[1]), abs(axis[0]))), within.mean()


def main(words, comm):
    parser = cases.parser("biaxial", __doc__, recipe="pack_dense", grains=400, draws=4, elements=4, to=0.03, first=5e-4)
    parser.add_argument("--pressure", type=cases.positive, default=100e3, metavar="PA", help="lateral (default: 100e3)")
    parser.add_argument("--rough", action="store_true", help="plates hold the ends of the block")
    o = parser.parse_args(words)
    body = cases.rectangle(comm, np.linspace(0, WIDTH, o.elements + 1), np.linspace(0, HEIGHT, 2 * o.elements + 1))
    material = cases.material(o, comm, body, initial=geostatic(HEIGHT, 0, 1, o.pressure))
    solver = Solver(material)
    bottom, top = (lambda x: np.isclose(x[1], 0)), (lambda x: np.isclose(x[1], HEIGHT))
    solver.fix(bottom, 1)
    solver.fix(top, 1, lambda t: -HEIGHT * t)
    if o.rough:
        solver.fix(bottom, 0)
        solver.fix(top, 0)
    else:
        solver.fix(lambda x: np.isclose(x[0], 0) & np.isclose(x[1], 0), 0, at="points")
    solver.pressure(lambda x: np.isclose(x[0], 0) | np.isclose(x[0], WIDTH), o.pressure)

    def row(step):
        F = np.concatenate(comm.allgather(material.F))  # small strains: 1
        load = -solver.reaction(top)[1] / (WIDTH * F[:, 0, 0].mean())
        if material.finite:
            return load / o.pressure, np.linalg.det(F).mean() - 1
        return load / o.pressure, np.concatenate(comm.allgather(material.gradient(0))).trace(axis1=1, axis2=2).mean()

    found = cases.follow(o, comm, solver, ["load_ratio", "volume_strain"], row)
    ratio, t = found["load_ratio"], found["t"]
    peak = int(np.argmax(ratio))
    phi = np.degrees(np.arcsin((ratio[peak] - 1) / (ratio[peak] + 1)))
    after = slice(max(0, peak - 5), peak + 6)
    rate = np.polyfit(t[after], found["volume_strain"][after], 1)[0] if len(t[after]) > 2 else 0.0
    psi = np.degrees(np.arcsin(np.clip(rate / (2 + rate), -1, 1)))  # plane strain: dV/d1 = 2 sin/(1 - sin)
    strain = tensors.polar(material.F)[1] if material.finite else tensors.symmetric(material.gradient(0))
    angle, share = band(material, strain)
    cases.tell(comm, f"peak load ratio {ratio[peak]:.3f} at {t[peak]:.2%}, at the end {ratio[-1]:.3f}; "
               f"phi {phi:.1f}, psi {psi:.1f} degrees", "no band" if np.isnan(angle) else
               f"band at {angle:.0f} degrees to the horizontal in {share:.0%} of the points; "
               f"Coulomb {45 + phi / 2:.0f}, Roscoe {45 + psi / 2:.0f}, Arthur {45 + (phi + psi) / 4:.0f}")
