"""States of grains as arrays: of a specimen the one, of a record file its snapshots and its end.

Grains, contacts and their forces come from `rvelab export --format xdmf`, the normals of ellipses from its CSV.
"""

import csv
import os
import pathlib
import shutil
import subprocess
import tempfile
from dataclasses import dataclass

import records  # first: it names a missing package
import h5py
import numpy as np


@dataclass
class Bonds:
    """Bonds of a state, broken ones too."""

    begin: np.ndarray  # (b, d) m, centre of the first grain
    branch: np.ndarray  # (b, d) m, from the first grain to the image of the second
    length: np.ndarray  # (b,) m, as it was made
    radius: np.ndarray  # (b,) m
    broken: np.ndarray  # (b,) 0: intact, 1: in tension, 2: in shear


@dataclass
class State:
    """Laboratory frame, SI. Grains lie in the parallelepiped of the cell vectors around the origin."""

    path: str
    record: int  # number of its record; of a specimen 0
    strain: float  # driving strain of that record; None of a specimen
    dimension: int
    cell: np.ndarray  # (d, d), cell vectors in columns, m
    position: np.ndarray  # (n, d) m
    radius: np.ndarray  # (n,) m; of an ellipse sqrt(a b)
    axes: np.ndarray  # (n, 2) m, semi-axes; of round grains the radius twice
    angle: np.ndarray  # (n,) degrees, of the long axis of an ellipse; else 0
    ellipses: bool
    grain_stress: np.ndarray  # (n, d, d) Pa, mean over the grain, compression positive
    begin: np.ndarray  # (c, d) m, centre of the first grain of each contact
    branch: np.ndarray  # (c, d) m, from the first grain to the image of the second
    normal: np.ndarray  # (c, d) unit vectors from the first grain to the second; None where it was not read
    normal_force: np.ndarray  # (c,) N, compression positive
    bonds: Bonds

    @property
    def mean_diameter(self):
        return 2 * float(self.radius.mean())


def program():
    """RVELAB_PROGRAM, else rvelab of this tree or installation, or that of the PATH."""
    named = os.environ.get("RVELAB_PROGRAM")
    root = pathlib.Path(__file__).resolve().parents
    paths = [named] if named else [root[2] / "build/release/bin/rvelab", root[3] / "bin/rvelab"]
    found = next((str(path) for path in paths if pathlib.Path(path).exists()), None) or shutil.which("rvelab")
    if found is None:
        raise ValueError("no program rvelab is built here or in the PATH; run tools/setup and build it")
    return found


def read_states(paths):
    """One state for each specimen or record file, of record files the last; of folders those of their *.h5."""
    files = []
    for path in map(pathlib.Path, paths):
        files += sorted(path.glob("*.h5")) if path.is_dir() else [path]
    if not files:
        raise ValueError(f"{', '.join(map(str, paths))}: no *.h5 there; give specimen or record files")
    return [read_state(file) for file in files]


def read_state(path):
    """The last state, with the normals of its contacts."""
    state = every_state(path)[-1]
    if state.ellipses and len(state.branch):
        state.normal = normals_of_ellipses(path)
    return state


def export(path, form, output):
    done = subprocess.run([program(), "export", str(path), "--format", form, "-o", output], capture_output=True, text=True)
    if done.returncode != 0:
        raise ValueError(done.stderr.strip().removeprefix("rvelab: "))


def every_state(path):
    """All states that the file holds, in their order: snapshots and the end. Of ellipses without normals."""
    with tempfile.TemporaryDirectory() as folder:
        xdmf = os.path.join(folder, "states.xdmf")
        export(path, "xdmf", xdmf)
        with h5py.File(xdmf + ".h5", "r") as exported:
            count = len(exported)
            numbers = records_of(path, count)
            return [state_of(path, exported[f"state_{k}"], *numbers[k]) for k in range(count)]


def records_of(path, count):
    """Number and driving strain of the record of each exported state: the snapshots, then the end."""
    try:
        with h5py.File(path, "r") as file:
            if "records" not in file:
                return [(0, None)] * count
            strain = file["records/strain"][()]
            rows = [int(name) for name in sorted(file["snapshots"])] if "snapshots" in file else []
    except OSError:  # only a journal: the numbers do not matter
        return [(k, None) for k in range(count)]
    rows = (rows + [len(strain) - 1])[-count:]
    return [(row, float(strain[row]) if 0 <= row < len(strain) else None) for row in rows]


def state_of(path, exported, record, strain):
    """A State from a group of the exported file."""
    edges = exported["cell/points_m"][()]
    d = 2 if len(edges) == 8 else 3
    # Edges along the first vector come first, two of them in 2D, four in 3D.
    stride = 4 if d == 2 else 8
    cell = np.stack([edges[stride * k + 1] - edges[stride * k] for k in range(d)], axis=1)[:d]
    grains = exported["grains"]
    position, radius = grains["points_m"][()][:, :d], grains["radius_m"][()]
    ellipses = "orientation" in grains
    angle, axes = np.zeros(len(radius)), np.stack([radius, radius], axis=1)
    if ellipses:
        long_axis = grains["orientation"][()]
        angle = np.degrees(np.arctan2(long_axis[:, 1], long_axis[:, 0]))
        axes = np.stack([grains["semi_major_m"][()], grains["semi_minor_m"][()]], axis=1)
    begin, branch, force = np.zeros((0, d)), np.zeros((0, d)), np.zeros(0)
    if "contacts" in exported:
        points = exported["contacts/points_m"][()][:, :d]
        begin, branch = points[0::2], points[1::2] - points[0::2]
        force = exported["contacts/normal_force_N"][()]
    normal = branch / np.maximum(np.linalg.norm(branch, axis=1, keepdims=True), 1e-300)
    stress = -grains["stress_Pa"][()].reshape(-1, 3, 3)[:, :d, :d]
    return State(str(path), record, strain, d, cell, position, radius, axes, angle, ellipses, stress, begin, branch,
                 None if ellipses else normal, force, bonds_of(exported, d))


def bonds_of(exported, d):
    """The bonds of a state, none where it has none."""
    if "bonds" not in exported:
        return Bonds(np.zeros((0, d)), np.zeros((0, d)), *(np.zeros(0) for _ in range(3)))
    bonds = exported["bonds"]
    points = bonds["points_m"][()][:, :d]
    return Bonds(points[0::2], points[1::2] - points[0::2], *(bonds[name][()] for name in ("length_m", "radius_m", "broken")))


def normals_of_ellipses(path):
    """Unit vectors from the first grain to the second, one a contact, of the last state."""
    with tempfile.TemporaryDirectory() as folder:
        stem = os.path.join(folder, "state")
        export(path, "csv", stem)
        with open(stem + ".contacts.csv") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return np.array([[float(row["nx"]), float(row["ny"])] for row in rows])
