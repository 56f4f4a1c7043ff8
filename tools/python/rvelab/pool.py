"""A pool of many RVEs: Pool, over the C interface."""
from __future__ import annotations

import json
import os
import sys
import tomllib
from ctypes import byref, c_char_p, c_double, c_int32, c_int64, c_size_t, c_void_p, create_string_buffer, sizeof
from typing import Any, Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from .interrupt import long_call
from .library import (MEASURES, Array, Batch, BatchStruct, Definition, Info, Mixed, MixedStruct, RvelabError,
                      RvelabWarning, bytes_of, call, functions, gradients_of, id_of, library, numbers_of)
from .program import flat, plain

_COUNTED_IDS = 2  # RVELAB_POOL_COUNTED_IDS
_pool, _number, _ids, _size = c_void_p, c_int64, c_void_p, c_size_t
for _name, _arguments in {
        "pool_def_init": (c_void_p, _size), "pool_create": (c_void_p, c_void_p), "pool_destroy": (_pool,),
        "template_load": (_pool, c_char_p, c_void_p), "template_from_snapshot": (_pool, c_char_p, _size, c_void_p),
        "template_release": (_pool, _number), "spawn": (_pool, _number, _number, _ids),
        "clone": (_pool, _number, c_void_p), "release": (_pool, _number, _ids), "ids": (_pool, _number, _ids, c_void_p),
        "batch_init": (c_void_p, _size), "apply": (_pool, _number, c_void_p, c_double, c_void_p),
        "trial": (_pool, c_void_p), "commit": (_pool, _number, _ids), "revert": (_pool, _number, _ids),
        "mixed_init": (c_void_p, _size), "apply_mixed": (_pool, c_void_p),
        "relax": (_pool, _number, c_double, _number, c_void_p),
        "info_init": (c_void_p, _size), "get_info": (_pool, _number, c_void_p),
        "array_init": (c_void_p, _size), "list_arrays": (_pool, _number, _number, c_void_p, c_void_p),
        "get_array": (_pool, _number, c_char_p, c_void_p, _size, c_void_p),
        "get_parameters": (_pool, _number, c_char_p, _size, c_void_p), "set_parameters": (_pool, _number, c_char_p),
        "run_stages": (_pool, _number, _ids, c_char_p, c_void_p, c_void_p),
        "cost": (_pool, _number, _ids, c_void_p), "interrupt": (_pool, c_int32),
        "snapshot_save": (_pool, _number, c_void_p, _size, c_void_p),
        "snapshot_load": (_pool, _number, c_char_p, _size), "pool_write": (_pool, c_char_p),
        "pool_read": (_pool, c_char_p)}.items():
    functions[_name] = getattr(library, "rvelab_" + _name)
    functions[_name].argtypes = _arguments


def stages_text(stages: str | Mapping[str, Any] | Iterable[Mapping[str, Any]]) -> str:
    """Stages as TOML: a text of a protocol as it is; the keys of a stage, or of several."""
    if isinstance(stages, str):
        return stages
    listed = [stages] if isinstance(stages, Mapping) else list(stages)
    if not all(isinstance(stage, Mapping) for stage in listed):
        raise TypeError("stages: a text of TOML, or the keys of each stage, {'kind': 'cement', ...}")
    return "".join("[[stage]]\n" + _table_text(stage) for stage in listed)


def _table_text(table: Mapping[str, Any]) -> str:
    return "".join(f"{json.dumps(key)} = {_value_text(value)}\n" for key, value in table.items())


def _value_text(value: Any) -> str:
    if isinstance(value, Mapping):  # events, rows, components: inline tables
        return "{" + ", ".join(f"{json.dumps(key)} = {_value_text(each)}" for key, each in value.items()) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_value_text(each) for each in value) + "]"
    return json.dumps(value, default=plain)


def parameters_text(settings: Mapping[str, Any]) -> str:
    """Settings as lines of TOML. A list of materials becomes the keys of each by its name."""
    settings = dict(settings)
    listed = settings.pop("material") if isinstance(settings.get("material"), list) else []
    keys = flat(settings)
    for material in listed:
        keys.update({f"material.{json.dumps(material['name'])}.{key}": value for key, value in material.items()})
    return "".join(f"{key} = {json.dumps(value, default=plain)}\n" for key, value in keys.items())


class Pool:
    """Many RVEs with common threads. Options are those of rvelab_pool_def: workers (0: one per core),
    trial_memory (0 keep, 1 recompute), tolerance_rel, tolerance_abs, max_substeps, damping, min_height (m);
    0: the value of the specimen. Ids and tokens begin with random numbers, so that those of other pools and
    processes are errors; counted_ids: they count from the lowest, and snapshots and pool files of the same calls have
    the same bytes."""

    def __init__(self, counted_ids: bool = False, **options: float) -> None:
        self._pool, definition = c_void_p(), Definition()
        allowed = [name for name, _ in Definition._fields_[2:-2]]
        call("pool_def_init", byref(definition), sizeof(definition))
        for name, value in options.items():
            if name not in allowed:
                raise TypeError(f"Pool has no option {name!r}; allowed: {', '.join(allowed)}, counted_ids")
            setattr(definition, name, value)
        definition.flags = _COUNTED_IDS if counted_ids else 0
        call("pool_create", byref(definition), byref(self._pool))

    def close(self) -> None:
        """Joins the workers and frees every RVE. A second time it does nothing; later calls of the pool raise."""
        if self._pool:
            call("pool_destroy", self._pool)
            self._pool = c_void_p()

    def __enter__(self) -> "Pool":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        # As the interpreter ends, modules and other objects may be gone: the process gives all back.
        if getattr(self, "_pool", None) and not sys.is_finalizing():
            library.rvelab_pool_destroy(self._pool)
            self._pool = c_void_p()

    def template(self, source: str | os.PathLike[str] | bytes) -> int:
        """From a specimen file, a record file (its end state), or the bytes of snapshot(). To spawn from."""
        made = c_int64()
        if isinstance(source, (str, os.PathLike)):
            call("template_load", self._pool, os.fsencode(source), byref(made))
        else:
            snapshot = bytes_of(source)
            call("template_from_snapshot", self._pool, snapshot, len(snapshot), byref(made))
        return made.value

    def release_template(self, template: int) -> None:
        """Ends a template; RVEs made from it stay."""
        call("template_release", self._pool, template)

    def spawn(self, template: int, n: int = 1) -> np.ndarray:
        """n RVEs in the state of the template: their ids, (n) of int64, each also exact in a double."""
        ids = np.zeros(max(n, 0), np.int64)
        long_call("spawn", self._pool, template, n, ids.ctypes.data)
        return ids

    def clone(self, rve: int) -> int:
        """A second RVE in the committed state of the first, with its tokens."""
        made = c_int64()
        call("clone", self._pool, id_of(rve), byref(made))
        return made.value

    def release(self, rves: ArrayLike) -> None:
        """Ends RVEs: all of those named, or none."""
        ids = numbers_of(rves)
        call("release", self._pool, len(ids), ids.ctypes.data)

    def ids(self) -> np.ndarray:
        """Of all RVEs, in the order of their slots."""
        n = c_int64()
        call("ids", self._pool, 0, None, byref(n))
        ids = np.zeros(n.value, np.int64)
        call("ids", self._pool, n.value, ids.ctypes.data, byref(n))
        return ids

    def apply(self, rve: int, dH: ArrayLike, dt: float = 0) -> np.ndarray:
        """Trial and commit in one: sigma (3, 3) after dH (3, 3) over dt."""
        gradient, sigma = gradients_of(dH, (3, 3)), np.empty((3, 3))
        long_call("apply", self._pool, id_of(rve), gradient.ctypes.data, dt, sigma.ctypes.data, result=sigma)
        return sigma

    def trial(self, rves: ArrayLike, dH: ArrayLike, dt: float = 0, tokens: ArrayLike | None = None,
              want: str | Iterable[str] = (), out: Batch | None = None) -> Batch:
        """One trial of each of n RVEs, dH (n, 3, 3), from its committed state or from the one that its token names.
        commit() accepts them. want: a name among MEASURES, or several. out: a Batch of n whose arrays are used
        again. Raises if one fails; error.batch then has the results of the others. int64 and float64 arrays are not copied."""
        ids, batch = numbers_of(rves), BatchStruct()
        gradients = gradients_of(dH, (len(ids), 3, 3))
        want = want if isinstance(want, str) else tuple(want)  # once, where it is a generator
        found = Batch(len(ids), want) if out is None else out
        if out is not None:
            Batch.expect_fits(out, len(ids), want)
        named = None if tokens is None else numbers_of(tokens, "tokens")
        if named is not None and len(named) != len(ids):
            raise ValueError(f"tokens has the length {len(named)}; allowed: {len(ids)}, one for each RVE")
        call("batch_init", byref(batch), sizeof(batch))
        batch.n, batch.dt, batch.ids, batch.dH = len(ids), dt, ids.ctypes.data, gradients.ctypes.data
        batch.tokens_in = None if named is None else named.ctypes.data
        for name in ("sigma", *MEASURES):
            array = getattr(found, name)
            if array is not None:
                array.fill(np.nan)
                setattr(batch, name, array.ctypes.data)
        found.tokens.fill(0)
        batch.dt_scale, batch.status = found.dt_scale.ctypes.data, found.status.ctypes.data
        batch.tokens_out = found.tokens.ctypes.data
        long_call("trial", self._pool, byref(batch), batch=found)
        return found

    def batch(self, rves: ArrayLike, dH: ArrayLike, dt: float = 0, want: str | Iterable[str] = ()) -> Batch:
        """Trial and commit of n RVEs. Successful ones are committed, even if others fail."""
        try:
            found = self.trial(rves, dH, dt, want=want)
        except RvelabError as error:
            if error.batch is not None:
                self.commit(numbers_of(rves)[error.batch.tokens != 0])
            raise
        except RvelabWarning as warning:
            self.commit(rves)
            warning.args = (str(warning).replace("its trials are pending", "its trials are committed"),)
            raise
        self.commit(rves)
        return found

    def apply_mixed(self, rves: ArrayLike, strain: ArrayLike, stress: ArrayLike, value: ArrayLike, scale: ArrayLike,
                    dt: float = 0, missed: ArrayLike | None = None, spin: ArrayLike | None = None,
                    tolerance: float = 0) -> Mixed:
        """Trial and commit of n RVEs to rows A : d eps + B : d sigma = c, 3 in 2D, 6 in 3D: strain A and stress B
        (n, rows, 3, 3), value c, scale and missed (n, rows), spin (n, 3, 3); see rvelab_mixed in rvelab.h. Raises if one
        fails; error.batch then has the results of the others."""
        ids, mixed = numbers_of(rves), MixedStruct()
        n, rows = len(ids), np.shape(value)[-1]
        given = {name: gradients_of(array, shape, name) for name, array, shape in (
            ("strain", strain, (n, rows, 3, 3)), ("stress", stress, (n, rows, 3, 3)), ("value", value, (n, rows)),
            ("scale", scale, (n, rows)), ("missed", missed, (n, rows)), ("spin", spin, (n, 3, 3))) if array is not None}
        found = Mixed(n)
        call("mixed_init", byref(mixed), sizeof(mixed))
        mixed.n, mixed.rows, mixed.dt, mixed.tolerance, mixed.ids = n, rows, dt, tolerance, ids.ctypes.data
        for name, array in given.items():
            setattr(mixed, name, array.ctypes.data)
        for name in ("sigma", "dH", "held_error", "error_estimate", "status"):
            setattr(mixed, name, getattr(found, name).ctypes.data)
        mixed.tokens_out = found.tokens.ctypes.data
        long_call("apply_mixed", self._pool, byref(mixed), batch=found)
        return found

    def relax(self, rve: int, unbalanced: float, max_substeps: int = 100_000) -> np.ndarray:
        """sigma (3, 3) after sub-steps at a fixed cell until the unbalanced ratio is reached; warns if it is not."""
        sigma = np.empty((3, 3))
        long_call("relax", self._pool, id_of(rve), unbalanced, max_substeps, sigma.ctypes.data, result=sigma)
        return sigma

    def commit(self, rves: ArrayLike | None = None) -> None:
        """Pending trials become the states; None: all pending ones."""
        self._settle("commit", rves)

    def revert(self, rves: ArrayLike | None = None) -> None:
        """Discards pending trials; None: all."""
        self._settle("revert", rves)

    def _settle(self, name: str, rves: ArrayLike | None) -> None:
        ids = None if rves is None else numbers_of(rves)
        long_call(name, self._pool, 0 if ids is None else len(ids), None if ids is None else ids.ctypes.data)

    def info(self, rve: int) -> Info:
        """Measures of the committed state as attributes: void_ratio, p, q, fabric (3, 3), token ... (see Info)."""
        found = Info()
        call("info_init", byref(found), sizeof(found))
        call("get_info", self._pool, id_of(rve), byref(found))
        return found

    def arrays(self, rve: int) -> dict[str, Array]:
        """All arrays of the committed state by name: measures of the cell, columns of grains and contacts; unit,
        meaning, shape() of each."""
        n = c_int64()
        call("list_arrays", self._pool, id_of(rve), 0, None, byref(n))
        found = (Array * n.value)()
        for each in found:
            call("array_init", byref(each), sizeof(each))
        call("list_arrays", self._pool, id_of(rve), n.value, byref(found), byref(n))
        return {each.name.decode(): each for each in found}

    def array(self, rve: int, name: str) -> np.ndarray:
        """One of them, laboratory frame: "void_ratio", "grains/position_m" (n, 3), "contacts/force_N" (m, 3)."""
        about, need = self.arrays(rve).get(name), c_size_t()
        if about is None:
            call("get_array", self._pool, id_of(rve), name.encode(), None, 0, byref(need))  # says which there are
            raise RvelabError(f"no array {name}")
        values = np.empty(about.shape(), np.int64 if about.type else np.float64)
        call("get_array", self._pool, id_of(rve), name.encode(), values.ctypes.data, values.nbytes, byref(need))
        return values

    def parameters(self, rve: int) -> dict[str, Any]:
        """Parameters of law, damping, solver and materials by their keys: {"contact": {"law": ...}, "damping": ...,
        "solver": ..., "material": [{"name": ...}, ...]}."""
        need = c_size_t()
        call("get_parameters", self._pool, id_of(rve), None, 0, byref(need))
        text = create_string_buffer(need.value)
        call("get_parameters", self._pool, id_of(rve), text, need.value, byref(need))
        return tomllib.loads(text.value.decode())

    def set_parameters(self, rve: int, settings: Mapping[str, Any]) -> None:
        """Sets some of them, all others stay: {"solver.relative_tolerance": 1e-3, "material.sand.friction": 0.4}, or
        tables as parameters() returns them. The state has a new token; a pending trial is reverted."""
        call("set_parameters", self._pool, id_of(rve), parameters_text(settings).encode())

    def run_stages(self, rves: ArrayLike, stages: str | Mapping[str, Any] | Iterable[Mapping[str, Any]]) -> np.ndarray:
        """Runs stages of a test on RVEs, by the keys of protocols: {"kind": "cement", "young_modulus_Pa": 50e6, ...}, a
        list of such, or a text of TOML. Their ends are the new states, whose stresses are returned, (n, 3, 3) Pa; a
        pending trial is reverted. If one of them fails, RvelabError gives the reason: it is as before, the others have
        their new states."""
        ids = numbers_of(rves)
        sigma = np.full((len(ids), 3, 3), np.nan)
        long_call("run_stages", self._pool, len(ids), ids.ctypes.data, stages_text(stages).encode(), sigma.ctypes.data, None,
                        result=sigma)
        return sigma

    def cost(self, rves: ArrayLike) -> np.ndarray:
        """Grains times sub-steps made for each RVE in this pool, (n), including reverted trials."""
        ids = numbers_of(rves)
        made = np.zeros(len(ids), np.int64)
        call("cost", self._pool, len(ids), ids.ctypes.data, made.ctypes.data)
        return made

    def snapshot(self, rve: int) -> bytes:
        """The committed state with its tokens, bitwise, for the same build of rvelab; across builds: write()."""
        need = c_size_t()
        call("snapshot_save", self._pool, id_of(rve), None, 0, byref(need))
        buffer = create_string_buffer(need.value)
        call("snapshot_save", self._pool, id_of(rve), buffer, need.value, byref(need))
        return buffer.raw[:need.value]

    def restore(self, rve: int, snapshot: bytes) -> None:
        """The RVE takes the state of a snapshot, of any specimen; a pending trial is discarded."""
        held = bytes_of(snapshot)
        call("snapshot_load", self._pool, id_of(rve), held, len(held))

    def write(self, path: str | os.PathLike[str]) -> None:
        """All RVEs with ids and tokens into a pool file (HDF5)."""
        long_call("pool_write", self._pool, os.fsencode(path))

    def read(self, path: str | os.PathLike[str]) -> np.ndarray:
        """The RVEs of a pool file, with their ids and tokens, into this pool, which must have none. Their ids."""
        long_call("pool_read", self._pool, os.fsencode(path))
        return self.ids()
