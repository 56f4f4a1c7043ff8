"""Tables and figure of yade_increments.py."""
import math
import statistics

import numpy as np

from harness import bars, pyplot, verdict

COLUMNS = (("state", 11), ("mode", 5), ("error", 5), ("of", 11), ("steps and settings", 27), ("its error", 9),
           ("ms, restored", 24), ("ms, going on", 26), ("times, restored", 19), ("times, going on", 19))

judged = []  # rows of print_state that verdicts() takes
NUMBERED = ("YADE", "tolerance", "one setting", "settings")  # points of a target, as choice() gives them


def line(*cells):
    print("  ".join(f"{cell!s:{width}s}" for cell, (_, width) in zip(cells, COLUMNS)).rstrip(), flush=True)


def spread(values):
    """Median (least to most)."""
    return f"{statistics.median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


def words(point):
    if "steps" in point:
        return f"{point['steps']}+{point['after']}, a {point['damping']:g}, t {point['time_step']:g}"
    fine = "" if "fixed_substeps" in point else f", r {point['relative_tolerance']:.2g}"
    more = f", a {point['damping']:g}, t {point['time_step']:g}" if "damping" in point else ""
    return f"{point['substeps']}{fine}{more}"


def print_head(rounds):
    print(f"one increment of 1e-4, medians of {rounds} rounds (least to most), processor ms of stepping\n"
          "steps: YADE's in and after the increment, rvelab's sub-steps; a: damping; t: time step over PWave, over the "
          "critical one;\nr: relative tolerance.\ntolerance: nothing else set; one setting: the same damping and time step in all "
          "cases; settings: the best of all.\nrestored: from a copy of the state, YADE by O.run; going on: what only the "
          "first step or call after that does is done before,\nYADE by O.step\n")
    line(*(name for name, _ in COLUMNS))


def print_state(name, modes, chosen, times):
    for mode, rows in enumerate(chosen):
        for target, *points in rows:
            theirs = times.get((mode, target, 0))
            for number, point in enumerate(points):
                head = (name, modes[mode], f"{100 * target:g} %", NUMBERED[number])
                if point is None:
                    line(*head, "not reached")
                    continue
                own = times[mode, target, number]
                ratios = [spread([their[k] / ms[k] for their, ms in zip(theirs, own)]) for k in (0, 1)] \
                    if number and theirs else []
                ms_of_rounds = [spread([ms[k] for ms in own]) for k in (0, 1)]
                line(*head, words(point), f"{100 * point['error']:.2g} %", *ms_of_rounds, *ratios)
                if head[3] in ("YADE", "settings"):
                    judged.append((f"{name}, {modes[mode]}, {head[2]}", head[3], words(point), statistics.median(ms for ms, _ in own)))


@bars
def verdicts(rows):
    """rows: (case, whose, steps, restored ms) of YADE and of the best settings. Where both make as many steps the ratio of their times is
    that of a step; the best settings need no more steps than YADE, so that this ratio is the least that is asked."""
    def steps_of(words):
        return sum(map(int, words.split(",")[0].split("+")))

    # Of the rows of most steps, where what a call costs beside its steps is nothing.
    longest = {whose: max((row for row in rows if row[1] == whose), key=lambda row: steps_of(row[2])) for whose in ("YADE", "settings")}
    step = {whose: row[3] / steps_of(row[2]) for whose, row in longest.items()}
    least = step["YADE"] / step["settings"]
    print(f"\na step: YADE {1e3 * step['YADE']:.0f} us, rvelab {1e3 * step['settings']:.1f} us (of {steps_of(longest['YADE'][2])} and "
          f"{steps_of(longest['settings'][2])}): {least:.0f} times\n")
    of_yade = {row[0]: row for row in rows if row[1] == "YADE"}
    for case, whose, words, ms in rows:
        if whose == "YADE":
            continue
        ratio, each = of_yade[case][3] / ms, ms / steps_of(words)
        verdict(f"{case}: YADE's time over rvelab's, restored", f"{ratio:.1f}", f"{least:.0f} and more", ratio >= least,
                each > 1.5 * step["settings"] and ", r " in words,
                f"a start to a tolerance is measured on a copy: {1e3 * each:.0f} us for each of the {steps_of(words)} sub-steps that are counted")


def print_agreement(results):
    print("\nhow far the programs are apart: start states (Pa), resolved answers (over the stress increment); what 3,000 "
          "steps change\nof the answers of 10,000; error of YADE's coupling as shipped; rvelab at its default tolerances: "
          "sub-steps, error, ms (restored)")
    print("state        mode      start  resolved      YADE    rvelab  coupling  sub-steps   error      ms")
    for name, modes in results.items():
        for mode, (theirs, ours) in modes.items():
            coupled = next(point for point in theirs["points"] if point["kind"] == "coupling")
            default = next(point for point in ours["points"] if point["kind"] == "default")
            apart = float(np.linalg.norm(theirs["reference"] - ours["reference"])) / theirs["change"]
            print(f"{name:11s}  {mode:5s}  {np.linalg.norm(theirs['start'] - ours['start']):8.1e}  {apart:8.1e}  "
                  f"{theirs['open']:8.1e}  {ours['open']:8.1e}  {100 * coupled['error']:6.3g} %  {default['substeps']:9d}  "
                  f"{100 * default['error']:4.2g} %  {default['ms']:6.3f}")


def print_prices(results):
    """What a call costs beside stepping."""
    name, modes = next(iter(results.items()))
    theirs, ours = next(iter(modes.values()))
    print(f"\na call from a copy of the state, {name}: processor ms, elapsed ms (medians)\nYADE's FEMxDEM coupling")
    whole = [0.0, 0.0]
    for part in theirs["coupling"][0]:
        both = [1e3 * statistics.median(call[part][k] for call in theirs["coupling"]) for k in (0, 1)]
        whole = [whole[k] + both[k] for k in (0, 1)]
        print(f"  {part:32s} {both[0]:8.2f} {both[1]:8.2f}")
    print(f"  {'all':32s} {whole[0]:8.2f} {whole[1]:8.2f}")
    default = next(point for point in ours["points"] if point["kind"] == "default")
    print("rvelab (no call waits)")
    save, restore = (1e3 * statistics.median(ours["beside"][part]) for part in ("save", "restore"))
    for part, ms in (("state from its snapshot", restore), (f"apply, {default['substeps']} sub-steps, stress", default["ms"]),
                     ("snapshot of the state", save), ("all", restore + default["ms"] + save)):
        print(f"  {part:32s} {ms:8.3f}")


def front(points):
    found, least = [], math.inf
    for point in sorted(points, key=lambda p: p["ms"]):
        if point["error"] < least:
            least = point["error"]
            found.append((point["ms"], point["error"]))
    return found


def draw(results, targets, path):
    plt = pyplot()
    modes = list(next(iter(results.values())))
    figure, axes = plt.subplots(len(modes), len(results), figsize=(3.4 * len(results) + 0.6, 6), sharex=True, sharey=True,
                                squeeze=False)
    for column, (name, of_state) in zip(axes.T, results.items()):
        for panel, (mode, (theirs, ours)) in zip(column, of_state.items()):
            for points, kind, color, label in ((theirs, "YADE", "C1", "YADE"),
                                               (ours, "settings", "C2", "rvelab, all settings"),
                                               (ours, "tolerance", "C0", "rvelab, tolerance alone")):
                points = [point for point in points["points"] if point["kind"] == kind]
                panel.plot([p["ms"] for p in points], [p["error"] for p in points], ".", color=color, alpha=0.2,
                           markersize=2, zorder=1)
                panel.plot(*zip(*front(points)), color=color, linewidth=1.5, label=label)
            for target in targets:
                panel.axhline(target, color="0.7", linewidth=0.8, zorder=0)
            panel.set(xscale="log", yscale="log", ylim=(1e-4, 1.5), title=f"{name}, {mode}")
            panel.title.set_fontsize(10)
    axes[0][0].legend(fontsize=8)
    for panel in axes[-1]:
        panel.set_xlabel("processor time of an increment, ms")
    for panel in axes[:, 0]:
        panel.set_ylabel("error of the stress increment")
    figure.tight_layout()
    figure.savefig(path, dpi=100)
