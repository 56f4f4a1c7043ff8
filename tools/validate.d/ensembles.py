"""Tests by the dozen: ensembles.py PROGRAM WORK RESULTS [SPECIMENS]

1. So many specimens (20) of each recipe of Liang and Zhao (2019, table 2), tested biaxially at 10, 15, 20, 25 and 30 kPa: the
   friction angle over the five pressures and N_q, mean +- standard error, beside the paper's angle (of one specimen) and the mean
   of repeated tests on one packing of YADE (where ../shared/reference is there). A packing of YADE is one specimen: the standard
   error of the difference holds the scatter of specimens once for it, and the scatter of its repeats.
2. 15 specimens at three pressures by one command: wall time beside the processor time of the tests over the cores. Other work
   on the machine shows here.
3. The same command killed at random and resumed until it is done: byte by byte the summary of the run that nobody killed.
"""

import json
import math
import os
import random
import resource
import shutil
import signal
import statistics
import subprocess
import time

import harness
from harness import REFERENCE, mean_error, once, program, run, work

count = int(harness.words[0]) if harness.words else 20
PAPER = {"dense": 28.1, "medium": 20.8, "soft": 18.2}
PRESSURES = (10e3, 15e3, 20e3, 25e3, 30e3)


def yade():
    path = REFERENCE / "yade/paths/biaxial_scatter.json"
    if not path.exists():
        return {}
    return {name: each["phi_origin_deg"] for name, each in json.loads(path.read_text())["packings"].items()}


def packed(recipe, number):
    def make(first):
        harness.rvelab("pack", f"pack_{recipe}", "--count", number, "-o", first.with_name(f"{recipe}.h5"), "--force")

    once(work / f"{recipe}_01.h5", recipe, number, make=make)
    return sorted(work.glob(f"{recipe}_*.h5"))[:number]


def command(files, pressures, out, *more):
    words = [program, "calibrate", "biaxial", "--every-pressure", "--pressures", ",".join(f"{p:g}" for p in pressures),
             "-o", str(out), *more]
    for each in files:
        words += ["--specimen", str(each)]
    return words


def strengths():
    """Prints the table; how many bars were missed."""
    missed, reference = 0, yade()
    print(f"{count} specimens of each recipe, biaxial at 10 to 30 kPa: mean +- standard error (standard deviation)")
    print("recipe  friction angle, deg     large strain, deg       N_q                   paper   YADE          differs by")
    for recipe, published in PAPER.items():
        answer = run(*command(packed(recipe, count), PRESSURES, work / f"C_{recipe}", "--json", "--force"))
        found = json.loads((work / f"C_{recipe}" / "summary.json").read_text())
        result = json.loads(answer.stdout)
        large = statistics.mean(each["large_strain_friction_angle_deg"] for each in found["tests"])
        by_specimen = {}
        for each in found["tests"]:
            by_specimen.setdefault(each["specimen"], []).append(each["large_strain_friction_angle_deg"])
        large_error = mean_error([statistics.mean(each) for each in by_specimen.values()])[1]
        mean, deviation = (result[f"friction_angle_{what}_deg"] for what in ("mean", "standard_deviation"))
        line = (f"{recipe:7s} {mean:5.2f} +- {deviation / math.sqrt(count):4.2f} ({deviation:4.2f})    {large:5.2f} +- {large_error:4.2f}"
                f"           {result['bearing_capacity_Nq_mean']:5.2f} +- {result['bearing_capacity_Nq_standard_error']:4.2f}"
                f"         {published:5.1f}")
        if recipe in reference:
            peer = reference[recipe]
            error = math.sqrt(deviation**2 * (1 + 1 / count) + peer["sd"] ** 2 / peer["n"])
            apart = (mean - peer["mean"]) / error
            missed += recipe != "dense" and abs(apart) > 2
            line += f"   {peer['mean']:5.2f} +- {peer['sd'] / math.sqrt(peer['n']):4.2f}  {apart:+.1f} standard errors"
        print(line, flush=True)
    return missed


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def one_command():
    files, out, cores = packed("medium", 15), work / "whole", os.cpu_count()
    begun, before = time.monotonic(), processor_seconds()
    run(*command(files, PRESSURES[::2], out, "--force"))
    wall, spent = time.monotonic() - begun, (processor_seconds() - before) / cores
    print(f"45 tests by one command: {wall:.1f} s, processor time of the tests over {cores} cores {spent:.1f} s: "
          f"{100 * (wall / spent - 1):+.1f} % (5 allowed, on a machine without other work)", flush=True)
    return (out / "summary.json").read_bytes(), wall


def killed(expected, wall, rounds=3):
    """The same summary, whenever it was killed."""
    rng, wrong, kills = random.Random(1), 0, 0
    for number in range(rounds):
        out = work / f"killed_{number}"
        shutil.rmtree(out, ignore_errors=True)
        words = command(packed("medium", 15), PRESSURES[::2], out, "--resume")
        while True:
            running = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                running.wait(rng.uniform(0.1, 0.5) * wall)
            except subprocess.TimeoutExpired:
                running.send_signal(signal.SIGKILL)
                running.wait()
                kills += 1
                continue
            break
        same = running.returncode == 0 and (out / "summary.json").read_bytes() == expected
        wrong += not same
        shutil.rmtree(out, ignore_errors=True)
    print(f"killed {kills} times in {rounds} runs and resumed: {rounds - wrong} of {rounds} summaries are the bytes of the whole run",
          flush=True)
    return wrong


def main():
    missed = strengths()
    return missed + killed(*one_command())


if __name__ == "__main__":
    harness.main(main)
