"""Checkpoints of the host and of its RVEs, in one call, for any number of ranks.

A folder holds pool files, one of each rank that wrote it (tools/manual/pages/file_format.md), and host.npz, which
names them: arrays in the order of the points, whatever their ranks. host.npz is replaced last, so that a run that is
killed leaves the checkpoint before it."""
from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import rvelab

from . import compat
from .ranks import together
from .solver import Solver

FORMAT = 1
PER_POINT = "sigma", "error", "F", "stress", "tangent", "beside", "shared_F", "home", "id"


def save(solver: Solver, folder: str | os.PathLike[str]) -> None:
    """Collective. The committed state; a checkpoint in the folder is replaced."""
    material, comm, folder = solver.material, solver.material.mesh.comm, Path(folder)
    points, d = material.points, material.d
    generation = comm.bcast(together(comm, lambda: _generation(folder) if comm.rank == 0 else 0))
    together(comm, lambda: points.pool.write(folder / f"pool_{generation}_{comm.rank}.h5"))
    cells = np.asarray(material.mesh.topology.original_cell_index)[:len(material.cells)]
    dofs = compat.cell_dofs(material.space, len(cells))
    last = np.zeros_like(material.u.x.array) if solver._last is None else solver._last
    stress, tangent = material.values()
    mine = dict(numbers=material.numbers, cells=cells, u=material.u.x.array.reshape(-1, d)[dofs],
                last=last.reshape(-1, d)[dofs], sigma=material.sigma, error=material.error, F=material.F, stress=stress,
                tangent=tangent, beside=material.beside, shared_F=points.F, home=points.home, id=points.ids)
    parts = comm.gather(mine)
    about = dict(format=FORMAT, generation=generation, t=solver.t, dt=solver.dt, last_dt=solver._last_dt,
                 version=rvelab.__version__, **_kind(material))
    together(comm, lambda: _write(folder, about, parts) if comm.rank == 0 else None)


def _generation(folder: Path) -> int:
    folder.mkdir(parents=True, exist_ok=True)
    return max((int(file.name.split("_")[1]) for file in folder.glob("pool_*_*.h5")), default=-1) + 1


def _kind(material: Any) -> dict[str, Any]:
    """Collective. What a checkpoint and the Material of a program must agree in."""
    comm = material.mesh.comm
    return dict(points=comm.allreduce(len(material.numbers)), cells=comm.allreduce(len(material.cells)),
                dimension=material.d, strains="finite" if material.finite else "small", degree=material.degree)


def _write(folder: Path, about: dict[str, Any], parts: list[dict[str, np.ndarray]]) -> None:
    whole = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    by_number, by_cell = np.argsort(whole["numbers"]), np.argsort(whole["cells"])
    arrays = {name: whole[name][by_number] for name in PER_POINT}
    arrays |= {name: whole[name][by_cell] for name in ("u", "last")}
    with open(folder / "host.part", "wb") as file:
        np.savez(file, about=json.dumps(about), **arrays)
        file.flush()
        os.fsync(file.fileno())
    os.replace(folder / "host.part", folder / "host.npz")
    for file in folder.glob("pool_*_*.h5"):
        if int(file.name.split("_")[1]) != about["generation"]:
            file.unlink()


def load(solver: Solver, folder: str | os.PathLike[str]) -> None:
    """Collective. Mesh, specimens, constraints and loads are those of the program, state and time those of the
    checkpoint."""
    material, comm, folder = solver.material, solver.material.mesh.comm, Path(folder)
    about, arrays = together(comm, lambda: _host(folder))
    points, d = material.points, material.d
    _compare(folder, about, _kind(material))
    mine = {name: arrays[name][material.numbers] for name in PER_POINT}
    points.restore(together(comm, lambda: _snapshots(folder, about, mine)), mine["shared_F"])
    cells = np.asarray(material.mesh.topology.original_cell_index)[:len(material.cells)]
    dofs = compat.cell_dofs(material.space, len(cells))
    for name, function in (("last", material.du), ("u", material.u)):
        function.x.array.reshape(-1, d)[dofs] = arrays[name][cells]
        function.x.scatter_forward()
    solver._last = material.du.x.array.copy() if about["last_dt"] > 0 else None
    material.du.x.array[:] = 0
    for name in ("sigma", "error", "F", "beside"):
        setattr(material, name, mine[name])
    material.set_values(mine["stress"], mine["tangent"])
    material.keep()
    solver.forms.t = about["t"]
    solver.t, solver.dt, solver._last_dt = about["t"], about["dt"], about["last_dt"]


def _compare(folder: Path, about: dict[str, Any], own: dict[str, Any]) -> None:
    if (about["points"], about["dimension"]) != (own["points"], own["dimension"]):
        raise ValueError(f"{folder} holds {about['points']} points in {about['dimension']}D, and the mesh has "
                         f"{own['points']} in {own['dimension']}D: a checkpoint is for the mesh and the elements that it "
                         "was made with")
    for key, value in own.items():
        held = about.get(key, value)  # older checkpoints do not name all
        if held != value:
            remedy = "take the mesh that it was made with" if key == "cells" else f"set {key} to {held}"
            raise ValueError(f"{folder} was made with {key} {held}, and this material has {key} {value}: {remedy}, or "
                             "begin without the checkpoint")


def _snapshots(folder: Path, about: dict[str, Any], mine: dict[str, np.ndarray]) -> list[bytes | None]:
    """Of the RVEs of this rank's points; None: the point has none."""
    snapshots: list[bytes | None] = [None] * len(mine["home"])
    for rank in sorted(set(mine["home"][mine["home"] >= 0].tolist())):
        with rvelab.Pool(workers=1) as held:
            held.read(folder / f"pool_{about['generation']}_{rank}.h5")
            for k in np.flatnonzero(mine["home"] == rank):
                snapshots[k] = held.snapshot(int(mine["id"][k]))
    return snapshots


def rve(folder: str | os.PathLike[str], number: int, output: str | os.PathLike[str]) -> str:
    """Writes the RVE of a point, by its number in the output, as a specimen file. What it is, in a sentence."""
    folder = Path(folder)
    about, arrays = _host(folder)
    if not 0 <= number < about["points"]:
        raise ValueError(f"point {number}: {folder} holds points 0 to {about['points'] - 1}")
    home, wanted = int(arrays["home"][number]), int(arrays["id"][number])
    if home < 0:
        raise ValueError(f"point {number} has no RVE of its own: it saw elastic strain alone, and is its specimen")
    with rvelab.Pool(workers=1) as held, rvelab.Pool(workers=1) as alone:
        held.read(folder / f"pool_{about['generation']}_{home}.h5")
        alone.spawn(alone.template(held.snapshot(wanted)))
        alone.write(output)
    return f"{output}: the RVE of point {number} at t = {about['t']:g}"


def _host(folder: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    try:
        with np.load(folder / "host.npz") as file:
            about, arrays = json.loads(str(file["about"])), {name: file[name] for name in file.files if name != "about"}
    except FileNotFoundError:
        raise ValueError(f"{folder} holds no host.npz: no checkpoint was made there") from None
    if about["format"] != FORMAT:
        raise ValueError(f"{folder / 'host.npz'} is of format {about['format']}; this version reads format {FORMAT}")
    return about, arrays
