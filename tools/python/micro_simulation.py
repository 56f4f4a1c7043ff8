"""RVEs as the micro simulations of preCICE's Micro Manager, one at each coupling point.

In micro-manager-config.json "micro_file_name": "micro_simulation", and as data vectors of three (two in a 2D mesh):

    read    dH_x, dH_y, dH_z             rows of dH, the increment of displacement gradient over the time window
    write   sigma_x, sigma_y, sigma_z    rows of the Cauchy stress at its end, Pa, tension positive

A 2D mesh has no rows of z. RVELAB_SPECIMEN names the specimen; RVELAB_PHYSICAL_TIME = 1 makes the time window
physical time, otherwise steps are quasi-static. Or set them in Python, in your own module and class:

    import micro_simulation
    class MicroSimulation(micro_simulation.MicroSimulation):
        specimen = "S.h5"

A failed step raises rvelab.Discard, which the Micro Manager treats as a crash of that simulation."""
from __future__ import annotations

import csv
import os
import sys
from pathlib import Path
from typing import ClassVar

import numpy as np

import rvelab

_AXES = "xyz"
_MEASURES = ("p", "q", "void_ratio", "coordination_number", "fabric_anisotropy", "sliding_fraction")


class MicroSimulation:
    specimen: ClassVar[str | None] = os.environ.get("RVELAB_SPECIMEN")
    physical_time: ClassVar[bool] = os.environ.get("RVELAB_PHYSICAL_TIME") == "1"
    _pool: ClassVar[rvelab.Pool | None] = None
    _templates: ClassVar[dict[str, int]] = {}
    _process: ClassVar[int] = 0  # that the pool belongs to

    def __init__(self, sim_id: int) -> None:
        self._global_id, self._windows, self._id, self._made_in = sim_id, 0, 0, 0
        if self.specimen is None:
            raise ValueError("MicroSimulation has no specimen: let RVELAB_SPECIMEN name its file (rvelab pack)")

    def initialize(self) -> None:
        """Makes the RVE, once. A simulation that adaptivity keeps inactive has none until it gets a state."""
        if self._id:
            return
        if MicroSimulation._process != os.getpid():  # the first, or that of a forked child
            MicroSimulation._pool = rvelab.Pool(workers=1)  # the Micro Manager works by its ranks
            MicroSimulation._templates, MicroSimulation._process = {}, os.getpid()
        path = os.path.abspath(self.specimen)
        if path not in self._templates:
            self._templates[path] = MicroSimulation._pool.template(path)
        self._id, self._made_in = int(MicroSimulation._pool.spawn(self._templates[path])[0]), os.getpid()

    def _rve(self) -> int:
        self.initialize()
        if self._made_in != os.getpid():
            raise RuntimeError("this simulation was made before the process was forked, and its state is in the parent: "
                               "make one here and give it the state, set_state(get_state() of the parent)")
        return self._id

    def __del__(self) -> None:
        if getattr(self, "_id", 0) and self._made_in == os.getpid() and not sys.is_finalizing():
            MicroSimulation._pool.release(self._id)

    def solve(self, macro_data: dict[str, np.ndarray], dt: float) -> dict[str, np.ndarray]:
        """One time window from the present state, which it changes."""
        dH, n = np.zeros((3, 3)), len(macro_data["dH_x"])
        for i in range(n):
            dH[i, :n] = macro_data["dH_" + _AXES[i]]
        rve = self._rve()
        sigma = MicroSimulation._pool.apply(rve, dH, dt if self.physical_time else 0)
        return {"sigma_" + _AXES[i]: sigma[i, :n].copy() for i in range(n)}

    def get_state(self) -> bytes:
        """The whole state, in bytes that can be sent to another rank of the same build."""
        rve = self._rve()
        return MicroSimulation._pool.snapshot(rve)

    def set_state(self, state: bytes) -> None:
        """The state of any simulation."""
        if self._made_in != os.getpid():
            self._id = 0  # of the parent of this process
        rve = self._rve()
        MicroSimulation._pool.restore(rve, state)

    def output(self) -> None:
        """Appends the measures of the state to rve_ID.csv."""
        file = Path(f"rve_{self._global_id}.csv")
        rve = self._rve()
        info = MicroSimulation._pool.info(rve)
        self._windows += 1
        new = self._windows == 1
        with file.open("w" if new else "a", newline="") as rows:
            writer = csv.writer(rows)
            if new:
                writer.writerow(("output", *_MEASURES))
            writer.writerow((self._windows, *(getattr(info, name) for name in _MEASURES)))

    def get_global_id(self) -> int:
        return self._global_id

    def set_global_id(self, global_id: int) -> None:
        self._global_id = global_id
