"""RVEs as the micro simulations of preCICE's Micro Manager, one at each coupling point.

In micro-manager-config.json: "micro_file_name": "micro_simulation", and as data, vectors of three (of two in a 2D mesh):

    read    dH_x, dH_y, dH_z             rows of dH, the increment of displacement gradient over the time window
    write   sigma_x, sigma_y, sigma_z    rows of the Cauchy stress at its end, Pa, tension positive

Rows of z are left out in a 2D mesh. RVELAB_SPECIMEN names the specimen; RVELAB_PHYSICAL_TIME = 1 makes the time window
physical time, else steps are quasi-static. A module of your own with a class of your own sets them in Python:

    import micro_simulation
    class MicroSimulation(micro_simulation.MicroSimulation):
        specimen = "S.h5"

A step that cannot be made raises rvelab.Discard, which the Micro Manager treats as a crash of that simulation."""
from __future__ import annotations

import csv
import os
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

    def __init__(self, sim_id: int) -> None:
        self._global_id, self._windows, self._id = sim_id, 0, 0
        if self.specimen is None:
            raise ValueError("MicroSimulation has no specimen: let RVELAB_SPECIMEN name its file (rvelab pack)")
        if MicroSimulation._pool is None:
            MicroSimulation._pool = rvelab.Pool(workers=1)  # the Micro Manager works by its ranks
        pool, path = MicroSimulation._pool, os.path.abspath(self.specimen)
        if path not in self._templates:
            self._templates[path] = pool.template(path)
        self._id = int(pool.spawn(self._templates[path])[0])

    def __del__(self) -> None:
        if getattr(self, "_id", 0):
            MicroSimulation._pool.release(self._id)

    def initialize(self) -> dict[str, np.ndarray]:
        """The stress before the first window, for adaptivity and coupling schemes that want it."""
        sigma = MicroSimulation._pool.trial(self._id, np.zeros((1, 3, 3))).sigma[0]
        MicroSimulation._pool.revert(self._id)
        return self._rows(sigma, MicroSimulation._pool.info(self._id).dimension)

    def solve(self, macro_data: dict[str, np.ndarray], dt: float) -> dict[str, np.ndarray]:
        """One time window from the state as it is, which moves on."""
        dH, n = np.zeros((3, 3)), len(macro_data["dH_x"])
        for i in range(n):
            dH[i, :n] = macro_data["dH_" + _AXES[i]]
        return self._rows(MicroSimulation._pool.apply(self._id, dH, dt if self.physical_time else 0), n)

    @staticmethod
    def _rows(sigma: np.ndarray, n: int) -> dict[str, np.ndarray]:
        return {"sigma_" + _AXES[i]: sigma[i, :n].copy() for i in range(n)}

    def get_state(self) -> bytes:
        """The whole state, in bytes that can be sent to another rank of the same build."""
        return MicroSimulation._pool.snapshot(self._id)

    def set_state(self, state: bytes) -> None:
        """The state of any simulation."""
        MicroSimulation._pool.restore(self._id, state)

    def output(self) -> None:
        """Appends the measures of the state to rve_ID.csv."""
        file = Path(f"rve_{self._global_id}.csv")
        info = MicroSimulation._pool.info(self._id)
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
