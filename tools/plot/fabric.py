#!/usr/bin/env python3
"""Fabric against strain: fabric.py RECORDS.h5... -o fabric.png (a folder means its *.h5).

Above, the anisotropy Fa of the contact normals against the driving strain of each stage with records (continued stages
are joined); below, the coordination number and the fraction of sliding contacts, where the files have them. Mean and band
over specimens as in stress_strain.py.
"""

import argparse

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt


def draw(stages, options):
    rows = [("fabric_anisotropy", "fabric anisotropy $F_a$")]
    rows += [(name, label) for name, label in (("coordination_number", "coordination number $Z$"),
                                               ("sliding_fraction", "sliding fraction"))
             if all(stage.has(name) for stage in stages)]
    drawn = kinds.curves_of(kinds.joined(stages), options.colour)
    figure, axes = plt.subplots(len(rows), 1, figsize=(6.4, 1.2 + 1.8 * len(rows)), sharex=True, squeeze=False)
    for row, (name, label) in zip(axes[:, 0], rows):
        for curve in drawn:
            curve.draw(row, lambda stage: stage.column(name), label=row is axes[0, 0], each=options.each, scale=(100, 1))
        row.set_ylabel(label)
        row.set_ylim(bottom=0)
    kinds.legend(axes[0, 0], None if options.each else kinds.band_in_words(drawn))
    strains = list(dict.fromkeys(stage.strain_in_words() for stage in stages))
    axes[-1, 0].set_xlabel(strains[0] if len(strains) == 1 else "driving strain of the stage (%)")
    axes[0, 0].set_title("Fabric", fontsize=11, loc="left")
    figure.align_ylabels()
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(stages), 'stage')}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="fabric.py", description=__doc__.splitlines()[0])
    kinds.add_options(parser, "fabric.png")
    records.run(draw, parser)
