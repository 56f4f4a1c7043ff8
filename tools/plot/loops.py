#!/usr/bin/env python3
"""Cyclic loops: loops.py RECORDS.h5 -o loops.png (the last cyclic stage with records).

Left, the driving stress against the driving strain: shear stress for simple shear, axial minus lateral stress for
compression; right, against p: the stress path to liquefaction. Below, p over its start against the number of cycles.
Colours show the cycle.
"""

import argparse
import math

import records  # first: it names a missing package
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import colors
from matplotlib.collections import LineCollection


def driving_stress(stage):
    """Pa, growing with the driving strain."""
    if len(stage.axis) == 2:
        a, b = ("xyz".index(letter) for letter in stage.axis)
        return -0.5 * (stage.stress[:, a, b] + stage.stress[:, b, a]), f"shear stress $\\sigma_{{{stage.axis}}}$ (kPa)"
    axis = "xyz".index(stage.axis) if stage.axis else stage.dimension - 1
    lateral = [k for k in range(stage.dimension) if k != axis]
    stress = stage.stress[:, axis, axis] - sum(stage.stress[:, k, k] for k in lateral) / len(lateral)
    return stress, "axial minus lateral stress $\\sigma_a - \\sigma_r$ (kPa)"


def cycles_of(strain):
    """Number of cycles at each record: a quarter to the first reversal, half a cycle from each reversal to the next, in between
    by the strain path. After the last reversal a half cycle is as long as the one before it."""
    direction = np.sign(np.diff(strain))
    turns = np.flatnonzero(direction[1:] * direction[:-1] < 0) + 1
    ends = [0, *turns, len(strain) - 1]
    cycles = np.zeros(len(strain))
    done, share, half = 0.0, 0.25, 0.0
    for begin, end in zip(ends[:-1], ends[1:]):
        travelled = np.abs(strain[begin:end + 1] - strain[begin])
        whole = max(travelled[-1], half) if end == ends[-1] else travelled[-1]
        cycles[begin:end + 1] = done + share * travelled / whole
        half = travelled[-1] * 0.5 / share
        done, share = done + share, 0.5
    return cycles


def add_line(axes, x, y, cycles, scale):
    """A line whose colour shows the cycle."""
    points = np.stack([x, y], axis=1)
    line = LineCollection(np.stack([points[:-1], points[1:]], axis=1), cmap=scale.cmap, norm=scale.norm, linewidths=1.0,
                          capstyle="round")
    line.set_array(0.5 * (cycles[1:] + cycles[:-1]))
    axes.add_collection(line)
    axes.autoscale_view()


def scale_of(cycles):
    """One colour per cycle, up to 20 of them; beyond, a continuous scale."""
    count = max(1, math.ceil(cycles[-1] - 1e-9))
    cmap = plt.get_cmap("viridis")
    if count <= 20:
        shades = colors.ListedColormap(cmap(np.linspace(0.0, 0.88, count)))
        return plt.cm.ScalarMappable(colors.BoundaryNorm(np.arange(count + 1), count), shades), count
    return plt.cm.ScalarMappable(colors.Normalize(0, count), cmap), count


def draw(stages, options):
    cyclic = [stage for stage in stages if stage.cyclic]
    if not cyclic:
        raise ValueError(f"{stages[-1].path}: monotonic, its driving strain never turns; give records of cyclic_shear, "
                         "cyclic_liquefaction or a stage with cycles > 0 (stress_strain.py draws this one)")
    stage = cyclic[-1]
    stress, label = driving_stress(stage)
    p, _ = stage.invariants()
    cycles = cycles_of(stage.strain)
    scale, count = scale_of(cycles)
    figure = plt.figure(figsize=(9.5, 6.4), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(3, 1.6))
    loop, path, decay = (figure.add_subplot(place) for place in (grid[0, 0], grid[0, 1], grid[1, :]))
    add_line(loop, 100 * stage.strain, stress / 1e3, cycles, scale)
    loop.set_xlabel(stage.strain_in_words())
    loop.set_ylabel(label)
    add_line(path, p / 1e3, stress / 1e3, cycles, scale)
    path.set_xlabel("mean stress $p$ (kPa)")
    path.set_ylabel(label)
    path.set_xlim(left=min(0, 1.05 * float(p.min()) / 1e3))
    add_line(decay, cycles, p / p[0], cycles, scale)
    if p.min() < 0.5 * p[0]:
        decay.axhline(0.02, color="0.5", linewidth=0.8, linestyle="--", label="$p/p_0$ = 0.02, liquefied")
        decay.legend(fontsize=8, loc="upper right")
    decay.set_title(f"lowest $p/p_0$ = {records.plain(p.min() / p[0])}, {cycles[-1]:.1f} cycles", fontsize=9, loc="left")
    decay.set_xlabel("cycles")
    decay.set_ylabel("$p/p_0$")
    decay.set_xlim(left=0)
    decay.set_ylim(bottom=min(0, 1.05 * float(p.min() / p[0])))
    bar = figure.colorbar(scale, ax=[loop, path], aspect=30, pad=0.02)
    bar.set_label("cycle")
    if count <= 20:
        bar.set_ticks(np.arange(count) + 0.5, labels=[str(k + 1) for k in range(count)])
        bar.ax.tick_params(length=0)
    figure.suptitle(f"{stage.test_in_words()}: {stage.label}", fontsize=11, x=0.06, ha="left")
    figure.savefig(options.output)
    return (f"{options.output}: {cycles[-1]:.1f} cycles, p from {records.plain(p[0] / 1e3)} to "
            f"{records.plain(p[-1] / 1e3)} kPa, lowest {records.plain(p.min() / 1e3)} kPa")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="loops.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs=1, help="record file")
    parser.add_argument("-o", "--output", default="loops.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser)
