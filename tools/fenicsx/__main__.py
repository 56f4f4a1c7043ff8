"""python3 -m rvelab.fenicsx CASE [options], mpirun -np 4 python3 -m rvelab.fenicsx CASE [options]"""
import importlib
import logging
import sys
import traceback
import warnings

from mpi4py import MPI

CASES = {"biaxial": "a block to a band of shear", "footing": "a strip footing beside N_q and N_gamma",
         "wall": "a retaining wall, active or passive, beside Rankine and Coulomb",
         "cavity": "an expanding cylindrical cavity",
         "triaxial": "a cylinder of spheres between rough plates"}


def main(words: list[str]) -> int:
    comm = MPI.COMM_WORLD
    logging.disable(logging.INFO)  # the compiler of forms reports each of its calls
    warnings.simplefilter("ignore", ResourceWarning)
    listed = "\n".join(f"  {name:10}{text}" for name, text in CASES.items())
    usage = (f"usage: python3 -m rvelab.fenicsx CASE [options]; CASE --help lists its options\n{listed}\n"
             "  rve CHECKPOINT NUMBER -o FILE: the RVE of a point, by its number in points.xdmf, as a specimen file")
    if words in ([], ["--help"], ["-h"]):
        print(usage if comm.rank == 0 else "", end="\n" if comm.rank == 0 else "")
        return 0 if words else 2
    try:
        if words[0] == "rve":
            from .checkpoint import rve
            if len(words) != 5 or words[3] != "-o" or not words[2].isdigit():
                raise ValueError("usage: rve CHECKPOINT NUMBER -o FILE")
            print(rve(words[1], int(words[2]), words[4]))
            return 0
        if words[0] not in CASES:
            raise ValueError(f"there is no case {words[0]!r}; allowed: {', '.join(CASES)}, rve")
        importlib.import_module("." + words[0], __package__).main(words[1:], comm)
        return 0
    except KeyboardInterrupt as stopped:
        print(f"\nrvelab.fenicsx: {stopped or 'stopped'}" if comm.rank == 0 else "", file=sys.stderr, flush=True)
        return 130
    except Exception as error:
        if isinstance(error, (ValueError, RuntimeError, OSError, ImportError)):  # RvelabError is a RuntimeError
            print(f"rvelab.fenicsx: {error}", file=sys.stderr, flush=True)
        else:
            traceback.print_exc()
        if comm.size > 1:
            comm.Abort(2)  # other ranks may wait for this one
        return 2


sys.exit(main(sys.argv[1:]))
