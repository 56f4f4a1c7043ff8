"""tools/validate sheet: data sheets of Toyoura and Karlsruhe sand by the quick plan, beside published numbers.

    sheet.py RVELAB WORK RESULTS

Each published number (published/*.toml) and the interval of the sheet, then the misfits of the continuum models on tests that were kept back.
Spheres pack denser than sands, so that critical void ratios are those of the model; the pages are sheet_NAME.html."""

import json
import pathlib
import shutil

import numpy as np

import harness
from harness import once, results, verdict, work

PUBLISHED = pathlib.Path(__file__).parent / "published"


def main():
    for soil in ("toyoura", "karlsruhe"):
        folder = once(work / soil, "sheet", soil, "--quick", "--beside", PUBLISHED / f"{soil}.toml", resume=True)
        summary = json.loads((folder / "summary.json").read_text())
        print(f"{soil}: {len(summary['numbers'])} numbers")
        for number in summary["numbers"]:
            if number.get("published") is None:
                continue
            scale, unit = (1e-6, "MPa") if number["unit"] == "Pa" else (1, number["unit"])
            mean, low, high, known = (scale * (np.nan if number[key] is None else number[key])
                                      for key in ("mean", "low_95", "high_95", "published"))
            verdict(f"{number['key']}, {number['published_by']}", f"{known:.3g} {mean:.3g} ({low:.3g} to {high:.3g}) {unit}",
                    "in the interval", low <= known <= high, width=60)
        for model in summary["models"]:
            for each in model["misfits"]:
                if not each["fitted"]:
                    off = "not comparable" if each["stress"] is None else f"{each['stress']:.2f}"
                    print(f"{model['model']:<40} {each['test']:<40} {each.get('remark') or off}")
        shutil.copy(folder / "index.html", results / f"sheet_{soil}.html")
        print()


if __name__ == "__main__":
    harness.main(main)
