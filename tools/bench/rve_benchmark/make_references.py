#!/usr/bin/python3
"""Makes the references of the cases by rvelab: make_references.py [CASE]...   (environment as make_cases.py)

Curves: the mean of four runs at the finest setting, three of them from centres moved by up to 1e-9 radii; the bar of a
record is twice the largest distance from it of these four and of a run at a setting coarser by three. Means of chaotic paths: of ten sets of
runs at a fine setting, nine of them moved; the bar is the standard deviation of a set, which is what a perfect code would
show by chance.
"""
import re
import sys
import warnings

import numpy as np

import answers
import case as cases
import run_rvelab

FINEST = ({"relative_tolerance": 1e-4}, {"relative_tolerance": 3e-4}, {"relative_tolerance": 3e-3})
FINEST_AT_RATE = ({"time_step": 0.005}, {"time_step": 0.015}, {"time_step": 0.05})
SETS = 10


def rows_of(case, setting, seed):
    found = [run_rvelab.made(case, one, {**setting, **({"perturb": seed} if seed else {})}) for one in case.specimens]
    return answers.reduced(case, answers.checked(case, found, "rvelab"))


def text_of(setting):
    return ", ".join(f"{key.replace('_', ' ')} {value:g}" for key, value in setting.items())


def main():
    warnings.simplefilter("ignore")
    for name in sys.argv[1:] or cases.names():
        case = cases.Case(cases.folder_of(name))
        finest, coarser, of_means = FINEST_AT_RATE if case.rate else FINEST
        if case.windows:
            runs = np.array([rows_of(case, of_means, seed) for seed in range(SETS)])
            mean = runs.mean(axis=0)
            bars = np.sqrt((answers.norm(runs[..., 3:] - mean[:, 3:]) ** 2).sum(axis=0) / (SETS - 1))
            says = (f"{SETS} sets of runs of rvelab, {text_of(of_means)}, centres of nine moved by up to 1e-9 radii; bar: standard "
                    "deviation of a set")
        else:
            runs = np.array([rows_of(case, finest, seed) for seed in range(4)])
            mean = runs.mean(axis=0)
            off = answers.norm(np.array([*runs, rows_of(case, coarser, 0)])[..., 3:] - mean[:, 3:])
            bars = np.maximum(2 * off.max(axis=0), 0.1)
            says = (f"4 runs of rvelab, {text_of(finest)}, centres of three moved by up to 1e-9 radii; bar: twice the largest distance of "
                    f"these and of a run with {text_of(coarser)}")
        answers.write_reference(case, mean, bars)
        with open(case.path, encoding="utf-8") as file:
            text = file.read()
        with open(case.path, "w", encoding="utf-8") as file:
            file.write(re.sub(r'made_by = ".*"', f'made_by = "{says}"', text))
        print(f"{name}: bar {answers.Reference(cases.Case(case.folder)).bar():.1e}", flush=True)


if __name__ == "__main__":
    main()
