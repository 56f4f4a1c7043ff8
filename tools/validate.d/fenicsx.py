"""tools/validate fenicsx_biaxial, fenicsx_footing: finite elements of dolfinx with RVEs of 100 discs in their points.

biaxial: the block of `python3 -m rvelab.fenicsx biaxial`, four specimens of pack_dense drawn by its points, to 4 % of
strain, over three meshes, without and with a length of 0.25 m. Asked: the block is no stronger than the mean of its
specimens alone, by their peak angles (two degrees below to one above; weak spots lower it); with the length the load
at the end is the same on the two finer meshes within 3 %; the band lies between Roscoe's and Coulomb's angle to five
degrees; the curve of two ranks is that of one to 0.1 % of strain, where the grains have not yet magnified the
round-off of the solver; three iterations an increment at most.

footing: `footing`, pack_medium, surcharge 100 kPa, to a settlement of a fifth of the width: rough over three meshes, and
smooth. Asked: the largest pressure lies between the formulas' by the angle at 15 % of strain and by that at the peak of
the same specimens. Beside it Mohr-Coulomb points on the same meshes, which tell what the meshes do.

wall: `wall`, active and passive, smooth and rough. Asked: the extreme K lies between those of Coulomb's wedge (of
Rankine where the wall is smooth) by the same two angles, with the wall friction of the reactions.

thousand: 968 points to 3 % of strain through the peak, on one rank and on two. Asked: the curves agree to 1e-9.

scaling: work, messages and bytes of a rank on 1 to 16 ranks, however many cores there are.

    fenicsx.py RVELAB WORK RESULTS biaxial|footing|wall|thousand|scaling"""
import json
import os
import re
import subprocess
import sys

import numpy as np

import harness
from harness import bars, columns, once, verdict, work

SETTINGS = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
            "OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMP_NUM_THREADS": "1"}


COUNTS = dict(iterations=r"iterations per increment ([\d.]+)", trials=r"trials of a point per increment ([\d.]+)",
              seconds=r"increment and RVE ([\d.e-]+)", work=r"grain-steps per increment and RVE ([\d.e+]+)",
              unmade=r"(\d+) of \d+ points never", points=r"ranks?, (\d+) points")


def case(name, first, *options, ranks=1, program=("-m", "rvelab.fenicsx")):
    """Columns of the curve of a run in WORK/NAME, and what it printed. first: the case; program: of Python."""
    def make(folder):
        command = [*(("mpirun", "-np", str(ranks)) if ranks > 1 else ()), sys.executable, *program,
                   first, "--frames", "0", "--keep", "0", *options, "-o", folder]
        environment = {**os.environ, **SETTINGS, "PYTHONPATH": str(harness.ROOT / "tools/python"),
                       "RVELAB_PROGRAM": str(harness.program),
                       "RVELAB_LIBRARY": str(harness.program.parents[1] / "lib/librvelab.so.1")}
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, env=environment, check=False)
        if done.returncode != 0:
            sys.exit(f"{name}: {done.stdout[-500:]}{done.stderr[-500:]}")
        (folder / "printed.txt").write_text(done.stdout)
    folder = once(work / name, "fenicsx", first, *options, ranks, make=make)
    return columns(folder / "curve.csv"), (folder / "printed.txt").read_text()


def number(pattern, text):
    return float(re.search(pattern, text).group(1))


def figures_of(curve, printed):
    ratio, t = curve["load_ratio"], curve["t"]
    patterns = dict(phi=r"phi ([-\d.]+)", psi=r"psi ([-\d.]+)", band=r"band at ([\d.]+)", **COUNTS)
    return dict(end=ratio[-1], peak=ratio.max(), at=t[ratio.argmax()], reached=t[-1],
                **{name: number(pattern, printed) for name, pattern in patterns.items()})


@bars
def judge_biaxial(runs, alone, together, apart):
    print("points  length  peak load ratio, at  at the end, at  iterations, trials an increment  "
          "grain-steps, s an increment and RVE  shared RVEs  band  Roscoe Arthur Coulomb")
    for name, each in runs.items():
        phi, psi = each["phi"], each["psi"]
        print(f"{each['points']:6.0f}  {name.split('_')[1]:>6}  {each['peak']:15.3f} {each['at']:.4f}  "
              f"{each['end']:8.3f} {each['reached']:.4f}  {each['iterations']:10.2f} {each['trials']:8.2f}  "
              f"{each['work']:25.3g} {each['seconds']:.1e}  {each['unmade']:17.0f}  "
              f"{each['band']:4.0f}  {45 + psi / 2:6.0f} {45 + (phi + psi) / 4:6.0f} {45 + phi / 2:7.0f}")
    for name, each in runs.items():
        if name.endswith("_0"):
            verdict(f"peak angle of {each['points']:.0f} points without a length", f"{each['phi']:.1f}",
                    f"{alone - 2:.1f} to {alone + 1:.1f}", alone - 2 <= each["phi"] <= alone + 1,
                    abs(each["phi"] - together) <= 1, "cells of 100 discs alone peak at different strains; the points of "
                    "the block strain together, and the mean stress of the same cells at one strain peaks at "
                    f"{together:.1f} degrees")
    for length in ("0", "0.25"):
        coarse, fine = runs[f"4_{length}"]["end"], runs[f"6_{length}"]["end"]
        what, found = f"load at the end, 128 over 288 points, length {length} m", f"{coarse / fine:.3f}"
        if length == "0":  # behind the peak the mesh decides, nothing is asked
            print(f"{what:<76} {found}")
        else:
            verdict(what, found, "0.97 to 1.03", abs(coarse / fine - 1) <= 0.03)
    fine = runs["6_0"]
    low, high = 45 + fine["psi"] / 2, 45 + fine["phi"] / 2
    verdict("band of 288 points without a length, degrees", f"{fine['band']:.0f}", f"{low - 5:.0f} to {high + 5:.0f}",
            low - 5 <= fine["band"] <= high + 5)
    most = max(each["iterations"] for each in runs.values())
    verdict("iterations an increment, the most of all runs", f"{most:.2f}", "<= 3", most <= 3)
    verdict("curves of one and two ranks to 0.1 % of strain, largest difference", f"{apart:.1e}", "<= 1e-6", apart <= 1e-6)


def peak_together(files):
    """Friction angle of the largest mean stress of the specimens, each in its own test, at one strain."""
    ratios, strain = [], np.linspace(0, 0.04, 81)
    for k, file in enumerate(files):
        out = once(work / f"alone_{k}.h5", "run", "biaxial", "--specimen", file,
                   *harness.sets("test.pressure_Pa=100e3", "stage.compression.to_strain=0.04"))
        found = harness.records(out, "strain", "stress_Pa", last=True)
        ratios.append(np.interp(strain, found["strain"], found["stress_Pa"][:, 1, 1] / found["stress_Pa"][:, 0, 0]))
    return harness.degrees_of(np.mean(ratios, axis=0).max(), 1)


def draw(curves):
    """Load over strain of all runs: RESULTS/fenicsx_biaxial.png."""
    plt = harness.pyplot()
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True, constrained_layout=True)
    for axis, length in zip(axes, ("0", "0.25")):
        for elements in (2, 4, 6):
            curve = curves[f"{elements}_{length}"]
            axis.plot(100 * curve["t"], curve["load_ratio"], label=f"{8 * elements ** 2} points")
        axis.set(xlabel="axial strain (%)", title="without a length" if length == "0" else f"length {length} m")
        axis.legend()
    axes[0].set_ylabel("axial stress over lateral pressure")
    figure.savefig(harness.results / "fenicsx_biaxial.png", dpi=120)


def biaxial():
    common = ("biaxial", "--grains", "100", "--to", "0.04")
    found = {f"{elements}_{length}": case(f"block_{elements}_{length}", *common, "--elements", elements, "--length", length)
             for elements in (2, 4, 6) for length in ("0", "0.25")}
    runs = {name: figures_of(*each) for name, each in found.items()}
    draw({name: each[0] for name, each in found.items()})
    files = sorted((work / "block_4_0").glob("specimen_*.h5"))
    words = [word for file in files for word in ("--specimen", file)]
    alone = harness.answer("calibrate", "biaxial", *words, "--pressures", "100e3")
    short = ("biaxial", "--grains", "100", "--elements", "2", "--to", "0.001", "--first", "1e-4")
    one, two = case("one", *short)[0], case("two", *short, ranks=2)[0]
    judge_biaxial(runs, alone["friction_angle_mean_deg"], peak_together(files), np.abs(one["load_ratio"] / two["load_ratio"] - 1).max())


@bars
def judge_footing(runs):
    print("points  base    elements under half of it  largest pressure over the surcharge, at  by the angle at 15 %  at the peak  "
          "iterations an increment")
    for each in runs.values():
        print(f"{each['points']:6.0f}  {each['base']:6}  {each['elements']:26}  {each['largest']:35.2f} {each['at']:.3f}  "
              f"{each['low']:19.1f}  {each['high']:11.1f}  {each['iterations']:23.2f}")
    print("\nMohr-Coulomb points on the same meshes (fenicsx_soil.py): largest pressure over the formula's by their angle; mobilised: the "
          "angle that RVEs have in the end which shear by more than 10 %\npoints  base    at 15 %: degrees, without dilation, "
          "associated   mobilised: degrees, largest pressure without dilation   of grains over it")
    for each in runs.values():
        print(f"{each['points']:6.0f}  {each['base']:6}  {each['phi']:15.1f} {each['plain'] / each['low']:17.2f} "
              f"{each['associated'] / each['low']:11.2f}   {each['mobilised']:18.1f} {each['as_mobilised']:35.2f}   "
              f"{each['largest'] / each['as_mobilised']:17.2f}")
    print()
    for each in runs.values():
        verdict(f"N_q, {each['base']} base, elements under half of it: {each['elements']}", f"{each['largest']:.2f}",
                f"{each['low']:.1f} to {each['high']:.1f}", each["low"] <= each["largest"] <= each["high"],
                abs(each["largest"] / each["as_mobilised"] - 1) <= 0.15,
                f"RVEs that shear by more than 10 % mobilise {each['mobilised']:.1f} degrees, not the {each['phi']:.1f} of biaxial tests "
                f"at 15 %; Mohr-Coulomb points of that angle without dilation carry {each['as_mobilised']:.1f} on this mesh "
                f"(of {each['phi']:.1f} degrees: {each['plain']:.1f}, so that the mesh adds {each['plain'] / each['low'] - 1:.0%})")


def mobilised(folder):
    """Friction angle, degrees, of the points of a checkpoint that shear by more than 10 %, weighted by that strain."""
    with np.load(folder / "checkpoint/host.npz") as file:
        sigma, F = file["sigma"], file["F"]
    stretch = np.linalg.svd(F, compute_uv=False)
    shear = np.log(stretch[:, 0] / stretch[:, 1])
    low, high = np.linalg.eigvalsh(sigma).T  # tension positive
    weight = np.where(shear > 0.1, shear, 0)
    return np.degrees(np.arcsin(np.sum(weight * (high - low)) / np.sum(weight * -(high + low))))


def footing():
    runs = {}
    for base, elements in (("rough", 1), ("rough", 2), ("rough", 3), ("smooth", 2)):
        name, smooth = f"{base}_{elements}", ["--smooth"] if base == "smooth" else []
        curve, printed = case(name, "footing", "--grains", "100", "--to", "0.2", "--first", "4e-3", "--elements", elements,
                              "--keep", "1000000", *smooth)
        formula = re.search(r"by the formula ([\d.]+) by .* \(peak\), ([\d.]+) by ([\d.]+)", printed)
        low, phi = float(formula.group(2)), float(formula.group(3))
        angle = mobilised(work / name)

        def soil(phi, psi):
            found = case(f"soil_{name}_{phi:.1f}_{psi:.1f}", f"{phi:.2f},{psi:.2f}", "--elements", elements, "--to", "0.1", "--first",
                         "4e-3", *smooth, program=(harness.ROOT / "tools/validate.d/fenicsx_soil.py",))
            return found[0]["pressure_ratio"].max()
        ratio = curve["pressure_ratio"]
        runs[name] = dict(base=base, elements=elements, largest=ratio.max(), at=curve["t"][ratio.argmax()], low=low,
                          high=float(formula.group(1)), phi=phi, plain=soil(phi, 0), associated=soil(phi, phi), mobilised=angle,
                          as_mobilised=soil(angle, 0), **{key: number(each, printed) for key, each in COUNTS.items()})
    judge_footing(runs)


@bars
def judge_wall(runs):
    print("wall             extreme K, at   wall friction  Rankine at the peak, at 15 %  Coulomb at the peak, at 15 %  angles   points")
    for name, each in runs.items():
        print(f"{name.replace('_', ', '):15}  {each['extreme']:9.3f} {each['at']:.3f}  {each['delta']:13.1f}  "
              f"{each['rankine'][0]:19.3f} {each['rankine'][1]:8.3f}  {each['coulomb'][0]:19.3f} {each['coulomb'][1]:8.3f}  "
              f"{each['angles'][0]:.1f} {each['angles'][1]:.1f}  {each['points']:5.0f}")
    for name, each in runs.items():
        low, high = sorted(each["coulomb"])
        what = "Rankine" if each["delta"] == 0 else "Coulomb"
        verdict(f"K, {name.replace('_', ', ')}, beside {what}'s by the angles at 15 % and at the peak", f"{each['extreme']:.3f}",
                f"{low:.3f} to {high:.3f}", low <= each["extreme"] <= high)


def wall():
    runs = {}
    for side in ("active", "passive"):
        for base in ("smooth", "rough"):
            name = f"{side}_{base}"
            options = ["--to", "0.03"] if side == "active" else ["--to", "0.06", "--first", "2e-3", "--passive"]
            curve, printed = case(f"wall_{name}", "wall", "--grains", "100", "--elements", "4", *options,
                                  *(["--rough"] if base == "rough" else []))
            K = curve["K"]
            at = K.argmin() if side == "active" else K.argmax()
            theory = {each: list(zip(*re.findall(r"([\d.]+) by ([\d.]+) degrees", re.search(f"{each} (.*)", printed).group(1))))
                      for each in ("Rankine", "Coulomb")}
            floats = lambda words: list(map(float, words))  # noqa: E731
            runs[name] = dict(extreme=K[at], at=curve["t"][at], delta=curve["wall_friction_deg"][at],
                              rankine=floats(theory["Rankine"][0]), coulomb=floats(theory["Coulomb"][0]),
                              angles=floats(theory["Coulomb"][1]), points=number(COUNTS["points"], printed))
    judge_wall(runs)


@bars
def judge_scaling(strong, weak, uneven):
    print("A step: an increment. Of a rank: grain-steps (mean; the busiest over it), messages and bytes of RVEs to other ranks (answers "
          "and work; moves), ghosts\n(degrees of freedom, 8 bytes each, once a solution and once a residual); MUMPS: entries and "
          "operations of a factorisation")
    for title, rows in (("one mesh", strong), ("as many points a rank", weak), ("a footing, RVEs move and stay", uneven)):
        print(f"\n{title}\nranks  points  iterations, trials  grain-steps  busiest  moved  messages  bytes: answers, work, moves  "
              "ghosts  MUMPS: unknowns, entries, operations")
        for each in rows:
            sent, volume = each["messages"], each["bytes"]
            print(f"{each['ranks']:5}  {each['points']:6}  {each['iterations']:10.2f} {each['trials']:7.2f}  {each['work']:11.3g}  "
                  f"{each['spread']:7.2f}  {each['moved']:5}  {sum(sent.values()):8.1f}  {volume['answers']:14.0f} {volume['work']:5.0f} "
                  f"{volume['moves']:6.0f}  {each['ghosts']:6}  {each['unknowns']:15} {each['factor_entries']:8} "
                  f"{each['factor_operations']:11.3g}")
    print()
    one, most = strong[0], strong[-1]
    verdict("grain-steps of a step, 16 ranks over one", f"{most['work'] * most['ranks'] / one['work']:.9f}", "1",
            most["work"] * most["ranks"] == one["work"])
    verdict("one mesh, busiest rank over the mean, the most", f"{max(each['spread'] for each in strong):.2f}", "<= 1.3",
            max(each["spread"] for each in strong) <= 1.3)
    verdict("a footing, busiest rank over the mean, RVEs move", f"{uneven[0]['spread']:.2f}", f"< {uneven[1]['spread']:.2f} (they stay)",
            uneven[0]["spread"] < uneven[1]["spread"])


def scaling():
    def counted(name, ranks, which, *options):
        _, printed = case(f"counts_{name}_{ranks}", which, "--grains", "50", *options, ranks=ranks,
                          program=(harness.ROOT / "tools/validate.d/fenicsx_counts.py",))
        return json.loads(printed.splitlines()[-1])
    block = lambda elements, ranks: counted(f"block_{elements}", ranks, "biaxial", "--elements", elements, "--to", "0.005")  # noqa: E731
    strong = [block(8, ranks) for ranks in (1, 2, 4, 8, 16)]
    weak = [block(*each) for each in ((2, 1), (3, 2), (4, 4), (6, 8))] + strong[-1:]
    uneven = [counted(f"footing{len(stays)}", 8, "footing", "--elements", "2", "--to", "0.04", "--first", "4e-3", *stays)
              for stays in ((), ("--no-balance",))]
    judge_scaling(strong, weak, uneven)


@bars
def judge_thousand(runs, apart):
    print("ranks  points  peak load ratio, at  at the end, at  iterations, trials an increment  "
          "grain-steps an increment and RVE  shared RVEs  busiest rank over the mean, moved")
    for ranks, each in runs.items():
        print(f"{ranks:>5}  {each['points']:6.0f}  {each['peak']:15.3f} {each['at']:.4f}  {each['end']:8.3f} "
              f"{each['reached']:.4f}  {each['iterations']:10.2f} {each['trials']:8.2f}  {each['work']:32.3g}  "
              f"{each['unmade']:11.0f}  {each['busiest']:11.2f} {each['moved']:13.0f}")
    one = runs["1"]
    verdict("points", f"{one['points']:.0f}", ">= 950", one["points"] >= 950)
    verdict("strain reached; peak before it", f"{one['reached']:.4f}, {one['at']:.4f}", "0.03, before",
            one["reached"] >= 0.03 * (1 - 1e-9) and one["at"] < one["reached"])
    verdict("curves of one and two ranks to the end, largest difference", f"{apart:.1e}", "<= 1e-9", apart <= 1e-9)
    verdict("iterations an increment", f"{one['iterations']:.2f}", "<= 3", one["iterations"] <= 3)


def thousand():
    options = ("biaxial", "--grains", "200", "--elements", "11", "--to", "0.03")
    found = {ranks: case(f"thousand_{ranks}", *options, ranks=ranks) for ranks in (1, 2)}
    runs = {ranks: figures_of(*each) | {"busiest": 1.0, "moved": 0} for ranks, each in found.items()}
    runs[2] |= dict(busiest=number(r"over the mean: mean ([\d.]+)", found[2][1]), moved=number(r"ranks: (\d+)", found[2][1]))
    apart = np.abs(found[1][0]["load_ratio"] / found[2][0]["load_ratio"] - 1).max()
    judge_thousand(runs, apart)


def main():
    {"biaxial": biaxial, "footing": footing, "wall": wall, "thousand": thousand, "scaling": scaling}[harness.words[0]]()
    return False


if __name__ == "__main__":
    harness.main(main)
