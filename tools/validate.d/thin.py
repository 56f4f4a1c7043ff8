#!/usr/bin/python3
"""Cells under large strain: thin.py RVELAB WORK [PART...] [RECIPE...]. Parts: rate, rest, pure (default: all).

rate: a specimen of every recipe (or of those named) sheared v_x(y), in space v_x(z), to gamma = 1e4 at dt > 0: of pack_regular
and four recipes of discs as it is, of the others 100 discs or 200 spheres, whose cell is thin the sooner. rest: to 300 at dt = 0
by the loosest tolerance, 100 discs or 200 spheres. Printed: records, those of a thin cell (a height below four mean
diameters), heights of the last cell over the mean diameter.
pure: upright and oriented specimens of discs, compressed at constant volume to a Hencky strain of 2: five each of pack_loose at
dt > 0 and at dt = 0, at dt = 0 of pack_medium and pack_dense 20 each of 400 grains and ten of 1600: heights of the upright
cell, p and sin phi by strain, of the records that are not flagged as thin; which are.

Bars: no thin cell in simple shear. In pure shear every record of a thin cell is flagged and told, and p and sin phi of
the others are within three standard errors of those of oriented cells; below ten mean diameters
they are off, and the run tells of a low cell.
"""
import pathlib
import subprocess
import sys
import time

import h5py
import numpy as np

PROTOCOLS = pathlib.Path("protocols").resolve()
RECIPES = sorted(path.stem for path in PROTOCOLS.glob("pack_*.toml"))
WHOLE = ("pack_dense", "pack_medium", "pack_loose", "pack_soft")
SPHERES = ("pack_hertz", "pack_mixture", "pack_qu282", "pack_qu371", "pack_qu548", "pack_qu738")
# Grains of the Qu recipes have no pressure to give a rate by: v = rate d is 1 m/s.
SHEAR = """[test]
name = "large strain"
[loading]
mode = "{mode}"
{rate}
[solver]
max_overlap_ratio = 1
relative_tolerance = 1
[[stage]]
kind = "{kind}"
to_strain = {strain}
record_every = {every}
{more}
"""


def call(*words):
    answer = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    return answer.returncode, answer.stderr.strip()


def packed(program, work, recipe, *settings):
    file = work / ("_".join([recipe, *(each.split("=")[1] for each in settings)]) + ".h5")
    if not file.exists():
        code, errors = call(program, "pack", PROTOCOLS / f"{recipe}.toml", "-o", file, "--threads", 1,
                            *(word for each in settings for word in ("--set", each)))
        if code != 0:
            raise SystemExit(f"thin: {recipe}: {errors[-300:]}")
    return sorted(work.glob(file.stem + "_*Pa.h5"))[:1][0] if not file.exists() else file


def run(program, work, specimen, **scene):
    """The records, the last specimen's heights over the mean diameter, and what was said."""
    test, out = work / "test.toml", work / "R.h5"
    test.write_text(SHEAR.format(**scene))
    code, errors = call(program, "run", test, "--specimen", specimen, "-o", out, "--force")
    if not out.exists():
        return None, None, errors, errors
    with h5py.File(out) as file:
        records = {name: file["records"][name][:] for name in ("strain", "stress_Pa", "cell_thin")}
        lattice, radius = file["specimen/cell/lattice_m"][:], file["specimen/grains/radius_m"][:]
    inverse = np.linalg.inv(lattice)
    dimension = 2 if np.ptp(records["stress_Pa"][:, 2, 2]) == 0 else 3
    out.unlink()
    return records, 1 / np.linalg.norm(inverse, axis=1)[:dimension] / (2 * radius.mean()), errors if code else "", errors


def simple_shear(program, work, recipes, at_rate):
    print(f"simple shear at dt {'> 0 to 1e4' if at_rate else '= 0 to 300'}: recipe, grains, records, thin, last heights/d, seconds")
    missed = 0
    for recipe in recipes:
        number = [f"pack.number={200 if recipe in SPHERES else 100}"]
        if "\nvoid_ratio" in (PROTOCOLS / f"{recipe}.toml").read_text():
            number.append("target.void_ratio_tolerance=0.02")
        if recipe == "pack_regular" or (at_rate and recipe in WHOLE):
            number = []
        specimen = packed(program, work, recipe, *number)
        rate = "" if not at_rate else "rate_1_s = 5" if "qu" in recipe else "inertial_number = 0.3"
        begun = time.monotonic()
        records, heights, errors, _ = run(program, work, specimen, mode="physical" if at_rate else "quasi_static", rate=rate,
                                       kind="simple_shear", strain=1e4 if at_rate else 300, every=1 if at_rate else 0.1, more="")
        seconds = time.monotonic() - begun
        if records is None or errors:
            print(f"{recipe:14} {errors[-300:]}", flush=True)
            missed += 1
        if records is None:
            continue
        thin = int(records["cell_thin"].sum())
        print(f"{recipe:14} {number[0][12:] if number else 'all':4} {len(records['strain']):6} {thin:6}  "
              f"{' '.join(f'{each:6.2f}' for each in heights)} {seconds:8.0f}", flush=True)
        missed += thin > 0
    return missed


def pure_shear(program, work, at_rate, recipe="pack_loose", number=400, seeds=5):
    print(f"pure shear at constant volume, dt {'> 0' if at_rate else '= 0'}, {recipe}, {number} grains: Hencky strain; upright height over "
          "d; upright, oriented: records, thin, p, sin phi; p over that of oriented cells; differences over their standard errors")
    edges, found, heights = np.linspace(0, 2, 11), {}, []
    missed = told = to_tell = 0
    for cell in ("upright", "oriented"):
        found[cell] = []
        for seed in range(1, seeds + 1):
            size = [f"pack.number={number}"] if number != 400 else []
            specimen = packed(program, work, recipe, *size, f"pack.cell={cell}", f"pack.seed={seed}")
            records, last, errors, said = run(program, work, specimen, mode="physical" if at_rate else "quasi_static",
                                        rate="inertial_number = 0.1" if at_rate else "", kind="compression",
                                        strain=1 - np.exp(-2), every=0.0025, more='lateral = "constant_volume"')
            if records is None or errors:
                print(f"  {cell} {seed}: {errors[-300:]}", flush=True)
            if records is None:
                continue
            found[cell].append(records)
            if cell == "upright":
                heights.append(last[1] / (1 - records["strain"][-1]))
                told += ("the cell became" in said) + ("records are of a thin cell" in said)
                to_tell += int(min(last) < 10) + int(records["cell_thin"].any())
    for low, high in zip(edges[:-1], edges[1:]):
        height = np.mean(heights) * np.exp(-(low + high) / 2)
        line, means = f"  {low:.1f} to {high:.1f}  {height:5.1f}", {}
        for cell, runs in found.items():
            values, count, thin = [], 0, 0
            for records in runs:
                hencky = -np.log(1 - records["strain"])
                inside = (hencky > low) & (hencky <= high + 1e-9)
                count, thin = count + int(inside.sum()), thin + int((inside & records["cell_thin"]).sum())
                whole = inside & ~records["cell_thin"].astype(bool)
                if not whole.any():
                    continue
                stress = -records["stress_Pa"][whole][:, :2, :2]
                p = np.trace(stress, axis1=1, axis2=2) / 2
                q = np.hypot((stress[:, 1, 1] - stress[:, 0, 0]) / 2, stress[:, 0, 1])
                values.append((p.mean(), q.mean() / p.mean()))
            means[cell] = np.array(values)
            line += f"   {count:4} {thin:4}" + (" {:9.4g} {:6.3f}".format(*means[cell].mean(axis=0)) if values else 17 * " ")
        if all(len(each) > 1 for each in means.values()):
            of_upright, of_oriented = means["upright"].mean(axis=0), means["oriented"].mean(axis=0)
            error = np.sqrt(sum(each.var(axis=0, ddof=1) / len(each) for each in means.values()))
            apart = (of_upright - of_oriented) / error
            line += "   {:5.2f} {:5.1f} {:5.1f}".format(of_upright[0] / of_oriented[0], *apart)
            off = (abs(apart) > 3).any()
            line += "" if not off else " MISSED" if height >= 10 else " low"
            missed += bool(off and height >= 10)
        print(line, flush=True)
    print(f"  runs of upright cells that are told of as low, and as thin: {told} of {to_tell}", flush=True)
    return missed + (told < to_tell)


def main():
    program, work = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    recipes = [each for each in sys.argv[3:] if each in RECIPES] or RECIPES
    parts = [each for each in sys.argv[3:] if each not in RECIPES] or ["rate", "rest", "pure"]
    work.mkdir(parents=True, exist_ok=True)
    missed = 0
    if "pure" in parts:
        missed += pure_shear(program, work, True) + pure_shear(program, work, False)
        for recipe in ("pack_medium", "pack_dense"):
            missed += pure_shear(program, work, False, recipe, seeds=20)
            missed += pure_shear(program, work, False, recipe, 1600, 10)
    if "rate" in parts:
        missed += simple_shear(program, work, recipes, True)
    if "rest" in parts:
        missed += simple_shear(program, work, recipes, False)
    if missed:
        sys.exit("thin: bars missed")


main()
