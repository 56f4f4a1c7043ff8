"""Record files of rvelab as arrays: stages with their measures in soil mechanics' signs, the style of the figures, and
the command line of their scripts. curves.py groups stages to curves.

Files hold Cauchy stress in Pa, tension positive, laboratory frame; everything returned here whose name is a soil
measure (sigma_1, sigma_3, p, q, eps_v, eps_a) is compression positive.
"""

import math
import os
import pathlib
import sys
from dataclasses import dataclass, field

PACKAGES = {"h5py": "python3-h5py", "matplotlib": "python3-matplotlib", "numpy": "python3-numpy",
            "tomllib": "python3 (3.11 or later)"}

try:
    import tomllib

    import h5py
    import matplotlib

    if "MPLBACKEND" not in os.environ:
        matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
except ModuleNotFoundError as missing:
    print(f"{pathlib.Path(sys.argv[0]).name}: this python3 ({sys.executable}) has no {missing.name}; apt-get install "
          f"{PACKAGES.get(missing.name, 'python3-' + str(missing.name))}, or run the script with /usr/bin/python3",
          file=sys.stderr)
    sys.exit(1)

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
    "svg.hashsalt": "rvelab",  # the same figure, the same bytes
    "pdf.fonttype": 42,  # text stays text
}


@dataclass(frozen=True)
class Origin:
    """Data of a record file about the whole test."""

    group: str  # folder of the file, or the folder that was given
    specimen: int  # checksum of the specimen that the test began with
    grains: int
    material: tuple  # contact law and parameters of the materials
    sticks: bool  # whether its grains adhere: bonds, water, adhesive contacts
    settings: str  # the protocol without its pressures
    wall_seconds: float
    grain_steps: int
    complete: bool
    version: str


@dataclass
class Stage:
    """One visit of a stage with records."""

    path: pathlib.Path
    kind: str
    name: str
    label: str  # the name, with that of the file where there are several files
    keys: dict  # of the stage in the protocol, every default in it
    dimension: int  # 2: stress lies in the x-y plane
    strain: np.ndarray  # driving strain of the stage, axial strain compression positive
    stress: np.ndarray  # (n, d, d) Pa, compression positive
    deformation: np.ndarray  # (n, d, d), F since the start of the stage
    held: np.ndarray  # the held stress was within its tolerance
    columns: dict  # by the names of the datasets under /records
    origin: object = None  # Origin of the file
    first_record: int = 0  # number of its first record in the file
    parts: list = field(default_factory=list)  # row at which each stage begins that was joined to the first

    @property
    def axis(self):
        """Loading axis "y", plane of shear "xy", or "" where there is none."""
        if self.kind == "compression":
            return self.keys.get("axis") or "xyz"[self.dimension - 1]
        if self.kind == "simple_shear":
            return self.keys.get("plane") or ("xy" if self.dimension == 2 else "xz")
        return self.keys.get("axis", "") if self.kind == "path" else ""

    @property
    def drained(self):
        """The lateral stress of a compression is constant."""
        return self.kind == "compression" and self.keys.get("lateral", "constant_stress") == "constant_stress"

    @property
    def extension(self):
        """The axis becomes longer."""
        return self.kind == "compression" and not self.cyclic and self.strain[-1] < self.strain[0]

    @property
    def cyclic(self):
        """The driving strain reverses."""
        step = np.sign(np.diff(self.strain))
        return bool(np.any(step[1:] * step[:-1] < 0))

    @property
    def pressure(self):
        """Pa: the held lateral pressure, otherwise p at the start."""
        return self.keys["lateral_pressure_Pa"] if self.drained else self.invariants()[0][0]

    @property
    def volumetric_strain(self):
        """1 - det F, compression positive."""
        return 1 - np.linalg.det(self.deformation)

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

    def mobilised(self):
        """q/p, nan where the stress carries no pressure."""
        p, q = self.invariants()
        return np.divide(q, p, out=np.full_like(q, math.nan), where=p > 1e-6 * abs(p[0]))

    def test_in_words(self):
        """The laboratory name of the stage."""
        place = "Biaxial" if self.dimension == 2 else "Triaxial"
        if self.kind == "compression":
            if self.keys.get("lateral") == "zero_strain":
                return "Oedometer"
            return (("Cyclic " + place.lower() + " test") if self.cyclic else
                    f"{place} {'extension' if self.extension else 'compression'}") + ("" if self.drained else ", undrained")
        constant = "normal stress" if self.keys.get("normal") == "constant_stress" else "volume"
        return {"simple_shear": f"{'Cyclic simple' if self.cyclic else 'Simple'} shear at constant {constant}",
                "deviatoric": "Deviatoric loading at constant p", "pressure_path": "Isotropic compression",
                "path": "Stress-strain path", "flow": "Flow", "deformation": "Prescribed deformation"}.get(self.kind, "")

    def strain_in_words(self):
        """Label of the driving strain, in per cent."""
        if self.kind == "compression":
            return f"axial strain $\\varepsilon_{{{self.axis}}}$ (%), compression positive"
        if self.kind == "simple_shear":
            return f"shear strain $\\gamma_{{{self.axis}}}$ (%)"
        return {"deviatoric": "deviatoric strain $\\varepsilon_q$ (%)",
                "pressure_path": "volumetric strain $\\varepsilon_v$ (%)"}.get(self.kind, "driving strain of the stage (%)")

    def has(self, name):
        return name in self.columns

    def column(self, name):
        if name not in self.columns:
            raise ValueError(f"{self.path}: its records have no {name}; run the test with it in [output] quantities")
        return self.columns[name]


def texts(dataset):
    """Texts of a dataset, as one list."""
    return [text.decode() if isinstance(text, bytes) else str(text) for text in np.ravel(dataset[()])]


def without_pressures(table):
    """A protocol with no key whose value is a pressure, so that tests at several pressures are of one kind."""
    if isinstance(table, dict):
        return {key: without_pressures(value) for key, value in sorted(table.items())
                if key not in ("calibrate", "specimen") and "pressure" not in key}
    return [without_pressures(item) for item in table] if isinstance(table, list) else table


def origin_of(file, path, protocol):
    """Origin of an open record file."""
    specimen = file["specimen"]
    material, sticks = [specimen["contact/law"][()]], any(
        len(group[next(iter(group))]) > 0 for group in map(specimen.get, ("bonds", "bridges")) if group)
    for name, values in specimen["materials"].items():
        if name != "name":
            material += [f"{name} {value:.6g}" for value in np.ravel(values[()])]
            sticks = sticks or name in ("adhesion_Pa", "adhesion_N") and bool(np.any(values[()] > 0))
    return Origin(path.resolve().parent.name, int(file["provenance/specimen_crc32c"][()]), len(specimen["grains/radius_m"]),
                  tuple(map(str, material)), sticks, str(without_pressures(protocol)), float(file["provenance/wall_seconds"][()]),
                  int(file["test/grain_steps"][()]), bool(file["complete"][()]), texts(file["provenance/version"])[0])


def read_columns(path):
    """The datasets under /records, the names of the stages, the protocol and its Origin; ValueError, naming the file, if
    it is none."""
    path = pathlib.Path(path)
    journal = path.with_name(path.name + ".journal")
    if not path.exists() and journal.exists():
        raise ValueError(f"{path}: there is only the journal of a run that was killed or goes on; make the file with "
                         f"`rvelab recover {path}`")
    try:
        with h5py.File(path, "r") as file:
            columns = {name: file["records/" + name][()] for name in file["records"]}
            names = texts(file["test/stages"])
            protocol = tomllib.loads(texts(file["provenance/protocol"])[0])
            origin = origin_of(file, path, protocol)
    except (OSError, KeyError, RuntimeError, tomllib.TOMLDecodeError) as error:
        raise ValueError(f"{path}: not a record file of rvelab ({error}); give one that `rvelab run` or "
                         "`rvelab calibrate -o` wrote") from error
    if len(columns["stage"]) == 0:
        raise ValueError(f"{path}: holds no records; the test made none, or stopped before its first one")
    return columns, names, protocol, origin


def stages_of(path):
    """Every visit of a stage with at least two records, in order."""
    columns, names, protocol, origin = read_columns(path)
    # 2D output has sigma_zz = 0: there is no out-of-plane model.
    d = 2 if np.all(columns["stress_Pa"][:, 2, 2] == 0) else 3
    keys = {stage.get("name", stage["kind"]): stage for stage in protocol.get("stage", [])}
    # A stage begins with a record that no sub-step led to.
    begin = (columns["substeps"] == 0) & np.all(columns["deformation_gradient"] == np.eye(3), axis=(1, 2))
    # So does one of a small cycle that comes back to zero, with increments that share a sub-step: by one step, not at once.
    strain = columns["strain"]
    begin[2:] &= np.abs(strain[1:-1]) > 1.5 * np.abs(np.diff(strain)[:-1])
    change = np.flatnonzero((np.diff(columns["stage"]) != 0) | begin[1:]) + 1
    stages = []
    for rows in np.split(np.arange(len(columns["stage"])), change):
        if len(rows) < 2:
            continue
        name = names[columns["stage"][rows[0]]]
        own = {key: values[rows] for key, values in columns.items()}
        of_stage = keys.get(name, {})
        stages.append(Stage(pathlib.Path(path), of_stage.get("kind", ""), name, name, of_stage, d, own["strain"],
                            -own["stress_Pa"][:, :d, :d], own["deformation_gradient"][:, :d, :d],
                            own["target_held"].astype(bool), own, origin, int(rows[0])))
    return stages


def files_of(paths):
    """The files named, and of folders all *.h5 in them that are record files."""
    files = []
    for path in map(pathlib.Path, paths):
        files += [file for file in sorted(path.glob("*.h5")) if is_record_file(file)] if path.is_dir() else [path]
    return files


def is_record_file(path):
    """False for specimens in a folder of records; other errors are reported when the file is read."""
    try:
        with h5py.File(path, "r") as file:
            return "records" in file or "materials" not in file
    except OSError:
        return True


def read_stages(paths):
    """The stages of record files, or of all *.h5 of folders; labels name the file where there are several."""
    files = files_of(paths)
    stages = [stage for file in files for stage in stages_of(file)]
    for stage in stages:
        if len(files) > 1:
            stage.label = f"{stage.path.stem}: {stage.name}"
    if not stages:
        raise ValueError(f"{', '.join(map(str, paths))}: no stage with records there; give record files or their folder")
    if len({stage.dimension for stage in stages}) > 1:
        raise ValueError(f"{', '.join(map(str, paths))}: 2D and 3D records, whose p and q are not the same; give one kind")
    return stages


def read_driven_stages(paths):
    """The same without envelopes and rests, whose records are no curve."""
    stages = [stage for stage in read_stages(paths) if stage.kind not in ("envelope", "relax", "isotropic")]
    if not stages:
        raise ValueError(f"{', '.join(map(str, paths))}: no stage with a curve of records there; give a test that drives a "
                         "strain or a stress (biaxial, simple_shear, ...)")
    return stages


def sine_through_origin(s, t):
    """sin phi of the least-squares line t = s sin phi."""
    return float(np.dot(s, t) / np.dot(s, s))


def plain(value, digits=3):
    """A number as a label shows it: few digits, no trailing zeros, no exponent where it can be read without."""
    if not math.isfinite(value) or value == 0:
        return f"{value:g}"
    size = math.floor(math.log10(abs(value)))
    if not -4 < size < 6:
        return f"{value:.{digits}g}"
    text = f"{round(value, digits - 1 - size):.{max(digits - 1 - size, 0)}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def with_error(value, error, between=" +- "):
    """A value and its error, with two digits of the error and the value with the same decimals; without an error three digits."""
    if not (math.isfinite(error) and error > 0):
        return plain(value)
    decimals = min(max(1 - math.floor(math.log10(error)), 0), 12)
    return f"{value:.{decimals}f}{between}{error:.{decimals}f}"


def counted(number, noun):
    """1 stage, 2 stages."""
    return f"{number} {noun}" + ("" if number == 1 else "s")


def run(draw, parser, read=read_driven_stages):
    """Parses the command line, draws, and turns a user's mistake into one line on stderr and exit code 2."""
    options = parser.parse_args()
    try:
        with plt.rc_context(STYLE):
            print(draw(read(options.records), options))
    except KeyboardInterrupt:
        sys.exit(130)
    except OSError as error:
        print(f"{parser.prog}: {error.filename or options.output}: {error.strerror or error}; give a path in an existing "
              "folder that you may use", file=sys.stderr)
        sys.exit(2)
    except ValueError as error:
        print(f"{parser.prog}: " + " ".join(str(error).split()), file=sys.stderr)
        sys.exit(2)
