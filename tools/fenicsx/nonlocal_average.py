"""Nonlocal average of the strain increment: a band then has a width of some lengths, whatever the elements are.

    e - length^2 laplace(e) = dH in the mesh, no flux through its boundary

for each component, solved on the nodes (linear elements) with one factorisation for all increments. A uniform dH stays
as it is. The implicit gradient form is that of Peerlings et al. (1996, IJNME 39, 3391), with the increment of displacement
gradient as the averaged quantity; the stress then follows the averaged increment, its tangent the local one."""
from __future__ import annotations

from typing import Any

import dolfinx.fem.petsc
import numpy as np
import ufl
from dolfinx import fem
from petsc4py import PETSc

from . import compat


class Average:
    """length: m. A call maps values (n, d, d) at the quadrature points to their average there. Collective."""

    def __init__(self, mesh: Any, reference: np.ndarray, dx: Any, quadrature_degree: int, length: float) -> None:
        self.mesh = mesh
        self.space = compat.lagrange(mesh, 1, ())
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        self.given = fem.Function(compat.quadrature_space(mesh, quadrature_degree, (1, 1)))
        self.found = fem.Function(self.space)
        square = fem.Constant(mesh, PETSc.ScalarType(length ** 2))
        form = fem.form((trial * test + square * ufl.dot(ufl.grad(trial), ufl.grad(test))) * dx)
        self.load = fem.form(self.given[0, 0] * test * dx)
        matrix = dolfinx.fem.petsc.assemble_matrix(form)
        matrix.assemble()
        self.solver = PETSc.KSP().create(mesh.comm)
        self.solver.setType("preonly")
        self.solver.getPC().setType("lu")
        self.solver.getPC().setFactorSolverType("mumps")
        self.solver.setOperators(matrix)
        self.solution, self.right = matrix.createVecs()
        self.vector, self.owned = compat.vector(self.space), compat.owned(self.space)
        count = mesh.topology.index_map(mesh.topology.dim).size_local
        self.cells = np.arange(count, dtype=np.int32)
        self.dofs = compat.cell_dofs(self.given.function_space, count).ravel()
        self.value = fem.Expression(self.found, reference)

    def __call__(self, values: np.ndarray) -> np.ndarray:
        averaged = np.empty_like(values)
        for i in range(values.shape[1]):
            for j in range(values.shape[2]):
                self.given.x.array[self.dofs] = values[:, i, j]
                self.right.array[:] = compat.assemble_into(self.vector, self.load)[:self.owned]
                self.solver.solve(self.right, self.solution)
                self.found.x.array[:self.owned] = self.solution.array
                self.found.x.scatter_forward()
                averaged[:, i, j] = compat.evaluate(self.value, self.mesh, self.cells).ravel()
        return averaged
