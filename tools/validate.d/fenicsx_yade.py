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

    fenicsx_yade.py RVELAB WORK RESULTS"""
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
COPIES, REPEATS, ROUNDS = 16, 5, 3


def trials(name, increment):
    """Of rvelab: stress (2 x 2, Pa), and ms of processor time of a trial with and without its tangent, medians over a
    batch of copies."""
    sys.path.insert(0, str(harness.ROOT / "tools/python"))
    os.environ.setdefault("RVELAB_LIBRARY", str(harness.program.parents[1] / "lib/librvelab.so.1"))
    import rvelab
    options = dict(workers=1, tolerance_rel=TOLERANCES[0], tolerance_abs=TOLERANCES[1])
    with warnings.catch_warnings(), rvelab.Pool(**options) as pool:
        warnings.simplefilter("ignore", rvelab.RvelabWarning)
        ids = pool.spawn(pool.template(str(work / f"{name}.h5")), COPIES)
        dH = np.zeros((COPIES, 3, 3))
        pool.trial(ids, dH)
        pool.commit()
        dH[:, :2, :2] = increment
        ms = []
        for want in (["tangent", "error_estimate"], ["error_estimate"]):
            seconds = []
            for _ in range(REPEATS):
                begin = time.process_time()
                found = pool.trial(ids, dH, want=want)
                seconds.append(time.process_time() - begin)
                pool.revert()
            ms.append(1e3 * statistics.median(seconds) / COPIES)
        return found.sigma[0, :2, :2], *ms


def compared(base, name):
    """Figures of both increments of a state; ms: lists of the rounds."""
    yade.INCREMENTS = INCREMENTS  # of job()
    theirs = yade.of_yade(base, [COUPLING, *POINTS], 1, resolved=RESOLVED, tangent=True)
    ours = yade.of_rvelab(name, [], 1, resolved=RESOLVED)
    rows = {}
    for mode, (their, own, increment) in enumerate(zip(theirs, ours, INCREMENTS.values())):
        exact, reference = (np.array(of["resolved"][0]["stress"]) for of in (own, their))
        p = -np.trace(np.array(own["start"])) / 2
        apart = np.linalg.norm(np.array(own["resolved"][1]["stress"]) - exact) / p
        error = np.linalg.norm(trials(name, increment)[0] - exact) / p
        for point in their["points"]:
            point["error"] = np.linalg.norm(np.array(point["stress"]) - reference) / p
        coupled, *others = their["points"]
        same = yade.within(others, max(error, apart))
        ms = dict(coupled=[], same=[], beside=[], own=[], bare=[])
        for _ in range(ROUNDS):
            jobs = [{**{key: point[key] for key in COUPLING}, "only": mode} for point in (coupled, same)]
            timed = yade.of_yade(base, jobs, 3, tangent=True)[mode]
            for which, point in zip(("coupled", "same"), timed["points"]):
                ms[which].append(1e3 * statistics.median(point["seconds"]))
            ms["beside"].append(1e3 * sum(timed["beside"].values()))
            for which, each in zip(("own", "bare"), trials(name, increment)[1:]):
                ms[which].append(each)
        rows[list(INCREMENTS)[mode]] = dict(error=error, coupled=coupled["error"], steps=same["steps"] + same["after"],
                                            damping=same["damping"], same=same["error"], ms=ms)
    return rows


@bars
def judge(found):
    print("processor ms of a trial, medians of rounds; errors over the pressure; same error: YADE's cheapest steps and damping;\n"
          "ms of YADE: steps + what the coupling takes beside them; times, medians of the rounds: of the coupling, of the coupling\n"
          "with the steps of the same error, of these steps alone over a trial without tangent\n"
          "state        increment  rvelab: error, ms, without tangent  coupling: error, ms      "
          "same error: steps, damping, error, ms    times")
    ratios = {}
    for state, rows in found.items():
        for mode, each in rows.items():
            ms = {which: np.array(values) for which, values in each["ms"].items()}
            middle = {which: np.median(values) for which, values in ms.items()}
            ratios[state, mode] = [np.median(ratio) for ratio in (
                (ms["coupled"] + ms["beside"]) / ms["own"], (ms["same"] + ms["beside"]) / ms["own"],
                ms["same"] / ms["bare"])]
            print(f"{state:11}  {mode:9} {each['error']:14.1e} {middle['own']:5.2f} {middle['bare']:14.2f} "
                  f"{each['coupled']:16.1e} {middle['coupled']:5.1f} + {middle['beside']:.1f} {each['steps']:17} "
                  f"{each['damping']:8g} {each['same']:7.1e} {middle['same']:5.1f} + {middle['beside']:.1f}  "
                  + " ".join(f"{ratio:5.1f}" for ratio in ratios[state, mode]))
    for (state, mode), (_, ratio, alone) in ratios.items():
        verdict(f"{state}, {mode}: YADE's time over rvelab's at the same error", f"{ratio:.1f}; steps alone {alone:.1f}", "> 1, both",
                min(ratio, alone) > 1)


def main():
    judge({name: compared(yade.state_of(name), name) for name in STATES})
    return False


if __name__ == "__main__":
    harness.main(main)
