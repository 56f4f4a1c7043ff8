"""The table, the numbers and the picture of tools/bench/benchmark."""
import csv
import os
import re
from dataclasses import dataclass

from case import CaseError

TARGETS = (0.01, 0.001)
# Colours that are told apart by colour-blind people (Okabe and Ito), each with a marker of its own.
LOOKS = {"rvelab": ("#0072B2", "o"), "rvelab, u given": ("#56B4E9", "o"), "LAMMPS": ("#D55E00", "s"), "YADE": ("#009E73", "^"), "LIGGGHTS": ("#CC79A7", "D")}
OTHERS = (("#000000", "v"), ("#E69F00", "P"), ("#F0E442", "X"))


@dataclass
class Point:
    case: str
    code: str
    setting: str
    seconds: float
    error: float
    volume_error: float | None
    version: str = ""


HEAD = ["case", "code", "version", "setting", "processor_s", "error", "volume_error", "bar"]


def line(point):
    more = "" if point.volume_error is None else f" | volume {point.volume_error:.1e}"
    return f"{point.case} | {point.code} | {point.setting} | {point.seconds:.3g} s | error {point.error:.1e}{more}"


def cheapest(points, target):
    """The cheapest point from which on all finer ones are within the target: no chance hit counts. Points in order."""
    best = None
    for point in reversed(points):
        if point.error > target:
            break
        if best is None or point.seconds < best.seconds:
            best = point
    return best


class Result:
    def __init__(self, codes, rounds):
        self.codes, self.rounds = codes, rounds
        self.cases, self.points, self.lacks, self.added = [], [], {}, False

    def add(self, path, names):
        """Points of an earlier run of the cases of these names."""
        try:
            with open(path, encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
            if not rows or list(rows[0]) != HEAD:
                raise ValueError(f"the first line must be {','.join(HEAD)}, points below it")
            found = [Point(row["case"], row["code"], row["setting"], float(row["processor_s"]), float(row["error"]),
                           float(row["volume_error"]) if row["volume_error"] else None, row["version"]) for row in rows]
        except (OSError, ValueError, TypeError) as error:
            raise CaseError(f"{path}: {error}; it must be a benchmark.csv of this program") from None
        known = {(p.case, p.code) for p in self.points}
        for point in found:
            if point.case in names and (point.case, point.code) not in known:
                self.points.append(point)
                self.added = True
                if point.code not in self.codes:
                    self.codes.append(point.code)
        order = [code for code in LOOKS if code in self.codes]
        self.codes = order + [code for code in self.codes if code not in order]

    def start(self, case, reference):
        self.cases.append((case, reference))

    def of(self, case, code):
        return [p for p in self.points if p.case == case.name and p.code == code]

    def in_order(self):
        return [p for case, _ in self.cases for code in self.codes for p in self.of(case, code)]

    def write(self, folder):
        with open(os.path.join(folder, "benchmark.csv"), "w", encoding="utf-8", newline="") as out:
            table = csv.writer(out, lineterminator="\n")
            table.writerow(HEAD)
            bars = {case.name: reference.bar() for case, reference in self.cases}
            for p in self.in_order():
                table.writerow([p.case, p.code, p.version, p.setting, f"{p.seconds:.4g}", f"{p.error:.3e}",
                                "" if p.volume_error is None else f"{p.volume_error:.3e}", f"{bars[p.case]:.2e}"])
        with open(os.path.join(folder, "benchmark.md"), "w", encoding="utf-8") as out:
            out.write("\n".join(self.text()) + "\n")
        self.draw(os.path.join(folder, "benchmark.png"))
        print(f"written to {os.path.join(folder, 'benchmark')}.md, .csv, .png")

    def text(self):
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            model = re.search(r"model name\s*: (.*)", file.read())
        versions = dict.fromkeys(p.version for p in self.in_order())
        yield (f"{', '.join(versions)}. Made by tools/bench/benchmark on {model.group(1) if model else 'an unknown processor'}, "
               f"{len(os.sched_getaffinity(0))} cores, shared machine, one core used; processor times of stepping, medians of "
               f"{self.rounds} round{'s' if self.rounds > 1 else ''}." + (" Points of earlier runs were added." if self.added else ""))
        yield "Seconds to an error: the cheapest setting from which on all finer ones are within it; in brackets times that of the first code."
        if "LIGGGHTS" in self.codes:
            yield "LIGGGHTS prints no processor times: they are differences of two processes, and of no worth below 0.01 s."
        yield ""
        yield "| case | grains | bar | error | " + " | ".join(self.codes) + " |"
        yield "| --- " * (4 + len(self.codes)) + "|"
        for case, reference in self.cases:
            targets = [(max(target, reference.bar()), target) for target in TARGETS]
            if case.windows:  # no error below chance can be seen
                targets = [(3 * reference.bar(), 0)]
            for limit, target in targets:
                first, words = None, []
                for code in self.codes:
                    best = cheapest(self.of(case, code), limit)
                    if (case.name, code) in self.lacks:
                        words.append("not run")
                    elif not self.of(case, code):  # points that were added are of other cases
                        words.append("-")
                    elif best is None:
                        words.append(f"not reached ({min(p.error for p in self.of(case, code)):.1e})")
                    else:
                        first = best.seconds if code == self.codes[0] else first
                        times = f" ({best.seconds / first:.2g})" if first and code != self.codes[0] else ""
                        words.append(f"{best.seconds:.3g}{times}")
                grains = " + ".join(str(len(s.grains)) for s in case.specimens)
                wanted = f"{target:g}" if target else "three times the bar"
                yield f"| {case.name} | {grains} | {reference.bar():.1e} | {wanted} | " + " | ".join(words) + " |"
        if self.lacks:
            yield ""
            yield "Not run:"
            yield ""
            for (name, code), why in self.lacks.items():
                yield f"- {name}, {code}: {why}."
        for case, reference in self.cases:
            yield ""
            yield f"## {case.title}"
            yield ""
            yield f"{case.name}. {case.sentence} Bar of the reference {reference.bar():.1e}."
            yield ""
            volume = any(p.volume_error is not None for p in self.points if p.case == case.name)
            yield "| code | setting | processor time, s | error |" + (" error of the volumetric strain |" if volume else "")
            yield "| --- | --- | --- | --- |" + (" --- |" if volume else "")
            for p in self.in_order():
                if p.case == case.name:
                    yield f"| {p.code} | {p.setting} | {p.seconds:.3g} | {p.error:.1e} |" + (f" {p.volume_error:.1e} |" if volume else "")

    def draw(self, path):
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        looks = dict(LOOKS)
        for name, look in zip([code for code in self.codes if code not in LOOKS], OTHERS):
            looks[name] = look
        columns = min(2, len(self.cases))
        rows = -(-len(self.cases) // columns)
        height = 2.7 * rows + 0.6
        figure, axes = plt.subplots(rows, columns, figsize=(5.2 * columns, height), squeeze=False, layout="constrained")
        figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 0.35 * -(-len(self.codes) // 3) / height))
        times = [p.seconds for p in self.points] or [1]
        for axis in axes.flat[len(self.cases):]:
            axis.set_visible(False)
        for axis, (case, reference) in zip(axes.flat, self.cases):
            axis.set_xscale("log")
            axis.set_yscale("log")
            errors = [p.error for p in self.points if p.case == case.name]
            low = min([reference.bar(), *errors]) / 2
            axis.axhspan(low / 100, reference.bar(), color="0.88", lw=0)
            for code in self.codes:
                points = self.of(case, code)
                colour, marker = looks.get(code, ("0.3", "*"))
                axis.plot([p.seconds for p in points], [p.error for p in points], color=colour, marker=marker, ms=4.5, lw=1.2)
            axis.set_ylim(low, max([reference.bar(), *errors]) * 2)
            axis.set_xlim(min(times) / 1.5, max(times) * 1.5)
            axis.set_title(case.title, fontsize=8.5)
            axis.grid(True, which="major", color="0.92", lw=0.6)
            axis.tick_params(labelsize=8)
        for axis in axes[:, 0]:
            axis.set_ylabel("error of the stress", fontsize=8.5)
        for axis in axes.flat[max(len(self.cases) - columns, 0):len(self.cases)]:
            axis.set_xlabel("processor time, s", fontsize=8.5)
        lines = [plt.Line2D([], [], color=looks.get(code, ("0.3", "*"))[0], marker=looks.get(code, ("0.3", "*"))[1], ms=4.5)
                 for code in self.codes] + [plt.Rectangle((0, 0), 1, 1, color="0.88")]
        figure.legend(lines, [*self.codes, "within the bar of the reference"], loc="upper center", ncols=3 * columns - 1, fontsize=8.5,
                      frameon=False)
        figure.savefig(path, dpi=110, metadata={"Software": None})
        plt.close(figure)
