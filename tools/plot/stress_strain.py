#!/usr/bin/env python3
"""Stress ratio and volumetric strain: stress_strain.py RECORDS.h5... -o stress_strain.png (folders: their *.h5).

Every stage that drives a strain one way, in its order. Above, q/p against the driving strain, q = sqrt(s:s/2) in 2D (then
q/p is the sine of the mobilised friction angle) and sqrt(3 s:s/2) in 3D. Below, volumetric strain 1 - V/V0, compression
positive, so that dilation goes down. Strains count from the start of each stage. Records at which a held stress was not
held are crossed.
"""

import argparse

import records  # first: it says which package is missing
import matplotlib.pyplot as plt

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


def draw(stages, options):
    stages = curves(stages)
    figure, (ratio, volume) = plt.subplots(2, 1, figsize=(7, 6.6), sharex=True, height_ratios=(3, 2))
    one_each = len({stage.path for stage in stages}) == len(stages)
    only_pressure = (one_each and all(stage.drained for stage in stages)
                     and len({records.plain(stage.pressure) for stage in stages}) == len(stages))
    unheld = 0
    for stage, colour in zip(stages, records.pressure_colours(len(stages))):
        strain, mobilised = 100 * stage.strain, stage.mobilised()
        pressure = f"{records.plain(stage.pressure / 1e3)} kPa"
        label = pressure if only_pressure else f"{stage.label}, $p_0$ = {records.plain(stage.invariants()[0][0] / 1e3)} kPa"
        ratio.plot(strain, mobilised, color=colour, label=label)
        volume.plot(strain, 100 * stage.volumetric_strain, color=colour)
        missed = ~stage.held
        unheld += int(missed.sum())
        ratio.plot(strain[missed], mobilised[missed], "x", color=colour, markersize=4)
    if unheld:
        ratio.plot([], [], "x", color="0.3", markersize=4, label="held stress missed")
    names = list(dict.fromkeys(stage.test_in_words() for stage in stages))
    strains = list(dict.fromkeys(stage.strain_in_words() for stage in stages))
    ratio.set_ylabel("$q/p$" + (" = $(\\sigma_1 - \\sigma_3)/(\\sigma_1 + \\sigma_3)$" if stages[0].dimension == 2 else ""))
    ratio.set_ylim(bottom=0)
    ratio.legend(title="lateral pressure $\\sigma_r$" if only_pressure else None, ncols=2 if only_pressure else 1, fontsize=9)
    ratio.set_title(names[0] if len(names) == 1 else "Stress ratio and volumetric strain", fontsize=11, loc="left")
    volume.axhline(0, color="0.5", linewidth=0.8)
    volume.set_ylabel("volumetric strain $\\varepsilon_v$ (%)\ndilation negative")
    volume.set_xlabel(strains[0] if len(strains) == 1 else "driving strain of the stage (%)")
    lowest, highest = min(stage.strain.min() for stage in stages), max(stage.strain.max() for stage in stages)
    if lowest >= 0:
        volume.set_xlim(left=0)
    elif highest <= 0:
        volume.set_xlim(right=0)
    figure.align_ylabels()
    figure.savefig(options.output)
    made = f"{', '.join(names)}: {records.counted(len(stages), 'stage')}"
    return f"{options.output}: {made}, {records.counted(unheld, 'record')} with the held stress missed"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="stress_strain.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="stress_strain.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser)
