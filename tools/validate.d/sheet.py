"""tools/validate sheet: data sheets of Toyoura and Karlsruhe sand by the quick plan, beside published numbers.

    sheet.py RVELAB WORK RESULTS

Each published number (published/*.toml) and that of the sheet, with half of its 95 % interval over specimens and its error of
calculation; it has to lie within the root of the sum of their squares. Then the misfits of the continuum models on tests that were kept back.
What shows why a number is missed is calculated beside: G0 of the same packings of grains as stiff as quartz, ends of the measured tests,
limits of density; the pages are sheet_NAME.html. Then what a dense specimen does under cyclic stress."""

import csv
import json
import math
import pathlib
import shutil

import numpy as np

import harness
from harness import once, records, results, verdict, work

HERE = pathlib.Path(__file__).parent
PUBLISHED = HERE / "published"
PROTOCOLS = HERE.parent.parent / "protocols"
SAND_LIMITS = 0.597, 0.977  # e_min, e_max of Toyoura sand (Verdugo and Ishihara 1996)
QUARTZ = 70e9  # Pa
PROBES = """[sheet]
seeds = 3
pressure_Pa = 20e3
settings = ["pack.number=500", "target.void_ratio_tolerance=0.005", "material.{material}.young_modulus_Pa={E}"]
""" + "".join(f"""[[density]]
name = "{name}"
relative_density = {density}
""" for name, density in (("loose", 0.3), ("medium", 0.6), ("dense", 0.9))) + """[[test]]
name = "isotropic"
purpose = "isotropic"
protocol = "isotropic_probes"
"""


def number(folder, key):
    numbers = json.loads((folder / "summary.json").read_text())["numbers"]
    return next(each for each in numbers if each["key"] == key and each["density"] is None)


def with_stiff_grains(soil, material):
    plan = work / f"probes_{soil}.toml"
    plan.write_text(PROBES.format(material=material, E=f"{QUARTZ:g}"))
    return once(work / f"{soil}_quartz", "sheet", soil, "--plan", plan, resume=True)


def angle_at_end(name):
    """Of a measured drained test at 100 kPa: mean q over the last quarter of its strain, degrees."""
    with open(PROTOCOLS / "fits/karlsruhe" / f"{name}.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    strain, q = (np.array([float(row[column]) for row in rows]) for column in ("axial_strain_percent", "deviator_kPa"))
    q = q[strain >= 0.75 * strain[-1]].mean()
    return math.degrees(math.asin(q / (q + 200)))


def cycles(test):
    """Half of the turns of its strain."""
    return np.count_nonzero(np.diff(np.sign(np.diff(records(test, "strain", last=True)["strain"])))) / 2


def reasons(soil, folder):
    """Why numbers are missed, by their keys: each from figures that are calculated here."""
    if soil == "karlsruhe":
        ends = ", ".join(f"{name} {angle_at_end(name):.1f}" for name in ("TMD2", "TMD22"))
        return {"phi_cs_deg": f"the recipe is fitted to measured tests, of which the last quarter of the strain is at {ends} degrees"}
    stiff = with_stiff_grains(soil, "quartz")
    G, n, soft = number(stiff, "G_ref_Pa"), number(stiff, "G0_exponent"), number(folder, "G_ref_Pa")
    stiffness = (f"E of the grains is 7 GPa; with {QUARTZ / 1e9:g} GPa G_ref is {G['mean'] / 1e6:.0f} MPa, off by "
                 f"{100 * (G['mean'] / soft['published'] - 1):+.0f} %, "
                 f"the exponent {n['mean']:.3f}: smooth spheres (Hertz 1/3), rough ones have more; "
                 f"by E^(2/3) (Hertz) {QUARTZ / 1e9 * (soft['published'] / G['mean']) ** 1.5:.0f} GPa would give "
                 f"the published {soft['published'] / 1e6:.0f} MPa")
    grading = (PROTOCOLS / "soils/toyoura.toml").read_text()
    limits = [float(next(line for line in grading.splitlines() if line.startswith(key)).split("=")[1].split("#")[0])
              for key in ("e_min", "e_max")]
    e_G = number(folder, "critical_line_e_G")
    state = [(high - value) / (high - low) for (low, high), value in
             ((limits, e_G["mean"]), (SAND_LIMITS, e_G["published"]))]
    line, M = number(folder, "critical_line_lambda"), number(folder, "M_tc")["mean"]
    ends = [pressure * 3 / (3 - M) for pressure in (50, 400)]  # kPa, p of drained tests at critical state
    span = np.ptp((np.array(ends) / 101.325) ** 0.7)
    return {"G_ref_Pa": stiffness, "G0_exponent": stiffness,
            "critical_line_e_G": f"spheres pack denser: limits {limits[0]:g}, {limits[1]:g}, of the sand {SAND_LIMITS[0]:g}, "
                                 f"{SAND_LIMITS[1]:g}; between them relative density {state[0]:.2f}, of the sand {state[1]:.2f}",
            "critical_line_lambda": f"from {ends[0]:.0f} to {ends[1]:.0f} kPa, the ends of the tests, e of the sand falls by "
                                    f"{span * line['published']:.3f}, of these grains by {span * line['low_95']:.3f} to "
                                    f"{span * line['high_95']:.3f}, not determined where 0 lies between; single ends scatter by "
                                    f"{number(folder, 'critical_line_scatter')['mean']:.3f}"}


def main():
    for soil in ("toyoura", "karlsruhe"):
        folder = once(work / soil, "sheet", soil, "--quick", "--beside", PUBLISHED / f"{soil}.toml", resume=True)
        summary = json.loads((folder / "summary.json").read_text())
        why = reasons(soil, folder)
        print(f"{soil}: {len(summary['numbers'])} numbers")
        for each in summary["numbers"]:
            if each.get("published") is None:
                continue
            scale, unit = (1e-6, "MPa") if each["unit"] == "Pa" else (1, each["unit"])
            mean, low, high, known = (scale * (np.nan if each[key] is None else each[key])
                                      for key in ("mean", "low_95", "high_95", "published"))
            half, error = (high - low) / 2, each["calculation_error"] and scale * each["calculation_error"]
            verdict(f"{each['key']}, {each['published_by']}",
                    f"{known:.3g} {mean:.3g} +- {half:.3g} of specimens{f', {error:.3g} of calculation' if error else ''} {unit}",
                    "within both", abs(mean - known) <= np.hypot(half, error or 0), width=60, reason=why.get(each["key"], ""))
        for model in summary["models"]:
            for each in model["misfits"]:
                if not each["fitted"] and each["stress"] is not None:
                    print(f"{model['model']:<40} {each['test']:<40} {each['remark'] or format(each['stress'], '.2f')}")
        for each in summary["remarks"]:
            if any(words in each for words in ("is left out", "void ratio", "first cycle")):
                print(each)
        ends = sorted(cycles(path) for path in (folder / "tests").glob("cyclic_stress_loose_*.h5"))
        print(f"loose specimens under cyclic stress: {ends[0]:g} to {ends[-1]:g} cycles to the end of a test")
        shutil.copy(folder / "index.html", results / f"sheet_{soil}.html")
        print()
    dense = once(work / "dense_cyclic.h5", "run", "triaxial_cyclic", "--specimen",
                 work / "karlsruhe/specimens/S_dense_1.h5", "--set", "stage.cycles.reverse_at_Pa=140e3", "--set",
                 "stage.cycles.record_every=0.001")
    found = records(dense, "strain", "stress_Pa", last=True)
    strain, p = found["strain"], -np.trace(found["stress_Pa"], axis1=1, axis2=2) / 3
    print(f"dense specimen of karlsruhe, 100 kPa, q/(2 p) = 0.7: {cycles(dense):.0f} cycles, r_u at most {1 - p.min() / p[0]:.2f}, "
          f"strain at most {100 * np.abs(strain).max():.1f} %")


if __name__ == "__main__":
    harness.main(main)
