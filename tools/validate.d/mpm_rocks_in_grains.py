"""tools/validate mpm_rocks_in_grains: discs ten times as large as the grains, as rocks beside RVEs and as grains among grains.

    mpm_rocks_in_grains.py RVELAB FOLDER RESULTS

Biaxial compression at 100 kPa to 3.5 %: the scene rocks_in_grains with rocks and without, in cells of the grid of two
points along each side and of one, and periodic cells of the mixture (4,000 discs) and of the fine grains alone, made
with the preparation friction of the RVE. Three specimens and drawings of each. Runs that are whole in FOLDER are used
again."""

import numpy as np

import harness
from harness import mean_error, once, records, results, rvelab, sets, verdict
from mpm import folder, picture, run, specimen

EDGE, BEGINS, SEEDS = 0.7, 0.05, (1, 2, 3)
STRAINS = np.array([0.2, 0.5, 1, 1.5, 2, 2.5, 3]) / 100
MIXTURE = """[pack]
name = "mixture"
shape = "disc"
number = 4000
seed = {seed}
thickness_m = 0.1
share_by = "mass"
[[grains]]
name = "coarse"
share = 0.25
smallest_radius_m = 47e-3
largest_radius_m = 53e-3
[[grains]]
name = "fine"
share = 0.75
smallest_radius_m = 3e-3
largest_radius_m = 7e-3
[target]
pressure_Pa = 100e3
[preparation]
friction = {friction}
[contact]
law = "linear"
rolling = false
[damping]
local = 0.1
[[material]]
name = "sand"
density_kg_m3 = 2650
young_modulus_Pa = 800e6
stiffness_ratio = 0.5
friction_angle_deg = 23
"""


def mixture(seed, friction):
    recipe = folder / f"mixture_{seed}.toml"
    recipe.write_text(MIXTURE.format(seed=seed, friction=friction))
    return once(folder / f"mixture_{seed}.h5", "pack", recipe)


def cell(file):
    """Axial strain, sin of the mobilised angle, volumetric strain of the periodic cell."""
    out = once(file.with_name(file.stem + "_biaxial.h5"), "run", "biaxial", "--specimen", file,
               *sets("test.pressure_Pa=100e3", "stage.compression.to_strain=0.035", "solver.max_overlap_ratio=0.5"))
    h = records(out, "stress_Pa", "deformation_gradient", last=True)
    stress, F = -h["stress_Pa"], h["deformation_gradient"]
    return (-np.log(F[:, 1, 1] / F[0, 1, 1]), harness.sine_of(stress[:, 1, 1], stress[:, 0, 0]),
            -np.log(np.linalg.det(F) / np.linalg.det(F[0])))


def scene(seed, rocks, one_point):
    """The same of material points; residual energy over the work of the stress. one_point: the grid's cells are as
    large as the points, else twice."""
    name = f"{'with' if rocks else 'without'}_rocks_{seed}" + ("_one" if one_point else "")
    h, printed = run(name, "rocks_in_grains.toml", "-j", "1", *sets(f'material.fine.specimens=["fine_{seed}.h5"]'),
                     *(sets(f"rocks.coarse.seed={seed}") if rocks else ("--case", "none")),
                     *(() if one_point else ("--case", "two_points")))
    rows = slice(np.searchsorted(h["time_s"], BEGINS), None)
    x, y = EDGE + h["right.displacement_x_m"][rows], EDGE + h["top.displacement_y_m"][rows]
    major, minor = h["top.pressure_Pa"][rows], h["right.pressure_Pa"][rows]
    return (-np.log(y / y[0]), harness.sine_of(major, minor), -np.log(x * y / (x * y)[0]),
            np.abs(h["residual_J"]).max() / np.abs(h["stress_work_J"]).max())


def peak_of(strain, ratio):
    """Of a mean over a fifth of a per cent of strain."""
    even = np.arange(0, min(strain[-1], 0.035), 2e-4)
    smooth = np.convolve(np.interp(even, strain, ratio), np.ones(10) / 10, "valid")
    return smooth.max(), even[smooth.argmax()] + 1e-3


def main():
    found, shares = {}, {}
    print("sin of the mobilised angle of friction at axial strains of\n" + " " * 30 + " ".join(f"{100 * s:6.1f}%"
                                                                                               for s in STRAINS) +
          "   peak   at strain, %   volumetric at 3 %, %")
    for what in ("fine, cell", "fine, scene", "fine, scene, one point", "mixture, cell", "mixture, scene",
                 "mixture, scene, one point"):
        shares[what] = []
        for seed in SEEDS:
            fine = specimen(f"fine_{seed}", "contact.rolling=false", f"pack.seed={seed}")
            if what.endswith("cell"):
                friction = float(rvelab("inspect", fine).split("preparation_friction")[1].split()[0])
                curve = cell(fine if what.startswith("fine") else mixture(seed, friction))
            else:
                curve = scene(seed, what.startswith("mixture"), what.endswith("one point"))
                shares[what].append(curve[3])
            peak, where = peak_of(*curve[:2])
            found.setdefault(what, []).append(peak)
            print(f"{what:<26} {seed:<3}" + " ".join(f"{v:7.3f}" for v in np.interp(STRAINS, *curve[:2])) +
                  f"   {peak:.3f}  {100 * where:<12.2f}   {100 * np.interp(0.03, curve[0], curve[2]):.2f}", flush=True)
    print()
    mean, error = ({what: mean_error(peaks)[k] for what, peaks in found.items()} for k in (0, 1))
    for what in found:
        left = f"; residual energy over the work of the stress, largest {max(shares[what]):.2f}" if shares[what] else ""
        print(f"{what:<26} peak {mean[what]:.3f} +- {error[what]:.3f}{left}")
    for what in mean:
        cells = what.split(",")[0] + ", cell"
        if what == cells:
            continue
        ratio = mean[what] / mean[cells]
        spread = ratio * np.hypot(error[what] / mean[what], error[cells] / mean[cells])
        one = what if what.endswith("one point") else what + ", one point"
        single = mean[one] / mean[cells]
        verdict(f"{what}: peak over that of the periodic cell, means of {len(SEEDS)}", f"{ratio:.3f} +- {spread:.3f}",
                "1 +- 0.1",
                abs(ratio - 1) < 0.1, what == "mixture, scene" and ratio > 1 and abs(single - 1) <= 0.5 * (ratio - 1),
                f"nodes of cells of two points a side carry soil of both sides of a rock: the same specimens in cells of one point, "
                f"half as wide, stand at {single:.3f}")
    picture(folder / "with_rocks_1_one", "--field", "eps_q", "-o", results / "mpm_rocks_in_grains.png")


if __name__ == "__main__":
    harness.main(main)
