"""The tables of a report: what was asked, the specimen, results of the tests, their error and run time. A table is a list of
rows, a row a list of texts; the first row is the head."""

import json
import math
import pathlib

import records  # first: it says which package is missing
import mohr
import curves as kinds
import h5py
import numpy as np

SHOWN = ("axis", "plane", "lateral", "normal", "to_strain", "cycles", "pressure_Pa", "lateral_pressure_Pa", "record_every",
         "amplitude", "stress_ratio")
SETTINGS = ("solver", "contact", "damping", "material", "loading")


def plain_value(value):
    """A value of a protocol as a reader writes it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (int, float)):
        return f"{value:.6g}"
    return ", ".join(map(plain_value, value)) if isinstance(value, list) else str(value)


def asked(tests, protocol):
    """Name of the test, how often and at which pressures it was made, its stages, settings that are not the usual."""
    specimens = len({test[0].origin.specimen for test in tests})
    pressures = sorted({f"{test[0].pressure / 1e3:.4g}" for test in tests}, key=float)
    rows = [["", ""], ["tests", f"{len(tests)}, on {records.counted(specimens, 'specimen')}"],
            ["pressure", ", ".join(pressures) + " kPa"]]
    for stage in protocol.get("stage", []):
        keys = [f"{name} {plain_value(value)}" for name, value in stage.items()
                if name in SHOWN and not ("pressure" in name and len(pressures) > 1)]
        rows.append([f"stage {stage.get('name', stage['kind'])}", ": ".join([stage["kind"], "; ".join(keys)]).rstrip(": ")])
    for name in SETTINGS:
        table = protocol.get(name)
        for entry in table if isinstance(table, list) else [table] if table else []:
            rows.append([name, "; ".join(f"{key} {plain_value(value)}" for key, value in entry.items())])
    return rows


def grading(radius, dimension):
    """d10, d50 and d60 by mass (by area in 2D), m."""
    order = np.sort(radius)
    passing = np.cumsum(order**dimension) / np.sum(order**dimension)
    return [2 * float(np.interp(part, passing, order)) for part in (0.1, 0.5, 0.6)]


def specimen(path, first):
    """What the grains of a record file are; void ratio and coordination from its first records."""
    with h5py.File(path, "r") as file:
        own = file["specimen"]
        radius, shape = own["grains/radius_m"][()], records.texts(own["shape"])[0]
        law, materials = records.texts(own["contact/law"])[0], own["materials"]
        lattice = own["cell/lattice_m"][()]
        d10, d50, d60 = grading(radius, first.dimension)
        factor, unit = kinds.length_unit(d50)
        rows = [["", ""], ["grains", f"{len(radius)} {'of shape ' + shape}, {first.dimension}D"],
                ["d10, d50, d60", ", ".join(f"{factor * d:.3g}" for d in (d10, d50, d60)) + f" {unit}; uniformity d60/d10 "
                 f"{d60 / d10:.3g}"],
                ["cell at the end", " x ".join(f"{np.linalg.norm(lattice[:, k]) / (2 * radius.mean()):.3g}"
                                              for k in range(first.dimension)) + " mean diameters"]]
        for name, label in (("void_ratio", "void ratio at the start"), ("coordination_number", "coordination number at the start")):
            if first.has(name):
                rows.append([label, f"{first.column(name)[0]:.4g}"])
        rows.append(["contact law", law])
        for k, name in enumerate(records.texts(materials["name"])):
            values = [f"{key} {plain_value(float(materials[key][k]))}" for key in materials if key != "name"
                      and float(materials[key][k]) != 0]
            rows.append([f"material {name}", "; ".join(values)])
    return rows


def angle_in_words(values):
    """Mean, standard error where there are several."""
    values = np.array([value for value in values if value is not None])
    if len(values) == 0:
        return "none"
    error = f" ± {values.std(ddof=1) / math.sqrt(len(values)):.2f}" if len(values) > 1 else ""
    return f"{values.mean():.2f}{error}"


def peaks(test):
    """Largest q/p, strain there, mobilised angle there in degrees, and that of large strain (None before 15 %)."""
    sigma_1, sigma_3 = test.principal()
    row = int(np.argmax(sigma_1 - sigma_3)) if test.drained else int(np.nanargmax(test.mobilised()))
    angle = math.degrees(math.asin((sigma_1[row] - sigma_3[row]) / (sigma_1[row] + sigma_3[row])))
    large = mohr.large_strain_angle(test) if test.drained else None
    return 100 * test.strain[row], angle, None if large is None else math.degrees(large)


def results(tests):
    """One row a kind of test: mean and standard error over its specimens."""
    last = [test[-1] for test in tests if test[-1].kind in ("compression", "simple_shear", "deviatoric")
            and test[-1].keys.get("lateral") != "zero_strain" and not test[-1].cyclic]
    if not last:
        return []
    rows = [["test", "specimens", "peak friction angle (degrees)", "strain at the peak (%)",
             "angle at 12 to 15 % strain (degrees)"]]
    for curve in kinds.curves_of(last):
        found = [peaks(test) for test in curve.stages]
        label = curve.label.split(" (n =")[0].replace("$", "").replace("e_0", "e0")
        rows.append([label, str(len(found)), angle_in_words([row[1] for row in found]),
                     angle_in_words([row[0] for row in found]), angle_in_words([row[2] for row in found])])
    return rows


def to_error(values, error):
    """Texts of values with the digits that a standard error leaves: two of its own; powers of 1000 where they are long."""
    values = [value for value in values if value is not None]
    if not error or not all(map(math.isfinite, [error, *values])):
        return [f"{value:.4g}" for value in values]
    power = 3 * int(math.log10(max(map(abs, values)) or 1) // 3) if max(map(abs, values)) >= 1e5 else 0
    digits = max(0, 1 - math.floor(math.log10(error / 10 ** power)))
    return [f"{value / 10 ** power:.{digits}f}" + (f"e{power}" if power else "") for value in values]


def summary(folder):
    """The means that `rvelab run` and `calibrate` wrote beside the records of several specimens; no rows without them."""
    path = pathlib.Path(folder) / "summary.json"
    try:
        found = json.loads(path.read_text())["summary"]
    except (OSError, ValueError, KeyError, TypeError):
        return []
    rows = [["group", "pressure", "measure", "n", "mean", "standard error", "95 % interval of the mean"]]
    for row in found:
        pressure = row.get("pressure_Pa")
        names = ("mean", "standard_error", "low_95", "high_95")
        shown = to_error([row.get(name) for name in names], row.get("standard_error"))
        shown += [""] * (len(names) - len(shown))
        unit = row.get("unit", "")
        rows.append([str(row.get("group", "")), "all" if pressure is None else f"{pressure / 1e3:.4g} kPa",
                     row["measure"] + (f" ({unit})" if unit not in ("", "1") else ""), str(row["n"]), shown[0], shown[1],
                     f"{shown[2]} to {shown[3]}" if shown[2] else ""])
    return rows


ERROR_IN_WORDS = ("The error estimate is how far the stress of a record may be from that of infinitely slow loading, as a "
                  "share of the mean stress p; some 19 of 20 errors are smaller than their estimate.")


def error_and_time(tests):
    """One row a test: records, those off the held stress or without equilibrium, unbalanced ratio, time."""
    rows = [["file", "records", "held stress missed", "no equilibrium", "largest held error", "unbalanced ratio, median",
             "error estimate over p: mean, largest", "cell thin", "run time (s)", "grain-steps", "complete"]]
    for test in tests:
        def of(name, default=0):
            return np.concatenate([stage.columns.get(name, np.full(len(stage.strain), default)) for stage in test])
        missed, calm = int((of("target_held", 1) == 0).sum()), int((of("quasi_static", 1) == 0).sum())
        origin = test[0].origin
        judged = of("error_estimate")[of("error_estimate") > 0]
        estimate = f"{judged.mean():.2g}, {judged.max():.2g}" if judged.size else "-"
        rows.append([test[0].path.name, str(len(of("strain"))), str(missed), str(calm), f"{np.nanmax(of('held_error')):.2g}",
                     f"{np.nanmedian(of('unbalanced_force_ratio')):.2g}", estimate, str(int(of("cell_thin").sum())),
                     f"{origin.wall_seconds:.3g}", f"{origin.grain_steps:.3g}", "yes" if origin.complete else "no"])
    total = sum(test[0].origin.wall_seconds for test in tests)
    steps = sum(test[0].origin.grain_steps for test in tests)
    rows.append(["all", str(sum(len(stage.strain) for test in tests for stage in test)), "", "", "", "", "", "", f"{total:.3g}",
                 f"{steps:.3g}", f"{steps / max(total, 1e-9):.2g} grain-steps/s"])
    return rows
