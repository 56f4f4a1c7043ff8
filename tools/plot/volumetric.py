#!/usr/bin/env python3
"""Volumetric curves: volumetric.py RECORDS.h5... -o volumetric.png (folders stand for their *.h5).

Left, void ratio against the driving strain of each stage with records; right, against p (on a logarithmic axis where it
changes by more than three), where the state goes to the critical state line. Needs void_ratio among [output] quantities,
as it is by default.
"""

import argparse

import records  # first: it says which package is missing
import matplotlib.pyplot as plt

SPAN = 1e-3  # of the axis of void ratio at least


def draw(stages, options):
    figure, (by_strain, by_pressure) = plt.subplots(1, 2, figsize=(9.5, 4.2), sharey=True)
    for stage, colour in zip(stages, records.pressure_colours(len(stages))):
        void_ratio = stage.column("void_ratio")
        p, _ = stage.invariants()
        by_strain.plot(100 * stage.strain, void_ratio, color=colour, label=stage.label)
        carried = p > 0
        by_pressure.plot(p[carried] / 1e3, void_ratio[carried], color=colour)
        by_pressure.plot(p[0] / 1e3, void_ratio[0], "o", color=colour, markersize=4)
    strains = list(dict.fromkeys(stage.strain_in_words() for stage in stages))
    by_strain.set_xlabel(strains[0] if len(strains) == 1 else "driving strain of the stage (%)")
    by_strain.set_ylabel("void ratio $e$")
    # At constant volume the void ratio changes by round-off alone: a level line, not its last digits.
    low, high = by_strain.get_ylim()
    if high - low < SPAN:
        by_strain.set_ylim(0.5 * (low + high - SPAN), 0.5 * (low + high + SPAN))
        by_strain.ticklabel_format(axis="y", useOffset=False)
    by_strain.legend(fontsize=8)
    pressures = [p for stage in stages for p in stage.invariants()[0] if p > 0]
    if max(pressures) > 3 * min(pressures):
        by_pressure.set_xscale("log")
    by_pressure.set_xlabel("mean stress $p$ (kPa)")
    figure.suptitle("Volumetric curves", fontsize=11, x=0.12, ha="left")
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(stages), 'stage')}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="volumetric.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="volumetric.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=records.read_driven_stages)
