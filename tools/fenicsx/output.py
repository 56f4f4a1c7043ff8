"""Fields of a run for ParaView: cells.xdmf (displacements of nodes, means of cells) and points.xdmf (the quadrature
points, where they are now, with the number of their RVE)."""
from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
from dolfinx import fem, io

from . import compat, tensors
from .material import Material
from .ranks import together

_PAIRS = {2: ("xx", "yy", "xy"), 3: ("xx", "yy", "zz", "yz", "xz", "xy")}


def fields(material: Material) -> dict[str, np.ndarray]:
    """Collective. Values of the committed states at the points of this rank, by name."""
    points, d = material.points, material.d
    strain = tensors.polar(material.F)[1] if material.finite else tensors.symmetric(material.gradient(0))
    found = {f"stress_{pair}_Pa": material.sigma[:, "xyz".index(pair[0]), "xyz".index(pair[1])] for pair in _PAIRS[d]}
    found |= dict(pressure_Pa=-np.trace(material.sigma, axis1=1, axis2=2) / d,
                  deviator_Pa=tensors.deviator(material.sigma), shear_strain=2 * tensors.deviator(strain),
                  volumetric_strain=np.linalg.det(np.eye(d) + strain) - 1)
    return found | points.info() | dict(error_estimate_Pa=material.error, has_an_rve=points.made.astype(float),
                                        grain_steps=points.work)


class Output:
    """Writes the fields at a time t into two files of a folder. Collective."""

    def __init__(self, material: Material, folder: str | os.PathLike[str]) -> None:
        self.material, self.folder, self.times = material, Path(folder), []
        mesh = material.mesh
        together(mesh.comm, self._prepare)
        self.constant = compat.lagrange(mesh, 0, ())
        self.shown = fem.Function(compat.lagrange(mesh, 1, (material.d,)), name="displacement")
        self.means: dict[str, Any] = {}
        self.file = io.XDMFFile(mesh.comm, str(self.folder / "cells.xdmf"), "w")
        self.file.write_mesh(mesh)

    def write(self, t: float) -> None:
        material, comm = self.material, self.material.mesh.comm
        values, count = fields(material), len(material.cells)
        self.shown.interpolate(material.u)
        self.file.write_function(self.shown, t)
        of_cells = compat.cell_dofs(self.constant, count).ravel()
        weights = material.weights / material.weights.sum()
        for name, each in values.items():
            mean = self.means.setdefault(name, fem.Function(self.constant, name=name))
            mean.x.array[of_cells] = each.reshape(count, -1) @ weights
            self.file.write_function(mean, t)
        position = material.x + self._displacement()
        parts = comm.gather((material.numbers, position, values))
        together(comm, lambda: self._write_points(t, parts) if comm.rank == 0 else None)

    def _prepare(self) -> None:
        try:
            import h5py  # noqa: F401
        except ImportError:
            raise ImportError("files for ParaView need h5py, which " + (sys.executable or "this Python") + " does not "
                              "have: tools/setup fenicsx, or apt-get install python3-h5py; the cases run without them "
                              "by --frames 0") from None
        if self.material.mesh.comm.rank == 0:
            self.folder.mkdir(parents=True, exist_ok=True)

    def close(self) -> None:
        self.file.close()

    def _displacement(self) -> np.ndarray:
        """(n, 3) m of the points, from the nodes of their cells by the linear elements that are shown."""
        material, d = self.material, self.material.d
        if not hasattr(self, "expression"):
            reference = compat.quadrature(material.mesh, material.quadrature_degree)[0]
            self.expression = fem.Expression(self.shown, reference)
        found = np.zeros_like(material.x)
        found[:, :d] = compat.evaluate(self.expression, material.mesh, material.cells).reshape(-1, d)
        return found

    def _write_points(self, t: float, parts: list[Any]) -> None:
        import h5py
        order = np.argsort(np.concatenate([part[0] for part in parts]))
        arrays = {"position": np.concatenate([part[1] for part in parts])[order], "rve": np.arange(len(order))}
        arrays |= {name: np.concatenate([part[2][name] for part in parts])[order] for name in parts[0][2]}
        with h5py.File(self.folder / "points.h5", "a" if self.times else "w") as file:
            for name, values in arrays.items():
                file[f"{len(self.times)}/{name}"] = values
        self.times.append(t)
        item = lambda k, name, size: (  # noqa: E731
            f'<DataItem Dimensions="{size}" NumberType="{"Int" if name == "rve" else "Float"}" Precision="8" '
            f'Format="HDF">points.h5:/{k}/{name}</DataItem>')
        grids = []
        for k, time in enumerate(self.times):
            attributes = "".join(f'<Attribute Name="{name}" Center="Node">{item(k, name, len(order))}</Attribute>'
                                 for name in arrays if name != "position")
            grids.append(f'<Grid Name="points"><Time Value="{time}"/><Topology TopologyType="Polyvertex" '
                         f'NodesPerElement="1" NumberOfElements="{len(order)}"/><Geometry GeometryType="XYZ">'
                         f'{item(k, "position", f"{len(order)} 3")}</Geometry>{attributes}</Grid>')
        head = '<?xml version="1.0"?>\n<Xdmf Version="3.0"><Domain><Grid CollectionType="Temporal" GridType="Collection">\n'
        (self.folder / "points.xdmf").write_text(head + "\n".join(grids) + "\n</Grid></Domain></Xdmf>\n")
