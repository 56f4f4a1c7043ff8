"""tools/validate mpm_soil_rock: triaxial tests of a soil with rocks of 10, 15 and 20 mm at 200, 400 and 800 kPa.

    mpm_soil_rock.py RVELAB FOLDER RESULTS [KPA...]

The scene soil_rock_triaxial (Li et al. 2023, tables 6 to 8) at three quarters of the published edges, one drawing of the
rocks; default: all pressures. Runs that are whole in FOLDER are used again."""

import numpy as np

from mpm import between_plates, cases, run, tell_missed, verdict

EDGES, BEGINS = (0.075, 0.075, 0.15), 0.02  # m, s
SOIL = {200: (3.0e6, 471), 400: (4.8e6, 871), 800: (8.5e6, 1671)}  # Pa, kPa: E, and q at which the soil alone yields
SHARE = {10: 0.389, 15: 0.398, 20: 0.417}
STRAINS = np.array([1, 2, 4, 6, 8, 10, 12, 14.5]) / 100
NU = 0.3
pressures = [int(word) for word in cases] or list(SOIL)
found = {}


def bound(young, share):
    """Lower bound of Hashin and Shtrikman on E over that of the soil, rough rigid spheres."""
    g, k = young / (2 * (1 + NU)), young / (3 * (1 - 2 * NU))
    bulk = k + share / (1 - share) * (k + 4 / 3 * g)
    shear = g + share / (1 - share) * 5 * g * (3 * k + 4 * g) / (6 * (k + 2 * g))
    return 9 * bulk * shear / (3 * bulk + shear) / young


print("Soil with 39 to 42 % of rocks by volume, contact at the surface, plates at 0.2 m/s, one drawing: q, kPa, at axial strains\n")
print("kPa   rocks, mm  number " + " ".join(f"{100 * s:6.1f}%" for s in STRAINS) +
      "   volumetric at the end, %   E over the soil's (bound)   soil's residual, J  s a million")
for pressure in pressures:
    young, soil = SOIL[pressure]
    for size in (10, 15, 20):
        options = [word for name, first in ((f"mm_{size}", size == 10), (f"kPa_{pressure}", pressure == 200)) if not first
                   for word in ("--case", name)]
        h, printed = run(f"soil_rock_{size}_{pressure}", "soil_rock_triaxial.toml", "-j", "1", *options)
        axial, volumetric, q = between_plates(h, EDGES, BEGINS)
        rows = (axial > 0.002) & (axial < 0.006)
        stiff = np.polyfit(axial[rows], q[rows], 1)[0] / young
        at = np.interp(STRAINS, axial, q / 1e3)
        found[pressure, size] = at[-1], q[axial < 0.15].max() / 1e3 / at[-1], stiff / bound(young, SHARE[size])
        rate = float(printed.split(" M point-steps")[0].split()[-1])
        print(f"{pressure:<5} {size:<10} {printed.split(' rocks of ')[0].split()[-1]:<6} " + " ".join(f"{x:7.0f}" for x in at) +
              f"   {100 * np.interp(0.145, axial, volumetric):<24.2f}   {stiff:.2f} ({bound(young, SHARE[size]):.2f}){'':<17}"
              f"{np.abs(h['residual_J']).max():<18.3f}  {1 / rate:.2f}", flush=True)
    print(f"      the soil alone yields at {soil}")
print()
for pressure in pressures:
    ends, still, stiff = zip(*(found[pressure, size] for size in (10, 15, 20)))
    verdict(f"{pressure} kPa, 10, 15, 20 mm: q at 14.5 % falls", " ".join(f"{x:.0f}" for x in ends), "in order", ends[0] > ends[1] > ends[2])
    verdict(f"{pressure} kPa: largest q over that at 14.5 %: no peak", " ".join(f"{x:.3f}" for x in still), "1 to 1.02", max(still) < 1.02)
    verdict(f"{pressure} kPa: E over the bound of rough rigid spheres", " ".join(f"{x:.2f}" for x in stiff), "1 and more", min(stiff) >= 1)

tell_missed()
