#!/usr/bin/env python3
"""Void ratio against the logarithm of pressure: e_log_p.py RECORDS.h5... -o e_log_p.png (folders: their *.h5).

Isotropic compression (and other paths) and oedometers; the stages of a test are one path. The path is divided at the
reversals of p, and each part is fitted by e = e_1 - C log10 p: first loading by the compression index C_c beyond the best-fitting
bend (before it the preparation has an effect), unloading by the swelling index C_s, reloading up to the
largest pressure so far by the recompression index C_r. Standard errors are those of the regression; of several specimens
the index is the mean of theirs and its error that of the mean. C = lambda ln 10. Crosses mark records outside the held stress.
"""

import argparse
import math

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt
import numpy as np

LEAST = 4  # records of a part that is fitted
REVERSAL = 0.02  # of p
COLOURS = {"C_c": "crimson", "C_s": "tab:green", "C_r": "tab:orange"}
NAMES = {"C_c": "compression index", "C_s": "swelling index", "C_r": "recompression index"}


def compressions(stages):
    """The stages of compression or swelling; ValueError if there are none."""
    chosen = [stage for stage in stages if stage.kind in ("pressure_path", "path") or
              stage.kind == "compression" and stage.keys.get("lateral") == "zero_strain"]
    if not chosen:
        raise ValueError(f"{stages[0].path}: {stages[0].test_in_words() or stages[0].name}; e against log p needs compression "
                         "and swelling: give records of isotropic_compression or oedometer")
    return chosen


def line_through(x, y):
    """Slope of the least-squares line, its standard error, the value at x = 0, and the sum of squares left."""
    spread = float(np.sum((x - x.mean()) ** 2))
    slope = float(np.sum((x - x.mean()) * (y - y.mean()))) / spread
    rest = y - y.mean() - slope * (x - x.mean())
    error = math.sqrt(float(rest @ rest) / max(len(x) - 2, 1) / spread)
    return slope, error, float(y.mean() - slope * x.mean()), float(rest @ rest)


def turns_of(p):
    """Rows of reversals of p by more than REVERSAL; smaller ones are within the tolerance of a held stress."""
    turns, extreme, direction = [], 0, 0
    for k in range(1, len(p)):
        change = p[k] / p[extreme] - 1
        if direction == 0 and abs(change) > REVERSAL:
            direction = math.copysign(1, change)
        if direction * (p[k] - p[extreme]) >= 0:
            extreme = k if direction else extreme
        elif abs(change) > REVERSAL:
            turns.append(extreme)
            extreme, direction = k, -direction
    return turns


def parts_of(p):
    """Parts of a path, rows of one direction: (index, first row, behind the last one). Reloading ends at the largest p."""
    parts, begin, largest = [], 0, 0.0
    for end in turns_of(p) + [len(p) - 1]:
        rows = p[begin:end + 1]
        past = begin + int(np.argmax(rows > largest)) if np.any(rows > largest) else end + 1
        if rows[-1] < rows[0]:
            parts.append(("C_s", begin, end + 1))
        elif rows[0] < largest * (1 - REVERSAL):
            parts.append(("C_r", begin, past))
            if past <= end:
                parts.append(("C_c", past, end + 1))
        else:
            parts.append(("C_c", begin, end + 1))
        largest, begin = max(largest, float(rows.max())), end
    return parts


def bend_of(x, y):
    """Row at which two lines that share it fit first loading best; 0 where one line does as well or the second is not the
    steeper."""
    whole, best, at = line_through(x, y)[3], math.inf, 0
    for k in range(LEAST - 1, len(x) - LEAST + 1):
        first, second = line_through(x[:k + 1], y[:k + 1]), line_through(x[k:], y[k:])
        if first[3] + second[3] < best and second[0] < first[0] < 0:
            best, at = first[3] + second[3], k
    # Two more parameters must halve the sum of squares.
    return at if best < 0.5 * whole else 0


def fits_of(p, void_ratio):
    """(name, index, its error, value at log10 p = 0, first p, last p) of each part that has records enough."""
    found = []
    for name, begin, end in parts_of(p):
        x, y = np.log10(p[begin:end]), void_ratio[begin:end]
        if len(x) < LEAST or np.ptp(x) < 0.02:
            continue
        if name == "C_c":
            bend = bend_of(x, y)
            x, y = x[bend:], y[bend:]
        slope, error, at_zero, _ = line_through(x, y)
        found.append((name, -slope, error, at_zero, 10 ** x[0], 10 ** x[-1]))
    return found


def path_of(stages):
    """p and e of the stages of one file, where the grains carry a pressure."""
    p = np.concatenate([stage.invariants()[0] for stage in stages])
    void_ratio = np.concatenate([stage.column("void_ratio") for stage in stages])
    held = np.concatenate([stage.held for stage in stages])
    carried = p > 0
    return p[carried], void_ratio[carried], held[carried]


def mean_index(of_files, k):
    """Index k of several specimens: its mean, the standard error of the mean (of one: that of the fit), range of p."""
    found = [fits[k] for fits in of_files]
    values = np.array([fit[1] for fit in found])
    error = found[0][2] if len(values) == 1 else float(values.std(ddof=1) / math.sqrt(len(values)))
    return found[0][0], float(values.mean()), error, found[0][4], found[0][5]


def draw_fits(axes, of_files, colour):
    """Lines of the fits, in the colour of their curve or of their index, and words for each: its value and error."""
    told = []
    same = [fits for fits in of_files if [fit[0] for fit in fits] == [fit[0] for fit in of_files[0]]]
    for k in range(len(of_files[0])):
        own = colour if colour is not None else COLOURS[of_files[0][k][0]]
        for fits in same:
            name, index, _, at_zero, low, high = fits[k]
            ends = np.array([low, high])
            axes.plot(ends / 1e3, at_zero - index * np.log10(ends), color=own, linewidth=2.2, alpha=0.5, zorder=1,
                      solid_capstyle="butt")
        name, index, error, low, high = mean_index(same, k)
        range_of = f"{records.plain(low / 1e3)} to {records.plain(high / 1e3)} kPa"
        axes.plot([], [], color=own, linewidth=2.2, alpha=0.5,
                  label=f"${name}$ = {records.with_error(index, error, ' ± ')}, {range_of}")
        told.append(f"{NAMES[name]} {name} = {records.with_error(index, error)} ({range_of}; lambda "
                    f"{records.plain(index / math.log(10))})")
    return told


def draw(stages, options):
    stages = compressions(stages)
    files = {}
    for stage in stages:
        files.setdefault(stage.path, []).append(stage)
    # The first stage of each file says of which kind the test is.
    drawn = kinds.curves_of([own[0] for own in files.values()], options.colour)
    figure, axes = plt.subplots(figsize=(6.0, 4.4))
    told, carried = [], []
    for curve in drawn:
        of_files = []
        for k, first in enumerate(curve.stages):
            p, void_ratio, held = path_of(files[first.path])
            carried.append(p / 1e3)
            axes.plot(p / 1e3, void_ratio, "-o", color=curve.colour, markersize=2.5, linewidth=0.9,
                      label=curve.label if k == 0 and len(files) > 1 else None)
            axes.plot(p[~held] / 1e3, void_ratio[~held], "x", color="crimson")
            of_files.append(fits_of(p, void_ratio))
        if of_files[0]:
            told += draw_fits(axes, of_files, curve.colour if len(drawn) > 1 else None)
    kinds.log_axis(axes.xaxis, np.concatenate(carried))
    axes.set_xlabel("mean stress $p$ (kPa)")
    axes.set_ylabel("void ratio $e$")
    kinds.legend(axes)
    axes.set_title("Compression and swelling", fontsize=11, loc="left")
    figure.savefig(options.output)
    names = ", ".join(dict.fromkeys(stage.name for stage in stages))
    return "\n".join([f"{options.output}: {names}: {records.counted(len(files), 'test')}"] + told)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="e_log_p.py", description=__doc__.splitlines()[0])
    kinds.add_options(parser, "e_log_p.png")
    records.run(draw, parser)
