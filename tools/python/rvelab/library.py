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
    """A call failed, and the state is as before. status: number in rvelab.h (None: the program failed); batch: what
    the other RVEs gave."""

    def __init__(self, text: str, status: int | None = None, batch: "Batch | None" = None) -> None:
        super().__init__(text)
        self.status, self.batch = status, batch


class Discard(RvelabError):
    """The increment cannot be made: try a smaller one (batch.dt_scale times it, after a trial)."""


class StaleToken(RvelabError):
    """No trial of this RVE has that token any more."""


class OutOfMemory(RvelabError, MemoryError):
    """There is not enough memory."""


class RvelabWarning(UserWarning):
    """The result is usable. Its text is the same each time, so that Python tells it once for a line; detail is the
    library's text with its figures, status the number in rvelab.h."""

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
    """What a mixed target gave n RVEs: sigma and dH, what was applied (n, 3, 3), held_error, error_estimate (Pa), status,
    tokens (n). Rows of an RVE that failed are NaN, its token is 0."""

    def __init__(self, n: int) -> None:
        self.sigma, self.dH = np.full((n, 3, 3), np.nan), np.full((n, 3, 3), np.nan)
        self.held_error, self.error_estimate = np.full(n, np.nan), np.full(n, np.nan)
        self.status, self.tokens = np.zeros(n, np.int32), np.zeros(n, np.int64)


class Array(ctypes.Structure):
    """What rvelab_list_arrays tells of an array: name, unit, meaning, what it is of, and its extent in this state."""
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("name", c_char_p), ("unit", c_char_p),
                ("meaning", c_char_p), ("of", c_int32), ("type", c_int32), ("rows", c_int64), ("columns", c_int64)]

    def shape(self) -> tuple[int, ...]:
        """That of numpy: () of a number of the cell, (n), (3, 3), (n, 3), (n, 3, 3)."""
        rows = () if self.of == 0 else (self.rows,)
        return rows + {1: (), 9: (3, 3)}.get(self.columns, (self.columns,))


class Batch:
    """What a trial of n RVEs gave: sigma (n, 3, 3), status (n), dt_scale (n), tokens (n), and where asked for contact
    and reynolds (n, 3, 3), tangent (n, 6, 6; xx yy zz yz xz xy, engineering shear) and error_estimate (n), all in Pa.
    Rows of an RVE that failed are NaN, its token is 0."""

    def __init__(self, n: int, want: Iterable[str] = ()) -> None:
        shapes = {"sigma": (n, 3, 3), "contact": (n, 3, 3), "reynolds": (n, 3, 3), "tangent": (n, 6, 6)}
        unknown = set(want) - set(MEASURES)
        if unknown:
            raise ValueError(f"want names {sorted(unknown)}; allowed: {', '.join(MEASURES)}")
        for name in ("sigma", *MEASURES):
            asked = name == "sigma" or name in want
            setattr(self, name, np.empty(shapes.get(name, (n,))) if asked else None)
        self.dt_scale, self.status, self.tokens = np.empty(n), np.empty(n, np.int32), np.empty(n, np.int64)


def load() -> ctypes.CDLL:
    here, name = Path(__file__).resolve().parent, "librvelab.so.1"
    # In the wheel; beside the module; PREFIX/lib of an installed one, PREFIX/lib/python3/dist-packages/rvelab; the build
    # of a checkout.
    folders = here / "native/lib", here, here.parent, here.parents[2], here.parents[2] / "build/release/lib"
    places = [folder / name for folder in folders]
    place = os.environ.get("RVELAB_LIBRARY") or str(next((file for file in places if file.exists()), name))
    try:
        library = ctypes.CDLL(place)
    except OSError as error:
        raise ImportError(f"{place}: {error}; let RVELAB_LIBRARY name {name}, or put it beside {__file__}") from None
    for name_of_call in ("rvelab_version", "rvelab_status_name", "rvelab_last_error"):
        getattr(library, name_of_call).restype = c_char_p
    library.rvelab_capabilities.restype = c_int64
    version = library.rvelab_abi_version()
    if version >> 16 != 1 or version & 65535 < 1:
        raise ImportError(f"{place} has ABI {version >> 16}.{version & 65535}; this module is for 1.1 and later 1.x")
    return library


library = load()


_folder = os.path.dirname(__file__)


def _level_of_caller() -> int:
    """Frames from the one that warns up to the first outside these modules."""
    level, frame = 2, sys._getframe(2)
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == _folder:
        level, frame = level + 1, frame.f_back
    return level


def call(name: str, *arguments: Any, batch: Batch | None = None) -> None:
    """A call by its name without rvelab_. A warning is told as one, an error is raised with the library's text."""
    status = getattr(library, "rvelab_" + name)(*arguments)
    if status == 0:
        return
    text, name = library.rvelab_last_error().decode(), library.rvelab_status_name(status).decode()
    if status > 0:
        message = RvelabWarning(f"{name}: {_warnings.get(status, text)}", status, text)
        warnings.warn(message, stacklevel=_level_of_caller())
        return
    raise {-1: Discard, -5: StaleToken, -10: OutOfMemory}.get(status, RvelabError)(f"{name}: {text}", status, batch)


def numbers_of(given: ArrayLike, what: str) -> np.ndarray:
    """Integers as int64, without a copy where they are; floats only where they are whole."""
    array = np.atleast_1d(np.asarray(given))
    whole = np.ascontiguousarray(array, np.int64)
    if whole.ndim != 1 or not np.array_equal(whole, array):
        raise ValueError(f"{what} of shape {array.shape}: allowed are whole numbers in one row; were they passed "
                         "through single precision?")
    return whole


def id_of(given: Any) -> int:
    return int(given) if isinstance(given, (int, np.integer)) else int(numbers_of(given, "id")[0])


def gradients_of(given: ArrayLike, shape: tuple[int, ...], what: str = "dH") -> np.ndarray:
    array = np.ascontiguousarray(given, np.float64)
    if array.shape != shape:
        raise ValueError(f"{what} has the shape {array.shape}; allowed: {shape}")
    return array
