"""LAMMPS reads what `rvelab export` writes: the data file, then the dump over it, with equal positions.

Needs lammps and python3-numpy (Debian).
"""

import sys

import numpy

import harness
from harness import imported, run, rvelab, sets, work

# Positions are set to zero between the two reads, so that those written back are the dump's.
SCRIPT = """units si
dimension {dimension}
atom_style sphere
boundary p p p
newton off
read_data {stem}.data
pair_style zero {cutoff}
pair_coeff * *
comm_modify vel no cutoff {cutoff}
set group all x 0
set group all y 0
read_dump {stem}.dump {step} {fields} box yes replace yes format native
write_dump all custom {stem}.back id type x y z radius modify format float %.17g sort id
"""


def read(path):
    lines = path.read_text().splitlines()
    box = numpy.array([[float(word) for word in line.split()] for line in lines[5:8]])
    atoms = numpy.array([[float(word) for word in line.split()] for line in lines[9:]])
    return int(lines[1]), box, atoms[atoms[:, 0].argsort()]


def main():
    for name, dimension in (("dense", 2), ("hertz", 3)):
        stem, test = work / name, work / f"{name}.test.h5"
        rvelab("run", "simple_shear", "--specimen", imported(name), "-o", test, "--force",
               *sets("stage.shear.to_strain=0.03", "stage.shear.record_every=0.03"))
        for kind, suffix in (("lammps", "dump"), ("lammps-data", "data")):
            rvelab("export", test, "--format", kind, "-o", f"{stem}.{suffix}", "--force")
        step, box, atoms = read(stem.with_suffix(".dump"))
        fields = "x y vx vy" if dimension == 2 else "x y z vx vy vz"
        (stem.with_suffix(".in")).write_text(SCRIPT.format(dimension=dimension, stem=stem, step=step, fields=fields,
                                                           cutoff=2.5 * atoms[:, 5].max()))
        run("lmp", "-in", f"{stem}.in", "-log", "none")
        _, box_back, atoms_back = read(stem.with_suffix(".back"))
        if atoms_back.shape[0] != atoms.shape[0]:
            sys.exit(f"lammps: {name}: {atoms_back.shape[0]} atoms of {atoms.shape[0]} came back")
        # LAMMPS goes through fractional coordinates and back: the last bits are its own.
        size = (box[:, 1] - box[:, 0]).max()
        error = abs(atoms_back[:, 2:5] - atoms[:, 2:5]).max() / size
        if not (abs(box_back - box).max() <= 1e-15 * size and error <= 1e-15
                and (atoms_back[:, 5] == atoms[:, 5]).all()):
            sys.exit(f"lammps: {name}: positions differ by {error} of the box")
        print(f"lammps: {name}: {atoms.shape[0]} atoms read back, largest error {error:.1e} of the box")


if __name__ == "__main__":
    harness.main(main)
