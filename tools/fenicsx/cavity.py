"""A cylindrical cavity of radius 1 m is expanded in an infinite soil under an isotropic pressure: a quarter, to radius
15 m.

Load parameter: displacement of its wall over the radius. Beside it: the pressure p0 + 2 G u/a of an elastic soil, with
G of the specimens' own tangent; the pressure p0 (1 + sin phi) at which a soil of friction angle phi begins to yield;
and behind it the slope d ln p/d ln u = (1 + sin psi) sin phi/(1 + sin phi) of Hughes, Wroth and Windle (1977,
Geotechnique 27, 455; formulas from memory). phi is that of the same specimens in biaxial tests; psi is taken as 0 and
as phi."""
import numpy as np

from . import cases
from .material import geostatic
from .solver import Solver

RADIUS, OUTER = 1.0, 15.0


def main(words, comm):
    parser = cases.parser("cavity", __doc__, recipe="pack_dense", grains=200, draws=4, elements=4, to=0.02, first=5e-4)
    parser.add_argument("--pressure", type=cases.positive, default=100e3, metavar="PA", help="in the soil (default: 100e3)")
    o = parser.parse_args(words)
    n = o.elements  # around the quarter
    radii = RADIUS + cases.graded(1, RADIUS * np.pi / 2 / n / 1.5, 3 * n, OUTER - RADIUS)
    body = cases.rectangle(comm, radii, np.linspace(0, np.pi / 2, n + 1))
    r, angle = body.geometry.x[:, 0].copy(), body.geometry.x[:, 1].copy()
    body.geometry.x[:, 0], body.geometry.x[:, 1] = r * np.cos(angle), r * np.sin(angle)
    material = cases.material(o, comm, body, initial=geostatic(0, 0, 1, o.pressure))
    solver = Solver(material)
    distance = lambda x: np.hypot(x[0], x[1])  # noqa: E731
    # Chords between nodes are nearer to the middle than these: their middles count as on the circle.
    chord = np.cos(np.pi / 4 / n) * (1 - 1e-9)
    wall = lambda x: distance(x) < RADIUS * (1 + 1e-9)  # noqa: E731
    for k in range(2):
        solver.fix(lambda x, k=k: np.abs(x[k]) < 1e-9, k)
        solver.fix(wall, k, lambda t: RADIUS * t, profile=lambda x, k=k: x[k] / RADIUS)
    solver.pressure(lambda x: distance(x) > OUTER * chord, o.pressure)
    # The shear modulus of the specimens' tangents: its mean over all directions.
    C = [each.stiffness for part in comm.allgather(list(material.points.shared.values())) for each in part]
    modulus = np.mean([0.5 * c[0, 1, 0, 1] + 0.125 * (c[0, 0, 0, 0] + c[1, 1, 1, 1] - c[0, 0, 1, 1] - c[1, 1, 0, 0])
                       for c in C])

    edge = n * np.sin(np.pi / 2 / n) * RADIUS  # radial forces of the nodes of n chords under a pressure of 1

    def row(step):
        force = solver.reaction(wall, along=lambda x: x[:2] / RADIUS)
        pressure = force / edge / (1 + step.t if material.finite else 1)
        return pressure / o.pressure, 1 + 2 * modulus * step.t / o.pressure

    found = cases.follow(o, comm, solver, ["pressure_ratio", "elastic"], row)
    phi, _ = cases.angles(o, comm, [o.pressure])
    sine, t = np.sin(np.radians(phi)), found["t"]
    late = t > 0.5 * t[-1]
    slope = np.polyfit(np.log(t[late]), np.log(found["pressure_ratio"][late]), 1)[0] if late.sum() > 2 else np.nan
    cases.tell(comm, f"pressure at the end {found['pressure_ratio'][-1]:.3f} p0; yield begins at {1 + sine:.3f} p0 by "
               f"{phi:.1f} degrees", f"slope d ln p/d ln u of the second half {slope:.3f}; by the formula "
               f"{sine / (1 + sine):.3f} (psi 0) to {sine:.3f} (psi = phi)")
