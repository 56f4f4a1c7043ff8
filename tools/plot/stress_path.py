#!/usr/bin/env python3
"""Stress paths: stress_path.py RECORDS.h5... -o stress_path.png (a folder means its *.h5).

Left, q against p of every stage with records, q = sqrt(s:s/2) in 2D and sqrt(3 s:s/2) in 3D; right, the stress path of 3D
tests in the deviatoric plane (compression positive, axes z, x, y at 90, -30 and 210 degrees), of 2D tests the shear
stress against the difference of the normal stresses. Compression positive. Of several specimens the mean path at equal
strains is drawn over those of the specimens; --each omits it.
"""

import argparse
import math

import records  # first: it names a missing package
import curves as kinds
import matplotlib.pyplot as plt
import numpy as np

MANY = 400  # records of one path


def deviatoric_plane(stress):
    """Coordinates of 3D stresses along and across the projection of the z axis."""
    x, y, z = (stress[:, k, k] for k in range(3))
    return (x - y) / math.sqrt(2), (2 * z - x - y) / math.sqrt(6)


def shear_plane(stress):
    """Coordinates of 2D stresses: difference of the normal stresses, shear stress."""
    return 0.5 * (stress[:, 1, 1] - stress[:, 0, 0]), -0.5 * (stress[:, 0, 1] + stress[:, 1, 0])


def draw_path(axes, curve, coordinates, label, each):
    """The paths of all specimens of a curve, their starts marked; several ones thin under their mean."""
    alone = len(curve.stages) == 1 or each or curve.turns
    for stage in curve.stages:
        x, y = (column / 1e3 for column in coordinates(stage))
        width = 1.2 if len(x) < MANY else 0.5  # a long flow fills its plane with its path
        axes.plot(x, y, color=curve.colour, linestyle=curve.dashes, linewidth=width if alone else 0.5,
                  alpha=1 if alone else 0.35)
        axes.plot(x[0], y[0], "o", color=curve.colour, markersize=4 if alone else 2)
    if not alone:
        x, y = (curve.mean(lambda stage, k=k: coordinates(stage)[k])[1] / 1e3 for k in (0, 1))
        axes.plot(x, y, color=curve.colour, linestyle=curve.dashes, linewidth=1.6)
    axes.plot([], [], color=curve.colour, linestyle=curve.dashes, label=curve.label if label else None)


def draw_axes_of_plane(plane):
    """The three principal axes of stress in the deviatoric plane."""
    plane.grid(False)
    reach = 1.15 * max(float(np.abs(plane.get_ylim()).max()), float(np.abs(plane.get_xlim()).max()))
    for name, angle in (("$\\sigma_z$", 90), ("$\\sigma_x$", -30), ("$\\sigma_y$", 210)):
        end = reach * math.cos(math.radians(angle)), reach * math.sin(math.radians(angle))
        plane.plot([0, end[0]], [0, end[1]], color="0.7", linewidth=0.8)
        plane.annotate(name, 1.06 * np.array(end), ha="center", va="center", color="0.4")
    plane.update_datalim([(-1.12 * reach, -0.68 * reach), (1.12 * reach, 1.12 * reach)])  # the names are within the frame
    plane.autoscale_view()
    plane.set_title("deviatoric plane (kPa)", fontsize=10, loc="left")


def draw(stages, options):
    figure, (meridian, plane) = plt.subplots(1, 2, figsize=(10, 4.4))
    three = stages[0].dimension == 3
    curves = kinds.curves_of(stages, options.colour)
    for curve in curves:
        draw_path(meridian, curve, lambda stage: stage.invariants(), False, options.each)
        draw_path(plane, curve, lambda stage: (deviatoric_plane if three else shear_plane)(stage.stress), True, options.each)
    meridian.set_xlabel("mean stress $p$ (kPa)")
    meridian.set_ylabel("deviatoric stress $q$ (kPa)")
    # Space beside a vertical path.
    meridian.set_xlim(min(0, meridian.dataLim.x0), 1.05 * max(meridian.dataLim.x1, meridian.get_xlim()[1]))
    meridian.set_ylim(bottom=0)
    plane.plot([], [], "o", color="0.3", markersize=4, label="start")
    averaged = not options.each and kinds.band_in_words(curves)
    kinds.legend(plane, "mean of n specimens,\nthin: each of them" if averaged else None)
    plane.set_aspect("equal", adjustable="datalim")
    if three:
        draw_axes_of_plane(plane)
    else:
        plane.set_xlabel("$(\\sigma_y - \\sigma_x)/2$ (kPa)")
        plane.set_ylabel("$\\sigma_{xy}$ (kPa), positive with $\\gamma_{xy}$")
    meridian.set_title("Stress paths", fontsize=11, loc="left")
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(stages), 'stage')}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="stress_path.py", description=__doc__.splitlines()[0])
    kinds.add_options(parser, "stress_path.png")
    records.run(draw, parser)
