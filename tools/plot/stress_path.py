#!/usr/bin/env python3
"""Stress paths: stress_path.py RECORDS.h5... -o stress_path.png (folders stand for their *.h5).

Left, q against p of every stage with records, q = sqrt(s:s/2) in 2D and sqrt(3 s:s/2) in 3D; right, the stress path of 3D
tests in the deviatoric plane (compression positive, axes z, x, y at 90, -30 and 210 degrees), of 2D tests the shear
stress against the difference of the normal stresses. Compression positive.
"""

import argparse
import math

import records  # first: it says which package is missing
import matplotlib.pyplot as plt
import numpy as np


def deviatoric_plane(stress):
    """Coordinates of 3D stresses along and across the projection of the z axis."""
    x, y, z = (stress[:, k, k] for k in range(3))
    return (x - y) / math.sqrt(2), (2 * z - x - y) / math.sqrt(6)


def draw(stages, options):
    figure, (meridian, plane) = plt.subplots(1, 2, figsize=(10, 4.4))
    three = stages[0].dimension == 3
    for stage, colour in zip(stages, records.pressure_colours(len(stages))):
        p, q = stage.invariants()
        meridian.plot(p / 1e3, q / 1e3, color=colour, label=stage.label)
        meridian.plot(p[0] / 1e3, q[0] / 1e3, "o", color=colour, markersize=4)
        if three:
            across, along = deviatoric_plane(stage.stress)
        else:
            across = 0.5 * (stage.stress[:, 1, 1] - stage.stress[:, 0, 0])
            along = -0.5 * (stage.stress[:, 0, 1] + stage.stress[:, 1, 0])
        plane.plot(across / 1e3, along / 1e3, color=colour)
        plane.plot(across[0] / 1e3, along[0] / 1e3, "o", color=colour, markersize=4)
    meridian.set_xlabel("mean stress $p$ (kPa)")
    meridian.set_ylabel("deviatoric stress $q$ (kPa)")
    # Room beside a path that goes straight up.
    meridian.set_xlim(0, 1.05 * max(meridian.dataLim.x1, meridian.get_xlim()[1]))
    meridian.set_ylim(bottom=0)
    meridian.legend(fontsize=8)
    plane.set_aspect("equal", adjustable="datalim")
    if three:
        reach = 1.15 * max(float(np.abs(plane.get_ylim()).max()), float(np.abs(plane.get_xlim()).max()))
        for name, angle in (("$\\sigma_z$", 90), ("$\\sigma_x$", -30), ("$\\sigma_y$", 210)):
            end = reach * math.cos(math.radians(angle)), reach * math.sin(math.radians(angle))
            plane.plot([0, end[0]], [0, end[1]], color="0.7", linewidth=0.8)
            plane.annotate(name, end, color="0.4")
        plane.set_title("deviatoric plane (kPa)", fontsize=10, loc="left")
    else:
        plane.set_xlabel("$(\\sigma_y - \\sigma_x)/2$ (kPa)")
        plane.set_ylabel("$\\sigma_{xy}$ (kPa), positive with $\\gamma_{xy}$")
    figure.suptitle("Stress paths", fontsize=11, x=0.12, ha="left")
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: {records.counted(len(stages), 'stage')}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="stress_path.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default="stress_path.png", help="figure to write (PNG, PDF or SVG)")
    records.run(draw, parser, read=records.read_driven_stages)
