"""Large simple shear against LAMMPS: steady_state.py RVELAB WORK RESULTS.

Runs protocols/large_shear.toml from the starts of ../shared/reference/lammps/rve/init and holds the means over 4 <
gamma <= 10 against lammps/rve/steady_state.csv: contact pressure p, shear stress Pxz, trace of the Reynolds stress tr
R, and ratio = tr R / tr P, each within 4 sqrt(se^2 + se_own^2) at porosities 0.738, 0.548, 0.371; at 0.282 from random
starts within 5 %, or within 2 sqrt(se^2 + se_own^2) where two means of that scatter could not tell 5 % (the fcc start
has no unique steady state and is shown only). se: the larger of the standard errors of 12 blocks and between the runs.
The figure draws ratio against porosity.

Then protocols/complex_loading.toml from the first start of porosity 0.548: the volume is that of its velocity gradient to
1e-12, and Reynolds over contact stress falls as the spheres come closer.

At 0.282 tr R of one run wanders by a tenth, so each random start is sheared three times, twice with its spheres moved by
some 1e-9 m: before gamma = 4 chaos has made runs of their own of them. LAMMPS' mean there has a standard error of 3.3 %.
"""
import csv

import numpy as np

import harness
from harness import REFERENCE, bars, in_turn, once, records, results, row, sets, work

REFERENCE = REFERENCE / "lammps/rve"

CASES = {"n738": (0.738, "4 se"), "n548": (0.548, "4 se"), "n371": (0.371, "4 se"), "n282": (0.282, "5 %"),
         "fcc282": (0.282, "shown")}
BLOCKS = 12
RUNS = {case: [f"s{seed}" for seed in (1, 2, 3)] for case in CASES}
RUNS["n282"] += [f"s{seed}_r{again}" for again in (1, 2) for seed in (1, 2, 3)]


def start_of(name):
    """The start as LAMMPS had it, or moved: NAME is CASE_sSEED or CASE_sSEED_rNUMBER."""
    given, _, again = name.partition("_r")
    path = REFERENCE / "init" / f"{given}.csv"
    if not again:
        return path
    moved = work / f"{name}.csv"
    with open(path) as old, open(moved, "w") as new:
        new.write(old.readline())
        for line in old:
            number, x, rest = line.split(",", 2)
            new.write(f"{number},{float(x) + int(again) * 1e-9 * (int(number) % 7 - 3):.15f},{rest}")
    return moved


def make(name):
    specimen = once(work / f"{name}.h5", "import", start_of(name), "--cell", "2,2,2", "--material",
                    work / "grains.toml")
    # n282 starts with overlaps of a tenth of a diameter.
    return once(work / f"R_{name}.h5", "run", "large_shear", "--specimen", specimen,
                *sets("stage.shear.record_every=0.002", "solver.max_overlap_ratio=1"), resume=True)


def complex_loading():
    """Prints its table."""
    out = once(work / "R_complex_loading.h5", "run", "complex_loading", "--specimen", work / "n548_s1.h5", resume=True)
    found = records(out, "strain", "void_ratio", "deformation_gradient", "contact_stress_Pa", "reynolds_stress_Pa")
    strain, void_ratio = found["strain"], found["void_ratio"]
    volume = np.linalg.det(found["deformation_gradient"][-1])
    contact, reynolds = (-np.trace(found[f"{name}_stress_Pa"], axis1=1, axis2=2) for name in ("contact", "reynolds"))
    row(f"\ncomplex loading from n548: volume ratio {volume:.15f}, that of the flow {np.exp(-0.2):.15f} ",
        abs(volume - np.exp(-0.2)) <= 1e-12, good="")
    before = np.inf
    print("gamma     porosity  p, Pa      Reynolds/contact")
    for begin, end in ((1, 4), (4, 7), (7, 10)):
        inside = (strain > begin) & (strain <= end + 1e-9)
        ratio = reynolds[inside].mean() / contact[inside].mean()
        porosity = (void_ratio[inside] / (1 + void_ratio[inside])).mean()
        row(f"{begin:2} to {end:2}  {porosity:.3f}     {contact[inside].mean() / 3:8.1f}   {ratio:.4f} ",
            ratio < before, good="")
        before = ratio


def quantities(path):
    """Blocks of the four quantities, (BLOCKS, 4), Pa, compression positive."""
    strain, contact, reynolds = records(path, "strain", "contact_stress_Pa", "reynolds_stress_Pa").values()
    inside = (strain > 4) & (strain <= 10 + 1e-9)
    contact, reynolds = -contact[inside], -reynolds[inside]
    trace_p, trace_r = np.trace(contact, axis1=1, axis2=2), np.trace(reynolds, axis1=1, axis2=2)
    series = np.stack([trace_p / 3, contact[:, 2, 0], trace_r], axis=1)
    blocks = np.array([block.mean(axis=0) for block in np.array_split(series, BLOCKS)])
    return np.column_stack([blocks, blocks[:, 2] / (3 * blocks[:, 0])])


def allowed(rule, expected, error):
    """error: the standard error of the difference of two means."""
    return 4 * error if rule == "4 se" else max(0.05 * abs(expected), 2 * error)


@bars
def steady_row(case, quantity, mean, own, expected, se):
    """A row of the table and its verdict; fcc282, whose steady state is not unique, is shown beside 5 %."""
    rule = CASES[case][1]
    bound = 0.05 * abs(expected) if rule == "shown" else allowed(rule, expected, np.hypot(se, own))
    off = abs(mean - expected)
    row(f"{case:7} {quantity:8} {mean:13.6g} {own:12.3g} {expected:12.6g} {se:12.3g} {off / abs(expected):9.2%} "
        f"{bound / abs(expected):8.2%} ", rule == "shown" or off <= bound, good="shown" if rule == "shown" else "ok",
        what=f"{case} {quantity}")


def main():
    (work / "grains.toml").write_text('[contact]\nlaw = "hertz_stiffness"\n[[material]]\nnormal_stiffness_N_m1_5 = 2e7\n')
    there = {}
    with open(REFERENCE / "steady_state.csv") as file:
        for line in csv.DictReader(file):
            there[line["case"], line["quantity"]] = (float(line["mean"]), float(line["se"]), line["per_seed_means"])
    names = [f"{case}_{run}" for case in CASES for run in RUNS[case]]
    files, curve = dict(zip(names, in_turn(make, names))), []
    print("case    quantity        rvelab       se_own       LAMMPS           se   deviation  allowed  verdict")
    for case, (porosity, rule) in CASES.items():
        seeds = np.array([quantities(files[f"{case}_{run}"]) for run in RUNS[case]])
        means = seeds.mean(axis=1)
        of_blocks = np.sqrt((seeds.var(axis=1, ddof=1) / BLOCKS).sum(axis=0)) / len(seeds)
        between = means.std(axis=0, ddof=1) / np.sqrt(len(seeds))
        mean, own = means.mean(axis=0), np.maximum(of_blocks, between)
        curve.append((porosity, case, mean[3], own[3], *there[case, "ratio"][:2]))
        for k, quantity in enumerate(("p", "Pxz", "trR", "ratio")):
            expected, se, per_seed = there[case, quantity]
            steady_row(case, quantity, mean[k], own[k], expected, se)
            if rule == "shown":
                print(f"        per seed: rvelab {' '.join(f'{m:.4g}' for m in means[:, k])}; LAMMPS {per_seed}")
    print("\nporosity  Reynolds/contact (rvelab)  (LAMMPS)   Qu et al.")
    paper = {"n738": "0.5", "n548": "at least one order below", "n371": "three orders below", "n282": "three orders below"}
    for porosity, case, value, own, expected, se in sorted(curve):
        print(f"{porosity:.3f} {case:7} {value:.4g} +- {own:.2g}   {expected:.4g} +- {se:.2g}   {paper.get(case, '-')}")
    complex_loading()
    draw(curve, results / "steady_state.png")


def draw(curve, path):
    plt = harness.pyplot()
    figure, axes = plt.subplots(figsize=(6, 4.2), dpi=150)
    random = [row for row in sorted(curve) if not row[1].startswith("fcc")]
    axes.errorbar([r[0] for r in random], [r[2] for r in random], [r[3] for r in random], fmt="o-", label="rvelab")
    axes.errorbar([r[0] for r in random], [r[4] for r in random], [r[5] for r in random], fmt="x", label="LAMMPS")
    fcc = [row for row in curve if row[1].startswith("fcc")]
    axes.plot([r[0] for r in fcc], [r[2] for r in fcc], "s", mfc="none", label="fcc start")
    axes.axhline(0.5, color="0.6", lw=0.8, ls="--")
    axes.axhline(1e-3, color="0.6", lw=0.8, ls="--")
    axes.annotate("Qu et al. at 0.738: 0.5", (0.3, 0.56), color="0.4", fontsize=8)
    axes.annotate("Qu et al. at 0.371 and 0.282: below 1e-3", (0.46, 6.5e-4), color="0.4", fontsize=8)
    axes.set(yscale="log", xlabel="porosity", ylabel="tr(Reynolds stress) / tr(contact stress)")
    axes.legend(frameon=False)
    figure.savefig(path, bbox_inches="tight")


if __name__ == "__main__":
    harness.main(main)
