#!/usr/bin/env python3
"""Bonds and cracks: bonds.py S.h5|R.h5|FOLDER... -o bonds.png (of record files the last state).

An intact bond is a line between the centres of its grains. A broken bond is a crack across that line, of the width of the bond: red in
tension, blue in shear; it is not drawn if its grains are farther apart than twice the length of the bond. The cell
is dashed. In 3D a slab is shown, a mean diameter on both sides of the middle of the cell along y, projected onto the plane of x
and z.
"""

import argparse
import math
import pathlib

import records  # first: it names a missing package
import chains
import state as states
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

TENSION, SHEAR, INTACT = "crimson", "tab:blue", "0.25"


def lines_of(state):
    """Segments (k, 2, 2) m in the plane of the figure: intact bonds, cracks in tension, cracks in shear."""
    plane = [0, state.dimension - 1]
    bonds = state.bonds
    seen = chains.in_slab(state, bonds.begin + 0.5 * bonds.branch)
    begin, branch = bonds.begin[:, plane], bonds.branch[:, plane]
    middle = begin + 0.5 * branch
    across = np.stack([-branch[:, 1], branch[:, 0]], axis=1)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
    half = bonds.radius[:, None] * across
    near = np.linalg.norm(bonds.branch, axis=1) <= 2 * bonds.length
    cracks = np.stack([middle - half, middle + half], axis=1)
    whole = np.stack([begin, begin + branch], axis=1)
    return whole[seen & (bonds.broken == 0)], cracks[seen & near & (bonds.broken == 1)], cracks[seen & near & (bonds.broken == 2)]


def draw_bonds(axes, state):
    """Grains, bonds, cracks and cell of a state."""
    scale = chains.draw_cell(axes, state)
    for lines, colour, width in zip(lines_of(state), (INTACT, TENSION, SHEAR), (1.2, 1.8, 1.8)):
        axes.add_collection(LineCollection(scale * lines, linewidths=width, colors=colour, capstyle="round"))
    axes.autoscale_view()


def counts(state):
    """How many bonds are intact, how many broke in tension, how many in shear."""
    return [int((state.bonds.broken == mode).sum()) for mode in (0, 1, 2)]


def add_key(axes, **position):
    handles = [Line2D([], [], color=INTACT, linewidth=1.2, label="intact bond"),
               Line2D([], [], color=TENSION, linewidth=1.8, label="broken in tension"),
               Line2D([], [], color=SHEAR, linewidth=1.8, label="broken in shear")]
    axes.legend(handles=handles, fontsize=8, **position)


def expect_bonds(found):
    for each in found:
        if len(each.bonds.broken) == 0:
            raise ValueError(f"{each.path}: holds no bonds; give states of a test with a [[stage]] of kind = \"cement\"")


def draw(found, options):
    expect_bonds(found)
    columns = math.ceil(math.sqrt(len(found)))
    rows = math.ceil(len(found) / columns)
    figure = plt.figure(figsize=(8 * columns, 6 * rows), layout="constrained")
    told = []
    for k, state in enumerate(found):
        axes = figure.add_subplot(rows, columns, k + 1)
        draw_bonds(axes, state)
        intact, tension, shear = counts(state)
        name = pathlib.Path(state.path).name
        axes.set_title(f"{name}: {intact} bonds intact, {tension} broken in tension, {shear} in shear", fontsize=10, loc="left")
        told.append(f"{name}: {intact} bonds, {tension} broken in tension, {shear} in shear")
        if k == 0:
            add_key(axes, loc="upper left", bbox_to_anchor=(1.01, 1.02))
    figure.savefig(options.output)
    return f"{options.output}: " + "; ".join(told)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="bonds.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="specimen or record files, or folders of them")
    parser.add_argument("-o", "--output", default="bonds.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=states.read_states)
