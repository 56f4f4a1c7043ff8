"""Runs of saturated scenes and what is read of them. Used by mpm_fluid_scenes.py."""

import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../plot"))
from mpm import folder, rvelab, specimen  # noqa: E402
import mpm as scenes  # noqa: E402


# Of the environment: threads of each run, more options of rvelab-mpm for single parts, seeds of the shaken soils.
THREADS = ["-j", os.environ["RVELAB_MPM_THREADS"]] if "RVELAB_MPM_THREADS" in os.environ else []
SOLIDS, WATER, GRAVITY = 2650.0, 1000.0, 9.81  # kg/m3, m/s2


def run(name, scene, *options):
    return scenes.run(name, scene, *options, *THREADS)


def told(options):
    """What a part was run with beside its scene."""
    return f"\n(with {' '.join(options)})" if options else ""


def columns(path):
    names = path.open().readline().strip().split(",")
    return dict(zip(names, np.atleast_2d(np.genfromtxt(path, delimiter=",", skip_header=1)).T))


def watched(name):
    return columns(folder / name / "watched.csv")


def frames(name):
    return sorted((folder / name).glob("points_*.h5"))


def frame_at(name, time):
    """The frame next to that time; fields by name."""
    def time_of(path):
        with h5py.File(path) as file:
            return float(file["time_s"][0])
    found = min(frames(name), key=lambda path: abs(time_of(path) - time))
    with h5py.File(found) as file:
        return {key: file[key][()] for key in file if isinstance(file[key], h5py.Dataset)}


def costs(name):
    """The last lines that runs printed: steps, seconds, grain-steps."""
    print("    " + "\n    ".join((folder / f"{name}.txt").read_text().strip().splitlines()[-3:]))


def cell_test(name, protocol, packed, *settings):
    """Strains (1 - F_yy) and stresses (Pa, compression positive, xx and yy) of the last stage of a test."""
    path = folder / f"{name}.h5"
    if not path.exists():
        subprocess.run([rvelab, "run", protocol, "--specimen", folder / f"{packed}.h5", "-o", path,
                        *(word for each in settings for word in ("--set", each))],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with h5py.File(path) as file:
        stage = file["records/stage"][()]
        last = stage == stage.max()
        stress = -file["records/stress_Pa"][()][last]
        return file["records/strain"][()][last], stress[:, 0, 0], stress[:, 1, 1], {
            key: stage == key for key in np.unique(stage)}, -file["records/stress_Pa"][()], file["records/strain"][()]


def void_ratio(packed):
    with h5py.File(folder / f"{packed}.h5") as file:
        for place in ("records/void_ratio", "void_ratio"):
            if place in file:
                return float(np.ravel(file[place][()])[-1])
    told = subprocess.run([rvelab, "inspect", folder / f"{packed}.h5"], check=True, capture_output=True,
                          text=True).stdout
    return float(next(line for line in told.splitlines() if line.startswith("void_ratio")).split()[1])


# --- blocks beside the test of their specimen -------------------------------------------------------------------------


def mean_of(w, column, points=4):
    return np.mean([w[f"{k}.{column}"] for k in range(points)], axis=0)


ELASTIC = """[[material]]
name = "soil"
kind = "elastic"
density_kg_m3 = {density:g}
young_modulus_Pa = {young:g}
poisson_ratio = {poisson:g}

"""


MOHR_COULOMB = """[[material]]
name = "{name}"
kind = "mohr_coulomb"
density_kg_m3 = {density:g}
young_modulus_Pa = 5e6
poisson_ratio = 0.3
friction_angle_deg = {angle:g}

"""


def continuum_scene(name, scene, edits, material):
    """FOLDER/name.toml: a scene without its cases, a continuum in place of its grains, and further edits."""
    text = (scenes.ROOT / "protocols/mpm" / scene).read_text().split("\n[case.")[0]
    begin, end = text.index("[[material]]"), text.index("[[region]]")
    text = text[:begin] + material + text[end:]
    for old, new in edits:
        text = text.replace(old, new)
    path = folder / f"{name}.toml"
    path.write_text(text)
    return path.resolve()


def elastic_scene(name, scene, edits, **moduli):
    return continuum_scene(name, scene, edits, ELASTIC.format(**moduli))


# --- column -----------------------------------------------------------------------------------------------------------

VOID_RATIOS = {"dense": 0.21, "medium": 0.23, "loose": 0.24}


def family(soil, seed=1):
    """Names of the specimens of a geostatic family."""
    name = soil if seed == 1 else f"{soil}_seed{seed}"
    if not (folder / f"{name}_1645Pa.h5").exists():
        specimen(name, "--set", f"target.void_ratio={VOID_RATIOS[soil]}", "--set", f"pack.seed={seed}",
                 recipe="pack_saturated")
    return [f"{name}_{p}Pa.h5" for p in (1645, 4935, 8225, 11515)]
