"""What a macro code and the Micro Manager call of preCICE's Python module, for two participants on two threads of one
process and a serial-implicit scheme. Scheme, data and meshes are read from the case's precice-config.xml; an unknown name
is an error there as here. The first participant's data reach the second, whose data go back; the window is
repeated until each relative measure is met or the iterations are used up."""
from __future__ import annotations

import queue
import threading
import xml.etree.ElementTree as xml
from pathlib import Path
from typing import Iterable

import numpy as np


class _Scheme:
    def __init__(self, path: str) -> None:
        text = Path(path).read_text().replace("data:vector", "data-vector").replace("m2n:", "m2n-")
        root = xml.fromstring(text.replace("coupling-scheme:", "coupling-scheme-"))
        scheme = root.find("coupling-scheme-serial-implicit")

        def value(name: str) -> float:
            return float(scheme.find(name).get("value"))

        self.first, self.second = (scheme.find("participants").get(place) for place in ("first", "second"))
        self.window, self.end, self.most = value("time-window-size"), value("max-time"), int(value("max-iterations"))
        self.limits = {m.get("data"): float(m.get("limit")) for m in scheme.findall("relative-convergence-measure")}
        self.dimensions = {mesh.get("name"): int(mesh.get("dimensions")) for mesh in root.findall("mesh")}
        self.meshes = {mesh.get("name"): [data.get("name") for data in mesh.findall("use-data")]
                       for mesh in root.findall("mesh")}
        self.writes, self.reads = ({p.get("name"): {d.get("name") for d in p.findall(kind)}
                                    for p in root.findall("participant")} for kind in ("write-data", "read-data"))
        sent = {(e.get("data"), e.get("from")) for e in scheme.findall("exchange")}
        if sent != {(name, p) for p, names in self.writes.items() for name in names}:
            raise ValueError(f"{path}: what is exchanged is not what is written")
        self.to = {self.first: queue.Queue(), self.second: queue.Queue()}
        self.vertices: np.ndarray | None = None


_schemes: dict[str, _Scheme] = {}
_making = threading.Lock()


class Participant:
    WAIT = 60  # s, for the other one

    def __init__(self, name: str, config: str, rank: int, size: int) -> None:
        key = str(Path(config).resolve())
        with _making:  # both participants come at once, and must find one scheme
            if key not in _schemes:
                _schemes[key] = _Scheme(config)
        self._scheme = _schemes[key]
        self._name, self._first = name, name == self._scheme.first
        if name not in self._scheme.to:
            raise ValueError(f"{name} is no participant of {config}")
        self._time = self._iteration = 0
        self._written: dict[str, np.ndarray] = {}
        self._read: dict[str, np.ndarray] = {}
        self._before: dict[str, np.ndarray] = {}
        self._new_window, self._repeat = True, False

    def _send(self, what: object) -> None:
        scheme = self._scheme
        scheme.to[scheme.second if self._first else scheme.first].put(what)

    def _receive(self) -> object:
        return self._scheme.to[self._name].get(timeout=self.WAIT)

    def get_mesh_dimensions(self, mesh: str) -> int:
        return self._scheme.dimensions[mesh]

    def set_mesh_vertices(self, mesh: str, coordinates: np.ndarray) -> np.ndarray:
        if coordinates.shape[1] != self._scheme.dimensions[mesh]:
            raise ValueError(f"{mesh} has {self._scheme.dimensions[mesh]} dimensions")
        self._coordinates = coordinates
        return np.arange(len(coordinates))

    def set_mesh_access_region(self, mesh: str, bounds: Iterable[float]) -> None:
        self._bounds = np.reshape(list(bounds), (self._scheme.dimensions[mesh], 2))

    def get_mesh_vertex_ids_and_coordinates(self, mesh: str) -> tuple[np.ndarray, np.ndarray]:
        at = self._scheme.vertices
        inside = ((at >= self._bounds[:, 0]) & (at <= self._bounds[:, 1])).all(axis=1)
        if not inside.all():
            raise ValueError("a vertex is outside macro_domain_bounds")
        return np.arange(len(at)), at

    def requires_initial_data(self) -> bool:
        return False

    def initialize(self) -> None:
        if self._first:
            self._send(self._coordinates)
        else:
            self._scheme.vertices = self._receive()
            self._read = self._receive()

    def is_coupling_ongoing(self) -> bool:
        return self._time < self._scheme.end

    def get_max_time_step_size(self) -> float:
        return self._scheme.window

    def requires_writing_checkpoint(self) -> bool:
        asked, self._new_window = self._new_window, False
        return asked

    def requires_reading_checkpoint(self) -> bool:
        return self._repeat

    def is_time_window_complete(self) -> bool:
        return not self._repeat

    def write_data(self, mesh: str, name: str, ids: np.ndarray, values: np.ndarray) -> None:
        values = np.array(values, dtype=float)
        if name not in self._scheme.writes[self._name] or name not in self._scheme.meshes[mesh]:
            raise ValueError(f"{self._name} writes no {name}")
        if values.shape != (len(ids), self._scheme.dimensions[mesh]):
            raise ValueError(f"{name} has shape {values.shape}")
        self._written[name] = values

    def read_data(self, mesh: str, name: str, ids: np.ndarray, relative_time: float) -> np.ndarray:
        if name not in self._scheme.reads[self._name]:
            raise ValueError(f"{self._name} reads no {name}")
        if self._first and relative_time != (self._scheme.window if self._repeat else 0):
            raise ValueError("a first participant reads the end of a repeated window, or the time that it has reached")
        return self._read[name].copy()

    def advance(self, dt: float) -> None:
        if dt != self._scheme.window or self._written.keys() != self._scheme.writes[self._name]:
            raise ValueError("a step of another size, or data that were not written")
        self._iteration += 1
        if self._first:
            self._send({name: values.copy() for name, values in self._written.items()})
            self._read, self._repeat = self._receive()
        else:
            met = all(name in self._before and
                      np.linalg.norm(self._written[name] - self._before[name]) <= limit * np.linalg.norm(self._written[name])
                      for name, limit in self._scheme.limits.items())
            self._repeat = not met and self._iteration < self._scheme.most
            self._before = dict(self._written) if self._repeat else {}
            self._send((dict(self._written), self._repeat))
        if not self._repeat:
            self._time, self._iteration, self._new_window = self._time + dt, 0, True
        if not self._first and self.is_coupling_ongoing():
            self._read = self._receive()

    def finalize(self) -> None:
        pass
