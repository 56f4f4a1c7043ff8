"""tools/validate fenicsx_yade: a trial of an RVE in finite elements, by YADE's FEMxDEM coupling and by rvelab.fenicsx.

States are two of yade_increments: the dense packing of 400 discs by YADE at rest, and after 2 % of its biaxial test. The
increments are as long as those of `python3 -m rvelab.fenicsx biaxial`: 5e-4. A trial begins with the state of a
point and ends with stress, tangent, and a new state:

coupling    as YADE's simDEM.py makes it (py/yade/FEMxDEM of its package): the scene from its copy, 1e5 times the largest
            strain of steps at the P-wave step with a damping of 0.1, a copy; the scene again, getStressAndTangent()
rvelab      Pool.trial(want=["tangent", "error_estimate"]) with the host's tolerances, 0.1 and 1e-3 p
same error  the cheapest steps and damping of YADE that err no more than rvelab, with the coupling's own parts

Errors are |sigma - sigma_r|/p with each program's own resolved and relaxed answer. Processor time on one core, in
rounds in turn; a ratio is one within a round.

    fenicsx_yade.py RVELAB WORK RESULTS [--rounds 5]"""
import itertools
import os
import statistics
import sys
import time
import warnings

import numpy as np

import harness
import yade_increments as yade
from harness import bars, verdict, work

LENGTH, TOLERANCES = 5e-4, (0.1, 1e-3)
INCREMENTS = {"biax": [[LENGTH / 2, 0], [0, -LENGTH]], "shear": [[0, LENGTH], [0, 0]]}
COUPLING = {"steps": 50, "after": 0, "damping": 0.1, "time_step": 1.0}
STEPS = (2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 17, 20, 25, 30, 40, 50, 70, 100, 150, 200, 300, 500, 700, 1000)
POINTS = [dict(steps=steps, after=after, damping=damping, time_step=0.9)
          for steps, after, damping in itertools.product(STEPS, (0, 1), (0.1, 0.3))]
RESOLVED, STATES = (3000, 1000), ("dense", "dense_2pct")
COPIES, REPEATS = 16, 5


def trials(name, increment):
    """Of rvelab: stress (2 x 2, Pa), and ms of processor time of a trial, the median of some of a batch of copies."""
    sys.path.insert(0, str(harness.ROOT / "tools/python"))
    os.environ.setdefault("RVELAB_LIBRARY", str(harness.program.parents[1] / "lib/librvelab.so.1"))
    import rvelab
    with warnings.catch_warnings(), rvelab.Pool(workers=1, tolerance_rel=TOLERANCES[0], tolerance_abs=TOLERANCES[1]) as pool:
        warnings.simplefilter("ignore", rvelab.RvelabWarning)
        ids = pool.spawn(pool.template(str(work / f"{name}.h5")), COPIES)
        dH = np.zeros((COPIES, 3, 3))
        pool.trial(ids, dH)
        pool.commit()
        dH[:, :2, :2] = increment
        seconds = []
        for _ in range(REPEATS):
            begin = time.process_time()
            found = pool.trial(ids, dH, want=["tangent", "error_estimate"])
            seconds.append(time.process_time() - begin)
            pool.revert()
        return found.sigma[0, :2, :2], 1e3 * statistics.median(seconds) / COPIES


def compared(base, name, rounds):
    """Figures of both increments of a state."""
    yade.INCREMENTS = INCREMENTS  # of job()
    theirs = yade.of_yade(base, [COUPLING, *POINTS], 1, resolved=RESOLVED, tangent=True)
    ours = yade.of_rvelab(name, [], 1, resolved=RESOLVED)
    rows = {}
    for mode, (their, own) in enumerate(zip(theirs, ours)):
        start, exact = np.array(own["start"]), np.array(own["resolved"][0]["stress"])
        p = -np.trace(start) / 2
        apart = np.linalg.norm(np.array(own["resolved"][1]["stress"]) - exact) / p
        error = np.linalg.norm(trials(name, list(INCREMENTS.values())[mode])[0] - exact) / p
        reference = np.array(their["resolved"][0]["stress"])
        for point in their["points"]:
            point["error"] = np.linalg.norm(np.array(point["stress"]) - reference) / p
        coupled, *others = their["points"]
        same = yade.within(others, max(error, apart))
        found = []
        for _ in range(rounds):
            jobs = [{**{key: point[key] for key in COUPLING}, "only": mode} for point in (coupled, same) if point]
            timed = yade.of_yade(base, jobs, 3, tangent=True)[mode]
            stepping = [1e3 * statistics.median(point["seconds"]) for point in timed["points"]]
            beside = sum(1e3 * seconds for seconds in timed["beside"].values())
            found.append([*stepping, beside, trials(name, list(INCREMENTS.values())[mode])[1]])
        rows[list(INCREMENTS)[mode]] = dict(error=error, open=apart, coupled=coupled["error"],
                                            same=same and dict(steps=same["steps"] + same["after"], damping=same["damping"],
                                                               error=same["error"]), ms=found)
    return rows


@bars
def judge(found):
    print("processor ms of a trial, medians of rounds; error: over the pressure; same error: YADE's cheapest steps and damping\n"
          "state        increment   rvelab: error, ms    coupling: error, ms    same error: steps, damping, error, ms   "
          "times: coupling, same error, its steps alone")
    for state, rows in found.items():
        for mode, each in rows.items():
            ms, same = np.array(each["ms"]), each["same"]
            own, coupled = ms[:, -1], ms[:, 0] + ms[:, -2]
            text = f"{state:11}  {mode:9} {each['error']:14.1e} {np.median(own):5.2f} {each['coupled']:16.1e} {np.median(coupled):5.2f}"
            ratio = np.median(coupled / own)
            if same:
                equal = ms[:, 1] + ms[:, -2]
                text += (f"  {same['steps']:16d} {same['damping']:9g} {same['error']:8.1e} {np.median(equal):6.2f}"
                         f"  {ratio:14.0f} {np.median(equal / own):11.0f} {np.median(ms[:, 1] / own):16.1f}")
            else:
                text += f"  {'not reached':>43}  {ratio:14.0f}"
            print(text)
    for state, rows in found.items():
        for mode, each in rows.items():
            if each["same"]:
                ms = np.array(each["ms"])
                ratio = np.median((ms[:, 1] + ms[:, -2]) / ms[:, -1])
                verdict(f"{state}, {mode}: YADE's time over rvelab's at the same error", f"{ratio:.1f}", "> 1", ratio > 1)


def main():
    rounds = int(harness.words[harness.words.index("--rounds") + 1]) if "--rounds" in harness.words else 5
    judge({name: compared(yade.state_of(name), name, rounds) for name in STATES})
    return False


if __name__ == "__main__":
    harness.main(main)
