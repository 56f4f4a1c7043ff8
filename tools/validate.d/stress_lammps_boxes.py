"""Cases of tests/extreme that deform a box of grains, put to LAMMPS; see stress_lammps.py."""
import math

import numpy

from stress_lammps import LIMIT, Answer, Failed, lmp, mass_of, motion, opening, write_data

STIFFNESS, YOUNG = 1e6, 1e9  # of the specimens: N/m, Pa


class Packing:
    """Touching grains of radius `length` in a shaken square or cubic lattice, in units of `length` and `force`.

    The unit of time stays, masses are those of force/length: what LAMMPS prints scales by the units alone.
    """

    def __init__(self, dimension, hertz, length=1.0, force=1.0, side=6, spacing=1.98):
        self.dimension, self.hertz, self.length, self.force = dimension, hertz, length, force
        axes = numpy.meshgrid(*[numpy.arange(side)] * dimension, indexing="ij")
        sites = numpy.stack(axes, -1).reshape(-1, dimension)
        shaken = (sites - 0.5 * side + 0.5) * spacing + numpy.random.default_rng(5).uniform(-5e-3, 5e-3, sites.shape)
        self.x = numpy.zeros((len(sites), 3))
        self.x[:, :dimension] = shaken * length
        high = 0.5 * side * spacing * length
        self.box = [(-high, high)] * dimension + [(-0.5 * length, 0.5 * length)] * (3 - dimension)
        self.mass = mass_of(dimension) * force / length
        # Stiffness of a contact that overlaps by 0.02; of Hertz contacts it grows with the root of the overlap.
        stiff = 2 * YOUNG / (2 * (1 - 0.2**2)) * math.sqrt(0.5 * 0.02) if hertz else STIFFNESS
        self.contact = math.pi * math.sqrt(0.5 * mass_of(dimension) / stiff)

    def deformed(self, folder, rates, n, steps, every, shown):
        """Rows of what LAMMPS shows every so many steps while sides grow at `rates`, 1/s."""
        write_data(folder, self.box, self.x, numpy.zeros_like(self.x), self.mass, self.length)
        if self.hertz:
            young = YOUNG * self.force / self.length**2
            law = ["pair_style granular", f"pair_coeff * * hertz/material {young!r} 0 0.2 tangential mindlin NULL "
                   "0 0.5 damping velocity"]
        else:
            kn = STIFFNESS * self.force / self.length
            law = [f"pair_style gran/hooke/history {kn!r} {0.5 * kn!r} 0 0 0.5 0", "pair_coeff * *"]
        sides = " ".join(f"{axis} erate {rate!r}" for axis, rate in zip("xyz", rates))
        text = lmp(opening(self.dimension, skin=0.5 * self.length) + law + motion(self.dimension, self.contact / n) +
                   [f"fix 3 all deform 1 {sides} remap v", "compute p all pressure NULL virial",
                    "compute d all pair/local dist", "compute m all reduce min c_d",
                    f"thermo_style custom step {shown}", "thermo_modify format float %.17g lost error",
                    f"thermo {every}", f"run {steps}"], folder)
        table = text.split("Step ")[-1].split("Loop time")[0].splitlines()[1:]
        return numpy.array([line.split()[1:] for line in table], float)


def stresses(packing, folder, n, strain):
    """Stresses at 20 states while x grows by 3/5 and y shrinks by the strain."""
    steps = 20 * n
    rates = [0.6 * strain / (20 * packing.contact), -strain / (20 * packing.contact), 0.0][:packing.dimension]
    area = packing.length if packing.dimension == 2 else packing.length**2
    return packing.deformed(folder, rates, n, steps, n, "c_p[1] c_p[2] c_p[3] c_p[4]") / (packing.force / area)


def units(case, n, folder):
    dimension, hertz = int(case("dimension")), bool(case("hertz"))
    one = stresses(Packing(dimension, hertz), folder, n, 1e-2)
    scaled = Packing(dimension, hertz, 2.0 ** case("length_power"), 2.0 ** case("force_power"))
    other = stresses(scaled, folder, n, 1e-2)
    difference = abs(one - other).max() / abs(one).max()
    return Answer(0.0) if difference == 0 else Answer(says=f"differs by {difference:.1g}")


def lengths(case, n, folder):
    dimension, hertz, length = int(case("dimension")), bool(case("hertz")), case("radius")
    one = stresses(Packing(dimension, hertz), folder, n, 2e-4)
    other = stresses(Packing(dimension, hertz, length, length**2), folder, n, 2e-4)
    return Answer(abs(one - other).max() / abs(one[0, :dimension]).mean() / case.tolerance)


def compressed(case, n, folder):
    """To half its sides in a hundred contact times."""
    packing = Packing(int(case("dimension")), bool(case("hertz")))
    rates = [-0.5 / (100 * packing.contact)] * packing.dimension
    rows = packing.deformed(folder, rates, n, 100 * n, n, "c_m")
    over = 2 - rows[:, 0].min()
    return Answer(says=f"goes on, overlap {over:.2g} r") if over > LIMIT else Answer(0.0)


def one_increment(case, n, folder):
    return compressed(case, n, folder) if case("compression") > 0 else None


def crystal(case, n, folder):
    side, spacing, strain = int(case("side")), 1.99, (1e-4, 0.0, -1e-3)
    a = [spacing * (1 + e) for e in strain]
    text = lmp(["units si", "atom_style sphere", "boundary p p p", "newton off", "comm_modify vel yes",
                "neighbor 0.1 bin", f"lattice custom 1 a1 {a[0]!r} 0 0 a2 0 {a[1]!r} 0 a3 0 0 {a[2]!r} basis 0 0 0",
                f"region 1 block 0 {side} 0 {side} 0 {side}", "create_box 1 1", "create_atoms 1 box",
                "set type 1 diameter 2 density 2650", f"pair_style gran/hooke {STIFFNESS!r} 0 0 0 0 0",
                "pair_coeff * *", "fix 1 all nve/sphere", "timestep 1e-6", "compute p all pressure NULL virial",
                "thermo_style custom step c_p[1] c_p[2] c_p[3]", "thermo_modify format float %.17g", "run 0"], folder)
    got = numpy.array(text.split("Step ")[-1].splitlines()[1].split()[1:], float)
    expected = numpy.array([STIFFNESS * (2 - b) * b / math.prod(a) for b in a])
    return Answer(abs(got - expected).max() / expected.max() / case.tolerance)


def no_increment(case, n, folder):
    """LAMMPS ends where it refuses. What it lets pass is then run for ten steps."""
    dimension = int(case("dimension"))
    packing = Packing(dimension, dimension == 3)
    contact = packing.contact
    asked = {0: ["change_box all x scale nan remap"], 1: ["change_box all x scale inf remap"],
             2: ["change_box all x scale -inf remap"], 3: ["change_box all x scale 0 remap"],
             4: ["change_box all x scale -0.5 remap"], 5: ["change_box all x scale 1e300 y scale 1e300 remap"],
             6: ["timestep nan", "timestep inf", f"timestep {-1e-3 * contact:.0e}"],
             7: ["change_box all z scale nan remap"], 8: ["fix 3 all press/berendsen x nan nan 1"],
             9: ["velocity all set nan 0 0"]}
    law = ["pair_style gran/hooke 1e6 0 0 0 0 0", "pair_coeff * *"]
    says = "refused"
    for line in asked[int(case("kind"))]:
        write_data(folder, packing.box, packing.x, numpy.zeros_like(packing.x), packing.mass, 1.0)
        try:
            lmp(opening(dimension) + law + motion(dimension, contact / n) + [line, "run 10"], folder)
        except Failed as failed:
            if "Lost atoms" in str(failed):
                return Answer(says="loses grains with " + line)
            says = "refused: " + str(failed).partition(": ")[2].removesuffix(" in input script or data file")
            continue
        return Answer(says="goes on with " + line)
    return Answer(says=says)
