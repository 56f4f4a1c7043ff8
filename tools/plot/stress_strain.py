#!/usr/bin/env python3
"""Stress ratio and volumetric strain: stress_strain.py RECORDS.h5... -o stress_strain.png (folders: their *.h5).

Above, q/p against axial strain, q = sqrt(s:s/2) in 2D (then q/p is the sine of the mobilised friction angle) and
sqrt(3 s:s/2) in 3D. Below, volumetric strain 1 - V/V0, compression positive, so that dilation goes down. Records at
which the lateral stress was not held are crossed.
"""

import argparse

import matplotlib.pyplot as plt

import records


def draw(tests, options):
    figure, (ratio, volume) = plt.subplots(2, 1, figsize=(7, 6.6), sharex=True, height_ratios=(3, 2))
    unheld = 0
    for test, colour in zip(tests, records.pressure_colours(len(tests))):
        p, q = test.invariants()
        strain = 100 * test.strain
        ratio.plot(strain, q / p, color=colour, label=f"{records.plain(test.pressure / 1e3)} kPa")
        volume.plot(strain, 100 * test.volumetric_strain, color=colour)
        missed = ~test.held
        unheld += int(missed.sum())
        ratio.plot(strain[missed], (q / p)[missed], "x", color=colour, markersize=4)
    if unheld:
        ratio.plot([], [], "x", color="0.3", markersize=4, label="lateral stress not held")
    dimension = tests[0].dimension
    ratio.set_ylabel("$q/p$" + (" = $(\\sigma_1 - \\sigma_3)/(\\sigma_1 + \\sigma_3)$" if dimension == 2 else ""))
    ratio.set_ylim(bottom=0)
    ratio.legend(title="lateral pressure", ncols=2, fontsize=9)
    ratio.set_title("Biaxial compression" if dimension == 2 else "Triaxial compression", fontsize=11, loc="left")
    volume.axhline(0, color="0.5", linewidth=0.8)
    volume.set_ylabel("volumetric strain $\\varepsilon_v$ (%)\ndilation negative")
    volume.set_xlabel("axial strain $\\varepsilon_a$ (%)")
    volume.set_xlim(left=0)
    figure.align_ylabels()
    figure.savefig(options.output)
    return f"{options.output}: {len(tests)} tests, {unheld} records with the lateral stress not held"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="stress_strain.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="stress_strain.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser)
