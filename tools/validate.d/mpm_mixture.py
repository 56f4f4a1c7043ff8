"""tools/validate mpm_mixture: triaxial tests of a softening soil without and with rocks, between plates under pressure.

    mpm_mixture.py RVELAB FOLDER RESULTS

The soil alone beside the exact curve of its law, mixtures of three seeds with points as balls (Li et al. 2023, 4.3, half
their edge), one of them with contact at the surface of the rocks, and the stiffness of an elastic mixture beside Hashin and
Shtrikman's bound for rough rigid spheres; mixtures in cells of 3.75 mm, two points a side as published, and in cells of
one point, where no node carries soil of both sides of a rock (there the soil without rocks gains energy in mapping once it
has softened, and ends: its peak is taken, its residual is that of cells of two points). Runs that are whole in FOLDER are used again."""

import functools
import re

import numpy as np

import harness
import keeping
from harness import mean_error, sets, verdict
from mpm import between_plates, energy_parts, folder, peak_of, rough_spheres_bound, run, softening_curve
from rigid_sphere import young_of_array

EDGE = 0.0375  # m
SCENE = "mixture_triaxial.toml"
E, NU, PRESSURE, PSI = 4.6e6, 0.12, 50e3, np.radians(16)
CUBIC, PEAK_STRAIN, DECAY = (1075.64, -407.93, 16.39, 0.32463), 0.022, 50
PEAK, RESIDUAL = np.radians(28.6), np.radians(18.6)


def exact(plastic):
    """Axial strain, deviatoric stress (Pa), volumetric strain (compression +) at deviatoric plastic strains."""
    angle = np.where(plastic < PEAK_STRAIN, np.polyval(CUBIC, plastic),
                     RESIDUAL + (PEAK - RESIDUAL) * np.exp(-DECAY * (plastic - PEAK_STRAIN)))
    return softening_curve(plastic, angle, PSI, PRESSURE, E, NU)


def test(name, *options, begins=0.02):
    """Logarithmic axial and volumetric strain, deviatoric stress (Pa) from the plates."""
    h, printed = run(name, SCENE, "-j", "1", *options)
    return *between_plates(h, [EDGE] * 3, begins), h, printed


def at(strains, axial, values):
    return " ".join(f"{x:6.1f}" for x in np.interp(strains, axial, values))


def soil_alone():
    print("Drucker-Prager soil with the softening of Li et al. (eq. 43) at 50 kPa, 8,000 points, plates at 0.02 m/s\n")
    strains = np.array([1, 2, 3, 4, 5, 6, 8, 10, 15]) / 100
    ep = np.linspace(0, 0.25, 100_001)
    curve = exact(ep)
    along = np.concatenate(([0], curve[0])), np.concatenate(([0], curve[1])), np.concatenate(([0], curve[2]))
    axial, volumetric, q, h, printed = test("soil")
    print("axial strain, %           " + " ".join(f"{100 * s:6.0f}" for s in strains))
    print("q, exact, kPa             " + at(strains, along[0], along[1] / 1e3))
    print("q, plates                 " + at(strains, axial, q / 1e3))
    print("volumetric, exact, %      " + at(strains, along[0], 100 * along[2]))
    print("volumetric, plates        " + at(strains, axial, 100 * volumetric) + "\n")
    peak_at = curve[0][curve[1].argmax()]
    before = axial < peak_at
    error = np.abs(q - np.interp(axial, along[0], along[1]))[before].max() / curve[1].max()
    verdict("largest error up to the peak over the peak", f"{100 * error:.2f} %", "2 %", error < 0.02)
    residual = q[(axial > 0.1) & (axial < 0.16)].mean() / 1e3
    verdict("mean from 10 to 16 %, kPa", f"{residual:.1f}", "46.9 +- 2", abs(residual - 46.9) < 2)
    before_load = (h["time_s"] > 0.005) & (h["time_s"] < 0.02)
    rest = max(np.abs(h[f"{plate}.pressure_Pa"][before_load] / PRESSURE - 1).max()
               for plate in ("right", "back", "top"))
    verdict("pressure on the plates at rest, largest error", f"{rest:.1e}", "0.5 %", rest < 5e-3)


SLOW = sets("time.duration_s=0.14", "body.top.motion=[[0,0,0,0],[0.02,0,0,0],[0.022,0,0,-0.05]]")
CELLS = {"3.75 mm": (), "1.875 mm": sets("grid.cell_m=1.875e-3", "region.0.points_per_cell=1")}
FINEST = "1.875 mm"
SEEDS = {"ghost": (1, 2, 3), "surface": (1,)}
# At the surface of rocks the soil starts at a quarter of the pressure, and the plates consolidate it, with GIMP
# (tools/mpm/rocks/README.md, Limits).
def at_surface(speed=0.05, edge=EDGE):
    rise = "pressure_history=[[0, 12.5e3], [0.01, 50e3]]"
    moving = f", pressure_until_s=0.02, motion=[[0,0,0,0],[0.02,0,0,0],[0.022,0,0,{-speed:g}]]"
    plates = [f'{{name="{name}", kind="half_space", centre_m={[edge if k == axis else 0 for k in range(3)]}, '
              f'normal={[-1 if k == axis else 0 for k in range(3)]}, {rise}{moving if name == "top" else ""}}}'
              for axis, name in enumerate(("right", "back", "top"))]
    return sets(f"body=[{', '.join(plates)}]", "initial.pressure_Pa=12.5e3", "time.cfl=0.1", 'grid.shape="gimp"')


@functools.cache
def mixture(cell, share, contact, seed):
    case = ["--case", f"rocks_{share}", *sets(f"rocks.coarse.seed={seed}")] if share else SLOW
    if contact == "surface":
        case = [*case, *sets('rock_soil={contact="surface", friction=0.35}', "time.duration_s=0.12"), *at_surface()]
    where = "" if cell == "3.75 mm" else cell.replace(" ", "") + "_"
    a, v, q, h, printed = test(f"{where}mixture_{share}_{contact}_{seed}", *case, *CELLS[cell])
    peak, at, residual = peak_of(a, q)
    lost, gained, unclosed = energy_parts(h)
    return {"peak": peak, "at": at, "residual": residual, "volumetric": np.interp(0.1, a, v), "lost": lost, "gained": gained,
            "unclosed": unclosed, "rocks": printed.split(" rocks of ")[0].split()[-1] if share else "0",
            "rate": float(printed.split(" M point-steps")[0].split()[-1])}


def of_contact(cell, contact, what):
    return [mixture(cell, share, contact, seed)[what] for share in (20, 40) for seed in SEEDS[contact]]


def surface_over_balls(cell, share):
    return mixture(cell, share, "surface", 1)["peak"] / mixture(cell, share, "ghost", 1)["peak"]


def ends_of_grains():
    """Means from 10 to 16 % of 0, 20 and 40 % in the kept table of mpm_grains, where every grain is a rock."""
    table = keeping.text(keeping.read("mpm_grains")).split("Soil fitted to fine grains")[0]
    ends = {}
    for share, last in re.findall(r"^ ?(\d+) % .* ([\d.]+)$", table, re.MULTILINE):
        ends.setdefault(share, []).append(float(last))
    return ", ".join(f"{np.mean(each):.0f}" for each in ends.values())


@functools.cache
def soil_peak(cell):
    """Of the soil alone in such cells, kPa."""
    if cell == "3.75 mm":
        return mixture(cell, 0, "-", 1)["peak"]
    a, v, q, h, printed = test("1.875mm_soil", *SLOW, *CELLS[cell], *sets("time.duration_s=0.06"))
    return q.max() / 1e3


@functools.cache
def means(cell):
    """Of balls, and their standard errors, by share: {"peak": (mean, error), ...}."""
    found = {}
    for share in (20, 40):
        values = {what: [mixture(cell, share, "ghost", seed)[what] for seed in SEEDS["ghost"]] for what in ("peak", "at", "residual")}
        found[share] = {what: mean_error(each) for what, each in values.items()}
    return found


def mixtures(cell):
    print(f"\nMixtures in cells of {cell}: rocks of 10 mm, points of 1.9 mm (1:5), plates at 0.05 m/s, seeds 1 to 3; at the surface\n"
          "of the rocks from a quarter of the pressure, to 14 % of strain\n")
    print("part     contact  seed  rocks  peak, kPa  at strain, %  residual, kPa  volumetric at 10 %, %  lost in contact, mapped, open, %  s a million")
    # Alone, the softening soil gains energy in mapping in cells of one point: the run ends.
    soil = mixture("3.75 mm", 0, "-", 1)
    rows = [(0, "-", 1, soil)] + [(share, contact, seed, mixture(cell, share, contact, seed))
                                  for contact in SEEDS for share in (20, 40) for seed in SEEDS[contact]]
    for share, contact, seed, m in rows:
        print(f"{share:2d} %     {contact:<8} {seed:<5} {m['rocks']:<6} {m['peak']:<10.1f} {100 * m['at']:<13.2f} {m['residual']:<14.1f} "
              f"{100 * m['volumetric']:<22.2f} {100 * m['lost']:5.1f} {100 * m['gained']:5.1f} {100 * m['unclosed']:5.1f}{'':<20}"
              f"{1 / m['rate']:.2f}")
    for share, mean in means(cell).items():
        print(f"mean of {share} %: peak {mean['peak'][0]:.1f} +- {mean['peak'][1]:.1f} kPa at {100 * mean['at'][0]:.2f} %, "
              f"residual {mean['residual'][0]:.1f} +- {mean['residual'][1]:.1f} kPa")
    # The soil alone, without a drawing to differ, is known to what halving the cells leaves, by a scheme of second order.
    halved = abs(soil_peak("3.75 mm") - soil_peak(FINEST)) / 3
    peaks = [(soil_peak(cell), halved * (1 if cell == FINEST else 4)), *(means(cell)[share]["peak"] for share in (20, 40))]
    print(f"peak of the soil alone in these cells {peaks[0][0]:.1f} +- {peaks[0][1]:.1f} kPa, by that in the other cells")
    ends = [soil["residual"], *(means(cell)[share]["residual"][0] for share in (20, 40))]
    # Three drawings know a mean to its standard error: an order is broken where a step falls by more than two of them.
    rises = all(b[0] - a[0] > -2 * np.hypot(a[1], b[1]) for a, b in zip(peaks, peaks[1:])) and peaks[2][0] > peaks[0][0]
    verdict(f"{cell}: peaks of 0, 20, 40 % rise, kPa", " ".join(f"{p:.1f}" for p, _ in peaks), "in order within 2 errors", rises)
    excess = {c: [means(c)[share]["residual"][0] - soil["residual"] for share in (20, 40)] for c in CELLS}
    verdict(f"{cell}: residuals of 0, 20, 40 %, kPa", " ".join(f"{p:.1f}" for p in ends), "within 10 %", max(ends) < 1.1 * min(ends),
            all(fine <= 0.5 * wide for fine, wide in zip(excess[FINEST], excess["3.75 mm"])),
            f"the mesh: nodes carry soil of both sides of a rock; of the excess of {excess['3.75 mm'][0]:.0f} and {excess['3.75 mm'][1]:.0f} kPa cells "
            f"half as wide lose more than half. With every grain a rock such mixtures end at {ends_of_grains()} kPa (mpm_grains)")
    coarse = cell != FINEST
    for contact in SEEDS:
        for key, what in (("unclosed", "does not close"), ("gained", "mapping gains")):
            worst, finest = max(of_contact(cell, contact, key)), max(of_contact(FINEST, contact, key))
            verdict(f"{cell}, {contact}: energy that {what}, of the plates' work", f"{100 * worst:.1f} %", "2 %", worst < 0.02,
                    coarse and finest < 0.02 and worst < 0.03,
                    f"the mesh: the same mixtures in cells of {FINEST} leave {100 * finest:.1f} % at most")
    for share in (20, 40):
        ratio, finest = surface_over_balls(cell, share), surface_over_balls(FINEST, share)
        verdict(f"{cell}, {share} %: peak, contact at the surface over balls, one seed", f"{ratio:.3f}", "1 +- 0.05", abs(ratio - 1) < 0.05,
                coarse and abs(finest - 1) < 0.05 and ratio < 1,
                f"the mesh: in cells of {FINEST} the ratio is {finest:.3f}")


@functools.cache
def stiffness(cell, share, contact):
    """E, Pa, of an elastic mixture, or of the soil alone (share 0) loaded and discretised alike; a row each 0.1 ms: 75 between 0.1
    and 0.3 % of strain. A wave crosses in 0.7 ms: at 0.05 m/s, with 40 rows, the soil alone had 0.82 to 1.06 of its E."""
    where = "" if cell == "3.75 mm" else cell.replace(" ", "") + "_"
    options = at_surface(0.01) if contact == "surface" else sets("body.top.motion=[[0,0,0,0],[0.02,0,0,0],[0.022,0,0,-0.01]]")
    rocks = ("--case", f"rocks_{share}",
             *sets("rock_soil={" + f'contact="{contact}", rough=true' + "}")) if share else ()
    a, v, q, h, printed = test(f"{where}slow_elastic_{share}_{contact}", *rocks, *ELASTIC, *CELLS[cell], *options)
    return slope_of(a, q)


# Cohesion of 1 MPa: the soil stays elastic.
ELASTIC = sets("material.soil.cohesion_Pa=1e6", "time.duration_s=0.034", "output.history_every_s=1e-4")


def slope_of(axial, q):
    rows = (axial > 0.001) & (axial < 0.003)
    return np.polyfit(axial[rows], q[rows], 1)[0]


@functools.cache
def one_rock(edge, radius):
    """E over that of the soil alone, of one rough rock in the middle of a cube between plates, at the surface, in the finest cells;
    the exact value, of a simple cubic array; the gap between rock and plate in cells."""
    def of(name, *rock):
        h, _ = run(f"one_{name}_{1e3 * edge:g}", SCENE, "-j", "1", *ELASTIC, *CELLS[FINEST],
                   *at_surface(0.01 * edge / EDGE, edge),
                   *sets(f"region.0.upper_m={[edge] * 3}", *rock))
        axial, _, q = between_plates(h, [edge] * 3, 0.02)
        return slope_of(axial, q)

    rock = ("rock_material=[{name='grain', density_kg_m3=2600, young_modulus_Pa=0.8e9, poisson_ratio=0.12, friction=0.35}]",
            f"rock=[{{name='one', material='grain', shape='sphere', radius_m={radius}, centre_m={[edge / 2] * 3}}}]",
            "rock_soil={contact='surface', rough=true}")
    return of("rock", *rock) / of("soil"), young_of_array(radius / edge, NU), (edge / 2 - radius) / 1.875e-3


def narrow_gaps(share, contact):
    """Gaps between rocks that are narrower than a cell, as the run in the finest cells reported."""
    printed = (folder / f"{FINEST.replace(' ', '')}_slow_elastic_{share}_{contact}.txt").read_text()
    return int(re.search(r"(\d+) gaps between rocks are narrower", printed)[1])


def elastic_mixtures(cell):
    print(f"\nElastic soil (4.6 MPa, 0.12) with rough rocks of 0.8 GPa and 10 mm in cells of {cell}: stiffness between 0.1 and\n"
          "0.3 % over that of the soil alone, which has " + " and ".join(f"{stiffness(cell, 0, contact) / E:.3f} ({contact})"
                                                                        for contact in ("ghost", "surface")) + " of its E\n")
    for share, volume in ((20, 0.158), (40, 0.311)):
        bound = rough_spheres_bound(E, NU, volume)
        for contact in ("ghost", "surface"):
            stiff, finest = (stiffness(c, share, contact) / stiffness(c, 0, contact) for c in (cell, FINEST))
            if cell != FINEST:  # halving the cells brings it into the range, or down from above it
                explained = finest <= 1.3 * bound and (finest >= bound or stiff > 1.3 * bound)
                cause = f"the mesh: nodes carry soil of both sides of a rock; in cells of half the width the same mixture is at {finest:.2f}"
            else:
                (free, array, gap), (near, dense, slit) = (one_rock(*cube) for cube in ((0.015, 0.0051), (0.01125, 0.00473)))
                explained = 0.85 * bound <= stiff < bound and 0.95 < free / array < 1 and near / dense < 0.6
                cause = (f"soil between rocks that are nearer than a cell has no stress of its own, {narrow_gaps(share, contact)} such gaps here. One rock in a "
                         f"cube: with gaps of {gap:.1f} cells to the plates {free:.2f}, {free / array:.2f} of the exact {array:.2f} of the array; with gaps of "
                         f"{slit:.1f} cells {near:.2f}, {near / dense:.2f} of {dense:.2f}")
            verdict(f"{cell}, {share} %, {contact}: E over that of the soil", f"{stiff:.2f}", f"{bound:.2f} to {1.3 * bound:.2f}",
                    bound <= stiff <= 1.3 * bound, explained, cause)


def main():
    soil_alone()
    for cell in CELLS:
        mixtures(cell)
        elastic_mixtures(cell)


if __name__ == "__main__":
    harness.main(main)
