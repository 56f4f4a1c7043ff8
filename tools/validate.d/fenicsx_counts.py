"""A run of `python3 -m rvelab.fenicsx CASE` under mpirun with its messages counted (tools/validate fenicsx_scaling).

    fenicsx_counts.py CASE [OPTIONS]      prints a line of JSON after the rows of the case

Counted are the messages of RVEs (points.py), each rank's to each other one as mpi4py sends them, with the bytes of their
pickles: `answers` carry increments and their stresses and tangents to and from RVEs that live elsewhere, `work` the
counted grain-steps, `moves` snapshots. The finite elements exchange the values of ghosts, 8 bytes each: once for each
solution, once for each residual. MUMPS is told by its own numbers."""
import contextlib
import importlib
import json
import pickle
import sys

import numpy as np
from mpi4py import MPI
from rvelab.fenicsx import cases, compat, material, summary


class Counted:
    """Calls of a communicator, with messages and bytes to other ranks by kind."""

    def __init__(self, comm):
        self.comm, self.rank, self.size, self.kind = comm, comm.rank, comm.size, "answers"
        self.messages, self.bytes = {}, {}

    def _add(self, texts):
        self.messages[self.kind] = self.messages.get(self.kind, 0) + len(texts)
        self.bytes[self.kind] = self.bytes.get(self.kind, 0) + sum(map(len, texts))

    def alltoall(self, objects):
        self._add([pickle.dumps(each, -1) for rank, each in enumerate(objects) if rank != self.rank])
        return self.comm.alltoall(objects)

    def allgather(self, each):
        self._add([pickle.dumps(each, -1)] * (self.size - 1))
        return self.comm.allgather(each)

    def allreduce(self, each):
        self._add([pickle.dumps(each, -1)] * (2 if self.rank else 0))  # a tree up and down: 2 (size - 1) of all ranks
        return self.comm.allreduce(each)


class Points(material.Points):
    def __init__(self, comm, *given, **named):
        super().__init__(Counted(comm), *given, **named)

    @contextlib.contextmanager
    def of(self, kind):
        self.comm.kind, before = kind, self.comm.kind
        yield
        self.comm.kind = before

    def _balance(self):
        with self.of("work"):
            super()._balance()

    def _move(self, moves):
        with self.of("moves"):
            super()._move(moves)


def main():
    comm, solvers = MPI.COMM_WORLD, []
    material.Points = Points
    cases.summary = lambda solver: solvers.append(solver) or summary(solver)
    importlib.import_module("rvelab.fenicsx." + sys.argv[1]).main(sys.argv[2:], comm)
    solver, = solvers
    points, steps = solver.material.points, len(solver.history)
    factor = solver.forms.solver.getPC().getFactorMatrix()
    ghosts = comm.gather(solver.material.space.dofmap.index_map.num_ghosts * solver.forms.blocks)
    mine = {kind: (points.comm.messages.get(kind, 0) / steps, points.comm.bytes.get(kind, 0) / steps)
            for kind in ("answers", "work", "moves")}
    parts, work, owned = comm.gather(mine), comm.allreduce(float(points.total)), comm.gather(compat.owned(solver.material.space))
    moved, count = comm.allreduce(points.moved), comm.allreduce(len(points.group))
    if comm.rank == 0:
        print(json.dumps(dict(
            ranks=comm.size, points=count, increments=steps, work=work / steps / comm.size,
            iterations=float(np.mean([each.iterations for each in solver.history])),
            trials=float(np.mean([each.trials for each in solver.history])),
            spread=float(np.mean(points.spread)) if points.spread else 1.0, moved=moved, unknowns=sum(owned), ghosts=max(ghosts),
            messages={kind: float(np.mean([each[kind][0] for each in parts])) for kind in mine},
            bytes={kind: float(np.mean([each[kind][1] for each in parts])) for kind in mine},
            factor_entries=factor.getMumpsInfog(29), factor_operations=factor.getMumpsRinfog(3))), flush=True)


main()
