"""tools/validate constants: what each constant of quasi-static loading is worth.

    constants.py RVELAB WORK RESULTS ESTIMATES

A copy of the tree in FOLDER is built, in which the constants of rvelab/solver/quasi_static/constants.hpp are read when the
program starts. With each constant put out of action the increments of `tools/validate estimates` are made again, eight of each of
three states of 36 packings, from the same states and against the same truths (ESTIMATES): sub-steps (geometric mean and sum, those
of measurements too), errors within the estimate, median of estimate over error, errors within the tolerance. A constant
stays if that costs 5 % of sub-steps or a point of honesty, or where the last column says what it is for."""

import math
import os
import pathlib
import re
import shutil
import statistics

import harness
from harness import ROOT, run, work

estimates = pathlib.Path(harness.words[0]).resolve()
EACH = 8
# Without: the values that put it out of action.
ALONE = {
    "check_interval": ("check_interval=25", "half of it"),
    "checked_steps": ("checked_steps=1", "the cost of a call of one sub-step"),
    "judged_together": ("judged_together=0", "paths cut finely (tools/validate pieces)"),
    "step_margin": ("step_margin=1", ""),
    "least_change": ("least_change=0", "the tolerance itself"),
    "largest_target": ("largest_target=1", ""),
    "first_step_over_overlap": ("first_step_over_overlap=3e-3", "three times"),
    "ratio_of_first_step": ("ratio_of_first_step=1e-3", "three times"),
    "least_change_of_step, largest_change_of_step": ("least_change_of_step=0,largest_change_of_step=1e9", "stress control (tests/extreme)"),
    "largest_step_over_overlap": ("largest_step_over_overlap=1", ""),
    "smallest_over_largest_step": ("smallest_over_largest_step=0", ""),
    "per_ratio, least_share_of_smallest": ("least_share_of_smallest=1,per_ratio=1e9", "tight tolerances under stress control (tests/solver)"),
    "least_overlap": ("least_overlap=0", "stiff rolling springs, a reference of another stage (tests/solver)"),
    "rounded_off": ("rounded_off=0", "paths cut finely (tools/validate pieces)"),
    "growth_of_search": ("growth_of_search=1.01", "the time of the search"),
    "onward_allowance": ("onward_allowance=1", ""),
    "most_steps, most_steps_of_overlap": ("most_steps=1e15", "states without equilibrium (tests/extreme)"),
    "fewer_after_check": ("fewer_after_check=1", ""),
    "start_damping, start_step": ("start_damping=1,start_step=0.7", ""),
    "longest_start": ("longest_start=0", ""),
    "firm_factor_of_start, isostatic_factor_of_start": ("firm_factor_of_start=0.3,isostatic_factor_of_start=1.7", "increments after the friction was lowered (tests/solver)"),
    "start_margin, largest_target_of_start": ("start_margin=2,largest_target_of_start=2e-3", "low friction (tests/solver)"),
    "longest_elastic_strain": ("longest_elastic_strain=1", "starts of spheres that are no equilibrium (tests/adapters)"),
    "least_elastic_ratio": ("least_elastic_ratio=0", "starts in flow (tests/solver)"),
    "most_steps_before_turn": ("most_steps_before_turn=0", ""),
    "slow_share": ("slow_share=0", ""),
    "isostatic_creep": ("isostatic_creep=0", ""),
    "lags_left": ("lags_left=0", ""),
    "share_of_directions": ("share_of_directions=1", "the stiffness of a network"),
    "stiff_factor": ("stiff_factor=0", ""),
    "least_stiffness_ratio": ("least_stiffness_ratio=0.1", ""),
    "hyperstatic_factor": ("hyperstatic_factor=0", ""),
    "isostatic_factor, isostatic_width": ("isostatic_factor=0", ""),
    "measured_period": ("measured_period=100", "a tenth of it"),
    "changed_period": ("changed_period=1000", "not tried alone in the tests"),
    "largest_start": ("largest_start=1", "paths cut finely (tests/solver)"),
    "fitted_margin": ("fitted_margin=1", "increments between measurements (tests/solver)"),
    "slow_growth, slow_goes_on": ("slow_growth=1e9", ""),
    "creep_steps, creep_goes_on": ("creep_goes_on=0", ""),
    "least_share": ("least_share=0", ""),
    "met_margin": ("met_margin=1", "what the report says"),
}


def readable(text):
    """constants.hpp whose values an environment variable of their name replaces."""
    def one(match):
        kind, values = match.groups()
        whole = "(long)" if kind == "long" else ""
        return f"inline const {kind} " + re.sub(r"(\w+) = ([^,;]+)", rf'\1 = {whole}given("\1", \2)', values) + ";"

    text = re.sub(r"constexpr (double|long) ([^;]*);", one, text)
    reader = ("#include <cstdlib>\n#include <string>\nnamespace rvelab::constants {\ninline double given(const char* name, double value) {\n"
              '  const char* set = std::getenv((std::string("RVELAB_CONSTANT_") + name).c_str());\n'
              "  return set != nullptr ? std::strtod(set, nullptr) : value;\n}\n")
    return text.replace("namespace rvelab::constants {", reader, 1)


def built():
    tree = work / "tree"
    shutil.rmtree(tree, ignore_errors=True)
    shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns("build", ".git", "results"))
    module = tree / "rvelab/solver/quasi_static"
    (module / "constants.hpp").write_text(readable((module / "constants.hpp").read_text()))
    for path in [*module.glob("*.?pp"), *(tree / "rvelab/solver/at_rate").glob("*.?pp")]:
        path.write_text(re.sub(r"constexpr (long|double) (?=\w+ = [^;]*(check_interval|held_path))", r"const \1 ",
                               path.read_text().replace("constexpr double held_path_ratio", "inline double held_path_ratio")))
    run("cmake", "--preset", "release", "-D", "BUILD_TESTING=OFF", cwd=tree)
    run("cmake", "--build", "--preset", "release", "--target", "rvelab-estimates", cwd=tree)
    return tree / "build/release/bin/rvelab-estimates"


def figures(program, without=""):
    values = {"RVELAB_CONSTANT_" + key: value for key, value in (each.split("=") for each in without.split(",") if each)}
    run(program, 2, 37, EACH, estimates, env={**os.environ, **values})
    within, kept, ratios, steps = [], [], [], []
    for line in (estimates / "increments.txt").read_text().splitlines():
        _, _, _, _, known, failed, error, estimate, allowed, spread, *_, cost = map(float, line.split())
        if not known or failed:
            continue
        steps.append(cost)
        if spread <= allowed / 3:
            within.append(error <= estimate)
            kept.append(error <= allowed)
            ratios.append(estimate / max(error, 1e-300))
    return (math.exp(statistics.mean(map(math.log, steps))), sum(steps), 100 * statistics.mean(within), statistics.median(ratios),
            100 * statistics.mean(kept), len(within))


def line(name, found, base, note=""):
    print(f"{name:<48}{found[0] / base[0]:8.3f}{found[1] / base[1]:8.3f}{found[2]:10.1f}{found[3]:8.2f}{found[4]:11.1f}{found[5]:6d}   {note}".rstrip(), flush=True)


def main():
    program = built()
    base = figures(program)
    print(f"{'':<48}sub-steps over those   % within  median  % within\n{'without':<48}{'mean':>8}{'sum':>8}{'estimate':>10}{'est/err':>8}"
          f"{'tolerance':>11}{'n':>6}   what else it is for, or what was tried\n")
    line("all as they are", base, base, f"{base[1]:.3g} sub-steps")
    for name, (without, note) in ALONE.items():
        line(name, figures(program, without), base, note)


if __name__ == "__main__":
    harness.main(main)
