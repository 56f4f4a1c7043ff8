"""tools/validate mpm_rocks: rocks beside material points, against exact answers and published bars.

    mpm_rocks.py RVELAB FOLDER RESULTS

Collisions of two rocks, a slope for spheres, free spin, superquadrics and polyhedra are held to their exact answers by
tests/mpm. Here: balls of a rock and of 4224 points, a block on a slope, a rock that floats, boulders against a barrier,
and what rocks cost. Runs that are whole in FOLDER are used again."""

import filecmp
import re

import h5py
import numpy as np

import harness
from harness import PROTOCOLS, mpm, once, results, sets, verdict
from mpm import folder, frames, last_frame, picture, run


def momentum(name):
    """Of points and rocks along x, N s, at each frame."""
    sums = []
    for points, rocks in zip(frames(name), sorted((folder / name).glob("rocks_*.h5"))):
        with h5py.File(rocks) as file:
            total = (file["mass_kg"][()] * file["velocity_m_s"][()][:, 0]).sum()
        with h5py.File(points) as file:
            if file["velocity_m_s"].size:
                # All points of the ball have one mass.
                total += 9916.5 * 8e-9 * file["velocity_m_s"][()][:, 0].sum()
        sums.append(total)
    return np.array(sums)


def balls():
    print("Two balls of 0.3351 kg at 5 m/s (Li et al. 2023, 4.1)\n")
    for steps in (500, 1000):
        h, _ = run(f"balls_{steps}", "ball_impact.toml", *sets(f"time.rock_steps_per_collision={steps}"))
        residual = np.abs(h["rocks.residual_J"]).max()
        if steps == 500:
            coarse = residual
    verdict("two rocks: speed of the one that flew, m/s", f"{h['flying.velocity_x_m_s'][-1]:.2e}", "0 +- 5e-6",
            abs(h["flying.velocity_x_m_s"][-1]) < 5e-6)
    verdict("two rocks: energy residual over 4.19 J", f"{residual / 4.189:.1e}", "< 1e-4", residual < 4.189e-4)
    verdict("two rocks: it falls at half the step", f"{coarse / residual:.2f}", "4 +- 0.4", abs(coarse / residual - 4) < 0.4)
    lost = {}
    for contact, cfl, cell in (("ghost", 0.1, 4), ("ghost", 0.05, 4), ("surface", 0.4, 4), ("surface", 0.4, 2), ("surface", 0.1, 4),
                               ("surface", 0.1, 2)):
        name = f"ball_points_{contact}_{cfl}" + ("_fine" if cell == 2 else "")
        h, _ = run(name, "ball_impact.toml", "--case", "points",
                   *sets(f'rock_soil.contact="{contact}"', f"time.cfl={cfl}", f"grid.cell_m={cell}e-3"))
        rock, soil = -h["flying.velocity_x_m_s"][-1], -h["momentum_x_N_s"][-1] / 0.3351
        head = f"points, {contact}, cells of {cell} mm, cfl {cfl}: "
        if cell == 4:
            p = momentum(name)
            change = np.abs(p / p[0] - 1).max()
            verdict(head + "momentum, change", f"{change:.1e}", "< 1e-12", change < 1e-12)
        if contact == "ghost":
            verdict(head + "rock after, m/s", f"{rock:.3f}", "-0.15 to 0.15", abs(rock) < 0.15)
            verdict(head + "points after, m/s", f"{soil:.3f}", "4.85 to 5", 4.85 <= soil <= 5)
        lost[contact, cfl, cell] = 1 - (soil - rock) / 5
        print(f"    restitution {(soil - rock) / 5:.3f}; rock {rock:.3f}, points {soil:.3f} m/s after; soil's energy residual "
              f"{np.abs(h['residual_J']).max():.2e} J, its kinetic energy {h['kinetic_J'][-1]:.3f} J")
    # Impulses stop the soil that they reach, a layer of a cell: what they take is of first order in it, half at half of it.
    for cfl in (0.4, 0.1):
        ratio = lost["surface", cfl, 2] / lost["surface", cfl, 4]
        verdict(f"points, surface, cfl {cfl}: lost restitution, cells of 2 mm over 4 mm", f"{ratio:.2f}", "0.25 to 0.6",
                0.25 <= ratio <= 0.6)


def slid(contact, friction, *options, name=""):
    """Speed and way along a slope less the exact ones, m/s and m, and these. While it slides, the ground takes as much of the
    speed down the slope as friction has of what it gives across it: hops and settling are taken out so."""
    h, _ = run(f"block_{contact}_{friction}{name}", "block_slide.toml",
               *sets(f'rock_soil.contact="{contact}"', f"rock_soil.friction={friction}", *options))
    t = h["time_s"]
    speed, way = 10 * (1 - friction) * t, 5 * (1 - friction) * t**2
    return (h["block.velocity_x_m_s"] + friction * h["block.velocity_z_m_s"] - speed,
            h["block.x_m"] + friction * (h["block.z_m"] - h["block.z_m"][0]) - way, speed, way)


def block():
    print("\nBlock on a slope of 45 degrees for 0.5 s (Li et al. 2023, 4.2)\n")
    stiffer = slid("surface", 0.5, "material.0.young_modulus_Pa=1.28e9", "time.duration_s=0.04", name="_stiff")[0]
    for contact in ("surface", "ghost"):
        for friction in (0.1, 0.2, 0.3, 0.4, 0.5):
            faster, farther, speed, way = slid(contact, friction)
            verdict(f"{contact}, friction {friction}: speed, error", f"{100 * faster[-1] / speed[-1]:.2f} %", "0.3 %",
                    abs(faster[-1]) < 3e-3 * speed[-1])
            # The first rows, 0.02 s: it slides only once it has sheared the elastic ground so far.
            held, stiff = faster[2], stiffer[2]
            verdict(f"{contact}, friction {friction}: distance, error", f"{100 * farther[-1] / way[-1]:.3f} %", "0.06 %",
                    abs(farther[-1]) < 6e-4 * way[-1],
                    contact == "surface" and 0 < stiff < 0.25 * held and abs(farther[-1] - 0.5 * held) < 3e-4 * way[-1],
                    f"sticks to the elastic ground for the first moment and gains {1e3 * held:.2f} mm/s by 0.02 s, most of the distance; "
                    f"ground 16 times as stiff: {1e3 * stiff:.2f} mm/s (exact: rigid ground)")


FLOAT = """
[scene]
name = "float"
[grid]
cell_m = 0.1
[time]
duration_s = 4
[loads]
gravity_m_s2 = [0, -9.81]
[initial]
stress = "geostatic"
surface_m = 1.5
[[material]]
name = "mud"
kind = "mohr_coulomb"
density_kg_m3 = 2000
young_modulus_Pa = 2e5
poisson_ratio = 0.49
friction_angle_deg = 0
cohesion_Pa = 1
[[region]]
material = "mud"
lower_m = [0, 0]
upper_m = [3, 1.5]
[[boundary]]
name = "left"
kind = "roller"
axis = "x"
at_m = 0
[[boundary]]
name = "right"
kind = "roller"
axis = "x"
at_m = 3
soil = "below"
[[boundary]]
name = "base"
kind = "roller"
axis = "y"
at_m = 0
[[rock_material]]
name = "light"
density_kg_m3 = 1000
young_modulus_Pa = 1e7
[[rock]]
name = "rock"
material = "light"
radius_m = 0.5
centre_m = [1.5, 1.5]
[rock_soil]
contact = "{contact}"
friction = 0
"""


def floating():
    """A disc of half the density sinks to its centre: the mud rises by its lower half."""
    print("\nDisc of 0.5 m and half the density in mud without strength (1 Pa), half sunk at the start\n")
    for contact in ("surface", "ghost"):
        scene = folder.resolve() / f"float_{contact}.toml"
        scene.write_text(FLOAT.format(contact=contact))
        h, _ = run(f"float_{contact}", scene)
        late = h["time_s"] > 2
        x, volume = last_frame(f"float_{contact}", "position_m", "volume_m3")
        # The level, away from the disc: columns of points on the outer sides.
        aside = (x[:, 0] < 0.6) | (x[:, 0] > 2.4)
        level = volume[aside].sum() / 1.2
        depth = level - h["rock.y_m"][late].mean()
        verdict(f"{contact}: depth of the centre below the level over the radius", f"{depth / 0.5:.3f}", "0 +- 0.02",
                abs(depth / 0.5) < 0.02)
        force, weight = h["rock.soil_force_y_N"][late].mean(), 1000 * np.pi * 0.25 * 9.81
        # The disc still bobs a little: the mean force over a time T is weight + m (v' - v)/T by Newton's law.
        first = np.flatnonzero(late)[0] - 1
        faster = (h["rock.velocity_y_m_s"][-1] - h["rock.velocity_y_m_s"][first]) / (h["time_s"][-1] - h["time_s"][first]) / 9.81
        verdict(f"{contact}: force of the mud, less what speeds the disc up, over the weight", f"{force / weight - faster:.4f}",
                "1 +- 0.001", abs(force / weight - faster - 1) < 1e-3)
        print(f"    with it {force / weight:.4f}")


def same_files(a, b):
    names = sorted(path.name for path in (folder / a).iterdir())
    differ = [name for name in names if not filecmp.cmp(folder / a / name, folder / b / name, shallow=False)]
    return len(names), differ


def shares(printed):
    """Seconds: continuum, rocks, soil on rocks, and million point-steps a second."""
    found = re.search(r"continuum (\S+) s.*rocks (\S+) s, soil on rocks (\S+) s", printed)
    rate = re.search(r"(\S+) M point-steps", printed)
    return *(float(each) for each in found.groups()), float(rate.group(1))


def boulders():
    print("\nBoulders in debris against a barrier (boulders.toml, five of them, 4110 points, 2.5 s)\n")
    h, printed = run("boulders", "boulders.toml", "-j", "1")
    h2, _ = run("boulders_2", "boulders.toml", "-j", "2")
    count, differ = same_files("boulders", "boulders_2")
    verdict(f"one and two threads: files that differ, of {count}", str(len(differ)), "0", not differ)
    name = "boulders_stopped"

    def stopped(out):
        harness.run(mpm, PROTOCOLS / "mpm/boulders.toml", "-o", out, "-q", "--stop-at", "1.2")
        harness.run(mpm, "--resume", out, "-q")

    once(folder / name, "boulders, stopped at 1.2 s", make=stopped)
    # The checkpoint says when the next one is due: a stop is one more.
    count, differ = same_files("boulders", name)
    verdict(f"stopped at 1.2 s and resumed: files that differ, of {count}", str(len(differ)), "0", not differ)
    largest = h["rocks.kinetic_J"].max()
    residual = np.abs(h["rocks.residual_J"]).max()
    print(f"    largest force on the barrier {np.abs(h['barrier.force_x_N']).max():.0f} N, at rest "
          f"{np.abs(h['barrier.force_x_N'][-50:]).mean():.0f} N; rocks' largest kinetic energy {largest:.0f} J, residual "
          f"{residual:.2g} J; soil's residual {np.abs(h['residual_J']).max():.0f} J of {h['kinetic_J'].max():.0f} J")
    picture(folder / "boulders", "--field", "velocity", "--frame", "22", "-o", results / "mpm_boulders.png")
    points, rocks, soil, rate = shares(printed)
    print(f"    rocks {rocks:.2f} s, soil against rocks {soil:.1f} s of {points:.1f} s: {100 * (rocks + soil) / points:.0f} %"
          f" (published, of the pair's time: 10 and 21 %); {1 / rate:.2f} s a million point-steps")


FIELD = """
[scene]
name = "field"
dimension = 3
[grid]
cell_m = 0.1
[time]
duration_s = 0.05
rock_steps_per_collision = 20
[loads]
gravity_m_s2 = [0, 0, -9.81]
[initial]
stress = "geostatic"
surface_m = 2
[[material]]
name = "soil"
kind = "mohr_coulomb"
density_kg_m3 = 1900
young_modulus_Pa = 5e6
friction_angle_deg = 30
cohesion_Pa = 1e3
[[region]]
material = "soil"
lower_m = [0, 0, 0]
upper_m = [5, 5, 2]
points_per_cell = 1
[[boundary]]
name = "base"
kind = "fixed"
axis = "z"
at_m = 0
{sides}
[[rock_material]]
name = "granite"
density_kg_m3 = 2700
young_modulus_Pa = 1e8
[[rocks]]
name = "rocks"
material = "granite"
lower_m = [0.1, 0.1, 0.1]
upper_m = [4.9, 4.9, 1.9]
volume_share = {share}
diameters_m = [[0.3, 1]]
[rock_soil]
contact = "{contact}"
"""
SIDE = '[[boundary]]\nname = "{name}"\nkind = "roller"\naxis = "{axis}"\nat_m = {at}\nsoil = "{soil}"\n'


def cost():
    print("\nCost: 0.05 s of 50,000 points with spheres of 0.3 m in them (three points across); the shares on one thread\n")
    print("contact   rocks  points   steps   s a million   on two    soil on rocks   among rocks   contacts with soil\n"
          "                                  point-steps   threads        %              %")
    sides = "".join(SIDE.format(name=f"{axis}{k}", axis=axis, at=5 * k, soil=("above", "below")[k])
                    for axis in "xy" for k in (0, 1))
    box = 4.8 * 4.8 * 1.8
    for contact in ("surface", "ghost"):
        for count in (10, 100, 1000):
            name = f"field_{contact}_{count}"
            scene = folder.resolve() / f"{name}.toml"
            scene.write_text(FIELD.format(contact=contact, sides=sides, share=count * np.pi / 6 * 0.027 / box))
            for each in (name, name + "_two"):  # times of one program: made again
                (folder / f"{each}.whole").unlink(missing_ok=True)
            h, printed = run(name, scene, "-j", "1")
            points, rocks, soil, rate = shares(printed)
            two = shares(run(name + "_two", scene, "-j", "2")[1])[-1]
            n = len(last_frame(name, "position_m")[0])
            print(f"{contact:<9} {count:<6} {n:<8} {int(h['steps'][-1]):<7} {1 / rate:<13.2f} {1 / two:<9.2f} "
                  f"{100 * soil / points:<15.1f} {100 * rocks / points:<13.2f} {int(h['rocks.soil_contacts'][-1])}",
                  flush=True)


def main():
    for part in (balls, block, floating, boulders, cost):
        part()


if __name__ == "__main__":
    harness.main(main)
