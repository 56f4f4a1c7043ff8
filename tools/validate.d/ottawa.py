"""tools/validate ottawa: a cyclic undrained triaxial test on Ottawa F65 sand, predicted from its limits of density, critical angle and G0.

    ottawa.py RVELAB WORK RESULTS

Measured by El Ghoraiby, Park and Manzari (2020), e = 0.507, 100 kPa, q amplitude over twice the pressure 0.325: 18 cycles to r_u = 1,
41 to 2.5 % of axial strain. Eight specimens of 500 grains by the recipe ottawa_f65; prediction: the median over specimens and the range of
the middle six. Friction at the lower end of its interval, four specimens, tells what the critical angle leaves open. Tests end after 60 cycles."""

import json

import numpy as np

import harness
from harness import once, rvelab, sets, specimens, verdict, work

AMPLITUDE = 2 * 0.325 * 100e3  # Pa
MEASURED = {"cycles to r_u = 0.95 (measured: 1)": ("cycles_to_r_u_0.95", 18), "cycles to 2.5 %": ("cycles_to_2.5_percent", 41)}
FRICTIONS = {"": 8, "0.22": 4}  # number of specimens


def made(friction, count):
    """Measures of each specimen, and their G0, MPa."""
    settings = [f"material.friction={friction}"] if friction else []
    files = specimens("ottawa_f65", f"O{friction}", count, *settings)
    folder = once(work / f"R{friction}", "run", "triaxial_cyclic", "--specimen", *files, resume=True,
                  *sets(f"stage.cycles.reverse_at_Pa={AMPLITUDE}", "stage.cycles.cycles=60"), codes=None)
    stiffness = [np.array(json.loads(rvelab("probe", file, "--json"))["stiffness_Pa"]) for file in files]
    return json.loads((folder / "summary.json").read_text())["tests"], [np.trace(C[3:, 3:]) / 3e6 for C in stiffness]


def main():
    for friction, count in FRICTIONS.items():
        tests, moduli = made(friction, count)
        print(f"friction {friction or 'of the recipe'}: G0 {harness.in_words(moduli, digits=0)} MPa")
        for what, (key, value) in MEASURED.items():
            cycles = np.sort([test.get(key, np.inf) or np.inf for test in tests])  # inf: not within 60
            text = f"{np.median(cycles):6.1f} ({cycles[1]:.1f} to {cycles[-2]:.1f})"
            if friction:
                print(f"{what:<40} {text}")
            else:
                verdict(f"{what}, measured {value}", text, "in the range",
                        cycles[1] <= value <= cycles[-2] and np.isfinite(cycles[-2]), width=40)


if __name__ == "__main__":
    harness.main(main)
