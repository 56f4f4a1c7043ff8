#!/usr/bin/env python3
"""Rheology of dense flow: mu_I.py RECORDS.h5... -o mu_I.png (a folder means its *.h5).

One point a steady simple shear (protocol mu_I, or any simple shear at a given rate): friction mu = |sigma_ab| / sigma_bb
and void ratio against the inertial number, means over the last three fifths of the strain with standard errors from ten
blocks. The line is that of da Cruz et al. 2005 for discs of friction 0.4.
"""

import argparse
import math

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt
import numpy as np


BLOCKS = 10


def mean_and_error(values):
    """Mean, and its standard error from means of blocks longer than the correlations."""
    means = np.array([block.mean() for block in np.array_split(values, BLOCKS)])
    return values.mean(), means.std(ddof=1) / math.sqrt(BLOCKS)


def steady_state(stage):
    """Inertial number, mu and void ratio of one flow, each with its standard error."""
    if stage.kind != "simple_shear" or stage.cyclic:
        raise ValueError(f"{stage.path}: no simple shear one way; give records of `rvelab run mu_I`")
    if not np.median(stage.column("inertial_number")[1:]) > 0:
        raise ValueError(f"{stage.path}: the inertial number is 0: the shear was quasi-static; run it with "
                         "loading.mode=at_rate, as mu_I does")
    a, b = ("xyz".index(letter) for letter in stage.axis)
    steady = stage.strain > 0.4 * stage.strain[-1]
    if steady.sum() < 2 * BLOCKS:
        raise ValueError(f"{stage.path}: {steady.sum()} records of steady flow; at least {2 * BLOCKS} are needed")
    shear = 0.5 * (stage.stress[steady, a, b] + stage.stress[steady, b, a])
    normal = stage.stress[steady, b, b]
    mean, error = mean_and_error(-shear if shear.mean() < 0 else shear)
    friction = mean / normal.mean(), error / normal.mean()
    inertial = np.median(stage.column("inertial_number")[steady])
    return inertial, friction, mean_and_error(stage.column("void_ratio")[steady])


def draw(stages, options):
    flows = sorted((steady_state(stage) for stage in stages), key=lambda flow: flow[0])
    inertial = np.array([flow[0] for flow in flows])
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4.0))
    for axes, column, label in ((left, 1, "friction $\\mu = |\\sigma_{ab}|/\\sigma_{bb}$"), (right, 2, "void ratio $e$")):
        values = np.array([flow[column] for flow in flows])
        axes.errorbar(inertial, values[:, 0], yerr=values[:, 1], fmt="o", color="C0", markersize=4, capsize=3)
        kinds.log_axis(axes.xaxis, [inertial.min() / 2, 2 * inertial.max()])
        axes.set_xlabel("inertial number $I$")
        axes.set_ylabel(label)
    line = np.geomspace(inertial.min() / 2, 2 * inertial.max(), 100)  # a single flow has room around it too
    left.plot(line, 0.25 + 1.1 * line, color="0.5", label="$\\mu$ = 0.25 + 1.1 $I$ (da Cruz et al. 2005, discs)")
    left.legend(fontsize=8, loc="lower left", bbox_to_anchor=(-0.02, 0.99))  # above the points, wherever they are
    figure.suptitle("Steady shear at constant normal stress", fontsize=11, x=0.12, ha="left")
    figure.tight_layout()
    figure.savefig(options.output)
    lines = [f"I {records.plain(i)}: mu {records.with_error(*mu)}, void ratio {records.with_error(*e)}" for i, mu, e in flows]
    return "\n".join(lines + [f"{options.output}: {records.counted(len(flows), 'flow')}"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="mu_I.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="mu_I.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=records.read_driven_stages)
