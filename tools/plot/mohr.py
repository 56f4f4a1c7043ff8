#!/usr/bin/env python3
"""Mohr circles at peak and their envelope: mohr.py RECORDS.h5... -o mohr.png (a folder means its *.h5).

Of each file the last drained compression or extension. Its peak is the record with the largest deviator sigma_1 - sigma_3,
unsmoothed; a test that ends before 15 % strain with its largest deviator at the end has none: the others are drawn, with a
warning. Of several specimens at one pressure the circle of their mean state is drawn over thin ones of each. The envelope
passes through the origin: t = s sin phi by least squares over the tests, s = (sigma_1 + sigma_3)/2,
t = (sigma_1 - sigma_3)/2; of a cohesive soil it is t = s sin phi + c cos phi, as calibrate has it: its grains stick, or the c
of three tests and more is beyond twice its standard error and 5 % of their mean s. Tests in tension (their least sigma_3 pulls: rvelab run direct_tension) are no points of the line: their circle is drawn,
and the envelope is cut off at their mean strength. Of several specimens the mean of their
angles with its 95 % interval (Student's) is drawn and printed instead. Where all tests reach 15 % axial strain, the mean of
their angles from 12 to 15 % is drawn too, secants through the origin. Compression positive.
"""

import argparse
import math

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt
import numpy as np


LARGE_STRAIN = (0.12, 0.15)
SLACK = 1e-9  # recorded strains are round numbers up to round-off
# 97.5 % quantiles of Student's distribution for 1 to 10 degrees of freedom.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)


def drained_tests(stages):
    """The last drained compression or extension of each file, in the order of their pressures."""
    tests = {stage.path: stage for stage in stages if stage.drained and not stage.cyclic}
    for stage in stages:
        if stage.path not in tests:
            raise ValueError(f"{stage.path}: {stage.test_in_words() or stage.name}; the circles need a peak at a held lateral "
                             "stress: give records of biaxial, triaxial or their extensions")
    return sorted(tests.values(), key=lambda test: test.pressure)


def still_rising(test):
    """Why a test has no peak; empty where it has one."""
    sigma_1, sigma_3 = test.principal()
    peak = int(np.argmax(sigma_1 - sigma_3))
    end, left = abs(test.strain[-1]), (sigma_1[-1] - sigma_3[-1]) / (sigma_1[peak] - sigma_3[peak])
    if abs(test.strain[peak]) <= 0.95 * end or left <= 0.9 or end >= LARGE_STRAIN[1] - SLACK:
        return ""  # it broke within a record counts as a peak
    return (f"{test.path}: still rising at the end ({100 * end:.3g} % strain): no peak; run it further (to_strain), to 15 % "
            "at most")


def peak_state(test):
    """s and t, Pa, of the record with the largest deviator."""
    sigma_1, sigma_3 = test.principal()
    peak = int(np.argmax(sigma_1 - sigma_3))
    return 0.5 * (sigma_1[peak] + sigma_3[peak]), 0.5 * (sigma_1[peak] - sigma_3[peak])


def pulls(test):
    """A test in tension: the minor stress of its peak is one."""
    centre, radius = peak_state(test)
    return centre - radius < 0 and test.extension


def tensile_strength(tests):
    """Mean of the largest tensions of tests in tension, Pa; 0 without any."""
    return float(np.mean([max(-test.principal()[1].min(), 0) for test in tests])) if tests else 0.0


def large_strain_angle(test):
    """Friction angle, radians, of the mean state over the large strains; None for a test that ends before 15 %."""
    strain = np.abs(test.strain)
    if strain.max() < LARGE_STRAIN[1] - SLACK:
        return None
    inside = (strain >= LARGE_STRAIN[0] - SLACK) & (strain <= LARGE_STRAIN[1] + SLACK)
    sigma_1, sigma_3 = (stress[inside].mean() for stress in test.principal())
    return math.asin((sigma_1 - sigma_3) / (sigma_1 + sigma_3))


def student(freedom):
    """97.5 % quantile of Student's distribution; beyond the table its expansion in 1/freedom, to 1e-3."""
    if freedom <= len(STUDENT):
        return STUDENT[freedom - 1]
    z = 1.959964
    return z + (z**3 + z) / (4 * freedom) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom**2)


def straight_envelope(s, t):
    """Angle (radians), cohesion and the standard error of it (Pa) of t = s sin phi + c cos phi by least squares, as
    rvelab/calibrate/mohr.cpp; None for fewer than two different s. Of two tests the error is nan."""
    off = s - s.mean()
    if len(s) < 2 or not np.dot(off, off) > 0:
        return None
    slope = np.dot(off, t) / np.dot(off, off)
    if not slope < 1:  # circles through one lateral stress
        return None
    intercept, cosine = t.mean() - slope * s.mean(), math.sqrt(1 - slope**2)
    variance = np.sum((t - intercept - slope * s)**2) / (len(s) - 2) if len(s) > 2 else math.nan
    of_slope = variance / np.dot(off, off)
    of_intercept = variance / len(s) + s.mean()**2 * of_slope
    by_a, by_b = 1 / cosine, intercept * slope / cosine**3
    square = by_a**2 * of_intercept + by_b**2 * of_slope - 2 * by_a * by_b * s.mean() * of_slope
    return math.asin(slope), intercept / cosine, math.sqrt(max(0, square)) if square == square else math.nan


def envelope(tests):
    """Angle (radians) and cohesion (Pa) of the envelope of the peaks: through the origin where the soil has none."""
    s, t = np.array([peak_state(test) for test in tests]).T
    line = straight_envelope(s, t)
    if line is not None and (any(test.origin.sticks for test in tests) or line[1] > max(2 * line[2], 0.05 * s.mean())):
        return line[:2]
    return math.asin(records.sine_through_origin(s, t)), 0.0


def interval_of(tests, cohesive):
    """Mean of the peak angles of the specimens, radians, and half of its 95 % interval; None for a single specimen, and for
    specimens of a cohesive soil with one test each."""
    specimens = {}
    for test in tests:
        specimens.setdefault(test.origin.specimen, []).append(peak_state(test))
    if cohesive:
        lines = [straight_envelope(*np.array(states).T) for states in specimens.values()]
        angles = np.array([line[0] for line in lines if line is not None])
    else:
        angles = np.array([math.asin(records.sine_through_origin(*np.array(states).T)) for states in specimens.values()])
    if len(angles) < 2:
        return None
    return float(angles.mean()), student(len(angles) - 1) * float(angles.std(ddof=1)) / math.sqrt(len(angles)), len(angles)


def line_of(axes, angle, right, label, cohesion=0.0, cut=0.0, **line):
    """Draws tau = c + sigma tan phi, phi in radians, c in kPa, cut off at the tension `cut`, kPa."""
    left = -min(cut, cohesion / math.tan(angle)) if cut > 0 and angle > 0 else 0.0
    x, y = [left, right], [cohesion + left * math.tan(angle), cohesion + right * math.tan(angle)]
    axes.plot([left, *x] if cut > 0 else x, [0, *y] if cut > 0 else y, label=label, **line)


def label_of(curve, drawn):
    """Label of a circle: tests without lateral stress are unconfined, or in tension."""
    before, found, after = curve.label.partition("no pressure at the start")
    if not found:
        return curve.label
    words = "tension" if all(map(pulls, curve.stages)) else "unconfined"
    sets = {other.rest for other in drawn if not all(map(pulls, other.stages))}
    return words + after if len(sets) < 2 else before + words + after


def draw_circles(axes, drawn):
    """One circle a pressure (and group), that of the mean state; thin ones of each specimen. Largest stress, kPa."""
    around = np.linspace(0, math.pi, 300)
    reach = 0.0
    for curve in drawn:
        states = np.array([peak_state(test) for test in curve.stages]) / 1e3
        if len(states) > 1:
            for centre, radius in states:
                axes.plot(centre + radius * np.cos(around), radius * np.sin(around), color=curve.colour, linewidth=0.4,
                          alpha=0.45)
        centre, radius = states.mean(axis=0)
        x, y = centre + radius * np.cos(around), radius * np.sin(around)
        axes.fill_between(x, 0, y, color=curve.colour, alpha=0.08, linewidth=0)
        axes.plot(x, y, color=curve.colour, linestyle=curve.dashes, linewidth=1.5, label=label_of(curve, drawn))
        reach = max(reach, float(states.sum(axis=1).max()))
    return reach


def draw_envelopes(axes, tests, right, colour="crimson", name=""):
    """Envelope of the peaks with its interval, and that of large strain; the words for both and the peak angle."""
    tension = tensile_strength([test for test in tests if pulls(test)])
    tests = [test for test in tests if not pulls(test)]
    peak, cohesion = envelope(tests)
    interval = interval_of(tests, cohesion != 0)
    text = f"peak friction angle {math.degrees(peak):.1f} degrees"
    before = f"{name}, " if name else ""
    label = f"{before}peak: $\\varphi$ = {math.degrees(peak):.1f}°"
    if interval is not None:
        mean, half, count = interval
        low, high = (np.array([cohesion / 1e3, cohesion / 1e3 + right * math.tan(angle)]) for angle in (mean - half, mean + half))
        axes.fill_between([0, right], low, high, color=colour, alpha=0.12, linewidth=0,
                          label="95 % interval of the mean" if not name else None)
        label = f"{before}peak: $\\varphi$ = {math.degrees(mean):.1f}° ± {math.degrees(half):.1f}°"
        text = (f"peak friction angle {math.degrees(mean):.1f} +- {math.degrees(half):.1f} degrees (mean of {count} specimens and "
                "its 95 % interval)")
    if cohesion:
        label += f", c = {cohesion / 1e3:.3g} kPa"
        text += f", cohesion {cohesion:.0f} Pa: the tangent angle of a cohesive soil"
    elif len({round(float(test.pressure), -2) for test in tests}) == 1:
        label += " (through the origin)"  # one pressure tells no cohesion
    if tension:
        label += f", $\\sigma_t$ = {tension / 1e3:.3g} kPa"
        text += f", tensile strength {tension:.0f} Pa"
    line_of(axes, interval[0] if interval else peak, right, label, cohesion / 1e3, tension / 1e3, color=colour, linewidth=1.6)
    large = [large_strain_angle(test) for test in tests]
    if None not in large:
        mean = sum(large) / len(large)
        line_of(axes, mean, right, f"{before}12 to 15 % strain: $\\varphi$ = {math.degrees(mean):.1f}°",
                color=colour if name else "0.35", linestyle=(0, (5, 3)))
        text += f", at large strain {math.degrees(mean):.1f} degrees"
    return (f"{name}: " if name else "") + text, cohesion / 1e3 + right * math.tan(peak)


def sets_of(drawn):
    """Tests of each kind at all its pressures, with their colour and the words that tell them apart. Those in tension go
    with the others where these are of one kind."""
    sets, tension = {}, []
    for curve in drawn:
        if all(map(pulls, curve.stages)):
            tension += curve.stages
        else:
            sets.setdefault(curve.rest, []).append(curve)
    if not sets:
        raise ValueError("all tests are in tension; the envelope needs compressions: give their records too")
    if len(sets) == 1:
        return [([stage for curve in next(iter(sets.values())) for stage in curve.stages] + tension, "crimson", "")]
    found = []
    for own in sets.values():
        name = own[0].label.split(" (n =")[0]
        parts = [part for part in name.split(", ") if len(own) == 1 or not part.endswith(" kPa")]
        found.append(([stage for curve in own for stage in curve.stages], own[0].colour, ", ".join(parts)))
    return found


def several_groups(tests):
    """More than the pressure tells the tests apart: then colours go with the kind of test."""
    return len({curve.rest for curve in kinds.curves_of(tests)}) > 1


def draw(stages, options):
    tests = drained_tests(stages)
    rising = [why for why in map(still_rising, tests) if why]
    tests = [test for test in tests if not still_rising(test)]
    if not tests:
        raise ValueError("; ".join(rising))
    figure, axes = plt.subplots(figsize=(7, 4.4))
    drawn = kinds.curves_of(tests, "group" if options.colour == "auto" and several_groups(tests) else options.colour)
    right = 1.06 * draw_circles(axes, drawn)
    found = [draw_envelopes(axes, own, right, colour, name) for own, colour, name in sets_of(drawn)]
    text, top = "; ".join(words for words, _ in found), max(height for _, height in found)
    pulled = tensile_strength([test for test in tests if pulls(test)]) / 1e3
    axes.set_xlim(-1.5 * pulled if pulled else 0, right)
    if pulled:
        axes.axvline(0, color="0.6", linewidth=0.8)
    axes.set_ylim(0, max(0.56 * right, top))
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("normal stress $\\sigma$, compression positive (kPa)")
    axes.set_ylabel("shear stress $\\tau$ (kPa)")
    kinds.legend(axes, "lateral pressure $\\sigma_r$, envelope")
    words = " and ".join(dict.fromkeys("tension" if pulls(test) else test.test_in_words() for test in tests))
    axes.set_title(f"{words}: Mohr circles at peak", fontsize=11, loc="left")
    figure.savefig(options.output)
    return f"{options.output}: {text}" + "".join(f"\nwarning: not drawn: {why}" for why in rising)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="mohr.py", description=__doc__.splitlines()[0])
    kinds.add_options(parser, "mohr.png")
    records.run(draw, parser)
