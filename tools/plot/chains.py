#!/usr/bin/env python3
"""Force chains with the outline of the cell: chains.py S.h5|R.h5|FOLDER... -o chains.png (of record files the last state).

Several states are drawn side by side, each with its own mean force and key. Each contact is a line along its branch, as wide as its
normal force; forces above the mean are red, the others blue. Ellipses have their orientation. The cell is dashed,
and each grain is drawn once. In 3D a slab is shown, a mean diameter on both sides of the middle of the cell along y,
projected onto the plane of x and z.
"""

import argparse
import math
import pathlib

import records  # first: it names a missing package
import curves as kinds
import state as states
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Ellipse, Polygon

STRONG, WEAK = "crimson", "tab:blue"


def unit_of(state):
    """Factor and name of the unit of length of this specimen."""
    return kinds.length_unit(float(np.linalg.norm(state.cell, axis=0).max()))


def in_slab(state, points):
    """Rows of visible points: in 2D all, in 3D those near the middle of the cell along y."""
    if state.dimension == 2:
        return np.ones(len(points), bool)
    return np.abs(points[:, 1]) < state.mean_diameter


def patches_of(state, scale, rows):
    """Outlines of the grains, in the unit of the axes; of spheres where the middle plane or their equator cuts them."""
    if state.dimension == 2:
        return [Ellipse(scale * x, 2 * scale * a, 2 * scale * b, angle=turn)
                for x, (a, b), turn in zip(state.position[rows], state.axes[rows], state.angle[rows])]
    order = np.argsort(-state.position[rows][:, 1])
    return [Circle(scale * state.position[rows][k][[0, 2]], scale * state.radius[rows][k]) for k in order]


def outline_of(state):
    """Corners of the cell in the plane of the figure, m."""
    plane = [0, state.dimension - 1]
    a, b = state.cell[plane, 0], state.cell[plane, state.dimension - 1]
    return np.array([-(a + b) / 2, (a - b) / 2, (a + b) / 2, (b - a) / 2])


def draw_cell(axes, state):
    """Grains and cell of a state, under the lines that come after; the factor of lengths."""
    scale, unit = unit_of(state)
    axes.grid(False)
    rows = np.flatnonzero(in_slab(state, state.position))
    axes.add_collection(PatchCollection(patches_of(state, scale, rows), facecolor="0.94", edgecolor="0.78", linewidth=0.4))
    axes.add_patch(Polygon(scale * outline_of(state), fill=False, linestyle="--", edgecolor="k", linewidth=1.2))
    axes.set_aspect("equal")
    axes.set_xlabel(f"x ({unit})")
    axes.set_ylabel(f"{'xyz'[state.dimension - 1]} ({unit})")
    return scale


def draw_network(axes, state):
    """Grains, forces and cell of a state; the mean normal force, N, and how many contacts carry more."""
    scale, plane = draw_cell(axes, state), [0, state.dimension - 1]
    mean = state.normal_force.mean() if len(state.normal_force) else 1.0
    seen = in_slab(state, state.begin + 0.5 * state.branch)
    lines = scale * np.stack([state.begin, state.begin + state.branch], axis=1)[:, :, plane]
    strong = state.normal_force > mean
    for chosen, colour in ((~strong & seen, WEAK), (strong & seen, STRONG)):
        axes.add_collection(LineCollection(lines[chosen], linewidths=1.6 * state.normal_force[chosen] / mean,
                                           colors=colour, capstyle="round"))
    axes.autoscale_view()
    return mean, int(strong.sum())


def force_in_words(newton):
    """A force with a unit that gives it few digits."""
    for factor, unit in ((1e-3, "kN"), (1, "N"), (1e3, "mN"), (1e6, "µN")):
        if newton * factor >= 1:
            return f"{newton * factor:.3g} {unit}"
    return f"{newton:.3g} N"


def add_key(axes, mean):
    """Lines of known force outside of the grains."""
    handles = [Line2D([], [], color=STRONG, linewidth=4.8, label=f"{force_in_words(3 * mean)} (three times the mean)"),
               Line2D([], [], color=WEAK, linewidth=1.6, label=f"{force_in_words(mean)} (mean)"),
               Line2D([], [], color="k", linestyle="--", linewidth=1.2, label="periodic cell")]
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.02), fontsize=8, title="normal force",
                title_fontsize=8, alignment="left")


def draw_state(axes, state, title):
    """One state with its key under a title; what the summary says of it."""
    mean, strong = draw_network(axes, state)
    add_key(axes, mean)
    slab = "" if state.dimension == 2 else ", slab of two mean diameters"
    axes.set_title(title + slab, fontsize=11, loc="left")
    return f"{len(state.normal_force)} contacts, {strong} above the mean force of {mean:.3g} N"


def draw(found, options):
    title = "Normal forces, red above the mean"
    if len(found) == 1:
        figure, axes = plt.subplots(figsize=(6, 6))
        told = draw_state(axes, found[0], title)
        figure.savefig(options.output)
        return f"{options.output}: {told}"
    columns = math.ceil(math.sqrt(len(found)))
    rows = math.ceil(len(found) / columns)
    figure = plt.figure(figsize=(8 * columns, 6 * rows))  # with room for the key beside each state
    lines = []
    for k, state in enumerate(found):
        name = pathlib.Path(state.path).name
        lines.append(f"{name}: {draw_state(figure.add_subplot(rows, columns, k + 1), state, name)}")
    figure.suptitle(title, fontsize=12)
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: " + "; ".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="chains.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="specimen or record files, or folders of them")
    parser.add_argument("-o", "--output", default="chains.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=states.read_states)
