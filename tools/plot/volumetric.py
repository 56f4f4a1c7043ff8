#!/usr/bin/env python3
"""Volumetric curves: volumetric.py RECORDS.h5... -o volumetric.png (a folder means its *.h5).

Left, void ratio against the driving strain of each stage with records (continued stages are joined, mean and band over
specimens as in stress_strain.py); right, against p (on a logarithmic axis where it changes by more than three), for every
specimen on its way to the critical state line. Needs void_ratio among [output] quantities, as it is by default.
"""

import argparse

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt
import numpy as np

SPAN = 1e-3  # of the axis of void ratio at least
LEAST_RANGE_OF_P = 0.1  # of p: if it is held, its tolerance must not fill the axis


def draw_by_pressure(axes, drawn):
    pressures = np.concatenate([stage.invariants()[0] for curve in drawn for stage in curve.stages]) / 1e3
    for curve in drawn:
        for stage in curve.stages:
            p, void_ratio = stage.invariants()[0] / 1e3, stage.column("void_ratio")
            carried = p > 0
            alone = len(curve.stages) == 1
            axes.plot(p[carried], void_ratio[carried], color=curve.colour, linestyle=curve.dashes,
                      linewidth=1.0 if alone else 0.6, alpha=1 if alone else 0.6)
            if p[0] > 0:
                axes.plot(p[0], void_ratio[0], "o", color=curve.colour, markersize=4 if alone else 2.5)
    carried = pressures[pressures > 0]
    if len(carried) and carried.max() > 3 * carried.min():
        kinds.log_axis(axes.xaxis, carried)
    else:
        kinds.least_span(axes, "x", LEAST_RANGE_OF_P * float(pressures.max()))
    axes.set_xlabel("mean stress $p$ (kPa)")


def draw(stages, options):
    drawn = kinds.curves_of(kinds.joined(stages), options.colour)
    figure, (by_strain, by_pressure) = plt.subplots(1, 2, figsize=(9, 4), sharey=True)
    for curve in drawn:
        curve.draw(by_strain, lambda stage: stage.column("void_ratio"), label=False, each=options.each, scale=(100, 1))
        by_pressure.plot([], [], color=curve.colour, linestyle=curve.dashes, label=curve.label)
    draw_by_pressure(by_pressure, drawn)
    strains = list(dict.fromkeys(stage.strain_in_words() for stage in stages))
    by_strain.set_xlabel(strains[0] if len(strains) == 1 else "driving strain of the stage (%)")
    by_strain.set_ylabel("void ratio $e$")
    # At constant volume the void ratio changes only by round-off: draw a horizontal line, not the last digits.
    kinds.least_span(by_strain, "y", SPAN)
    kinds.legend(by_pressure, None if options.each else kinds.band_in_words(drawn))
    by_strain.set_title("Volumetric curves", fontsize=11, loc="left")
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(stages), 'stage')}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="volumetric.py", description=__doc__.splitlines()[0])
    kinds.add_options(parser, "volumetric.png")
    records.run(draw, parser)
