"""Shear bands of a biaxial test: bands.py PROGRAM WORK RESULTS [SPECIMENS]

Dense discs at 100 kPa (8 specimens), probed at eight strains before, at and after the peak of the mean curve, by
  loading   increments that go on in the direction of the test (rvelab probe R.h5 --bands)
  averaged  increments of +-1e-3 in each component, of loading and unloading (--method dynamic --size 1e-3)
Mean over the specimens of: least det of the acoustic tensor over that of the elastic tangent of the same state, and over that at
the start; second-order work along the direction of the test over the elastic one; angle between the normal of the weakest band and
the major stress, beside 45 + phi/2 (Coulomb), 45 + psi/2 (Roscoe) and their mean (Arthur).

Bars: of the loading probes the mean det falls below 5 % of the elastic one at the peak and is negative there or at the next state,
with the band between Roscoe and Coulomb to three standard errors.
"""

import math

import numpy as np

import harness
from harness import answer, mean_error, once, packed, sets, work

count = int(harness.words[0]) if harness.words else 8
STRAINS = (0.0005, 0.003, 0.006, 0.01, 0.015, 0.02, 0.03, 0.05)


def specimen(number):
    return packed("pack_dense", f"S_{number}", f"pack.seed={number}")


def test(number, strain):
    return once(work / f"R_{number}_{strain:g}.h5", "run", "biaxial", "--specimen", specimen(number),
                *sets("test.pressure_Pa=1e5", f"stage.compression.to_strain={strain}"))


def least_determinant(stiffness):
    """Of the acoustic tensor in the plane, over all directions; stiffness row by row, xx yy xy."""
    c = np.reshape(stiffness, (3, 3))
    best = math.inf
    for angle in np.linspace(0, math.pi, 1800, endpoint=False):
        n = math.cos(angle), math.sin(angle)
        strains = np.array([[n[0], 0], [0, n[1]], [n[1], n[0]]])
        best = min(best, np.linalg.det(strains.T @ c @ strains))
    return best


def main():
    numbers = range(1, count + 1)
    start = {n: least_determinant(answer("probe", specimen(n), "--method", "linear")["stiffness_Pa"]) for n in numbers}
    rows = []
    print(f"{count} specimens of 400 dense discs, biaxial at 100 kPa: mean +- standard error")
    print("strain    q/p   | loading: det/elastic     det/start  work/elastic  band angle    | averaged: det    work  angle  "
          "| Roscoe Arthur Coulomb")
    for strain in STRAINS:
        loading = [answer("probe", test(n, strain), "--bands") for n in numbers]
        averaged = [answer("probe", test(n, strain), "--bands", "--method", "dynamic", "--size", "1e-3")
                    for n in numbers]
        from_start = mean_error([least_determinant(each["stiffness_Pa"]) / start[n] for n, each in zip(numbers, loading)])

        def of(answers, key):
            return mean_error([each[key] for each in answers])

        det, work, angle = (of(loading, key) for key in ("acoustic_ratio", "second_order_work_ratio", "band_angle_deg"))
        roscoe, arthur, coulomb = (of(loading, f"{name}_angle_deg")[0] for name in ("roscoe", "arthur", "coulomb"))
        q_over_p = math.sin(math.radians(2 * (coulomb - 45)))
        print(f"{strain:6.4f}  {q_over_p:5.3f}   | {det[0]:7.3f} +- {det[1]:5.3f}     {from_start[0]:7.3f}    {work[0]:7.3f}       "
              f"{angle[0]:4.1f} +- {angle[1]:3.1f}   |    {of(averaged, 'acoustic_ratio')[0]:7.3f}  {of(averaged, 'second_order_work_ratio')[0]:6.3f}  "
              f"{of(averaged, 'band_angle_deg')[0]:5.1f}  | {roscoe:5.1f}  {arthur:5.1f}  {coulomb:5.1f}", flush=True)
        rows.append((q_over_p, det, angle, roscoe, coulomb))
    peak = max(range(len(rows)), key=lambda k: rows[k][0])
    _, det, angle, roscoe, coulomb = rows[peak]
    after = rows[min(peak + 1, len(rows) - 1)][1]
    bars = [("mean det at the peak over the elastic one, below 0.05", det[0], det[0] < 0.05),
            ("least of the mean det at the peak and the next state, below 0", min(det[0], after[0]), min(det[0], after[0]) < 0),
            (f"band angle at the peak between {roscoe:.1f} (Roscoe) and {coulomb:.1f} (Coulomb), to 3 standard errors", angle[0],
             roscoe - 3 * angle[1] <= angle[0] <= coulomb + 3 * angle[1])]
    for what, value, met in bars:
        harness.row(f"{what}: {value:.3f} ", met, good="ok")


if __name__ == "__main__":
    harness.main(main)
