#!/usr/bin/env python3
"""Mohr circles at peak and their envelope: mohr.py RECORDS.h5... -o mohr.png (folders stand for their *.h5).

The peak of a test is its record with the largest major principal stress, unsmoothed. The envelope passes through the
origin: t = s sin phi by least squares over the tests, s = (sigma_1 + sigma_3)/2, t = (sigma_1 - sigma_3)/2. Where all
tests reach 15 % axial strain, the mean of their angles from 12 to 15 % is drawn beside it. Compression positive.
"""

import argparse
import math

import matplotlib.pyplot as plt
import numpy as np

import records

LARGE_STRAIN = (0.12, 0.15)


def peak_state(test):
    """s and t, Pa, of the record with the largest major principal stress."""
    sigma_1, sigma_3 = test.principal()
    peak = int(np.argmax(sigma_1))
    return 0.5 * (sigma_1[peak] + sigma_3[peak]), 0.5 * (sigma_1[peak] - sigma_3[peak])


def large_strain_angle(test):
    """Friction angle, radians, of the mean state over the large strains; None for a test that ends before 15 %."""
    slack = 1e-9  # recorded strains are round numbers up to round-off
    if test.strain.max() < LARGE_STRAIN[1] - slack:
        return None
    inside = (test.strain >= LARGE_STRAIN[0] - slack) & (test.strain <= LARGE_STRAIN[1] + slack)
    sigma_1, sigma_3 = (stress[inside].mean() for stress in test.principal())
    return math.asin((sigma_1 - sigma_3) / (sigma_1 + sigma_3))


def envelope(axes, angle, right, label, **line):
    """Draws tau = sigma tan phi, phi in radians."""
    axes.plot([0, right], [0, right * math.tan(angle)], label=f"{label}: $\\varphi$ = {math.degrees(angle):.2f}°", **line)


def draw(tests, options):
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
    axes.legend(title="lateral pressure, envelope", loc="upper left", fontsize=9)
    axes.set_title("Mohr circles at peak", fontsize=11, loc="left")
    figure.savefig(options.output)
    return f"{options.output}: {text}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="mohr.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="mohr.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser)
