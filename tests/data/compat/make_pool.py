#!/usr/bin/python3
"""Makes pool_VERSION.h5 from specimen_VERSION.h5: three RVEs of four, a step that was committed, two that were not, and
prints what tests/abi/test_compat.cpp expects of it: ids, tokens, and the stresses of the steps that follow.

    RVELAB_LIBRARY=build/release/lib/librvelab.so.1 tests/data/compat/make_pool.py 1.8
"""
import gzip
import pathlib
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parents[2] / "tools" / "python"))
import rvelab

VERSION = sys.argv[1].replace(".", "_")


def steps(ids, round_):
    """dH of each RVE: shear, stretch, both, a little more in each round."""
    one = 1e-5 * (1 + round_)
    return [[[one * (k % 2), one, 0], [0, -one * (k // 2), 0], [0, 0, 0]] for k in range(len(ids))]


with tempfile.TemporaryDirectory() as name:
    specimen, file = pathlib.Path(name) / "s.h5", pathlib.Path(name) / "p.h5"
    specimen.write_bytes(gzip.decompress((FOLDER / f"specimen_{VERSION}.h5.gz").read_bytes()))
    pool = rvelab.Pool(workers=1)
    ids = pool.spawn(pool.template(specimen), 4)
    pool.release([ids[1]])
    ids = ids[[0, 2, 3]]
    pool.trial(ids, steps(ids, 0))
    pool.commit()
    first = pool.trial(ids, steps(ids, 1))
    pool.trial(ids, steps(ids, 2))
    pool.write(file)
    (FOLDER / f"pool_{VERSION}.h5.gz").write_bytes(gzip.compress(file.read_bytes(), 9, mtime=0))
    found = pool.trial(ids, steps(ids, 3), tokens=first.tokens)
    print("ids", *ids, "tokens", *first.tokens)
    print("sigma_xx, sigma_xy, sigma_yy of each after the step that follows the first that was not committed, Pa")
    for sigma in found.sigma:
        print(*(repr(float(sigma[i][j])) for i, j in ((0, 0), (0, 1), (1, 1))))
