"""Single flipped bits in every kind of file that is read: damage.py PROGRAM WORK RESULTS [NUMBER].

Packs a specimen, runs a test on it, exports CSV, and flips one bit at a time, seeded, NUMBER (1000) in each file:
specimen, records, a pool, a journal without its record file; records and a pool of cemented, moist grains too. Each must be refused (exit code 2, one line) or leave what
`inspect --json` prints as it is; of a journal the whole frames before the flip are taken, and stand for fewer records.
The files of `import` have no checksum: there only crashes, endless runs and messages of several lines are counted as bad.
"""
import json
import os
import random
import subprocess
import sys
import time

import harness
from harness import program, run, rvelab, sets, work

TEST = '[test]\nname = "small"\n[output]\nsnapshots_every = 2\n[[stage]]\nkind = "simple_shear"\nto_strain = 1e-3\n' \
       'record_every = 2e-4\n'

CEMENTED = '[test]\nname = "cemented and moist"\n[[stage]]\nkind = "cement"\nyoung_modulus_Pa = 50e6\n' \
           'tensile_strength_Pa = 50e3\ncohesion_Pa = 50e3\n[[stage]]\nkind = "water"\nsuction_Pa = 100\n' \
           '[[stage]]\nkind = "simple_shear"\nto_strain = 5e-3\nrecord_every = 1e-3\n'


def answer(command):
    done = run(*command, codes=None, timeout=120, errors="replace")
    return done.returncode, done.stdout, done.stderr


def measures(output):
    listing = json.loads(output)
    listing.pop("file", None)
    return listing


def flip(command, original, number, sealed, damaged):
    """`command` reads the file `damaged`, which is `original` with a bit flipped."""
    whole = original.read_bytes()
    damaged.write_bytes(whole)
    code, output, errors = answer(command)
    if code != 0:
        sys.exit(f"damage: {original} cannot be read: {errors}")
    reference = measures(output)
    rng = random.Random(len(whole))
    counts = {"refused": 0, "without effect": 0, "opened and differed": 0, "bad": 0}
    for _ in range(number):
        at, bit = rng.randrange(len(whole)), rng.randrange(8)
        bytes_ = bytearray(whole)
        bytes_[at] ^= 1 << bit
        damaged.write_bytes(bytes_)
        code, output, errors = answer(command)
        if code == 0:
            same = measures(output) == reference
            counts["without effect" if same else "opened and differed"] += 1
        elif code in (1, 2) and errors.count("\n") == 1 and errors.startswith("rvelab: "):
            counts["refused"] += 1
        else:
            counts["bad"] += 1
            print(f"  byte {at} bit {bit}: exit code {code}, {errors.replace(str(work), work.name)!r}")
    print(f"{original.name}: {len(whole)} bytes, {number} flips: " + ", ".join(f"{n} {k}" for k, n in counts.items()))
    return counts["bad"] == 0 and not (sealed and counts["opened and differed"])


def journal_of():
    """The journal of a run that was killed."""
    running = subprocess.Popen([program, "run", "small.toml", "--specimen", "S.h5", "-o", "K.h5", "--force",
                                *sets("stage.simple_shear.to_strain=1")], cwd=work, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    journal = work / "K.h5.journal"
    while running.poll() is None and (not journal.exists() or journal.stat().st_size < 200_000):
        time.sleep(0.005)
    running.kill()
    running.wait()
    return journal


def pool_of(source, name):
    """A pool file of one RVE, by the Python package."""
    run(sys.executable, "-c", f"import rvelab; rvelab.Rve('{source}').save('{name}')", cwd=work,
        env={**os.environ, "PYTHONPATH": str(harness.ROOT / "tools/python"),
             "RVELAB_LIBRARY": str(program.parents[1] / "lib/librvelab.so.1")})
    return work / name


def main():
    number, good = int(harness.words[0]) if harness.words else 1000, True
    (work / "small.toml").write_text(TEST)
    (work / "cemented.toml").write_text(CEMENTED)
    for words in (["pack", "pack_dense", "-o", "S.h5", *sets("pack.number=64")],
                  ["run", "small.toml", "--specimen", "S.h5", "-o", "R.h5"],
                  ["run", "cemented.toml", "--specimen", "S.h5", "-o", "C.h5"],
                  ["export", "S.h5", "--format", "csv", "-o", "E"]):
        rvelab(*words, "--force", cwd=work)
    damaged = work / "damaged.h5"
    inspect = [program, "inspect", damaged, "--json"]
    for path in (work / "S.h5", work / "R.h5", work / "C.h5"):
        good &= flip(inspect, path, number, True, damaged)
    for source, name in (("S.h5", "P.h5"), ("C.h5", "PC.h5")):
        pool = pool_of(source, name)
        good &= flip([program, "compare", damaged, pool, "--json"], pool, number, True, damaged)
    damaged.unlink()
    good &= flip(inspect, journal_of(), number, False, work / "damaged.h5.journal")
    tables = [work / name for name in ("E.particles.csv", "E.contacts.csv", "E.json", "E.material.toml")]
    for path in tables:
        copy = path.with_name("damaged." + path.name)
        inputs = [copy if each == path else each for each in tables]
        good &= flip([program, "import", *inputs[:3], "--material", inputs[3], "-o", work / "E.h5", "--force",
                      "--json"], path, number // 4,
                     False, copy)
    return not good


if __name__ == "__main__":
    harness.main(main)
