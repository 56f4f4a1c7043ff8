"""How scatter falls with the number of specimens and of grains: scatter.py PROGRAM WORK RESULTS [SPECIMENS]

A sweep of `rvelab fit` over the number of grains, on so many specimens each (biaxial, 20 kPa, to 5 %). Prints mean, standard
deviation with its own standard error sd/sqrt(2 (n - 1)), the standard deviation times the root of the number of grains, which
is constant where grains are independent, and how many specimens give the friction angle to half a degree (one standard error).
"""

import csv
import math

import harness
from harness import sets, work

MEASURES = {"friction_angle_deg": "friction angle", "dilation_angle_deg": "dilation angle"}


def main():
    out = harness.once(work / "sweep", "fit", "biaxial", "--recipe", "pack_dense", "--count", *(harness.words or [20]),
                       "--vary",
                       "pack.number=50:1600:6:log", *sets("stage.compression.to_strain=0.05",
                                                          "target.void_ratio_tolerance=0.003"), resume=True)
    print("grains  specimens  measure          mean        sd             sd sqrt(grains)  specimens for 0.5 degrees")
    with open(out / "sweep.csv", newline="") as table:
        for row in csv.DictReader(table):
            for name, words in MEASURES.items():
                n, grains = int(row[name + "_n"]), float(row["pack.number"])
                deviation = float(row[name + "_standard_error"]) * math.sqrt(n)
                own = deviation / math.sqrt(2 * (n - 1))
                needed = max(2, math.ceil((deviation / 0.5) ** 2))
                print(f"{grains:6.0f}  {n:9d}  {words:15s}  {float(row[name]):6.2f} deg  {deviation:4.2f} +- {own:4.2f}  "
                      f"{deviation * math.sqrt(grains):15.0f}  {needed:6d}")


if __name__ == "__main__":
    harness.main(main)
