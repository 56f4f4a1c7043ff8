"""Error against processor time of one increment of 1e-4, rvelab beside YADE (tools/validate yade_increments).

usage: yade_increments.py RVELAB WORK RESULTS [--rounds 5] [--state NAME]...

YADE's packings with contact history are those of ../shared/reference. Both programs make the same
increments from the same states: at rest, and after 2 % of a drained biaxial test of YADE's, relaxed. The error is
|sigma - sigma_r|/|sigma_r - sigma_0| (Frobenius) against each program's own resolved and relaxed answer.

Each program is given its best. YADE: over number of steps, damping, time step, and steps at rest after the increment
(0: as its coupling reads the stress; 1: without the lag of one step; more: relaxed). rvelab: over the relative
tolerance alone; the same with one damping and time step for all cases; and over tolerance or number of sub-steps,
damping and time step. What counts for an error is the cheapest point from which on all finer ones of its series are
within it too, so that no chance zero of an error wins.

Both are timed on one core, stepping only, processor time, in rounds in turn; a ratio is one within a round. `restored`:
from a copy of the state, YADE by O.run, as its coupling does and as the recorded points of YADE were taken. `going on`:
with what only the first step or call after that does (YADE sorts all grains again, rvelab scales the masses) done before,
and YADE by O.step, without the thread that O.run starts: what the steps themselves cost.
"""
import argparse
import itertools
import json
import os
import pathlib
import statistics

import numpy as np

import harness
import yade_increments_report as report
from harness import REFERENCE, program, results, work

HERE = pathlib.Path(__file__).parent
LENGTH = 1e-4
INCREMENTS = {"biax": [[LENGTH / 2, 0], [0, -LENGTH]], "shear": [[0, LENGTH], [0, 0]]}
STATES = {"dense": ("dense", 0), "dense_2pct": ("dense", 0.02), "medium": ("medium", 0),
          "medium_2pct": ("medium", 0.02)}
TARGETS = (0.01, 0.001)

STEPS = (*range(2, 13), 14, 16, 18, 20, 23, 26, 30, 35, 40, 45, 50, 60, 70, 85, 100, 120, 150, 200, 250, 300, 400, 500,
         700, 1000, 1500, 2000, 3000)
MOST_STEPS_AT_REST = 300
MOST_STEPS_RELAXED = 50  # after more steps than these, or in flow, relaxing gains nothing over steps in the increment
DAMPINGS = (0.02, 0.05, 0.1, 0.3, 0.5)
TIME_STEPS = {"YADE": (0.8, 0.9), "rvelab": (0.7, 0.95)}  # over PWave, over the critical one; 1.0 PWave is not stable
TOLERANCES = tuple(10 ** (-k / 8) for k in range(0, 37))
RESOLVED = (10_000, 3_000)
# What YADE's FEMxDEM coupling makes of this length.
COUPLING = {"steps": 10, "after": 0, "damping": 0.1, "time_step": 1.0}
# One setting of rvelab for all cases, beside the best of each.
ONE_SETTING = {"damping": 0.1, "time_step": 0.95}
DEFAULT = {"relative_tolerance": 1e-2, "absolute_tolerance": 1e-4, "kind": "default"}


def yade_points(at_rest):
    points = [{**COUPLING, "kind": "coupling"}]
    for steps, damping, time_step in itertools.product(STEPS, DAMPINGS, TIME_STEPS["YADE"]):
        if at_rest and steps > MOST_STEPS_AT_REST:
            continue
        relaxed = (10, 20, 40) if at_rest and steps <= MOST_STEPS_RELAXED else ()
        points += [{"steps": steps, "after": after, "damping": damping, "time_step": time_step, "kind": "YADE"}
                   for after in (0, 1, *relaxed)]
    return points


def rvelab_points(at_rest):
    points = [DEFAULT]
    tolerances = [{"relative_tolerance": t, "absolute_tolerance": 1e-3 * t} for t in TOLERANCES]
    points += [{**tolerance, "kind": "tolerance"} for tolerance in tolerances]
    steps = [{"fixed_substeps": n} for n in STEPS if not at_rest or n <= MOST_STEPS_AT_REST]
    for fine, damping, time_step in itertools.product(tolerances + steps, DAMPINGS, TIME_STEPS["rvelab"]):
        points.append({**fine, "damping": damping, "time_step": time_step, "kind": "settings"})
    return points


def cost(point):
    """Steps: the same on a busy machine."""
    return point["steps"] + point["after"] if "steps" in point else point["substeps"]


def series(point):
    """Points of a series differ by how fine they are."""
    return "fixed_substeps" in point, point.get("damping"), point.get("time_step"), point.get("after")


def fineness(point):
    return point.get("steps") or point.get("fixed_substeps") or 1 / point["relative_tolerance"]


def run(*command):
    """On one core, in WORK."""
    return harness.run("taskset", "-c", max(os.sched_getaffinity(0)), *command, cwd=work,
                       env=dict(os.environ, OMP_NUM_THREADS="1")).stdout


def scene(*arguments):
    return run("yade", "-n", "-x", "-j1", HERE / "yade_scene.py", *arguments)


def job(content):
    (work / "job.json").write_text(json.dumps({"increments": list(INCREMENTS.values()), **content}))
    return work / "job.json"


def of_yade(base, points, repeats, **more):
    scene("increments", base, job({"points": points, "repeats": repeats, **more}), work / "yade.json")
    return json.loads((work / "yade.json").read_text())


def of_rvelab(name, settings, repeats, **more):
    return json.loads(run(program.with_name("rvelab-increments"), f"{name}.h5",
                          job({"settings": settings, "repeats": repeats, **more})))


def state_of(name):
    """A state of both programs. rvelab takes the slip and the arms of YADE, so that the answers can be compared."""
    parent, strain = STATES[name]
    base = (REFERENCE / "yade/packings" / parent).resolve()
    if strain:
        parent, base = base, work / name
        scene("biaxial", parent, base, strain)
    run(program, "import", f"{base}.particles.csv", f"{base}.contacts.csv", f"{base}.json", "-o", f"{name}.h5",
        "--force",
        "--set", "contact.slip=full_radius_ratcheting")
    return base


def judged(found):
    """Errors of all points of one increment, and what its resolved answers leave open."""
    start, reference = np.array(found["start"]), np.array(found["resolved"][0]["stress"])
    change = float(np.linalg.norm(reference - start))
    error = lambda of: float(np.linalg.norm(np.array(of["stress"]) - reference)) / change
    for point in found["points"]:
        point["error"] = error(point)
        point["ms"] = 1e3 * statistics.median(point["seconds"])
    return {**found, "start": start, "reference": reference, "change": change, "open": error(found["resolved"][1])}


def within(points, target):
    """Cheapest point from which on all finer ones of its series are within the target; None: there is none."""
    best = None
    for _, of in itertools.groupby(sorted(points, key=lambda p: (str(series(p)), fineness(p))), key=series):
        of = list(of)
        while of and of[-1]["error"] <= target:
            point = of.pop()
            if best is None or cost(point) < cost(best):
                best = point
    return best


def of_kind(points, *kinds):
    return [point for point in points if point["kind"] in kinds]


def choice(theirs, ours):
    """What is put side by side for each target: (target, YADE's point, rvelab's by tolerance, the same with
    ONE_SETTING, the best of all settings)."""
    one = [point for point in ours if ONE_SETTING.items() <= point.items() and "fixed_substeps" not in point]
    return [(target, *(within(points, target) for points in (
        of_kind(theirs, "YADE"), of_kind(ours, "tolerance"), one, of_kind(ours, "tolerance", "settings"))))
            for target in TARGETS]


def timed(base, name, chosen, rounds):
    """ms of each round: {(increment, target, number of the point): [(restored, going on)]}; number 0 is YADE's."""
    theirs, ours, order = [], [], []
    for mode, rows in enumerate(chosen):
        for target, *points in rows:
            for number, point in enumerate(points):
                if point is None:
                    continue
                kept = {key: value for key, value in point.items() if key not in ("seconds", "stress")}
                jobs = [{**kept, "only": mode, "warm": warm} for warm in (False, True)]
                (theirs if number == 0 else ours).extend(jobs)
                order.append((mode, target, number))
    found = {key: [] for key in order}
    for _ in range(rounds):
        both = [itertools.chain(*(of["points"] for of in made))
                for made in (of_yade(base, theirs, 3), of_rvelab(name, ours, 51))]
        for key in order:
            of = both[min(key[2], 1)]
            found[key].append(tuple(1e3 * statistics.median(next(of)["seconds"]) for _ in range(2)))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--state", action="append", choices=list(STATES))
    options, found = parser.parse_args(harness.words), {}
    report.print_head(options.rounds)
    for name in options.state or STATES:
        base, at_rest = state_of(name), STATES[name][1] == 0
        theirs = [judged(of) for of in of_yade(base, yade_points(at_rest), 1, resolved=RESOLVED, couplings=5)]
        ours = [judged(of) for of in of_rvelab(name, rvelab_points(at_rest), 3, resolved=RESOLVED, beside=101)]
        found[name] = dict(zip(INCREMENTS, zip(theirs, ours)))
        chosen = [choice(their["points"], own["points"]) for their, own in zip(theirs, ours)]
        report.print_state(name, list(INCREMENTS), chosen, timed(base, name, chosen, options.rounds))
    report.print_agreement(found)
    report.print_prices(found)
    report.verdicts(report.judged)
    report.draw(found, TARGETS, results / "yade_increments.png")


if __name__ == "__main__":
    harness.main(main)
