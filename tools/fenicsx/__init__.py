"""Finite elements with grains inside: dolfinx problems whose quadrature points are RVEs.

    from mpi4py import MPI
    from dolfinx import mesh
    from rvelab import fenicsx
    block = mesh.create_rectangle(MPI.COMM_WORLD, [(0, 0), (1, 2)], (4, 8), mesh.CellType.quadrilateral)
    solver = fenicsx.Solver(fenicsx.Material(block, "S.h5"))
    solver.fix(lambda x: x[1] < 1e-9, 1)
    solver.fix(lambda x: x[1] > 2 - 1e-9, 1, lambda t: -2 * t)      # t: axial strain
    solver.fix(lambda x: (x[0] < 1e-9) & (x[1] < 1e-9), 0, at="points")
    solver.pressure(lambda x: (x[0] < 1e-9) | (x[0] > 1 - 1e-9), 100e3)
    for step in solver.march(end=0.01, first=5e-4):
        print(step.t, solver.reaction(lambda x: x[1] > 2 - 1e-9), step.iterations)

Needs dolfinx with PETSc and MUMPS, mpi4py, petsc4py: `tools/setup fenicsx`, or apt-get install python3-dolfinx-real."""
try:
    import dolfinx as _dolfinx  # noqa: F401
    import mpi4py as _mpi4py  # noqa: F401
    import petsc4py as _petsc4py  # noqa: F401
except ModuleNotFoundError as missing:
    if missing.name not in ("dolfinx", "mpi4py", "petsc4py"):
        raise
    import sys as _sys
    _text = (f"rvelab.fenicsx needs {missing.name}, which {_sys.executable or 'this Python'} does not have: "
             "tools/setup fenicsx, or apt-get install python3-dolfinx-real; other systems: "
             "https://fenicsproject.org/download")
    if _sys.argv[:1] == ["-m"] and "rvelab.fenicsx" in getattr(_sys, "orig_argv", ()):  # the program: a line is enough
        print(_text, file=_sys.stderr)
        _sys.exit(2)
    raise ImportError(_text) from None
from .checkpoint import load, rve, save
from .material import Material, geostatic
from .output import Output
from .solver import Increment, NotConverged, Solver
from .summary import summary

__all__ = ["Increment", "Material", "NotConverged", "Output", "Solver", "geostatic", "load", "rve", "save", "summary"]
