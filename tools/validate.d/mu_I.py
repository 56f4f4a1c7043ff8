"""tools/validate mu_I: rheology of dense flow under a held normal stress, beside the same states at constant volume.

Discs of friction 0.4 and restitution 0.1 (da Cruz et al. 2005), 1000 of them, packed at kappa = kn/(p thickness) of
1e3, 1e4 and 1e6, and 500 spheres at kappa = kn/(p d) of the same sizes, frictionless at the first two, sheared at
inertial numbers from 1e-4 to 0.3, one specimen each. Asked: the mean of the held stress within 0.5 %, its scatter over
the records under 5 %, mu as at the same volume held constant within two standard errors, the rate as asked. And a
biaxial test at I = 1e-2 with four spacings of its records: the angle must not know the spacing.
"""

import argparse
import math

import numpy as np

import harness
from harness import once, records, work

RECIPE = """
[pack]
name = "grains of restitution 0.1"
shape = "{shape}"
number = {number}
seed = 1
{thickness}
[grains]
smallest_radius_m = 4e-3
largest_radius_m = 6e-3
[target]
pressure_Pa = 1e4
[preparation]
friction = {prepared}
[contact]
law = "linear_stiffness"
[damping]
dashpot = "restitution"
restitution = 0.1
[[material]]
name = "disc"
density_kg_m3 = 2650
normal_stiffness_N_m = {stiffness}
tangential_stiffness_N_m = {half}
friction = {friction}
"""
# Steady shear from the state as it is; no isotropic stage, so that a flow goes on where another ended.
SHEAR = """
[test]
name = "shear"
pressure_Pa = 1e4
[loading]
mode = "at_rate"
rate_1_s = {rate:.9g}
[solver]
max_overlap_ratio = 0.5
[[stage]]
name = "shear"
kind = "simple_shear"
plane = "{plane}"
to_strain = {strain}
record_every = 0.005
normal = "{normal}"
"""
BIAXIAL = """
[test]
name = "biaxial at a rate"
pressure_Pa = 1e4
[loading]
mode = "at_rate"
inertial_number = 1e-2
[[stage]]
kind = "compression"
to_strain = 0.1
record_every = {spacing}
"""
# Grains, kappa, inertial number, shear strain.
FLOWS = (("disc", 1e3, 0.3, 3), ("disc", 1e3, 0.1, 3), ("disc", 1e3, 0.01, 3), ("disc", 1e4, 0.3, 3),
         ("disc", 1e4, 0.1, 3), ("disc", 1e4, 0.01, 2), ("disc", 1e6, 0.3, 2), ("disc", 1e6, 0.1, 2),
         ("disc", 1e4, 0.001, 1), ("disc", 1e3, 1e-4, 0.4), ("sphere", 1e3, 0.3, 3), ("sphere", 1e4, 0.1, 3),
         ("sphere", 1e4, 0.01, 2), ("sphere", 1e4, 0.001, 1), ("sphere", 1e6, 0.3, 1))
SPACINGS = (1e-4, 5e-4, 2e-3, 5e-3)
PRESSURE, DIAMETER, DENSITY = 1e4, 0.01, 2650


def blocks(values, count=10):
    """Mean and standard error from blocks."""
    means = np.array([block.mean() for block in np.array_split(values, count)])
    return values.mean(), means.std(ddof=1) / math.sqrt(count)


def tested(name, protocol, specimen):
    """Records of a test."""
    path = work / f"{name}.toml"
    path.write_text(protocol)
    return once(work / f"{name}.h5", "run", path, "--specimen", specimen)


def flow(name, specimen, plane, inertial, strain, normal):
    """The state, and means over the last three fifths of a steady shear, in the plane "xy" or "xz"."""
    along, across = ("xyz".index(axis) for axis in plane)
    rate = inertial * math.sqrt(PRESSURE / DENSITY) / DIAMETER
    out = tested(name, SHEAR.format(plane=plane, rate=rate, strain=strain, normal=normal), specimen)
    rows = records(out, "strain", "stress_Pa", "inertial_number", "substeps", "target_held")
    late = rows["strain"] > 0.4 * rows["strain"][-1]
    stress = -rows["stress_Pa"][late]
    normal_stress, shear = stress[:, across, across], -stress[:, along, across]
    mu, error = blocks(shear / normal_stress.mean())
    return out, {"held": normal_stress.mean() / PRESSURE, "scatter": normal_stress.std() / normal_stress.mean(),
                 "mu": mu,
                 "error": error, "flagged": 1 - rows["target_held"].mean(), "substeps": rows["substeps"].sum()}


def angle(specimen, spacing):
    """Friction angle of a biaxial test, degrees: of the largest mean axial stress over 1 % of strain."""
    rows = records(tested(f"biaxial_{spacing:g}", BIAXIAL.format(spacing=spacing), specimen), "stress_Pa",
                   "inertial_number")
    stress, inertial = -rows["stress_Pa"], np.median(rows["inertial_number"][1:])
    width = max(1, round(0.01 / spacing))
    largest = np.convolve(stress[1:, 1, 1], np.ones(width) / width, "valid").max() / PRESSURE
    return math.degrees(math.asin((largest - 1) / (largest + 1))), stress[1:, 0, 0].mean() / PRESSURE, inertial


def packed(shape, kappa):
    """A specimen of 1000 discs of friction 0.4, or of 500 spheres: frictionless, but of friction 0.4 at kappa = 1e6,
    where frictionless ones do not come to rest within minutes."""
    disc = shape == "disc"
    rough = disc or kappa > 1e5
    stiffness = kappa * PRESSURE * (0.1 if disc else DIAMETER)
    recipe = work / f"{shape}_{kappa:g}.toml"
    recipe.write_text(RECIPE.format(shape=shape, number=1000 if disc else 500, stiffness=stiffness, half=stiffness / 2,
                                    thickness="thickness_m = 0.1" if disc else "", friction=0.4 if rough else 0,
                                    prepared=0.1 if rough else 0))
    return harness.packed(recipe, recipe.stem)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", help="flows of this shape alone, or none: biaxial tests alone")
    parser.add_argument("--flows", type=int, nargs="+", help="numbers of flows in the table, from 1: these alone")
    options = parser.parse_args(harness.words)
    if options.only != "none":
        print("shape   kappa  I      held mean  scatter  mu held            mu at constant volume  difference/error  "
              "flagged  sub-steps", flush=True)
    for number, (shape, kappa, inertial, strain) in enumerate(FLOWS, 1):
        if options.only not in (None, shape) or (options.flows and number not in options.flows):
            continue
        plane = "xy" if shape == "disc" else "xz"
        state, held = flow(f"held_{number}", packed(shape, kappa), plane, inertial, strain, "constant_stress")
        _, fixed = flow(f"fixed_{number}", state, plane, inertial, strain, "constant_volume")
        apart = abs(held["mu"] - fixed["mu"]) / math.hypot(held["error"], fixed["error"])
        print(f"{shape:<7} {kappa:<6g} {inertial:<6g} {held['held']:<10.4f} {held['scatter']:<8.4f} "
              f"{held['mu']:.4f} +- {held['error']:.4f}   {fixed['mu']:.4f} +- {fixed['error']:.4f}       "
              f"{apart:<17.2f} {held['flagged']:<8.2%} {held['substeps']:.3g}", flush=True)
    if options.flows or options.only not in (None, "none"):
        return
    print("biaxial test at I = 1e-2, kappa = 1e4: record spacing, friction angle (degrees), mean lateral stress over "
          "its target, inertial number reported")
    for spacing in SPACINGS:
        degrees, lateral, inertial = angle(packed("disc", 1e4), spacing)
        print(f"{spacing:<8g} {degrees:<8.2f} {lateral:<8.4f} {inertial:.5g}", flush=True)


if __name__ == "__main__":
    harness.main(main)
