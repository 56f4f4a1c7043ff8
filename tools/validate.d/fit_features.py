"""tools/validate fit_features fit_agitated: Karlsruhe fine sand fitted by features of three tests, the other tests predicted.

    fit_features.py RVELAB WORK RESULTS FIT

Parameters, the map of densities, and each feature as measured (scatter of laboratories), fitted and predicted. Then, of fitted
and predicted tests each, how many features lie within one and two errors."""

import csv
import json
import re

import harness
from harness import once, words, work


def main():
    folder = once(work / "K", "fit", words[0], resume=True)
    with open(folder / "features.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    fit = json.loads((folder / "fit.json").read_text())
    for parameter in fit["parameters"]:
        print(f"{parameter['key']}: {parameter['mean']:.3g} ({parameter['low_95']:.3g} to {parameter['high_95']:.3g})")
    a, b = (fit["density_map"][key] for key in ("intercept", "slope"))
    print(f"void ratio of the model = a + b (that of the sand): a {a['mean']:.3f} ({a['low_95']:.3f} to {a['high_95']:.3f}), "
          f"b {b['mean']:.3f} ({b['low_95']:.3f} to {b['high_95']:.3f})")
    print(f"{len(fit['tests'])} sets of parameters x 3 tests; misfit {fit['misfit']:.2f}\n")
    print(f"{'test':<8} {'':<10} {'feature':<30} {'measured':>10} {'scatter':>9} {'model':>10} {'sd':>9} {'errors off':>10}")
    off = {"fitted": [], "predicted": []}
    for row in rows:
        role = "predicted" if row["predicted"] == "1" else "fitted"
        value, error, mean, deviation = (float(row[key]) for key in ("measured", "error", "mean", "standard_deviation"))
        off[role].append(abs(mean - value) / (error ** 2 + deviation ** 2) ** 0.5)
        # Stresses in kPa, moduli in MPa, strains in per cent.
        name = row["feature"]
        factor = 1e-6 if name == "E50_Pa" else 1e-3 if name.endswith("_Pa") else 100
        label = re.sub("_Pa$", "", name) + (", MPa" if name == "E50_Pa" else ", kPa" if name.endswith("_Pa") else ", %")
        print(f"{row['test']:<8} {role:<10} {label:<30} " + " ".join(
            f"{factor * number:>{width}.3g}" for number, width in ((value, 10), (error, 9), (mean, 10), (deviation, 9)))
            + f" {off[role][-1]:>10.1f}")
    for role, all_of in off.items():
        print(f"{role}: {len(all_of)} features, within one error {sum(each < 1 for each in all_of)}, within two {sum(each < 2 for each in all_of)}")


if __name__ == "__main__":
    harness.main(main)
