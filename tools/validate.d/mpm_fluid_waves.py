"""Waves from a strip load in bedded soil, and the scan of conductivities: parts of mpm_fluid_scenes.py."""

import os

import h5py
import numpy as np

from mpm_fluid_runs import (
    SOLIDS, WATER, cell_test, costs, elastic_scene, frame_at, run, watched, with_options)
from mpm_fluid_blocks import oedometer
from harness import bars, results, sets, verdict
from mpm import folder, frames, picture, specimen


# --- waves ------------------------------------------------------------------------------------------------------------

PACKINGS = {"bedded_0": ("R0", "pack_regular"),
            "bedded_30": ("R30", "pack_regular", "pack.number=432", "grains.bedding_angle_deg=30"),
            "isotropic": ("I", "pack_bedded", "grains.bedding_spread_deg=90")}
WAVE_OPTIONS = os.environ.get("RVELAB_MPM_WAVE", "").split()
MIDDLE, SURFACE = 10.5, 10.0  # m: of the strip
SCAN_ENDS = 0.06  # s, beyond the pulse and what it does at B
SNAPSHOTS = 0.04, 0.07, 0.09, 0.12  # s, of the published figures


def wave_run(case, conductivity=None):
    name = f"wave_{case}" + (f"_{conductivity:g}" if conductivity else "")
    packed, recipe, *keys = PACKINGS[case]
    specimen(packed, *keys, recipe=recipe)
    run(name, "wave.toml", "--case", case, *WAVE_OPTIONS,
        *(sets(f"fluid.conductivity_m_s={conductivity:g}", f"time.duration_s={SCAN_ENDS}") if conductivity else ()))
    return name


def modulus_of_shear(packed):
    """Pa: of gamma_xy at small strains, on the specimen as it is."""
    strain, *_, stress, strains = cell_test(f"shear_{packed}", "simple_shear", packed, "stage.shear.to_strain=1e-5",
                                            "stage.shear.record_every=1e-6", "solver.target_unbalanced=0",
                                            "solver.relative_tolerance=1e-3", "solver.absolute_tolerance=1e-6")
    return abs(np.polyfit(strains[-len(strain):], stress[-len(strain):, 0, 1], 1)[0])


def moved(w, k, axis):
    return w[f"{k}.{axis}_m"] - w[f"{k}.{axis}_m"][0]


def turned(x, y):
    """Degrees that the direction of motion of a plane path turns through in all, with its sign; its beginning and end,
    slower than a twentieth of the fastest, left out."""
    dx, dy = np.gradient(x), np.gradient(y)
    speed = np.hypot(dx, dy)
    fast = speed > 0.05 * speed.max()
    angle = np.unwrap(np.arctan2(dy[fast], dx[fast]))
    return np.degrees(angle.max() - angle.min())


def wave():
    print("\nWaves, 21 x 10 m of elliptic grains, k 1e-2 m/s: shear modulus of the specimen, Rayleigh speed\n"
          "0.955 sqrt(G/rho) of the soil with its water; speeds along the surface, 2 to 5.6 m from the strip's middle,\n"
          "right and left (a wave of 0.08 s is 7 to 11 m long: these points are nearer than one, where crests and troughs\n"
          "move apart)" + with_options(WAVE_OPTIONS))
    depth, asymmetry, shares, ratios = {}, {}, {}, {}
    for case in PACKINGS:
        name = wave_run(case)
        w, packed = watched(name), PACKINGS[case][0]
        frame = frame_at(name, 0)
        n = float(np.mean(frame["porosity"]))
        density, G = density_and_shear(packed, frame)
        rayleigh = 0.955 * np.sqrt(G / density)
        speeds, sideways = [], []
        for points, sign in (((4, 6, 2), 1), ((3, 5, 0), -1)):  # right, left: outward
            where = [abs(w[f"{k}.x_m"][0] - MIDDLE) for k in points]
            speeds.append(np.polyfit([trough(w["time_s"], moved(w, k, "y")) for k in points], where, 1)[0])
            sideways.append(np.polyfit([trough(w["time_s"], sign * moved(w, k, "x")) for k in points], where, 1)[0])
        reflected = (MIDDLE + w["0.x_m"][0]) / rayleigh
        early = w["time_s"] < reflected
        turn = turned(moved(w, 0, "x")[early], moved(w, 0, "y")[early])
        asymmetry[case], pairs = sums_right_over_left(name)
        depth[case], shares[case] = penetration(name), np.mean([share_below(frame_at(name,
                                                                                     time)) for time in SNAPSHOTS])
        print(f"{case}: G {G / 1e6:.2f} MPa, n {n:.3f}, Rayleigh {rayleigh:.1f} m/s; troughs of u_y {speeds[0]:.1f}, "
              f"{speeds[1]:.1f} m/s, crests of u_x towards the strip {sideways[0]:.1f}, {sideways[1]:.1f} m/s;\n"
              f"    A turns through {turn:.0f} degrees; right/left at 0.04, 0.07, 0.09, 0.12 s "
              f"{', '.join(f'{pair:.3f}' for pair in pairs)}")
        costs(name)
        ratios[case] = [speed / rayleigh for speed in speeds]
        verdict(f"wave, {case}: A turns through, degrees, before the reflection", f"{turn:.0f}", ">= 270", turn >= 270)
        picture(folder / name, "--field", "excess_pore_pressure_Pa", "--frame", 7, "-o", results / f"mpm_{name}.png")
    verdict("wave: mean share of |p| below 5 m at 0.04 to 0.12 s: isotropic; 0, 30 degrees",
            "{:.3f}; {:.3f}, {:.3f}".format(
        shares["isotropic"], shares["bedded_0"], shares["bedded_30"]), "isotropic the least",
            shares["isotropic"] < min(shares["bedded_0"], shares["bedded_30"]))
    print("    by the depth where the largest pressure of the run falls to a quarter the order is another: "
          + ", ".join(f"{case} {depth[case]:.2f} m" for case in depth))
    lame = oedometer("I")[1] * 1e6
    near = [2.0, 3.5, 5.5]
    where, when = elastic_fronts("wave_elastic", 10.5, 10.0, near, G, lame, n)
    beside = np.polyfit(when, where, 1)[0] / rayleigh
    where, when = elastic_fronts("wave_elastic_far", WIDE / 2, DEEP, FAR, G, lame, n)
    away = np.polyfit(when[-3:], where[-3:], 1)[0] / rayleigh
    verdict("wave: elastic soil, 44 x 20 m: speed from 14 to 18 m over that of Rayleigh", f"{away:.3f}", "1 within 10 %",
            abs(away - 1) <= 0.1)
    print(f"{'wave: elastic soil, moduli of the isotropic packing: the same ratio':<76} {beside:.3f}")
    near_bars(ratios, beside)
    sides_bars(*(asymmetry[case] for case in PACKINGS))


@bars
def near_bars(ratios, elastic):
    """In the near field, less than a wavelength from the strip, crests and troughs move apart: the speed of Rayleigh waves is
    asked at 14 to 18 m (wave_far), and here that of an elastic soil in the same box, which has it there."""
    for case, pair in ratios.items():
        verdict(f"wave, {case}: speed of the fronts over that of Rayleigh, right and left",
                ", ".join(f"{each:.3f}" for each in pair), f"elastic {elastic:.3f} +- 5 %",
                max(abs(each / elastic - 1) for each in pair) <= 0.05)


@bars
def sides_bars(straight, inclined, isotropic):
    """Right over left in the paper's box, sums over all points."""
    for angle, found in (("0 degrees", straight), ("isotropic", isotropic)):
        verdict(f"wave: right over left of u_x, {angle}", f"{found:.3f}", "1 within 0.05", abs(found - 1) <= 0.05)
    print(f"    30 degrees: {inclined:.3f} (judged with the box of 44 x 20 m)")


@bars
def inclined_bar(inclined, far):
    """The paper says which side moves more, not by how much: more than what is allowed to a symmetric packing. far: of the
    amplitudes on the surface of the larger box."""
    verdict("wave, 21 x 10 m: right over left of u_x, 30 degrees, sums over all points", f"{inclined:.3f}", "> 1.05, to the right",
            inclined > 1.05, explained=far > 1.05,
            cause="sums over all points at 0.04 to 0.12 s hold what sides and base have returned by then, and what lies below\n"
                  f"    the waves: where nothing returns, in 44 x 20 m, the amplitudes on the surface are {far:.3f}")


@bars
def far_bars(straight, inclined, isotropic):
    """What the asymmetric packing has beyond what is allowed to a symmetric one, to the right as the paper says."""
    what = "wave, 44 x 20 m: amplitudes of u_x on the surface, right over left,"
    verdict(f"{what} 0 degrees", f"{straight:.3f}", "1 within 0.05", abs(straight - 1) <= 0.05)
    verdict(f"{what} 30 degrees", f"{inclined:.3f}", "> 1.05, to the right", inclined > 1.05)
    verdict(f"{what} isotropic", f"{isotropic:.3f}", "between",
            min(straight, inclined) < isotropic < max(straight, inclined))


WIDE, DEEP = 44.0, 20.0  # m
FAR = [2.0, 3.5, 5.5, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0]  # m from the strip's middle


def density_and_shear(packed, frame):
    n = float(np.mean(frame["porosity"]))
    return (1 - n) * SOLIDS + n * WATER, modulus_of_shear(packed)


def wave_far():
    """The same soils in a box of 44 x 20 m: beyond a wavelength a front has the speed of a Rayleigh wave."""
    print(f"\nWaves in {WIDE:g} x {DEEP:g} m of the same grains: speeds of the troughs of u_y, 14 to 18 m from the strip's middle,\n"
          "right and left, before Rayleigh waves return from the sides; right over left of u_x")
    middle = WIDE / 2
    region = f'[{{material="soil",lower_m=[0,0],upper_m=[{WIDE:g},{DEEP:g}],points_per_cell=4}}]'
    strip = f"[{{lower_m={middle - 0.5:g},upper_m={middle + 0.5:g},half_sine_Pa=100e3,half_sine_s=0.04}}]"
    watch = [[middle + d, DEEP] for d in FAR] + [[middle - d, DEEP] for d in FAR]
    sideways = {}
    for case, (packed, recipe, *keys) in PACKINGS.items():
        specimen(packed, *keys, recipe=recipe)
        name = f"wave_far_{case}"
        lasts = 0.32 if case == "isotropic" else 0.24  # s, until the trough has passed 18 m
        run(name, "wave.toml", "--case", case, *WAVE_OPTIONS,
            *sets(f"region={region}", f"boundary.right.at_m={WIDE:g}", f"loads.strip={strip}",
                  f"time.duration_s={lasts}",
                  f"output.watched_points_m={watch}"))
        density, G = density_and_shear(packed, frame_at(name, 0))
        rayleigh, w, n = 0.955 * np.sqrt(G / density), watched(name), len(FAR)
        far = [k for k, d in enumerate(FAR) if d >= 14]
        # Before Rayleigh waves return from the sides.
        passed = [trough(w["time_s"][early], moved(w, k, "y")[early])
                  for k in [*far, *(n + k for k in far)] for early in [w["time_s"] < (WIDE - FAR[k % n]) / rayleigh]]
        speeds = [np.polyfit(passed[first:first + len(far)], [FAR[k] for k in far], 1)[0] for first in (0, len(far))]
        pairs = [right_over_left(frame_at(name, time), middle) for time in (*SNAPSHOTS, 0.2)]
        sideways[case] = amplitudes_right_over_left(name, middle)
        print(f"{case}: Rayleigh {rayleigh:.1f} m/s; {speeds[0]:.1f}, {speeds[1]:.1f} m/s; right/left at 0.04, 0.07, 0.09, 0.12, 0.2 s "
              + ", ".join(f"{pair:.3f}" for pair in pairs))
        costs(name)
        verdict(f"wave, {case}, 44 x 20 m: speed over that of Rayleigh, right and left",
                ", ".join(f"{speed / rayleigh:.3f}" for speed in speeds), "1 within 10 %",
                max(abs(speed / rayleigh - 1) for speed in speeds) <= 0.1)
    far_bars(*(sideways[case] for case in PACKINGS))
    inclined_bar(sums_right_over_left(wave_run("bedded_30"))[0], sideways["bedded_30"])


def amplitudes_right_over_left(name, middle, near=5.0, far=15.0, until=0.2):
    """Of the range of u_x in time at the uppermost points, beside those at the same distance (m) from the strip."""
    moves = []
    for path in frames(name):
        with h5py.File(path) as file:
            if file["time_s"][0] > until + 1e-9:
                break
            u, at = file["displacement_m"][()], file["position_m"][()] - file["displacement_m"][()]
        top = at[:, 1] > at[:, 1].max() - 1e-6
        moves.append(u[top, 0][np.argsort(at[top, 0])])
    where = np.sort(at[top, 0]) - middle
    spans = np.ptp(moves, axis=0)
    right, left = ([spans[sign * where > 0] for sign in (1, -1)])
    away = where[where > 0]
    there = (away >= near) & (away <= far)
    return float(np.exp(np.mean(np.log(right[there] / left[::-1][there]))))


def elastic_fronts(name, half_width, depth, distances, G, lame, porosity):
    """The same pulse on an elastic soil of these moduli: speeds of the troughs of u_y between the distances (m) from the
    strip's middle."""
    K = lame + 2 * G / 3
    watched_text = "watched_points_m = [[5, 10], [10.5, 10], [16, 10], [8.5, 10], [12.5, 10], [7, 10], [14, 10]]"
    edits = [("upper_m = [21, 10]", f"upper_m = [{2 * half_width:g}, {depth:g}]"),
             ("at_m = 21", f"at_m = {2 * half_width:g}"),
             ("lower_m = 10, upper_m = 11", f"lower_m = {half_width - 0.5:g}, upper_m = {half_width + 0.5:g}"),
             ("conductivity_m_s = 1e-2", f"conductivity_m_s = 1e-2\nporosity = {porosity:g}"),
             ("duration_s = 0.15", f"duration_s = {0.08 + distances[-1] / 75:g}"),
             ("frame_every_s = 0.01", "frame_every_s = 1"),
             (watched_text, f"watched_points_m = {[[half_width - d, depth] for d in distances]}")]
    scene = elastic_scene(name, "wave.toml", edits, density=(1 - porosity) * SOLIDS,
                          young=9 * K * G / (3 * K + G), poisson=(3 * K - 2 * G) / (2 * (3 * K + G)))
    run(name, scene)
    w = watched(name)
    when = np.array([trough(w["time_s"], moved(w, k, "y")) for k in range(len(distances))])
    where = np.array([half_width - w[f"{k}.x_m"][0] for k in range(len(distances))])
    return where, when


def share_below(frame):
    """Of the sum of |excess pressure|, what lies in the lower half."""
    excess = abs(frame["excess_pore_pressure_Pa"])
    low = (frame["position_m"] - frame["displacement_m"])[:, 1] < SURFACE / 2
    return np.sum(excess[low]) / np.sum(excess)


def right_over_left(frame, middle=MIDDLE):
    """Sums of |u_x| over the points on both sides of the strip's middle."""
    u = frame["displacement_m"]
    right = (frame["position_m"] - u)[:, 0] > middle
    return np.sum(abs(u[right, 0])) / np.sum(abs(u[~right, 0]))


def sums_right_over_left(name):
    """Geometric mean over the snapshots, and each."""
    pairs = [right_over_left(frame_at(name, time)) for time in SNAPSHOTS]
    return float(np.exp(np.mean(np.log(pairs)))), pairs


def trough(time, value):
    """When a curve is lowest, by a parabola through the three least values."""
    k = int(np.clip(np.argmin(value), 1, len(value) - 2))
    a, b, _ = np.polyfit(time[k - 1:k + 2] - time[k], value[k - 1:k + 2], 2)
    return time[k] - b / (2 * a)


def penetration(name):
    """m: depth below the strip at which the largest excess pressure of the run falls to a quarter."""
    largest, height = None, None
    for path in frames(name):
        with h5py.File(path) as file:
            at, p = file["position_m"][()], file["excess_pore_pressure_Pa"][()]
        largest = p if largest is None else np.maximum(largest, p)
        height = at if height is None else height
    below = abs(height[:, 0] - MIDDLE) < 0.5
    levels = np.unique(np.round(height[below, 1], 6))[::-1]
    values = np.array([np.mean(largest[below & (abs(height[:, 1] - level) < 1e-6)]) for level in levels])
    top = int(values.argmax())
    under = np.flatnonzero(values[top:] < 0.25 * values[top])
    return SURFACE - (levels[top + under[0]] if len(under) else 0.0)


def scan():
    print("\nConductivity, 0 degrees, point B at the middle of the strip: largest settlement (mm), largest excess\n"
          "pressure (kPa), when (s)\n\nk (m/s)   settlement  pressure  when")
    ks, rows = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6), []
    for k in ks:
        name = wave_run("bedded_0", None if k == 1e-2 else k)
        w = watched(name)
        p = w["1.excess_pore_pressure_Pa"]
        until = w["time_s"] <= SCAN_ENDS
        rows.append((-moved(w, 1, "y")[until].min() * 1e3, p[until].max() / 1e3, w["time_s"][p[until].argmax()]))
        print(f"{k:<10g}{rows[-1][0]:<12.4f}{rows[-1][1]:<10.2f}{rows[-1][2]:.4f}", flush=True)
    print()
    rows = np.array(rows)
    verdict("scan: settlement of B from 1e-2 to 1e-4", "", "falls", rows[0, 0] > rows[1, 0] > rows[2, 0])
    verdict("scan: pressure of B from 1e-2 to 1e-4", "", "rises", rows[0, 1] < rows[1, 1] < rows[2, 1])
    spread = [np.ptp(rows[2:, i]) / rows[2:, i].mean() for i in (0, 1)]
    verdict("scan: settlement, pressure at 1e-4, 1e-5, 1e-6 differ by", ", ".join(f"{each:.3f}" for each in spread),
            "0.05", max(spread) <= 0.05)
    verdict("scan: the pressure peaks, s, at 1e-2, 1e-3", f"{rows[0, 2]:.4f}, {rows[1, 2]:.4f}", "before 0.02",
            rows[:2, 2].max() < 0.02)
