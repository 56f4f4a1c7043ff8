#!/usr/bin/env python3
"""Stress, force and fabric: stress_force_fabric.py RECORDS.h5 -o stress_force_fabric.png (the last stage that has them).

Above, q/p measured, and predicted from the distributions of contact normals, forces and branches
(rvelab/measure/anisotropy.hpp); below, their anisotropies along the stress: contact normals a_c, normal forces a_n,
tangential forces a_t, branches a_l. Last, where the file has them, the share of contacts
above the mean normal force and their share of q. The printed line has the largest difference of the
prediction, and the mean relative one for q/p above 0.1.
"""

import argparse

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt
import numpy as np

AMPLITUDES = (("a_c", "contact normals $a_c$"), ("a_n", "normal forces $a_n$"), ("a_t", "tangential forces $a_t$"),
              ("a_l", "branches $a_l$"), ("a_lt", "branches across $a_{lt}$"))
STRONG = (("strong_contacts", "of the contacts"), ("strong_deviator", "of $q$"))


def draw(stages, options):
    having = [stage for stage in kinds.joined(stages) if stage.has("stress_force_fabric")]
    if not having:
        stages[-1].column("stress_force_fabric")  # names the missing quantity
    stage = having[-1]
    strain, measured, predicted = 100 * stage.strain, stage.mobilised(), stage.column("stress_force_fabric")
    strong = [row for row in STRONG if stage.has(row[0])]
    figure, axes = plt.subplots(3 if strong else 2, 1, figsize=(6.4, 7.6 if strong else 5.6), sharex=True)
    for row in axes:
        row.set_prop_cycle(color=kinds.QUALITATIVE, linestyle=(kinds.DASHES * 2)[:len(kinds.QUALITATIVE)])
    axes[0].plot(strain, measured, label="measured")
    axes[0].plot(strain, predicted, label="of force and fabric")
    axes[0].set_ylabel("$q/p$")
    for name, label in AMPLITUDES:
        if stage.has(name) and np.abs(stage.column(name)).max() > 1e-9:
            axes[1].plot(strain, stage.column(name), label=label)
    axes[1].set_ylabel("anisotropy along the stress")
    for name, label in strong:
        # Shares of a negligible deviator have no meaning.
        shown = np.where(measured > 0.02, stage.column(name), np.nan) if name == "strong_deviator" else stage.column(name)
        axes[2].plot(strain, shown, label=label)
    if strong:
        axes[2].set_ylabel("share of strong contacts")
        axes[2].set_ylim(0, 1.3)
    for row in axes:
        kinds.legend(row)
    axes[-1].set_xlabel(stage.strain_in_words())
    axes[0].set_title(f"{stage.test_in_words()}: {stage.label}", fontsize=11, loc="left")
    figure.align_ylabels()
    figure.savefig(options.output)
    difference, sheared = np.abs(predicted - measured), measured > 0.1
    mean = f", {100 * np.mean(difference[sheared] / measured[sheared]):.1f} % on average" if sheared.any() else ""
    return f"{options.output}: q/p of force and fabric within {difference.max():.3f}{mean}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="stress_force_fabric.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs=1, help="record file")
    parser.add_argument("-o", "--output", default="stress_force_fabric.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser)
