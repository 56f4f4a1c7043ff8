"""One RVE."""
from __future__ import annotations

import contextlib
import os
import sys
from typing import Any, Iterable, Mapping, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .library import Array, Batch, Info, Mixed, RvelabError, RvelabWarning
from .pool import Pool

_FIELDS = tuple(name for name, _ in Info._fields_ if name not in ("struct_size", "flags"))


class Contacts(NamedTuple):
    """c contacts, laboratory frame; each is there once."""
    first: np.ndarray  #: (c) row of positions of the first grain
    second: np.ndarray  #: (c) row of the second grain
    branch: np.ndarray  #: (c, 3) m, from the first grain to the image of the second that it touches
    normal: np.ndarray  #: (c, 3) unit vectors from the first grain to the second
    normal_force: np.ndarray  #: (c) N, compression positive
    tangential_force: np.ndarray  #: (c, 3) N, on the second grain; both forces with dashpots


class Rve:
    """One RVE, in a separate or a given pool. source: a specimen file, a record file (its end state), or the bytes
    of snapshot(). The fields of Info are its attributes: rve.void_ratio, rve.p, rve.fabric; dir(rve) names all. It exists
    until close(), the end of its `with`, or the last reference to it; a given pool remains. pickle and copy use
    snapshot(): for the same build of rvelab, into a separate pool."""

    def __init__(self, source: str | os.PathLike[str] | bytes, pool: Pool | None = None, **options: float) -> None:
        if pool is not None and options:
            raise TypeError("options are those of a pool of its own: give them to the Pool")
        self.id, self._owns_pool, self._options = 0, pool is None, dict(options)
        self._held: dict[str, float] | None = None  # by the last step
        self.pool = Pool(workers=1, **options) if pool is None else pool
        template = self.pool.template(source)
        try:
            self.id = int(self.pool.spawn(template)[0])
        finally:
            self.pool.release_template(template)

    def close(self) -> None:
        """Ends the RVE, and its pool unless that was given. A second time it does nothing; later calls raise."""
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
        self._held = None
        return self.pool.apply(self.id, dH, dt)

    def apply_held(self, dH: ArrayLike, held: dict[str, float], dt: float = 0, tolerance: float = 0) -> Mixed:
        """An increment in which stresses come to given values, {"xx": -20e3} (Pa, tension positive), and all other
        components, the spin included, follow dH (3, 3): as the lateral stresses of a drained test. sigma[0] is the
        stress, dH[0] the applied increment. tolerance: relative to each stress; 0: 0.005. The remaining error of the step
        before with the same `held` is corrected."""
        dH, stress, d = np.asarray(dH, np.float64), self.stress, self.dimension
        names = ["xx", "yy", "xy"] if d == 2 else ["xx", "yy", "zz", "yz", "xz", "xy"]
        if not set(held) <= set(names):
            raise ValueError(f"held names {sorted(set(held) - set(names))}; allowed: {', '.join(names)}")
        A, B, c, scale = (np.zeros((1, len(names), *shape)) for shape in ((3, 3), (3, 3), (), ()))
        for k, name in enumerate(names):
            i, j = "xyz".index(name[0]), "xyz".index(name[1])
            rows = B if name in held else A
            rows[0, k, i, j] = rows[0, k, j, i] = 1 if i == j else 0.5
            c[0, k] = 0.5 * (dH[i, j] + dH[j, i])
            if name in held:
                c[0, k] = held[name] - 0.5 * (stress[i, j] + stress[j, i])
                scale[0, k] = max(abs(held[name]), 0.01 * abs(self.p))
        missed = np.where(scale > 0, c, 0) if self._held == held else None
        try:
            found = self.pool.apply_mixed(self.id, A, B, c, scale, dt, missed, 0.5 * (dH - dH.T)[np.newaxis], tolerance)
        except RvelabWarning:  # made an error by a filter
            self._held = dict(held)
            raise
        self._held = dict(held)
        return found

    def relax(self, unbalanced: float, max_substeps: int = 100_000) -> np.ndarray:
        """sigma (3, 3) after sub-steps at a fixed cell until the unbalanced ratio is reached."""
        self._held = None
        return self.pool.relax(self.id, unbalanced, max_substeps)

    def trial(self, dH: ArrayLike, dt: float = 0, token: int | None = None, want: str | Iterable[str] = ()) -> Batch:
        """A Batch of one: the result of dH. The trial is pending until commit(), revert() or the next call."""
        return self.pool.trial(self.id, np.asarray(dH, np.float64)[np.newaxis], dt, token, want)

    def commit(self) -> None:
        """The pending trial becomes the state."""
        self._held = None
        self.pool.commit(self.id)

    def revert(self) -> None:
        """Discards the pending trial."""
        self.pool.revert(self.id)

    def tangent(self) -> np.ndarray:
        """Elastic tangent (6, 6) of the present contacts, Pa: xx yy zz yz xz xy, engineering shear. Made by a trial
        of dH = 0, which replaces a pending one and is discarded."""
        try:
            found = self.trial(np.zeros((3, 3)), want="tangent")
        except RvelabWarning as warning:  # made an error by a filter
            self.revert()
            warning.args = (str(warning).replace("its trials are pending", "the state is as before"),)
            raise
        self.revert()
        return found.tangent[0]

    def snapshot(self) -> bytes:
        """The committed state with its tokens, bitwise, for the same build of rvelab; Rve(bytes) restores it."""
        return self.pool.snapshot(self.id)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the committed state as a specimen file, for run, plot, export, Rve."""
        with Pool(workers=1) as alone:  # a pool file of one RVE
            alone.spawn(alone.template(self.snapshot()))
            alone.write(path)

    @property
    def stress(self) -> np.ndarray:
        """(3, 3) Pa, Cauchy stress of the committed state, laboratory frame, tension positive. A pending trial stays."""
        return self.pool.info(self.id).sigma

    @property
    def positions(self) -> np.ndarray:
        """(n, 3) m, centres of the grains in the cell around the origin, laboratory frame."""
        info, positions = self.pool.info(self.id), self.array("grains/position_m")
        cell = (info.rotation @ info.lattice)[:info.dimension, :info.dimension]
        # A grain is held wherever it went; its images within the cell are the same grain.
        parts = np.linalg.solve(cell, positions[:, :info.dimension].T)
        positions[:, :info.dimension] -= (cell @ np.floor(parts + 0.5)).T
        return positions

    @property
    def radii(self) -> np.ndarray:
        """(n) m; of an ellipse sqrt(a b)."""
        return self.array("grains/radius_m")

    @property
    def contacts(self) -> Contacts:
        """The contacts of the committed state: first, second, branch, normal, normal_force, tangential_force.
        -(1/volume) sum of force (x) branch with force = normal_force normal + tangential_force is the stress of the
        contacts."""
        return Contacts(*(self.array("contacts/" + name) for name in (
            "i", "j", "branch_m", "normal", "normal_force_N", "tangential_force_N")))

    def arrays(self) -> dict[str, Array]:
        """All arrays of the committed state by name, with unit, meaning and shape()."""
        return self.pool.arrays(self.id)

    def array(self, name: str) -> np.ndarray:
        """One of them, laboratory frame: measures of the cell by the names of records ("void_ratio", "a_n"), columns of
        grains and contacts ("grains/orientation", "contacts/force_N")."""
        return self.pool.array(self.id, name)

    def parameters(self) -> dict[str, Any]:
        """Parameters of law, damping, solver and materials by their keys, as tables (Pool.parameters)."""
        return self.pool.parameters(self.id)

    def set_parameters(self, settings: Mapping[str, Any]) -> None:
        """Sets some of them: {"material.friction": 0.4}; all others stay (Pool.set_parameters)."""
        self.pool.set_parameters(self.id, settings)

    def run_stages(self, stages: str | Mapping[str, Any] | Iterable[Mapping[str, Any]]) -> np.ndarray:
        """Runs stages of a test by their keys, {"kind": "cement", ...}, and returns the stress (Pool.run_stages): for example
        to make bonds or water, dissolve cement, apply a pressure. rvelab.run also gives records."""
        return self.pool.run_stages([self.id], stages)[0]

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
