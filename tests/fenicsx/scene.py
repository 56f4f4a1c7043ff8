"""A small problem of tests/fenicsx/test_ranks.py, for mpirun: a block pressed by a rough plate on part of its top.
scene.py FOLDER OUTPUT END [--resume CHECKPOINT] [--save CHECKPOINT] [--still] [--die] [--own] [--tags]
--own: each point has its RVE from the beginning; at the end the checkpoint is loaded again, and gives the last row again
--tags: one cell has a tag without a specimen; OUTPUT gets the number of ranks that are told"""
import json
import os
import signal
import sys
import warnings
from pathlib import Path

import numpy as np
import rvelab
import stand_in
from dolfinx import mesh
from mpi4py import MPI
from rvelab import fenicsx

warnings.simplefilter("ignore")
stand_in.FOLDER, output, end = Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3])
option = lambda name: sys.argv[sys.argv.index(name) + 1] if name in sys.argv else None  # noqa: E731
comm = MPI.COMM_WORLD
block = mesh.create_rectangle(comm, [(0, 0), (2, 1)], (4, 2), mesh.CellType.quadrilateral)
specimens = [stand_in.specimen(), stand_in.specimen("loose", 50, "pack_loose")]
if "--tags" in sys.argv:
    cells = np.arange(block.topology.index_map(2).size_local, dtype=np.int32)
    x = mesh.compute_midpoints(block, 2, cells)
    tags = mesh.meshtags(block, 2, cells, ((x[:, 0] > 1.5) & (x[:, 1] > 0.5)).astype(np.int32))
    told = 0
    try:
        fenicsx.Material(block, {0: specimens[0]}, cell_tags=tags)
    except (ValueError, rvelab.RvelabError) as error:
        told = int("cells have the tag 1" in str(error))
    told = comm.allreduce(told)
    if comm.rank == 0:
        output.write_text(json.dumps(told))
    sys.exit(0)
material = fenicsx.Material(block, specimens, balance="--still" not in sys.argv, tolerance=1e-4,
                            share=0 if "--own" in sys.argv else True)
solver = fenicsx.Solver(material)
plate = lambda x: np.isclose(x[1], 1) & (x[0] < 0.51)  # noqa: E731
for k, value in enumerate((0.0, lambda t: -t)):
    solver.fix(plate, k, value)
for where, k in ((lambda x: np.isclose(x[0], 0), 0), (lambda x: np.isclose(x[0], 2), 0), (lambda x: np.isclose(x[1], 0), 1)):
    solver.fix(where, k)
solver.pressure(lambda x: np.isclose(x[1], 1) & (x[0] > 0.49), stand_in.P)
if option("--resume"):
    fenicsx.load(solver, option("--resume"))
curve = []
for step in solver.march(end, 1e-4):
    curve.append([step.t, *solver.reaction(plate)])
    if option("--save"):
        fenicsx.save(solver, option("--save"))
    if "--die" in sys.argv and step.t > 2.5e-4:
        os.kill(os.getpid(), signal.SIGKILL)
if "--own" in sys.argv and option("--save"):
    fenicsx.load(solver, option("--save"))
    curve.append([solver.t, *solver.reaction(plate)])
points, lines = material.points, fenicsx.summary(solver)
kinds = comm.gather((points.made.sum(), len(points.made), points.moved, points.spread))
if comm.rank == 0:
    made, count, moved = (int(sum(each[k] for each in kinds)) for k in range(3))
    output.write_text(json.dumps(dict(curve=curve, made=made, count=count, moved=moved, spread=kinds[0][3], summary=lines)))
