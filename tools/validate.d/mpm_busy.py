"""tools/validate mpm_busy: one thread and as many as there are cores, on the machine as it is and beside busy loops.

    mpm_busy.py RVELAB WORK RESULTS

The beginnings of three scenes: soil with rocks, shaken saturated grains, a footing on grains. Beside as many busy loops as
cores threads must not take longer than 1.3 times one thread. Runs with one and more threads take turns; the ratio is the
median of those of the turns, so that what else the machine does meets both. The same bits in all."""

import os
import shutil
import statistics
import subprocess
import time

import harness
from harness import PROTOCOLS, mpm, packed, sets, work

CORES = len(os.sched_getaffinity(0))
TURNS, ASKED = 3, 1.3
SCENES = {  # name: file, end (s)
    "soil with rocks": ("soil_rock_triaxial", "0.0007"),
    "shaken box": ("shaking", "0.04"),
    "footing": ("footing", "0.1"),
}


def run(scene, threads):
    """Wall and processor time (s), and the history."""
    file, end = SCENES[scene]
    shutil.rmtree(work / "run", ignore_errors=True)
    begin, before = time.perf_counter(), os.times()
    harness.run(mpm, PROTOCOLS / f"mpm/{file}.toml", "-o", work / "run", "-q", "-j", threads, "--specimens", work,
                *sets(f"time.duration_s={end}", f"output.history_every_s={end}"))
    after = os.times()
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return time.perf_counter() - begin, used, (work / "run/history.csv").read_bytes()


def turns(scene, loops):
    """Of one thread and of all, beside so many busy loops: medians of wall and processor time, of the ratio; same bits."""
    others = [subprocess.Popen(["sh", "-c", "while :; do :; done"]) for _ in range(loops)]
    try:
        pairs = [[run(scene, threads) for threads in (1, CORES)] for _ in range(TURNS)]
    finally:
        for other in others:
            other.kill()
            other.wait()
    wall = [statistics.median(pair[k][0] for pair in pairs) for k in (0, 1)]
    used = [statistics.median(pair[k][1] for pair in pairs) for k in (0, 1)]
    ratios = [pair[1][0] / pair[0][0] for pair in pairs]
    return wall, used, ratios, len({each[2] for pair in pairs for each in pair}) == 1


def main():
    # Small specimens: threads share grains by the cell, so that a hundred are enough.
    for recipe, name in (("pack_dense", "dense"), ("pack_saturated", "medium")):
        packed(recipe, name, "pack.number=100", "solver.max_overlap_ratio=0.5")
    print(f"{'scene':<16} {'beside':>8}   wall time, s: 1 and {CORES} threads   processor time, s   ratio of wall times (all turns)")
    for scene in SCENES:
        for loops in (0, CORES):
            wall, used, ratios, same = turns(scene, loops)
            ratio = statistics.median(ratios)
            asked = "OTHER BITS" if not same else "" if loops == 0 else f"at most {ASKED}:"
            harness.row(f"{scene:<16} {loops:>2} loops   {wall[0]:>12.2f} {wall[1]:>12.2f} {used[0]:>17.2f} {used[1]:>6.2f}"
                        f"   {ratio:>6.2f} ({' '.join(f'{each:.2f}' for each in sorted(ratios))}) {asked}",
                        same and (loops == 0 or ratio <= ASKED), good="met" if loops else "")


if __name__ == "__main__":
    harness.main(main)
