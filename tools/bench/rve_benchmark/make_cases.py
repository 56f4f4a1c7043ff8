#!/usr/bin/python3
"""Makes the cases: packings by rvelab, without friction, and their files.

usage: make_cases.py [CASE]...      (with PYTHONPATH=tools/python, RVELAB_LIBRARY or rvelab in the PATH)

Two sizes of grains, 5 and 3.5 mm, as many of each. Without friction and rolling a packing at rest has no tangential
forces: coordinates and radii say all of its state, and every code can start from it.
"""
import os
import subprocess
import sys
import tempfile

import numpy as np
import rvelab
from rvelab.program import program

import case as cases

LINEAR = {"kind": "linear", "density_kg_m3": 2650, "young_modulus_Pa": 3e8, "stiffness_ratio": 0.5, "friction": 0.5}
HERTZ = {"kind": "hertz_mindlin", "density_kg_m3": 2650, "young_modulus_Pa": 7e9, "poisson_ratio": 0.25, "friction": 0.5}
ROLLING = {"rolling_stiffness": 1, "rolling_friction": 0.05}
P = 100e3


def leg(gradient, records, held=()):
    return {"gradient": gradient, "records": records, **({"held_Pa": {key: -P for key in held}} if held else {})}


def diagonal(*values):
    return np.diag(values).tolist()


def shear(gamma):
    return [[0, gamma], [0, 0]]


CASES = {
    "disc_isotropic": dict(
        grains=100, seed=1, law=LINEAR, legs=[leg(diagonal(-5e-4, -5e-4), 5), leg(diagonal(2e-4, 2e-4), 7)],
        title="Isotropic compression and swelling, discs",
        sentence="Both sides of the cell shorten by 0.05 %, then lengthen to 0.02 % above the start."),
    "disc_biaxial": dict(
        grains=200, seed=2, law=LINEAR, legs=[leg(diagonal(0, -4e-3), 20, ["xx"])],
        title="Drained biaxial compression, discs, small strain",
        sentence="y shortens by 0.4 % while sigma_xx is held at -100 kPa."),
    "disc_biaxial_rolling": dict(
        grains=200, seed=11, specimens=4, law={**LINEAR, **ROLLING}, legs=[leg(diagonal(0, -0.04), 80, ["xx"])],
        windows=4, first=5, title="Drained biaxial compression, discs with rolling resistance, to 4 %",
        sentence="y shortens by 4 % while sigma_xx is held at -100 kPa; means over four specimens and windows of strain."),
    "disc_shear": dict(
        grains=200, seed=3, law=LINEAR, legs=[leg(shear(4.5e-3), 15)],
        title="Simple shear at constant volume, discs",
        sentence="F_xy grows to 0.45 %, all else is kept."),
    "disc_cyclic_rolling": dict(
        grains=100, seed=4, law={**LINEAR, **ROLLING},
        legs=[leg(shear(7e-4), 5), *[leg(shear(s * 7e-4), 10) for s in (-1, 1, -1, 1)]],
        title="Cyclic simple shear at constant volume, discs with rolling resistance",
        sentence="F_xy goes to 0.07 %, then four times to and fro between -0.07 % and 0.07 %."),
    "disc_at_rate": dict(
        grains=400, seed=5, law=LINEAR, rate=2.0, legs=[leg(diagonal(4e-3, -4e-3), 20)],
        title="Sudden pure shear at a rate, discs without damping",
        sentence="From rest in the moving frame, y shortens and x lengthens by 0.4 % at 2 1/s: waves, real masses."),
    "sphere_isotropic": dict(
        grains=150, seed=6, law=HERTZ, legs=[leg(diagonal(-5e-4, -5e-4, -5e-4), 5), leg(diagonal(2e-4, 2e-4, 2e-4), 7)],
        title="Isotropic compression and swelling, spheres",
        sentence="The sides of the cell shorten by 0.05 %, then lengthen to 0.02 % above the start."),
    "sphere_undrained": dict(
        grains=400, seed=7, law=HERTZ, legs=[leg(diagonal(1e-3, 1e-3, -2e-3), 20)],
        title="Triaxial compression at constant volume, spheres",
        sentence="z shortens by 0.2 %, x and y lengthen by 0.1 %."),
    "sphere_triaxial_rolling": dict(
        grains=200, seed=8, law={**HERTZ, **ROLLING}, legs=[leg(diagonal(0, 0, -2e-3), 20, ["xx", "yy"])],
        title="Drained triaxial compression, spheres with rolling resistance",
        sentence="z shortens by 0.2 % while sigma_xx and sigma_yy are held at -100 kPa."),
    "sphere_flow": dict(
        grains=200, seed=21, specimens=4, law={**HERTZ, "young_modulus_Pa": 7e8, "restitution": 0.7}, rate=100.0,
        legs=[leg(diagonal(0.045, 0.045, 0.045), 3), leg([[0.045, 0, 2.0], [0, 0.045, 0], [0, 0, 0.045]], 200)],
        windows=1, first=79,
        title="Dense flow in simple shear at a rate, spheres with dashpots",
        sentence="The cell is widened by 4.5 %, then F_xz grows to 2 at 100 1/s and constant volume; means over four "
                 "specimens and F_xz from 0.75 to 2."),
}


def packed(number, seed, law, dimension, folder):
    """A packing at P without friction in a rectangular cell: (cell, centres, radii)."""
    keys = {key: law[key] for key in law if key in ("density_kg_m3", "young_modulus_Pa", "stiffness_ratio", "poisson_ratio")}
    text = ["[pack]", 'name = "benchmark"', f'shape = "{"disc" if dimension == 2 else "sphere"}"', f"number = {number}",
            f"seed = {seed}", 'cell = "upright"', *(["thickness_m = 0.01"] if dimension == 2 else [])]
    for name, r in (("large", 5e-3), ("small", 3.5e-3)):
        text += ["[[grains]]", f'name = "{name}"', "share = 0.5", f"smallest_radius_m = {r}", f"largest_radius_m = {r * (1 + 1e-12)!r}"]
    text += ["[target]", f"pressure_Pa = {P}", "[preparation]", "friction = 0.0", "[contact]", f'law = "{law["kind"]}"',
             "[[material]]", 'name = "grain"', "friction = 0.0", *(f"{key} = {float(v)!r}" for key, v in keys.items())]
    with open(folder + "/recipe.toml", "w", encoding="utf-8") as out:
        out.write("\n".join(text) + "\n")
    rvelab.pack(folder + "/recipe.toml", folder + "/P.h5", overwrite=True)
    rve = rvelab.Rve(folder + "/P.h5")
    # Its shear stress was driven to zero: the cell is turned back into a rectangle, then p is corrected.
    lattice = np.array(rve.rotation) @ np.array(rve.lattice)
    straight = np.diag(np.diag(lattice))
    rve.apply(straight @ np.linalg.inv(lattice) - np.eye(3))
    held = {key: -P for key in cases.COMPONENTS[:dimension]}
    for _ in range(60):
        rve.relax(1e-7, 2_000_000)
        off = max(abs(rve.stress[i, i] / P + 1) for i in range(dimension))
        if off < 1e-5:
            break
        rve.apply_held(np.zeros((3, 3)), held, tolerance=1e-6)
    else:
        sys.exit(f"seed {seed}: the stress is off by {off:.1e} of p")
    rve.relax(1e-11, 5_000_000)
    lattice = np.array(rve.rotation) @ np.array(rve.lattice)
    if abs(lattice - np.diag(np.diag(lattice))).max() > 1e-12:
        sys.exit(f"seed {seed}: the cell is tilted")
    cell = np.diag(lattice)
    return cell, rve.positions % np.where(np.arange(3) < dimension, cell, 1.0), rve.radii


def toml_value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(float(value)) if not isinstance(value, int) else str(value)


def write(name, about):
    folder = cases.folder_of(name)
    os.makedirs(folder, exist_ok=True)
    dimension = len(about["legs"][0]["gradient"])
    text = ["[case]", f'title = "{about["title"]}"', f"dimension = {dimension}", f'sentence = "{about["sentence"]}"', "",
            "[law]", *(f"{key} = {toml_value(v)}" for key, v in about["law"].items()), "",
            "[path]", f"rate_1_s = {toml_value(about.get('rate', 0))}", ""]
    for one in about["legs"]:
        text += ["[[path.leg]]", *(f"{key} = {toml_value(v)}" for key, v in one.items()), ""]
    count = about.get("specimens", 1)
    for k in range(count):
        file = f"grains_{k + 1}.csv" if count > 1 else "grains.csv"
        with tempfile.TemporaryDirectory() as work:
            cell, x, r = packed(about["grains"], about["seed"] + k, about["law"], dimension, work)
        with open(os.path.join(folder, file), "w", encoding="utf-8") as out:
            out.write("id,x_m,y_m,z_m,r_m\n")
            for number, (centre, radius) in enumerate(zip(x.tolist(), r.tolist()), 1):
                centre = [*centre[:dimension], *([0.0] if dimension == 2 else [])]
                out.write(f"{number},{centre[0]!r},{centre[1]!r},{centre[2]!r},{round(radius, 9)!r}\n")
        text += ["[[specimen]]", f'grains = "{file}"', f"cell_m = {toml_value(cell.tolist())}", ""]
    text += ["[reference]", 'made_by = "not yet"']
    if "windows" in about:
        text += [f"windows = {about['windows']}", f"first_record = {about['first']}"]
    with open(os.path.join(folder, "case.toml"), "w", encoding="utf-8") as out:
        out.write("\n".join(text) + "\n")
    print(name, flush=True)


if __name__ == "__main__":
    for chosen in sys.argv[1:] or CASES:
        write(chosen, CASES[chosen])
    with open(cases.folder_of("order.txt"), "w", encoding="utf-8") as order:
        order.write("\n".join(CASES) + "\n")
