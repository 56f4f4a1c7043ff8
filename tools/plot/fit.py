#!/usr/bin/env python3
"""Results of `rvelab fit`: fit.py FOLDER -o fit.png (the folder that it wrote; fit.json, or of a sweep sweep.csv).

Of a fit: the posterior of each parameter with its mean and 95 % interval over the searched range, the tests
as strokes below it; then each target as measured and as fitted, in standard deviations of both; features of each test
likewise; of measured curves the points with their errors and the fit with its band of 95 %. Of a sweep: each measure against the first varied
key, mean and standard error over the specimens, one curve for each combination of the others.
"""

import argparse
import csv
import json
import math
import pathlib

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt
import numpy as np

# Labels of ordinates and abscissae of curves, and the factors to their units.
QUANTITIES = {"p": ("mean stress $p$ (kPa)", 1e-3), "strain": ("axial strain (%)", 100), "q_over_p": ("$q/p$", 1), "deviator": ("$\\sigma_1 - \\sigma_3$ (kPa)", 1e-3),
              "volumetric_strain": ("volumetric strain $\\varepsilon_v$ (%)", 100), "void_ratio": ("void ratio $e$", 1)}
ABSCISSAE = {"strain": ("strain (%)", 100), "p": ("mean stress $p$ (kPa)", 1e-3),
             "axial_stress": ("axial stress (kPa)", 1e-3)}


def read_fit(folders):
    """("fit", fit.json, rows of predictions.csv, else of curves.csv) or ("sweep", rows of sweep.csv) of the one folder."""
    if len(folders) != 1:
        raise ValueError(f"{' '.join(folders)}: one fit at a time; give the folder of one")
    folder = pathlib.Path(folders[0])
    own, sweep = folder / "fit.json", folder / "sweep.csv"
    if sweep.exists() and not own.exists():
        return "sweep", rows_of(sweep)
    try:
        found = json.loads(own.read_text())
        if not found["parameters"] or not found["posterior_sample"]:
            raise KeyError("parameters")
    except (FileNotFoundError, NotADirectoryError) as error:
        raise ValueError(f"{own}: is not there; give the folder that `rvelab fit -o` wrote") from error
    except (json.JSONDecodeError, KeyError, TypeError, UnicodeDecodeError) as error:
        raise ValueError(f"{own}: not the fit.json of rvelab ({error}); give the folder that `rvelab fit -o` wrote") from error
    for name in ("predictions.csv", "curves.csv"):
        if (folder / name).exists():
            return "fit", found, rows_of(folder / name)
    return "fit", found, []


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def draw_posterior(axes, parameter, sample, tests):
    """Histogram of the posterior, mean, interval, and where tests were made."""
    low, high = parameter["range"]
    axes.hist(sample, bins=np.linspace(low, high, 41), density=True, color="tab:blue", alpha=0.45)
    axes.axvspan(parameter["low_95"], parameter["high_95"], color="crimson", alpha=0.1, linewidth=0)
    axes.axvline(parameter["mean"], color="crimson", linewidth=1.4)
    made = [test["values"][parameter["key"]] for test in tests if "failure" not in test]
    axes.plot(made, np.zeros(len(made)), "|", color="0.3", markersize=9, clip_on=False)
    axes.set_xlim(low, high)
    axes.set_yticks([])
    axes.set_xlabel(parameter["key"], fontsize=9)
    axes.set_title(in_words(parameter), fontsize=9)


def in_words(parameter):
    """Mean and interval of a parameter, with the digits that the interval allows."""
    mean, low, high = (parameter[name] for name in ("mean", "low_95", "high_95"))
    if not high > low:
        return records.plain(mean)
    decimals = 1 - math.floor(math.log10(high - low))
    shown = [records.plain(round(value, decimals)) if decimals <= 0 else f"{value:.{decimals}f}" for value in (mean, low, high)]
    return f"{shown[0]} ({shown[1]} to {shown[2]})"


def target_in_words(target):
    fit, error = target["fit"], target["standard_error"]
    measured = records.plain(target["value"]) + (f" +- {records.plain(error)}" if error else "")
    return f"{target['name']}\nmeasured {measured}\nfit {records.with_error(fit['mean'], fit['standard_deviation'])}"


def draw_targets(axes, targets):
    """Scalar targets: difference of fit and measurement over the standard deviation of both, with that of the fit."""
    for row, target in enumerate(targets):
        fit = target["fit"]
        scale = math.hypot(target["standard_error"] or 0, fit["standard_deviation"]) or 1
        axes.errorbar((fit["mean"] - target["value"]) / scale, row, xerr=fit["standard_deviation"] / scale, fmt="o",
                      color="tab:blue", capsize=3)
    axes.axvline(0, color="crimson", linewidth=1)
    axes.set_xlim(*(lambda reach: (-reach, reach))(max(3, *np.abs(axes.get_xlim()))))
    axes.set_ylim(len(targets) - 0.5, -0.5)
    axes.set_yticks(range(len(targets)), [target_in_words(target) for target in targets], fontsize=8)
    axes.set_xlabel("fit less measured, in standard deviations", fontsize=9)


def draw_features(axes, rows):
    """Features of one test: difference of the model and the measurement over the error of both, with the scatter of the model."""
    role = "predicted" if rows[0]["predicted"] else "fitted"
    for row, feature in enumerate(rows):
        if feature["mean"] is None:
            continue
        deviation = feature["standard_deviation"] or 0
        scale = math.hypot(feature["standard_error"], deviation) or 1
        axes.errorbar((feature["mean"] - feature["measured"]) / scale, row, xerr=deviation / scale, fmt="o", markersize=4,
                      color="tab:orange" if role == "predicted" else "tab:blue", capsize=2)
    axes.axvline(0, color="crimson", linewidth=1)
    axes.set_xlim(*(lambda reach: (-reach, reach))(max(3, *np.abs(axes.get_xlim()))))
    axes.set_ylim(len(rows) - 0.5, -0.5)
    labels = [row["feature"].removesuffix("_Pa").replace("_percent", " %").replace("_", " ") for row in rows]
    axes.set_yticks(range(len(rows)), labels, fontsize=6)
    axes.set_title(f"{rows[0]['test']}, {role}", fontsize=9)
    axes.set_xlabel("model less measured, in standard deviations", fontsize=9)


def draw_curve(axes, rows):
    """Points of one measured curve, and the band of the fit, or of the tests made with the fitted parameters."""
    rows = sorted(rows, key=lambda row: float(row["x"]))
    (label, scale), (below, across) = QUANTITIES[rows[0]["quantity"]], ABSCISSAE[rows[0]["abscissa"]]

    def column(name, factor=scale):
        return factor * np.array([float(row[name]) if row[name] else np.nan for row in rows])
    x = column("x", across)
    if "mean" in rows[0]:
        mean, deviation = column("mean"), column("standard_deviation")
        low, high, band, name = mean - deviation, mean + deviation, "scatter", "mean"
        role = "predicted" if rows[0]["predicted"] == "1" else "fitted"
        axes.set_title(f"{rows[0]['test']}, {role}", fontsize=9, pad=18)
        colour = "tab:orange" if role == "predicted" else "tab:blue"
    else:
        mean, low, high, band, name = column("fit"), column("low_95"), column("high_95"), "95 % of the fit", "fit"
        colour = "tab:blue"
    axes.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0, label=band)
    axes.plot(x, mean, color=colour, label=name)
    axes.errorbar(x, column("measured"), yerr=column("error"), fmt="o", color="k", markersize=3, capsize=2, linewidth=0.8,
                  label="measured")
    if rows[0]["abscissa"] != "strain":
        kinds.log_axis(axes.xaxis, x)
    pressure = float(rows[0].get("pressure_Pa") or 0)
    axes.set_xlabel(below + (f" at {records.plain(pressure / 1e3)} kPa" if pressure > 0 else ""), fontsize=9)
    axes.set_ylabel(label, fontsize=9)
    axes.legend(fontsize=7, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1))


def panels(count):
    """A figure of so many panels, at most three in a row, and its axes."""
    columns = min(count, 3)
    rows = -(-count // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(3.6 * columns + 0.6, 2.9 * rows), squeeze=False,
                                layout="constrained")
    for unused in axes.flat[count:]:
        unused.set_visible(False)
    return figure, list(axes.flat[:count])


def draw_fit(found, rows, options):
    measured = groups_of(rows)
    features = {}
    for feature in found.get("features", []):
        features.setdefault(feature["test"], []).append(feature)
    drawn = {f"{test}: {feature['feature']}" for test, own in features.items() for feature in own}
    scalars = [target for target in found["targets"]
               if not target.get("of_curve", " at " in target["name"]) and target["name"] not in drawn]
    count = len(found["parameters"]) + bool(scalars) + len(features) + len(measured)
    figure, axes = panels(count)
    for parameter in found["parameters"]:
        draw_posterior(axes.pop(0), parameter, found["posterior_sample"][parameter["key"]], found["tests"])
    if scalars:
        draw_targets(axes.pop(0), scalars)
    for own in features.values():
        draw_features(axes.pop(0), own)
    for group in measured:
        draw_curve(axes.pop(0), [rows[k] for k in group])
    figure.savefig(options.output)
    told = [f"{parameter['key']} {in_words(parameter)}" for parameter in found["parameters"]]
    return f"{options.output}: {', '.join(told)}; {len(found['tests'])} tests"


def groups_of(rows):
    """Numbers of the rows of each curve and quantity, in their order."""
    groups = {}
    for number, row in enumerate(rows):
        groups.setdefault((row["curve"] if "curve" in row else row["test"], row["quantity"]), []).append(number)
    return list(groups.values())


def measure_in_words(name, largest):
    """Label of a measure with its unit, and the factor to that."""
    for end, unit, factor in (("_deg", "degrees", 1), ("_Pa", "MPa" if largest >= 1e6 else "kPa", 1e-6 if largest >= 1e6 else 1e-3)):
        if name.endswith(end):
            return f"{name.removesuffix(end).replace('_', ' ')} ({unit})", factor
    return name.replace("_", " "), 1


def draw_sweep(rows, options):
    names = list(rows[0]) if rows else []
    measures = [name for name in names if name + "_standard_error" in names]
    keys = names[:names.index(measures[0])] if measures else []
    if not keys:
        raise ValueError("sweep.csv: holds no measure; none of its tests was carried out")
    figure, axes = panels(len(measures))
    others = list(dict.fromkeys(tuple(row[key] for key in keys[1:]) for row in rows))
    for panel, measure in zip(axes, measures):
        words, scale = measure_in_words(measure, max(abs(float(row[measure])) for row in rows if row[measure]))
        for k, other in enumerate(others):
            own = [row for row in rows if tuple(row[key] for key in keys[1:]) == other and row[measure]]
            label = ", ".join(f"{key.split('.')[-1]} {float(value):.4g}" for key, value in zip(keys[1:], other))
            panel.errorbar([float(row[keys[0]]) for row in own], [scale * float(row[measure]) for row in own],
                           yerr=[scale * float(row[measure + "_standard_error"] or 0) for row in own], fmt="-o", markersize=3,
                           capsize=2, color=kinds.QUALITATIVE[k % len(kinds.QUALITATIVE)], label=label or None)
        panel.ticklabel_format(axis="y", useOffset=False)
        panel.set_xlabel(keys[0], fontsize=9)
        panel.set_ylabel(words, fontsize=8)
        varied = [float(row[keys[0]]) for row in rows]
        if min(varied) > 0 and max(varied) >= 10 * min(varied):
            kinds.log_axis(panel.xaxis, varied)
    if len(keys) > 1:
        kinds.legend(axes[min(2, len(axes) - 1)])
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(measures), 'measure')} against {', '.join(keys)}, {len(rows)} points"


def draw(given, options):
    return draw_fit(given[1], given[2], options) if given[0] == "fit" else draw_sweep(given[1], options)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="fit.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", metavar="FOLDER", help="folder of a fit or a sweep")
    parser.add_argument("-o", "--output", default="fit.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=read_fit)
