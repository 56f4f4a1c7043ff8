"""tools/validate new_law: what the next law of an interaction takes.

    new_law.py RVELAB WORK RESULTS

A copy of the tree in FOLDER gets a law of its own (new_law/soft_coat.hpp: reach, a scalar, a vector) by its file and its name
in laws.hpp, and a test (new_law/test_soft_coat.cpp); built and run, with the other tests of interactions. Prints the files touched."""

import os
import shutil
import subprocess
import sys

import harness
from harness import ROOT

SOURCE = ROOT / "tools/validate.d/new_law"
copy = harness.work

def main():
    tracked = harness.run("git", "ls-files", cwd=ROOT).stdout.split("\n")
    wanted = {name for name in tracked if name and (ROOT / name).is_file()}
    if copy.exists():  # what a run before left, but for its build
        for name in {str(path.relative_to(copy)) for path in copy.rglob("*") if path.is_file()} - wanted:
            if not name.startswith("build/"):
                (copy / name).unlink()
    for name in sorted(wanted):
        to = copy / name
        to.parent.mkdir(parents=True, exist_ok=True)
        if not to.exists() or to.read_bytes() != (ROOT / name).read_bytes():
            shutil.copy2(ROOT / name, to)

    module = copy / "rvelab/interaction"
    shutil.copy2(SOURCE / "soft_coat.hpp", module)
    laws = (module / "laws.hpp").read_text()
    first, rest = laws.split('#include "rvelab/interaction/softening_bond.hpp"\n', 1)
    list_of_laws = "SofteningBond>;"
    assert list_of_laws in rest, "laws.hpp is not as it was: its list of laws ends with another name"
    (module / "laws.hpp").write_text(first + '#include "rvelab/interaction/soft_coat.hpp"\n#include "rvelab/interaction/softening_bond.hpp"\n' +
                                   rest.replace(list_of_laws, "SofteningBond, SoftCoat>;"))
    touched = sorted(name for name in (str(path.relative_to(copy)) for path in module.iterdir())
                     if not (ROOT / name).exists() or (ROOT / name).read_bytes() != (copy / name).read_bytes())
    shutil.copy2(SOURCE / "test_soft_coat.cpp", copy / "tests/interaction/test_soft_coat.cpp")

    log = copy / "build.log"
    jobs = os.environ.get("RVELAB_JOBS") or str(os.cpu_count())
    with open(log, "w") as out:
        launcher = ["-D", "CMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        for command in (["cmake", "--preset", "release", "-D", "RVELAB_WERROR=ON", *launcher],
                        ["cmake", "--build", "--preset", "release", "--parallel", jobs, "--target",
                         "test_interaction"]):
            if subprocess.run(command, cwd=copy, stdout=out, stderr=out).returncode != 0:
                sys.exit(f"new_law: {' '.join(command)} failed; see {log}")
    print("touched: " + ", ".join(touched))
    for tests in ("[new_law]", "~[new_law]"):
        run = subprocess.run([copy / "build/release/bin/test_interaction", tests], capture_output=True, text=True,
                             cwd=copy)
        lines = run.stdout.strip().split("\n")
        print(f"{tests}: {lines[-1]}")
        if run.returncode != 0:
            sys.exit("\n".join(lines[-60:]))
    if len(touched) > 3:
        sys.exit("new_law: more than three files were touched")


if __name__ == "__main__":
    harness.main(main)
