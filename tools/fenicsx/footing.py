"""A rigid strip footing, 1 m wide, is pressed into level ground under a surcharge; the left edge is the plane of
symmetry.

Load parameter: settlement over the width. The pressure under the footing over the surcharge tends to N_q without
weight (Prandtl 1921, Reissner 1924); with --unit-weight the term of N_gamma is added: Hjiaj, Lyamin and Sloan (2005,
Int. J. Solids Struct. 42, 1681) for a rough base, half of it for a smooth one. Both formulas are of the friction angle
of the same specimens in biaxial tests at the surcharge and at four times that: at the peak, and at 15 % of strain.
Formulas from memory."""
import numpy as np

from . import cases
from .material import geostatic
from .solver import Solver

WIDTH, DEPTH, LENGTH = 1.0, 3.0, 5.0


def n_q(phi):
    return np.exp(np.pi * np.tan(phi)) * np.tan(np.pi / 4 + phi / 2) ** 2


def n_gamma(phi, rough):
    return np.exp((np.pi + 3 * np.pi ** 2 * np.tan(phi)) / 6) * np.tan(phi) ** (2 * np.pi / 5) * (1 if rough else 0.5)


def main(words, comm):
    parser = cases.parser("footing", __doc__, recipe="pack_medium", grains=200, draws=4, elements=2, to=0.1, first=2e-3)
    parser.add_argument("--surcharge", type=cases.positive, default=100e3, metavar="PA", help="on the ground (default: 100e3)")
    parser.add_argument("--unit-weight", type=float, default=0, metavar="N/M3", help="of the soil (default: 0)")
    parser.add_argument("--at-rest", type=float, default=1, help="initial horizontal over vertical stress (default: 1)")
    parser.add_argument("--smooth", action="store_true", help="the base of the footing slides on the soil")
    o = parser.parse_args(words)
    half, n = WIDTH / 2, o.elements  # elements under half the footing
    across = cases.graded(n, half / n, 5 * n, LENGTH)
    down = DEPTH - cases.graded(n, half / n, 4 * n, DEPTH)[::-1]
    body = cases.rectangle(comm, across, down)
    material = cases.material(o, comm, body, initial=geostatic(DEPTH, o.unit_weight, o.at_rest, o.surcharge))
    solver = Solver(material)
    base = lambda x: np.isclose(x[1], DEPTH) & (x[0] < half * (1 + 1e-6))  # noqa: E731
    solver.fix(base, 1, lambda t: -WIDTH * t)
    if not o.smooth:
        solver.fix(base, 0)
    for x in (0, LENGTH):
        solver.fix(lambda p, x=x: np.isclose(p[0], x), 0)
    solver.fix(lambda x: np.isclose(x[1], 0), 1)
    solver.pressure(lambda x: np.isclose(x[1], DEPTH) & (x[0] > half * (1 - 1e-6)), o.surcharge)
    if o.unit_weight:
        solver.body_force((0, -o.unit_weight))

    def row(step):
        return (-solver.reaction(base)[1] / half / o.surcharge,)

    found = cases.follow(o, comm, solver, ["pressure_ratio"], row)["pressure_ratio"]
    told = []
    for name, phi in zip(("peak", "15 %"), cases.angles(o, comm, [o.surcharge, 4 * o.surcharge])):
        angle = np.radians(phi)
        weight = 0.5 * o.unit_weight * WIDTH / o.surcharge * n_gamma(angle, not o.smooth)
        told.append(f"{n_q(angle) + weight:.1f} by {phi:.1f} degrees ({name})")
    cases.tell(comm, f"largest pressure over the surcharge {found.max():.1f}, at the end {found[-1]:.1f}; "
               "by the formula " + ", ".join(told))
