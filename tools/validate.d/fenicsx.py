"""tools/validate fenicsx_biaxial, fenicsx_footing: finite elements of dolfinx with RVEs of 100 discs in their points.

biaxial: the block of `python3 -m rvelab.fenicsx biaxial`, four specimens of pack_dense drawn by its points, to 4 % of
strain, over three meshes, without and with a length of 0.25 m. Asked: the block is no stronger than the mean of its
specimens alone, by their peak angles (two degrees below to one above; weak spots lower it); with the length the load
at the end is the same on the two finer meshes within 3 %; the band lies between Roscoe's and Coulomb's angle to five
degrees; the curve of two ranks is that of one to 0.1 % of strain, where the grains have not yet magnified the
round-off of the solver; three iterations an increment at most.

footing: `footing`, pack_medium, surcharge 100 kPa, to a settlement of a fifth of the width over two meshes, rough.
Asked: the largest pressure lies between the formulas' by the angle at 15 % of strain and by that at the peak of the
same specimens.

    fenicsx.py RVELAB WORK RESULTS biaxial|footing"""
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


def case(name, *options, ranks=1):
    """Columns of the curve of a run in WORK/NAME, and what it printed."""
    def make(folder):
        command = [*(("mpirun", "-np", str(ranks)) if ranks > 1 else ()), sys.executable, "-m", "rvelab.fenicsx",
                   *options, "-o", folder, "--frames", "0", "--keep", "0"]
        environment = {**os.environ, **SETTINGS, "PYTHONPATH": str(harness.ROOT / "tools/python"),
                       "RVELAB_PROGRAM": str(harness.program),
                       "RVELAB_LIBRARY": str(harness.program.parents[1] / "lib/librvelab.so.1")}
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, env=environment, check=False)
        if done.returncode != 0:
            sys.exit(f"{name}: {done.stdout[-500:]}{done.stderr[-500:]}")
        (folder / "printed.txt").write_text(done.stdout)
    folder = once(work / name, "fenicsx", *options, ranks, make=make)
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
    print("points  base    largest pressure over the surcharge, at  by the angle at 15 %  at the peak  "
          "iterations an increment  shared RVEs")
    for name, each in runs.items():
        print(f"{each['points']:6.0f}  {name.split('_')[0]:6}  {each['largest']:35.2f} {each['at']:.3f}  "
              f"{each['low']:19.1f}  {each['high']:11.1f}  {each['iterations']:23.2f}  {each['unmade']:11.0f}")
    for name, each in runs.items():
        verdict(f"N_q, {name.replace('_', ' base, elements under half of it: ')}", f"{each['largest']:.2f}",
                f"{each['low']:.1f} to {each['high']:.1f}", each["low"] <= each["largest"] <= each["high"])


def footing():
    runs = {}
    for elements in (1, 2):
        name = f"rough_{elements}"
        options = ("--grains", "100", "--to", "0.2", "--first", "4e-3", "--elements", elements)
        curve, printed = case(name, "footing", *options)
        ratio = curve["pressure_ratio"]
        formula = re.search(r"by the formula ([\d.]+) by .* \(peak\), ([\d.]+) by", printed)
        runs[name] = dict(largest=ratio.max(), at=curve["t"][ratio.argmax()], high=float(formula.group(1)),
                          low=float(formula.group(2)), **{key: number(each, printed) for key, each in COUNTS.items()})
    judge_footing(runs)


def main():
    {"biaxial": biaxial, "footing": footing}[harness.words[0]]()
    return False


if __name__ == "__main__":
    harness.main(main)
