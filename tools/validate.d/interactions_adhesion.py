"""Packings of grains that stick, rvelab beside LAMMPS' pair_style granular: for tools/validate interactions_peers.

The same law in both is

    rvelab                                  LAMMPS
    stage jkr, surface_energy_J_m2 gamma    jkr E eta nu gamma: its cohesion energy is gamma too, the work of adhesion 2 gamma
    stage dmt, gamma, range_m -> 0          dmt E eta nu gamma: 4 pi gamma R* on touching grains alone

with the effective modulus E/(2 (1 - nu^2)) and the effective radius r1 r2/(r1 + r2) in either. A JKR pair parts in LAMMPS at
the gap of its largest pull, 1.23 (gamma^2 R*/E*^2)^(1/3), where a held force would tear it off; in rvelab at 2.55 of the same,
the end of the branch that is stable at a held gap. So the strain here is one at which no pair parts.
"""
import numpy as np

import interactions_packing as packings
from harness import verdict

YOUNG, POISSON, GAMMA, RADIUS, DENSITY = 1e7, 0.25, 0.3, 1e-3, 2650
MODULUS = YOUNG / (2 * (1 - POISSON**2))
GRADIENT = 1e-5 * np.array([[0, 1.0, 0], [0, 0, 0], [0, 0, -0.5]])
RECIPE = f"""
[pack]
name = "sticky"
shape = "sphere"
number = 300
seed = 1
[grains]
grading = "uniform"
smallest_radius_m = {RADIUS}
largest_radius_m = {{largest}}
[preparation]
friction = 0
[target]
pressure_Pa = 1e3
[contact]
law = "hertz_mindlin"
[[material]]
name = "grains"
density_kg_m3 = {DENSITY}
young_modulus_Pa = {YOUNG}
poisson_ratio = {POISSON}
friction = 0
"""
STAGE = """
[test]
name = "sticky"
dimension = 3
[loading]
mode = "quasi_static"
[[stage]]
kind = "{law}"
surface_energy_J_m2 = {gamma}
{range}
"""
LAMMPS = """units si
atom_style sphere
boundary p p p
newton on off
comm_modify vel yes
read_data {data}
change_box all triclinic
pair_style granular
pair_coeff * * {law} {young} 0 {poisson} {gamma} tangential linear_nohistory 0 0 damping velocity
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
timestep {time_step}
fix move all nve/sphere
dump out all custom 1 lammps.forces id xu yu zu fx fy fz
dump_modify out sort id format float %.17g
run 0
undump out
fix damp all damping/cundall 0.3 0.3  # takes its part of the forces, so that they are dumped before
change_box all {change} remap units box
run 30000
dump out all custom 1 lammps.rest id xu yu zu fx fy fz
dump_modify out sort id format float %.17g
run 0
"""


def force_of(law, gap, radius):
    """Of a pair that touches, positive in compression; of JKR by bisection in the radius a of the area of contact."""
    delta = -gap
    if law == "dmt":
        return 4 / 3 * MODULUS * np.sqrt(radius) * np.maximum(delta, 0) ** 1.5 - 4 * np.pi * GAMMA * radius
    low = np.cbrt(np.pi * GAMMA * radius**2 / (4 * MODULUS))
    high = 100 * low
    for _ in range(100):
        a = 0.5 * (low + high)
        above = a**2 / radius - 2 * np.sqrt(np.pi * GAMMA * a / MODULUS) > delta
        low, high = np.where(above, low, a), np.where(above, a, high)
    return 4 * MODULUS * a**3 / (3 * radius) - np.sqrt(16 * np.pi * GAMMA * MODULUS * a**3)


def specimen(program, folder, largest, law):
    """An RVE at rest with adhesion in a cubic cell, whose pairs that stick all overlap: what a program that knows no more than
    its positions begins with too."""
    stem = folder / f"sticky_{largest}"
    edge, positions, radii = packings.cubic(program, stem, RECIPE.format(largest=largest))
    stage = STAGE.format(law=law, gamma=GAMMA, range="range_m = 1e-13" if law == "dmt" else "")
    for _ in range(3):
        rve = packings.put(program, stem, edge, positions, radii, stage)
        start = rve.snapshot()
        rve.relax(1e-9, 200_000)
        positions = rve.array("grains/position_m")
    return packings.rvelab.Rve(start), edge


def of_lammps(folder, lmp, law, x, r, edge, time_step):
    """Positions and forces, from the same positions: at once, and at rest under the strain."""
    inside = x - edge * np.floor(x / edge + 0.5)
    lines = ["sticky packing", "", f"{len(x)} atoms", "1 atom types",
             *(f"{-0.5 * edge!r} {0.5 * edge!r} {c}lo {c}hi" for c in "xyz"), "", "Atoms # sphere", ""]
    lines += [f"{k + 1} 1 {2 * float(rk)!r} {DENSITY} {float(p[0])!r} {float(p[1])!r} {float(p[2])!r}"
              for k, (p, rk) in enumerate(zip(inside, r))]
    (folder / "sticky.data").write_text("\n".join(lines) + "\n")
    change = " ".join([f"xy delta {GRADIENT[0, 1] * edge!r}", f"z scale {1 + GRADIENT[2, 2]!r}"])
    (folder / "sticky.in").write_text(LAMMPS.format(data="sticky.data", law=law, young=YOUNG, poisson=POISSON, gamma=GAMMA,
                                                    skin=0.3 * RADIUS, time_step=time_step, change=change))
    packings.run([lmp, "-in", "sticky.in", "-log", "none"], cwd=folder)
    return [np.loadtxt((folder / f"lammps.{name}").read_text().split("ITEM: ATOMS")[-1].splitlines()[1:])[:, 1:]
            for name in ("forces", "rest")]


def gaps_of(x, pairs, lattice, r):
    """Of the nearest image of each pair."""
    i, j = pairs.T
    d = (x[j] - x[i]) @ np.linalg.inv(lattice).T
    return np.linalg.norm((d - np.round(d)) @ lattice.T, axis=1) - r[i] - r[j]


def adhesion(program, folder, lmp):
    print("\nPackings that stick, beside LAMMPS' pair_style granular: largest difference over the mean size of the forces\n")
    for law in ("jkr", "dmt"):
        for what, largest in (("equal radii", RADIUS), ("radii 1:2", 2 * RADIUS)):
            rve, edge = specimen(program, folder, largest, law)
            x, r, first_resultants = (rve.array("grains/" + n) for n in ("position_m", "radius_m", "resultant_N"))
            overlap = rve.array("contacts/overlap_m").max()
            time_step = 0.1 * np.sqrt(rve.array("grains/mass_kg").min() / (2 * MODULUS * np.sqrt(RADIUS * overlap)))
            rve.apply(GRADIENT)
            rve.relax(1e-12, 400_000)
            group = "jkr_contacts" if law == "jkr" else "contacts"
            pairs = np.stack([rve.array(f"{group}/{c}") for c in "ij"], axis=1)
            reduced = r[pairs[:, 0]] * r[pairs[:, 1]] / (r[pairs[:, 0]] + r[pairs[:, 1]])
            first, rest = of_lammps(folder, lmp, law, x, r, edge, float(time_step))
            own = force_of(law, gaps_of(rve.array("grains/position_m"), pairs, rve.rotation @ rve.lattice, r), reduced)
            other = force_of(law, gaps_of(rest[:, :3], pairs, (np.eye(3) + GRADIENT) * edge, r), reduced)
            scale = np.abs(own).mean()
            for which, difference in (("resultants at the same places", np.abs(first[:, 3:] - first_resultants).max() / scale),
                                      ("at rest under a strain", np.abs(own - other).max() / scale)):
                verdict(f"{law}, {what}, {len(pairs)} pairs, {np.count_nonzero(own < 0)} pull: {which}", f"{difference:.1e}",
                        "1e-8", difference < 1e-8, width=70)
