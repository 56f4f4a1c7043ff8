#!/usr/bin/env python3
"""A fit over its data: fit.py FOLDER -o fit.png (the folder of `rvelab fit -o`).

With measured curves each is drawn with its errors, below it the mean of the tests with the fitted parameters and the band of
its 95 % interval. Without curves, each target against each parameter: the tests, the target with its error, and the 95 %
interval of the parameter. Strains in per cent, stresses in kPa.
"""

import argparse
import csv
import json
import pathlib

import records  # first: it says which package is missing
import matplotlib.pyplot as plt
import numpy as np

NAMES = {"q_over_p": ("$q/p$", 1), "deviator": ("$\\sigma_1 - \\sigma_3$ (kPa)", 1e-3),
         "volumetric_strain": ("volumetric strain (%)", 100), "void_ratio": ("void ratio $e$", 1)}
ABSCISSAE = {"strain": ("strain (%)", 100), "p": ("$p$ (kPa)", 1e-3)}


def intervals(fit):
    """One line a parameter, for the title."""
    return "\n".join(f"{each['key']} = {each['mean']:.3g}, 95 %: {each['low_95']:.3g} to {each['high_95']:.3g}"
                     for each in fit["parameters"])


def draw_curves(rows, fit):
    numbers = sorted({int(row["curve"]) for row in rows})
    figure, axes = plt.subplots(len(numbers), 1, figsize=(6.4, 3.2 * len(numbers)), squeeze=False)
    for axis, number in zip(axes[:, 0], numbers):
        own = [row for row in rows if int(row["curve"]) == number]
        (label, scale), (below, across) = NAMES[own[0]["quantity"]], ABSCISSAE[own[0]["abscissa"]]
        column = lambda name, factor: factor * np.array([float(row[name]) for row in own])
        x = column("x", across)
        axis.fill_between(x, column("low_95", scale), column("high_95", scale), color="tab:blue", alpha=0.25, linewidth=0,
                          label="fit, 95 %")
        axis.plot(x, column("fit", scale), color="tab:blue", label="fit")
        axis.errorbar(x, column("measured", scale), yerr=column("error", scale), fmt="o", color="0.2", markersize=4,
                      linewidth=1, label="measured")
        if own[0]["abscissa"] == "p":
            axis.set_xscale("log")
        axis.set_ylabel(label)
        axis.set_xlabel(below)
        axis.legend(fontsize=9)
    axes[0, 0].set_title(intervals(fit), fontsize=9, loc="left")
    return figure


def draw_targets(fit):
    keys, targets = [each["key"] for each in fit["parameters"]], fit["targets"]
    figure, axes = plt.subplots(len(targets), len(keys), figsize=(4.2 * len(keys), 3.2 * len(targets)), squeeze=False,
                                sharey="row")
    for row, target in enumerate(targets):
        for axis, key, parameter in zip(axes[row], keys, fit["parameters"]):
            tests = [test for test in fit["tests"] if test["targets"] and test["targets"][row] is not None]
            axis.plot([test["values"][key] for test in tests], [test["targets"][row] for test in tests], "o", color="0.5",
                      markersize=4, label="tests")
            error = target["standard_error"]
            axis.axhspan(target["value"] - 1.96 * error, target["value"] + 1.96 * error, color="tab:orange", alpha=0.3,
                         linewidth=0)
            axis.axhline(target["value"], color="tab:orange", label="target")
            axis.axvspan(parameter["low_95"], parameter["high_95"], color="tab:blue", alpha=0.15, linewidth=0,
                         label="95 % interval")
            axis.set_xlabel(key)
        axes[row, 0].set_ylabel(target["name"])
    axes[0, 0].legend(fontsize=8)
    axes[0, 0].set_title(intervals(fit), fontsize=9, loc="left")
    return figure


def main():
    parser = argparse.ArgumentParser(prog="fit.py", description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="folder of rvelab fit -o")
    parser.add_argument("-o", "--output", default="fit.png", help="figure to write (PNG, PDF or SVG)")
    options = parser.parse_args()
    if not (options.folder / "fit.json").exists():
        parser.exit(2, f"fit.py: {options.folder}/fit.json: no such file; allowed: the folder of a fit that has ended\n")
    fit = json.loads((options.folder / "fit.json").read_text())
    curves = options.folder / "curves.csv"
    plt.rcParams.update(records.STYLE)
    if curves.exists():
        with open(curves, newline="") as table:
            figure = draw_curves(list(csv.DictReader(table)), fit)
    else:
        figure = draw_targets(fit)
    figure.tight_layout()
    figure.savefig(options.output)
    print(f"{options.output}: {len(fit['parameters'])} parameters, {len(fit['tests'])} tests")


if __name__ == "__main__":
    main()
