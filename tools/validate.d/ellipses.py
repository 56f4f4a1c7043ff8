#!/usr/bin/python3
"""Ellipses: axis of stiffness of bedded specimens, friction angle against bedding angle and aspect ratio, fabric at the
critical state from two starts, simple shear along and across the bedding.

Bars: the mean axis of stiffness at bedding 0 and 30 degrees within 3 degrees, and within two of its standard errors;
the mean friction angle at aspect ratio 0.6 above that of discs, and the step from 0.6 to 0.4 below that from 1 to 0.6;
the fabric of orientations of bedded and random starts closer at the end of the shear than at its begin, within three
standard errors. The rest is a table. Small ensembles: --count specimens of --number grains each.

    tools/validate.d/ellipses.py build/release/bin/rvelab [--count 4] [--axes 20] [--number 200] [--figure FILE.png]
"""

import argparse
import concurrent.futures
import math
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ASPECTS = [1, 0.8, 0.6, 0.4]
BEDDINGS = [0, 15, 30, 45, 60, 75, 90]
SIZES = ["grains.smallest_radius_m=3e-3", "grains.largest_radius_m=5.6e-3"]  # equal discs would crystallise
PRESSURE = "test.pressure_Pa=100e3"
STRAIN = 0.12


class Bench:
    def __init__(self, program, folder, threads):
        self.program, self.folder = program, folder
        self.pool = concurrent.futures.ThreadPoolExecutor(threads)

    def call(self, words, settings):
        for setting in settings:
            words += ["--set", setting]
        done = subprocess.run([self.program] + words, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(" ".join(words) + ": " + done.stderr.strip())
        return done.stdout

    def specimen(self, name, settings):
        path = os.path.join(self.folder, name + ".h5")
        if not os.path.exists(path):
            self.call(["pack", "pack_bedded", "-o", path, "--threads", "1"], settings)
        return path

    def test(self, protocol, name, packing, settings):
        path = os.path.join(self.folder, name + "_" + protocol + ".h5")
        self.call(["run", protocol, "--specimen", self.specimen(name, packing), "-o", path], settings)
        return h5py.File(path)

    def each(self, work, items):
        return list(self.pool.map(work, items))


def mean_and_error(values):
    values = np.asarray(values, dtype=float)
    return values.mean(), values.std(ddof=1), values.std(ddof=1) / math.sqrt(len(values))


def sines(records):
    """Mobilised (sigma_1 - sigma_3)/(sigma_1 + sigma_3) of the last stage, and its strains."""
    last = records["records/stage"][:] == records["records/stage"][:].max()
    stress = -records["records/stress_Pa"][:][last][:, :2, :2]
    principal = np.linalg.eigvalsh(0.5 * (stress + stress.transpose(0, 2, 1)))
    return (principal[:, 1] - principal[:, 0]) / principal.sum(axis=1), np.abs(records["records/strain"][:][last])


def angles(records):
    """Friction angle at the peak, and over the last third of the strain, degrees."""
    sine, strain = sines(records)
    return math.degrees(math.asin(sine.max())), math.degrees(math.asin(sine[strain > strain.max() * 2 / 3].mean()))


def axis_of(stiffness):
    return math.degrees(0.5 * math.atan2(2 * (stiffness[0, 2] + stiffness[1, 2]), stiffness[0, 0] - stiffness[1, 1]))


def print_row(title, values, unit="degrees"):
    mean, deviation, error = mean_and_error(values)
    print(f"  {title:<34} {mean:7.2f} +- {error:.2f} {unit} (standard deviation {deviation:.2f}, {len(values)} specimens)",
          flush=True)
    return mean, deviation, error


def stiffness_axes(bench, count):
    """pack_bedded as it is shipped, 414 grains."""
    print("Axis of stiffness of bedded specimens, atan2(2 (C16 + C26), C11 - C22)/2 (pack_bedded, method = linear)")
    failures = []
    for angle in (0, 30):
        def probe(seed, angle=angle):
            packing = [f"pack.seed={seed}", f"grains.bedding_angle_deg={angle}"]
            with bench.test("probe", f"axis_{angle}_{seed}", packing, [PRESSURE, "stage.probe.method=linear"]) as found:
                stiffness = found["probes/stiffness_Pa"][-1]
            # Of an axis that is known up to half a turn.
            away = (axis_of(stiffness) - angle + 90) % 180 - 90
            return away, stiffness[0, 0] / stiffness[1, 1]
        found = bench.each(probe, range(1, count + 1))
        mean, _, error = print_row(f"bedding {angle:2d}: axis less bedding", [axis for axis, _ in found])
        if angle == 0:
            print_row("bedding  0: C11/C22", [ratio for _, ratio in found], "")
        if not abs(mean) <= 3:
            failures.append(f"the mean axis is {mean:.1f} degrees off the bedding of {angle}")
        if not abs(mean) <= 2 * error:
            failures.append(f"the mean axis is {abs(mean) / error:.1f} standard errors off the bedding of {angle}")
    return failures


def packing_of(aspect, angle, spread, number, seed):
    shape = [f"grains.smallest_aspect_ratio={aspect}", f"grains.largest_aspect_ratio={aspect}"]
    return SIZES + shape + [f"pack.number={number}", f"pack.seed={seed}", f"grains.bedding_angle_deg={angle}",
                            f"grains.bedding_spread_deg={spread}"]


def biaxial(bench, name, packing):
    settings = [PRESSURE, f"stage.compression.to_strain={STRAIN}", "stage.compression.record_every=0.002"]
    with bench.test("biaxial", name, packing, settings) as found:
        return angles(found)


def against_aspect(bench, count, number):
    print(f"Friction angle of random specimens against the aspect ratio (biaxial to {STRAIN:g}, {number} grains)")
    peaks = []
    for aspect in ASPECTS:
        found = bench.each(lambda seed: biaxial(bench, f"aspect_{aspect}_{seed}", packing_of(aspect, 0, 90, number, seed)),
                           range(1, count + 1))
        print_row(f"aspect ratio {aspect}: peak", [peak for peak, _ in found])
        peaks.append(print_row(f"aspect ratio {aspect}: last third", [last for _, last in found]))
    failures = []
    rise, more = peaks[2][0] - peaks[0][0], peaks[3][0] - peaks[2][0]
    if not rise > 0:
        failures.append(f"the friction angle does not rise from discs to an aspect ratio of 0.6 ({rise:.1f} degrees)")
    if not more < rise:
        failures.append(f"the friction angle does not level: {rise:.1f} degrees from 1 to 0.6, {more:.1f} from 0.6 to 0.4")
    return failures


def against_bedding(bench, count, number):
    print(f"Peak friction angle against the bedding angle, compression along y (aspect ratio 0.6, spread 30, {number} grains)")
    table = []
    for angle in BEDDINGS:
        found = bench.each(lambda seed: biaxial(bench, f"bedding_{angle}_{seed}", packing_of(0.6, angle, 30, number, seed)),
                           range(1, count + 1))
        mean, _, error = print_row(f"bedding {angle:2d}: peak", [peak for peak, _ in found])
        print_row(f"bedding {angle:2d}: last third", [last for _, last in found])
        table.append((angle, mean, error))
    return table


def fabric_of(records):
    """Along x less along y, of the orientations, first and last record of the last stage."""
    last = records["records/stage"][:] == records["records/stage"][:].max()
    fabric = records["records/orientation_fabric"][:][last]
    return [tensor[0, 0] - tensor[1, 1] for tensor in (fabric[0], fabric[-1])]


def critical_fabric(bench, count, number):
    print("Fabric of orientations, phi_xx - phi_yy, in biaxial compression from three starts (aspect ratio 0.6)")
    starts = {"bedding 0": (0, 30), "bedding 90": (90, 30), "random": (0, 90)}
    ends = {}
    for title, (angle, spread) in starts.items():
        def shear(seed, angle=angle, spread=spread):
            name = f"critical_{angle}_{spread}_{seed}"
            settings = [PRESSURE, "stage.compression.to_strain=0.4", "stage.compression.record_every=0.01",
                        'output.quantities=["orientation_fabric"]']
            with bench.test("biaxial", name, packing_of(0.6, angle, spread, number, seed), settings) as found:
                return fabric_of(found)
        found = bench.each(shear, range(1, count + 1))
        first = print_row(f"{title}: at rest", [start for start, _ in found], "")
        ends[title] = first, print_row(f"{title}: at 40 %", [end for _, end in found], "")
    failures = []
    for one, other in (("bedding 0", "bedding 90"), ("bedding 0", "random"), ("bedding 90", "random")):
        apart = abs(ends[one][0][0] - ends[other][0][0])
        end = abs(ends[one][1][0] - ends[other][1][0])
        error = math.hypot(ends[one][1][2], ends[other][1][2])
        print(f"  {one} and {other}: {apart:.3f} apart at rest, {end:.3f} at the end, standard error {error:.3f}")
        if not (end < apart and end <= 3 * error):
            failures.append(f"fabrics of {one} and {other} do not meet: {apart:.3f}, then {end:.3f} apart")
    return failures


def shear(bench, count, number):
    print("Friction angle in drained simple shear v_x(y), bedding along and across the shear (aspect ratio 0.6)")
    for title, angle in (("along", 0), ("across", 90)):
        def test(seed, angle=angle):
            settings = [PRESSURE, f"stage.shear.to_strain={2 * STRAIN}", "stage.shear.record_every=0.004"]
            with bench.test("simple_shear_drained", f"bedding_{angle}_{seed}", packing_of(0.6, angle, 30, number, seed),
                            settings) as found:
                return angles(found)
        found = bench.each(test, range(1, count + 1))
        print_row(f"{title}: peak", [peak for peak, _ in found])
        print_row(f"{title}: last third", [last for _, last in found])


def draw(table, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    angle, mean, error = zip(*table)
    figure, axes = plt.subplots(figsize=(5, 3.5))
    axes.errorbar(angle, mean, yerr=error, fmt="o-", capsize=3)
    axes.set_xlabel("bedding angle against the horizontal (degrees)")
    axes.set_ylabel("peak friction angle (degrees)")
    axes.set_xticks(BEDDINGS)
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=4, help="specimens of each mean")
    parser.add_argument("--axes", type=int, default=20, help="specimens of the axes of stiffness")
    parser.add_argument("--number", type=int, default=200, help="grains of each specimen")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--figure", help="friction angle against bedding angle")
    parser.add_argument("--only", choices=["axes", "aspect", "bedding", "fabric", "shear"], help="this table only")
    options = parser.parse_args()
    failures = []
    wanted = [options.only] if options.only else ["axes", "aspect", "bedding", "fabric", "shear"]
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(os.path.abspath(options.program), folder, options.threads)
        if "axes" in wanted:
            failures += stiffness_axes(bench, options.axes)
        if "aspect" in wanted:
            failures += against_aspect(bench, options.count, options.number)
        if "bedding" in wanted:
            table = against_bedding(bench, options.count, options.number)
            if options.figure:
                draw(table, options.figure)
        if "fabric" in wanted:
            failures += critical_fabric(bench, options.count, options.number)
        if "shear" in wanted:
            shear(bench, options.count, options.number)
    for failure in failures:
        print("FAILED: " + failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
