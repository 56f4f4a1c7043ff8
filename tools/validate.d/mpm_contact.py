"""tools/validate mpm_contact: contact of bodies at nodes and at their surface, in elastic and Mohr-Coulomb soil.

    mpm_contact.py RVELAB FOLDER RESULTS

An elastic block at rest under its weight on a half-space, and under a plate; a rough footing on weightless soil beside
N_q; a pipe pushed into soil; the collapse of a column. Half a minute of one core."""

import numpy as np

import harness
import mpm
from harness import PROTOCOLS, sets, work

KINDS = ("nodes", "surface")

BLOCK = """
[scene]
name = "elastic block on a half-space, 1 m high"
dimension = 2
[grid]
cell_m = 0.1
[time]
duration_s = {duration}
[loads]
gravity_m_s2 = [0, {gravity}]
[initial]
{initial}
[[material]]
name = "block"
kind = "elastic"
density_kg_m3 = 2000
young_modulus_Pa = 1e6
[[region]]
material = "block"
lower_m = [0, {height}]
upper_m = [0.5, {top}]
[[boundary]]
name = "left"
kind = "roller"
axis = "x"
at_m = 0
[[boundary]]
name = "right"
kind = "roller"
axis = "x"
at_m = 0.5
soil = "below"
[[body]]
name = "base"
kind = "half_space"
centre_m = [0, {height}]
normal = [0, 1]
contact = "{contact}"
"""
PLATE = """
[[body]]
name = "plate"
kind = "box"
centre_m = [0.25, {centre}]
size_m = [2, 0.6]
motion = [[0, 0, 0], [0.1, 0, -0.002]]
contact = "{contact}"
"""
def run(name, scene, *settings):
    """History of a run by columns; stress and position of the points at its end."""
    path = work / f"{name}.toml"
    path.write_text(scene)
    return mpm.run(name, path, "-j", "1", *sets(*settings))[0], mpm.last_frame(name, "stress_Pa", "position_m")


def block(contact, height, plate):
    values = dict(height=height, top=1 + height, contact=contact, duration=0.55 if plate else 3, centre=1.3 + height,
                gravity=0 if plate else -9.81, initial='stress = "zero"' if plate else
                f'stress = "geostatic"\nsurface_m = {1 + height}\nearth_pressure_ratio = {0.3 / 0.7}')
    h, last = run("block", (BLOCK + (PLATE if plate else "")).format(**values))
    stress, position = last
    stress, y = -stress[:, 4], position[:, 1]
    if plate:
        return np.mean(stress) / (-h["plate.displacement_y_m"][-1] * 1e6 * 0.7 / (1.3 * 0.4)) - 1
    return np.max(abs(stress - 2000 * 9.81 * (1 + height - y))) / (2000 * 9.81)


def soil(scene, cohesion):
    return mpm.with_soil("soil", scene, mpm.mohr_coulomb(30, cohesion=cohesion)).read_text()


def main():
    heights = (0.0, 0.02, 0.037, 0.05, 0.08)
    print("elastic block, 5 x 10 cells of 0.1 m with four points each, its base at a height of (m)\n"
          + " " * 47 + "".join(f"{height:<8g}" for height in heights))
    for plate, what in ((False, "at rest 3 s: largest error over rho g h"), (True, "under a plate: mean stress, error")):
        for contact in KINDS:
            print(f"{what:<38} {contact:<8}" + "".join(f"{block(contact, at, plate):<8.3f}" for at in heights), flush=True)
    depths = (0.01, 0.02, 0.03, 0.05, 0.075, 0.1)
    print("\nrough footing on weightless soil, 30 degrees, no dilation, 0.02 m/s: load over surcharge at d/B (N_q 18.4; 12.6\n"
          "by the reduced strength of Davis, 1968)\n" + " " * 23 + "".join(f"{depth:<8g}" for depth in depths))
    for cell, contact in ((0.25, "nodes"), (0.25, "surface"), (0.125, "nodes"), (0.125, "surface")):
        h, _ = run("footing_soil", soil("footing.toml", 0), f"grid.cell_m={cell}", f"body.footing.contact={contact}",
                   "body.footing.motion=[[0, 0, 0], [1, 0, -0.02]]", "time.duration_s=12", "output.history_every_s=0.05")
        load = mpm.moving_mean(1 + h["footing.force_y_N"] / 20e3, 5)
        print(f"cells of {cell:<6g} {contact:<8}"
              + "".join(f"{np.interp(depth, -h['footing.displacement_y_m'] / 2, load):<8.1f}" for depth in depths), flush=True)
    print("\npipe pushed 0.8 m into the same soil: largest force (kN/m)")
    for cell, contact in ((0.25, "nodes"), (0.25, "surface"), (0.125, "nodes"), (0.125, "surface")):
        h, _ = run("pipe_soil", soil("pipe.toml", 100), f"grid.cell_m={cell}", f"body.pipe.contact={contact}",
                   "time.duration_s=0.9")
        force = mpm.moving_mean(h["pipe.force_y_N"] / 1e3, mpm.rows_in(h["time_s"], 0.05), "valid")
        print(f"cells of {cell:<6g} {contact:<8}{force.max():.0f}", flush=True)
    print("\ncolumn of soil (column_soil.toml): largest kinetic energy, dissipated; run-out by gaps of 1/2, 3/4, 1 cell")
    for contact in KINDS:
        h, last = run("column_of_soil", (PROTOCOLS / "mpm/column_soil.toml").read_text(),
                      f"body.base.contact={contact}")
        ends = [mpm.front(last[1], 1 / 16, gap) - 1 for gap in (0.5, 0.75, 1)]
        whole = 2190 * 9.81 * 0.5
        print(f"{contact:<8} {h['kinetic_J'].max() / whole:.3f}  {(-h['potential_J'] - h['kinetic_J'])[-1] / whole:.2f}  "
              + "  ".join(f"{end:.2f}" for end in ends))


if __name__ == "__main__":
    harness.main(main)
