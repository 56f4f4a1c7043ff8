#!/usr/bin/env python3
"""Void ratio against the logarithm of pressure: e_log_p.py RECORDS.h5... -o e_log_p.png (folders: their *.h5).

Stages of isotropic compression (and paths of one's own) and of oedometers in their order. The slopes de/d ln p printed are
those between the ends of each stage, compression positive: lambda in first loading, kappa in swelling.
"""

import argparse

import records  # first: it says which package is missing
import matplotlib.pyplot as plt
import numpy as np


def compressions(stages):
    """The stages that compress or swell; ValueError if there are none."""
    chosen = [stage for stage in stages if stage.kind in ("pressure_path", "path") or
              stage.kind == "compression" and stage.keys.get("lateral") == "zero_strain"]
    if not chosen:
        raise ValueError(f"{stages[0].path}: {stages[0].test_in_words() or stages[0].name}; e against log p needs compression "
                         "and swelling: give records of isotropic_compression or oedometer")
    return chosen


def draw(stages, options):
    stages = compressions(stages)
    figure, axes = plt.subplots(figsize=(6.4, 4.4))
    slopes = []
    for stage, colour in zip(stages, records.pressure_colours(len(stages))):
        p, _ = stage.invariants()
        void_ratio = stage.column("void_ratio")
        axes.plot(p / 1e3, void_ratio, "-o", color=colour, markersize=3, label=stage.label)
        missed = ~stage.held
        axes.plot(p[missed] / 1e3, void_ratio[missed], "x", color="crimson")
        if p[0] != p[-1]:
            slopes.append(f"{stage.label} {(void_ratio[0] - void_ratio[-1]) / np.log(p[-1] / p[0]):.4f}")
    axes.set_xscale("log")
    axes.set_xlabel("mean stress $p$ (kPa)")
    axes.set_ylabel("void ratio $e$")
    axes.legend(fontsize=8)
    axes.set_title("Compression and swelling", fontsize=11, loc="left")
    figure.savefig(options.output)
    return f"{options.output}: slopes -de/d ln p: " + ", ".join(slopes)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="e_log_p.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="e_log_p.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=records.read_driven_stages)
