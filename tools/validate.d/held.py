"""Held stresses at dt = 0 through avalanches: held.py RVELAB WORK RESULTS [--count N] [--before RVELAB] [RECIPE...].

N specimens of each recipe (default: 20, of spheres 5), drained biaxial or triaxial compression at three pressures. For
each recipe: records, those off by more than loading.held_tolerance, largest error over the tolerance, tests that ended
early, sub-steps in all and in the worst record, friction angle at the peak (mean and standard deviation of all tests).
With --before the same by another build, which then makes the specimens. Then the other tests that hold a stress or the
volume, on three specimens of each of their recipes (--no-others: not).

Bars: no record off by more than the tolerance, no volume that should stay off by more than 1e-9, no test that ended early.
"""
import argparse

import numpy as np

import harness
from harness import degrees_of, once, packed, records, run, sets, work

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
    return work / name if name.endswith(".toml") else name


def specimens(program, name, count):
    """Made by `program`: those that this one refuses are left out."""
    recipe, settings, _ = RECIPES[name]
    made = []
    for seed in range(1, 1 + (1 if name == "regular" else count)):
        file = work / f"{name}_{seed}.h5"
        try:
            if program == harness.program:
                packed(path_of(recipe), file.stem, f"pack.seed={seed}", *settings, options=("--threads", 1))
            else:
                once(file, program, name, make=lambda out: run(program, "pack", path_of(recipe), "-o", out,
                                                               "--threads", 1,
                                                               *sets(f"pack.seed={seed}", *settings)))
        except SystemExit as refused:
            print(f"# {name} {seed}: {str(refused)[-200:]}", flush=True)
            continue
        # A family is a file for each depth: here the least deep.
        made.append(file if file.exists() else min(work.glob(f"{name}_{seed}_*Pa.h5"),
                                                   key=lambda each: int(each.stem.split("_")[-1][:-2])))
    return made


def test(program, protocol, specimen, settings):
    """Held errors (where the volume is to stay: its own, in units that allow 1e-9), sub-steps, peak friction angle in
    degrees, and how it ended."""
    out = work / "R.h5"
    out.unlink(missing_ok=True)
    done = run(program, "run", protocol, "--specimen", specimen, "-o", out, "--force", *sets(*settings), codes=None)
    if not out.exists():
        return np.zeros(0), np.zeros(0), np.nan, done.stderr
    errors, substeps, stage, gradient, stress = records(out, "held_error", "substeps", "stage", "deformation_gradient",
                                                        "stress_Pa").values()
    if protocol in KEPT_VOLUME:
        last = stage == stage[-1]
        volume = abs(np.linalg.det(gradient) - 1)
        errors[last] = np.maximum(errors, volume * TOLERANCE / 1e-9)[last]
    plane = np.ptp(stress[:, 2, 2]) == 0
    principal = np.linalg.eigvalsh(-stress[:, :2, :2] if plane else -stress)
    major, minor = principal[:, -1], principal[:, 0]
    peak = int(np.argmax(major - minor))
    return errors, substeps, degrees_of(major[peak], minor[peak]), "" if done.returncode == 0 else done.stderr


def row(head, files, made, angles=False):
    """Prints a row of tests (what test() gives of each); how many records and tests missed a bar."""
    e, s = np.concatenate([each[0] for each in made]), np.concatenate([each[1] for each in made])
    phi, ended = [each[2] for each in made], [each[3].strip()[-300:] for each in made if each[3]]
    off = int((e > TOLERANCE).sum())
    print(f"{head} {len(files):4} {len(e):8} {off:5} {e.max() / TOLERANCE:10.4g} {len(ended):6} {s.sum():10.4g} "
          + (f"{s.max():10.4g} {np.nanmean(phi):8.2f} +- {np.nanstd(phi, ddof=1):5.2f}" if angles else f"{s.max():12.4g}"), flush=True)
    for text in ended:
        print(f"#   {text}")
    return off + len(ended)


def line(program, name, files, label):
    protocol = "triaxial" if name in SPHERES else "biaxial"
    return row(f"{name:13} {label:7} ", files, [test(program, protocol, file, [f"test.pressure_Pa={pressure}"])
                                                for file in files for pressure in RECIPES[name][2]], True)


def others(program):
    print("test                   recipe  specs  records   off  error/tol  ended  sub-steps  in a record")
    missed = 0
    for protocol, recipes, pressure, settings in OTHERS:
        for name in recipes:
            files = specimens(program, name, 3)
            missed += row(f"{protocol:22} {name:8}", files,
                          [test(program, protocol, file, [f"test.pressure_Pa={pressure}", *settings]) for file in files])
    return missed


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--before")
    parser.add_argument("--others", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("recipes", nargs="*", default=list(RECIPES))
    given = parser.parse_intermixed_args(harness.words)
    harness.write(work / "sand.toml", SAND)
    print("recipe        build   specs  records   off  error/tol  ended  sub-steps  in a record  friction angle")
    missed = 0
    for name in given.recipes:
        files = specimens(given.before or harness.program, name,
                          min(given.count, 5) if name in SPHERES else given.count)
        if given.before:
            line(given.before, name, files, "before")
        missed += line(harness.program, name, files, "after" if given.before else "")
    return missed + (others(harness.program) if given.others else 0)


if __name__ == "__main__":
    harness.main(main)
