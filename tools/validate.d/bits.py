#!/usr/bin/python3
"""Hashes of results over all test data, so that a change that must move no bit can be told from one that does.

    tools/validate.d/bits.py PROGRAM WORK [BITS.json] [--write]

Runs imports of all packings, the calibration over five pressures, triaxial, oedometer, undrained and shear tests, tests
at a rate with and without dashpot, two packings and the quick cases of tests/extreme; hashes grains, contacts, cell and records as
the files hold them. With BITS.json the hashes are compared (exit code 1 if one differs), with --write they are kept
there. Equal on every instruction set and number of threads; not across versions that change an answer on purpose.
"""
import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys

import h5py
import numpy as np

DATA = pathlib.Path(__file__).resolve().parents[2] / "tests" / "data"
STATE = ("cell/lattice_m", "cell/rotation", "grains/id", "grains/position_m", "grains/velocity", "grains/spin",
         "contacts/i", "contacts/j", "contacts/image", "contacts/tangential_force_N", "contacts/rolling_moment_N_m",
         "contacts/last_root_overlap_m0_5", "bonds/i", "bonds/j", "bonds/broken", "bonds/released_energy_J", "bonds/shear_force_N",
         "bonds/bending_moment_N_m", "bonds/twisting_moment_N_m", "bridges/i", "bridges/j", "bridges/image", "bridges/pull_0")
RECORDS = ("strain", "deformation_gradient", "stress_Pa", "void_ratio", "coordination_number", "sliding_fraction",
           "fabric_anisotropy", "unbalanced_force_ratio", "inertial_number", "held_error", "substeps")

DENSE = "yade/dense"
# Name, protocol, packing, keys.
TESTS = [
    ("triaxial", "triaxial", "yade/hertz", ["stage.compression.to_strain=0.005"]),
    ("biaxial without rolling", "biaxial", "yade/noroll", ["stage.compression.to_strain=0.01"]),
    ("biaxial of soft grains", "biaxial", "yade/soft", ["stage.compression.to_strain=0.01"]),
    ("biaxial, energy balance", "biaxial", DENSE, ["stage.compression.to_strain=0.003", "solver.energy_balance=true"]),
    ("undrained", "biaxial_undrained", DENSE, []),
    ("oedometer", "oedometer", "yade/medium", []),
    ("simple shear, quasi-static", "simple_shear", DENSE, ["stage.shear.to_strain=0.05"]),
    ("simple shear, spheres", "simple_shear", "yade/hertz", ["stage.shear.to_strain=0.01"]),
    ("simple shear at a rate", "simple_shear", DENSE,
     ["stage.shear.to_strain=0.02", "loading.mode=at_rate", "loading.inertial_number=1e-2"]),
    ("spheres at a rate, restitution", "simple_shear", "yade/hertz",
     ["stage.shear.to_strain=0.005", "loading.mode=at_rate", "loading.inertial_number=1e-2",
      "damping.dashpot=restitution", "damping.restitution=0.5"]),
    ("held stress at a rate", "simple_shear_drained", DENSE,
     ["stage.shear.to_strain=0.01", "loading.mode=at_rate", "loading.inertial_number=1e-2"]),
    ("probe", "probe", DENSE, []),
    ("cemented discs that break", "biaxial_cemented", DENSE, ["stage.compression.to_strain=0.01"]),
    ("cemented spheres", "triaxial_cemented", "yade/hertz", ["stage.compression.to_strain=0.002"]),
    ("moist spheres", "unsaturated_shear", "yade/hertz",
     ["test.pressure_Pa=100e3", "stage.water.suction_Pa=200", "stage.compression.to_strain=0.002"]),
]


def hash_of(path, group):
    """Of what a file holds of a state (under `group`) and of its records."""
    total = hashlib.sha256()
    with h5py.File(path, "r") as file:
        names = [group + name for name in STATE] + ["records/" + name for name in RECORDS]
        for name in names:
            if name in file:
                total.update(name.encode())
                total.update(np.ascontiguousarray(file[name][()]).tobytes())
    return total.hexdigest()[:16]


class Program:
    def __init__(self, path, work):
        self.path, self.work = str(pathlib.Path(path).resolve()), pathlib.Path(work).resolve()
        self.work.mkdir(parents=True, exist_ok=True)

    def __call__(self, *arguments):
        done = subprocess.run([self.path, *map(str, arguments)], cwd=self.work, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"bits: rvelab {' '.join(map(str, arguments))}: {done.stderr}")
        return done.stdout


def imported(program):
    """All packings with particles and contacts of YADE, by name."""
    packings = {}
    for particles in sorted(DATA.glob("yade/*.particles.csv")):
        stem = str(particles).removesuffix(".particles.csv")
        name = f"yade/{pathlib.Path(stem).name}"
        if name == "yade/soft100":  # beyond the limit of overlaps: refused
            continue
        packings[name] = program.work / (pathlib.Path(stem).name + ".h5")
        program("import", particles, stem + ".contacts.csv", stem + ".json", "-o", packings[name], "--force")
    return packings


def hashes(program):
    packings = imported(program)
    for name, path in packings.items():
        yield f"import {name}", hash_of(path, "")
    for name, protocol, packing, keys in TESTS:
        settings = [part for key in keys for part in ("--set", key)]
        program("run", protocol, "--specimen", packings[packing], "-o", "R.h5", "--force", *settings)
        yield name, hash_of(program.work / "R.h5", "specimen/")
    program("calibrate", "biaxial", "--specimen", packings[DENSE], "-o", "records", "--force")
    for path in sorted((program.work / "records").glob("*.h5")):
        yield f"calibrate {path.stem}", hash_of(path, "specimen/")
    for recipe in ("pack_dense", "pack_loose"):
        program("pack", recipe, "-o", "P.h5", "--force")
        yield recipe, hash_of(program.work / "P.h5", "")
    extreme = program.work / "extreme.json"
    subprocess.run([str(pathlib.Path(program.path).with_name("test_extreme")), "the matrix"], stdout=subprocess.DEVNULL,
                   env={**os.environ, "RVELAB_CASES": "quick", "RVELAB_PATIENCE": "10", "RVELAB_JSON": str(extreme)})
    for case in json.loads(extreme.read_text())["cases"]:
        if "hash" in case:
            yield f"stress-test {case['name']}", f"{case['hash']}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("work")
    parser.add_argument("kept", nargs="?", help="file of hashes")
    parser.add_argument("--write", action="store_true", help="keep the hashes there instead of comparing")
    options = parser.parse_args()
    found = dict(hashes(Program(options.program, options.work)))
    if options.write or not options.kept:
        text = json.dumps(found, indent=1) + "\n"
        pathlib.Path(options.kept).write_text(text) if options.kept else print(text, end="")
        sys.exit(0)
    kept = json.loads(pathlib.Path(options.kept).read_text())
    differing = [name for name in kept if found.get(name) != kept[name]]
    for name in differing:
        print(f"{name}: {kept[name]} before, {found.get(name, 'missing')} now")
    new = [name for name in found if name not in kept]
    print(f"{len(kept)} results, {len(differing)} differ" + (f"; new: {', '.join(new)}" if new else ""))
    sys.exit(len(differing) > 0)
