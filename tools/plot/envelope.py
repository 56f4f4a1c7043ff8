#!/usr/bin/env python3
"""Response envelopes: envelope.py RECORDS.h5 -o envelope.png (every stage of kind envelope).

Left, the strains of the probes, right, their changes of stress (given or resulting), axial against lateral,
compression positive; in 3D lateral is the root of two times the mean of the two (Rendulic plane). Colours and numbers show
the direction of the strain of the probe.
"""

import argparse
import math

import records  # first: it names a missing package
import matplotlib.pyplot as plt
import numpy as np


def plane(tensor, dimension):
    """Lateral and axial coordinates, compression positive."""
    if dimension == 2:
        return tensor[:, 0, 0], tensor[:, 1, 1]
    return (tensor[:, 0, 0] + tensor[:, 1, 1]) / math.sqrt(2), tensor[:, 2, 2]


def number_directions(axis, strain, lateral, axial, dimension):
    """Every third probe with the direction of its strain, degrees from the lateral axis."""
    across, along = plane(strain, dimension)
    for k in range(0, len(axial), 3):
        degrees = round(math.degrees(math.atan2(along[k], across[k]))) % 360
        size = math.hypot(lateral[k], axial[k]) or 1
        axis.annotate(f"{degrees}°", (lateral[k], axial[k]), xytext=(-13 * lateral[k] / size, -13 * axial[k] / size),
                      textcoords="offset points", ha="center", va="center", fontsize=7, color="0.3")


def draw(stages, options):
    stages = [stage for stage in stages if stage.kind == "envelope"]
    if not stages:
        raise ValueError("no stage of kind envelope in there; run protocols/envelope.toml")
    figure, axes = plt.subplots(len(stages), 2, figsize=(8.4, 4 * len(stages)), squeeze=False)
    for (strains, stresses), stage in zip(axes, stages):
        identity = np.eye(stage.dimension)
        strain = identity - stage.deformation[1:]
        change = stage.stress[1:] - stage.stress[0]
        root, names = ("", ("y", "x")) if stage.dimension == 2 else ("\\sqrt{2}\\,", ("z", "r"))
        for axis, tensor, unit, letter in ((strains, 1e4 * strain, "$10^{-4}$", "\\varepsilon"),
                                           (stresses, change / 1e3, "kPa", "\\sigma")):
            lateral, axial = plane(tensor, stage.dimension)
            axis.plot(np.append(lateral, lateral[0]), np.append(axial, axial[0]), color="0.6", linewidth=0.9)
            axis.scatter(lateral, axial, c=np.linspace(0, 1, len(axial), endpoint=False), cmap="twilight", vmax=1,
                         edgecolor="0.35", linewidth=0.4, s=22, zorder=3)
            number_directions(axis, strain, lateral, axial, stage.dimension)
            axis.plot(0, 0, "+", color="k")
            axis.set_aspect("equal", adjustable="datalim")
            axis.set_xlabel(f"${root}\\Delta{letter}_{{{names[1]}}}$ ({unit})")
            axis.set_ylabel(f"$\\Delta{letter}_{{{names[0]}}}$ ({unit})")
        strains.set_title(stage.label, fontsize=10, loc="left")
    figure.suptitle("Response envelopes", fontsize=11, x=0.12, ha="left")
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(stages), 'envelope')}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="envelope.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs=1, help="record file")
    parser.add_argument("-o", "--output", default="envelope.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=records.read_stages)
