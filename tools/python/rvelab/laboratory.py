"""Specimens and laboratory tests by the program rvelab."""
from __future__ import annotations

import os
import tempfile
from copy import copy
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping, NamedTuple, Sequence, Union

import numpy as np

from .program import Folder, ask, words_of
from .rve import Rve

_PathLike = Union[str, "os.PathLike[str]"]


class Records(dict):
    """Records of a laboratory test by name, n rows each: strain (n), stress_Pa (n, 3, 3), void_ratio (n) and so on; the
    names, units and signs of record files (stress in tension positive).

    summary: further output of the program (peak_friction_angle_deg, flagged, stiffness_Pa, ...).
    file: path of the record file. Without `output` it exists as long as these records and their copies; pickle
    sends it to another process."""
    summary: dict[str, Any]
    file: Path
    _kept: Folder | None = None  # that of the file, without `output`

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        if self._kept is not None:
            self.file = Path(self._kept.name, self.file.name)

    def copy(self) -> "Records":
        return copy(self)

    def __repr__(self) -> str:
        n = len(self.get("strain", ()))
        return f"<rvelab.Records of {self.summary.get('protocol', 'a test')}: {n} records of\n {', '.join(self)}>"


class PathPoint(NamedTuple):
    """How far a test is on its path."""
    records: int  #: made so far
    stage: int  #: number of the stage, from 0
    strain: float  #: driving strain of the stage at the last record


def pack(recipe: _PathLike, output: _PathLike, settings: Mapping[str, Any] | None = None, *, count: int = 1,
         threads: int | None = None, overwrite: bool = False, **more: Any) -> Path | list[Path]:
    """Makes specimens from a recipe: the name of an installed one ("pack_dense") or a TOML file. Returns the path of the
    specimen file; with count > 1 the list of them, output_1.h5 and so on, each with the next seed.

    settings: keys of the recipe with dots, {"pack.number": 100, "target.pressure_Pa": 50e3}, or tables in tables."""
    words = ["pack", recipe, "-o", output, *words_of(settings, more)]
    words += ["--count", str(count)] if count != 1 else []
    words += ["--threads", str(threads)] if threads else []
    made = ask(words + (["--force"] if overwrite else []))
    files = [Path(each["file"]) for each in made.get("specimens", [made])]
    return files[0] if count == 1 and len(files) == 1 else files


def _specimen(given: _PathLike | Rve | Records, folder: str) -> str:
    """Path of a specimen file; an RVE is saved into the folder."""
    if isinstance(given, Records):
        return os.fspath(given.file)
    if not isinstance(given, Rve):
        return os.fspath(given)
    path = os.path.join(folder, f"specimen_{given.id}.h5")
    given.save(path)
    return path


def run(protocol: _PathLike, specimen: _PathLike | Rve | Records, settings: Mapping[str, Any] | None = None, *,
        output: _PathLike | None = None, progress: Callable[[PathPoint], None] | None = None, overwrite: bool = False,
        resume: bool = False, **more: Any) -> Records:
    """Runs a laboratory test: the name of an installed protocol ("biaxial") or a TOML file, on a specimen file, an Rve
    (its committed state, which does not change) or the end of other Records.

    settings: keys of the protocol with dots, {"test.pressure_Pa": 50e3}, or tables in tables, {"test": {...}}.
    output: record file to keep. progress: called with a PathPoint some times per second. overwrite: replaces an existing
    output; resume: continues a stopped test."""
    kept = Folder()
    file = os.fspath(output) if output is not None else os.path.join(kept.name, "R.h5")
    words = ["run", protocol, "--specimen", _specimen(specimen, kept.name), "-o", file, *words_of(settings, more)]
    words += ["--force"] * overwrite + ["--resume"] * resume

    def made_of(printed: dict[str, Any]) -> Records:
        records = Records()
        for name, rows in printed.pop("records").items():
            column = np.array(rows)  # a number that is not finite is null in JSON
            records[name] = column.astype(np.float64) if column.dtype == object else column
        records.summary, records.file = printed, Path(file).absolute()
        records._kept = kept if output is None else None
        return records

    records = ask(words, None if progress is None else lambda point: progress(PathPoint(**point)), made_of)
    if progress is not None:
        progress(PathPoint(len(records["strain"]), int(records["stage"][-1]) if "stage" in records else 0,
                        float(records["strain"][-1])))
    return records


def ensemble(protocol: _PathLike, specimens: Iterable[_PathLike | Rve], settings: Mapping[str, Any] | None = None, *,
             against: Iterable[_PathLike | Rve] = (), output: _PathLike | None = None, threads: int | None = None,
             overwrite: bool = False, resume: bool = False, **more: Any) -> dict[str, Any]:
    """Runs a test on two or more specimens, one per core, and returns the results of the program: summary, a list with mean,
    standard_deviation, standard_error, low_95, high_95 and n of each measure, and tests. against: a second group; then
    differences holds those of the means.

    output: folder for the record files, summary.json and summary.csv. settings as in run()."""
    with tempfile.TemporaryDirectory(prefix="rvelab-") as folder:
        words = ["run", protocol]
        for option, group in (("--specimen", specimens), ("--against", against)):
            words += [word for given in group for word in (option, _specimen(given, folder))]
        words += words_of(settings, more) + (["-o", output] if output is not None else [])
        words += ["--threads", str(threads)] if threads else []
        return ask(words + ["--force"] * overwrite + ["--resume"] * resume)


def calibrate(protocol: _PathLike, specimens: _PathLike | Rve | Iterable[_PathLike | Rve],
              pressures: Sequence[float] | None = None, settings: Mapping[str, Any] | None = None, *,
              output: _PathLike | None = None, threads: int | None = None, overwrite: bool = False,
              **more: Any) -> dict[str, Any]:
    """Runs a compression test of each specimen at every pressure, Pa, and returns the results of `rvelab calibrate`:
    friction_angle_deg, bearing_capacity_Nq, of several specimens friction_angle_mean_deg and its standard error, and the
    lists per_pressure and per_specimen.

    output: folder for the record files R_<pressure>.h5. settings as in run()."""
    several = isinstance(specimens, Iterable) and not isinstance(specimens, (str, os.PathLike, Records))
    with tempfile.TemporaryDirectory(prefix="rvelab-") as folder:
        files = [_specimen(given, folder) for given in (specimens if several else [specimens])]
        words = ["calibrate", protocol, *(word for file in files for word in ("--specimen", file)),
                 *words_of(settings, more)]
        words += ["--pressures", ",".join(f"{float(pressure)!r}" for pressure in pressures)] if pressures is not None else []
        words += ["--every-pressure"] if len(files) > 1 else []
        words += ["-o", output] if output is not None else []
        words += ["--threads", str(threads)] if threads else []
        return ask(words + (["--force"] if overwrite else []))


def fit(protocol: _PathLike, vary: Mapping[str, Sequence[Any]], targets: Mapping[str, Any] | None = None,
        curves: Mapping[_PathLike, float] | Iterable[_PathLike] = (), *,
        specimens: _PathLike | Rve | Iterable[_PathLike | Rve] = (), recipe: _PathLike | None = None,
        same_specimens: bool = False, count: int | None = None, tests: int | None = None,
        settings: Mapping[str, Any] | None = None, output: _PathLike | None = None, threads: int | None = None,
        overwrite: bool = False, resume: bool = False) -> dict[str, Any]:
    """Finds the parameters whose tests reproduce measurements, and returns the results of `rvelab fit`: parameters (key,
    mean, low_95, high_95, ...), targets, tests, posterior_sample. Without targets and curves a sweep.

    vary: {"material.friction": (0.1, 1.0)}; (low, high, "log"); of a sweep (low, high, number of values). targets:
    {"friction_angle_deg": 30} or (value, standard error); "friction_angle_deg@50e3" at a pressure in Pa. curves: measured
    curves, CSV files, or {file: pressure in Pa}. specimens that all tests share, or a recipe with count specimens.
    same_specimens: the targets were measured on these specimens. tests: their number. output: folder for fit.json
    and the other files; plot("fit", output) draws it. resume: continues a fit there."""
    words = ["fit", protocol]
    for key, bounds in vary.items():
        words += ["--vary", f"{key}=" + ":".join(map(str, bounds))]
    for measure, value in (targets or {}).items():
        pair = tuple(value) if isinstance(value, (tuple, list)) else (value,)
        words += ["--target", f"{measure}=" + "+-".join(f"{float(number)!r}" for number in pair)]
    pressures = curves if isinstance(curves, Mapping) else {file: 0 for file in curves}
    for file, pressure in pressures.items():
        words += ["--curve", os.fspath(file) + (f"@{float(pressure)!r}" if pressure else "")]
    several = isinstance(specimens, Iterable) and not isinstance(specimens, (str, os.PathLike, Records))
    with tempfile.TemporaryDirectory(prefix="rvelab-") as folder:
        for given in specimens if several else [specimens]:
            words += ["--specimen", _specimen(given, folder)]
        for name, value in (("--recipe", recipe), ("--count", count), ("--tests", tests), ("-o", output),
                            ("--threads", threads)):
            words += [name, os.fspath(value) if isinstance(value, os.PathLike) else str(value)] if value is not None else []
        words += words_of(settings, {}) + (["--same-specimens"] if same_specimens else [])
        return ask(words + (["--force"] if overwrite else []) + (["--resume"] if resume else []))
