"""tools/validate mpm_rocks_in_grains: discs ten times as large as the grains, as rocks beside RVEs and as grains among grains.

    mpm_rocks_in_grains.py RVELAB FOLDER RESULTS

Biaxial compression at 100 kPa to 3.5 %: the scene rocks_in_grains with rocks and without, in cells of the grid of two
points along each side and of one, and periodic cells of the mixture (4,000 discs) and of the fine grains alone, made
with the preparation friction of the RVE. Three specimens and drawings of each. Runs that are whole in FOLDER are used
again."""

import subprocess

import h5py
import numpy as np

from mpm import ROOT, folder, picture, results, run, rvelab, specimen
from verdict import tell_verdicts, verdict

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


def preparation_friction(file):
    answer = subprocess.run([rvelab, "inspect", file], capture_output=True, text=True, check=True).stdout
    return float(answer.split("preparation_friction")[1].split()[0])


def mixture(seed, friction):
    name, recipe = folder / f"mixture_{seed}.h5", folder / "mixture.toml"
    if not name.exists():
        recipe.write_text(MIXTURE.format(seed=seed, friction=friction))
        subprocess.run([rvelab, "pack", recipe, "-o", name], check=True, stdout=subprocess.DEVNULL)
    return name


def cell(file):
    """Axial strain, sin of the mobilised angle, volumetric strain of the periodic cell."""
    out = file.with_name(file.stem + "_biaxial.h5")
    if not out.exists():
        subprocess.run([rvelab, "run", ROOT / "protocols/biaxial.toml", "--specimen", file, "-o", out, "--set", "test.pressure_Pa=100e3",
                        "--set", "stage.compression.to_strain=0.035", "--set", "solver.max_overlap_ratio=0.5"], check=True,
                       stdout=subprocess.DEVNULL)
    with h5py.File(out) as records:
        last = records["records/stage"][()] == records["records/stage"][()].max()
        stress, F = -records["records/stress_Pa"][()][last], records["records/deformation_gradient"][()][last]
    major, minor = stress[:, 1, 1], stress[:, 0, 0]
    return -np.log(F[:, 1, 1] / F[0, 1, 1]), (major - minor) / (major + minor), -np.log(np.linalg.det(F) / np.linalg.det(F[0]))


def scene(seed, rocks, one_point):
    """one_point: the grid's cells are as large as the points, else twice."""
    name = f"{'with' if rocks else 'without'}_rocks_{seed}" + ("_one" if one_point else "")
    h, printed = run(name, "rocks_in_grains.toml", "-j", "1", "--set", f'material.fine.specimens=["fine_{seed}.h5"]',
                     *(("--set", f"rocks.coarse.seed={seed}") if rocks else ("--case", "none")),
                     *(() if one_point else ("--case", "two_points")))
    rows = slice(np.searchsorted(h["time_s"], BEGINS), None)
    x, y = EDGE + h["right.displacement_x_m"][rows], EDGE + h["top.displacement_y_m"][rows]
    major, minor = h["top.pressure_Pa"][rows], h["right.pressure_Pa"][rows]
    shares[what].append(np.abs(h["residual_J"]).max() / np.abs(h["stress_work_J"]).max())
    return -np.log(y / y[0]), (major - minor) / (major + minor), -np.log(x * y / (x * y)[0])


def peak_of(strain, ratio):
    """Of a mean over a fifth of a per cent of strain."""
    even = np.arange(0, min(strain[-1], 0.035), 2e-4)
    smooth = np.convolve(np.interp(even, strain, ratio), np.ones(10) / 10, "valid")
    return smooth.max(), even[smooth.argmax()] + 1e-3


found, shares = {}, {}
print("sin of the mobilised angle of friction at axial strains of\n" + " " * 30 + " ".join(f"{100 * s:6.1f}%" for s in STRAINS) +
      "   peak   at strain, %   volumetric at 3 %, %")
for what in ("fine, cell", "fine, scene", "fine, scene, one point", "mixture, cell", "mixture, scene", "mixture, scene, one point"):
    shares[what] = []
    for seed in SEEDS:
        specimen(f"fine_{seed}", "--set", "contact.rolling=false", "--set", f"pack.seed={seed}")
        fine = folder / f"fine_{seed}.h5"
        if what.endswith("cell"):
            curve = cell(fine if what.startswith("fine") else mixture(seed, preparation_friction(fine)))
        else:
            curve = scene(seed, what.startswith("mixture"), what.endswith("one point"))
        peak, where = peak_of(*curve[:2])
        found.setdefault(what, []).append(peak)
        print(f"{what:<26} {seed:<3}" + " ".join(f"{v:7.3f}" for v in np.interp(STRAINS, *curve[:2])) +
              f"   {peak:.3f}  {100 * where:<12.2f}   {100 * np.interp(0.03, curve[0], curve[2]):.2f}", flush=True)
print()
mean = {what: np.mean(peaks) for what, peaks in found.items()}
error = {what: np.std(peaks, ddof=1) / np.sqrt(len(peaks)) for what, peaks in found.items()}
for what in found:
    told = f"; residual energy over the work of the stress, largest {max(shares[what]):.2f}" if shares[what] else ""
    print(f"{what:<26} peak {mean[what]:.3f} +- {error[what]:.3f}{told}")
for what in mean:
    cells = what.split(",")[0] + ", cell"
    if what == cells:
        continue
    ratio = mean[what] / mean[cells]
    spread = ratio * np.hypot(error[what] / mean[what], error[cells] / mean[cells])
    one = what if what.endswith("one point") else what + ", one point"
    single = mean[one] / mean[cells]
    verdict(f"{what}: peak over that of the periodic cell, means of {len(SEEDS)}", f"{ratio:.3f} +- {spread:.3f}", "1 +- 0.1",
            abs(ratio - 1) < 0.1, what == "mixture, scene" and ratio > 1 and abs(single - 1) <= 0.5 * (ratio - 1),
            f"nodes of cells of two points a side carry soil of both sides of a rock: the same specimens in cells of one point, "
            f"half as wide, stand at {single:.3f}")
picture(folder / "with_rocks_1_one", "--field", "eps_q", "-o", results / "mpm_rocks_in_grains.png")

tell_verdicts()
