"""A wall, 1 m high, moves away from the soil behind it (active), or with --passive into it.

Load parameter: displacement of the wall over its height. The soil rests on a smooth base. K is the horizontal force
over that of the vertical stress. Against a smooth wall Rankine's is the exact limit, K = tan^2(45 -+ phi/2). With
--rough the soil holds on to the wall, and with the friction angle delta that the reactions then have Coulomb's wedge
gives (vertical wall, level ground; active +, passive -)

    K = cos^2 phi/(1 +- sqrt(sin(phi + delta) sin phi/cos delta))^2

which is Rankine's at delta = 0, and too large for a passive wall of delta > phi/3, since its surface is plane. phi is
that of the same specimens in biaxial tests at the mean lateral stress: at the peak, and at 15 % of strain."""
import numpy as np

from . import cases
from .material import geostatic
from .solver import Solver

HEIGHT, LENGTH = 1.0, 2.0


def coulomb(phi, delta, passive):
    """Horizontal K; angles in radians."""
    root = np.sqrt(np.sin(phi + delta) * np.sin(phi) / np.cos(delta))
    return np.cos(phi) ** 2 / (1 - root if passive else 1 + root) ** 2


def main(words, comm):
    parser = cases.parser("wall", __doc__, recipe="pack_dense", grains=200, draws=4, elements=3, to=0.02, first=1e-3)
    parser.add_argument("--passive", action="store_true", help="the wall moves into the soil")
    parser.add_argument("--rough", action="store_true", help="the soil holds on to the wall")
    parser.add_argument("--surcharge", type=cases.positive, default=20e3, metavar="PA", help="on the ground (default: 20e3)")
    parser.add_argument("--unit-weight", type=float, default=20e3, metavar="N/M3", help="of the soil (default: 20e3)")
    parser.add_argument("--at-rest", type=float, default=0.5, help="initial horizontal over vertical stress (default: 0.5)")
    o = parser.parse_args(words)
    body = cases.rectangle(comm, np.linspace(0, LENGTH, 2 * o.elements + 1), np.linspace(0, HEIGHT, o.elements + 1))
    material = cases.material(o, comm, body, initial=geostatic(HEIGHT, o.unit_weight, o.at_rest, o.surcharge))
    solver = Solver(material)
    wall, sign = (lambda x: np.isclose(x[0], 0)), 1 if o.passive else -1
    solver.fix(wall, 0, lambda t: sign * HEIGHT * t)
    if o.rough:
        solver.fix(wall, 1)
    solver.fix(lambda x: np.isclose(x[0], LENGTH), 0)
    solver.fix(lambda x: np.isclose(x[1], 0), 1)
    solver.pressure(lambda x: np.isclose(x[1], HEIGHT), o.surcharge)
    solver.body_force((0, -o.unit_weight))
    vertical = o.surcharge * HEIGHT + o.unit_weight * HEIGHT ** 2 / 2  # the vertical stress over the height, N/m

    def row(step):
        force, delta = solver.reaction(wall)[0], 0.0
        if o.rough:  # without the lowest node, which the base carries too
            shear = solver.reaction(wall, along=lambda x: np.array([0 * x[0], x[1] > 1e-9]))
            delta = np.degrees(np.arctan2(-sign * shear, force))
        return force / vertical, delta

    found = cases.follow(o, comm, solver, ["K", "wall_friction_deg"], row)
    at = np.argmax(found["K"]) if o.passive else np.argmin(found["K"])
    extreme, delta = found["K"][at], found["wall_friction_deg"][at]
    told = {"Rankine": [], "Coulomb": []}
    for name, phi in zip(("peak", "15 %"), cases.angles(o, comm, [vertical / HEIGHT * (1 if o.passive else extreme)])):
        for theory, angle in zip(told, (0, max(delta, 0))):
            K = coulomb(np.radians(phi), np.radians(angle), o.passive)
            told[theory].append(f"{K:.3f} by {phi:.1f} degrees ({name})")
    where = "at the end of the run" if at == len(found["K"]) - 1 else f"at the end {found['K'][-1]:.3f}"
    cases.tell(comm, f"{'largest' if o.passive else 'least'} K {extreme:.3f}, {where}; wall friction "
               f"{delta:.1f} degrees", *(f"{theory} {', '.join(each)}" for theory, each in told.items()))
