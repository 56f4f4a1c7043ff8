"""A cylinder of spheres, diameter 1 m and height 2 m, is compressed between rough plates under a lateral pressure: an
eighth.

Load parameter: axial strain. Rough plates hold the ends, so that the cylinder barrels and its strain is not that of
one RVE; beside the load stands the stress of the same specimen in a triaxial test of its own, at the same axial
strain."""
import warnings

import numpy as np
import rvelab
from dolfinx import mesh

from . import cases
from .material import geostatic
from .solver import Solver

RADIUS, HALF = 0.5, 1.0


def quarter(comm, n):
    """The body over a quarter of the section."""
    body = mesh.create_box(comm, [(0, 0, 0), (1, 1, HALF)], (n, n, 2 * n), mesh.CellType.hexahedron)
    x, y = body.geometry.x[:, 0].copy(), body.geometry.x[:, 1].copy()
    # The quarter of a square onto that of a disc, whose outer sides meet on the diagonal.
    body.geometry.x[:, 0] = RADIUS * x * np.sqrt(1 - y ** 2 / 2)
    body.geometry.x[:, 1] = RADIUS * y * np.sqrt(1 - x ** 2 / 2)
    return body


def wall(n):
    """`where` of the curved side. Its nodes lie at the angles asin(s/sqrt(2)), widest apart at the diagonal; the middles
    of facets are as near to the axis as their chords."""
    gap = np.pi / 4 - np.arcsin((1 - 1 / n) * np.sqrt(0.5))
    chord = RADIUS * np.cos(gap / 2) * (1 - 1e-9)
    return lambda p: np.hypot(p[0], p[1]) > chord


def alone(o, comm, file):
    """Strain and stress ratio of the specimen in its own drained test (the first rank runs it)."""
    found = None
    if comm.rank == 0:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            settings = {"test.pressure_Pa": o.pressure, "stage.compression.to_strain": o.to}
            records = rvelab.run("triaxial", file, settings)
        found = np.array(records["strain"]), -np.array(records["stress_Pa"])[:, 2, 2] / o.pressure
    return comm.bcast(found)


def main(words, comm):
    parser = cases.parser("triaxial", __doc__, recipe="pack_hertz", grains=200, draws=1, elements=2, to=0.01, first=5e-4)
    parser.add_argument("--pressure", type=cases.positive, default=100e3, metavar="PA", help="lateral (default: 100e3)")
    parser.add_argument("--smooth", action="store_true", help="smooth plates: the strain is that of one RVE")
    o = parser.parse_args(words)
    n = o.elements
    material = cases.material(o, comm, quarter(comm, n), initial=geostatic(HALF, 0, 1, o.pressure, 3))
    solver = Solver(material)
    top = lambda p: np.isclose(p[2], HALF)  # noqa: E731
    for k in range(3):
        solver.fix(lambda p, k=k: np.isclose(p[k], 0), k)
    solver.fix(top, 2, lambda t: -HALF * t)
    for k in range(2) if not o.smooth else ():
        solver.fix(top, k)
    solver.pressure(wall(n), o.pressure)
    s = np.linspace(0, 1, n + 1)  # the section is a polygon
    side = np.column_stack([np.sqrt(1 - s ** 2 / 2), s * np.sqrt(0.5)]) * RADIUS
    section = np.abs(np.sum(side[:-1, 0] * side[1:, 1] - side[1:, 0] * side[:-1, 1]))

    def row(step):
        return (-solver.reaction(top)[2] / section / o.pressure,)

    found = cases.follow(o, comm, solver, ["load_ratio"], row)
    strain, ratio = alone(o, comm, o.specimens[0])
    cases.tell(comm, f"axial load over the first area and the pressure at the end {found['load_ratio'][-1]:.3f}; "
               f"axial stress over the pressure of the specimen alone at that strain {np.interp(found['t'][-1], strain, ratio):.3f}")
