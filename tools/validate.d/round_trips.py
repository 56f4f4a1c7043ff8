"""Files that LAMMPS writes in several styles, and text of YADE's export.text: `rvelab import` finds the same grains.

Packings of tests/data go to LAMMPS as data files; LAMMPS writes them as dumps (plain, tilted box, in parts of the box,
packed by gzip, with units and time, with the columns of LIGGGHTS' tutorials) and by write_data, each number with the
digits that give the same double. What import reads of each is compared with what stands in the file: radii bit by bit,
positions modulo the cell. The last row is what YADE writes of the same grains by export.text (six digits).

Needs lammps, yade (that row alone), python3-h5py and python3-numpy (Debian).
"""

import gzip
import shutil
import sys

import h5py
import numpy

import harness
from harness import YADE, run, rvelab, sets, work

SCRIPT = """units si
dimension {dimension}
atom_style sphere
boundary p p p
newton off
read_data {stem}.data
pair_style zero {cutoff}
pair_coeff * *
comm_modify vel no cutoff {cutoff}
timestep 1e-9
run 0
write_dump all custom {stem}.plain id type x y z radius modify format float %.17g
write_dump all custom {stem}.unwrapped id type xu yu zu diameter modify format float %.17g
write_dump all custom {stem}.scaled id type xs ys zs radius modify format float %.17g sort id
write_dump all custom {stem}.packed.gz id type x y z radius modify format float %.17g
write_dump all custom {stem}.units id type x y z radius modify format float %.17g units yes time yes
write_dump all custom {stem}.liggghts id type type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius &
    modify format float %.17g
write_data {stem}.written
"""

EXPORT = """from yade import export
import numpy
for x, y, z, r in numpy.loadtxt('{table}'):
    O.bodies.append(sphere((x, y, z), r))
export.text('{text}')
"""


def stated(path, style):
    """The cell, and id, position and radius of each grain, as the file itself says them."""
    opened = gzip.open(path, "rt") if path.suffix == ".gz" else open(path)
    lines = opened.read().splitlines()
    if style == "write_data":
        at = {line.split(maxsplit=k)[-1]: line.split() for k in (2, 3) for line in lines[:20] if len(line.split()) > k}
        bounds = numpy.array([[float(word) for word in at[f"{axis}lo {axis}hi"][:2]] for axis in "xyz"])
        tilt = [float(word) for word in at["xy xz yz"][:3]] if "xy xz yz" in at else [0, 0, 0]
        begin = next(k for k, line in enumerate(lines) if line.startswith("Atoms")) + 2
        end = next(k for k in range(begin, len(lines)) if not lines[k].strip())
        rows = numpy.array([line.split()[:7] for line in lines[begin:end]], float)
        atoms = numpy.column_stack([rows[:, 0], rows[:, 4:7], rows[:, 2] / 2])
    else:
        head = next(k for k, line in enumerate(lines) if line.startswith("ITEM: BOX BOUNDS"))
        numbers = [[float(word) for word in line.split()] for line in lines[head + 1:head + 4]]
        tilt = [row[2] for row in numbers] if "xy xz yz" in lines[head] else [0, 0, 0]
        bounds = numpy.array([row[:2] for row in numbers])
        xy, xz, yz = tilt
        bounds[0] -= min(0, xy, xz, xy + xz), max(0, xy, xz, xy + xz)
        bounds[1] -= min(0, yz), max(0, yz)
        names = lines[head + 4].split()[2:]
        rows = numpy.array([line.split() for line in lines[head + 5:]], float)
        suffix = {"unwrapped": "u", "scaled": "s"}.get(style, "")
        position = rows[:, [names.index(axis + suffix) for axis in "xyz"]]
        radius = rows[:, names.index("radius")] if "radius" in names else rows[:, names.index("diameter")] / 2
        atoms = numpy.column_stack([rows[:, 0], position, radius])
    cell = numpy.diag(bounds[:, 1] - bounds[:, 0])
    cell[0, 1], cell[0, 2], cell[1, 2] = tilt
    if style == "scaled":
        atoms[:, 1:4] = bounds[:, 0] + atoms[:, 1:4] @ cell.T
    return cell, atoms[atoms[:, 0].argsort()]


def read(path, material, specimen, *more):
    rvelab("import", path, "--material", material, "-o", specimen, "--force", *more)
    with h5py.File(specimen) as file:
        return file["cell/lattice_m"][()], file["grains/position_m"][()], file["grains/radius_m"][()], file["grains/id"][()]


def compare(label, cell, atoms, found):
    lattice, position, radius, ids = found
    dimension = 2 if position.shape[1] == 2 or not position[:, -1].any() else 3
    if len(atoms) != len(radius):
        sys.exit(f"round trips: {label}: {len(radius)} of {len(atoms)} grains")
    inverse = numpy.linalg.inv(lattice[:dimension, :dimension])
    apart = position[:, :dimension] - atoms[:, 1:1 + dimension]
    images = numpy.rint(apart @ inverse.T)
    left = abs(apart - images @ lattice[:dimension, :dimension].T).max() / cell.max()
    same = (radius == atoms[:, 4]).all() and (ids == atoms[:, 0]).all()
    exact = (position[:, :dimension] == atoms[:, 1:1 + dimension])[(images == 0).all(axis=1)].mean()
    box = abs(lattice - cell)[:dimension, :dimension].max() / cell.max()
    good = same and left <= 1e-15 and box <= 1e-15
    moved = int((images != 0).any(axis=1).sum())
    harness.row(f"{label:24} {len(radius):5} grains, ids and radii {'equal' if same else 'DIFFER'}; positions within {left:.1e} "
                f"of the box, {100 * exact:.0f} % of the {len(radius) - moved} that stay in their image bit for bit; cell within {box:.1e}",
                good, good="", what=label)


def main():
    for name, dimension in (("dense", 2), ("hertz", 3)):
        stem = work / f"rt_{name}"
        source, test = harness.imported(name), f"{stem}.test.h5"
        rvelab("export", source, "--format", "csv", "-o", stem, "--force")
        rvelab("run", "simple_shear", "--specimen", source, "-o", test, "--force",
               *sets("stage.shear.to_strain=0.03", "stage.shear.record_every=0.03"))
        for box, state in (("upright", source), ("tilted", test)):
            case = work / f"{name}_{box}"
            rvelab("export", state, "--format", "lammps-data", "-o", f"{case}.data", "--force")
            _, atoms = stated(case.with_suffix(".data"), "write_data")
            case.with_suffix(".in").write_text(SCRIPT.format(dimension=dimension, stem=case,
                                                             cutoff=2.5 * atoms[:, 4].max()))
            run("lmp", "-in", f"{case}.in", "-log", "none")
            for style in ("plain", "unwrapped", "scaled", "packed.gz", "units", "liggghts", "written"):
                path = case.with_name(f"{case.name}.{style}")
                compare(f"{name} {box} {style}", *stated(path, "write_data" if style == "written" else style),
                        read(path, f"{stem}.material.toml", f"{case}.back.h5"))
    if shutil.which("yade"):
        table, text, script = (work / name for name in ("table", "yade.txt", "export.py"))
        numpy.savetxt(table, numpy.loadtxt(YADE / "hertz.particles.csv", delimiter=",", comments=("#", "i"))[:, 1:5],
                      fmt="%.17g")
        script.write_text(EXPORT.format(table=table, text=text))
        run("yade", "-x", "-n", script)
        rows = numpy.loadtxt(text)
        atoms = numpy.column_stack([numpy.arange(1, len(rows) + 1), rows])
        edges = rows[:, :3].max(axis=0) - rows[:, :3].min(axis=0) + 2 * rows[:, 3].max()
        compare("hertz, YADE's text", numpy.diag(edges), atoms,
                read(text, work / "rt_hertz.material.toml", work / "y.h5", "--cell",
                                                                     ",".join(repr(float(edge)) for edge in edges)))


if __name__ == "__main__":
    harness.main(main)
