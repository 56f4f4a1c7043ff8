"""A smooth wall, 1 m high, moves away from the soil behind it (active), or with --passive into it.

Load parameter: displacement of the wall over its height. The soil rests on a smooth base, so that Rankine's stresses
are the exact limit: K = tan^2(45 -+ phi/2), which is also Coulomb's for a smooth vertical wall and level ground. phi
is that of the same specimens in biaxial tests at the mean lateral stress: at the peak, and at 15 % of strain."""
import numpy as np

from . import cases
from .material import geostatic
from .solver import Solver

HEIGHT, LENGTH = 1.0, 2.0


def main(words, comm):
    parser = cases.parser("wall", __doc__, recipe="pack_dense", grains=200, draws=4, elements=3, to=0.02, first=1e-3)
    parser.add_argument("--passive", action="store_true", help="the wall moves into the soil")
    parser.add_argument("--surcharge", type=cases.positive, default=20e3, metavar="PA", help="on the ground (default: 20e3)")
    parser.add_argument("--unit-weight", type=float, default=20e3, metavar="N/M3", help="of the soil (default: 20e3)")
    parser.add_argument("--at-rest", type=float, default=0.5, help="initial horizontal over vertical stress (default: 0.5)")
    o = parser.parse_args(words)
    body = cases.rectangle(comm, np.linspace(0, LENGTH, 2 * o.elements + 1), np.linspace(0, HEIGHT, o.elements + 1))
    material = cases.material(o, comm, body, initial=geostatic(HEIGHT, o.unit_weight, o.at_rest, o.surcharge))
    solver = Solver(material)
    wall, sign = (lambda x: np.isclose(x[0], 0)), 1 if o.passive else -1
    solver.fix(wall, 0, lambda t: sign * HEIGHT * t)
    solver.fix(lambda x: np.isclose(x[0], LENGTH), 0)
    solver.fix(lambda x: np.isclose(x[1], 0), 1)
    solver.pressure(lambda x: np.isclose(x[1], HEIGHT), o.surcharge)
    solver.body_force((0, -o.unit_weight))
    vertical = o.surcharge * HEIGHT + o.unit_weight * HEIGHT ** 2 / 2  # the vertical stress over the height, N/m

    def row(step):
        return (solver.reaction(wall)[0] / vertical,)

    found = cases.follow(o, comm, solver, ["K"], row)["K"]
    extreme = found.max() if o.passive else found.min()
    told = []
    lateral = vertical / HEIGHT * (1 if o.passive else extreme)
    for name, phi in zip(("peak", "15 %"), cases.angles(o, comm, [lateral])):
        told.append(f"{np.tan(np.radians(45 + sign * phi / 2)) ** 2:.3f} by {phi:.1f} degrees ({name})")
    cases.tell(comm, f"{'largest' if o.passive else 'least'} K {extreme:.3f}, at the end {found[-1]:.3f}; Rankine "
               + ", ".join(told))
