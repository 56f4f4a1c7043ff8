"""Granular representative volume elements: an increment of displacement gradient goes in, the Cauchy stress comes out.

    import rvelab
    rvelab.pack("pack_dense", "S.h5")                            # a specimen from a recipe
    rve = rvelab.Rve("S.h5")                                     # a specimen file, or a record file: its end state
    sigma = rve.apply([[0, 1e-4, 0], [0, 0, 0], [0, 0, 0]])      # Pa
    print(rve, rve.positions, rve.contacts.normal_force)
    records = rvelab.run("biaxial", rve, {"test.pressure_Pa": 50e3}, output="R.h5")
    rvelab.plot("stress_strain", records)                        # shown by a notebook; output="R.pdf" keeps it

dH     (3, 3), dH[i, j] = d(du_i)/dx_j over the step, laboratory frame, finite (F_inc = I + dH), spin included.
sigma  (3, 3), Pa, laboratory frame, Cauchy, tension positive. Batches have a first axis of length n. SI units.
dt     s; > 0: physical time, real inertia and rate; 0: quasi-static. 2D: z-components of dH are zero.

Needs numpy and librvelab.so.1: from RVELAB_LIBRARY, in or beside this package, or found by the loader, in this order. The
meaning of every call is that of include/rvelab/rvelab.h. Calls on different RVEs may run in threads: ctypes releases the
interpreter's lock meanwhile."""
import sys as _sys

try:
    import numpy as _numpy  # noqa: F401
except ModuleNotFoundError as missing:
    if missing.name != "numpy":
        raise
    raise ImportError(f"rvelab needs numpy, which {_sys.executable or 'this Python'} does not have: apt-get install "
                      "python3-numpy, or pip install numpy in the environment of this Python") from None
from .library import (MEASURES, Array, Batch, Discard, Info, Mixed, OutOfMemory, RvelabError, RvelabWarning, StaleToken,
                      library as _library)
from .pool import Pool
from .rve import Contacts, Rve
from .laboratory import PathPoint, Records, calibrate, ensemble, fit, pack, run
from .figures import Picture, plot, report

__all__ = ["Array", "Batch", "Contacts", "Discard", "Info", "MEASURES", "Mixed", "OutOfMemory", "PathPoint", "Picture", "Pool",
           "Records", "Rve", "RvelabError", "RvelabWarning", "StaleToken", "calibrate", "ensemble", "fit", "pack", "plot",
           "report", "run"]
__version__ = _library.rvelab_version().decode()
