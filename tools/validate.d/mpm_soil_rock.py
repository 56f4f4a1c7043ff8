"""tools/validate mpm_soil_rock: triaxial tests of a soil with rocks of 10, 15 and 20 mm at 200, 400 and 800 kPa.

    mpm_soil_rock.py RVELAB FOLDER RESULTS [KPA...]

The scene soil_rock_triaxial (Li et al. 2023, tables 6 to 8) at three quarters of the published edges, three drawings of
the rocks (one at 800 kPa), contact at the surface; at 200 kPa one drawing with ghosts too, and three of 20 mm at the share of
the rocks of 10 mm: by the published shares the larger rocks are also the more. The trace of the stress on the plates is the
sum of three virials over the volume: of the forces between rocks (and plates), of the stress of the soil, and, what is left,
of the forces between soil and rocks. Default: all pressures. Runs that are whole in FOLDER are used again."""

import re

import numpy as np

import harness
import keeping
from harness import sets, verdict
from mpm import between_plates, energy_parts, last_frame, rough_spheres_bound, run

EDGES, BEGINS, CELL = (0.075, 0.075, 0.15), 0.02, 5  # m, s, mm
SOIL = {200: (3.0e6, 471), 400: (4.8e6, 871), 800: (8.5e6, 1671)}  # Pa, kPa: E, and q at which the soil alone yields
SHARE = {10: 0.389, 15: 0.398, 20: 0.417}
STRAINS = np.array([1, 2, 4, 6, 8, 10, 12, 14.5]) / 100
NU = 0.3
SEEDS = {200: (1, 2, 3), 400: (1, 2, 3), 800: (1,)}
# Ghosts as stiff as the rocks would take steps of 1e-7 s; of 1e8 Pa they overlap by 3 % of a ball's radius at 200 kPa.
GHOSTS = sets('rock_soil={contact="ghost", friction=0.3, porosity=0.35, young_modulus_Pa=1e8}')
pressures = [int(word) for word in harness.words] or list(SOIL)
found, open_energy = {}, {}


def tested(size, pressure, seed, ghosts=False, share=None):
    """q (Pa) at STRAINS, volumetric strain at the last, the largest q over the last, E over the soil's, parts of the work of
    the plates: lost by contact of soil and rocks, gained by mapping, left open; s a million; parts of the trace (kPa) of
    rocks, soil, between both: at the last strain and where q is largest."""
    options = [word for name, first in ((f"mm_{size}", size == 10), (f"kPa_{pressure}", pressure == 200)) if not first
               for word in ("--case", name)]
    name = f"soil_rock_{size}_{pressure}" + (f"_{seed}" if seed > 1 else "") + ("_ghosts" if ghosts else "")
    options += sets(f"rocks.coarse.seed={seed}") * (seed > 1) + GHOSTS * ghosts
    if share:
        name, options = f"{name}_share_{share}", options + sets(f"rocks.coarse.volume_share={share}")
    h, printed = run(name, "soil_rock_triaxial.toml", "-j", "1", *options)
    axial, volumetric, q = between_plates(h, EDGES, BEGINS)
    rows = (axial > 0.002) & (axial < 0.006)
    at, largest = np.interp(STRAINS, axial, q), axial[q[axial < 0.15].argmax()]
    parts = trace_parts(h)
    return (at, np.interp(STRAINS[-1], axial, volumetric), q[axial < 0.15].max() / at[-1],
            np.polyfit(axial[rows], q[rows], 1)[0] / SOIL[pressure][0], *energy_parts(h),
            1 / float(printed.split(" M point-steps")[0].split()[-1]),
            [[np.interp(strain, axial, part) for part in parts] for strain in (STRAINS[-1], largest)])


def trace_parts(h):
    """Of the stress on the plates, kPa, compression +, from BEGINS on: by forces between rocks, by soil, between both."""
    rows = slice(np.searchsorted(h["time_s"], BEGINS), None)
    plates = ("right", "back", "top")
    volume = np.prod([edge + h[f"{plate}.displacement_{axis}_m"] for edge, plate, axis in zip(EDGES, plates, "xyz")], axis=0)
    rocks, soil = (h[f"{what}.virial_J"] / volume / 1e3 for what in ("rocks", "soil"))
    between = sum(h[f"{plate}.pressure_Pa"] for plate in plates) / 1e3 - rocks - soil
    return [part[rows] for part in (rocks, soil, between)]


def surface_over_balls():
    """Peak of a mixture of 40 % by contact at the surface over that by balls, in wide cells and in those of half the width: the kept
    table of mpm_mixture."""
    table = keeping.text(keeping.read("mpm_mixture"))
    return [float(re.search(rf"^{cell} mm, 40 %: peak, contact at the surface over balls.*?([\d.]+)\s+1 \+- 0.05", table, re.MULTILINE)[1])
            for cell in (r"3\.75", r"1\.875")]


def error(values):
    """Of the mean; one value has none."""
    return np.std(values, axis=0, ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.full_like(values[0], np.nan)


def whole(number):
    return "-" if np.isnan(number) else f"{number:.0f}"


def row(pressure, size, contact, runs):
    at, volumetric, peak, stiff, lost, gained, unclosed, cost, parts = (np.array(column) for column in zip(*runs))
    open_energy[pressure, size, contact] = max(unclosed), max(gained)
    print(f"{pressure:<5} {size:<10} {contact:<8} {len(runs):<3}" + " ".join(f"{x / 1e3:7.0f}" for x in at.mean(axis=0)) +
          f"   {whole(error(at)[-1] / 1e3):<6} {100 * volumetric.mean():<15.2f} "
          f"{stiff.mean():.2f} ({rough_spheres_bound(SOIL[pressure][0], NU, SHARE[size]):.2f}){'':<17}{100 * lost.mean():5.1f} {100 * gained.max():5.1f} "
          f"{100 * unclosed.max():5.1f}{'':<15}" + " ".join(f"{x:5.0f}" for x in parts[:, 0].mean(axis=0)) + f"{'':<13}{cost.mean():.2f}",
          flush=True)
    return at[:, -1] / 1e3, peak, stiff / rough_spheres_bound(SOIL[pressure][0], NU, SHARE[size]), parts


def alone(shape):
    """Change of the volume of soil without rocks between three plates, from 50 to 200 kPa in 0.01 s, at 0.04 s: by the plates
    and by its points; what mapping takes over the work of the stress."""
    edge = 0.04
    keys = [f'grid.shape="{shape}"', "rocks=[]", f"region.0.upper_m={[edge] * 3}", "time.duration_s=0.04",
            "body.top.pressure_until_s=1",
            *(f"body.{plate}.centre_m={[edge * (k == axis) for k in range(3)]}" for axis, plate in enumerate(("right", "back", "top")))]
    h, _ = run(f"alone_{shape}", "soil_rock_triaxial.toml", "-j", "1", *sets(*keys))
    sides = [edge + h[f"{plate}.displacement_{axis}_m"][-1] for plate, axis in (("right", "x"), ("back", "y"), ("top", "z"))]
    volume = last_frame(f"alone_{shape}", "volume_m3")[0].sum()
    return np.prod(sides) / edge**3 - 1, volume / edge**3 - 1, h["mapping_loss_J"][-1] / h["stress_work_J"][-1]


def main():
    print("Soil alone in 8 x 8 x 8 cells, pressed from 50 to 200 kPa in 10 ms: change of its volume at 40 ms by the plates and by its\n"
          "points, %, and what mapping takes of the work of the stress, %\n")
    found_alone = {shape: alone(shape) for shape in ("bspline", "gimp")}
    for shape, values in found_alone.items():
        print(f"{shape:<10}" + " ".join(f"{100 * x:8.2f}" for x in values))
    plates, points, _ = found_alone["gimp"]
    # Contact acts from a tenth of a cell on: of three plates on eight cells.
    verdict("plates and points part, gimp, % of the volume", f"{100 * (plates - points):.2f}", "3 * 0.1/8 at most",
            abs(plates - points) < 0.3 / 8)
    print()

    print("Soil with 39 to 42 % of rocks by volume, plates at 0.2 m/s: mean q, kPa, at axial strains, and its standard error at the last\n")
    print("kPa   rocks, mm  contact  runs " + " ".join(f"{100 * s:6.1f}%" for s in STRAINS) +
          "   error  volumetric, %   E over the soil's (bound)   lost, mapped, open, %   trace, kPa: rocks, soil, both   s a million")
    for pressure in pressures:
        for size in SHARE:
            found[pressure, size] = row(pressure, size, "surface",
                                        [tested(size, pressure, seed) for seed in SEEDS[pressure]])
        if pressure == 200:
            ghosts = {size: row(pressure, size, "ghost", [tested(size, pressure, 1, True)])[0][0] for size in SHARE}
            alike = row(pressure, 20, "0.389", [tested(20, pressure, seed, share=SHARE[10]) for seed in SEEDS[200]])[0]
        print(f"      the soil alone yields at {SOIL[pressure][1]}")
    print()
    for pressure in pressures:
        ends, still, stiff, parts = zip(*(found[pressure, size] for size in SHARE))
        means, errors = [end.mean() for end in ends], [error(end) for end in ends]
        falls = all(means[k] - means[k + 1] > np.nan_to_num(np.hypot(errors[k], errors[k + 1])) for k in (0, 1))
        rocks, soil, _ = np.transpose([each[:, 0].mean(axis=0) for each in parts])
        verdict(f"{pressure} kPa, 10, 15, 20 mm: q at 14.5 % falls beyond its standard errors",
                ", ".join(f"{x:.0f} +- {whole(e)}" for x, e in zip(means, errors)), "in order", falls,
                soil[0] > soil[1] > soil[2] and rocks[0] < rocks[1] < rocks[2],
                f"few large rocks between the plates, edges of 7.5, 5 and 3.75 diameters: of the trace of the stress the soil bears "
                f"{', '.join(f'{x:.0f}' for x in soil)} kPa, which falls as the paper's strength does, forces between rocks "
                f"{', '.join(f'{x:.0f}' for x in rocks)} kPa")
        highest = max(((x, k) for each, of in zip(still, parts) for x, k in zip(each, of)), key=lambda pair: pair[0])[1]
        of_rocks, of_soil, of_both = highest[1] - highest[0]
        verdict(f"{pressure} kPa: largest q over that at 14.5 %: no peak", " ".join(f"{x.max():.3f}" for x in still),
                "1 to 1.02",
                max(x.max() for x in still) < 1.02, of_rocks > 0.8 * (of_rocks + of_soil + of_both),
                f"a chain of rocks between the plates that gives way: of the fall of the trace by {of_rocks + of_soil + of_both:.0f} kPa "
                f"{of_rocks:.0f} kPa are forces between rocks, {of_soil:.0f} kPa soil, {of_both:.0f} kPa between both")
        verdict(f"{pressure} kPa: least E over the bound of rough rigid spheres",
                " ".join(f"{x.min():.2f}" for x in stiff), "1 and more",
                min(x.min() for x in stiff) >= 1)
        # What does not close would be work from nothing, as much of the strength.
        unclosed = {key: value for key, value in open_energy.items() if key[0] == pressure}
        for k, what in ((0, "energy of soil, rocks and their contact that does not close"),
                        (1, "energy that mapping gains")):
            verdict(f"{pressure} kPa: {what}, of the plates' work",
                    " ".join(f"{100 * value[k]:.1f}" for value in unclosed.values()),
                    "2 %", max(value[k] for value in unclosed.values()) < 0.02)
        if pressure == 200:
            print(f"      rocks of 20 mm at the share of those of 10 mm: {alike.mean():.0f} +- {whole(error(alike))} kPa")
            ratios = [found[pressure, size][0][0] / ghosts[size] for size in SHARE]
            wide, half = surface_over_balls()
            verdict("200 kPa, first drawing: q at the surface over that of ghosts at 14.5 %",
                    " ".join(f"{x:.3f}" for x in ratios),
                    "0.95 to 1.05", all(0.95 <= x <= 1.05 for x in ratios),
                    ratios[0] < ratios[1] < ratios[2] < 1.05 and abs(half - 1) < 0.05 and wide < 0.95,
                    f"the mesh: rocks are {', '.join(f'{size / CELL:.0f}' for size in SHARE)} cells across, and the narrower one is, the more of a ball's "
                    f"soil is on its other side. In a mixture with 40 % of rocks (mpm_mixture) the ratio of the peaks is {wide:.3f} with rocks "
                    f"of 2.7 cells and {half:.3f} with the same in cells of half the width")


if __name__ == "__main__":
    harness.main(main)
