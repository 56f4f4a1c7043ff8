#!/usr/bin/python3
"""Held stresses at dt = 0 through avalanches: held.py RVELAB WORK [--count N] [--before RVELAB] [RECIPE...].

N specimens of each recipe (default: 20, of spheres 5), drained biaxial or triaxial compression at three pressures. For
each recipe: records, those off by more than loading.held_tolerance, largest error over the tolerance, tests that ended
early, sub-steps in all and in the worst record, friction angle at the peak (mean and standard deviation of all tests).
With --before the same by another build, which then makes the specimens. Then the other tests that hold a stress or the
volume, on three specimens of each of their recipes (--no-others: not).

Bars: no record off by more than the tolerance, no volume that should stay off by more than 1e-9, no test that ended early.
"""
import argparse
import pathlib
import subprocess
import sys

import h5py
import numpy as np

PROTOCOLS = pathlib.Path("protocols").resolve()
PRESSURES = ("50e3", "100e3", "200e3")
LOW = ("2e3", "5e3", "15e3")  # of families under their own weight, 0.25 to 1 m deep
SPHERES = ("hertz", "mixture", "qu282", "qu371")
TOLERANCE = 0.005  # loading.held_tolerance
# 400 discs of a sand by mass, d60/d10 2.1, with rolling friction: its loose states come apart in avalanches.
SAND = """[pack]
name = "sand"
shape = "disc"
number = 400
thickness_m = 4e-4
[grains]
grading = "tabulated"
passing_by = "mass"
radii_m = [0.10e-3, 0.15e-3, 0.275e-3, 0.31e-3, 0.5e-3]
passing = [0, 0.1, 0.5, 0.6, 1]
[target]
pressure_Pa = 100e3
void_ratio = 0.1874
[contact]
law = "linear"
rolling = true
[damping]
local = 0.1
[[material]]
name = "sand"
density_kg_m3 = 2650
young_modulus_Pa = 800e6
stiffness_ratio = 0.5
friction_angle_deg = 23
rolling_stiffness = 1
rolling_friction = 0.05
"""
# name: recipe, settings, pressures
RECIPES = {
    "sand": ("sand.toml", [], PRESSURES),
    "dense": ("pack_dense", [], PRESSURES),
    "medium": ("pack_medium", [], PRESSURES),
    "loose": ("pack_loose", [], PRESSURES),
    "soft": ("pack_soft", [], ("5e3", "10e3", "20e3")),
    "column": ("pack_column", [], LOW),
    "saturated": ("pack_saturated", [], LOW),
    "consolidation": ("pack_consolidation", [], PRESSURES),
    "bedded": ("pack_bedded", [], PRESSURES),
    "regular": ("pack_regular", [], PRESSURES),
    "hertz": ("pack_hertz", [], PRESSURES),
    "mixture": ("pack_mixture", [], PRESSURES),
    "qu282": ("pack_qu282", [], PRESSURES),
    "qu371": ("pack_qu371", [], PRESSURES),  # no contact at the start; so are qu548 and qu738
    "smooth": ("pack_dense", ["material.friction_angle_deg=6", "target.void_ratio_tolerance=0.02"], PRESSURES),
    "rough": ("sand.toml", ["material.friction_angle_deg=40", "material.rolling_friction=0.5"], PRESSURES),
    "sand_low": ("sand.toml", [], ("1e3", "2e3")),
    "free": ("sand.toml", ["contact.rolling=false"], PRESSURES),
    "low": ("sand.toml", ["pack.number=60", "target.void_ratio_tolerance=0.03"], ("2e3", "10e3")),
    "high": ("sand.toml", ["pack.number=100", "target.void_ratio_tolerance=0.03"], ("500e3", "1e6")),
}
# protocol, recipes, pressure, settings
OTHERS = (
    ("constant_p", ("sand", "dense", "loose"), "50e3", []),
    ("simple_shear_drained", ("sand", "dense", "loose"), "50e3", ["stage.shear.to_strain=0.3"]),
    ("biaxial_extension", ("sand",), "50e3", []),
    ("isotropic_compression", ("sand",), "50e3", []),
    ("biaxial_undrained", ("sand", "dense", "loose"), "100e3", []),
    ("biaxial_undrained", ("soft",), "20e3", []),
    ("cyclic_shear", ("sand", "dense", "loose"), "100e3", []),
    ("cyclic_liquefaction", ("soft",), "20e3", []),
    ("triaxial_extension", ("hertz",), "50e3", []),
    ("constant_p", ("hertz",), "50e3", []),
    ("triaxial_undrained", ("hertz",), "100e3", []),
)
KEPT_VOLUME = ("biaxial_undrained", "triaxial_undrained", "cyclic_shear", "cyclic_liquefaction")


def path_of(name):
    return name if name.endswith(".toml") else str(PROTOCOLS / f"{name}.toml")


def specimens(program, work, name, count):
    recipe, settings, _ = RECIPES[name]
    made = []
    for seed in range(1, 1 + (1 if name == "regular" else count)):
        file = work / f"{name}_{seed}.h5"
        # A family is a file for each depth: here the least deep.
        depths = f"{name}_{seed}_*Pa.h5"
        if not file.exists() and not any(work.glob(depths)):
            answer = subprocess.run([program, "pack", path_of(recipe), "-o", file, "--threads", "1", "--set", f"pack.seed={seed}",
                                     *(word for each in settings for word in ("--set", each))], cwd=work,
                                    capture_output=True, text=True)
            if answer.returncode != 0:
                print(f"# {name} {seed}: {answer.stderr.strip()[-200:]}", flush=True)
                continue
        made.append(file if file.exists() else min(work.glob(depths), key=lambda each: int(each.stem.split("_")[-1][:-2])))
    return made


def test(program, work, protocol, specimen, settings):
    """Held errors (where the volume is to stay: its own, in units that allow 1e-9), sub-steps, peak friction angle in
    degrees, and how it ended."""
    out = work / "R.h5"
    answer = subprocess.run([program, "run", path_of(protocol), "--specimen", specimen, "-o", out, "--force",
                             *(word for each in settings for word in ("--set", each))], capture_output=True, text=True)
    if not out.exists():
        return np.zeros(0), np.zeros(0), np.nan, answer.stderr
    with h5py.File(out) as file:
        records = file["records"]
        errors, substeps = records["held_error"][:], records["substeps"][:]
        if protocol in KEPT_VOLUME:
            last = records["stage"][:] == records["stage"][-1]
            volume = abs(np.linalg.det(records["deformation_gradient"][:]) - 1)
            errors[last] = np.maximum(errors, volume * TOLERANCE / 1e-9)[last]
        principal = np.linalg.eigvalsh(-records["stress_Pa"][:, :2, :2] if np.ptp(records["stress_Pa"][:, 2, 2]) == 0 else
                                       -records["stress_Pa"][:])
    major, minor = principal[:, -1], principal[:, 0]
    peak = int(np.argmax(major - minor))
    angle = np.degrees(np.arcsin((major[peak] - minor[peak]) / (major[peak] + minor[peak])))
    out.unlink()
    return errors, substeps, angle, "" if answer.returncode == 0 else answer.stderr


def line(program, work, name, files, label):
    protocol = "triaxial" if name in SPHERES else "biaxial"
    errors, substeps, angles, ended = [], [], [], []
    for file in files:
        for pressure in RECIPES[name][2]:
            e, s, angle, end = test(program, work, protocol, file, [f"test.pressure_Pa={pressure}"])
            errors.append(e), substeps.append(s), angles.append(angle)
            if end:
                ended.append(end.strip()[-300:])
    e, s = np.concatenate(errors), np.concatenate(substeps)
    off = int((e > TOLERANCE).sum())
    print(f"{name:13} {label:7} {len(files):5} {len(e):8} {off:5} {e.max() / TOLERANCE:10.4g} {len(ended):6} {s.sum():10.4g} "
          f"{s.max():10.4g} {np.nanmean(angles):8.2f} +- {np.nanstd(angles, ddof=1):5.2f}", flush=True)
    for text in ended:
        print(f"#   {text}")
    return off + len(ended)


def others(program, work):
    print("test                   recipe  specs  records   off  error/tol  ended  sub-steps  in a record")
    missed = 0
    for protocol, recipes, pressure, settings in OTHERS:
        for name in recipes:
            files = specimens(program, work, name, 3)
            made = [test(program, work, protocol, file, [f"test.pressure_Pa={pressure}", *settings]) for file in files]
            e, s = np.concatenate([each[0] for each in made]), np.concatenate([each[1] for each in made])
            ended, off = [each[3].strip()[-300:] for each in made if each[3]], int((e > TOLERANCE).sum())
            print(f"{protocol:22} {name:8} {len(files):4} {len(e):8} {off:5} {e.max() / TOLERANCE:10.4g} {len(ended):6} {s.sum():10.4g} "
                  f"{s.max():12.4g}", flush=True)
            for text in ended:
                print(f"#   {text}")
            missed += off + len(ended)
    return missed


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--before")
    parser.add_argument("--others", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("recipes", nargs="*", default=list(RECIPES))
    given = parser.parse_intermixed_args()
    program, work = str(pathlib.Path(given.program).resolve()), given.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    (work / "sand.toml").write_text(SAND)
    print("recipe        build   specs  records   off  error/tol  ended  sub-steps  in a record  friction angle")
    missed = 0
    for name in given.recipes:
        files = specimens(given.before or program, work, name, min(given.count, 5) if name in SPHERES else given.count)
        if given.before:
            line(given.before, work, name, files, "before")
        missed += line(program, work, name, files, "after" if given.before else "")
    if given.others:
        missed += others(program, work)
    if missed:
        sys.exit("held: bars missed")


main()
