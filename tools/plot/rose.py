#!/usr/bin/env python3
"""Contact rose: rose.py S.h5|R.h5... -o rose.png (of record files the last state).

Left, the density E of contact normals over their direction, bars of 10 degrees, with the fit E = (1 + a cos 2(theta -
theta_a))/2 pi from the fabric tensor; right, the mean normal force in each direction over the mean of all. 3D: the angle
is that to the x axis in the plane of x and z, each contact weighted by the part of its normal in it.
"""

import argparse
import math

import records  # first: it says which package is missing
import state as states
import matplotlib.pyplot as plt
import numpy as np


BARS = 36


def draw(found, options):
    figure = plt.figure(figsize=(9, 4.4 * len(found)))
    lines = []
    for row, state in enumerate(found):
        if len(state.branch) == 0 or not state.normal_force.sum() > 0:
            raise ValueError(f"{state.path}: has no contact that carries a force, and so no rose; compress it first")
        normal = state.branch / np.linalg.norm(state.branch, axis=1, keepdims=True)
        plane = normal[:, [0, state.dimension - 1]]
        weight = np.linalg.norm(plane, axis=1)
        angle = np.arctan2(plane[:, 1], plane[:, 0])
        both = np.concatenate([angle, angle + math.pi]) % (2 * math.pi)
        edges = np.linspace(0, 2 * math.pi, BARS + 1)
        weights = np.tile(weight, 2)
        count, _ = np.histogram(both, edges, weights=weights)
        force, _ = np.histogram(both, edges, weights=weights * np.tile(state.normal_force, 2))
        density = count / count.sum() * BARS / (2 * math.pi)
        c = np.average(np.cos(2 * angle), weights=weight)
        s = np.average(np.sin(2 * angle), weights=weight)
        a, direction = 2 * math.hypot(c, s), 0.5 * math.atan2(s, c)
        middle, width = 0.5 * (edges[1:] + edges[:-1]), 2 * math.pi / BARS
        rose = figure.add_subplot(len(found), 2, 2 * row + 1, projection="polar")
        rose.bar(middle, density, width, color="tab:blue", alpha=0.45, edgecolor="tab:blue", linewidth=0.5)
        around = np.linspace(0, 2 * math.pi, 361)
        rose.plot(around, (1 + a * np.cos(2 * (around - direction))) / (2 * math.pi), color="crimson", linewidth=1.4)
        rose.set_title(f"{state.path.rsplit('/', 1)[-1]}: normals, a = {a:.3f} at {math.degrees(direction) % 180:.0f}°",
                       fontsize=10)
        mean = np.average(state.normal_force, weights=weight)
        forces = figure.add_subplot(len(found), 2, 2 * row + 2, projection="polar")
        ratio = np.divide(force, count, out=np.zeros_like(force), where=count > 0) / mean
        forces.bar(middle, ratio, width, color="tab:orange", alpha=0.5, edgecolor="tab:orange", linewidth=0.5)
        forces.set_title("mean normal force / mean", fontsize=10)
        for axes in (rose, forces):
            axes.set_yticklabels([])
        lines.append(f"a = {a:.4f} at {math.degrees(direction) % 180:.1f} degrees, {len(angle)} contacts")
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: " + "; ".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="rose.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="specimen or record files")
    parser.add_argument("-o", "--output", default="rose.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=states.read_states)
