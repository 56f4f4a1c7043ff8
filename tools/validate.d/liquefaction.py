"""Liquefaction resistance: liquefaction.py RVELAB WORK RESULTS.

Stress-controlled cyclic simple shear at constant volume of the loose reference packing `soft` (20 kPa), until p
is under 2 % of its start: cycles against the stress ratio, as table and curve. Bar: at least
five stress ratios liquefy within 200 cycles, the more stress the fewer the cycles; below them a test may run out, since
small stress cycles shake a packing down. Beside each the cycles and grain-steps of the same test to the tolerances,
instead of the protocol's unbalanced ratio.
"""
import h5py
import numpy as np

import harness
from harness import imported, in_turn, once, records, results, sets, work

RATIOS = (0.08, 0.10, 0.12, 0.14, 0.16, 0.20)


def test(ratio, name, *more):
    out = once(work / f"R_{ratio}_{name}.h5", "run", "cyclic_liquefaction", "--specimen", imported("soft"),
               *sets(f"stage.cycles.reverse_at_Pa={ratio * 20e3!r}", *more))
    strain, stress, gradient = records(out, "strain", "stress_Pa", "deformation_gradient", last=True).values()
    with h5py.File(out) as file:
        steps = int(np.ravel(file["test/grain_steps"][()])[0])
    determinant = np.linalg.det(gradient)
    p = -0.5 * (stress[:, 0, 0] + stress[:, 1, 1])
    direction = np.sign(np.diff(strain))
    return (0.5 * np.count_nonzero(np.diff(direction)), p.min() / p[0], np.abs(strain).max(),
            np.abs(determinant - 1).max(), steps)


def main():
    imported("soft")
    rows = list(in_turn(lambda ratio: test(ratio, "ratio"), RATIOS))
    others = list(in_turn(lambda ratio: test(ratio, "tolerances", "solver.target_unbalanced=0"), RATIOS))
    print("stress ratio   cycles   lowest p/p0   largest |gamma|   det F - 1  grain-steps   by tolerances: cycles  grain-steps")
    for ratio, (cycles, lowest, largest, volume, steps), other in zip(RATIOS, rows, others):
        print(f"{ratio:12.2f} {cycles:8.1f} {lowest:13.4f} {largest:17.4f}     {volume:.1e} {steps:12.3g} "
              f"{other[0]:23.1f} {other[4]:12.3g}")
    plt = harness.pyplot()
    figure, axes = plt.subplots(figsize=(5.6, 4), dpi=150)
    axes.semilogx([max(row[0], 0.5) for row in rows], RATIOS, "-", color="tab:blue", lw=0.8)
    for ratio, row in zip(RATIOS, rows):
        runs_out = row[1] >= 0.02
        axes.plot(max(row[0], 0.5), ratio, ">" if runs_out else "o", color="tab:blue", mfc="w" if runs_out else None)
    axes.plot([], [], ">", color="tab:blue", mfc="w", label="not within 200 cycles")
    axes.legend(frameon=False)
    axes.set(xlabel="cycles to p < 2 % of its start", ylabel="stress ratio $\\tau/p_0$")
    axes.grid(color="0.9")
    figure.savefig(results / "liquefaction.png", bbox_inches="tight")
    cycles = [row[0] for row in rows]
    liquefied = [row[1] < 0.02 for row in rows]
    good = sum(liquefied) >= 5 and liquefied == sorted(liquefied) and all(np.diff(cycles) <= 0)
    return not (good and all(row[3] <= 1e-12 for row in rows))


if __name__ == "__main__":
    harness.main(main)
