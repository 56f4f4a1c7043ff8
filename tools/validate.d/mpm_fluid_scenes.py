"""tools/validate mpm_fluid_scenes, mpm_shaking: saturated grains beside exact answers, cells and published figures.

    mpm_fluid_scenes.py RVELAB FOLDER RESULTS                 # all parts but shaking
    mpm_fluid_scenes.py RVELAB FOLDER RESULTS PART...         # of the list at the end

Published: Liang, Zhao, Wu, Zhao and Wang (2023, Comput. Methods Appl. Mech. Eng. 405, 115871). Each line: what, found,
asked for, verdict. consolidation: the specimen's own modulus and the exact answer of the two-phase equations.
undrained, undrained_64, drained, cyclic: blocks beside the test of their specimen. mandel: the analytic answer.
column, wave, wave_far, scan: trends that the paper describes, at reduced size; shaking: the same, hours. Runs that are whole in FOLDER are used
again, and those that were stopped are continued."""

import harness
from mpm import plot_style
from mpm_fluid_blocks import consolidation, cyclic, drained, mandel, undrained, undrained_64
from mpm_fluid_soils import column, shaking
from mpm_fluid_waves import scan, wave, wave_far

PARTS = {"consolidation": consolidation, "undrained": undrained, "undrained_64": undrained_64, "drained": drained,
         "cyclic": cyclic, "mandel": mandel, "column": column, "wave": wave, "wave_far": wave_far, "scan": scan,
         "shaking": shaking}


def main():
    plot_style()
    for part in harness.words or [part for part in PARTS if part != "shaking"]:
        PARTS[part]()


if __name__ == "__main__":
    harness.main(main)
