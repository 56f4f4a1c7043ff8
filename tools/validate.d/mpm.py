"""tools/validate mpm, mpm_biaxial, mpm_tolerance: scenes of rvelab-mpm beside pure cells and published figures.

    mpm.py RVELAB FOLDER RESULTS
    mpm.py RVELAB FOLDER RESULTS biaxial CASE...
    mpm.py RVELAB FOLDER RESULTS tolerance

Speed of the continuum (asked: 2 M point-steps a second of one core in the plane) and the single element beside the
biaxial test of its specimen (stress and volume). `biaxial`: compression in the cases named (C1: the file without a
case). `tolerance`: error of the plate's stress against grain-steps, over tolerances and gathering. Runs that are whole
in FOLDER are used again, and those that were stopped are continued. Other scenes: mpm_scenes.py."""

import resource
import shutil
import sys

import numpy as np

import harness
from harness import PROTOCOLS, ROOT, columns, mpm, once, records, results, sets, work

folder = work


def run(name, scene, *options):
    """Runs a scene into WORK/name unless it is there and whole, or continues one that was stopped; its history by
    columns, and what it printed."""
    printed, warned, scene = work / f"{name}.txt", work / f"{name}.warnings", PROTOCOLS / "mpm" / scene
    command = [scene, "--specimens", work, "-q", *options]

    def make(out):
        continued = (out / "checkpoint.h5").exists()
        if not continued:
            shutil.rmtree(out, ignore_errors=True)
        done = harness.run(mpm, *(("--resume", out, "-q") if continued else (*command, "-o", out)))
        for path, text in ((printed, done.stdout), (warned, done.stderr)):
            with path.open("a" if continued else "w") as file:
                file.write(text)

    once(work / name, *command, make=make, resume=True)
    if warned.read_text():
        print(warned.read_text(), end="", flush=True)
    return columns(work / name / "history.csv"), printed.read_text()


def with_soil(name, scene, soil, *edits):
    """WORK/name.toml: a scene without its cases, with a continuum instead of its grains, and further edits (old,
    new)."""
    text = (PROTOCOLS / "mpm" / scene).read_text().split("\n[case.")[0]
    begin, end = text.index("[[material]]"), text.index("[[region]]")
    text = (text[:begin] + soil + text[end:]).replace('"dense"', '"soil"')
    for old, new in edits:
        text = text.replace(old, new)
    path = work / f"{name}.toml"
    path.write_text(text)
    return path


def mohr_coulomb(angle, density=2000, young=20e6, cohesion=0, more=""):
    return f'''[[material]]
name = "soil"
kind = "mohr_coulomb"
density_kg_m3 = {density:g}
young_modulus_Pa = {young:g}
friction_angle_deg = {angle:g}
cohesion_Pa = {cohesion:g}
{more}

'''


def moving_mean(values, width, mode="same"):
    """Over so many rows."""
    return np.convolve(values, np.ones(width) / width, mode)


def rows_in(time, span):
    """Rows of a history in a span of time (s), one at least."""
    return max(1, round(span / np.median(np.diff(time))))


def front(position, cell, apart=1):
    """Where a deposit ends, m: the first gap of more than so many cells along x."""
    x = np.sort(position[:, 0])
    gaps = np.flatnonzero(np.diff(x) > apart * cell)
    return x[gaps[0]] if len(gaps) else x[-1]


def frames(name):
    return sorted((work / name).glob("points_*.h5"))


def last_frame(name, *fields):
    """Arrays of the points at the end of a run."""
    import h5py
    with h5py.File(frames(name)[-1]) as file:
        return [file[field][()] for field in fields]


def between_plates(h, edges, begins):
    """Logarithmic axial and volumetric strain and deviatoric stress (Pa) of a triaxial test in the corner of three
    boundaries, the plates at `edges` (m) at first, from the time `begins` (s) on."""
    sides = [edge + h[f"{plate}.displacement_{axis}_m"]
             for edge, plate, axis in zip(edges, ("right", "back", "top"), "xyz")]
    rows = slice(np.searchsorted(h["time_s"], begins), None)
    axial = -np.log(sides[2] / sides[2][rows][0])
    volumetric = -np.log(np.prod(sides, axis=0) / np.prod(sides, axis=0)[rows][0])
    q = h["top.pressure_Pa"] - 0.5 * (h["right.pressure_Pa"] + h["back.pressure_Pa"])
    return axial[rows], volumetric[rows], q[rows]


def energy_parts(h):
    """Of a mixture between plates, over the largest work of the plates on soil and rocks: what contact of soil and rocks
    takes; the most that mapping gains; the most that soil, rocks and their contact together leave open."""
    if "rocks.soil_work_J" not in h:
        plates, lost, open_parts = h["boundary_work_J"], 0 * h["residual_J"], np.abs(h["residual_J"])
    else:
        plates = h["boundary_work_J"] - h["rocks.work_on_soil_J"] + h["rocks.wall_work_J"]
        lost = sum(h.get(f"rocks.{part}_J", 0) for part in ("surface_loss", "ghost_loss", "ghost_mapping", "ghost_springs"))
        between = h["rocks.work_on_soil_J"] + h["rocks.soil_work_J"] + lost
        open_parts = np.abs(h["residual_J"]) + np.abs(h["rocks.residual_J"]) + np.abs(between)
    return np.array((lost[-1], max(0, -h["mapping_loss_J"].min()), open_parts.max())) / np.abs(plates).max()


def peak_of(axial, q):
    """Stress (kPa) and strain where the running mean of three rows is largest, and the mean from 10 to 16 % (kPa)."""
    smooth = moving_mean(q, 3)
    k = smooth[1:-1].argmax() + 1
    return q[k] / 1e3, axial[k], q[(axial > 0.1) & (axial < 0.16)].mean() / 1e3


def cone(angle):
    """Slope of the outer cone of Drucker and Prager for an angle."""
    return 2 * np.sin(angle) / (np.sqrt(3) * (3 - np.sin(angle)))


def softening_curve(plastic, angle, dilation, pressure, young, nu):
    """Axial strain, deviatoric stress (Pa), volumetric strain (compression +) of a soil at deviatoric plastic strains,
    the lateral stress held: q/sqrt(3) = alpha (3 p + q); deps_p = -(1/sqrt(3) - beta) dlambda along, dplastic =
    dlambda/sqrt(3)."""
    alpha, beta = cone(angle), cone(dilation)
    q = 3 * alpha * pressure / (1 / np.sqrt(3) - alpha)
    return q / young + (1 - np.sqrt(3) * beta) * plastic, q, q * (1 - 2 * nu) / young - 3 * np.sqrt(3) * beta * plastic


def rough_spheres_bound(young, nu, share):
    """Lower bound of Hashin and Shtrikman on E over that of the soil, rough rigid spheres."""
    g, k = young / (2 * (1 + nu)), young / (3 * (1 - 2 * nu))
    bulk = k + share / (1 - share) * (k + 4 / 3 * g)
    shear = g + share / (1 - share) * 5 * g * (3 * k + 4 * g) / (6 * (k + 2 * g))
    return 9 * bulk * shear / (3 * bulk + shear) / young


def grain_steps(printed):
    """Of a run and of those that it went on from: the last figure counts them all."""
    return float(printed.replace(",", "").rsplit("grain-steps ", 1)[1].split()[0])


def picture(*options):
    harness.run(sys.executable, "-B", ROOT / "tools/plot/mpm.py", *options)


def costs(printed):
    """The last lines that a run printed: steps, seconds, grain-steps."""
    print("    " + "\n    ".join(printed.strip().splitlines()[-3:]), flush=True)


def plot_style():
    """Of the figures of records: matplotlib.pyplot with it."""
    sys.path.append(str(ROOT / "tools/plot"))
    from records import STYLE, plt
    plt.rcParams.update(STYLE)
    return plt


def specimen(name="dense", *settings, recipe="pack_dense"):
    """WORK/name.h5, packed by a recipe. In shear bands grains are pinched beyond the usual limit now and then."""
    return harness.packed(recipe, name, "solver.max_overlap_ratio=0.5", *settings)


def cell_test(name="cell", *settings):
    """Axial strain, stress (Pa) and volumetric strain (compression +) of the biaxial test of dense.h5 at 100 kPa."""
    path = once(work / f"{name}.h5", "run", "biaxial", "--specimen", specimen(),
                *sets("test.pressure_Pa=100e3", *settings))
    h = records(path, "strain", "stress_Pa", "deformation_gradient", last=True)
    volume = np.linalg.det(h["deformation_gradient"])
    return h["strain"], -h["stress_Pa"][:, 1, 1], np.log(volume[0] / volume)


def speed():
    for what, options in (("plane, 17,408", ["-j", "1"]), ("space, 34,816", ["-j", "1", "--case", "space"])):
        best = 0
        for _ in range(3):
            (work / "block.whole").unlink(missing_ok=True)
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            words = run("block", "elastic_block.toml", *options)[1].replace(",", "").split()
            spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
            made = float(words[words.index("points") + 1]) * float(words[words.index("steps") + 1])
            best = max(best, made / spent / 1e6)
        print(f"continuum alone, {what} elastic points: {best:.2f} M point-steps a second of one core's time")


def element():
    strain, stress, volume = cell_test()
    h, _ = run("element", "element.toml")
    watched = columns(work / "element/watched.csv")
    axial = -h["top.displacement_y_m"]
    point = np.mean([watched[f"{k}.p_Pa"] + watched[f"{k}.q_Pa"] for k in (0, 1)], axis=0) / 1e3
    dilated = np.mean([watched[f"{k}.eps_v"] for k in (0, 1)], axis=0) * 100
    # Paths of grains part by chance: the same cell at tolerances that hardly differ.
    others = [cell_test(f"cell_{k}", f"solver.relative_tolerance={0.01 + 1e-5 * k}", "stage.compression.to_strain=0.05")
              for k in range(1, 9)]
    print("\nsingle element: axial strain; axial stress (kPa) of the points, of the cell under stress control, mean and\n"
          "standard deviation of the cell at eight tolerances of 0.01001 to 0.01008; volumetric strain\n"
          "(%, compression +) likewise")
    for at in (0.003, 0.006, 0.01, 0.015, 0.02, 0.03, 0.04, 0.049):
        many = np.array([np.interp(at, other[0], other[1]) for other in others]) / 1e3
        grown = np.array([np.interp(at, other[0], other[2]) for other in others]) * 100
        print(f"{at:<8g} {np.interp(at, axial, point):<8.1f} {np.interp(at, strain, stress) / 1e3:<8.1f} "
              f"{many.mean():<8.1f} {many.std(ddof=1):<8.1f} {np.interp(at, axial, dilated):<8.3f} "
              f"{np.interp(at, strain, volume) * 100:<8.3f} {grown.mean():<8.3f} {grown.std(ddof=1):.3f}")


def biaxial(chosen):
    strain, stress, _ = cell_test()
    print(f"biaxial compression, stress on the plate (kPa); of the cell {stress.max() / 1e3:.1f} at "
          f"{strain[stress.argmax()]:.4f}; published 280 at 0.016, 220 from 0.08 on, finer meshes soften more\n"
          "case  peak    at strain  mean from 8 %  at the end  at strain  points of eps_q > 0.5, > 1")
    for case in chosen:
        options = [] if case == "C1" else ["--case", case]
        h, printed = run(case, "biaxial.toml", *options)
        axial, plate = -h["plate.displacement_y_m"] / 2, h["plate.force_y_N"] + 100e3
        k = plate.argmax()
        sheared, = last_frame(case, "eps_q")
        print(f"{case:<5} {plate[k] / 1e3:<7.1f} {axial[k]:<10.4f} {np.mean(plate[axial > 0.08]) / 1e3:<14.1f} "
              f"{np.mean(plate[-10:]) / 1e3:<11.1f} {axial[-1]:<10.3f} {np.mean(sheared > 0.5):.2f}, {np.mean(sheared > 1):.2f}")
        costs(printed)
        picture(folder / case, "--field", "eps_q", "-o", results / f"mpm_{case}.png")
    picture(*(folder / case for case in chosen), "--force", "plate.force_y", "--against", "plate.displacement_y", "-o",
            results / "mpm_biaxial.png")


# tolerance_rel, tolerance_abs, gather; the first is what the others are held against.
SETTINGS = [(0.003, 3e-5, 0), (0.01, 1e-4, 0), (0.03, 3e-4, 0), (0.1, 1e-3, 0), (0.3, 3e-3, 0), (0.1, 1e-4, 0),
            (0.01, 1e-3, 0), (0.01, 1e-4, 1e-5), (0.01, 1e-4, 3e-5), (0.01, 1e-4, 1e-4), (0.1, 1e-3, 1e-5),
            (0.1, 1e-3, 3e-5), (0.1, 1e-3, 1e-4), (0.1, 1e-3, 3e-4)]
FEW = [SETTINGS[k] for k in (1, 3, 10, 11, 12)]
WINDOWS = np.linspace(0.001, 0.01, 91), np.linspace(0.01, 0.019, 91)  # axial strain: hardening, peak
SCENES = {"element": ("top", 1, sets("time.duration_s=1.0", "time.cfl=0.05")),
          "biaxial": ("plate", 2, sets("time.duration_s=0.48"))}


def under_load(scene, setting, *options, packed="dense"):
    """Stress on the plate (Pa) at the strains of the windows, grain-steps and increments given to RVEs, of one run."""
    (plate, height, chosen), (rel, absolute, gather) = SCENES[scene], setting
    settings = [*(f"material.dense.{name}={value:g}" for name, value in
                  (("tolerance_rel", rel), ("tolerance_abs", absolute), ("gather", gather))),
                f'material.dense.specimens=["{packed}.h5"]', "output.frame_every_s=1", "output.history_every_s=0.0025",
                *options]
    name = "_".join(["tolerance", scene, f"{rel:g}", f"{absolute:g}", f"{gather:g}", packed, *options])
    h, printed = run(name.replace("=", "_"), f"{scene}.toml", "-j", "1", *chosen, *sets(*settings))
    stress = [np.interp(window, -h[f"{plate}.displacement_y_m"] / height, h[f"{plate}.force_y_N"] + 100e3) for window in WINDOWS]
    words = printed.replace(",", "").split()
    return stress, grain_steps(printed), float(words[words.index("increments") - 3])


def errors(stress, best):
    return [np.sqrt(np.mean((s - b)**2)) / np.mean(b) for s, b in zip(stress, best)]


def tolerance():
    specimen()
    specimen("other", "pack.seed=2")
    print("Root mean square of the difference of the stress on the plate from that of line a, over its mean, at\n"
          "axial strains of 0.1 to 1 % (hardening) and of 1 to 1.9 % (the peak).")
    scenes = (("element", SETTINGS, "single element, time.cfl = 0.05 (increments of 7e-6)"),
              ("biaxial", FEW, "biaxial compression, 16 x 8 cells with one point each, 0.1 m/s"))
    for scene, settings, title in scenes:
        print(f"\n{title}\n   tolerance_rel  tolerance_abs  gather  increments  grain-steps  to 1 %   to 1.9 %")
        best, rows = under_load(scene, settings[0])[0], []
        for letter, setting in zip("abcdefghijklmn", settings):
            stress, steps, called = under_load(scene, setting)
            rows.append((setting, steps, errors(stress, best), letter))
            print("%-2s %-14g %-14g %-7g %-11.3g %-12.3g %-8.2g %.2g" % (letter, *setting, called, steps, *errors(stress, best)))
        if scene == "element":
            step = errors(under_load(scene, SETTINGS[1], "time.cfl=0.04")[0], best)
            other = errors(under_load(scene, SETTINGS[1], packed="other")[0], best)
            print("%-62s %-8.2g %.2g" % ("b with time.cfl = 0.04", *step))
            print("%-62s %-8.2g %.2g" % ("b with another specimen of the recipe", *other))
            tolerance_figure(rows, step, other)


def tolerance_figure(rows, step, other):
    plt = plot_style()
    figure, panels = plt.subplots(1, 2, figsize=(8.4, 3.6), sharey=True)
    for k, (axes, title) in enumerate(zip(panels, ("axial strain 0.1 to 1 %", "1 to 1.9 %"))):
        for gathers, label, style in ((False, "without gather", "o"), (True, "with gather", "s")):
            chosen = [row for row in rows[1:] if (row[0][2] > 0) == gathers]
            axes.loglog([row[1] for row in chosen], [row[2][k] for row in chosen], style, label=label)
        for n, (_, steps, error, letter) in enumerate(sorted(rows[1:], key=lambda row: row[1])):
            axes.annotate(letter, (steps, error[k]), xytext=(4, 4) if n % 2 else (-9, -9), textcoords="offset points",
                          fontsize=8)
        axes.axhline(step[k], color="0.4", linestyle="--", linewidth=1, label="another time step")
        axes.axhline(other[k], color="0.4", linestyle=":", linewidth=1, label="another specimen")
        axes.set_title(title, fontsize=10, loc="left")
        axes.set_xlabel("grain-steps")
        axes.margins(x=0.15)
    panels[0].set_ylabel("error of the stress on the plate")
    panels[0].legend(fontsize=7, loc="center right")
    figure.tight_layout()
    figure.savefig(results / "mpm_tolerance.png")


def main():
    if harness.words == ["tolerance"]:
        tolerance()
    elif harness.words:
        biaxial(harness.words[1:])
    else:
        speed()
        element()


if __name__ == "__main__":
    harness.main(main)
