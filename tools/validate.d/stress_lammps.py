"""Cases of tests/extreme put to LAMMPS, with the masses, stiffnesses and dashpots that they have there.

An experiment is a function (case, n, folder) -> Answer; n is how many steps a collision lasts. Errors are those of the
case's invariant over what it allows. Needs lammps and python3-numpy (Debian).
"""
import math
import os
import subprocess
from dataclasses import dataclass

import numpy

DENSITY, THICKNESS, LIMIT = 2650.0, 0.5, 0.25  # of the specimens: kg/m^3, m in 2D, largest overlap over r
HERTZ_TIME = 2.943275  # duration of an elastic Hertz impact over overlap/speed


@dataclass
class Answer:
    error: float = math.nan  # measured over allowed, at most 1 is right
    says: str = ""           # what happened instead of an answer
    spread: float = 0.0      # statistical error of the error

    def text(self):
        if self.says:
            return self.says if self.says.startswith("refused") else "WRONG " + self.says
        spread = f" +- {self.spread:.2g}" if self.spread else ""
        return f"{'right' if self.error <= 1 else 'WRONG'} {self.error:.3g}{spread}"


class Failed(Exception):
    """LAMMPS ended with an error; the text is its own."""


def lmp(lines, folder):
    """What LAMMPS prints."""
    with open(os.path.join(folder, "in"), "w") as out:
        out.write("\n".join(lines) + "\n")
    done = subprocess.run(["lmp", "-in", "in", "-log", "none"], cwd=folder, capture_output=True, text=True,
                          env=dict(os.environ, OMP_NUM_THREADS="1"))
    if done.returncode:
        errors = [line for line in (done.stdout + done.stderr).splitlines() if "ERROR" in line]
        raise Failed(errors[0].split(" (")[0].strip() if errors else f"ended with {done.returncode}")
    return done.stdout


def mass_of(dimension):
    return DENSITY * (math.pi * THICKNESS if dimension == 2 else 4 / 3 * math.pi)


def has_damping(damping, folder):
    """Whether this version of LAMMPS knows that damping of Hertz contacts."""
    write_data(folder, [(-9.0, 9.0)] * 3, numpy.zeros((1, 3)), numpy.zeros((1, 3)), 1.0, 1.0)
    try:
        lmp(opening(3) + pair_of(True, 1.0, 1.0, 0.5, damping) + motion(3, 1e-3) + ["run 0"], folder)
    except Failed:
        return False
    return True


def impact(hertz, constant, half_mass, speed):
    """Largest overlap and duration of an elastic impact, f_n = constant overlap^(1 or 1.5)."""
    if not hertz:
        return speed * math.sqrt(half_mass / constant), math.pi * math.sqrt(half_mass / constant)
    overlap = (1.25 * half_mass * speed**2 / constant) ** 0.4
    return overlap, HERTZ_TIME * overlap / speed


def constant_for(hertz, overlap, half_mass, speed):
    return 1.25 * half_mass * speed**2 / overlap**2.5 if hertz else half_mass * (speed / overlap) ** 2


def pair_of(hertz, constant, half_mass, e=1.0, damping="tsuji"):
    """Lines of the contact law. Linear: the exact dashpot of e; Hertz: LAMMPS' own of that name."""
    if hertz:  # f_n = kn sqrt(r* overlap) overlap, r* = 1/2
        e, damping = (e, damping) if e < 1 else (0, "velocity")
        return ["pair_style granular", f"pair_coeff * * hertz {constant / math.sqrt(0.5)!r} {e!r} tangential "
                f"linear_nohistory 0 0 damping {damping}"]
    log = -math.log(e)
    gamma = 2 * math.sqrt(constant / half_mass) * log / math.hypot(math.pi, log)
    return [f"pair_style gran/hooke {constant!r} 0 {gamma!r} 0 0 0", "pair_coeff * *"]


def opening(dimension, boundary="p p p", skin=0.5):
    """Lines before the contact law. Grains stand in the file `data`."""
    return ["units si", f"dimension {dimension}", "atom_style sphere", f"boundary {boundary}", "newton off",
            "comm_modify vel yes", f"neighbor {skin!r} bin", "neigh_modify delay 0 every 1 check yes", "read_data data"]


def motion(dimension, step):
    return ["fix 1 all nve/sphere" + (" disc" if dimension == 2 else ""), f"timestep {step!r}", "thermo 1000000000",
            *(["fix 2 all enforce2d"] if dimension == 2 else [])]


def write_data(folder, box, x, v, mass, radius):
    with open(os.path.join(folder, "data"), "w") as out:
        out.write(f"grains\n\n{len(x)} atoms\n1 atom types\n\n")
        for axis, (low, high) in zip("xyz", box):
            out.write(f"{low!r} {high!r} {axis}lo {axis}hi\n")
        density = mass / (4 / 3 * math.pi * radius**3)  # LAMMPS reads the mass of a sphere in 2D too
        out.write("\nAtoms # sphere\n\n")
        for k, (a, b, c) in enumerate(x.tolist()):
            out.write(f"{k + 1} 1 {2 * radius!r} {density!r} {a!r} {b!r} {c!r}\n")
        out.write("\nVelocities\n\n")
        for k, (a, b, c) in enumerate(v.tolist()):
            out.write(f"{k + 1} {a!r} {b!r} {c!r} 0 0 0\n")


def moved(folder, dimension, box, x, v, mass, law, step, steps, every, boundary="p p p", mixing=()):
    """Positions and velocities of free grains of radius 1 every so many steps: arrays (frames, grains, 3)."""
    write_data(folder, box, x, v, mass, 1.0)
    lmp(opening(dimension, boundary) + law + motion(dimension, step) + list(mixing) +
        [f"dump 1 all custom {every} dump x y z vx vy vz", "dump_modify 1 sort id format float %.17g", f"run {steps}"],
        folder)
    with open(os.path.join(folder, "dump")) as file:
        texts = file.read().split("ITEM: ATOMS x y z vx vy vz")[1:]
    frames = [numpy.array(text.split("ITEM:")[0].split(), float).reshape(-1, 6) for text in texts]
    if any(len(frame) != len(x) for frame in frames):
        raise Failed("grains lost")
    frames = numpy.array(frames)
    return frames[..., :3], frames[..., 3:]


def side_by_side(gaps, speed):
    """Two grains for each gap, each couple on a line of its own, 4 apart."""
    y = 4.0 * numpy.arange(len(gaps))
    x = numpy.zeros((2 * len(gaps), 3))
    x[0::2, 0], x[1::2, 0] = -1 - 0.5 * numpy.array(gaps), 1 + 0.5 * numpy.array(gaps)
    x[0::2, 1] = x[1::2, 1] = y
    v = numpy.zeros_like(x)
    v[0::2, 0], v[1::2, 0] = speed, -speed
    return x, v, [(-20.0, 20.0), (-2.0, y[-1] + 10.0), (-0.5, 0.5)]


def phases_of(case, n):
    """As asked, and a little more each, so that the contact begins anywhere within a step of n-ths of it too."""
    return [k / case("phases") * (1 + 1 / n) for k in range(int(case("phases")))]


def bounds(dimension, box):
    return (box, "f f p") if dimension == 2 else (box[:2] + [(-5.0, 5.0)], "f f f")


def rebound(case, n, folder, e=1.0):
    dimension, hertz, speed = int(case("dimension")), bool(case("hertz")), case("speed")
    half = 0.5 * mass_of(dimension)
    # Young's modulus 6e11 Pa, Poisson's ratio 0.2; or 1e11 N/m
    constant = 4 / 3 * 6e11 / (2 * (1 - 0.2**2)) * math.sqrt(0.5) if hertz else 1e11
    _, duration = impact(hertz, constant, half, 2 * speed)
    x, v, box = side_by_side([2 * speed * duration * (8 + phase) for phase in phases_of(case, n)], speed)
    box, boundary = bounds(dimension, box)
    law = pair_of(hertz, constant, half, e, case.damping)
    x, v = moved(folder, dimension, box, x, v, 2 * half, law, duration / n, 40 * n, 40 * n, boundary)
    got = (v[-1, 1::2, 0] - v[-1, 0::2, 0]) / (2 * speed)
    apart = x[-1, 1::2, 0] - x[-1, 0::2, 0] > 2
    momentum = abs(v[-1, 0::2] + v[-1, 1::2]).max() / speed
    return Answer(max(abs(numpy.where(apart, got, 1e9) / e - 1).max() / case.tolerance, momentum / 1e-10))


def restitution(case, n, folder):
    return rebound(case, n, folder, case("restitution"))


def third_contact(case, n, folder):
    hertz, e, speed = bool(case("hertz")), case("restitution"), 0.5
    half = 0.5 * mass_of(3)
    constant = constant_for(hertz, 0.02, half, 2 * speed)
    overlap, duration = impact(hertz, constant, half, 2 * speed)
    gaps = [2 * speed * duration * (0.3 + 0.7 * phase) for phase in phases_of(case, n)]
    # The couples beside them touch at a quarter of the depth. They share a step, which is all that matters here.
    x, v, box = side_by_side(gaps + [-0.25 * overlap] * len(gaps), speed)
    v[2 * len(gaps):] = 0
    box, boundary = bounds(3, box)
    steps = math.ceil(n * (max(gaps) / (2 * speed * duration) + 10))
    law = pair_of(hertz, constant, half, e, case.damping)
    x, v = moved(folder, 3, box, x, v, 2 * half, law, duration / n, steps, steps, boundary)
    got = (v[-1, 1::2, 0] - v[-1, 0::2, 0])[:len(gaps)] / (2 * speed)
    return Answer(abs(got / e - 1).max() / case.tolerance)


def too_hard(case, n, folder):
    if case("dimension") == 2:
        return None
    hertz, speed, half = bool(case("hertz")), 1.0, 0.5 * mass_of(3)
    constant = constant_for(hertz, case("overlap_over_limit") * LIMIT, half, 2 * speed)
    _, duration = impact(hertz, constant, half, 2 * speed)
    x, v, box = side_by_side([0.5 + 0.02 * k for k in range(20)], speed)
    box, boundary = bounds(3, box)
    step = duration / n
    x, v = moved(folder, 3, box, x, v, 2 * half, pair_of(hertz, constant, half), step, math.ceil(4 / step), 1, boundary)
    apart = x[:, 1::2, 0] - x[:, 0::2, 0]
    through = ", they change places" if (apart[-1] < 0).any() else ""
    return Answer(says=f"goes on, overlap {2 - apart.min():.2g} r{through}")


# ---- Gases of grains of radius 1 and temperature 1

class Gas:
    def __init__(self, dimension, grains, fraction, hertz, contact_time):
        self.dimension, self.grains, self.hertz = dimension, grains, hertz
        self.volume = grains * (math.pi if dimension == 2 else 4 / 3 * math.pi) / fraction
        self.side, density = self.volume ** (1 / dimension), grains / self.volume
        free = 1 - fraction
        chi = (1 - 7 * fraction / 16) / free**2 if dimension == 2 else (1 - fraction / 2) / free**3
        self.rate = 2 * (dimension - 1) * density * 2 ** (dimension - 1) * chi * math.sqrt(math.pi)  # Enskog
        self.contact, self.half = contact_time / self.rate, 0.5 * mass_of(dimension)
        overlap = self.contact * 2 / (HERTZ_TIME if hertz else math.pi)  # at a typical speed of approach, 2
        self.constant = constant_for(hertz, overlap, self.half, 2.0)
        high = 0.5 * self.side
        self.box = [(-high, high)] * dimension + [(-0.5, 0.5)] * (3 - dimension)

    def start(self, seed):
        random, centres = numpy.random.default_rng(seed), []
        while len(centres) < self.grains:
            x = numpy.append(random.uniform(-0.5, 0.5, self.dimension) * self.side, [0.0] * (3 - self.dimension))
            if not centres or numpy.linalg.norm(self.nearest(x - numpy.array(centres)), axis=1).min() > 2:
                centres.append(x)
        v = numpy.zeros((self.grains, 3))
        v[:, :self.dimension] = random.standard_normal((self.grains, self.dimension))
        v -= v.mean(axis=0)
        return numpy.array(centres), v * math.sqrt(self.dimension * self.grains / (v**2).sum())

    def nearest(self, b):
        return b - self.side * numpy.round(b / self.side)

    def energy(self, x, v):
        """LAMMPS keeps no elastic energy of granular contacts: from the positions."""
        i, j = numpy.triu_indices(self.grains, 1)
        overlap = numpy.maximum(0, 2 - numpy.linalg.norm(self.nearest(x[i] - x[j]), axis=1))
        elastic = 0.4 * self.constant * overlap**2.5 if self.hertz else 0.5 * self.constant * overlap**2
        return self.half * (v**2).sum() + elastic.sum()

    def law(self, e=1.0, damping="tsuji"):
        return pair_of(self.hertz, self.constant, self.half, e, damping)


def gas_energy(case, n, folder):
    dimension = int(case("dimension"))
    gas = Gas(dimension, int(case("grains")), 0.4 if dimension == 2 else 0.25, bool(case("hertz")), 0.02)
    steps = math.ceil(case("collisions") / gas.rate / gas.contact * n / 20) * 20
    x, v = moved(folder, dimension, gas.box, *gas.start(7), 2 * gas.half, gas.law(), gas.contact / n, steps,
                 steps // 20)
    energy = numpy.array([gas.energy(*frame) for frame in zip(x, v)])
    momentum = numpy.linalg.norm(v[-1].sum(axis=0)) / numpy.linalg.norm(v[-1], axis=1).sum()
    return Answer(max(abs(energy / energy[0] - 1).max() / case.tolerance, momentum / 1e-10))


def gas_cools(case, n, folder):
    dimension, e, looks = int(case("dimension")), case("restitution"), 14
    gas = Gas(dimension, int(case("grains")), case("solid_fraction"), bool(case("hertz")), case("contact_time"))
    a2 = 16 * (1 - e) * (1 - 2 * e * e) / ((57 - 25 * e if dimension == 2 else 81 - 17 * e) + 30 * e * e * (1 - e))
    tau = 2 * dimension / ((1 - e * e) * gas.rate) / (1 + 3 * a2 / 16)
    step, rates = gas.contact / n, []
    every = math.ceil(case("duration") * tau / looks / step)
    mixing = [f"run {math.ceil(8 / gas.rate / step)}", "reset_timestep 0", *gas.law(e, case.damping)]
    for seed in range(7, 7 + int(case("gases"))):
        _, v = moved(folder, dimension, gas.box, *gas.start(seed), 2 * gas.half, gas.law(), step, looks * every, every,
                     mixing=mixing)
        temperature = (v**2).sum(axis=(1, 2))
        y = numpy.sqrt(temperature[0] / temperature[-looks:]) - 1
        # Mixed, a gas has the kinetic energy that its contacts leave: tau is that of its own first temperature.
        own = tau / math.sqrt(temperature[0] / (dimension * gas.grains))
        t = numpy.arange(1, looks + 1) * every * step / own
        rates.append((t * y).sum() / (t * t).sum())
    spread = numpy.std(rates, ddof=1) / math.sqrt(len(rates)) if len(rates) > 1 else 0.03
    return Answer(abs(numpy.mean(rates) - 1) / case.tolerance, spread=spread / case.tolerance)
