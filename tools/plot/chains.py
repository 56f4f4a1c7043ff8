#!/usr/bin/env python3
"""Force chains with the outline of the cell: chains.py S.h5|R.h5 -o chains.png (2D; of a record file the last state).

Each contact is a line along its branch, as wide as its normal force; contacts that carry more than the mean are red,
the others blue. Ellipses are drawn as they lie. The cell is dashed, grains of one cell are drawn once.
"""

import argparse

import records  # first: it says which package is missing
import state as states
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.patches import Ellipse, Polygon


def draw_network(axes, state):
    """Grains, forces and cell of a state; the mean normal force, N, and how many contacts carry more."""
    if state.dimension != 2:
        raise ValueError(f"{state.path}: is 3D; force chains are drawn in 2D (export --format xdmf shows it in "
                         "ParaView)")
    axes.grid(False)
    grains = [Ellipse(x, 2 * a, 2 * b, angle=turn) for x, (a, b), turn in zip(state.position, state.axes, state.angle)]
    axes.add_collection(PatchCollection(grains, facecolor="0.94", edgecolor="0.78", linewidth=0.4))
    mean = state.normal_force.mean() if len(state.normal_force) else 1.0
    begin = state.position[state.first]
    lines = np.stack([begin, begin + state.branch], axis=1)
    strong = state.normal_force > mean
    for chosen, colour in ((~strong, "tab:blue"), (strong, "crimson")):
        axes.add_collection(LineCollection(lines[chosen], linewidths=1.6 * state.normal_force[chosen] / mean,
                                           colors=colour, capstyle="round"))
    a, b = state.cell[:, 0], state.cell[:, 1]
    axes.add_patch(Polygon([-(a + b) / 2, (a - b) / 2, (a + b) / 2, (b - a) / 2], fill=False, linestyle="--",
                           edgecolor="k", linewidth=1.2))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    return mean, int(strong.sum())


def draw(found, options):
    state = found[0]
    figure, axes = plt.subplots(figsize=(7, 7))
    mean, strong = draw_network(axes, state)
    axes.set_title(f"Normal forces, mean {mean:.3g} N; red: above the mean", fontsize=11, loc="left")
    figure.savefig(options.output)
    return f"{options.output}: {len(state.normal_force)} contacts, {strong} above the mean force of {mean:.4g} N"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="chains.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs=1, help="specimen or record file")
    parser.add_argument("-o", "--output", default="chains.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=states.read_states)
