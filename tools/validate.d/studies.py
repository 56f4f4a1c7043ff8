"""tools/validate study, studies: the kept studies of rvelab study.

    studies.py RVELAB WORK RESULTS tolerance     # errors and their estimates over the tolerances
    studies.py RVELAB WORK RESULTS               # of scale: space, number of grains, stiffness over pressure; and of damping"""
import re
import sys

import harness
from harness import packed, results, run, rvelab, sets, work


def study(title, name, specimen, *settings, figure=""):
    if title:
        print(f"== {title}")
    out = work / f"{name}_{specimen.stem}"
    text = rvelab("study", name, specimen, "-o", out, "--force", *sets(*settings))
    print(re.sub(r"\n*\nfile .*", "", text, flags=re.S), flush=True)
    if figure:
        run(sys.executable, "-B", harness.ROOT / "tools/plot/study.py", out, "-o", results / figure)


def main():
    if harness.words == ["tolerance"]:
        study("", "tolerance", packed("pack_dense", "S"), figure="study_tolerance.png")
        return
    study("1000 spheres, Hertz-Mindlin, triaxial to 5 %", "tolerance_3d", packed("pack_hertz", "hertz"),
          figure="study_tolerance_3d.png")
    for number in (100, 400, 1600):
        study(f"{number} discs, biaxial to 5 %", "number_of_grains",
              packed("pack_dense", f"n{number}", f"pack.number={number}"))
    for ratio, pressure, strain, every in (("1e2", "4e5", "0.2", "2e-3"), ("1e4", "4e3", "2e-3", "2e-5"),
                                           ("1e6", "40", "2e-5", "2e-7")):
        study(f"kn/(p t) = {ratio}, 400 discs, biaxial to {strain}", "stiffness",
              packed("pack_dense", f"k{ratio}", f"target.pressure_Pa={pressure}", "target.void_ratio=0.19"),
              f"test.pressure_Pa={pressure}",
              f"stage.compression.to_strain={strain}", f"stage.compression.record_every={every}")
    study("damping, 400 discs, biaxial to 5 %", "damping", packed("pack_dense", "dense"))


if __name__ == "__main__":
    harness.main(main)
