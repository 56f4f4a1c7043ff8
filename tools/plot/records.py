"""Record files of rvelab as arrays, and what the figures share: measures in soil mechanics' signs, colours, style.

Files hold Cauchy stress in Pa, tension positive, laboratory frame; everything returned here whose name is a soil
measure (sigma_1, sigma_3, p, q, eps_v, eps_a) is compression positive.
"""

import math
import pathlib
import sys
from dataclasses import dataclass

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

STYLE = {
    "figure.dpi": 150,
    "savefig.bbox": "tight",
    "font.size": 10,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
}


@dataclass
class Test:
    """The last stage of one record file."""

    path: pathlib.Path
    dimension: int  # 2: stress lies in the x-y plane
    pressure: float  # Pa, the stage's first p
    strain: np.ndarray  # driving strain of the stage, axial strain compression positive
    stress: np.ndarray  # (n, d, d) Pa, compression positive
    volumetric_strain: np.ndarray  # 1 - det F, compression positive
    held: np.ndarray  # the lateral stress was held within tolerance

    def principal(self):
        """sigma_1 and sigma_3, Pa, one each a record."""
        values = np.linalg.eigvalsh(0.5 * (self.stress + self.stress.transpose(0, 2, 1)))
        return values[:, -1], values[:, 0]

    def invariants(self):
        """p and q, Pa: q = sqrt(s:s/2) in 2D, sqrt(3 s:s/2) in 3D."""
        p = np.trace(self.stress, axis1=1, axis2=2) / self.dimension
        deviator = self.stress - p[:, None, None] * np.eye(self.dimension)
        factor = 0.5 if self.dimension == 2 else 1.5
        return p, np.sqrt(factor * np.einsum("nij,nij->n", deviator, deviator))


def read_test(path):
    """Reads one record file; raises ValueError, naming the file, where it is none."""
    path = pathlib.Path(path)
    journal = path.with_name(path.name + ".journal")
    if not path.exists() and journal.exists():
        raise ValueError(f"{path}: there is only the journal of a run that was killed or goes on; make the file with "
                         f"`rvelab recover {path}`")
    try:
        with h5py.File(path, "r") as file:
            records = {name: file["records/" + name][()] for name in
                       ("stage", "strain", "stress_Pa", "deformation_gradient", "target_held")}
            pressure = float(np.ravel(file["test/pressure_Pa"][()])[0]) if "test/pressure_Pa" in file else math.nan
    except (OSError, KeyError) as error:
        raise ValueError(f"{path}: not a record file of rvelab ({error}); give one that `rvelab run` or "
                         "`rvelab calibrate -o` wrote") from error
    if len(records["stage"]) == 0:
        raise ValueError(f"{path}: holds no records; the test stopped before its first one")
    last = records["stage"] == records["stage"].max()
    # 2D output has sigma_zz = 0: there is no out-of-plane model.
    dimension = 2 if np.all(records["stress_Pa"][:, 2, 2] == 0) else 3
    test = Test(path, dimension, pressure, records["strain"][last], -records["stress_Pa"][last][:, :dimension, :dimension],
                1 - np.linalg.det(records["deformation_gradient"][last]), records["target_held"][last].astype(bool))
    if not math.isfinite(test.pressure):
        test.pressure = float(test.invariants()[0][0])
    return test


def read_tests(paths):
    """Reads record files, or all *.h5 of folders, in the order of their pressures."""
    files = []
    for path in map(pathlib.Path, paths):
        files += sorted(path.glob("*.h5")) if path.is_dir() else [path]
    if not files:
        raise ValueError(f"{', '.join(map(str, paths))}: no *.h5 file there; give record files or their folder")
    return sorted(map(read_test, files), key=lambda test: test.pressure)


def sine_through_origin(s, t):
    """sin phi of the least-squares line t = s sin phi."""
    return float(np.dot(s, t) / np.dot(s, s))


def pressure_colours(count):
    """One colour a test, dark to light with pressure."""
    return plt.get_cmap("viridis")(np.linspace(0.05, 0.85, count)) if count > 1 else [plt.get_cmap("viridis")(0.3)]


def plain(value):
    """A number as a label shows it: no trailing zeros."""
    return f"{value:.4g}"


def run(draw, parser):
    """Parses the command line, draws, and turns a user's mistake into one line on stderr and exit code 2."""
    options = parser.parse_args()
    try:
        tests = read_tests(options.records)
        with plt.rc_context(STYLE):
            print(draw(tests, options))
    except (ValueError, OSError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        sys.exit(2)
