"""tools/validate ottawa: a cyclic undrained triaxial test on Ottawa F65 sand, predicted from its limits of density, critical angle and G0.

    ottawa.py RVELAB WORK RESULTS

Measured by El Ghoraiby, Park and Manzari (2020), e = 0.507, 100 kPa, q amplitude over twice the pressure 0.325: 18 cycles to r_u = 1,
41 to 2.5 % of axial strain. Eight specimens of 500 grains by the recipe ottawa_f65; prediction: the median over specimens and the range of
the middle six. Friction at the lower end of its interval, four specimens, tells what the critical angle leaves open. Tests end after 60 cycles; r_u of each specimen by then is told."""

import json

import numpy as np

import harness
from harness import bars, once, rvelab, sets, specimens, verdict, work

AMPLITUDE = 2 * 0.325 * 100e3  # Pa
MEASURED = {"cycles to r_u = 0.95 (measured: 1)": ("cycles_to_r_u_0.95", 18), "cycles to 2.5 %": ("cycles_to_2.5_percent", 41)}
CYCLES = 60
FRICTIONS = {"": 8, "0.22": 4}  # number of specimens
CONTRACTION = "spheres this dense contract less at small strains than the sand, so that pore pressure builds up over more cycles"


@bars
def predicted(what, measured, cycles):
    """Median and middle six of eight, or of all but the first and last; a specimen without the event has no number."""
    cycles = np.sort([np.inf if each is None else each for each in cycles])
    median, low, high = (f"{each:.1f}" if np.isfinite(each) else f"> {CYCLES}" for each in (np.median(cycles), cycles[1], cycles[-2]))
    verdict(f"{what}, measured {measured}", f"{median} ({low} to {high})", "in the range",
            bool(cycles[1] <= measured <= cycles[-2] and np.isfinite(cycles[-2])), width=56, reason=CONTRACTION)


def largest_r_u(path):
    """r_u as the measures have it: 1 - the mean lateral stress over that of the start."""
    sigma = harness.records(path, "stress_Pa", last=True)["stress_Pa"]
    lateral = sigma[:, 0, 0] + sigma[:, 1, 1]
    return 1 - (lateral / lateral[0]).min()


def made(friction, count):
    """Measures of each specimen, their G0, MPa, and the largest r_u of their tests."""
    settings = [f"material.friction={friction}"] if friction else []
    files = specimens("ottawa_f65", f"O{friction}", count, *settings)
    folder = once(work / f"R{friction}", "run", "triaxial_cyclic", "--specimen", *files, resume=True,
                  *sets(f"stage.cycles.reverse_at_Pa={AMPLITUDE}", f"stage.cycles.cycles={CYCLES}"), codes=None)
    stiffness = [np.array(json.loads(rvelab("probe", file, "--json"))["stiffness_Pa"]) for file in files]
    return (json.loads((folder / "summary.json").read_text())["tests"], [np.trace(C[3:, 3:]) / 3e6 for C in stiffness],
            [largest_r_u(folder / f"R_{file.name}") for file in files])


def main():
    for friction, count in FRICTIONS.items():
        tests, moduli, pressures = made(friction, count)
        print(f"friction {friction or 'of the recipe'}: G0 {harness.in_words(moduli, digits=0)} MPa; largest r_u of each specimen "
              + ", ".join(f"{each:.2f}" for each in pressures))
        for what, (key, value) in MEASURED.items():
            cycles = [test.get(key) for test in tests]
            if friction:
                print(f"{what:<40} of each: {', '.join('none' if each is None else f'{each:.1f}' for each in cycles)}")
            else:
                predicted(what, value, cycles)


if __name__ == "__main__":
    harness.main(main)
