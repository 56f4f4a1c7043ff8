#!/usr/bin/python3
"""Liquefaction resistance: liquefaction.py RVELAB WORK [FIGURE].

Stress-controlled cyclic simple shear at constant volume of the loose reference packing `soft` (20 kPa), until p
is under 2 % of its start: cycles against the stress ratio, as table and curve. Bar: at least
five stress ratios liquefy within 200 cycles, the more stress the fewer the cycles; below them a test may run out, since
small stress cycles shake a packing down. Beside each the cycles and grain-steps of the same test to the tolerances,
instead of the protocol's unbalanced ratio.
"""
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np

DATA = pathlib.Path("tests/data/yade/soft")
RATIOS = (0.08, 0.10, 0.12, 0.14, 0.16, 0.20)


def test(program, work, ratio, name, *more):
    records = work / f"R_{ratio}_{name}.h5"
    subprocess.run([program, "run", "protocols/cyclic_liquefaction.toml", "--specimen", work / "soft.h5", "-o", records,
                    "--force", "--set", f"stage.cycles.reverse_at_Pa={ratio * 20e3!r}", *more], check=True,
                   stdout=subprocess.DEVNULL)
    with h5py.File(records) as file:
        rows = file["records/stage"][:] == file["records/stage"][:].max()
        strain, stress = file["records/strain"][rows], file["records/stress_Pa"][rows]
        steps = int(np.ravel(file["test/grain_steps"][()])[0])
        determinant = np.linalg.det(file["records/deformation_gradient"][rows])
    p = -0.5 * (stress[:, 0, 0] + stress[:, 1, 1])
    direction = np.sign(np.diff(strain))
    return (0.5 * np.count_nonzero(np.diff(direction)), p.min() / p[0], np.abs(strain).max(),
            np.abs(determinant - 1).max(), steps)


def main():
    program, work = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    subprocess.run([program, "import", f"{DATA}.particles.csv", f"{DATA}.contacts.csv", f"{DATA}.json", "-o",
                    work / "soft.h5", "--force"], check=True, stdout=subprocess.DEVNULL)
    with ThreadPoolExecutor(2) as pool:
        rows = list(pool.map(lambda ratio: test(program, work, ratio, "ratio"), RATIOS))
        exact = ["--set", "solver.target_unbalanced=0"]
        others = list(pool.map(lambda ratio: test(program, work, ratio, "tolerances", *exact), RATIOS))
    print("stress ratio   cycles   lowest p/p0   largest |gamma|   det F - 1  grain-steps   by tolerances: cycles  grain-steps")
    for ratio, (cycles, lowest, largest, volume, steps), other in zip(RATIOS, rows, others):
        print(f"{ratio:12.2f} {cycles:8.1f} {lowest:13.4f} {largest:17.4f}     {volume:.1e} {steps:12.3g} "
              f"{other[0]:23.1f} {other[4]:12.3g}")
    if len(sys.argv) > 3:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        figure, axes = plt.subplots(figsize=(5.6, 4), dpi=150)
        out = [row[1] >= 0.02 for row in rows]
        axes.semilogx([max(row[0], 0.5) for row in rows], RATIOS, "-", color="tab:blue", lw=0.8)
        for ratio, row, runs_out in zip(RATIOS, rows, out):
            axes.plot(max(row[0], 0.5), ratio, ">" if runs_out else "o", color="tab:blue", mfc="w" if runs_out else None)
        axes.plot([], [], ">", color="tab:blue", mfc="w", label="not within 200 cycles")
        axes.legend(frameon=False)
        axes.set_xlabel("cycles to p < 2 % of its start")
        axes.set_ylabel("stress ratio $\\tau/p_0$")
        axes.grid(color="0.9")
        figure.savefig(sys.argv[3], bbox_inches="tight")
        print(f"figure: {sys.argv[3]}")
    cycles = [row[0] for row in rows]
    liquefied = [row[1] < 0.02 for row in rows]
    good = sum(liquefied) >= 5 and liquefied == sorted(liquefied) and all(np.diff(cycles) <= 0)
    good = good and all(row[3] <= 1e-12 for row in rows)
    if not good:
        sys.exit("liquefaction: bars missed")


main()
