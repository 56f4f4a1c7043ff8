"""tools/validate calculix: CalculiX with RVEs in its integration points, end to end, beside the cell alone.

CalculiX is built from Debian's source with external behaviours (its Debian program ignores them without a word) and
loads librvelab_umat.so. A biaxial test in plane strain: the lateral pressure held, the height shortened by steps of 2.5e-4,
geometry nonlinear. One element of eight points to 1 %, a block of a hundred elements to 0.5 %, each point a packing of
400 discs. Asked: the mean axial stress is that of the cell alone in the same test, within 1 % of the pressure to 0.3 %
of strain, and within 3 % beyond, where two cells one bit apart differ by as much. Printed besides: wall time, iterations
and calls of the material per increment.

    calculix.py RVELAB WORK RESULTS [CCX]      # CCX: a program that was built before
"""
import os
import pathlib
import re
import subprocess
import time

import numpy as np

import debian_source
import harness
from harness import once, records, sets
from harness import work as folder

PRESSURE, STEP = 1e5, 2.5e-4
VERSION = "2.20"
MAKEFILE = f"""
CFLAGS = -w -O2 -fcommon -I/usr/include/spooles -DARCH="Linux" -DSPOOLES -DARPACK -DMATRIXSTORAGE -DUSE_MT=1 \\
  -DCALCULIX_EXTERNAL_BEHAVIOURS_SUPPORT
FFLAGS = -w -O2 -fopenmp -fallow-argument-mismatch
.c.o :
\t$(CC) $(CFLAGS) -c $<
.f.o :
\tgfortran $(FFLAGS) -c $<
include Makefile.inc
ccx: ccx_{VERSION}.o $(SCCXF:.f=.o) $(SCCXC:.c=.o)
\tgfortran -fopenmp -o $@ $^ -lspooles -larpack -llapack -lblas -lpthread -lm -lc -ldl
"""


def built():
    """CalculiX with external behaviours, from Debian's source package."""
    program = folder / "calculix" / f"ccx_{VERSION}" / "src" / "ccx"
    if not program.exists():
        debian_source.download("calculix-ccx", "bookworm", folder)
        harness.run("dpkg-source", "-x", next(folder.glob("calculix-ccx_*.dsc")), folder / "calculix")
        (program.parent / "Makefile.external").write_text(MAKEFILE)
        debian_source.make(program.parent, "-f", "Makefile.external", "ccx")
    return program


def deck(n, increments):
    """n x n elements of a unit square, one thick; both faces are tied to each other: discs have no stiffness across."""
    lines = ["*NODE,NSET=ALL"]
    row = n + 1

    def node(i, j, k):
        return 1 + i + row * j + row * row * k

    grid = [(i, j) for j in range(row) for i in range(row)]
    lines += [f"{node(i, j, k)},{i / n},{j / n},{k / n}" for k in range(2) for i, j in grid]
    lines.append("*ELEMENT,TYPE=C3D8,ELSET=SOIL")
    corners = ((0, 0), (1, 0), (1, 1), (0, 1))
    for j in range(n):
        for i in range(n):
            nodes = [node(i + a, j + b, k) for k in range(2) for a, b in corners]
            lines.append(",".join(map(str, [1 + i + n * j, *nodes])))
    for name, chosen in (("TOP", [(i, n) for i in range(row)]), ("BOTTOM", [(i, 0) for i in range(row)]),
                         ("LEFT", [(0, j) for j in range(row)])):
        lines += [f"*NSET,NSET={name}", *(f"{node(i, j, k)}," for k in range(2) for i, j in chosen)]
    lines += ["*ELSET,ELSET=RIGHT", *(f"{n * (1 + j)}," for j in range(n))]
    lines += ["*MATERIAL,NAME=@ABAQUSNL_RVELAB", "*USER MATERIAL,CONSTANTS=3", "1.,1.,0.", "*DEPVAR", "2",
              "*SOLID SECTION,ELSET=SOIL,MATERIAL=@ABAQUSNL_RVELAB", "*INITIAL CONDITIONS,TYPE=STRESS"]
    lines += [f"{e},{q},{-PRESSURE},{-PRESSURE},0.,0.,0.,0." for e in range(1, n * n + 1) for q in range(1, 9)]
    lines += ["*BOUNDARY", "ALL,3,3", "LEFT,1,1", "BOTTOM,2,2", "*EQUATION"]
    for i, j in grid:
        for axis, held in ((1, i == 0), (2, j in (0, n))):
            if not held:
                lines += ["2", f"{node(i, j, 1)},{axis},1.,{node(i, j, 0)},{axis},-1."]
    step = 1 / increments
    lines += ["*AMPLITUDE,NAME=HELD", "0.,1.,1.,1.", "*STEP,NLGEOM,INC=10000", "*STATIC", f"{step},1.,1.E-7,{step}",
              "*CONTROLS,PARAMETERS=TIME INCREMENTATION", "10,20,30,60,10,4,,20,,", "*DLOAD,AMPLITUDE=HELD",
              f"RIGHT,P4,{PRESSURE}", "*BOUNDARY", f"TOP,2,2,{-increments * STEP}", "*EL PRINT,ELSET=SOIL", "S", "*END STEP"]
    return "\n".join(lines) + "\n"


def axial_stress(printed):
    """Mean axial stress of all points at the end of each increment, Pa, compression positive; its time."""
    found = []
    for block in re.split(r" stresses .* time ", printed)[1:]:
        rows = [line.split() for line in block.splitlines()[1:] if len(line.split()) == 8]
        found.append((float(block.split()[0]), -np.mean([float(row[3]) for row in rows])))
    return np.array(found)


def alone(strain):
    """The same test of the cell alone. Strains of a protocol are of the first height, as the host's displacement is."""
    output = once(folder / "alone.h5", "run", "biaxial", "--specimen", folder / "S.h5",
                  *sets(f"test.pressure_Pa={PRESSURE}", f"stage.compression.to_strain={strain}",
                        f"stage.compression.record_every={STEP}"))
    found = records(output, "strain", "stress_Pa")
    return found["strain"], -found["stress_Pa"][:, 1, 1]


def main():
    ccx = pathlib.Path(harness.words[0]).resolve() if harness.words else built()
    library = harness.program.parents[1] / "lib"
    link = folder / "libRVELAB.so"
    link.unlink(missing_ok=True)
    link.symlink_to(library / "librvelab_umat.so")
    (folder / "rvelab_umat.toml").write_text('[[material]]\nnumber = 1\nspecimen = "S.h5"\n')
    (folder / "rvelab_umat.log").unlink(missing_ok=True)
    harness.packed("pack_dense", "S")
    strain, stress = alone(0.0101)
    good = True
    print("elements  RVEs  strain  increments  iterations  calls of a point an increment  wall time (s)  "
          "axial stress less that of the cell alone, over the pressure: to 0.3 % of strain, to the end")
    for n, increments in ((1, 40), (10, 20)):
        name = f"block{n}"
        (folder / f"{name}.inp").write_text(deck(n, increments))
        environment = dict(os.environ, LD_LIBRARY_PATH=f"{folder}:{library}", OMP_NUM_THREADS=str(os.cpu_count()))
        begin = time.monotonic()
        done = subprocess.run([ccx, name], cwd=folder, env=environment, capture_output=True, text=True, check=False)
        seconds = time.monotonic() - begin
        log = folder / "rvelab_umat.log"
        if done.returncode != 0 or log.exists():
            print(f"{name}: CalculiX ended with {done.returncode}: {log.read_text() if log.exists() else done.stdout[-300:]}")
            good = False
            continue
        found = axial_stress((folder / f"{name}.dat").read_text())
        iterations = [int(line.split()[3]) for line in (folder / f"{name}.sta").read_text().splitlines()[2:]]
        points, reached = 8 * n * n, increments * STEP
        calls = done.stdout.count("umat_abaqusnl") / points / len(found)
        apart = (found[:, 1] - np.interp(found[:, 0] * reached, strain, stress)) / PRESSURE
        early = found[:, 0] * reached <= 0.003
        small, large = np.abs(apart[early]).max(), np.abs(apart).max()
        good &= small <= 0.01 and large <= 0.03 and len(found) == increments
        print(f"{n * n:<9} {points:<5} {reached:<7g} {len(found):<11} {np.mean(iterations):<11.2f} {calls:<30.2f} "
              f"{seconds:<14.1f} {small:.4f}, {large:.4f}", flush=True)
    return not good


if __name__ == "__main__":
    harness.main(main)
