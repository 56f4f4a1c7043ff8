#!/usr/bin/env python3
"""Contact rose: rose.py S.h5|R.h5... -o rose.png [--of normals|branches|orientations] (of record files the last state).

Left, the density E of contact normals over their direction (or of branches, or of the long axes of ellipses), bars of 10
degrees, with the fit E = (1 + a cos 2(theta - theta_a))/2 pi from the fabric tensor; 1/2 pi is isotropic. Right, the mean
normal force in each direction over the mean of all (not of orientations). Of several files one row each; --together makes
one rose of them all. 3D: the angle is that to the first axis in the plane (--plane xz, xy, yz), each direction weighted
by the part of it in that plane.
"""

import argparse
import math
import pathlib

import records  # first: it names a missing package
import state as states
import matplotlib.pyplot as plt
import numpy as np


BARS = 36
EDGES = np.linspace(0, 2 * math.pi, BARS + 1)
MIDDLE, WIDTH = 0.5 * (EDGES[1:] + EDGES[:-1]), 2 * math.pi / BARS


def directions(state, of):
    """Unit vectors, one a row."""
    if of == "orientations":
        if not state.ellipses:
            raise ValueError(f"{state.path}: has round grains, and so no orientations; leave --of out")
        turn = np.radians(state.angle)
        return np.stack([np.cos(turn), np.sin(turn)], axis=1)
    if len(state.branch) == 0 or not state.normal_force.sum() > 0:
        raise ValueError(f"{state.path}: has no contact that carries a force, and so no rose; compress it first")
    return state.normal if of == "normals" else state.branch / np.linalg.norm(state.branch, axis=1, keepdims=True)


def plane_of(state, plane):
    """Numbers of the two axes of the plane."""
    if state.dimension == 2 and plane not in (None, "xy"):
        raise ValueError(f"--plane {plane}: {state.path} is 2D; allowed: xy; leave --plane out")
    return ["xyz".index(letter) for letter in plane or ("xy" if state.dimension == 2 else "xz")]


def number_axes(rose, plane, top, every):
    """Circles with their numbers, and the names of the axes of the plane."""
    rose.set_ylim(0, top)
    ticks = np.arange(every, 0.9 * top, every)  # a number at the rim would run into those of the angles
    rose.set_yticks(ticks, labels=[f"{tick:.3g}" for tick in ticks], fontsize=7, color="k")
    rose.set_rlabel_position(75)
    named = {0: "$" + "xyz"[plane[0]] + "$", 90: "$" + "xyz"[plane[1]] + "$"}
    rose.set_xticks(np.radians(np.arange(0, 360, 30)),
                    labels=[named.get(degrees, f"{degrees}°") for degrees in range(0, 360, 30)], fontsize=8)
    rose.tick_params(pad=0)


def draw_density(rose, plane, of, angle, weight, count):
    """Bars of the density and the fit; words for the fit."""
    density = count / count.sum() * BARS / (2 * math.pi)
    rose.bar(MIDDLE, density, WIDTH, color="tab:blue", alpha=0.45, edgecolor="tab:blue", linewidth=0.5)
    c = np.average(np.cos(2 * angle), weights=weight)
    s = np.average(np.sin(2 * angle), weights=weight)
    a, direction = 2 * math.hypot(c, s), 0.5 * math.atan2(s, c)
    around = np.linspace(0, 2 * math.pi, 361)
    rose.plot(around, (1 + a * np.cos(2 * (around - direction))) / (2 * math.pi), color="crimson", linewidth=1.4)
    rose.plot(around, np.full_like(around, 1 / (2 * math.pi)), color="0.4", linewidth=0.7, linestyle="--")
    degrees = math.degrees(direction) % 180
    number_axes(rose, plane, 1.08 * max(float(density.max()), (1 + a) / (2 * math.pi)), 0.1)
    noun = "grains" if of == "orientations" else "contacts"
    rose.set_title(f"density of {of}, $a$ = {a:.2f} at {degrees:.0f}°, {len(angle)} {noun}", fontsize=9, pad=12)
    return f"a = {a:.3f} at {degrees:.0f} degrees, {len(angle)} {noun}"


def draw_row(figure, place, found, options):
    """The roses of one or several states in a row of a figure; words about them."""
    rows, columns, row = place
    plane = plane_of(found[0], options.plane)
    inside = np.concatenate([directions(state, options.of)[:, plane] for state in found])
    weight = np.linalg.norm(inside, axis=1)
    angle = np.arctan2(inside[:, 1], inside[:, 0])
    both = np.concatenate([angle, angle + math.pi]) % (2 * math.pi)
    weights = np.tile(weight, 2)
    count, _ = np.histogram(both, EDGES, weights=weights)
    rose = figure.add_subplot(rows, columns, columns * row + 1, projection="polar")
    told = draw_density(rose, plane, options.of, angle, weight, count)
    if len(found) == 1:
        rose.set_ylabel(pathlib.Path(found[0].path).name, fontsize=9, labelpad=24)
    if columns == 1:
        return told
    # Forces over the mean of their own specimen.
    relative = np.concatenate([state.normal_force / np.average(
        state.normal_force, weights=np.linalg.norm(directions(state, options.of)[:, plane], axis=1)) for state in found])
    force, _ = np.histogram(both, EDGES, weights=weights * np.tile(relative, 2))
    forces = figure.add_subplot(rows, columns, columns * row + 2, projection="polar")
    ratio = np.divide(force, count, out=np.zeros_like(force), where=count > 0)
    forces.bar(MIDDLE, ratio, WIDTH, color="tab:orange", alpha=0.5, edgecolor="tab:orange", linewidth=0.5)
    around = np.linspace(0, 2 * math.pi, 361)
    forces.plot(around, np.ones_like(around), color="0.4", linewidth=0.7, linestyle="--")
    number_axes(forces, plane, 1.08 * float(ratio.max()), 0.5 if ratio.max() < 3.5 else 1.0)
    forces.set_title("normal force over its mean", fontsize=9, pad=12)
    return told


def draw(found, options):
    groups = [found] if options.together else [[state] for state in found]
    columns = 1 if options.of == "orientations" else 2
    figure = plt.figure(figsize=(4.2 * columns, 4.2 * len(groups)))
    lines = [draw_row(figure, (len(groups), columns, row), group, options) for row, group in enumerate(groups)]
    if options.together and len(found) > 1:
        figure.suptitle(f"{len(found)} specimens together", fontsize=10)
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: " + "; ".join(lines)


def read_same(paths):
    """The states, of one dimension."""
    found = states.read_states(paths)
    if len({state.dimension for state in found}) > 1:
        raise ValueError(f"{', '.join(map(str, paths))}: 2D and 3D states; give one kind")
    return found


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="rose.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="specimen or record files, or folders of them")
    parser.add_argument("-o", "--output", default="rose.png", help="figure to write (PNG, PDF or SVG)")
    parser.add_argument("--of", choices=["normals", "branches", "orientations"], default="normals", help="what is counted")
    parser.add_argument("--plane", choices=["xy", "xz", "yz"], help="of 3D states; default xz")
    parser.add_argument("--together", action="store_true", help="one rose of all files")
    records.run(draw, parser, read=read_same)
