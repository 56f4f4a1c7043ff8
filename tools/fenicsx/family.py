"""Specimens of the points of a mesh, and families of them: one specimen brought to the stresses that points begin
with."""
from __future__ import annotations

import os
import warnings
from typing import Any, Mapping, Sequence

import numpy as np
import rvelab

from .ranks import together

Sources = str | os.PathLike | Sequence | Mapping
# Each stress has its member, up to so many; of more the members are this far apart in the logarithm of the vertical
# stress, and in the ratios of the others to it, and points are brought from there to their stress by the tangent.
MOST_EXACT, STEP_OF_LOGARITHM, STEP_OF_RATIO = 100, 0.02, 0.01
LARGEST_STEP = 0.1  # of a stress on the way there, over the mean pressure
NEAR = 1e-3  # over the pressure: a specimen that is so near to a stress stays as it is
HELD = 1e-3  # tolerance of the stresses of members
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


def members(comm: Any, sources: list[Any], sigma: np.ndarray | None, d: int,
            options: Mapping[str, Any]) -> tuple[np.ndarray, dict[int, bytes], np.ndarray | None]:
    """Collective. Group of each point, a snapshot of the RVE of each group, and the stress that each point is brought
    to from there by the tangent: NaN where it stays."""
    goals = together(comm, lambda: [()] * len(sources) if sigma is None else [_exact(each) for each in sigma])
    if len(set().union(*comm.allgather(set(goals)))) > MOST_EXACT:
        goals = [_binned(goal) for goal in goals]
    keys: dict[tuple, int] = {}
    group = np.array([keys.setdefault((str(source), goal), len(keys))
                      for source, goal in zip(sources, goals)], np.int64).reshape(-1)
    made = together(comm, lambda: {number: _member(*key, d, options) for key, number in keys.items()})
    if sigma is not None:
        stays = np.array([_near(made[number][1], each) for number, each in zip(group, sigma)], bool)
        sigma = np.where(stays[:, None, None], np.nan, sigma)
    return group, {number: each[0] for number, each in made.items()}, sigma


def _exact(sigma: np.ndarray) -> tuple[float, ...]:
    """Upper triangle, Pa, to nine digits."""
    if not sigma[-1, -1] < 0:
        raise ValueError(f"an initial vertical stress is {sigma[-1, -1]:.4g} Pa; allowed: compression (negative) at every "
                         "point, by a load on the free surface")
    return tuple(float(f"{each:.9g}") for each in sigma[np.triu_indices(len(sigma))])


def _binned(goal: tuple[float, ...]) -> tuple[float, ...]:
    vertical = -np.exp(round(np.log(-goal[-1]) / STEP_OF_LOGARITHM) * STEP_OF_LOGARITHM)
    return tuple(float(vertical * STEP_OF_RATIO * round(each / goal[-1] / STEP_OF_RATIO)) for each in goal)


def _member(source: str, goal: tuple[float, ...], d: int, options: Mapping[str, Any]) -> tuple[bytes, np.ndarray | None]:
    """Snapshot, and the stress of the specimen (d, d), Pa, if it stayed as it is."""
    with rvelab.Pool(**{**options, "workers": 1}) as pool:
        rve = rvelab.Rve(source, pool)
        if rve.dimension != d:
            raise ValueError(f"{source} is a specimen in {rve.dimension}D, and the mesh is in {d}D")
        if not goal:
            return rve.snapshot(), rve.stress[:d, :d]
        sigma = np.zeros((d, d))
        rows, columns = np.triu_indices(d)
        sigma[rows, columns] = sigma[columns, rows] = goal
        own = np.array(rve.stress[:d, :d])
        if _near(own, sigma):
            return rve.snapshot(), own
        bring(rve, sigma)
        return rve.snapshot(), None


def _near(own: np.ndarray | None, sigma: np.ndarray) -> bool:
    """Whether a specimen of this stress stays as it is for a point of stress sigma."""
    return own is not None and bool(np.abs(own - sigma).max() < -NEAR * np.trace(own) / len(own))


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
            rve.apply_held(np.zeros((3, 3)), held, tolerance=HELD)
