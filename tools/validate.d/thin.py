"""Cells under large strain: thin.py RVELAB WORK RESULTS [PART...] [RECIPE...]. Parts: rate, rest, pure (default: all).

rate: a specimen of every recipe (or of those named) sheared v_x(y), in space v_x(z), to gamma = 1e4 at dt > 0: of pack_regular
and four recipes of discs as it is, of the others 100 discs or 200 spheres, whose cell is thin the sooner. rest: to 300 at dt = 0
by the loosest tolerance, 100 discs or 200 spheres. Printed: records, those of a thin cell (a height below four mean
diameters), heights of the last cell over the mean diameter.
pure: upright and oriented specimens of discs, compressed at constant volume to a Hencky strain of 2: five each of pack_loose at
dt > 0 and at dt = 0, at dt = 0 of pack_medium and pack_dense 20 each of 400 grains and ten of 1600: heights of the upright
cell, p and sin phi by strain, of the records that are not flagged as thin; which are.

Bars: no thin cell in simple shear. In pure shear every record of a thin cell is flagged and reported, and p and sin phi of
the others are as in oriented cells, as far as means of so many specimens tell; below ten mean diameters they are off, and the
run warns of a low cell. Where a higher cell differs by as much at the same strain (1600 grains beside 400), it is no matter of the
height: the row says DIFFERS.
"""
import time

import h5py
import numpy as np

import harness
from harness import PROTOCOLS, bars, records, row, work

RECIPES = sorted(path.stem for path in PROTOCOLS.glob("pack_*.toml"))
WHOLE = ("pack_dense", "pack_medium", "pack_loose", "pack_soft")
SPHERES = ("pack_hertz", "pack_mixture", "pack_qu282", "pack_qu371", "pack_qu548", "pack_qu738")
# Grains of the Qu recipes have no pressure to give a rate by: v = rate d is 1 m/s.
SHEAR = """[test]
name = "large strain"
[loading]
mode = "{mode}"
{rate}
[solver]
max_overlap_ratio = 1
relative_tolerance = 1
[[stage]]
kind = "{kind}"
to_strain = {strain}
record_every = {every}
{more}
"""


COMPARISONS = 60  # of means in cells higher than ten diameters, in all tables of pure shear
LEVEL = 0.01  # that one of them is beyond the bar by chance: one false alarm in a hundred makings of the tables


def beyond(freedom):
    """What Student's t of so many degrees of freedom exceeds, to both sides, with a chance of LEVEL / COMPARISONS."""
    t = np.linspace(0, 200, 2_000_001)
    density = (1 + t**2 / freedom) ** (-(freedom + 1) / 2)
    above = 1 - np.cumsum(density) / density.sum()
    return float(t[np.argmax(above < LEVEL / COMPARISONS)])


def error_of(compared):
    """Of p over that of oriented cells; at least what rounding in the table leaves."""
    ratio, apart, _ = compared
    return max(abs(ratio - 1), 0.005) / max(abs(apart), 0.05)


@bars
def judge(tables):
    """Prints tables of one recipe, one size after the other: head, number of seeds, rows, tail. A row: its text,
    strain, height over d, and, compared with oriented cells, p over theirs and the differences of p and sin phi over
    their standard errors, or nothing."""
    for k, (head, seeds, rows, tail) in enumerate(tables):
        bar = beyond(2 * seeds - 2)
        print(head, flush=True)
        for text, strain, height, compared in rows:
            apart = bool(compared) and max(map(abs, compared[1:])) > bar
            others = [(other_height, other) for j, table in enumerate(tables) if j != k
                      for _, at, other_height, other in table[2]
                      if at == strain and other and other_height >= 10]
            same = [(at, other) for at, other in others
                    if apart and abs(other[0] - compared[0]) <= 3 * np.hypot(error_of(compared), error_of(other))]
            low = apart and height < 10
            row(text, not apart or low, apart and bool(same) and abs(compared[2]) <= bar,
                f"p depends on how the edges of the periodic cell lie to the strain, not on its height: over that of oriented cells\n"
                f"    at the same strain {compared[0]:.2f} at {height:.0f} d, {same[0][1][0]:.2f} at {same[0][0]:.0f} d" if same else "",
                good="low" if low else "", what=f"{head.split(',')[2].strip()}, {strain}")
        print(tail + f"; bar {bar:.1f} standard errors", flush=True)


def packed(recipe, *settings):
    made = harness.packed(recipe, "_".join([recipe, *(each.split("=")[1] for each in settings)]), *settings,
                          options=("--threads", 1))
    return made if made.exists() else min(work.glob(made.stem + "_*Pa.h5"))


def run(specimen, **scene):
    """The records, the last specimen's heights over the mean diameter, and what was said."""
    test, out = work / "test.toml", work / "R.h5"
    test.write_text(SHEAR.format(**scene))
    out.unlink(missing_ok=True)
    done = harness.run(harness.program, "run", test, "--specimen", specimen, "-o", out, "--force", codes=None)
    errors = done.stderr.strip()
    if not out.exists():
        return None, None, errors, errors
    found = records(out, "strain", "stress_Pa", "cell_thin")
    with h5py.File(out) as file:
        lattice, radius = file["specimen/cell/lattice_m"][:], file["specimen/grains/radius_m"][:]
    dimension = 2 if np.ptp(found["stress_Pa"][:, 2, 2]) == 0 else 3
    heights = 1 / np.linalg.norm(np.linalg.inv(lattice), axis=1)[:dimension] / (2 * radius.mean())
    return found, heights, errors if done.returncode else "", errors


def simple_shear(recipes, at_rate):
    print(f"simple shear at dt {'> 0 to 1e4' if at_rate else '= 0 to 300'}: recipe, grains, records, thin, last heights/d, seconds")
    missed = 0
    for recipe in recipes:
        number = [f"pack.number={200 if recipe in SPHERES else 100}"]
        if "\nvoid_ratio" in (PROTOCOLS / f"{recipe}.toml").read_text():
            number.append("target.void_ratio_tolerance=0.02")
        if recipe == "pack_regular" or (at_rate and recipe in WHOLE):
            number = []
        specimen = packed(recipe, *number)
        rate = "" if not at_rate else "rate_1_s = 5" if "qu" in recipe else "inertial_number = 0.3"
        begun = time.monotonic()
        records, heights, errors, _ = run(specimen, mode="at_rate" if at_rate else "quasi_static", rate=rate,
                                       kind="simple_shear", strain=1e4 if at_rate else 300, every=1 if at_rate else 0.1, more="")
        seconds = time.monotonic() - begun
        if records is None or errors:
            print(f"{recipe:14} {errors[-300:]}", flush=True)
            missed += 1
        if records is None:
            continue
        thin = int(records["cell_thin"].sum())
        print(f"{recipe:14} {number[0][12:] if number else 'all':4} {len(records['strain']):6} {thin:6}  "
              f"{' '.join(f'{each:6.2f}' for each in heights)} {seconds:8.0f}", flush=True)
        missed += thin > 0
    return missed


def pure_shear(at_rate, recipe="pack_loose", number=400, seeds=5):
    """A table for judge(), and whether runs did not report what they should."""
    head = (f"pure shear at constant volume, dt {'> 0' if at_rate else '= 0'}, {recipe}, {number} grains: Hencky strain; upright height "
            "over d; upright, oriented: records, thin, p, sin phi; p over that of oriented cells; differences over their standard errors")
    edges, found, heights, rows = np.linspace(0, 2, 11), {}, [], []
    reported = to_report = 0
    for cell in ("upright", "oriented"):
        found[cell] = []
        for seed in range(1, seeds + 1):
            size = [f"pack.number={number}"] if number != 400 else []
            specimen = packed(recipe, *size, f"pack.cell={cell}", f"pack.seed={seed}")
            records, last, errors, said = run(specimen, mode="at_rate" if at_rate else "quasi_static",
                                        rate="inertial_number = 0.1" if at_rate else "", kind="compression",
                                        strain=1 - np.exp(-2), every=0.0025, more='lateral = "constant_volume"')
            if records is None or errors:
                print(f"  {cell} {seed}: {errors[-300:]}", flush=True)
            if records is None:
                continue
            found[cell].append(records)
            if cell == "upright":
                heights.append(last[1] / (1 - records["strain"][-1]))
                reported += ("the cell became" in said) + ("records are of a thin cell" in said)
                to_report += int(min(last) < 10) + int(records["cell_thin"].any())
    for low, high in zip(edges[:-1], edges[1:]):
        height = np.mean(heights) * np.exp(-(low + high) / 2)
        line, means = f"  {low:.1f} to {high:.1f}  {height:5.1f}", {}
        for cell, runs in found.items():
            values, count, thin = [], 0, 0
            for records in runs:
                hencky = -np.log(1 - records["strain"])
                inside = (hencky > low) & (hencky <= high + 1e-9)
                count, thin = count + int(inside.sum()), thin + int((inside & records["cell_thin"]).sum())
                whole = inside & ~records["cell_thin"].astype(bool)
                if not whole.any():
                    continue
                stress = -records["stress_Pa"][whole][:, :2, :2]
                p = np.trace(stress, axis1=1, axis2=2) / 2
                q = np.hypot((stress[:, 1, 1] - stress[:, 0, 0]) / 2, stress[:, 0, 1])
                values.append((p.mean(), q.mean() / p.mean()))
            means[cell] = np.array(values)
            line += f"   {count:4} {thin:4}" + (" {:9.4g} {:6.3f}".format(*means[cell].mean(axis=0)) if values else 17 * " ")
        compared = None
        if all(len(each) > 1 for each in means.values()):
            of_upright, of_oriented = means["upright"].mean(axis=0), means["oriented"].mean(axis=0)
            error = np.sqrt(sum(each.var(axis=0, ddof=1) / len(each) for each in means.values()))
            apart = (of_upright - of_oriented) / error
            compared = [of_upright[0] / of_oriented[0], *apart]
            line += "   {:5.2f} {:5.1f} {:5.1f}".format(*compared)
        rows.append((line, f"{low:.1f} to {high:.1f}", float(height), compared))
    tail = f"  runs of upright cells that are told of as low, and as thin: {reported} of {to_report}"
    return (head, seeds, rows, tail), reported < to_report


def main():
    recipes = [each for each in harness.words if each in RECIPES] or RECIPES
    parts = [each for each in harness.words if each not in RECIPES] or ["rate", "rest", "pure"]
    missed = 0
    if "pure" in parts:
        for at_rate, recipe, sizes in ((True, "pack_loose", ((400, 5),)), (False, "pack_loose", ((400, 5),)),
                                       (False, "pack_medium", ((400, 20), (1600, 10))), (False, "pack_dense", ((400, 20), (1600, 10)))):
            tables, unreported = zip(*(pure_shear(at_rate, recipe, number, seeds) for number, seeds in sizes))
            judge(tables)
            missed += sum(unreported)
    for part, at_rate in (("rate", True), ("rest", False)):
        if part in parts:
            missed += simple_shear(recipes, at_rate)
    return missed


if __name__ == "__main__":
    harness.main(main)
