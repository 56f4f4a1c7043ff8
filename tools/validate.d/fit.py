"""Hidden parameters of real tests: fit.py PROGRAM WORK RESULTS [SETS]

For each set friction and rolling friction are drawn. Ten specimens of 150 discs are tested with them (biaxial, 20 kPa, to 4 %),
and the means of friction angle and dilation angle with their standard errors are the targets; the errors are widened by
Student's t of nine degrees of freedom over that of the normal distribution. `rvelab fit` gets these and ten other specimens. Each
set has specimens of its own, so that sets are independent. Prints truth and 95 % interval of both parameters, and how many sets have both truths within.
"""

import json
import random

import harness
from harness import answer, rvelab, sets, work

KEYS = {"material.friction": (0.15, 0.8), "material.rolling_friction": (0.0, 0.2)}
TARGETS = ("friction_angle_deg", "dilation_angle_deg")
TEST = sets("stage.compression.to_strain=0.04", "test.pressure_Pa=20e3")


def measured(specimens, truth):
    """Mean and standard error of the targets with the hidden parameters."""
    summary = answer("run", "biaxial", "--specimen", *specimens, *TEST,
                     *sets(*(f"{key}={value}" for key, value in truth.items())))["summary"]
    rows = {row["measure"]: row for row in summary}
    return {name: (rows[name]["mean"], 2.262 / 1.96 * rows[name]["standard_error"]) for name in TARGETS}


def main():
    count = int(harness.words[0]) if harness.words else 20
    draw = random.Random(7)
    print("10 specimens of 150 discs in the data, 10 others in the fit; two targets, two unknowns, 56 tests a set")
    print("set  friction: truth, 95 % interval  rolling friction: truth, 95 % interval  both within")
    inside = 0
    for number in range(1, count + 1):
        rvelab("pack", "pack_dense", "-o", work / "S.h5", "--count", 20, "--force",
               *sets("pack.number=150", "target.void_ratio_tolerance=0.01", f"pack.seed={100 * number}"))
        specimens = [work / f"S_{k:02d}.h5" for k in range(1, 21)]
        truth = {key: round(low + (0.1 + 0.8 * draw.random()) * (high - low), 4) for key, (low, high) in KEYS.items()}
        targets = measured(specimens[:10], truth)
        words = [word for name, (mean, error) in targets.items() for word in ("--target", f"{name}={mean}+-{error}")]
        words += [word for key, (low, high) in KEYS.items() for word in ("--vary", f"{key}={low}:{high}")]
        out = work / f"set_{number:02d}"
        rvelab("fit", "biaxial", "--specimen", *specimens[10:], *words, *TEST, "-o", out, "--force")
        found = json.loads((out / "fit.json").read_text())["parameters"]
        within = [each["low_95"] <= truth[each["key"]] <= each["high_95"] for each in found]
        inside += all(within)
        cells = "  ".join(f"{truth[each['key']]:.3f}, {each['low_95']:.3f} to {each['high_95']:.3f}" for each in found)
        print(f"{number:3d}  {cells}  {'yes' if all(within) else 'no'}", flush=True)
    print(f"both truths within their 95 % intervals: {inside} of {count} sets")


if __name__ == "__main__":
    harness.main(main)
