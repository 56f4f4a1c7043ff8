#!/usr/bin/python3
"""Critical state: critical_state.py RVELAB WORK [FIGURE].

Ten dense and ten loose specimens of 1000 discs (preparation friction 0 and 0.9), sheared at constant normal stress of
10 kPa to gamma = 5; means of void ratio and q/p over gamma = 2 to 5. Bars: dense and loose differ by less than two
standard errors of the difference; each standard error at most 1 % of the mean.
"""
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np

SEEDS = range(1, 11)
RECIPE = """[pack]
name = "discs"
shape = "disc"
number = 1000
[grains]
smallest_radius_m = 3e-3
largest_radius_m = 7e-3
[target]
pressure_Pa = 10e3
[preparation]
friction = 0.0
[contact]
law = "linear"
[[material]]
name = "grain"
young_modulus_Pa = 80e6
stiffness_ratio = 0.5
friction = 0.5
"""


def test(program, work, kind, seed):
    specimen, records = work / f"{kind}_{seed}.h5", work / f"R_{kind}_{seed}.h5"
    friction = {"dense": 0.0, "loose": 0.9}[kind]
    if not specimen.exists():
        subprocess.run([program, "pack", work / "discs.toml", "-o", specimen, "--set", f"pack.seed={seed}", "--set",
                        f"preparation.friction={friction}"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([program, "run", "protocols/simple_shear_drained.toml", "--specimen", specimen, "-o", records, "--resume",
                    "--set", "test.pressure_Pa=10e3"], check=True, stdout=subprocess.DEVNULL)
    return means(records)


def means(records):
    with h5py.File(records) as file:
        strain, stress = file["records/strain"][:], file["records/stress_Pa"][:]
        void_ratio, held = file["records/void_ratio"][:], file["records/target_held"][:]
    p = -0.5 * (stress[:, 0, 0] + stress[:, 1, 1])
    q = np.hypot(0.5 * (stress[:, 0, 0] - stress[:, 1, 1]), 0.5 * (stress[:, 0, 1] + stress[:, 1, 0]))
    late = (strain >= 2) & (strain <= 5 + 1e-9)
    return void_ratio[0], void_ratio[late].mean(), (q / p)[late].mean(), 1 - held.mean()


def main():
    program, work = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    (work / "discs.toml").write_text(RECIPE)
    tests = [(kind, seed) for seed in SEEDS for kind in ("dense", "loose")]
    with ThreadPoolExecutor(2) as pool:
        rows = dict(zip(tests, pool.map(lambda each: test(program, work, *each), tests)))
    print("specimen  e at start   e         q/p      flagged")
    for (kind, seed), row in sorted(rows.items()):
        print(f"{kind} {seed:3d}  {row[0]:.4f}      {row[1]:.5f}   {row[2]:.4f}   {row[3]:.2%}")
    failed = max(row[3] for row in rows.values()) > 0.01
    print("\nquantity  dense +- se          loose +- se          difference/se   largest se/mean")
    for k, name in ((1, "e"), (2, "q/p")):
        both = [np.array([rows[kind, seed][k] for seed in SEEDS]) for kind in ("dense", "loose")]
        mean = [values.mean() for values in both]
        error = [values.std(ddof=1) / np.sqrt(len(values)) for values in both]
        difference = abs(mean[0] - mean[1]) / np.hypot(*error)
        relative = max(error[0] / mean[0], error[1] / mean[1])
        good = difference < 2 and relative <= 0.01
        failed = failed or not good
        print(f"{name:8}  {mean[0]:.5f} +- {error[0]:.5f}   {mean[1]:.5f} +- {error[1]:.5f}   {difference:8.2f}   "
              f"{relative:14.2%}   {'ok' if good else 'MISSED'}")
    if failed:
        sys.exit("critical state: bars missed")


main()
