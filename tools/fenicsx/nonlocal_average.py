"""A width of bands that is not that of the elements. The RVEs alone have none: where they soften, strain gathers in
one row of elements. With a length l the stress gets a term of the strain beside its average,

    sigma = sigma of the RVE + h C : (e - a),    a - l^2 laplace(a) = e in the mesh, no flux through its boundary

with e the strain increments' sum and C the tangent of the first state. The average is solved on the nodes (linear
elements) with one factorisation for all increments. A uniform strain stays as it is; waves shorter than l are
stiffened by up to h C, so that bands have a width of some l as long as h C is more than the softening. The averaged
equation is that of Peerlings et al. (1996, IJNME 39, 3391), the stress that of the micromorphic approach of Forest
(2009, J. Eng. Mech. 135, 117; both from memory). To give the averaged increment itself to the RVEs does not work:
where neighbouring RVEs differ, no displacement of a wave shorter than l can balance their stresses."""
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
