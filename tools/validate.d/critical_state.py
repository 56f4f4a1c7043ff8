"""Critical state: critical_state.py RVELAB WORK RESULTS.

Ten dense and ten loose specimens of 1000 discs (preparation friction 0 and 0.9), sheared at constant normal stress of
10 kPa to gamma = 5; means of void ratio and q/p over gamma = 2 to 5. Bars: dense and loose differ by less than two
standard errors of the difference; each standard error at most 1 % of the mean.
"""
import numpy as np

import harness
from harness import in_turn, mean_error, once, packed, records, sets, work

SEEDS = range(1, 11)
RECIPE = """[pack]
name = "discs"
shape = "disc"
number = 1000
[grains]
smallest_radius_m = 3e-3
largest_radius_m = 7e-3
[target]
pressure_Pa = 10e3
[preparation]
friction = 0.0
[contact]
law = "linear"
[[material]]
name = "grain"
young_modulus_Pa = 80e6
stiffness_ratio = 0.5
friction = 0.5
"""


def test(kind, seed):
    specimen = packed(work / "discs.toml", f"{kind}_{seed}", f"pack.seed={seed}",
                      f"preparation.friction={dict(dense=0.0, loose=0.9)[kind]}")
    return means(once(work / f"R_{kind}_{seed}.h5", "run", "simple_shear_drained", "--specimen", specimen,
                      *sets("test.pressure_Pa=10e3"),
                      resume=True))


def means(path):
    strain, stress, void_ratio, held = records(path, "strain", "stress_Pa", "void_ratio", "target_held").values()
    p = -0.5 * (stress[:, 0, 0] + stress[:, 1, 1])
    q = np.hypot(0.5 * (stress[:, 0, 0] - stress[:, 1, 1]), 0.5 * (stress[:, 0, 1] + stress[:, 1, 0]))
    late = (strain >= 2) & (strain <= 5 + 1e-9)
    return void_ratio[0], void_ratio[late].mean(), (q / p)[late].mean(), 1 - held.mean()


def main():
    (work / "discs.toml").write_text(RECIPE)
    tests = [(kind, seed) for seed in SEEDS for kind in ("dense", "loose")]
    rows = dict(zip(tests, in_turn(lambda each: test(*each), tests)))
    print("specimen  e at start   e         q/p      flagged")
    for (kind, seed), row in sorted(rows.items()):
        print(f"{kind} {seed:3d}  {row[0]:.4f}      {row[1]:.5f}   {row[2]:.4f}   {row[3]:.2%}")
    failed = max(row[3] for row in rows.values()) > 0.01
    print("\nquantity  dense +- se          loose +- se          difference/se   largest se/mean")
    for k, name in ((1, "e"), (2, "q/p")):
        mean, error = zip(*(mean_error([rows[kind, seed][k] for seed in SEEDS]) for kind in ("dense", "loose")))
        difference = abs(mean[0] - mean[1]) / np.hypot(*error)
        relative = max(error[0] / mean[0], error[1] / mean[1])
        harness.row(f"{name:8}  {mean[0]:.5f} +- {error[0]:.5f}   {mean[1]:.5f} +- {error[1]:.5f}   {difference:8.2f}   "
                    f"{relative:14.2%}  ", difference < 2 and relative <= 0.01, good="ok")
    return failed


if __name__ == "__main__":
    harness.main(main)
