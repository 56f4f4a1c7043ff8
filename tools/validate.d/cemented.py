"""Cemented grains in ensembles: cemented.py RVELAB WORK RESULTS [SPECIMENS].

Five specimens each of 400 discs (pack_dense, biaxial) and of 500 spheres (triaxial), cemented by `kind = "cement"` with tensile
strength and cohesion of the cement alike, at several strengths and pressures; beside each the same specimens without cement.
Per specimen and strength a straight envelope of the peak circles, sigma_1 = 2 c sqrt(k) + k sigma_3 with
k = (1 + sin phi)/(1 - sin phi): cohesion c and friction angle phi, mean +- standard error over the specimens; then strain and
sharpness of the peak, when the volume grows fastest, and bonds broken by mode.

Published statements that stand beside them, with limits as set before the runs:
  Clough, Rad, Bachus, Sitar 1981 (J. Geotech. Eng. Div. 107, 799-817), 137 tests: friction angles similar to those of uncemented sand,
  with a cohesion intercept;
  Consoli 2014 (Eng. Geol. 169, 61-68): the friction angle does not depend on the amount of cement, c is a direct function of strength;
  Collins and Sitar 2009 (J. Geotech. Geoenviron. Eng. 135): brittle; the envelope is curved, of less friction at higher confinement;
  Jiang, Zhang, Sun, Utili 2013 (Granul. Matter 15, 65-84), DEM in the plane: strength and dilation grow with bond strength, over pressure;
  Wang and Leung 2008, as those report: with more cement hardening becomes softening, contraction dilation;
  de Bono, McDowell, Wanatowski 2014 (Granul. Matter 16, 563-572), of laboratory studies: cement lowers the strain of the peak.
"""
import numpy as np

import harness
from harness import PROTOCOLS, envelope, in_words, mean_error, once, protocol_without, records, results, sets, specimens, work

plt = harness.pyplot()
COUNT = int(harness.words[0]) if harness.words else 5
BIAXIAL = {"protocol": "biaxial_cemented", "pack": ("pack_dense",), "pressures": (20e3, 40e3, 80e3, 160e3), "axis": 1,
           "strengths": (0, 100e3, 200e3, 400e3), "set": [], "what": "400 discs"}
TRIAXIAL = {"protocol": "triaxial_cemented", "pack": ("pack_hertz", "pack.number=500", "material.young_modulus_Pa=1e9"),
            "pressures": (50e3, 100e3, 200e3), "axis": 2, "strengths": (0, 200e3, 400e3),
            "set": ["stage.compression.record_every=0.0005"], "what": "500 spheres"}


def verdict(*words, **more):
    harness.verdict(*words, width=98, **more)


def run(test, specimen, pressure, strength, young_modulus=50e6):
    """Of the compression: arrays of strain, sigma_1, sigma_3, volume strain (expansion positive), broken bonds."""
    stiff = "" if young_modulus == 50e6 else f"_{young_modulus:g}"
    protocol, cement = protocol_without(test["protocol"], "cement"), []
    if strength > 0:
        protocol = PROTOCOLS / f"{test['protocol']}.toml"
        cement = [f"stage.cement.tensile_strength_Pa={strength:g}", f"stage.cement.cohesion_Pa={strength:g}",
                  f"stage.cement.young_modulus_Pa={young_modulus:g}"]
    out = once(work / f"{specimen.stem}_{pressure:g}_{strength:g}{stiff}_records.h5", "run", protocol, "--specimen",
               specimen,
               *sets(f"test.pressure_Pa={pressure:g}", *test["set"], *cement), codes=None)
    read = records(out, "strain", "stress_Pa", "void_ratio", "bonds", "bonds_broken_in_tension",
                   "bonds_broken_in_shear", last=True)
    stress, void_ratio, axis = -read.pop("stress_Pa"), read.pop("void_ratio"), test["axis"]
    return {**read, "sigma_1": stress[:, axis, axis], "sigma_3": np.mean([stress[:, k, k] for k in range(axis)],
                                                                         axis=0),
            "eps_v": (void_ratio - void_ratio[0]) / (1 + void_ratio[0])}


def smoothed(values, width):
    """Moving mean, which a single avalanche does not decide."""
    padded = np.pad(values, width // 2, mode="edge")
    return np.convolve(padded, np.ones(width) / width, mode="valid")[:len(values)]


def measures(found):
    strain, q = found["strain"], found["sigma_1"] - found["sigma_3"]
    peak = int(np.argmax(q))
    every = strain[1] - strain[0]
    width = max(3, int(round(0.002 / every)) // 2 * 2 + 1)  # 0.2 % of strain
    rate = np.gradient(smoothed(found["eps_v"], width), strain)
    broken = found["bonds_broken_in_tension"] + found["bonds_broken_in_shear"]
    whole = max(1, found["bonds"][0])
    late = q[strain > 0.04].mean()
    return {"curve": found, "sigma_1": found["sigma_1"][peak], "sigma_3": found["sigma_3"][peak], "strain": strain[peak], "q": q[peak], "late": late,
            "brittleness": q[peak] / late - 1, "dilation": rate.max(), "dilation_strain": strain[int(np.argmax(rate))],
            "volume": found["eps_v"][-1], "tension": found["bonds_broken_in_tension"][-1] / whole,
            "shear": found["bonds_broken_in_shear"][-1] / whole, "at_peak": broken[peak] / whole}


def envelope_of(rows):
    return envelope([row["sigma_3"] for row in rows], [row["sigma_1"] for row in rows])


def family(test):
    """All tests of one kind; prints their tables. Per strength: c, phi of each specimen; rows by strength, pressure."""
    recipe, *settings = test["pack"]
    files = specimens(recipe, test["protocol"], COUNT, *settings)
    rows = {(s, p): [measures(run(test, each, p, s)) for each in files]
            for s in test["strengths"] for p in test["pressures"]}
    print(f"\n{test['protocol']}, {COUNT} specimens of {test['what']}, mean +- standard error of the mean\n")
    print("strength  pressure  q peak, kPa      strain of the peak, %  q peak/late - 1  fastest dilation at, %  its rate        "
          "broken at peak, %  in tension, in shear at 5 %")
    for (s, p), each in rows.items():
        column = {name: [row[name] for row in each] for name in each[0]}
        print(f"{s / 1e3:6.0f}    {p / 1e3:6.0f}    {in_words(column['q'], 1e-3):15s}  {in_words(column['strain'], 100, 2):21s}  "
              f"{in_words(column['brittleness'], 1, 2):15s}  {in_words(column['dilation_strain'], 100, 2):22s}  "
              f"{in_words(column['dilation'], 1, 2):14s}  {in_words(column['at_peak'], 100):17s}  "
              f"{in_words(column['tension'], 100)}, {in_words(column['shear'], 100)}")
    envelopes = {s: [envelope_of([rows[s, p][k] for p in test["pressures"]]) for k in range(COUNT)]
                 for s in test["strengths"]}
    print("\nstrength, kPa  c, kPa           phi, degrees     c over strength")
    for s, each in envelopes.items():
        c, phi = zip(*each)
        print(f"{s / 1e3:6.0f}         {in_words(c, 1e-3):15s}  {in_words(phi):15s}  {'' if s == 0 else in_words(np.array(c) / s, 1, 3)}")
    print()
    # The strongest cement at the ratios of pressure to strength of the weakest.
    weakest, strongest = test["strengths"][1], test["strengths"][-1]
    high = [p * strongest / weakest for p in test["pressures"]]
    rows.update({(strongest, p): [measures(run(test, each, p, strongest)) for each in files] for p in high
                 if (strongest, p) not in rows})
    similar = [envelope_of([rows[strongest, p][k] for p in high]) for k in range(COUNT)]
    # And as stiff as it should be for its strength.
    stiff = [measures(run(test, each, test["pressures"][0], strongest, 200e6))["strain"] for each in files]
    return rows, envelopes, similar, stiff


def along_envelope(rows, strength):
    """phi between neighbouring pressures, degrees, in words."""
    pressures = sorted(p for s, p in rows if s == strength)
    phi = [np.mean([envelope_of([rows[strength, a][k], rows[strength, b][k]])[1] for k in range(COUNT)])
           for a, b in zip(pressures, pressures[1:])]
    return ", ".join(f"{each:.1f}" for each in phi)


def judge(name, test, rows, envelopes, similar, stiff, count=COUNT):
    strengths, low = test["strengths"], test["pressures"][0]
    cohesion = np.array([[each[0] for each in envelopes[s]] for s in strengths])
    angle = np.array([[each[1] for each in envelopes[s]] for s in strengths])
    ordered = int((np.diff(cohesion, axis=0) > 0).all(axis=0).sum())
    verdict(f"{name}: cohesion grows with bond strength (Clough; Consoli; Jiang)", f"in {ordered} of {count}", f"in all {count}", ordered == count)
    ratio = cohesion[1:].mean(axis=1) / np.array(strengths[1:])
    verdict(f"{name}: c in proportion to strength (Consoli): largest c/strength over smallest", f"{ratio.max() / ratio.min():.2f}",
            "at most 1.3", ratio.max() / ratio.min() <= 1.3)
    weakest, strongest = strengths[1], strengths[-1]
    scaled = np.array([[each[1] for each in similar]]).mean()
    gap = scaled - angle[1].mean()
    cause = (f"bonds of {strongest / 1e3:.0f} kPa at these pressures are on the steep part of a curved envelope (Collins and Sitar); at pressures "
             f"{strongest / weakest:.0f} times as high, of the same part of their strength as for {weakest / 1e3:.0f} kPa, phi is {scaled:.1f}, "
             f"{gap:+.1f} from that of {weakest / 1e3:.0f} kPa")
    curved = (f"the envelope is curved (Collins and Sitar): between neighbouring pressures, from {low / 1e3:.0f} kPa on twice as high each, phi is "
              + "; ".join(f"{along_envelope(rows, s)} with bonds of {s / 1e3:.0f} kPa"
                          for s in strengths[1:]) + f"; {along_envelope(rows, 0)} without "
              f"cement. At pressures {strongest / weakest:.0f} times as high, of the same part of their strength as for {weakest / 1e3:.0f} kPa, phi is {scaled:.1f}, "
              f"{gap:+.1f} from that of {weakest / 1e3:.0f} kPa, where 3 are allowed to this cause")
    change = angle[1:].mean(axis=1) - angle[0].mean()
    error = max(mean_error(angle[k] - angle[0])[1] for k in range(1, len(strengths)))
    verdict(f"{name}: phi beside that without cement (Clough: similar), largest change, degrees",
            f"{change[np.argmax(abs(change))]:+.1f} +- {error:.1f}", "within 5", abs(change).max() <= 5, abs(gap) <= 3,
            cause, reason=curved)
    spread = np.ptp(angle[1:].mean(axis=1))
    verdict(f"{name}: phi between bond strengths (Consoli: independent), degrees", f"{spread:.1f}", "within 3",
            spread <= 3, abs(gap) <= 3, cause, reason=curved)
    mean = lambda what, s, p: np.mean([row[what] for row in rows[s, p]])
    brittle = [mean("brittleness", s, low) for s in strengths]
    verdict(f"{name}: softening after the peak grows with strength (Wang and Leung; Jiang)",
            ", ".join(f"{each:.2f}" for each in brittle), "rising", bool((np.diff(brittle) > 0).all()))
    by_pressure = [mean("brittleness", strongest, p) for p in test["pressures"]]
    verdict(f"{name}: and falls with pressure (Jiang)", ", ".join(f"{each:.2f}" for each in by_pressure),
            "falling", bool((np.diff(by_pressure) < 0).all()))
    peaks = [mean("strain", s, low) for s in strengths]
    verdict(f"{name}: strain of the peak below that without cement (de Bono et al.), %",
            ", ".join(f"{100 * each:.2f}" for each in peaks), "all below the first", max(peaks[1:]) < peaks[0],
            np.mean(stiff) < peaks[0], f"the peak is at some {strongest / 1e3:.0f} kPa over the stiffness of the cement, 50 MPa for all strengths; with 200 MPa, as "
            f"stronger cement is stiffer too, it is at {100 * np.mean(stiff):.2f} %")
    after = [row["dilation_strain"] > row["strain"] for s in strengths[1:] for p in test["pressures"] for row in rows[s, p]]
    verdict(f"{name}: the volume grows fastest after the peak", f"{sum(after)} of {len(after)} tests",
            "9 of 10 tests", sum(after) >= 0.9 * len(after))
    rates = [mean("dilation", s, low) for s in strengths]
    verdict(f"{name}: rate of dilation grows with strength (Jiang)", ", ".join(f"{each:.2f}" for each in rates), "rising",
            bool((np.diff(rates) > 0).all()))


def draw(path, families):
    """q and volume over strain at the lowest pressure, envelopes of the peaks, broken bonds by mode; a row for each family."""
    figure, grid = plt.subplots(len(families), 4, figsize=(16, 3.9 * len(families)), layout="constrained", squeeze=False)
    for axes, (name, test, rows, envelopes) in zip(grid, families):
        low = test["pressures"][0]
        for k, strength in enumerate(test["strengths"]):
            colour = plt.cm.viridis(0.85 * k / (len(test["strengths"]) - 1))
            label = f"bonds of {strength / 1e3:.0f} kPa" if strength else "no cement"
            curves = [row["curve"] for row in rows[strength, low]]
            length = min(len(each["strain"]) for each in curves)
            strain = 100 * curves[0]["strain"][:length]
            for axis, values in ((axes[0], [(each["sigma_1"] - each["sigma_3"])[:length] / 1e3 for each in curves]),
                                 (axes[1], [100 * each["eps_v"][:length] for each in curves])):
                axis.plot(strain, np.mean(values, axis=0), color=colour, label=label)
                axis.fill_between(strain, np.min(values, axis=0), np.max(values, axis=0), color=colour, alpha=0.18, linewidth=0)
            peaks = np.array([[row["sigma_3"], row["sigma_1"]] for p in test["pressures"] for row in rows[strength, p]]) / 1e3
            axes[2].plot(*peaks.T, ".", color=colour, markersize=4)
            c, phi = np.mean(envelopes[strength], axis=0)
            slope = (1 + np.sin(np.radians(phi))) / (1 - np.sin(np.radians(phi)))
            along = np.array([0, peaks[:, 0].max()])
            axes[2].plot(along, 2 * c / 1e3 * np.sqrt(slope) + slope * along, color=colour, linewidth=1)
            if strength:
                whole = [each["bonds"][0] for each in curves]
                for mode, style in (("tension", "-"), ("shear", "--")):
                    axes[3].plot(strain, 100 * np.mean([each[f"bonds_broken_in_{mode}"][:length] / n for each, n in zip(curves, whole)], axis=0),
                                 style, color=colour, label=f"{strength / 1e3:.0f} kPa, {mode}")
        for axis, what in ((axes[0], "q (kPa)"), (axes[1], "volume strain (%), expansion"), (axes[3], "broken bonds (%)")):
            axis.set(xlabel="axial strain (%)", ylabel=what)
        axes[0].set_title(f"{name}, {low / 1e3:.0f} kPa: mean and range of {len(curves)}", fontsize=10, loc="left")
        axes[2].set_title("peaks and envelopes", fontsize=10, loc="left")
        axes[2].set(xlabel=r"$\sigma_3$ (kPa)", ylabel=r"$\sigma_1$ (kPa)")
        axes[2].set_xlim(left=0)
        axes[2].set_ylim(bottom=0)
        axes[0].legend(fontsize=8)
        axes[3].legend(fontsize=7, loc="center right")
        axes[3].set_ylim(bottom=0)
        axes[3].set_xlim(right=7.5)
    figure.savefig(path, dpi=80)


def main():
    families = []
    for name, test in (("discs", BIAXIAL), ("spheres", TRIAXIAL)):
        rows, envelopes, similar, stiff = family(test)
        judge(name, test, rows, envelopes, similar, stiff)
        families.append((name, test, rows, envelopes))
    draw(results / "cemented.png", families)


if __name__ == "__main__":
    harness.main(main)
