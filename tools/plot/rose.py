#!/usr/bin/env python3
"""Contact rose: rose.py S.h5|R.h5... -o rose.png [--of normals|branches|orientations] (of record files the last state).

Left, the density E of contact normals over their direction (or of branches, or of the long axes of ellipses), bars of 10
degrees, with the fit E = (1 + a cos 2(theta - theta_a))/2 pi from the fabric tensor; right, the mean normal force in each
direction over the mean of all (not of orientations). 3D: the angle is that to the x axis in the plane of x and z, each
direction weighted by the part of it in that plane.
"""

import argparse
import math

import records  # first: it says which package is missing
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


def draw_density(rose, state, of, angle, weight, count):
    rose.bar(MIDDLE, count / count.sum() * BARS / (2 * math.pi), WIDTH, color="tab:blue", alpha=0.45, edgecolor="tab:blue",
             linewidth=0.5)
    c = np.average(np.cos(2 * angle), weights=weight)
    s = np.average(np.sin(2 * angle), weights=weight)
    a, direction = 2 * math.hypot(c, s), 0.5 * math.atan2(s, c)
    around = np.linspace(0, 2 * math.pi, 361)
    rose.plot(around, (1 + a * np.cos(2 * (around - direction))) / (2 * math.pi), color="crimson", linewidth=1.4)
    degrees = math.degrees(direction) % 180
    rose.set_title(f"{state.path.rsplit('/', 1)[-1]}: {of}, a = {a:.3f} at {degrees:.0f}°", fontsize=10)
    return f"a = {a:.4f} at {degrees:.1f} degrees, {len(angle)} {'grains' if of == 'orientations' else 'contacts'}"


def draw(found, options):
    columns = 1 if options.of == "orientations" else 2
    figure = plt.figure(figsize=(4.5 * columns, 4.4 * len(found)))
    lines = []
    for row, state in enumerate(found):
        plane = directions(state, options.of)[:, [0, state.dimension - 1]]
        weight = np.linalg.norm(plane, axis=1)
        angle = np.arctan2(plane[:, 1], plane[:, 0])
        both = np.concatenate([angle, angle + math.pi]) % (2 * math.pi)
        weights = np.tile(weight, 2)
        count, _ = np.histogram(both, EDGES, weights=weights)
        rose = figure.add_subplot(len(found), columns, columns * row + 1, projection="polar")
        lines.append(draw_density(rose, state, options.of, angle, weight, count))
        rose.set_yticklabels([])
        if columns == 1:
            continue
        force, _ = np.histogram(both, EDGES, weights=weights * np.tile(state.normal_force, 2))
        mean = np.average(state.normal_force, weights=weight)
        forces = figure.add_subplot(len(found), 2, 2 * row + 2, projection="polar")
        ratio = np.divide(force, count, out=np.zeros_like(force), where=count > 0) / mean
        forces.bar(MIDDLE, ratio, WIDTH, color="tab:orange", alpha=0.5, edgecolor="tab:orange", linewidth=0.5)
        forces.set_title("mean normal force / mean", fontsize=10)
        forces.set_yticklabels([])
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: " + "; ".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="rose.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="specimen or record files")
    parser.add_argument("-o", "--output", default="rose.png", help="figure to write (PNG, PDF or SVG)")
    parser.add_argument("--of", choices=["normals", "branches", "orientations"], default="normals", help="what is counted")
    records.run(draw, parser, read=states.read_states)
