"""The interface of dolfinx in the one form that this package uses: that of 0.5 (Debian 12), and that of 0.8 and later
as its documentation and source have it, where elements come from basix.ufl and spaces from fem.functionspace."""
from __future__ import annotations

from typing import Any, Callable

import basix
import dolfinx
import dolfinx.fem.petsc  # noqa: F401  (not imported by dolfinx itself since 0.6)
import numpy as np
import ufl
from dolfinx import fem, la, mesh as meshes

OLD = not hasattr(fem, "functionspace")  # before 0.7
if not OLD:
    import basix.ufl

QUADRILATERALS = "quadrilateral", "hexahedron"


def cell_name(mesh: Any) -> str:
    return mesh.ufl_cell().cellname() if OLD else mesh.topology.cell_name()


def lagrange(mesh: Any, degree: int, shape: tuple[int, ...]) -> Any:
    """The space of Lagrange elements; on quadrilaterals and hexahedra degree 2 means serendipity (8 or 20 nodes).
    Degree 0 is constant in each cell."""
    family = "DG" if degree == 0 else "S" if degree == 2 and cell_name(mesh) in QUADRILATERALS else "Lagrange"
    if OLD:
        element = ufl.FiniteElement(family, mesh.ufl_cell(), degree)
        if shape:
            element = ufl.VectorElement(element, dim=shape[0])
        return fem.FunctionSpace(mesh, element)
    if family == "S":
        element = basix.ufl.element(basix.ElementFamily.serendipity, cell_name(mesh), degree, shape=shape or None,
                                    lagrange_variant=basix.LagrangeVariant.legendre,
                                    dpc_variant=basix.DPCVariant.legendre)
        return fem.functionspace(mesh, element)
    return fem.functionspace(mesh, (family, degree, shape) if shape else (family, degree))


def quadrature_space(mesh: Any, degree: int, shape: tuple[int, ...]) -> Any:
    """Values at the quadrature points of each cell."""
    if OLD:
        words = dict(cell=mesh.ufl_cell(), degree=degree, quad_scheme="default")
        return fem.FunctionSpace(mesh, ufl.TensorElement("Quadrature", shape=shape, **words))
    return fem.functionspace(mesh, basix.ufl.quadrature_element(cell_name(mesh), value_shape=shape, scheme="default",
                                                                degree=degree))


def quadrature(mesh: Any, degree: int) -> tuple[np.ndarray, np.ndarray]:
    """Points (q, dimension) and weights (q) on the reference cell."""
    return basix.make_quadrature(getattr(basix.CellType, cell_name(mesh)), degree)


def cell_dofs(space: Any, cells: int) -> np.ndarray:
    """(cells, dofs of a cell) blocks of the first cells."""
    listed = space.dofmap.list
    array = listed.array.reshape(listed.num_nodes, -1) if OLD and hasattr(listed, "array") else np.asarray(listed)
    return array[:cells]


def _first(geometry: Any, name: str) -> Any:
    """The one of the only kind of cells: geometry.name; geometry.names[0] of releases that deprecate it."""
    several = getattr(geometry, name + "s", None)
    return several[0] if isinstance(several, (list, tuple)) else getattr(geometry, name)


def cell_corners(mesh: Any, cells: int) -> np.ndarray:
    """(cells, nodes, 3) m, nodes of the geometry of the first cells."""
    listed = _first(mesh.geometry, "dofmap")
    array = listed.array.reshape(listed.num_nodes, -1) if hasattr(listed, "array") else np.asarray(listed)
    return mesh.geometry.x[array[:cells]]


def push_forward(mesh: Any, points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(points, dimension) m of points of the reference cell, in the cell of these corners."""
    return _first(mesh.geometry, "cmap").push_forward(points, np.ascontiguousarray(corners[:, :mesh.geometry.dim]))


def evaluate(expression: Any, mesh: Any, cells: np.ndarray) -> np.ndarray:
    return expression.eval(cells) if OLD else expression.eval(mesh, cells)


def locate(mesh: Any, dimension: int, marker: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Entities of the boundary with the marker true at all nodes and at the middle: a facet between two marked sides is
    in none of them."""
    found = meshes.locate_entities_boundary(mesh, dimension, marker)
    if len(found) == 0 or dimension == 0:
        return found
    return found[np.asarray(marker(meshes.compute_midpoints(mesh, dimension, found).T), bool)]


def facet_tags(mesh: Any, groups: list[np.ndarray]) -> Any:
    """Tags 1, 2, ... of groups of facets; a facet keeps that of the first group that names it."""
    found: dict[int, int] = {}
    for tag, facets in enumerate(groups, 1):
        for facet in facets:
            found.setdefault(int(facet), tag)
    entities = np.array(sorted(found), np.int32)
    return meshes.meshtags(mesh, mesh.topology.dim - 1, entities, np.array([found[k] for k in entities], np.int32))


def vector(space: Any) -> Any:
    return la.vector(space.dofmap.index_map, space.dofmap.index_map_bs)


def assemble_into(vector: Any, form: Any) -> np.ndarray:
    """Assembles a linear form with the parts of other ranks: its array, of which the owned part is whole."""
    vector.array[:] = 0
    fem.assemble_vector(vector.array, form)
    vector.scatter_reverse(la.ScatterMode.add if OLD else la.InsertMode.add)
    return vector.array


def owned(space: Any) -> int:
    """Degrees of freedom of a space that this rank owns; they are the first."""
    return space.dofmap.index_map.size_local * space.dofmap.index_map_bs


def version() -> str:
    return dolfinx.__version__
