"""Record files of rvelab as arrays, and what the figures share: measures in soil mechanics' signs, colours, style.

Files hold Cauchy stress in Pa, tension positive, laboratory frame; everything returned here whose name is a soil
measure (sigma_1, sigma_3, p, q, eps_v, eps_a) is compression positive.
"""

import math
import pathlib
import sys
import tomllib
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


@dataclass
class Stage:
    """One visit of a stage with records."""

    path: pathlib.Path
    kind: str
    label: str
    axis: str  # loading axis of the file's last driven stage: "y", "xy", ...; may be empty
    dimension: int
    strain: np.ndarray
    stress: np.ndarray  # (n, d, d) Pa, compression positive
    deformation: np.ndarray  # (n, d, d), F since the start of the stage
    held: np.ndarray
    columns: dict  # by the names of the datasets under /records

    invariants = Test.invariants

    def has(self, name):
        return name in self.columns

    def column(self, name):
        if name not in self.columns:
            raise ValueError(f"{self.path}: its records have no {name}; run the test with it in [output] quantities")
        return self.columns[name]


def stages_of(path):
    """Every visit of a stage with at least two records, in order."""
    test = read_test(path)  # says what is wrong with the file
    with h5py.File(path, "r") as file:
        columns = {name: file["records/" + name][()] for name in file["records"]}
        names = [name.decode() for name in file["test/stages"][()]]
        axis = np.ravel(file["test/axis"][()])[0].decode()
        protocol = tomllib.loads(np.ravel(file["provenance/protocol"][()])[0].decode())
    kinds = {stage.get("name", stage["kind"]): stage["kind"] for stage in protocol.get("stage", [])}
    # A stage begins with a record that no sub-step led to.
    begin = (columns["substeps"] == 0) & np.all(columns["deformation_gradient"] == np.eye(3), axis=(1, 2))
    change = np.flatnonzero((np.diff(columns["stage"]) != 0) | begin[1:]) + 1
    stages = []
    for rows in np.split(np.arange(len(columns["stage"])), change):
        if len(rows) < 2:
            continue
        name = names[columns["stage"][rows[0]]]
        own = {key: values[rows] for key, values in columns.items()}
        d = test.dimension
        stages.append(Stage(pathlib.Path(path), kinds.get(name, ""), name, axis, d, own["strain"],
                            -own["stress_Pa"][:, :d, :d], own["deformation_gradient"][:, :d, :d],
                            own["target_held"].astype(bool), own))
    return stages


def read_stages(paths):
    """The stages of record files, or of all *.h5 of folders; labels name the file where there are several."""
    files = []
    for path in map(pathlib.Path, paths):
        files += sorted(path.glob("*.h5")) if path.is_dir() else [path]
    stages = [stage for file in files for stage in stages_of(file)]
    for stage in stages:
        if len(files) > 1:
            stage.label = f"{stage.path.stem}: {stage.label}"
    if not stages:
        raise ValueError(f"{', '.join(map(str, paths))}: no stage with records there; give record files or their folder")
    return stages


def read_driven_stages(paths):
    """The same without envelopes and rests, whose records are no curve."""
    stages = [stage for stage in read_stages(paths) if stage.kind not in ("envelope", "relax", "isotropic")]
    if not stages:
        raise ValueError(f"{', '.join(map(str, paths))}: no stage with a curve of records there")
    return stages


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


def run(draw, parser, read=read_tests):
    """Parses the command line, draws, and turns a user's mistake into one line on stderr and exit code 2."""
    options = parser.parse_args()
    try:
        tests = read(options.records)
        with plt.rc_context(STYLE):
            print(draw(tests, options))
    except (ValueError, OSError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        sys.exit(2)
