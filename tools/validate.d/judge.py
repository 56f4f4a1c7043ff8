"""Verdicts of kept tables by the bars of today, without making their runs again.

    judge.py RVELAB FOLDER RESULTS TABLE...     # mpm_fluid_scenes, mpm_shaking, mpm_pipe, steady_state, pieces, yade_increments

What a table measured is read from its rows as they were printed, and judged by the functions that judge a new run; runs that
isolate a cause are made, or found in FOLDER. The rows of a group are written again where its first one stood, and the third line
of the table says so. (thin.py --kept does it for thin.txt.)"""

import contextlib
import io
import re

import mpm_fluid_soils as soils
import mpm_fluid_waves as waves
import mpm_scenes
import steady_state
from mpm import ROOT, cases, folder, results

NOTE = "# verdicts of {}: by the present bars, from the figures that the runs printed (judge.py)"


class Table:
    def __init__(self, name):
        self.path = results / f"{name}.txt"
        self.lines, self.judged = self.path.read_text().splitlines(), []

    def found(self, what):
        """Numbers of the found column of a row."""
        line = next(line for line in self.lines if line.startswith(what))
        numbers = re.match(r"\s*(-?[\d.]+(?:e-?\d+)?(?:, -?[\d.]+(?:e-?\d+)?)*)", line[len(what):])
        return [float(each) for each in numbers[1].split(",")]

    def replace(self, whats, judge, *figures):
        """The rows that begin so, and what is indented below them, by what judge(*figures) prints."""
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            judge(*figures)
        kept, first, skipping = [], None, False
        for line in self.lines:
            old = any(line.startswith(what) for what in whats)
            skipping = old or (skipping and line.startswith("    "))
            if not old and not skipping:
                kept.append(line)
            elif first is None:
                first = len(kept)
        self.lines = kept[:first] + printed.getvalue().rstrip("\n").splitlines() + kept[first:]

    def write(self, what):
        head = [line for line in self.lines if not line.startswith("# verdicts of")]
        text = "\n".join([*head[:2], NOTE.format(what), *head[2:]])
        missed = [line for line in self.lines if line.endswith(" MISSED")]
        different = sum(line.endswith(" DIFFERS") for line in self.lines)
        text = re.sub(r"\n\d+ missed[^\n]*$", f"\n{len(missed)} missed"
                      + (": " + "; ".join(re.split(r"  +", line)[0] for line in missed) if missed else "")
                      + f"; {different} differ from their source, with the cause", text)
        self.path.write_text(re.sub(r"\n{3,}", "\n\n", text).rstrip("\n") + "\n")


def mpm_fluid_scenes():
    table = Table("mpm_fluid_scenes")
    what = "column: "
    names = ["mean excess pressure at 0.06 s, dense, medium, loose (Pa)",
             "the pore pressure itself (the cut face loses that of rest too)", "front beyond 1 m at 0.5 s, dry",
             "the same, dense, medium, loose", "peak of E_k over the dry one, dense, medium, loose"]
    excess, water, (dry,), fronts, peaks = (table.found(what + name) for name in names)

    def columns():
        soils.column_bars(excess, water, dry, fronts, peaks, soils.column_causes())

    table.replace(["column: ", "Mohr-Coulomb soil of"], columns)
    packings = list(waves.PACKINGS)
    near = {case: table.found(f"wave, {case}: speed of the fronts over that of Rayleigh, right and left") for case in packings}
    elastic = table.found("wave: elastic soil, moduli of the isotropic packing: the same ratio")[0]
    table.replace([f"wave, {case}: speed of the fronts" for case in packings], waves.near_bars, near, elastic)
    kinds = ("0 degrees", "30 degrees", "isotropic")
    try:
        sides = [table.found(f"wave: right over left of u_x, {each}")[0] for each in kinds]
    except StopIteration:  # judged before
        sides = [table.found(f"wave: right over left of u_x, {kinds[0]}")[0], table.found("    30 degrees:")[0],
                 table.found(f"wave: right over left of u_x, {kinds[2]}")[0]]
    table.replace(["wave: right over left of u_x", "    30 degrees:"], waves.sides_bars, *sides)
    what = "wave, 44 x 20 m: amplitudes of u_x on the surface, right over left,"
    far = [table.found(f"{what} {each}")[0] for each in kinds]

    def far_and_near():
        waves.far_bars(*far)
        waves.inclined_bar(sides[1], far[1])

    table.replace([what, "wave, 21 x 10 m: right over left"], far_and_near)
    table.write("the column, the waves")


def mpm_shaking():
    table = Table("mpm_shaking")
    seeds = [int(each) for each in re.findall(r"^shaking, seed (\d+): onset", "\n".join(table.lines), re.M)]
    onsets = [table.found(f"shaking, seed {seed}: onset at A, B, C, medium (s)") for seed in seeds]
    for seed, onset in zip(seeds, onsets):
        table.replace([f"shaking, seed {seed}: onset"], soils.onset_bar, seed, onset)
    last = max(k for k, line in enumerate(table.lines) if line.startswith("shaking, seed"))
    table.lines.insert(last + 1, "shaking: onset at B")
    table.replace(["shaking: onset at B"], soils.onset_bars, onsets)
    table.write("the onset")


def mpm_pipe():
    table = Table("mpm_pipe")
    found = [table.found(what)[0] for what in ("vertical peak", "vertical, sideways", "horizontal plateau")]
    table.replace(["vertical peak", "vertical, sideways", "horizontal plateau"], mpm_scenes.pipe_bars, *found)
    table.write("the forces")


def large_shear():
    """Rows of porosity 0.282: deviation, allowed and verdict."""
    table = Table("steady_state")
    for k, line in enumerate(table.lines):
        if not line.startswith("n282"):
            continue
        case, quantity, *numbers = line.split()
        mean, own, expected, se = map(float, numbers[:4])
        error = (own**2 + se**2)**0.5
        table.lines[k] = steady_state.row_of(case, quantity, mean, own, expected, se,
                                             steady_state.allowed(steady_state.CASES[case][1], expected, error))[0]
    table.write("porosity 0.282")


def yade_increments():
    """The best settings beside YADE, from the rows as they were printed; the verdicts stand at the end."""
    import yade_increments_report as report
    table = Table("yade_increments")
    end = next((k for k, line in enumerate(table.lines) if line.startswith("a step: ")), len(table.lines))
    table.lines = table.lines[:end]
    for line in table.lines:
        words = re.split(r"  +", line)
        if len(words) > 6 and words[3] in ("YADE", "settings") and words[2].endswith("%"):
            report.judged.append((", ".join(words[:3]), words[3], words[4], float(words[6].split()[0])))
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        report.verdicts(report.judged)
    table.lines += printed.getvalue().rstrip("\n").splitlines()
    table.write("the best settings")


def pieces():
    """Time ratio and its bar, then error, standard error and tolerance of each quarter, by the constant of pieces.cpp."""
    table = Table("pieces")
    by_chance = float(re.search(r"by_chance = ([\d.]+);", (ROOT / "tools/validate.d/pieces.cpp").read_text())[1])
    for k, line in enumerate(table.lines):
        if not line.endswith((" met", " MISSED")):
            continue
        ratio, bar, *quarters = map(float, line.split()[-15:-1])
        met = ratio <= bar and all(error <= allowed + by_chance * scatter
                                   for error, scatter, allowed in zip(quarters[::3], quarters[1::3], quarters[2::3]))
        table.lines[k] = re.sub(r"(met|MISSED)$", "met" if met else "MISSED", line)
    table.write("the means")


def main():
    folder.mkdir(parents=True, exist_ok=True)
    for name in cases:
        {"mpm_fluid_scenes": mpm_fluid_scenes, "mpm_shaking": mpm_shaking, "mpm_pipe": mpm_pipe,
         "steady_state": large_shear, "pieces": pieces,
         "yade_increments": yade_increments}[name]()


if __name__ == "__main__":
    main()
