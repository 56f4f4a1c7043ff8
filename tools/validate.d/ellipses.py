"""Ellipses: axis of stiffness of bedded specimens, friction angle against aspect ratio and bedding angle, simple shear
along and across the bedding, fabric at the critical state from three starts.

Bars, with the standard errors of the means:
- the mean axis of stiffness at bedding 0 and 30 degrees within 3 degrees of it, and within two errors;
- the friction angle rises from discs to an aspect ratio of 0.6 by more than three errors, and its slope from 0.4 to 0.2
  is smaller than that from 1 to 0.6 by more than three: it rises, then levels. From 0.6 to 0.4 it still rises;
- the peak of a bed pressed across its plane (0 degrees) exceeds that of one pressed along it (90) by more than three;
- sheared along and across the bedding the peaks differ by more than three, the last thirds by less than three;
- the fabrics of two starts, apart by more than five errors at rest, end within three and a fifth of what they were.

    ellipses.py RVELAB WORK RESULTS [--scale 1] [--only PART]
"""

import argparse
import math
import os

import h5py
import numpy as np

import harness
from harness import in_turn, once, packed, records, results, sets, sine_of, work

ASPECTS = [1, 0.8, 0.6, 0.4, 0.2]
BEDDINGS = [0, 15, 30, 45, 60, 75, 90]
SIZES = ["grains.smallest_radius_m=3e-3", "grains.largest_radius_m=5.6e-3"]  # equal discs would crystallise
PRESSURE = "test.pressure_Pa=100e3"
NUMBER = 300  # grains of a specimen
# Specimens of each mean, and how far they are strained: biaxial by aspect and by bedding, simple shear.
AXES, ASPECT, BEDDING, SHEAR, FABRIC, PEAKS = 32, 32, 16, 16, 8, 40
ASPECT_STRAIN, BEDDING_STRAIN, SHEAR_STRAIN, FABRIC_STRAIN = 0.3, 0.12, 1.0, 3.0
PEAK_STRAIN, PEAK_SHEAR = 0.08, 0.2


failures = []


def bar(holds, failure):
    if not holds:
        failures.append(failure)


def tested(protocol, name, count, packing, settings, read):
    """read(record file) of a test on each of so many specimens, on as many threads as there are cores. name: with the
    seed, a specimen's; packing: its settings without the seed."""
    def one(seed):
        specimen = packed("pack_bedded", f"{name}_{seed}", *packing, f"pack.seed={seed}", options=("--threads", 1))
        return read(once(work / f"{name}_{seed}_{protocol}.h5", "run", protocol, "--specimen", specimen,
                         *sets(PRESSURE, *settings)))
    return list(in_turn(one, range(1, count + 1), os.cpu_count()))


def mean_and_error(values):
    return np.mean(values), np.std(values, ddof=1), harness.mean_error(values)[1]


def angles(path):
    """Friction angle at the peak, and over the last third of the strain, degrees."""
    stress, strain = records(path, "stress_Pa", "strain", last=True).values()
    principal = np.linalg.eigvalsh(-0.5 * (stress + stress.transpose(0, 2, 1))[:, :2, :2])
    sine, strain = sine_of(principal[:, 1], principal[:, 0]), np.abs(strain)
    return math.degrees(math.asin(sine.max())), math.degrees(math.asin(sine[strain > strain.max() * 2 / 3].mean()))


def print_angles(title, found):
    """Rows of peaks and of last thirds."""
    return [print_row(f"{title}: {what}", column) for what, column in zip(("peak", "last third"), zip(*found))]


def axis_of(stiffness):
    return math.degrees(0.5 * math.atan2(2 * (stiffness[0, 2] + stiffness[1, 2]), stiffness[0, 0] - stiffness[1, 1]))


def print_row(title, values, unit=" degrees", digits=2):
    mean, deviation, error = mean_and_error(values)
    print(f"  {title:<38} {mean:7.{digits}f} +- {error:.{digits}f}{unit} (standard deviation {deviation:.{digits}f}, "
          f"{len(values)} specimens)", flush=True)
    return mean, deviation, error


def packing_of(aspect, angle, spread):
    return SIZES + [f"grains.smallest_aspect_ratio={aspect}", f"grains.largest_aspect_ratio={aspect}",
                    f"pack.number={NUMBER}",
                    f"grains.bedding_angle_deg={angle}", f"grains.bedding_spread_deg={spread}"]


def errors_apart(one, other):
    """Difference of two means, and how many of its standard errors it is."""
    difference = one[0] - other[0]
    return difference, difference / math.hypot(one[2], other[2])


def combined(means, weights):
    """Of independent means: their weighted sum, and how many of its standard errors it is."""
    total = sum(weight * mean for weight, (mean, _, _) in zip(weights, means))
    return total, total / math.sqrt(sum((weight * error) ** 2 for weight, (_, _, error) in zip(weights, means)))


def stiffness_axes(count):
    """pack_bedded as it is shipped, 414 grains."""
    print("Axis of stiffness of bedded specimens, atan2(2 (C16 + C26), C11 - C22)/2 (pack_bedded, method = linear)")
    for angle in (0, 30):
        def probed(path, angle=angle):
            with h5py.File(path) as file:
                stiffness = file["probes/stiffness_Pa"][-1]
            # Of an axis that is known up to half a turn.
            return (axis_of(stiffness) - angle + 90) % 180 - 90, stiffness[0, 0] / stiffness[1, 1]
        axes, ratios = zip(*tested("probe", f"axis_{angle}", count, [f"grains.bedding_angle_deg={angle}"],
                                   ["stage.probe.method=linear"], probed))
        mean, _, error = print_row(f"bedding {angle:2d}: axis less bedding", axes)
        if angle == 0:
            print_row("bedding  0: C11/C22", ratios, "")
        bar(abs(mean) <= 3, f"the mean axis is {mean:.1f} degrees off the bedding of {angle}")
        bar(abs(mean) <= 2 * error,
            f"the mean axis is {abs(mean) / error:.1f} standard errors off the bedding of {angle}")


def biaxial(strain):
    return [f"stage.compression.to_strain={strain}", "stage.compression.record_every=0.002"]


def against_aspect(count):
    print(f"Friction angle of random specimens against the aspect ratio (biaxial to {ASPECT_STRAIN:g}, {NUMBER} "
          "grains)")
    means = [print_angles(f"aspect ratio {aspect}", tested("biaxial", f"aspect_{aspect}", count,
                                                           packing_of(aspect, 0, 90),
                                                           biaxial(ASPECT_STRAIN), angles)) for aspect in ASPECTS]
    for title, (disc, _, *slender) in zip(("peak", "last third"), zip(*means)):
        rise, rise_errors = errors_apart(slender[0], disc)
        # By a tenth of the aspect ratio from 1 to 0.6, and how much less from 0.6 to 0.4 and from 0.4 to 0.2.
        first, _ = combined([disc, *slender], (-1 / 4, 1 / 4, 0, 0))
        less, errors = combined([disc, *slender], (-1 / 4, 1 / 4 + 1 / 2, -1 / 2, 0))
        least, levels = combined([disc, *slender], (-1 / 4, 1 / 4, 1 / 2, -1 / 2))
        print(f"  {title}: rises by {rise:.2f} degrees to 0.6, {rise_errors:.1f} standard errors; by a tenth of the "
              f"ratio {first:.2f} degrees there, {first - less:.2f} from 0.6 to 0.4 ({errors:.1f} errors less), "
              f"{first - least:.2f} from 0.4 to 0.2 ({levels:.1f} errors less)")
        bar(rise_errors > 3, f"the friction angle ({title}) does not rise to an aspect ratio of 0.6")
        bar(levels > 3, f"the friction angle ({title}) does not level: {levels:.1f} standard errors")


def against_bedding(count):
    print(f"Friction angle against the bedding angle, compression along y (aspect ratio 0.6, spread 30, biaxial to "
          f"{BEDDING_STRAIN:g}, {NUMBER} grains)")
    table = [(angle, *print_angles(f"bedding {angle:2d}", tested("biaxial", f"bedding_{angle}", count,
                                                                 packing_of(0.6, angle, 30),
                                                                biaxial(BEDDING_STRAIN), angles)))
                                                                for angle in BEDDINGS]
    draw(table)
    more, errors = errors_apart(table[0][1], table[-1][1])
    print(f"  across the bed less along it: {more:.2f} degrees, {errors:.1f} standard errors")
    bar(errors > 3, f"a bed is no stronger pressed across than along it ({more:.1f} degrees)")


def shear(count):
    print(f"Friction angle in drained simple shear v_x(y), bedding along and across the shear (aspect ratio 0.6, to "
          f"{SHEAR_STRAIN:g}, {NUMBER} grains)")
    along, across = (print_angles(title, tested("simple_shear_drained", f"bedding_{angle}", count,
                                                packing_of(0.6, angle, 30),
                                                [f"stage.shear.to_strain={SHEAR_STRAIN}",
                                                 "stage.shear.record_every=0.004"], angles))
                     for title, angle in (("along", 0), ("across", 90)))
    peaks, peak_errors = errors_apart(across[0], along[0])
    ends, end_errors = errors_apart(across[1], along[1])
    print(f"  across less along: peak {peaks:.2f} degrees, {peak_errors:.1f} standard errors; last third {ends:.2f} "
          f"degrees, {end_errors:.1f} standard errors")
    bar(abs(peak_errors) > 3, f"the peak of simple shear does not feel the bedding ({peaks:.1f} degrees)")
    bar(abs(end_errors) < 3, f"the end of simple shear still feels the bedding ({ends:.1f} degrees)")


def peaks(count):
    """The two differences of the peak by more specimens, strained past it only: they scatter by 1.8 degrees, so that ten of each tell
    2.4 degrees from nothing by three standard errors, forty 1.2."""
    print(f"Peaks by more specimens, compression to {PEAK_STRAIN:g}, shear to {PEAK_SHEAR:g}")
    # The bed lies across the compression at 0 degrees, across the shear at 90.
    for title, protocol, stage, strain, across, along in (
            ("compression, across less along", "biaxial", "compression", PEAK_STRAIN, 0, 90),
            ("shear, across less along", "simple_shear_drained", "shear", PEAK_SHEAR, 90, 0)):
        means = {angle: print_row(f"{protocol}, bedding {angle:2d}: peak", [peak for peak, _ in tested(
            protocol, f"peak_{angle}", count, packing_of(0.6, angle, 30),
            [f"stage.{stage}.to_strain={strain}", f"stage.{stage}.record_every=0.002"], angles)]) for angle in (0, 90)}
        more, errors = errors_apart(means[across], means[along])
        print(f"  {title}: {more:.2f} degrees, {errors:.1f} standard errors", flush=True)
        bar(errors > 3, f"{title}: {more:.1f} degrees, {errors:.1f} standard errors")


def fabrics_of(path):
    """(phi_xx - phi_yy, 2 phi_xy) of the orientations: at the first record of the last stage, over its last tenth."""
    tensor, strain = records(path, "orientation_fabric", "strain", last=True).values()
    fabric = np.stack([tensor[:, 0, 0] - tensor[:, 1, 1], 2 * tensor[:, 0, 1]], axis=1)
    return fabric[0], fabric[np.abs(strain) > 0.9 * np.abs(strain).max()].mean(axis=0)


def critical_fabric(count):
    print(f"Fabric of orientations in drained simple shear to {FABRIC_STRAIN:g} from three starts (aspect ratio 0.6, "
          f"{NUMBER} grains)")
    means = {}
    for title, angle, spread in (("bedding 0", 0, 30), ("bedding 90", 90, 30), ("random", 0, 90)):
        found = tested("simple_shear_drained", f"critical_{angle}_{spread}", count, packing_of(0.6, angle, spread),
                       [f"stage.shear.to_strain={FABRIC_STRAIN}", "stage.shear.record_every=0.02",
                        'output.quantities=["orientation_fabric"]'], fabrics_of)
        means[title] = [[print_row(f"{title}, {when}: {name}", [fabrics[at][part] for fabrics in found], "", 3)
                         for part, name in enumerate(("phi_xx - phi_yy", "2 phi_xy"))]
                        for at, when in enumerate(("at rest", "at the end"))]
    for one, other in (("bedding 0", "bedding 90"), ("bedding 0", "random"), ("bedding 90", "random")):
        apart, errors = [], []
        for at in (0, 1):
            parts = [errors_apart(means[one][at][part], means[other][at][part]) for part in (0, 1)]
            apart.append(math.hypot(*[difference for difference, _ in parts]))
            errors.append(max(abs(number) for _, number in parts))
        print(f"  {one} and {other}: {apart[0]:.3f} apart at rest ({errors[0]:.1f} standard errors), {apart[1]:.3f} at "
              f"the end ({errors[1]:.1f})")
        bar(errors[0] > 5 and errors[1] < 3 and apart[1] < apart[0] / 5,
            f"fabrics of {one} and {other} do not meet: {apart[0]:.3f}, then {apart[1]:.3f} apart")


def draw(table):
    plt = harness.pyplot()
    figure, axes = plt.subplots(figsize=(5, 3.5))
    for column, title in ((1, "peak"), (2, "mean of the last third")):
        axes.errorbar([row[0] for row in table], [row[column][0] for row in table],
                      yerr=[row[column][2] for row in table], fmt="o-", capsize=3, label=title)
    axes.set(xlabel="bedding angle against the horizontal (degrees)", ylabel="friction angle (degrees)",
             xticks=BEDDINGS)
    axes.legend()
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(results / "ellipses.png", dpi=80)


def main():
    parts = {"axes": (stiffness_axes, AXES), "aspect": (against_aspect, ASPECT), "bedding": (against_bedding, BEDDING),
             "shear": (shear, SHEAR), "peaks": (peaks, PEAKS), "fabric": (critical_fabric, FABRIC)}
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scale", type=float, default=1, help="of the number of specimens of each mean")
    parser.add_argument("--only", choices=list(parts), help="this table only")
    options = parser.parse_args(harness.words)
    for name, (part, specimens) in parts.items():
        if options.only in (None, name):
            part(max(2, round(options.scale * specimens)))
    for failure in failures:
        print("FAILED: " + failure)
    return failures


if __name__ == "__main__":
    harness.main(main)
