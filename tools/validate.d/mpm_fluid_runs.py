"""Runs of saturated scenes and what is read of them. Used by mpm_fluid_scenes.py."""

import os

import h5py
import numpy as np

import harness
import mpm as scenes
from harness import columns, once, records, sets
from mpm import folder, frames, specimen


# Of the environment: threads of each run, more options of rvelab-mpm for single parts, seeds of the shaken soils.
THREADS = ["-j", os.environ["RVELAB_MPM_THREADS"]] if "RVELAB_MPM_THREADS" in os.environ else []
SOLIDS, WATER, GRAVITY = 2650.0, 1000.0, 9.81  # kg/m3, m/s2


def run(name, scene, *options):
    return scenes.run(name, scene, *options, *THREADS)


def with_options(options):
    """What a part was run with beside its scene."""
    return f"\n(with {' '.join(options)})" if options else ""


def watched(name):
    return columns(folder / name / "watched.csv")


def frame_at(name, time):
    """The frame next to that time; fields by name."""
    def time_of(path):
        with h5py.File(path) as file:
            return float(file["time_s"][0])
    found = min(frames(name), key=lambda path: abs(time_of(path) - time))
    with h5py.File(found) as file:
        return {key: file[key][()] for key in file if isinstance(file[key], h5py.Dataset)}


def costs(name):
    scenes.costs((folder / f"{name}.txt").read_text())


def cell_test(name, protocol, packed, *settings):
    """Strains (1 - F_yy) and stresses (Pa, compression positive, xx and yy) of the last stage of a test."""
    path = once(folder / f"{name}.h5", "run", protocol, "--specimen", folder / f"{packed}.h5", *sets(*settings))
    all_ = records(path, "stage", "stress_Pa", "strain")
    stage, stress, strain = all_["stage"], -all_["stress_Pa"], all_["strain"]
    last = stage == stage.max()
    return strain[last], stress[last][:, 0, 0], stress[last][:, 1,
                                                             1], {key: stage == key
                                                                  for key in np.unique(stage)}, stress, strain


def void_ratio(packed):
    with h5py.File(folder / f"{packed}.h5") as file:
        for name in ("records/void_ratio", "void_ratio"):
            if name in file:
                return float(np.ravel(file[name][()])[-1])
    printed = harness.rvelab("inspect", folder / f"{packed}.h5")
    return float(next(line for line in printed.splitlines() if line.startswith("void_ratio")).split()[1])


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


def elastic_scene(name, scene, edits, **moduli):
    return scenes.with_soil(name, scene, ELASTIC.format(**moduli), *edits)


# --- column -----------------------------------------------------------------------------------------------------------

VOID_RATIOS = {"dense": 0.21, "medium": 0.23, "loose": 0.24}


def family(soil, seed=1):
    """Names of the specimens of a geostatic family."""
    name = soil if seed == 1 else f"{soil}_seed{seed}"
    specimen(name, f"target.void_ratio={VOID_RATIOS[soil]}", f"pack.seed={seed}", recipe="pack_saturated")
    return [f"{name}_{p}Pa.h5" for p in (1645, 4935, 8225, 11515)]
