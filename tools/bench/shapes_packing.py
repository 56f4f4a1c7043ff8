"""Packings of clumps and of other grains for tools/bench/shapes, and what rvelab, LAMMPS and YADE make of them.

The tangential forces of a packing are set to zero, so that no program needs a history of contacts; what they bore sets the
bodies in motion, undamped, in a cell at rest, at one time step. What is the same in the three:

    rvelab                      LAMMPS                                 YADE
    linear_stiffness            gran/hooke/history                     Law2_ScGeom_FrictPhys_CundallStrack
    hertz_mindlin               gran/hertz/history; granular           Law2_ScGeom_MindlinPhys_Mindlin
    clump                       fix rigid/small, `infile`              appendClumped, mass and inertia given
    contacts between bodies     neigh_modify exclude molecule/intra    the same

What is not: LAMMPS' arms reach to the surfaces, those of rvelab and YADE to the middle of the overlap. YADE's Hertz-Mindlin
is rvelab's with unload_rescale = false. gran/hertz/history, the fastest that LAMMPS has, multiplies the whole slip by the
stiffness of the moment; `granular` with mindlin_rescale/force adds up increments and rescales, as rvelab does.
"""
import pathlib
import re
import sys
import time

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "validate.d"))
import interactions_packing as packings  # noqa: E402

DENSITY, FRICTION, KN, KT, YOUNG, POISSON = 2650, 0.5, 1e6, 0.8e6, 7e9, 0.25
LAWS = {"linear_stiffness": f"normal_stiffness_N_m = {KN}\ntangential_stiffness_N_m = {KT}",
        "hertz_mindlin": f"young_modulus_Pa = {YOUNG}\npoisson_ratio = {POISSON}"}
RECIPE = """[pack]
name = "shapes"
{shape}
number = {grains}
seed = 1
[[grains]]
name = "grains"
{of}
grading = "uniform"
smallest_radius_m = 0.8e-3
largest_radius_m = 1.2e-3
[preparation]
friction = 0.1
[target]
pressure_Pa = 100e3
unbalanced = 1e-4
[contact]
law = "{law}"
[[material]]
name = "grains"
density_kg_m3 = {density}
friction = {friction}
{stiffness}
"""
LAMMPS = """units si
atom_style sphere
atom_modify map array
boundary p p p
newton off
comm_modify vel yes
fix body all property/atom mol ghost yes
read_data shapes.data fix body NULL Molecules
pair_style {pair}
pair_coeff * * {coefficients}
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes exclude molecule/intra all
timestep {time_step}
fix move all rigid/small molecule infile shapes.bodies
thermo_style custom step
thermo 1000000000
dump out all custom 1000000000 shapes.first id fx fy fz tqx tqy tqz
dump_modify out sort id format float %.17g
run 0
undump out
run {steps}
write_dump all custom shapes.last id xu yu zu modify sort id format float %.17g
"""


class Packing:
    """Bodies of rvelab at rest, without tangential forces; `rve()` is another one of them."""

    def __init__(self, program, folder, law, shape, of="", grains=1000):
        self.law, self.folder = law, folder
        stem = folder / re.sub(r"\W+", "_", f"{law} {shape} {of}")
        stem.with_suffix(".toml").write_text(RECIPE.format(shape=shape, of=of, grains=grains, law=law, density=DENSITY,
                                                           friction=FRICTION, stiffness=LAWS[law]))
        packings.run([program, "pack", stem.with_suffix(".toml"), "-o", f"{stem}.h5", "--force"])
        with h5py.File(f"{stem}.h5", "r+") as file:
            file["contacts/tangential_force_N"][...] = 0
            for name in ("velocity", "spin"):
                file[f"bodies/{name}" if "bodies" in file else f"grains/{name}"][...] = 0
            self.offset = file["members/offset_m"][:] if "members" in file else None
            self.radius = file["grains/radius_m"][:]
            self.compiler = file["provenance/compiler"][()].decode()
            self.first = np.append(file["bodies/first"][:], len(self.radius)) if "bodies" in file else None
        packings.run([program, "seal", f"{stem}.h5", "-o", f"{stem}.rest.h5", "--force"])
        rve = packings.rvelab.Rve(f"{stem}.rest.h5")
        self.start, self.lattice = rve.snapshot(), rve.rotation @ rve.lattice
        self.mass, self.centre = rve.array("grains/mass_kg"), rve.array("grains/position_m")
        self.contacts = len(rve.array("contacts/i"))
        self.time_step = 0.1 * float(np.sqrt(self.mass.min() / rve.array("contacts/normal_stiffness_N_m").max()))
        if self.offset is not None:
            axes = rve.array("grains/axes")
            self.inertia = rve.array("grains/inertia_tensor_kg_m2")
            self.owner = np.repeat(np.arange(len(self.mass)), np.diff(self.first))
            self.members = self.centre[self.owner] + np.einsum("nab,nb->na", axes[self.owner], self.offset)
            self.forces = np.hstack([rve.array("grains/resultant_N"), rve.array("grains/torque_N_m")])

    def rve(self, **settings):
        rve = packings.rvelab.Rve(self.start)
        rve.set_parameters({"damping.local": 0, "solver.fixed_time_step_s": self.time_step, "solver.collision_steps": 0,
                            **settings})
        return rve

    def moved(self, steps, unload_rescale):
        """Displacements of the bodies after so many steps."""
        rve = self.rve(**{"contact.unload_rescale": unload_rescale})
        rve.apply(np.zeros((3, 3)), steps * self.time_step)
        return rve.array("grains/position_m") - self.centre

    def of_rvelab(self, seconds=0.5):
        """Processor time of a step, over about so many seconds."""
        rve, steps, took = self.rve(), 10, 0
        while took < 0.5 * seconds:
            steps = 10 if not took else int(max(2 * steps, seconds / took * steps))
            made, begin = rve.grain_steps, time.process_time()
            rve.apply(np.zeros((3, 3)), steps * self.time_step)
            took = time.process_time() - begin
        return took * len(self.radius) / (rve.grain_steps - made)  # members are grains there

    def of_yade(self, steps):
        """Forces and torques on the bodies before the first step, displacements after the last; processor time of all."""
        split = self.first[1:-1]
        law = {"kn": KN, "kt": KT} if self.law == "linear_stiffness" else {"young": YOUNG, "poisson": POISSON}
        return packings.in_yade(HERE / "shapes_yade.py", self.folder, {
            **law, "friction": FRICTION, "lattice": self.lattice.tolist(), "dt": self.time_step, "steps": steps,
            "mass": self.mass.tolist(), "inertia": self.inertia.tolist(),
            "x": [part.tolist() for part in np.split(self.members, split)],
            "r": [part.tolist() for part in np.split(self.radius, split)]})

    def of_lammps(self, program, steps, check=False):
        """The same. check: with the law that is rvelab's, not the fastest."""
        def parts(x):
            return np.floor(x @ np.linalg.inv(self.lattice).T)

        cell = parts(self.centre)
        centre = self.centre - cell @ self.lattice.T
        x = self.members - cell[self.owner] @ self.lattice.T
        image = parts(x)
        x -= image @ self.lattice.T
        L = self.lattice
        lines = ["clumps", "", f"{len(x)} atoms", "1 atom types", *(f"0 {L[k, k]!r} {c}lo {c}hi" for k, c in enumerate("xyz")),
                 f"{L[0, 1]!r} {L[0, 2]!r} {L[1, 2]!r} xy xz yz", "", "Atoms # sphere", ""]
        lines += [f"{k + 1} 1 {2 * r!r} {DENSITY} {p[0]!r} {p[1]!r} {p[2]!r} {i[0]:.0f} {i[1]:.0f} {i[2]:.0f}"
                  for k, (r, p, i) in enumerate(zip(self.radius.tolist(), x.tolist(), image))]
        lines += ["", "Molecules", ""] + [f"{k + 1} {body + 1}" for k, body in enumerate(self.owner)]
        (self.folder / "shapes.data").write_text("\n".join(lines) + "\n")
        # Its velocities are those of the whole step, the others' those half a step later.
        half = 0.5 * self.time_step * self.forces
        rows = [[*p, *(inertia[a, b] for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))), *(v[:3] / m), *v[3:]]
                for p, inertia, v, m in zip(centre, self.inertia, half, self.mass)]
        (self.folder / "shapes.bodies").write_text(f"{len(rows)}\n" + "".join(
            f"{k + 1} {float(m)!r} {' '.join(repr(float(v)) for v in row)} 0 0 0\n"
            for k, (m, row) in enumerate(zip(self.mass, rows))))
        pair, coefficients = f"gran/hooke/history {KN} {KT} 0 0 {FRICTION} 0", ""
        if self.law == "hertz_mindlin":
            shear = YOUNG / (2 * (1 + POISSON))
            pair = f"gran/hertz/history {2 / 3 * YOUNG / (1 - POISSON**2)!r} {4 * shear / (2 - POISSON)!r} 0 0 {FRICTION} 0"
            if check:
                pair, coefficients = "granular", (f"hertz/material {YOUNG} 0 {POISSON} tangential mindlin_rescale/force NULL 0 "
                                                  f"{FRICTION} damping velocity")
        (self.folder / "shapes.in").write_text(LAMMPS.format(
            pair=pair, coefficients=coefficients, steps=steps, time_step=self.time_step,
            skin=0.2 * float(self.radius.mean())))
        text = packings.run([program, "-in", "shapes.in", "-log", "none"], cwd=self.folder)
        loop, share = re.findall(r"Loop time of (\S+) on", text)[-1], re.findall(r"(\S+)% CPU use", text)[-1]
        first, last = (np.loadtxt((self.folder / f"shapes.{name}").read_text().split("ITEM: ATOMS")[-1].splitlines()[1:])[:, 1:]
                       for name in ("first", "last"))
        turning = first[:, 3:] + np.cross(self.members - self.centre[self.owner], first[:, :3])
        forces = np.add.reduceat(np.hstack([first[:, :3], turning]), self.first[:-1])
        mean = np.add.reduceat(last, self.first[:-1]) / np.diff(self.first)[:, None]
        return {"seconds": float(loop) * float(share) / 100, "forces": forces, "moved": mean - centre}
