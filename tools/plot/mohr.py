#!/usr/bin/env python3
"""Mohr circles at peak and their envelope: mohr.py RECORDS.h5... -o mohr.png (folders stand for their *.h5).

Of each file the last drained compression or extension. Its peak is the record with the largest deviator sigma_1 - sigma_3,
unsmoothed; a test that ends before 15 % strain with its largest deviator at the end has none: the others are drawn, with a
warning. The envelope passes through the origin: t = s sin phi by least squares over the tests, s = (sigma_1 + sigma_3)/2,
t = (sigma_1 - sigma_3)/2. Where all tests reach 15 % axial strain, the mean of their angles from 12 to 15 % is drawn
beside it. Compression positive.
"""

import argparse
import math

import records  # first: it says which package is missing
import matplotlib.pyplot as plt
import numpy as np


LARGE_STRAIN = (0.12, 0.15)
SLACK = 1e-9  # recorded strains are round numbers up to round-off


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
    end = abs(test.strain[-1])
    if abs(test.strain[peak]) <= 0.95 * end or end >= LARGE_STRAIN[1] - SLACK:
        return ""
    return (f"{test.path}: still rising at the end ({100 * end:.3g} % strain): no peak; run it further (to_strain), to 15 % "
            "at most")


def peak_state(test):
    """s and t, Pa, of the record with the largest deviator."""
    sigma_1, sigma_3 = test.principal()
    peak = int(np.argmax(sigma_1 - sigma_3))
    return 0.5 * (sigma_1[peak] + sigma_3[peak]), 0.5 * (sigma_1[peak] - sigma_3[peak])


def large_strain_angle(test):
    """Friction angle, radians, of the mean state over the large strains; None for a test that ends before 15 %."""
    strain = np.abs(test.strain)
    if strain.max() < LARGE_STRAIN[1] - SLACK:
        return None
    inside = (strain >= LARGE_STRAIN[0] - SLACK) & (strain <= LARGE_STRAIN[1] + SLACK)
    sigma_1, sigma_3 = (stress[inside].mean() for stress in test.principal())
    return math.asin((sigma_1 - sigma_3) / (sigma_1 + sigma_3))


def envelope(axes, angle, right, label, **line):
    """Draws tau = sigma tan phi, phi in radians."""
    axes.plot([0, right], [0, right * math.tan(angle)], label=f"{label}: $\\varphi$ = {math.degrees(angle):.2f}°", **line)


def draw(stages, options):
    tests = drained_tests(stages)
    rising = [why for why in map(still_rising, tests) if why]
    tests = [test for test in tests if not still_rising(test)]
    if not tests:
        raise ValueError("; ".join(rising))
    figure, axes = plt.subplots(figsize=(8, 4.6))
    states = np.array([peak_state(test) for test in tests]) / 1e3
    right = 1.06 * float(np.max(states.sum(axis=1)))
    around = np.linspace(0, math.pi, 400)
    for test, (centre, radius), colour in zip(tests, states, records.pressure_colours(len(tests))):
        x, y = centre + radius * np.cos(around), radius * np.sin(around)
        axes.fill_between(x, 0, y, color=colour, alpha=0.08, linewidth=0)
        axes.plot(x, y, color=colour, label=f"{records.plain(test.pressure / 1e3)} kPa")
    peak = math.asin(records.sine_through_origin(*states.T))
    envelope(axes, peak, right, "peak", color="crimson", linewidth=1.6)
    text = f"peak friction angle {math.degrees(peak):.3f} degrees"
    large = [large_strain_angle(test) for test in tests]
    if None not in large:
        mean = sum(large) / len(large)
        envelope(axes, mean, right, "12 to 15 % strain", color="0.35", linestyle=(0, (5, 3)))
        text += f", at large strain {math.degrees(mean):.3f} degrees"
    axes.set_xlim(0, right)
    axes.set_ylim(0, max(1.12 * float(states[:, 1].max()), right * math.tan(peak)))
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("normal stress $\\sigma$, compression positive (kPa)")
    axes.set_ylabel("shear stress $\\tau$ (kPa)")
    axes.legend(title="lateral pressure $\\sigma_r$, envelope", loc="upper left", fontsize=9)
    kinds = " and ".join(dict.fromkeys(test.test_in_words() for test in tests))
    axes.set_title(f"{kinds}: Mohr circles at peak", fontsize=11, loc="left")
    figure.savefig(options.output)
    return f"{options.output}: {text}" + "".join(f"\nwarning: not drawn: {why}" for why in rising)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="mohr.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="mohr.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser)
