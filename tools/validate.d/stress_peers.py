"""The cases of tests/extreme, and put to LAMMPS where LAMMPS can express them.

Both are judged by the case's own criterion and tolerance. LAMMPS knows no step of its own: it gets what its users take,
a fiftieth of the duration of a collision (linear: pi sqrt(m*/kn), Hertz: 2.943 overlap/speed of the impact), and beside
it a twentieth. Linear contacts have the exact dashpot of the restitution, Hertz contacts `damping tsuji`. Where a
refusal is asked for and LAMMPS has no such check, the column says what happens. "-": cannot be expressed. Cases
at small fixed steps (resolved) ask whether the criterion is one, and are no question to LAMMPS.

    stress_peers.py RVELAB WORK RESULTS             # runs them first, long
    stress_peers.py RVELAB WORK RESULTS --json FILE # reuses what test_extreme wrote (RVELAB_JSON)
    stress_peers.py RVELAB WORK RESULTS --case impact
"""
import argparse
import collections
import concurrent.futures
import copy
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

import harness
import stress_lammps as grains
import stress_lammps_boxes as boxes

# experiment: what puts it to LAMMPS, and defaults of parameters (tests/extreme/*.cpp)
IMPACT = {"dimension": 3, "hertz": 0, "speed": 0.1, "phases": 20}
EXPERIMENTS = {
    "impact/rebound": (grains.rebound, IMPACT),
    "impact/restitution": (grains.restitution, {**IMPACT, "restitution": 0.5}),
    "impact/third_contact": (grains.third_contact, {"hertz": 0, "restitution": 0.5, "phases": 50}),
    "impact/too_hard": (grains.too_hard, {"dimension": 3, "hertz": 1, "overlap_over_limit": 2}),
    "gas/energy": (grains.gas_energy, {"dimension": 2, "hertz": 0, "grains": 100, "collisions": 100}),
    "gas/haff": (grains.gas_cools, {"dimension": 2, "hertz": 0, "grains": 256, "gases": 16, "solid_fraction": 0.1,
                                    "restitution": 0.9, "duration": 3, "contact_time": 3e-3}),
    "deformation/compression": (boxes.compressed, {"dimension": 2, "hertz": 0}),
    "deformation/one_increment": (boxes.one_increment, {"dimension": 2, "compression": 0, "hertz": 0}),
    "size/million": (boxes.crystal, {"side": 100}),
    "numbers/units": (boxes.units, {"dimension": 2, "hertz": 0, "length_power": 0, "force_power": 0}),
    "numbers/length": (boxes.lengths, {"dimension": 2, "hertz": 0, "radius": 1e-6}),
    "numbers/no_increment": (boxes.no_increment, {"dimension": 2, "kind": 0}),
}


class Case:
    """One case of the matrix by its full name, .../parameter=value,..."""

    def __init__(self, name, table, gases):
        head, _, varied = name.rpartition("/") if "=" in name.rpartition("/")[2] else (name, "", "")
        one = table[head]
        self.run, defaults = EXPERIMENTS.get(one["experiment"], (None, {}))
        self.tolerance, self.damping = one["tolerance"], "tsuji"
        self.values = {**defaults, **one.get("with", {})}
        self.values.update(pair.split("=") for pair in varied.split(",") if pair)
        if {"time_step_factor", "no_tension", "spread"} & set(self.values):
            self.run = None
        if one["experiment"] == "gas/haff":
            self.values["gases"] = min(gases, int(self.values["gases"]))
            self.run = self.run if gases else None

    def __call__(self, parameter):
        return float(self.values[parameter])

    def lammps(self, n, newer):
        """What becomes of it; newer: a second answer with LAMMPS' later damping where restitution is in question."""
        text = self.answer(n, "tsuji")
        if newer and self.values.get("hertz") and float(self.values.get("restitution", 1)) < 1 and text != "-":
            text += f"; coeff_restitution: {self.answer(n, 'coeff_restitution')}"
        return text

    def answer(self, n, damping):
        if not self.run:
            return "-"
        asked = copy.copy(self)  # both steps may be under way at a time
        asked.damping = damping
        with tempfile.TemporaryDirectory() as folder:
            try:
                answer = asked.run(asked, n, folder)
            except grains.Failed as failed:
                return f"WRONG {failed}"
        return answer.text() if answer else "-"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", help="what the tests wrote before")
    parser.add_argument("--case", action="append", default=[], help="only cases whose names begin so")
    parser.add_argument("--gases", type=int, default=4, help="at most so many cool in LAMMPS, a minute each; 0: none")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    return parser.parse_args(harness.words)


def answers(options):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(options.json or folder + "/answers.json")
        if not options.json:  # whether some are WRONG the table says
            subprocess.run([harness.program.with_name("test_extreme"), "the matrix"], stdout=subprocess.DEVNULL,
                           env={**os.environ, "RVELAB_CASES": " ".join(options.case) or "all",
                                "RVELAB_JOBS": str(options.jobs), "RVELAB_JSON": str(file)})
        if not file.exists():
            sys.exit("stress_peers: the cases did not run")
        cases = json.loads(file.read_text())["cases"]
    return [case for case in cases if not options.case or case["name"].startswith(tuple(options.case))]


def version():
    text = harness.run("lmp", "-h", codes=None).stdout
    return re.search(r"Simulator - (.*)", text).group(1).strip()


def count(texts):
    found = collections.Counter(text.split()[0].strip(":") for text in texts)
    return ", ".join(f"{found[word]} {word}" for word in ("right", "refused", "WRONG"))


def main():
    options = arguments()
    rows = answers(options)
    with open(harness.ROOT / "tests/extreme/matrix.toml", "rb") as file:
        table = {one["name"]: {**series, **one} for series in tomllib.load(file)["series"] for one in series["case"]}
    cases = [Case(row["name"], table, options.gases) for row in rows]
    with tempfile.TemporaryDirectory() as folder:
        if not grains.has_damping("tsuji", folder):
            sys.exit("stress_peers: LAMMPS does not run, or lacks pair_style granular")
        newer = grains.has_damping("coeff_restitution", folder)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        fiftieth, twentieth = (pool.map(lambda case, n=n: case.lammps(n, newer), cases) for n in (50, 20))
        peers = list(zip(fiftieth, twentieth))
    head = ["case", "asked", "outcome", "seconds", "error", "LAMMPS", "at a twentieth"]
    lines = [[row["name"], row["asked"], row["outcome"], f"{row['seconds']:.2f}",
              "-" if row.get("error") is None else f"{row['error']:.3g}", *peer] for row, peer in zip(rows, peers)]
    damping = "tsuji and coeff_restitution" if newer else "tsuji, this version has no coeff_restitution"
    print(f"# LAMMPS {version()}, steps of a fiftieth of a collision, and of a twentieth; Hertz damping: {damping}")
    cooled = f"of {options.gases} gases at most, +- their statistical error" if options.gases else "not put to LAMMPS"
    print(f"# error: measured over allowed, both programs; cooling (gas/haff...): {cooled}")
    widths = [max(len(line[k]) for line in [head, *lines]) for k in range(len(head))]
    for line in [head, *lines]:
        print("  ".join(word.ljust(width) for word, width in zip(line, widths)).rstrip())
    put = [peer for peer in peers if peer[0] != "-"]
    print(f"\nrvelab: {len(rows)} cases: {count(line[2] for line in lines)}")
    both = [line[2] for line, peer in zip(lines, peers) if peer[0] != "-"]
    print(f"of the {len(put)} put to LAMMPS: rvelab {count(both)}; LAMMPS {count(p[0] for p in put)}; "
          f"at a twentieth {count(p[1] for p in put)}")


if __name__ == "__main__":
    harness.main(main)
