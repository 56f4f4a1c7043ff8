"""Laboratory tests by the program rvelab, for rvelab.py."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from rvelab_library import RvelabError, RvelabWarning, library


class Records(dict):
    """Records of a laboratory test by name, one row each: strain (n), stress_Pa (n, 3, 3) and so on.
    summary: what else the program printed (peak_friction_angle_deg, flagged, stiffness_Pa, ...)."""
    summary: dict[str, Any]


def _program() -> str:
    named = os.environ.get("RVELAB_PROGRAM")
    if named:
        return named
    places = []
    if os.sep in library._name:
        folder = Path(library._name).resolve().parent
        places = [folder / "rvelab", folder.parent / "bin/rvelab", folder.parent.parent / "bin/rvelab"]
    found = next((str(file) for file in places if file.is_file()), None) or shutil.which("rvelab")
    if found is None:
        raise FileNotFoundError("the program rvelab was not found: let RVELAB_PROGRAM name it, or add it to PATH")
    return found


def run(protocol: str | os.PathLike[str], specimen: str | os.PathLike[str], **settings: Any) -> Records:
    """Runs a laboratory test, by the program: the name of a protocol or a TOML file, on a specimen file.
    settings: keys of the protocol, run("biaxial", "S.h5", **{"test.pressure_Pa": 50e3})."""
    command = [_program(), "run", os.fspath(protocol), "--specimen", os.fspath(specimen), "--json"]
    for key, value in settings.items():
        command += ["--set", f"{key}={value if isinstance(value, str) else json.dumps(value)}"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise RvelabError(done.stderr.strip() or f"{command[0]} ended with the exit code {done.returncode}")
    for line in done.stderr.splitlines():
        warnings.warn(line, RvelabWarning, stacklevel=2)
    printed = json.loads(done.stdout)
    records = Records()
    for name, rows in printed.pop("records").items():
        column = np.array(rows)  # a number that is not finite is null in JSON
        records[name] = column.astype(np.float64) if column.dtype == object else column
    records.summary = printed
    return records
