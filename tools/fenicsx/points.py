"""The RVEs of the quadrature points that a rank owns. Points that have seen elastic strain alone share one RVE; the
RVEs of the others may be on any rank, by their measured cost. It needs numpy, mpi4py and rvelab, and nothing of
dolfinx."""
from __future__ import annotations

import warnings
from typing import Any, Iterable, NamedTuple

import numpy as np
import rvelab

from . import tensors
from .sharing import Shared

# Points with a larger rotation get an RVE, since theirs is brought there in one increment.
LARGEST_SHARED_ROTATION = 0.01
IMBALANCE = 1.1  # RVEs move if the busiest rank has this much more work than the mean, as in rvelab_mpi.h
REFUSED = -1, -2  # RVELAB_DISCARD, and RVELAB_E_INPUT: det(I + dH) <= 0 in an iteration


class Response(NamedTuple):
    sigma: np.ndarray       #: (n, d, d) Pa, Cauchy, tension positive
    stiffness: np.ndarray   #: (n, d, d, d, d) Pa, d sigma/d eps at zero spin
    error: np.ndarray       #: (n) Pa, estimates of the errors of sigma
    scale: float            #: 1; below: an RVE refused, and this is the share of the increment to try


class Points:
    """n points of this rank. group: (n) number of the family member of each point, a key of `members`, which are
    snapshots of RVEs. share: error of the stress over the pressure that points may have which share an RVE; 0: none
    does. sigma: (n, d, d) Pa, stresses that points are brought to from their members; NaN or None: theirs."""

    def __init__(self, comm: Any, d: int, group: np.ndarray, members: dict[int, bytes], options: dict[str, Any],
                 share: float = 0, balance: bool = True, sigma: np.ndarray | None = None) -> None:
        self.comm, self.d, self.group, self.balances = comm, d, group, balance and comm.size > 1
        self.pool = rvelab.Pool(**options)
        self.shared = {key: Shared(self.pool, d, members[key], share) for key in sorted(set(group.tolist()))}
        n = len(group)
        self.F = np.tile(np.eye(d), (n, 1, 1))
        for key, shared in self.shared.items() if sigma is not None else ():
            moved = (group == key) & np.isfinite(sigma[:, 0, 0])
            self.F[moved] += shared.strain_to(sigma[moved])
        self.home, self.ids = np.full(n, -1), np.zeros(n, np.int64)  # rank and id of its RVE; -1: none
        self.warned: dict[int, int] = {}
        self.work, self.counted = np.zeros(n), np.zeros(n)  # grain-steps of the last increments, and at their beginning
        self.total = 0.0  # grain-steps of all increments
        self.away = False  # whether any point of any rank has its RVE elsewhere
        self.moved, self.spread = 0, []  # RVEs moved; per increment: work of the busiest rank over the mean
        self._pending = self.F
        if share == 0:
            self.make(np.arange(n))

    @property
    def made(self) -> np.ndarray:
        return self.home >= 0

    def make(self, which: Iterable[int]) -> None:
        """RVEs of their own, as copies of the shared one; the next trial brings them to the state of the point."""
        for k in which:
            self.ids[k] = self.pool.clone(self.shared[self.group[k]].id)
            self.home[k], self.counted[k] = self.comm.rank, 0

    def trial(self, dH: np.ndarray, tangent: bool = True) -> Response:
        """Collective. One trial of each point, dH (n, d, d) from the committed states. tangent: whether the stiffness is
        asked for, which costs an RVE of 400 discs as much as some hundred steps; if not it is that of shared points, else 0."""
        n, d = len(dH), self.d
        total = self._pending = (np.eye(d) + dH) @ self.F
        found = Response(np.zeros((n, d, d)), np.zeros((n, d, d, d, d)), np.zeros(n), 1.0)
        rotation, strain = tensors.polar(total)
        for key, shared in self.shared.items():
            unmade = np.flatnonzero(~self.made & (self.group == key))
            outside = (shared.leaves(strain[unmade])
                       | (tensors.rotation_angle(rotation[unmade]) > LARGEST_SHARED_ROTATION))
            self.make(unmade[outside])
            stay = unmade[~outside]
            found.sigma[stay], found.stiffness[stay], found.error[stay] = shared.response(strain[stay], rotation[stay])
        made = np.flatnonzero(self.made)
        gradients = np.zeros((len(made), 3, 3))
        gradients[:, :d, :d] = total[made] - np.eye(d)
        self._want = ["tangent", "error_estimate"] if tangent else ["error_estimate"]
        sigma, found.error[made], scale, *stiffness = self._exchange("trial", made, gradients)
        found.sigma[made] = tensors.symmetric(sigma[:, :d, :d])
        if tangent:
            found.stiffness[made] = tensors.stiffness_of(stiffness[0], d)
        refused = float(np.min(scale, initial=1.0))
        return found._replace(scale=min(self.comm.allgather(refused)))

    def commit(self) -> None:
        """Collective. The last trial, which refused nothing, becomes the state of all points."""
        self.pool.commit()
        self.F = self._pending
        self.F[self.made] = np.eye(self.d)
        self._balance()

    def revert(self) -> None:
        self.pool.revert()

    def info(self) -> dict[str, np.ndarray]:
        """Collective. void_ratio, coordination_number, fabric_anisotropy (n) of the committed states."""
        names = ("void_ratio", "coordination_number", "fabric_anisotropy")
        found = {name: np.zeros(len(self.group)) for name in names}
        for key, shared in self.shared.items():
            unmade = np.flatnonzero(~self.made & (self.group == key))
            for name in names:
                found[name][unmade] = getattr(self.pool.info(shared.id), name)
            found["void_ratio"][unmade] = (1 + found["void_ratio"][unmade]) * np.linalg.det(self.F[unmade]) - 1
        made = np.flatnonzero(self.made)
        for name, values in zip(names, self._exchange("info", made, np.zeros(len(made)))):
            found[name][made] = values
        return found

    def snapshots(self) -> list[bytes | None]:
        """Collective. Snapshots of the RVEs in the order of the points; None: the point shares one."""
        made = np.flatnonzero(self.made)
        found: list[bytes | None] = [None] * len(self.group)
        for k, snapshot in zip(made, self._exchange("snapshot", made, np.zeros(len(made)))[0]):
            found[k] = snapshot
        return found

    def restore(self, snapshots: list[bytes | None], F: np.ndarray) -> None:
        """Collective. The states of a checkpoint; RVEs return to the rank of their point."""
        comm, self.F = self.comm, F.copy()
        away = (self.home >= 0) & (self.home != comm.rank)
        for ids in comm.alltoall([self.ids[away & (self.home == rank)] for rank in range(comm.size)]):
            if len(ids):
                self.pool.release(ids)
        self.home[away], self.ids[away], self.away = -1, 0, False
        for k, snapshot in enumerate(snapshots):
            if snapshot is None:
                if self.home[k] >= 0:
                    self.pool.release([self.ids[k]])
                    self.home[k], self.ids[k] = -1, 0
            else:
                if self.home[k] < 0:
                    self.make([k])
                self.pool.restore(self.ids[k], snapshot)

    def costs(self) -> np.ndarray:
        """Collective. Grain-steps of the RVE of each point in the pool that holds it, (n)."""
        made, cost = np.flatnonzero(self.made), np.zeros(len(self.group))
        cost[made] = self._exchange("cost", made, np.zeros(len(made)))[0]
        return cost

    def _exchange(self, what: str, points: np.ndarray, given: np.ndarray) -> list[Any]:
        """Calls what(ids, given) on the rank that holds the RVE of each point, and brings its results back."""
        comm = self.comm
        if not self.away:
            parts = [getattr(self, "_" + what)(self.ids[points], given)]
            order = np.arange(len(points))
        else:
            chosen = [np.flatnonzero(self.home[points] == rank) for rank in range(comm.size)]
            asked = comm.alltoall([(self.ids[points[k]], given[k]) for k in chosen])
            done = getattr(self, "_" + what)(np.concatenate([ids for ids, _ in asked]),
                                             np.concatenate([values for _, values in asked]))
            ends = np.cumsum([0, *(len(ids) for ids, _ in asked)])
            parts = comm.alltoall([[each[a:b] for each in done] for a, b in zip(ends, ends[1:])])
            order = np.argsort(np.concatenate(chosen), kind="stable")
        return [np.concatenate([np.asarray(part[k]) for part in parts])[order] for k in range(len(parts[0]))]

    def _trial(self, ids: np.ndarray, gradients: np.ndarray) -> list[np.ndarray]:
        failure = None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rvelab.RvelabWarning)  # counted below
            try:
                batch = self.pool.trial(ids, gradients, want=self._want)
            except rvelab.RvelabError as error:
                batch = error.batch
                if batch is None or not np.isin(batch.status[batch.status < 0], REFUSED).all():
                    failure = str(error)
        failures = [f"rank {rank}: {text}" for rank, text in enumerate(self.comm.allgather(failure)) if text]
        if failures:
            raise rvelab.RvelabError("; ".join(failures))
        for status in batch.status[batch.status > 0]:
            self.warned[int(status)] = self.warned.get(int(status), 0) + 1
        scale = np.where(batch.status < 0, np.clip(batch.dt_scale, 0.1, 0.5), 1.0)
        return [batch.sigma, batch.error_estimate, scale, *([batch.tangent] if "tangent" in self._want else [])]

    def _info(self, ids: np.ndarray, _: np.ndarray) -> list[np.ndarray]:
        infos = [self.pool.info(k) for k in ids]
        return [np.array([getattr(info, name) for info in infos], float)
                for name in ("void_ratio", "coordination_number", "fabric_anisotropy")]

    def _snapshot(self, ids: np.ndarray, _: np.ndarray) -> list[np.ndarray]:
        held = np.empty(len(ids), object)
        held[:] = [self.pool.snapshot(k) for k in ids]
        return [held]

    def _cost(self, ids: np.ndarray, _: np.ndarray) -> list[np.ndarray]:
        return [self.pool.cost(ids).astype(float)]

    def _balance(self) -> None:
        """Counts the work of the increment on each rank, and moves RVEs from busy ranks to idle ones."""
        comm, cost = self.comm, self.costs()
        self.work, self.counted = cost - self.counted, cost
        self.total += self.work.sum()
        if comm.size == 1:
            return
        load = np.zeros(comm.size)
        np.add.at(load, self.home[self.made], self.work[self.made])
        load = comm.allreduce(load)  # whole counts: exact in any order
        if load.sum() == 0:
            return
        self.spread.append(float(load.max() / load.mean()))
        if self.balances and self.spread[-1] > IMBALANCE:
            self._move(plan(comm.allgather((self.home, self.work)), load))

    def _move(self, moves: list[tuple[int, int, int]]) -> None:
        """(owner, point, new rank) for each RVE that moves, the same list on all ranks."""
        comm, sent = self.comm, [[] for _ in range(self.comm.size)]
        self.away = self.away or bool(moves)
        asked = comm.alltoall([[(k, self.ids[k], to) for owner, k, to in moves if owner == comm.rank and
                                self.home[k] == rank] for rank in range(comm.size)])
        for owner, each in enumerate(asked):
            for k, rve, to in each:
                sent[to].append((owner, k, self.pool.snapshot(rve)))
                self.pool.release([rve])
        told = [[] for _ in range(comm.size)]
        for each in comm.alltoall(sent):
            for owner, k, snapshot in each:
                template = self.pool.template(snapshot)
                told[owner].append((k, int(self.pool.spawn(template)[0])))
                self.pool.release_template(template)
        for rank, each in enumerate(comm.alltoall(told)):
            for k, rve in each:
                self.home[k], self.ids[k], self.counted[k] = rank, rve, 0
                self.moved += 1


def plan(listed: list[tuple[np.ndarray, np.ndarray]], load: np.ndarray) -> list[tuple[int, int, int]]:
    """Moves from the busiest rank to the idlest, the largest RVE first that narrows the gap between both, until the
    busiest is within IMBALANCE of the mean."""
    load, moves = load.copy(), []
    held = [sorted(((float(work[k]), owner, int(k)) for owner, (home, work) in enumerate(listed)
                    for k in np.flatnonzero(home == rank) if work[k] > 0), reverse=True) for rank in range(len(load))]
    while load.max() > IMBALANCE * load.mean():
        busy, idle = int(np.argmax(load)), int(np.argmin(load))
        fits = next((k for k, each in enumerate(held[busy]) if each[0] <= 0.5 * (load[busy] - load[idle])), None)
        if fits is None:
            break
        work, owner, k = held[busy].pop(fits)
        load[busy], load[idle] = load[busy] - work, load[idle] + work
        moves.append((owner, k, idle))
    return moves
