#!/usr/bin/env python3
"""Shear modulus and damping against strain: stiffness.py RECORDS.h5... -o stiffness.png (a folder means its *.h5).

One point for each loop of a cyclic stage: secant shear modulus G over G_max, and damping ratio, against the amplitude of the
shear strain, as in `rvelab measure` (rvelab/ensemble/loops.hpp). G_max: the mean shear stiffness of the first probe
stage of a file; without one the secant from the first record of a stage to its second, the median over the stages, or the
stiffest loop if that is stiffer. Values above 1 belong to specimens whose p has grown since the probe.
"""

import argparse

import records  # first: it names a missing package
import curves as kinds
import h5py
import matplotlib.pyplot as plt
import numpy as np


def shear_of(stage):
    """gamma and tau, Pa: of the plane of a simple shear, else axial minus lateral strain and half of that stress."""
    if len(stage.axis) == 2:
        a, b = ("xyz".index(letter) for letter in stage.axis)
        return stage.deformation[:, a, b], -0.5 * (stage.stress[:, a, b] + stage.stress[:, b, a])
    axis = "xyz".index(stage.axis) if stage.axis else stage.dimension - 1
    lateral = [k for k in range(stage.dimension) if k != axis]
    less = lambda tensor: tensor[:, axis, axis] - sum(tensor[:, k, k] for k in lateral) / len(lateral)
    return -less(stage.deformation), 0.5 * less(stage.stress)


def loops_of(stage):
    """Rows gamma, G, damping ratio: of each loop from one reversal of the driving strain to the next but one."""
    gamma, tau = shear_of(stage)
    step = np.diff(stage.strain)
    moving = np.flatnonzero(step)  # records may stand at a turn
    turns = list(moving[1:][step[moving[1:]] * step[moving[:-1]] < 0])
    travelled = lambda one, other: abs(stage.strain[other] - stage.strain[one])
    if len(turns) > 1 and travelled(turns[-1], -1) > 0.95 * travelled(turns[-2], turns[-1]):
        turns.append(len(gamma) - 1)
    rows = []
    for first, opposite, last in zip(turns[:-2:2], turns[1:-1:2], turns[2::2]):
        part = slice(first, last + 1)
        x, y = np.append(gamma[part], gamma[first]), np.append(tau[part], tau[first])  # closed
        strain, stress = (0.5 * (value[first] + value[last]) - value[opposite] for value in (gamma, tau))
        area = np.sum(0.5 * (y[1:] + y[:-1]) * np.diff(x))
        rows.append((0.5 * abs(strain), stress / strain, area / (0.5 * np.pi * stress * strain)))
    return np.array(rows).reshape(-1, 3)


def largest_modulus(stages, loops):
    """G_max, Pa, and where it is from."""
    for path in dict.fromkeys(stage.path for stage in stages):
        with h5py.File(path) as file:
            if "probes/stiffness_Pa" in file and len(file["probes/stiffness_Pa"]):
                stiffness = file["probes/stiffness_Pa"][0]
                return float(np.mean(np.diag(stiffness)[stages[0].dimension:])), "probe"
    secants = [(tau[1] - tau[0]) / (gamma[1] - gamma[0]) for gamma, tau in map(shear_of, stages)]
    first, stiffest = float(np.median(secants)), float(loops[:, 1].max())
    return (first, "first record") if first >= stiffest else (stiffest, "stiffest loop")


def draw(stages, options):
    found = [(stage, loops_of(stage)) for stage in stages if stage.cyclic]
    found = [(stage, loops) for stage, loops in found if len(loops)]
    if not found:
        raise ValueError(f"{stages[-1].path}: no whole loop; give records of cyclic_shear, or of a stage with cycles > 1")
    greatest, source = largest_modulus([stage for stage, _ in found], np.concatenate([loops for _, loops in found]))
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(6.4, 6.2), sharex=True)
    for number, (stage, loops) in enumerate(found):
        style = {"color": kinds.QUALITATIVE[number % len(kinds.QUALITATIVE)], "markersize": 4}
        upper.plot(100 * loops[:, 0], loops[:, 1] / greatest, "o", label=stage.label, **style)
        lower.plot(100 * loops[:, 0], 100 * loops[:, 2], "o", **style)
    amplitudes = 100 * np.concatenate([loops[:, 0] for _, loops in found])
    kinds.log_axis(lower.xaxis, [amplitudes.min() / 2, 2 * amplitudes.max()])
    upper.set_title(f"Cyclic shear, $G_{{max}}$ = {records.plain(greatest / 1e6)} MPa ({source})", fontsize=11, loc="left")
    upper.set_ylabel("$G/G_{max}$")
    highest = max((loops[:, 1] / greatest).max() for _, loops in found)
    upper.set_ylim(0, 1.1 * max(1, highest))
    if highest > 1.02:
        upper.axhline(1, color="0.5", linewidth=0.8, linestyle="--", label="above: $p$ has grown since the probe")
    lower.set_ylabel("damping ratio (%)")
    lower.set_ylim(0, 110 * max(loops[:, 2].max() for _, loops in found))
    lower.set_xlabel("amplitude of the shear strain $\\gamma$ (%)")
    if len(found) > 1 or highest > 1.02:
        kinds.legend(upper)
    figure.align_ylabels()
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(amplitudes), 'loop')}, G_max {records.plain(greatest / 1e6)} MPa of the {source}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="stiffness.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="stiffness.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser)
