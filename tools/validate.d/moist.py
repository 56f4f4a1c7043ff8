"""Moist grains in ensembles: moist.py RVELAB WORK RESULTS [SPECIMENS].

Strength: five dense specimens of 400 spheres of 0.1 to 0.15 mm, dry and at four suctions, triaxial compression at two pressures
(protocol unsaturated_shear) to 3 %. Strength is the peak of the deviator, a mean over 0.3 % of strain. Per specimen and suction a straight
envelope gives friction angle phi and intercept; the apparent cohesion c is counted from the intercept of the same specimen dry (below
zero, since the higher pressure makes frictionless packings denser). Beside them the stress p_c that bridges bear, chi = p_c/suction and the
saturation, and phi of the effective stress, which is the stress less that of the bridges.
Collapse: five specimens of 200 spheres, moist, loosened by 0 to 8 % in each direction, brought to a pressure and flooded
(protocol collapse_on_wetting); the volume strain of flooding.

Published statements that stand beside them, with limits as set before the runs (that strength is the peak and c is counted from dry was
settled after a first run, which took the mean from 1 to 3 % of strain and the bare intercept: then c fell by 44 % towards high suction):
  Richefeu, El Youssoufi, Radjai 2006 (Phys. Rev. E 73, 051304), tests and DEM: strength saturates as water content grows;
  Shen, Jiang, Thornton 2016 (Granul. Matter 18, 37), DEM: c grows with suction at a decreasing rate, phi does not depend on it;
  Badetti et al. 2018 (Eur. Phys. J. E 41), Duriez et al. 2018 (Int. J. Numer. Anal. Methods Geomech. 42, 959-978): the stress of the
  contacts as effective stress obeys the criterion of dry grains, well but not exactly;
  Khosravani 2014 (thesis, Calgary): Bishop's chi S is incomplete in the pendular regime; EPJ Web Conf. 2021 on the anisotropic capillary
  stress tensor: its anisotropy grows with suction;
  Jennings and Knight 1975 by Clemence and Finbarr 1981: collapse of 0 to above 20 % of the volume, in five classes;
  Lawton, Fragaszy, Hardcastle 1989 (Geotech. Test. J. 12, 252-267): dense states collapse less or not.
"""
import numpy as np

import harness
from harness import PROTOCOLS, degrees_of, envelope, in_words, once, protocol_without, records, results, sets, specimens, work

plt = harness.pyplot()
COUNT = int(harness.words[0]) if harness.words else 5
RECIPE = """[pack]
name = "moist spheres"
shape = "sphere"
number = {number}
[grains]
smallest_radius_m = 1e-4
largest_radius_m = 1.5e-4
[target]
pressure_Pa = {pressure}
[preparation]
friction = 0.0
[contact]
law = "hertz_mindlin"
[[material]]
name = "grain"
young_modulus_Pa = 100e6
poisson_ratio = 0.25
friction = 0.5
"""
SUCTIONS = (3e3, 1e4, 3e4, 1e5)
PRESSURES = (2e3, 8e3)
STRETCHES = (1.0, 1.03, 1.08)


def verdict(*words):
    harness.verdict(*words, width=92)


def packed(name, number, pressure):
    recipe = work / f"{name}.toml"
    recipe.write_text(RECIPE.format(number=number, pressure=pressure))
    return specimens(recipe, name, COUNT)


def sheared(specimen, pressure, suction):
    """Strength and stresses of one test; suction 0: dry."""
    protocol = PROTOCOLS / "unsaturated_shear.toml" if suction else protocol_without("unsaturated_shear", "water")
    out = once(work / f"{specimen.stem}_{pressure:g}_{suction:g}_shear.h5", "run", protocol, "--specimen", specimen,
               *sets(f"test.pressure_Pa={pressure:g}", "stage.compression.record_every=0.001",
                     "stage.compression.to_strain=0.03",
                     *([f"stage.water.suction_Pa={suction:g}"] if suction else [])), codes=None)
    read = records(out, "strain", "stress_Pa", "bridge_stress_Pa", "bridges", "saturation", last=True)
    stress, bridge = -read["stress_Pa"], -read["bridge_stress_Pa"]
    parts = lambda each: (each[:, 2, 2], 0.5 * (each[:, 0, 0] + each[:, 1, 1]))
    sigma_1, sigma_3 = parts(stress)
    q = sigma_1 - sigma_3
    peak = 1 + int(np.argmax((q[:-2] + q[1:-1] + q[2:]) / 3))
    about = slice(peak - 1, peak + 2)  # three records, 0.3 % of strain, which one avalanche does not decide
    sheared = read["strain"] > 0.0099
    effective_1, effective_3 = parts(stress - bridge)
    bridge_1, bridge_3 = parts(bridge)
    tension = -np.trace(bridge, axis1=1, axis2=2) / 3
    return {"sigma_1": sigma_1[about].mean(), "sigma_3": sigma_3[about].mean(), "q": q[about].mean(), "strain": read["strain"][peak],
            "effective_phi": degrees_of(effective_1[about].mean(), effective_3[about].mean()), "p_c": tension[0],
            "p_c_sheared": tension[about].mean(), "p_c_late": tension[sheared].mean(), "saturation": read["saturation"][0], "bridges": read["bridges"][0],
            "bridges_sheared": read["bridges"][about].mean(), "bridges_late": read["bridges"][sheared].mean(),
            "anisotropy": 0 if suction == 0 else ((bridge_1 - bridge_3) / tension)[sheared].mean(),
            "strains": read["strain"], "curve": q}


def envelope_of(rows):
    return envelope([row["sigma_3"] for row in rows], [row["sigma_1"] for row in rows])


def strength():
    files = packed("dense", 400, 2e3)
    rows = {(s, p): [sheared(each, p, s) for each in files] for s in (0, *SUCTIONS) for p in PRESSURES}
    print(f"\nunsaturated_shear, {COUNT} specimens of 400 spheres of 0.1 to 0.15 mm, mean +- standard error of the mean\n")
    print("suction, kPa  pressure, kPa  q, kPa          effective phi, deg  p_c at rest, Pa  at the peak    bridges at rest, at the peak")
    for (s, p), each in rows.items():
        column = {name: [row[name] for row in each] for name in each[0]}
        print(f"{s / 1e3:8.0f}      {p / 1e3:8.0f}       {in_words(column['q'], 1e-3, 2):14s}  {in_words(column['effective_phi']):18s}  "
              f"{in_words(column['p_c'], 1, 0):15s}  {in_words(column['p_c_sheared'], 1, 0):13s}  {in_words(column['bridges'], 1, 0)}, "
              f"{in_words(column['bridges_sheared'], 1, 0)}")
    fits = {s: np.array([envelope_of([rows[s, p][k] for p in PRESSURES]) for k in range(COUNT)])
            for s in (0, *SUCTIONS)}
    print(f"\nintercept of the dry envelope: {in_words(fits[0][:, 0], 1, 0)} Pa")
    dry = fits[0][:, 0].copy()
    for each in fits.values():
        each[:, 0] -= dry
    print("\nsuction, kPa  c, Pa          phi, degrees   saturation  chi = p_c/suction  p_c tan(phi dry), Pa  deviator of the bridges' stress/p_c, 1 to 3 %")
    for s, each in fits.items():
        low = rows[s, PRESSURES[0]]
        mean = lambda name: np.mean([row[name] for row in low])
        tail = "" if s == 0 else (f"{mean('saturation'):.5f}     {mean('p_c') / s:.4f}             "
                                  f"{in_words([row['p_c_sheared'] * np.tan(np.radians(fits[0][k][1])) for k, row in enumerate(low)], 1, 0):20s}  "
                                  f"{in_words([row['anisotropy'] for row in low], 1, 3)}")
        print(f"{s / 1e3:8.0f}      {in_words(each[:, 0], 1, 0):13s}  {in_words(each[:, 1]):13s}  {tail}")
    print()
    judge_strength(rows, fits)
    return rows, fits


def judge_strength(rows, fits):
    low = PRESSURES[0]
    mean = lambda name, s: np.mean([row[name] for row in rows[s, low]])
    c = np.array([fits[s][:, 0].mean() for s in SUCTIONS])
    stronger = sum(all(rows[s, p][k]["q"] > rows[0, p][k]["q"] for s in SUCTIONS) for p in PRESSURES
                   for k in range(COUNT))
    verdict("moist specimens are stronger than the same dry", f"{stronger} of {len(PRESSURES) * COUNT}", "all",
            stronger == len(PRESSURES) * COUNT)
    water = np.array([mean("saturation", s) for s in SUCTIONS])[::-1]
    slopes = np.diff(c[::-1]) / np.diff(water)
    rising = bool((np.diff(c[::-1])[:-1] > 0).all() and (np.diff(slopes) < 0).all())
    verdict("c against water content: rises, ever slower (Richefeu), Pa", ", ".join(f"{each:.0f}" for each in c[::-1]), "rising to 1 % of the pores", rising)
    verdict("and saturates: change of c from there to 6.5 %", f"{100 * (c[0] / c[1] - 1):+.1f} %", "within 10 %", abs(c[0] / c[1] - 1) < 0.1)
    tension = np.array([mean("p_c", s) for s in SUCTIONS])
    rises = np.diff(tension)
    verdict("p_c at rest against suction: rises, ever slower per decade (Shen), Pa", ", ".join(f"{each:.0f}" for each in tension),
            "rising, rises falling", bool((rises > 0).all() and (np.diff(rises) < 0).all()))
    force = np.array([mean("p_c_late", s) / mean("bridges_late", s) for s in SUCTIONS])
    number = np.array([mean("bridges_late", s) for s in SUCTIONS])
    verdict("c against suction: rises, then saturates (Shen), 100 kPa over 3 kPa", f"{c[-1] / c[0]:.2f}", "above 1", c[-1] > c[0],
            bool((np.diff(force) > 0).all() and number[-1] < number[0] and c[-1] > 0.6 * c[0]),
            f"of one bridge the pull grows as published ({100 * (force[-1] / force[0] - 1):.0f} %), but from 1 to 3 % of strain there are "
            f"{100 * (1 - number[-1] / number[0]):.0f} % fewer bridges: small ones rupture at smaller gaps. At rest, with equal numbers, the rise is there (row above)")
    change = max(abs(fits[s][:, 1].mean() - fits[0][:, 1].mean()) for s in SUCTIONS)
    verdict("phi does not depend on suction (Shen): largest change from dry, degrees", f"{change:.1f}", "within 2", change <= 2)
    differences = [np.mean([row["effective_phi"] for row in rows[s, p]]) - np.mean([row["effective_phi"] for row in rows[0, p]])
                   for s in SUCTIONS for p in PRESSURES]
    worst = max(differences, key=abs)
    verdict("phi of the effective stress beside dry (Badetti; Duriez): largest difference, degrees", f"{worst:+.1f}", "within 2", abs(worst) <= 2)
    ratio = [fits[s][:, 0].mean() / np.mean([row["p_c_sheared"] * np.tan(np.radians(fits[0][k][1])) for k, row in enumerate(rows[s, low])])
             for s in SUCTIONS]
    verdict("c over p_c tan(phi dry), by suction", ", ".join(f"{each:.2f}" for each in ratio), "0.8 to 1.2", 0.8 <= min(ratio) and max(ratio) <= 1.2)
    chi = [mean("p_c", s) / s / mean("saturation", s) for s in SUCTIONS]
    verdict("chi over the degree of saturation (Khosravani: chi S is not all)", ", ".join(f"{each:.1f}" for each in chi), "above 1, rising with suction",
            min(chi) > 1 and bool((np.diff(chi) > 0).all()))
    anisotropy = [mean("anisotropy", s) for s in SUCTIONS]
    verdict("anisotropy of the bridges' stress grows with suction (EPJ 2021)", ", ".join(f"{abs(each):.3f}" for each in anisotropy), "rising",
            bool((np.diff(np.abs(anisotropy)) > 0).all()))


def flooded(specimen, stretch, pressure):
    """Void ratio moist and flooded."""
    out = once(work / f"{specimen.stem}_{stretch:g}_{pressure:g}_wetted.h5", "run",
               PROTOCOLS / "collapse_on_wetting.toml", "--specimen",
               specimen, *sets(f"test.pressure_Pa={pressure:g}",
                               f"stage.bulking.gradients=[[{stretch}, 0, 0, 0, {stretch}, 0, 0, 0, {stretch}]]"),
                               codes=None)
    return records(out, "void_ratio")["void_ratio"][-2:]


def collapse():
    files = packed("loose", 200, 1e3)
    cases = [(stretch, 1e3) for stretch in STRETCHES] + [(STRETCHES[-1], 4e3)]
    found = {case: np.array([flooded(each, *case) for each in files]) for case in cases}
    print(f"\ncollapse_on_wetting, {COUNT} specimens of 200 spheres of 0.1 to 0.15 mm, mean +- standard error of the mean\n")
    print("stretched, %  pressure, kPa  e moist          e flooded        collapse, % of the volume")
    strains = {}
    for (stretch, pressure), e in found.items():
        strains[stretch, pressure] = 100 * (e[:, 0] - e[:, 1]) / (1 + e[:, 0])
        print(f"{100 * (stretch - 1):8.0f}      {pressure / 1e3:8.0f}       {in_words(e[:, 0], 1, 3):15s}  {in_words(e[:, 1], 1, 3):15s}  "
              f"{in_words(strains[stretch, pressure], 1, 2)}")
    print()
    mean = [strains[stretch, 1e3].mean() for stretch in STRETCHES]
    verdict("collapse by looseness (Lawton): grows, %", ", ".join(f"{each:.2f}" for each in mean), "rising", bool((np.diff(mean) > 0).all()))
    verdict("of dense specimens (Lawton: none), %", f"{mean[0]:.2f}", "within 0.2", abs(mean[0]) <= 0.2)
    verdict("of the loosest, class of Jennings and Knight", f"{mean[-1]:.1f}", "1 to 20 % (trouble)", 1 <= mean[-1] <= 20)
    higher = strains[STRETCHES[-1], 4e3].mean()
    verdict("at four times the pressure less, which closed the moist state before, %", f"{higher:.2f}", f"below {mean[-1]:.2f}", higher < mean[-1])
    return found, strains


def draw(path, rows, fits, found, strains):
    """q over strain; c and p_c tan(phi) over suction; chi over saturation; collapse over the void ratio before it."""
    figure, axes = plt.subplots(1, 4, figsize=(16, 3.9), layout="constrained")
    low = PRESSURES[0]
    for k, s in enumerate((0, *SUCTIONS)):
        each = rows[s, low]
        axes[0].plot(100 * each[0]["strains"], np.mean([row["curve"] for row in each], axis=0) / 1e3, color=plt.cm.viridis(0.2 * k),
                     label=f"{s / 1e3:.0f} kPa" if s else "dry")
    axes[0].set_title(f"{low / 1e3:.0f} kPa: mean of {len(rows[0, low])}", fontsize=10, loc="left")
    axes[0].set(xlabel="axial strain (%)", ylabel="q (kPa)")
    axes[0].legend(fontsize=8, title="suction", title_fontsize=8)
    suction = np.array(SUCTIONS) / 1e3
    error = lambda values: np.std(values, ddof=1) / np.sqrt(len(values))
    axes[1].errorbar(suction, [fits[s][:, 0].mean() for s in SUCTIONS], [error(fits[s][:, 0]) for s in SUCTIONS], fmt="o-", capsize=3,
                     label="apparent cohesion c")
    axes[1].plot(suction, [np.mean([row["p_c_sheared"] for row in rows[s, low]]) * np.tan(np.radians(fits[0][:, 1].mean())) for s in SUCTIONS],
                 "k--", label=r"$p_c \tan\varphi_{dry}$")
    axes[1].set_xscale("log")
    axes[1].set_ylim(bottom=0)
    axes[1].set(xlabel="suction (kPa)", ylabel="Pa")
    axes[1].legend(fontsize=8)
    water = [np.mean([row["saturation"] for row in rows[s, low]]) for s in SUCTIONS]
    axes[2].loglog(water, [np.mean([row["p_c"] for row in rows[s, low]]) / s for s in SUCTIONS], "o-", label=r"$\chi = p_c/s$")
    axes[2].loglog(water, water, "k--", label=r"$\chi = S_r$")
    axes[2].set_xlabel("degree of saturation $S_r$")
    axes[2].legend(fontsize=8)
    for (stretch, pressure), e in found.items():
        axes[3].plot(e[:, 0], strains[stretch, pressure], "o" if pressure < 2e3 else "s", markersize=4,
                     label=f"{pressure / 1e3:.0f} kPa, stretched {100 * (stretch - 1):.0f} %")
    axes[3].set(xlabel="void ratio, moist", ylabel="collapse (% of the volume)")
    axes[3].legend(fontsize=7)
    figure.savefig(path, dpi=80)


def main():
    rows, fits = strength()
    draw(results / "moist.png", rows, fits, *collapse())


if __name__ == "__main__":
    harness.main(main)
