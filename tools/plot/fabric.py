#!/usr/bin/env python3
"""Fabric against strain: fabric.py RECORDS.h5... -o fabric.png (folders stand for their *.h5).

Above, the anisotropy Fa of the contact normals against the driving strain of each stage with records; below, the
coordination number and the fraction of sliding contacts, where the file has them.
"""

import argparse

import records  # first: it says which package is missing
import matplotlib.pyplot as plt


def draw(stages, options):
    extra = [(name, label) for name, label in (("coordination_number", "coordination number $Z$"),
                                               ("sliding_fraction", "sliding fraction")) if stages[0].has(name)]
    figure, axes = plt.subplots(1 + len(extra), 1, figsize=(7, 3 + 1.8 * len(extra)), sharex=True, squeeze=False)
    rows = axes[:, 0]
    for stage, colour in zip(stages, records.pressure_colours(len(stages))):
        rows[0].plot(100 * stage.strain, stage.column("fabric_anisotropy"), color=colour, label=stage.label)
        for row, (name, _) in zip(rows[1:], extra):
            row.plot(100 * stage.strain, stage.column(name), color=colour)
    rows[0].set_ylabel("fabric anisotropy $F_a$")
    rows[0].set_ylim(bottom=0)
    rows[0].legend(fontsize=8)
    for row, (_, label) in zip(rows[1:], extra):
        row.set_ylabel(label)
        row.set_ylim(bottom=0)
    strains = list(dict.fromkeys(stage.strain_in_words() for stage in stages))
    rows[-1].set_xlabel(strains[0] if len(strains) == 1 else "driving strain of the stage (%)")
    rows[0].set_title("Fabric", fontsize=11, loc="left")
    figure.align_ylabels()
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(stages), 'stage')}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="fabric.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="fabric.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=records.read_driven_stages)
