#!/usr/bin/env python3
"""Stress ratio and volumetric strain: stress_strain.py RECORDS.h5... -o stress_strain.png (folders: their *.h5).

Every monotonic stage; stages of one test that continue the same strain are joined. Above, q/p
against the driving strain, q = sqrt(s:s/2) in 2D (then q/p is the sine of the mobilised friction angle) and
sqrt(3 s:s/2) in 3D. Below, volumetric strain 1 - V/V0, compression positive, so that dilation goes down; of tests
at constant volume the mean stress p. Tests that differ only by their specimen are one curve, their mean, with a band of one standard deviation (curves.py); --each draws every
one. Crosses mark records outside the tolerance of a held stress.
"""

import argparse

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt
import numpy as np

ROUND_OFF = 1e-9  # of the volume
REFUSED = {"pressure_path": "is isotropic compression, where q is zero: give it to e_log_p.py",
           "deformation": "has no driving strain: give it to stress_path.py"}


def curves(stages):
    """The stages that are curves of this figure; ValueError, naming the script for them, if there are none."""
    chosen = [stage for stage in stages if stage.kind not in REFUSED and not (stage.cyclic and stage.kind != "path")]
    if not chosen:
        stage = stages[0]
        why = REFUSED.get(stage.kind, "goes to and fro: give it to loops.py")
        raise ValueError(f"{stage.path}: stage {stage.name} {why}")
    return chosen


def cross_unheld(axes, curve):
    """Crosses at records outside the tolerance of a held stress; their number."""
    missed = 0
    for stage in curve.stages:
        off = ~stage.held
        missed += int(off.sum())
        axes.plot(100 * stage.strain[off], stage.mobilised()[off], "x", color=curve.colour, markersize=4)
    return missed


def draw_volume(axes, drawn, each):
    """Volumetric strain, or the mean stress if the volume of all tests is constant."""
    stages = [stage for curve in drawn for stage in curve.stages]
    held = all(np.abs(stage.volumetric_strain).max() < ROUND_OFF for stage in stages)
    for curve in drawn:
        if held:
            curve.draw(axes, lambda stage: stage.invariants()[0], label=False, each=each, scale=(100, 1e-3))
        else:
            curve.draw(axes, lambda stage: stage.volumetric_strain, label=False, each=each, scale=(100, 100))
    if held:
        axes.set_ylabel("mean stress $p$ (kPa)\nat constant volume")
        axes.set_ylim(bottom=0)
    else:
        axes.axhline(0, color="0.5", linewidth=0.8, zorder=0.5)
        axes.set_ylabel("volumetric strain $\\varepsilon_v$ (%)\ndilation negative")
    strains = [stage.strain for stage in stages]
    if min(strain.min() for strain in strains) >= 0:
        axes.set_xlim(left=0)
    elif max(strain.max() for strain in strains) <= 0:
        axes.set_xlim(right=0)


def draw(stages, options):
    stages = curves(stages)
    whole = kinds.joined(stages)
    drawn = kinds.curves_of(whole, options.colour)
    figure, (ratio, volume) = plt.subplots(2, 1, figsize=(6.4, 6.2), sharex=True, height_ratios=(3, 2))
    unheld = 0
    for curve in drawn:
        curve.draw(ratio, lambda stage: stage.mobilised(), each=options.each, scale=(100, 1))
        unheld += cross_unheld(ratio, curve)
    if unheld:
        ratio.plot([], [], "x", color="0.3", markersize=4, label="held stress missed")
    draw_volume(volume, drawn, options.each)
    names = list(dict.fromkeys(stage.test_in_words() or stage.name for stage in whole))
    strains = list(dict.fromkeys(stage.strain_in_words() for stage in whole))
    ratio.set_ylabel("$q/p$" + (" = $(\\sigma_1 - \\sigma_3)/(\\sigma_1 + \\sigma_3)$" if stages[0].dimension == 2 else ""))
    ratio.set_ylim(bottom=0)
    kinds.legend(ratio, None if options.each else kinds.band_in_words(drawn))
    ratio.set_title(names[0] if len(names) == 1 else "Stress ratio and volumetric strain", fontsize=11, loc="left")
    volume.set_xlabel(strains[0] if len(strains) == 1 else "driving strain of the stage (%)")
    figure.align_ylabels()
    figure.savefig(options.output)
    made = f"{', '.join(names)}: {records.counted(len(stages), 'stage')}"
    return f"{options.output}: {made}, {records.counted(unheld, 'record')} with the held stress missed"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="stress_strain.py", description=__doc__.splitlines()[0])
    kinds.add_options(parser, "stress_strain.png")
    records.run(draw, parser)
