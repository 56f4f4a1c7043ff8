"""The C interface of librvelab.so.1: structs, exceptions, and calls that raise."""
from __future__ import annotations

import ctypes
import os
import sys
import warnings
from ctypes import c_char_p, c_double, c_int32, c_int64, c_uint32, c_void_p
from pathlib import Path
from typing import Any, Iterable

import numpy as np
from numpy.typing import ArrayLike

MEASURES = ("contact", "reynolds", "tangent", "error_estimate")


class RvelabError(RuntimeError):
    """A call failed, and the state is as before. status: number in rvelab.h (None: the program failed); batch: results of
    the other RVEs gave."""

    def __init__(self, text: str, status: int | None = None, batch: "Batch | None" = None) -> None:
        super().__init__(text)
        self.status, self.batch = status, batch


class Discard(RvelabError):
    """The increment failed: try a smaller one (batch.dt_scale times it, after a trial)."""


class StaleToken(RvelabError):
    """No current trial of this RVE has that token."""


class OutOfMemory(RvelabError, MemoryError):
    """There is not enough memory."""


class RvelabWarning(UserWarning):
    """The result is usable. The text is always the same, so that Python shows it once per line; detail is the
    library's text with its figures, status the number in rvelab.h. If a filter of warnings makes it an error, the call has
    still been made: result is its return value."""
    result: Any = None

    def __init__(self, text: str, status: int | None = None, detail: str = "") -> None:
        super().__init__(text)
        self.status, self.detail = status, detail


_warnings = {1: "the expected error of the stress is above the tolerance (error_estimate says by how much)",
             2: "the state is no equilibrium: the specimen flows or collapses",
             3: "a height of the cell is below four mean diameters",
             4: "the contact network has no elastic tangent; the affine one, which is stiffer, was written",
             5: "a stress of the mixed target was missed by more than the tolerance"}


class Definition(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("workers", c_int32), ("trial_memory", c_int32),
                ("tolerance_rel", c_double), ("tolerance_abs", c_double), ("max_substeps", c_int64),
                ("damping", c_double), ("min_height", c_double), ("run_tasks", c_void_p), ("host", c_void_p)]


class BatchStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("n", c_int64), ("dt", c_double)] + [
        (name, c_void_p) for name in ("ids", "dH", "tokens_in", "sigma", "contact", "reynolds", "tangent",
                                      "error_estimate", "dt_scale", "status", "tokens_out")]


class Info(ctypes.Structure):
    """Measures of a committed state, by the names and units of rvelab_info in rvelab.h; tensors as tuples of nine."""
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("dimension", c_int64), ("grains", c_int64),
                ("contacts", c_int64), ("lattice", 9 * c_double), ("rotation", 9 * c_double), ("volume", c_double),
                ("void_ratio", c_double), ("coordination_number", c_double), ("fabric", 9 * c_double)] + [
        (name, c_double) for name in ("fabric_anisotropy", "sliding_fraction", "p", "q", "unbalanced_force_ratio",
                                      "inertial_number", "permeability_ratio", "min_height_ratio")] + [
        (name, c_int64) for name in ("grain_steps", "bytes_resting", "bytes_trial", "bytes_working", "token")] + [
        (name, 9 * c_double) for name in ("sigma", "contact", "reynolds")] + [("error_estimate", c_double)]

    def __getattribute__(self, name: str) -> Any:
        value = super().__getattribute__(name)
        return np.array(value).reshape(3, 3) if isinstance(value, ctypes.Array) else value


class MixedStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("n", c_int64), ("rows", c_int64), ("dt", c_double),
                ("tolerance", c_double)] + [
        (name, c_void_p) for name in ("ids", "strain", "stress", "value", "scale", "missed", "spin", "sigma", "dH",
                                      "held_error", "error_estimate", "status", "tokens_out")]


class Mixed:
    """Results of a mixed target for n RVEs: sigma and the applied dH (n, 3, 3), held_error, error_estimate (Pa), status,
    tokens (n). Rows of an RVE that failed are NaN, its token is 0."""

    def __init__(self, n: int) -> None:
        self.sigma, self.dH = np.full((n, 3, 3), np.nan), np.full((n, 3, 3), np.nan)
        self.held_error, self.error_estimate = np.full(n, np.nan), np.full(n, np.nan)
        self.status, self.tokens = np.zeros(n, np.int32), np.zeros(n, np.int64)


class Array(ctypes.Structure):
    """An entry of rvelab_list_arrays: name, unit, meaning, owner, and its extent in this state."""
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("name", c_char_p), ("unit", c_char_p),
                ("meaning", c_char_p), ("of", c_int32), ("type", c_int32), ("rows", c_int64), ("columns", c_int64)]

    def shape(self) -> tuple[int, ...]:
        """That of numpy: () of a number of the cell, (n), (3, 3), (n, 3), (n, 3, 3)."""
        rows = () if self.of == 0 else (self.rows,)
        return rows + {1: (), 9: (3, 3)}.get(self.columns, (self.columns,))


class Batch:
    """Results of a trial of n RVEs: sigma (n, 3, 3), status (n), dt_scale (n), tokens (n), and on request contact
    and reynolds (n, 3, 3), tangent (n, 6, 6; xx yy zz yz xz xy, engineering shear) and error_estimate (n), all in Pa.
    Rows of an RVE that failed are NaN, its token is 0. want: a name among MEASURES, or several."""

    def __init__(self, n: int, want: str | Iterable[str] = ()) -> None:
        wanted = self._names(want)
        for name, (shape, kind) in self._arrays(n).items():
            setattr(self, name, None if name in MEASURES and name not in wanted else np.empty(shape, kind))

    @staticmethod
    def _names(want: str | Iterable[str]) -> set[str]:
        wanted = {want} if isinstance(want, str) else set(want)
        if wanted - set(MEASURES):
            raise ValueError(f"want names {sorted(wanted - set(MEASURES))}; allowed: {', '.join(MEASURES)}")
        return wanted

    @staticmethod
    def _arrays(n: int) -> dict[str, tuple[tuple[int, ...], type]]:
        wide = {"sigma": (n, 3, 3), "contact": (n, 3, 3), "reynolds": (n, 3, 3), "tangent": (n, 6, 6)}
        kinds = {"status": np.int32, "tokens": np.int64}
        return {name: (wide.get(name, (n,)), kinds.get(name, np.float64))
                for name in ("sigma", *MEASURES, "dt_scale", "status", "tokens")}

    def expect_fits(self, n: int, want: str | Iterable[str]) -> None:
        """ValueError unless the library can write a trial of n RVEs into these arrays."""
        wanted, ranges = Batch._names(want), []  # first byte, the one after the last, name
        for name, (shape, kind) in Batch._arrays(n).items():
            array = getattr(self, name, None)
            if array is None and name in MEASURES:
                if name in wanted:
                    raise ValueError(f"out has no array for {name}, which want names: out=Batch({n}, want)")
                continue
            flags = array.flags if isinstance(array, np.ndarray) else None
            if flags is None or array.shape != shape or array.dtype != kind or not (
                    flags.c_contiguous and flags.aligned and flags.writeable):
                found = f"of {array.dtype} and shape {array.shape}" if flags is not None else repr(array)[:80]
                order = "" if flags is None else ", ".join(
                    text for text, holds in (("not contiguous (order C)", not flags.c_contiguous),
                                             ("not aligned", not flags.aligned), ("read-only", not flags.writeable))
                    if holds)
                raise ValueError(f"out.{name} is {found}{', ' + order if order else ''}; allowed: a writeable array of "
                                 f"{np.dtype(kind)} and shape {shape}, contiguous in order C, as Batch({n}, want) makes it")
            ranges.append((array.ctypes.data, array.ctypes.data + array.nbytes, name))
        ranges.sort()
        for (_, end, first), (begin, _, second) in zip(ranges, ranges[1:]):
            if begin < end:
                raise ValueError(f"out.{first} and out.{second} share memory; give each an array of its own")


def load() -> ctypes.CDLL:
    here, name = Path(__file__).resolve().parent, "librvelab.so.1"
    # In the wheel; beside the module; PREFIX/lib of an installed one, PREFIX/lib/python3/dist-packages/rvelab; the build
    # of a checkout.
    folders = here / "native/lib", here, here.parent, here.parents[2], here.parents[2] / "build/release/lib"
    paths = [folder / name for folder in folders]
    path = os.environ.get("RVELAB_LIBRARY") or str(next((file for file in paths if file.exists()), name))
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"{path}: {error}; let RVELAB_LIBRARY name {name}, or put it beside {__file__}") from None
    for name_of_call in ("rvelab_version", "rvelab_status_name", "rvelab_last_error"):
        getattr(library, name_of_call).restype = c_char_p
    library.rvelab_capabilities.restype = c_int64
    version = library.rvelab_abi_version()
    if version >> 16 != 1 or version & 65535 < 4:
        raise ImportError(f"{path} has ABI {version >> 16}.{version & 65535}; this module is for 1.4 and later 1.x: let "
                          f"RVELAB_LIBRARY name a newer {name}")
    return library


library = load()
functions: dict[str, Any] = {}  # those that return a status, by their names without rvelab_ (pool.py)


_folder = os.path.dirname(__file__)


def _level_of_caller() -> int:
    """Frames from the one that warns up to the first outside these modules."""
    level, frame = 2, sys._getframe(2)
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == _folder:
        level, frame = level + 1, frame.f_back
    return level


def call(name: str, *arguments: Any, batch: Batch | Mixed | None = None, result: np.ndarray | None = None) -> None:
    """A call by its name without rvelab_. Issues its warning, or raises its error with the library's text. batch,
    result: its outputs, for error.batch and warning.result."""
    status = functions[name](*arguments)
    if status != 0:
        tell(status, name, arguments[0], result if batch is None else batch, batch)


def tell(status: int, name: str, pool: Any, result: Any, batch: Any) -> None:
    """The status of a call as a warning or an error."""
    if isinstance(pool, c_void_p) and not pool:
        raise RvelabError("this pool was closed, or the Rve that it is of; make another, or close it later", status)
    text, kind = library.rvelab_last_error().decode(), library.rvelab_status_name(status).decode()
    if status < 0:
        raise {-1: Discard, -5: StaleToken, -10: OutOfMemory}.get(status, RvelabError)(f"{kind}: {text}", status, batch)
    warn(RvelabWarning(f"{kind}: {_warnings.get(status, text)}", status, text), _level_of_caller(), result,
         "its trials are pending" if name == "trial" else "the state is that after the call")


def warn(message: RvelabWarning, level: int, result: Any, done: str) -> None:
    """If a filter makes the warning an error, adds what was done and the result of the call."""
    try:
        warnings.warn(message, stacklevel=level + 1)
    except RvelabWarning as raised:
        raised.args = (f"{raised}. A filter makes this warning an error: {done}, and .result is what the call gave",)
        raised.result = result
        raise


def numbers_of(given: ArrayLike, what: str = "ids") -> np.ndarray:
    """Integers as int64, without a copy if they already are; floats only if they are whole."""
    if given is None:
        raise ValueError(f"{what} is None; give the {what} that the pool returned")
    array = np.atleast_1d(np.asarray(given))
    if array.dtype.kind not in "iuf" and array.size > 0:
        raise ValueError(f"{what} are of {array.dtype}; allowed: whole numbers in one row, as the pool returned them")
    if what == "ids" and array.dtype.itemsize < 8:
        raise ValueError(f"ids of {array.dtype} are cut: an id has up to 53 bits; keep them as int64, or as float64")
    whole = np.ascontiguousarray(array, np.int64)
    if whole.ndim != 1 or not np.array_equal(whole, array):
        raise ValueError(f"{what} of shape {array.shape}: allowed are whole numbers in one row; were they passed "
                         "through single precision?")
    return whole


def id_of(given: Any) -> int:
    """That of a call for one RVE."""
    if type(given) is int or type(given) is np.int64:
        return int(given)
    ids = numbers_of(given)
    if len(ids) != 1:
        raise ValueError(f"{len(ids) or 'no'} ids are given, and this call is for one RVE: give one id (trial, batch, "
                         "run_stages, cost and release take several)")
    return int(ids[0])


def bytes_of(snapshot: Any) -> bytes:
    """A snapshot as bytes: those, a bytearray, a memoryview, an array of numpy."""
    try:
        return snapshot if isinstance(snapshot, bytes) else memoryview(snapshot).tobytes()
    except TypeError:
        raise TypeError(f"a snapshot is bytes, as snapshot() returns them, not {type(snapshot).__name__}") from None


def gradients_of(given: ArrayLike, shape: tuple[int, ...], what: str = "dH") -> np.ndarray:
    array = np.ascontiguousarray(given, np.float64)
    if array.shape != shape:
        raise ValueError(f"{what} has the shape {array.shape}; allowed: {shape}")
    return array
