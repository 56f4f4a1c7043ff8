"""A state of grains as arrays: the last one of a specimen or record file, read through `rvelab export --format csv`."""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
from dataclasses import dataclass

import numpy as np


@dataclass
class State:
    """Laboratory frame, SI."""

    path: str
    dimension: int
    cell: np.ndarray  # (d, d), cell vectors in columns, m
    position: np.ndarray  # (n, d) m
    radius: np.ndarray  # (n,) m; of an ellipse sqrt(a b)
    axes: np.ndarray  # (n, 2) m, semi-axes; of round grains the radius twice
    angle: np.ndarray  # (n,) degrees, of the long axis of an ellipse; else 0
    ellipses: bool
    first: np.ndarray  # (c,) row of the first grain of each contact
    branch: np.ndarray  # (c, d) m, from the first grain to the image of the second
    normal: np.ndarray  # (c, d) unit vectors from the first grain to the second
    normal_force: np.ndarray  # (c,) N, compression positive


def program():
    """rvelab of this tree, or that of the PATH."""
    own = pathlib.Path(__file__).resolve().parents[2] / "build/release/bin/rvelab"
    found = str(own) if own.exists() else shutil.which("rvelab")
    if found is None:
        raise ValueError("no program rvelab is built here or in the PATH; run tools/setup and build it")
    return found


def read_states(paths):
    """One state for each specimen or record file."""
    return [read_state(path) for path in paths]


def read_state(path):
    with tempfile.TemporaryDirectory() as folder:
        stem = os.path.join(folder, "state")
        done = subprocess.run([program(), "export", str(path), "--format", "csv", "-o", stem], capture_output=True, text=True)
        if done.returncode != 0:
            raise ValueError(done.stderr.strip().removeprefix("rvelab: "))
        grains, contacts = rows_of(stem + ".particles.csv"), rows_of(stem + ".contacts.csv")
        meta = json.loads(pathlib.Path(stem + ".json").read_text())
    d = meta["dim"]
    axes = "xyz"[:d]
    cell = np.array(meta["hSize"])[:d, :d]
    index = {int(grain["id"]): k for k, grain in enumerate(grains)}
    position = np.array([[float(grain[a]) for a in axes] for grain in grains])
    ellipses = "a" in grains[0]
    if ellipses:
        axes_of = np.array([[float(grain["a"]), float(grain["b"])] for grain in grains])
        radius = np.sqrt(axes_of[:, 0] * axes_of[:, 1])
        angle = np.array([float(grain["angle"]) for grain in grains])
    else:
        radius = np.array([float(grain.get("radius", grain.get("r"))) for grain in grains])
        axes_of = np.stack([radius, radius], axis=1)
        angle = np.zeros(len(grains))
    first = np.array([index[int(contact["id1"])] for contact in contacts], dtype=int)
    second = np.array([index[int(contact["id2"])] for contact in contacts], dtype=int)
    image = np.array([[int(contact["s" + a]) for a in axes] for contact in contacts]).reshape(-1, d)
    branch = position[second] + image @ cell.T - position[first] if len(contacts) else np.zeros((0, d))
    if ellipses and len(contacts):
        normal = np.array([[float(contact["n" + a]) for a in axes] for contact in contacts])
    else:
        normal = branch / np.linalg.norm(branch, axis=1, keepdims=True)
    force = np.array([float(contact["fn"]) for contact in contacts])
    return State(str(path), d, cell, position, radius, axes_of, angle, ellipses, first, branch, normal, force)


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))
