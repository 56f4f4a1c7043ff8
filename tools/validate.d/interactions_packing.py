"""Bonded packings of spheres, and what rvelab, YADE and LAMMPS make of them: for tools/validate interactions_peers and
tools/bench/interactions.

A bond of rvelab, a section of radius R with kn and ks per area, is in the two others, for its own pair of grains,

    normal    kn A,  A = pi R^2          LAMMPS bpm/rotational Kr    YADE CohFrictPhys kn, with unp the overlap at first
    shear     ks A                       Ks                          ks
    bending   kn I,  I = pi R^4/4        Kb                          kr
    twisting  ks J,  J = pi R^4/2        Kt                          ktw
    tension   strength A                 Fcr                         normalAdhesion
    shear     cohesion A                 Fcs                         shearAdhesion
    moments   strength I/R, cohesion J/R Tcb, Tct                    none: moments break no bond, moment_factor = 0

In YADE a bond takes the place of the contact; in rvelab and in LAMMPS (overlay/pair) it stands beside it. Arms reach to
the middle of the gap in rvelab and YADE, to the middle between the centres in LAMMPS: the same for equal radii. LAMMPS
measures shear and bending as angles from the first state, the others add up increments: the same at small strains.
LAMMPS breaks a bond where f_r/Fcr + |f_s|/Fcs + |M_b|/Tcb + |M_t|/Tct passes 1, which is rvelab's tension at the rim
where the cohesion is infinite.
"""
import csv
import json
import os
import pathlib
import re
import sys

import numpy as np

import harness

sys.path.insert(0, str(harness.ROOT / "tools/python"))
import rvelab  # noqa: E402

YADE = pathlib.Path(__file__).with_name("interactions_yade.py")
MODULUS, SHEAR_RATIO, DENSITY, GAP = 1e9, 0.4, 2650, 0.2
RECIPE = """
[pack]
name = "spheres"
shape = "sphere"
number = {grains}
seed = {seed}
[grains]
grading = "uniform"
smallest_radius_m = 1e-3
largest_radius_m = {largest}
[preparation]
friction = 0.1
[target]
pressure_Pa = 100e3
[contact]
law = "linear_stiffness"
[[material]]
name = "grains"
density_kg_m3 = 2650
normal_stiffness_N_m = 1e6
tangential_stiffness_N_m = 0.5e6
friction = 0.5
"""
CEMENT = """
[test]
name = "cement"
dimension = 3
[loading]
mode = "quasi_static"
[[stage]]
kind = "cement"
gap = {gap}
young_modulus_Pa = {modulus}
shear_ratio = {ratio}
tensile_strength_Pa = {tension}
cohesion_Pa = {cohesion}
friction_angle_deg = 0
moment_factor = {factor}
"""


def run(words, **options):
    return harness.run(*words, **options).stdout


def in_yade(script, folder, job):
    """What a script that runs inside YADE, on one core, answers to a job."""
    question, answer = folder / f"{script.stem}.job.json", folder / f"{script.stem}.out.json"
    question.write_text(json.dumps(job))
    run(["yade", "-n", "-x", "-j1", script, question, answer], env=dict(os.environ, OMP_NUM_THREADS="1"))
    return json.loads(answer.read_text())


def cubic(program, stem, recipe):
    """A packing of spheres in a cubic cell, so that it is the same in all programs: edge, positions, radii. It was
    packed in a cell that differs from it by some 1e-4."""
    pathlib.Path(f"{stem}.toml").write_text(recipe)
    run([program, "pack", f"{stem}.toml", "-o", f"{stem}.h5", "--force"])
    run([program, "export", f"{stem}.h5", "--format", "csv", "-o", stem, "--force"])
    lattice = np.array(json.loads(run([program, "inspect", f"{stem}.h5", "--json"]))["lattice_m"])
    edge = float(np.cbrt(np.linalg.det(lattice)))
    with open(f"{stem}.particles.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return (edge, np.array([[float(row[c]) for c in "xyz"] for row in rows]) @ np.linalg.inv(lattice).T * edge,
            [float(row["r"]) for row in rows])


def put(program, stem, edge, positions, radii, protocol):
    """An RVE of these spheres after a protocol."""
    with open(f"{stem}.apart.csv", "w", encoding="utf-8") as file:
        file.write("id,x,y,z,r\n")
        file.writelines(f"{k},{float(x[0])!r},{float(x[1])!r},{float(x[2])!r},{r!r}\n"
                        for k, (x, r) in enumerate(zip(positions, radii)))
    run([program, "import", f"{stem}.apart.csv", "--cell", f"{edge!r},{edge!r},{edge!r}", "--material",
         f"{stem}.material.toml", "-o",
         f"{stem}.apart.h5", "--force"])
    pathlib.Path(f"{stem}.test.toml").write_text(protocol)
    run([program, "run", f"{stem}.test.toml", "--specimen", f"{stem}.apart.h5", "-o", f"{stem}.put.h5", "--force"])
    return rvelab.Rve(f"{stem}.put.h5")


class Cemented:
    """A packing of spheres that stand a hundredth of their radii off each other (`shrunk`), bonded without force: the
    bonds alone act."""

    def __init__(self, program, folder, seed=1, grains=300, largest=1e-3, tension=1e30, cohesion=1e30, factor=1.0,
                 shrunk=0.01):
        self.program, self.folder = program, pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        stem = self.folder / f"{seed}_{grains}_{largest}"
        edge, positions, radii = cubic(program, stem, RECIPE.format(seed=seed, grains=grains, largest=largest))
        rve = put(program, stem, edge, positions, [(1 - shrunk) * r for r in radii], CEMENT.format(
            gap=GAP, modulus=MODULUS, ratio=SHEAR_RATIO, tension=tension, cohesion=cohesion, factor=factor))
        self.start, self.edge = rve.snapshot(), edge
        self.x, self.r, self.mass = (rve.array("grains/" + n) for n in ("position_m", "radius_m", "mass_kg"))
        bond = {name: rve.array("bonds/" + name) for name in ("i", "j", "radius_m", "normal_stiffness_Pa_m",
                                                             "shear_stiffness_Pa_m")}
        self.i, self.j, self.branch = bond["i"], bond["j"], branches(rve)
        R = bond["radius_m"]
        area, inertia = np.pi * R**2, np.pi * R**4 / 4
        kn, ks = bond["normal_stiffness_Pa_m"], bond["shear_stiffness_Pa_m"]
        self.kA, self.sA, self.kI, self.sJ = kn * area, ks * area, kn * inertia, 2 * ks * inertia
        self.strengths = tension * area, cohesion * area, tension * inertia / R, cohesion * 2 * inertia / R
        self.time_step = 0.2 * float(np.sqrt((self.mass.min() / self.kA.max())))

    def rve(self):
        return rvelab.Rve(self.start)

    def job(self, **what):
        return {"edge": self.edge, "reach": 1 + 0.5 * GAP, "density": DENSITY, "x": self.x.tolist(), "r": self.r.tolist(),
                "i": self.i.tolist(), "j": self.j.tolist(), "dt": self.time_step,
                **{name: getattr(self, name).tolist() for name in ("kA", "sA", "kI", "sJ")},
                "tension": self.strengths[0].tolist(), "shear": self.strengths[1].tolist(), **what}

    def yade(self, **what):
        return in_yade(YADE, self.folder, self.job(**what))


def branches(rve):
    x, lattice = rve.array("grains/position_m"), rve.rotation @ rve.lattice
    return x[rve.array("bonds/j")] - x[rve.array("bonds/i")] + rve.array("bonds/image") @ lattice.T


def forces_of(rve):
    """Force and moment on j of each bond, N and N m."""
    bond = {name: rve.array("bonds/" + name) for name in ("length_m", "radius_m", "normal_stiffness_Pa_m", "shear_force_N",
                                                         "bending_moment_N_m", "twisting_moment_N_m")}
    branch = branches(rve)
    length = np.linalg.norm(branch, axis=1)
    n = branch / length[:, None]
    normal = bond["normal_stiffness_Pa_m"] * np.pi * bond["radius_m"]**2 * (bond["length_m"] - length)
    moment = bond["bending_moment_N_m"] + bond["twisting_moment_N_m"][:, None] * n
    return np.hstack([normal[:, None] * n + bond["shear_force_N"], moment])


def direct(packing, gradient):
    """The same at strain 1 by a stiffness matrix of beams, all degrees of freedom at once: no time step, no increment."""
    count, bonds = len(packing.x), range(len(packing.i))
    matrix, load, kept = np.zeros((6 * count, 6 * count)), np.zeros(6 * count), []

    def cross(v):  # cross(v) w = w x v
        return np.array([[0, v[2], -v[1]], [-v[2], 0, v[0]], [v[1], -v[0], 0]])

    for b in bonds:
        i, j, d = packing.i[b], packing.j[b], packing.branch[b]
        length = np.linalg.norm(d)
        n = d / length
        half_gap = 0.5 * (length - packing.r[i] - packing.r[j])
        strain = np.zeros((6, 12))  # displacement and rotation of j less that of i at the middle of the gap
        strain[:3, :3], strain[:3, 6:9] = -np.eye(3), np.eye(3)
        strain[:3, 3:6] = -cross((packing.r[i] + half_gap) * n)
        strain[:3, 9:] = -cross((packing.r[j] + half_gap) * n)
        strain[3:, 3:6], strain[3:, 9:] = -np.eye(3), np.eye(3)
        along, across = np.outer(n, n), np.eye(3) - np.outer(n, n)
        stiffness = np.zeros((6, 6))
        stiffness[:3, :3] = packing.kA[b] * along + packing.sA[b] * across
        stiffness[3:, 3:] = packing.sJ[b] * along + packing.kI[b] * across
        affine = np.r_[gradient @ d, 0, 0, 0]
        rows = np.r_[6 * i:6 * i + 6, 6 * j:6 * j + 6]
        matrix[np.ix_(rows, rows)] += strain.T @ stiffness @ strain
        load[rows] += strain.T @ stiffness @ affine
        kept.append((strain, stiffness, affine, rows))
    # The mean translation is free; a grain without bonds too.
    free = np.flatnonzero(np.diag(matrix) > 0)[3:]
    moved = np.zeros(6 * count)
    moved[free] = np.linalg.solve(matrix[np.ix_(free, free)], -load[free])
    return np.array([-stiffness @ (strain @ moved[rows] + affine) for strain, stiffness, affine, rows in kept])


# --- LAMMPS ---

LAMMPS_HEAD = """units si
atom_style bpm/sphere
boundary p p p
newton on off
{special}
comm_modify vel yes cutoff {cutoff}
read_data {data}
change_box all triclinic
bond_style bpm/rotational smooth no {overlay}
bond_coeff 1 {kA} {sA} {sJ} {kI} {tension} {shear} {twisting} {bending} 0 0 0 0
{pair}
pair_coeff * *
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
timestep {time_step}
fix move all nve/bpm/sphere
fix damp all damping/cundall 0.3 0.3
thermo_modify norm no
compute stress all pressure NULL bond
compute of all nbond/atom
compute left all reduce sum c_of
"""


def lammps(packing, program, commands, contacts=False):
    """Runs `commands` on the packing, in whose folder; equal radii. contacts: those of the recipe, without their history."""
    if np.ptp(packing.r) > 0:
        raise ValueError("bpm/rotational is the same law for equal radii alone")
    edge, count = packing.edge, len(packing.x)
    x = packing.x - edge * np.floor(packing.x / edge + 0.5)
    lines = ["bonded packing", "", f"{count} atoms", f"{len(packing.i)} bonds", "1 atom types", "1 bond types",
             "30 extra bond per atom", "100 extra special per atom",
             *(f"{-0.5 * edge!r} {0.5 * edge!r} {c}lo {c}hi" for c in "xyz"), "", "Atoms # bpm/sphere", ""]
    lines += [f"{k + 1} 1 1 {2 * float(r)!r} {DENSITY} {float(p[0])!r} {float(p[1])!r} {float(p[2])!r}"
              for k, (p, r) in enumerate(zip(x, packing.r))]
    lines += ["", "Bonds", ""] + [f"{k + 1} 1 {i + 1} {j + 1}" for k, (i, j) in enumerate(zip(packing.i, packing.j))]
    data = packing.folder / "lammps.data"
    data.write_text("\n".join(lines) + "\n")
    radius = float(packing.r[0])
    tension, shear, bending, twisting = (float(s[0]) for s in packing.strengths)
    cutoff = 3.5 * radius
    beside = ({"special": "special_bonds lj/coul 1 1 1", "overlay": "overlay/pair yes",
               "pair": "pair_style gran/hooke/history 1e6 5e5 0 0 0.5 0"} if contacts else
              {"special": "special_bonds lj 0 1 1 coul 1 1 1", "overlay": "", "pair": f"pair_style zero {cutoff}"})
    head = LAMMPS_HEAD.format(**beside, data=data.name, cutoff=cutoff, skin=0.5 * radius, time_step=packing.time_step,
                              kA=float(packing.kA[0]), sA=float(packing.sA[0]), kI=float(packing.kI[0]),
                              sJ=float(packing.sJ[0]), tension=tension, shear=shear, bending=bending, twisting=twisting)
    (packing.folder / "lammps.in").write_text(head + commands)
    return run([program, "-in", "lammps.in", "-log", "none"], cwd=packing.folder)


def lammps_forces(packing, program, gradient, strain):
    """At rest under that strain: first the state without force, which LAMMPS takes as its reference, then the cell moved
    at once; its law knows no path.

    compute bond/local takes the wrong image of a bond across the boundary (bpm/rotational, 4Feb2025): all grains are
    moved by half a lattice vector, and again, and each bond is read where it lies well within the cell."""
    g, edge = strain * gradient, packing.edge
    box = " ".join(f"{c} scale {1 + g[k, k]!r}" for k, c in enumerate("xyz") if g[k, k])
    tilt = " ".join(f"{name} delta {g[k] * edge!r}" for name, k in (("xy", (0, 1)), ("xz", (0, 2)), ("yz", (1, 2))) if g[k])
    reads, shift, shifts = [], np.zeros(3), []
    for step, axis in enumerate((None, 0, 1, 0, 2, 0, 1, 0)):  # Gray's code: all eight corners
        if axis is not None:
            half = 0.5 * edge * (np.eye(3) + g)[:, axis]
            reads.append("displace_atoms all move " + " ".join(repr(float(v)) for v in half) + " units box")
            shift[axis] += 0.5
        shifts.append(shift.copy())
        reads += [f"dump out all local 1 lammps.forces.{step} c_id[1] c_id[2] c_force[1] c_force[2] c_force[3]",
                  "dump_modify out format float %.17g", "run 0", "undump out"]
    lammps(packing, program, f"""run 0
change_box all {tilt} {box} remap units box
run 12000
compute id all property/local batom1 batom2
compute force all bond/local b5 b6 b7
""" + "\n".join(reads) + "\n")
    within = packing.x / edge + 0.5
    best, out = np.full(len(packing.i), -np.inf), np.zeros((len(packing.i), 3))
    for step, shift in enumerate(shifts):
        text = (packing.folder / f"lammps.forces.{step}").read_text()
        rows = np.loadtxt(text.split("ITEM: ENTRIES")[-1].splitlines()[1:])
        # On the first of the two.
        found = {(min(a, b), max(a, b)): (-force if a < b else force)
                 for (a, b), force in zip(rows[:, :2].astype(int) - 1, rows[:, 2:])}
        at = (within + shift) % 1
        margin = np.minimum(at, 1 - at).min(axis=1)
        crosses = (np.abs(at[packing.i] - at[packing.j]) > 0.5).any(axis=1)
        margin = np.where(crosses, -np.inf, np.minimum(margin[packing.i], margin[packing.j]))
        for k in np.flatnonzero(margin > best):
            best[k], out[k] = margin[k], found[int(packing.i[k]), int(packing.j[k])]
    return out


def lammps_curve(packing, program, strain, steps, records):
    """Extended along z: strain, stress, broken bonds."""
    every = steps // records
    text = lammps(packing, program, f"""run 0
fix pull all deform 1 z scale {1 + strain!r} remap x
thermo {every}
thermo_style custom step lz c_stress[3] c_left
thermo_modify format float %.12g norm no
run {steps}
""")
    table = text[text.rindex("c_left"):].splitlines()[1:]
    rows = [[float(word) for word in line.split()] for line in table[:records + 1] if re.match(r"\s*\d", line)]
    whole = 2 * len(packing.i)
    return [[row[1] / packing.edge - 1, -row[2], (whole - row[3]) / 2] for row in rows[1:]]
