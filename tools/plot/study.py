#!/usr/bin/env python3
"""Error against run time of a study: study.py FOLDER -o study.png (the folder that `rvelab study -o` wrote).

Median error of the stress of an increment over p, against its processor time and against its grain-steps; the Pareto
fronts of the study are joined. Thin bars reach to the 95th percentile, crosses are root mean squares, which
the few increments in avalanches dominate. Labels are the values of the varied keys.
"""

import argparse
import json
import math
import pathlib

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt


ROOM = 1.6  # over the least and the largest cost


def read_study(folders):
    """The one study.json of a folder, or the file itself."""
    if len(folders) != 1:
        raise ValueError(f"{' '.join(folders)}: one folder at a time; give the folder of one study")
    path = pathlib.Path(folders[0])
    path = path / "study.json" if path.is_dir() else path
    try:
        study = json.loads(path.read_text())
        points = study["points"]
    except FileNotFoundError as error:
        raise ValueError(f"{path}: is not there; give a folder that `rvelab study -o` wrote, and finished") from error
    except (json.JSONDecodeError, KeyError, TypeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: not the study.json of rvelab ({error}); give a folder that `rvelab study -o` wrote") from error
    if not any("rms_error_over_p" in point for point in points):
        raise ValueError(f"{path}: the study made no increments; run it with --increments above 0")
    return study


def is_positive(value):
    return value is not None and math.isfinite(value) and value > 0


def label_of(point):
    return ", ".join(point["values"].values()) or "protocol"


def draw_against(axes, study, cost, unit, front):
    """One panel, costs in `unit`; the points with positive coordinates, for logarithmic axes."""
    error, high, rms = "median_error_over_p", "percentile_95_error_over_p", "rms_error_over_p"
    shown = [point for point in study["points"] if is_positive(point[cost]) and is_positive(point[error])]
    for place, point in enumerate(sorted(shown, key=lambda point: point[cost])):
        x, y = point[cost] / unit, point[error]
        if is_positive(point[high]):
            axes.plot([x, x], [y, point[high]], color="0.75", linewidth=1, zorder=1)
        axes.plot(x, y, "o", color="C0", markerfacecolor="C0" if point[front] else "white", markersize=6, zorder=3)
        right = place % 2 == 1  # neighbours have their labels on different sides
        axes.annotate(label_of(point), (x, y), xytext=(6, 4) if right else (-6, -9), textcoords="offset points",
                      fontsize=7, ha="left" if right else "right")
    crosses = [(point[cost] / unit, point[rms]) for point in shown if is_positive(point[rms])]
    axes.plot(*zip(*crosses), "x", color="0.5", markersize=4, zorder=2, label="root mean square")
    joined = sorted((point[cost] / unit, point[error]) for point in shown if point[front])
    axes.plot(*zip(*joined), color="C0", linewidth=1, zorder=2, label="Pareto front")
    reference = study["reference"]
    if is_positive(reference[cost]) and is_positive(reference[error]):
        axes.plot(reference[cost] / unit, reference[error], "s", color="C3", markersize=5, zorder=3,
                  label="reference before its relaxation")
        drawn = [*shown, reference]
    else:
        drawn = shown
    costs = [point[cost] / unit for point in drawn]
    errors = [point[error] for point in drawn] + [point[name] for point in shown for name in (high, rms)]
    # Labels are beside the points.
    kinds.log_axis(axes.xaxis, [min(costs) / ROOM, *costs, max(costs) * ROOM])
    kinds.log_axis(axes.yaxis, [value for value in errors if is_positive(value)])
    return len(shown)


def draw(study, options):
    if not any(is_positive(point["median_error_over_p"]) for point in study["points"]):
        raise ValueError("no grid point has a median error above 0; see study.csv for what there is")
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4.2), sharey=True)
    shown = draw_against(left, study, "processor_s_per_increment", 1e-3, "on_front_of_processor_time")
    draw_against(right, study, "grain_steps_per_increment", 1e3, "on_front_of_grain_steps")
    left.set_xlabel("processor time of an increment (ms)")
    right.set_xlabel("grain-steps of an increment (thousands)")
    left.set_ylabel("error $|\\sigma - \\sigma_r|\\,/\\,p$, median")
    left.legend(fontsize=8, loc="lower left")
    keys = ", ".join(variation["key"] for variation in study["study"]["vary"])
    figure.suptitle(f"Error against cost over {study['points'][0]['increments']} increments: {keys}", fontsize=11,
                    x=0.12, ha="left")
    figure.tight_layout()
    figure.savefig(options.output)
    fronts = sum(point["on_front_of_grain_steps"] for point in study["points"])
    return f"{options.output}: {records.counted(shown, 'grid point')}, {fronts} on the Pareto front of grain-steps"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="study.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", metavar="FOLDER", help="folder of a study, or its study.json")
    parser.add_argument("-o", "--output", default="study.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=read_study)
