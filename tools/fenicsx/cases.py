"""What the cases share: their options, specimens, meshes, and the run with its table, files and summary."""
from __future__ import annotations

import argparse
import csv
import difflib
import re
import sys
import warnings
from pathlib import Path
from typing import Any, Callable, NoReturn, Sequence

import numpy as np
import rvelab
from dolfinx import mesh
from mpi4py import MPI

from .checkpoint import load, save
from .material import Material
from .output import Output
from .solver import Increment, NotConverged, Solver
from .summary import summary


def positive(text: str) -> float:
    """Of an option: a number above zero."""
    value = float(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text}: allowed are numbers above 0")
    return value


def count(text: str) -> int:
    """Of an option: a whole number from 1 on."""
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}: allowed are whole numbers from 1 on")
    return int(text)


class Options(argparse.ArgumentParser):
    """Help and mistakes are the same on all ranks, and printed by the first. A mistake is one line, with the nearest
    option."""

    def print_help(self, file: Any = None) -> None:
        if MPI.COMM_WORLD.rank == 0:
            super().print_help(file)

    def error(self, message: str) -> NoReturn:
        unknown = re.fullmatch(r"unrecognized arguments: (--[^\s=]+).*", message)
        near = difflib.get_close_matches(unknown.group(1), self._option_string_actions) if unknown else []
        if unknown:
            message = f"there is no option {unknown.group(1)}" + (f"; the nearest is {near[0]}" if near else "")
        if MPI.COMM_WORLD.rank == 0:
            print(f"rvelab.fenicsx: {message} ({self.prog} --help lists all)", file=sys.stderr, flush=True)
        sys.exit(2)


def parser(name: str, text: str, **defaults: Any) -> argparse.ArgumentParser:
    """Options of a case; defaults: recipe, grains, draws, elements, to, first."""
    made = Options(prog=f"python3 -m rvelab.fenicsx {name}", description=text,
                   formatter_class=argparse.RawDescriptionHelpFormatter)
    add = made.add_argument
    add("-o", "--output", type=Path, default=Path(name), metavar="FOLDER", help="default: the name of the case")
    add("--specimens", nargs="+", metavar="FILE", help="files, drawn for each point; default: packed by --recipe")
    add("--recipe", default=defaults["recipe"], help="of `rvelab protocols` (default: %(default)s)")
    add("--grains", type=count, default=defaults["grains"], help="in each specimen (default: %(default)s)")
    add("--draws", type=count, default=defaults["draws"], help="number of specimens (default: %(default)s)")
    add("--elements", type=count, default=defaults["elements"], help="fineness (default: %(default)s)")
    add("--degree", type=int, default=1, choices=(1, 2), help="of the displacement (default: 1)")
    add("--to", type=positive, default=defaults["to"], help="load parameter at the end (default: %(default)s)")
    add("--first", type=positive, default=defaults["first"], help="first and largest increment (default: %(default)s)")
    add("--tolerance", type=positive, default=1e-3, help="of forces and of the stresses of RVEs (default: 1e-3)")
    add("--strains", default="finite", choices=("finite", "small"))
    add("--length", type=float, default=0, metavar="M", help="gives bands a width; 0: none (default)")
    add("--stiffening", type=float, default=0.1, help="of strain beside its average over that length (default: 0.1)")
    add("--share", type=float, metavar="ERROR", help="of the stress over the pressure, that points may have which "
        "share an RVE while they are elastic (default: the tolerance); 0: each point has an RVE")
    add("--no-balance", action="store_true", help="RVEs stay on the rank of their point")
    add("--frames", type=int, default=10, metavar="N", help="increments between files for ParaView; 0: none (default: 10)")
    add("--keep", type=int, default=10, metavar="N", help="increments between checkpoints; 0: none (default: 10)")
    add("--resume", action="store_true", help="from the checkpoint in the output folder, on any number of ranks")
    return made


def specimens(o: Any, comm: Any) -> list[str]:
    """Collective. The specimen files, packed by the first rank if none are given; from then on these are the given."""
    if o.specimens:
        missing = [file for file in o.specimens if not Path(file).exists()]
        if missing:
            raise ValueError(f"--specimens: there is no file {missing[0]}")
        return o.specimens
    files, failure = [str(o.output / f"specimen_{k + 1}.h5") for k in range(o.draws)], None
    if comm.rank == 0:
        o.output.mkdir(parents=True, exist_ok=True)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", rvelab.RvelabWarning)
                for k, file in enumerate(files):
                    if not (o.resume and Path(file).exists()):
                        rvelab.pack(o.recipe, file, {"pack.number": o.grains, "pack.seed": k + 1}, overwrite=True)
        except rvelab.RvelabError as error:
            failure = str(error)
    failure = comm.bcast(failure)
    if failure:
        raise ValueError(failure)
    o.specimens = files
    return files


def material(o: Any, comm: Any, body: Any, **more: Any) -> Material:
    return Material(body, specimens(o, comm), strains=o.strains, degree=o.degree, tolerance=o.tolerance,
                    share=True if o.share is None else o.share, balance=not o.no_balance, length=o.length,
                    stiffening=o.stiffening, **more)


def angles(o: Any, comm: Any, pressures: Sequence[float]) -> tuple[float, float]:
    """Collective. Friction angles of the same specimens in biaxial tests at these pressures (Pa): peak and at 15 % of
    strain, degrees, means over specimens and pressures."""
    found = None
    if comm.rank == 0:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tests = rvelab.calibrate("biaxial", o.specimens, list(pressures))
        each = tests["per_pressure"]
        found = (float(np.mean([test["friction_angle_deg"] for test in each])),
                 float(np.mean([test["large_strain_friction_angle_deg"] for test in each])))
    return comm.bcast(found)


def graded(fine: int, size: float, count: int, length: float) -> np.ndarray:
    """Coordinates of nodes: `fine` elements of `size`, then count - fine that grow by one ratio up to `length`."""
    rest, below, above = length - fine * size, 1.0, 10.0
    for _ in range(100):
        ratio = 0.5 * (below + above)
        short = size * np.sum(ratio ** np.arange(1, count - fine + 1)) < rest
        below, above = (ratio, above) if short else (below, ratio)
    sizes = np.concatenate([np.full(fine, size), size * ratio ** np.arange(1, count - fine + 1)])
    return np.concatenate([[0.0], np.cumsum(sizes) * length / sizes.sum()])


def rectangle(comm: Any, x: np.ndarray, y: np.ndarray) -> Any:
    """Quadrilaterals between these coordinates of nodes."""
    n = len(x) - 1, len(y) - 1
    made = mesh.create_rectangle(comm, [(0, 0), n], n, mesh.CellType.quadrilateral)
    for k, places in enumerate((x, y)):
        made.geometry.x[:, k] = np.interp(made.geometry.x[:, k], np.arange(len(places)), places)
    return made


def follow(o: Any, comm: Any, solver: Solver, columns: Sequence[str],
           row: Callable[[Increment], Sequence[float]]) -> dict[str, np.ndarray]:
    """Collective. Runs the case to its end, or to where it fails: prints the table, writes curve.csv, fields and
    checkpoints, prints the summary. The columns as arrays, with `t` the first."""
    names, rows, first = ["t", *columns], [], comm.rank == 0
    kept = o.output / "checkpoint"
    earlier = _saved(kept)  # another run may have left one there
    curve = o.output / "curve.csv"
    if o.resume:
        load(solver, kept)
        with open(curve, newline="") as file:
            rows = [list(map(float, each)) for each in list(csv.reader(file))[1:]]
        rows = [each for each in rows if each[0] <= solver.t * (1 + 1e-9)]
    if first:
        o.output.mkdir(parents=True, exist_ok=True)
    folder = o.output / (f"fields_from_{solver.t:.4g}" if o.resume else "fields")
    fields = Output(solver.material, folder) if o.frames else None
    _print(first, f"{len(rows)} rows of the run before\n" if o.resume else "", "  ".join(f"{name:>12}" for name in names),
           "  iterations  residual  RVEs")
    try:
        for step in solver.march(o.to, o.first):
            rows.append([step.t, *map(float, row(step))])
            made = comm.allreduce(int(solver.material.points.made.sum()))
            _print(first, "", "  ".join(f"{value:12.5g}" for value in rows[-1]),
                   f"  {step.iterations:10}  {step.residual:8.1e}  {made:4}" + ("  resolved" if step.resolved else ""))
            if first:
                with open(curve, "w", newline="") as file:
                    csv.writer(file).writerows([names, *rows])
            if fields and len(solver.history) % o.frames == 0:
                fields.write(step.t)
            if o.keep and len(solver.history) % o.keep == 0:
                save(solver, kept)
    except NotConverged as error:
        _print(first, f"stopped: {error}")
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"stopped after t = {solver.t:.4g}; " + (
            f"{kept} holds the last checkpoint, --resume goes on from it" if o.resume or _saved(kept) != earlier else
            "no checkpoint was made yet (--keep)")) from None
    finally:
        if fields:
            fields.close()
    if o.keep and solver.history:
        save(solver, kept)
    _print(first, *("\n" + line for line in summary(solver)))
    return dict(zip(names, np.array(rows).T.reshape(len(names), -1)))


def _saved(checkpoint: Path) -> int:
    """When, ns; 0: never."""
    file = checkpoint / "host.npz"
    return file.stat().st_mtime_ns if file.exists() else 0


def tell(comm: Any, *lines: str) -> None:
    _print(comm.rank == 0, *(line + "\n" for line in lines))


def _print(wanted: bool, *parts: str) -> None:
    if wanted:
        print("".join(parts).strip("\n"), flush=True)
