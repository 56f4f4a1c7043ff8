"""One RVE."""
from __future__ import annotations

import contextlib
import csv
import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any, Iterable, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .library import Batch, Info, RvelabError
from .pool import Pool
from .program import ask

_FIELDS = tuple(name for name, _ in Info._fields_ if name not in ("struct_size", "flags"))


class Contacts(NamedTuple):
    """c contacts, laboratory frame; each is there once."""
    first: np.ndarray  #: (c) row of positions of the first grain
    second: np.ndarray  #: (c) row of the second grain
    branch: np.ndarray  #: (c, 3) m, from the first grain to the image of the second that it touches
    normal: np.ndarray  #: (c, 3) unit vectors from the first grain to the second
    normal_force: np.ndarray  #: (c) N, compression positive
    tangential_force: np.ndarray  #: (c, 3) N, on the second grain; without dashpots


class Rve:
    """One RVE, in a pool of its own or in one given. source: a specimen file, a record file (its end state), or the bytes
    of snapshot(). The fields of Info are its attributes: rve.void_ratio, rve.p, rve.fabric; dir(rve) names all. It lives
    until close(), the end of its `with`, or the last reference to it: of a pool that was given nothing else ends. pickle
    and copy go by snapshot(): for the same build of rvelab, into a pool of its own."""

    def __init__(self, source: str | os.PathLike[str] | bytes, pool: Pool | None = None, **options: float) -> None:
        if pool is not None and options:
            raise TypeError("options are those of a pool of its own: give them to the Pool")
        self.id, self._owns_pool, self._options = 0, pool is None, dict(options)
        self._read: tuple[bytes, dict[str, Any]] | None = None
        self.pool = Pool(workers=1, **options) if pool is None else pool
        template = self.pool.template(source)
        try:
            self.id = int(self.pool.spawn(template)[0])
        finally:
            self.pool.release_template(template)

    def close(self) -> None:
        """Ends the RVE, and its pool if that is its own. A second time it does nothing; later calls raise."""
        if self.id and self.pool._pool and not self._owns_pool:
            self.pool.release(self.id)
        self.id = 0
        if self._owns_pool:
            self.pool.close()

    def __enter__(self) -> "Rve":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        # As Pool.__del__. An RVE that cannot be ended now, for another thread is at work in its pool, ends with that.
        if getattr(self, "id", 0) and not sys.is_finalizing():
            with contextlib.suppress(RvelabError):
                self.close()

    def apply(self, dH: ArrayLike, dt: float = 0) -> np.ndarray:
        """sigma (3, 3), Pa, tension positive, after the increment of displacement gradient dH (3, 3) over dt, s."""
        return self.pool.apply(self.id, dH, dt)

    def trial(self, dH: ArrayLike, dt: float = 0, token: int | None = None, want: Iterable[str] = ()) -> Batch:
        """A Batch of one: what dH would give. It pends until commit(), revert() or the next call."""
        return self.pool.trial(self.id, np.asarray(dH, np.float64)[np.newaxis], dt, token, want)

    def commit(self) -> None:
        """The pending trial becomes the state."""
        self.pool.commit(self.id)

    def revert(self) -> None:
        """Discards the pending trial."""
        self.pool.revert(self.id)

    def tangent(self) -> np.ndarray:
        """Elastic tangent (6, 6) of the contacts as they are, Pa: xx yy zz yz xz xy, engineering shear. Made by a trial
        of dH = 0, which replaces a pending one and is discarded."""
        found = self.trial(np.zeros((3, 3)), want=("tangent",)).tangent[0]
        self.revert()
        return found

    def snapshot(self) -> bytes:
        """The committed state with its tokens, bitwise, for the same build of rvelab; Rve(bytes) has it again."""
        return self.pool.snapshot(self.id)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the committed state as a file that everything reads which reads a specimen: run, plot, export, Rve."""
        with Pool(workers=1) as alone:  # a pool file of one RVE
            alone.spawn(alone.template(self.snapshot()))
            alone.write(path)

    @property
    def stress(self) -> np.ndarray:
        """(3, 3) Pa, Cauchy stress of the committed state, laboratory frame, tension positive. A pending trial stays."""
        twin = self.pool.clone(self.id)
        try:
            return self.pool.trial(twin, np.zeros((1, 3, 3))).sigma[0].copy()
        finally:
            self.pool.release(twin)

    @property
    def positions(self) -> np.ndarray:
        """(n, 3) m, centres of the grains in the cell around the origin, laboratory frame."""
        return self._grains()["positions"].copy()

    @property
    def radii(self) -> np.ndarray:
        """(n) m; of an ellipse sqrt(a b)."""
        return self._grains()["radii"].copy()

    @property
    def contacts(self) -> Contacts:
        """The contacts of the committed state: first, second, branch, normal, normal_force, tangential_force.
        -(1/volume) sum of force (x) branch with force = normal_force normal + tangential_force is the stress, except for
        dashpots and strain that waits for the next sub-step."""
        return Contacts(*(array.copy() for array in self._grains()["contacts"]))

    def _grains(self) -> dict[str, Any]:
        """Grains and contacts as the program exports them; kept until the state is another."""
        snapshot = self.snapshot()
        if self._read is None or self._read[0] != snapshot:
            with tempfile.TemporaryDirectory() as folder:
                self.save(os.path.join(folder, "S.h5"))
                stem = os.path.join(folder, "S")
                ask(["export", stem + ".h5", "--format", "csv", "-o", stem])
                self._read = snapshot, _read_csv(stem)
        return self._read[1]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in _FIELDS:
            raise AttributeError(f"Rve has no attribute {name!r}; those of its state are the fields of rvelab.Info: "
                                 + ", ".join(_FIELDS))
        return getattr(self.pool.info(self.id), name)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *_FIELDS})

    def __repr__(self) -> str:
        if not self.id or not self.pool._pool:
            return "<rvelab.Rve, closed>"
        info = self.pool.info(self.id)
        return (f"<rvelab.Rve: {info.grains} grains, {info.dimension}D, {info.contacts} contacts\n"
                f" p = {info.p:.4g} Pa, q = {info.q:.4g} Pa, void ratio {info.void_ratio:.4f}, "
                f"coordination number {info.coordination_number:.2f}>")

    def __reduce__(self) -> tuple[Any, ...]:
        return _from_snapshot, (self.snapshot(), self._options)


def _from_snapshot(snapshot: bytes, options: dict[str, float]) -> Rve:
    return Rve(snapshot, **options)


def _rows(path: str) -> list[dict[str, str]]:
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def _columns(rows: list[dict[str, str]], names: list[str], kind: type = float) -> np.ndarray:
    """(rows, 3), of 2D files with zeros for z."""
    found = np.zeros((len(rows), 3), kind)
    for k, name in enumerate(names):
        if rows and name in rows[0]:
            found[:, k] = [kind(row[name]) for row in rows]
    return found


def _read_csv(stem: str) -> dict[str, Any]:
    """Arrays of the files that `rvelab export --format csv` writes."""
    grains, touching = _rows(stem + ".particles.csv"), _rows(stem + ".contacts.csv")
    meta = json.loads(Path(stem + ".json").read_text())
    cell = np.zeros((3, 3))
    cell[:meta["dim"], :meta["dim"]] = np.array(meta["hSize"])[:meta["dim"], :meta["dim"]]
    row = {int(grain["id"]): k for k, grain in enumerate(grains)}
    positions = _columns(grains, ["x", "y", "z"])
    radii = np.array([float(grain["r"]) if "r" in grain else float(grain["radius"]) if "radius" in grain else
                      (float(grain["a"]) * float(grain["b"])) ** 0.5 for grain in grains])
    first = np.array([row[int(contact["id1"])] for contact in touching], int)
    second = np.array([row[int(contact["id2"])] for contact in touching], int)
    image = _columns(touching, ["sx", "sy", "sz"], int)
    branch = positions[second] + image @ cell.T - positions[first]
    normal = branch / np.linalg.norm(branch, axis=1, keepdims=True)
    if touching and "nx" in touching[0]:  # ellipses
        normal = _columns(touching, ["nx", "ny", "nz"])
    force = np.array([float(contact["fn"]) for contact in touching])
    # Files hold a grain wherever it went; its images within the cell are the same grain.
    d = meta["dim"]
    parts = np.linalg.solve(cell[:d, :d], positions[:, :d].T)
    positions[:, :d] -= (cell[:d, :d] @ np.floor(parts + 0.5)).T
    return {"positions": positions, "radii": radii,
            "contacts": (first, second, branch, normal, force, _columns(touching, ["fsx", "fsy", "fsz"]))}
