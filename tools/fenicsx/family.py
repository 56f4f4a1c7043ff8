"""Specimens of the points of a mesh, and families of them: one specimen brought to the stresses that points begin
with."""
from __future__ import annotations

import os
import warnings
from typing import Any, Mapping, Sequence

import numpy as np
import rvelab

Sources = str | os.PathLike | Sequence | Mapping
# Members are this far apart in the logarithm of the vertical stress, and in the ratios of the others to it. Points lie at
# most half of that from their member, and are brought to their stress by its tangent.
STEP_OF_LOGARITHM, STEP_OF_RATIO = 0.02, 0.01
LARGEST_STEP = 0.1  # of a stress on the way there, over the mean pressure
NAMES = {2: ("xx", "yy", "xy"), 3: ("xx", "yy", "zz", "yz", "xz", "xy")}


def chosen_sources(sources: Sources, tags: np.ndarray | None, numbers: np.ndarray) -> list[Any]:
    """The specimen of each point: of its tag, and where there are several, of a draw by the number of the point."""
    if isinstance(sources, Mapping):
        if tags is None:
            raise ValueError("specimens name tags of cells; give cell_tags, or one specimen for all")
        missing = sorted(set(tags.tolist()) - set(sources))
        if missing:
            raise ValueError(f"cells have the tag {missing[0]}, and specimens names {', '.join(map(str, sources))}; "
                             "give a specimen for each tag (0: cells without a tag)")
    drawn = (numbers.astype(np.uint64) * np.uint64(2654435761) >> np.uint64(16)).astype(np.int64)
    found = []
    for k, draw in enumerate(drawn):
        source = sources[int(tags[k])] if isinstance(sources, Mapping) else sources
        found.append(source[draw % len(source)] if isinstance(source, (list, tuple)) else source)
    return found


def members(sources: list[Any], sigma: np.ndarray | None, d: int,
            options: Mapping[str, Any]) -> tuple[np.ndarray, dict[int, bytes]]:
    """Group of each point, and a snapshot of the RVE of each group."""
    keys: dict[tuple, int] = {}
    group = np.zeros(len(sources), np.int64)
    for k, source in enumerate(sources):
        bins = () if sigma is None else _bins(sigma[k])
        group[k] = keys.setdefault((str(source), *bins), len(keys))
    return group, {number: _member(key, d, options) for key, number in keys.items()}


def _bins(sigma: np.ndarray) -> tuple[int, ...]:
    vertical = sigma[-1, -1] if len(sigma) == 3 else sigma[1, 1]
    if not vertical < 0:
        raise ValueError(f"an initial vertical stress is {vertical:.4g} Pa; allowed: compression (negative) at every "
                         "point, by a load on the free surface")
    rows, columns = np.triu_indices(len(sigma))
    ratios = sigma[rows, columns] / vertical
    return (round(np.log(-vertical) / STEP_OF_LOGARITHM), *(round(each / STEP_OF_RATIO) for each in ratios))


def _member(key: tuple, d: int, options: Mapping[str, Any]) -> bytes:
    source, bins = key[0], key[1:]
    with rvelab.Pool(workers=1, **{name: value for name, value in options.items() if name != "workers"}) as pool:
        rve = rvelab.Rve(source, pool)
        if rve.dimension != d:
            raise ValueError(f"{source} is a specimen in {rve.dimension}D, and the mesh is in {d}D")
        if bins:
            sigma = np.zeros((d, d))
            rows, columns = np.triu_indices(d)
            vertical = -np.exp(bins[0] * STEP_OF_LOGARITHM)
            sigma[rows, columns] = sigma[columns, rows] = vertical * STEP_OF_RATIO * np.array(bins[1:])
            bring(rve, sigma)
        return rve.snapshot()


def bring(rve: rvelab.Rve, sigma: np.ndarray) -> None:
    """Brings an RVE to a stress (d, d), Pa, in steps of at most a tenth of its pressure."""
    d, start = rve.dimension, rve.stress
    begin, end = rve.p, -np.trace(sigma) / d
    deviator = np.abs(start[:d, :d] / begin - sigma / end).max()
    steps = int(np.ceil(max(abs(np.log(end / begin)), deviator) / LARGEST_STEP))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rvelab.RvelabWarning)
        for k in range(1, steps + 1):
            part = k / steps
            p = begin * (end / begin) ** part
            goal = p * ((1 - part) * start[:d, :d] / begin + part * sigma / end)
            held = {name: goal["xyz".index(name[0]), "xyz".index(name[1])] for name in NAMES[d]}
            rve.apply_held(np.zeros((3, 3)), held)
