#!/usr/bin/env python3
"""Single flipped bits in specimen and record files: damage.py PROGRAM [NUMBER].

Packs a specimen, runs a test on it, and flips one bit at a time, seeded, NUMBER (1000) in each file. Each must be
refused (exit code 2, one line) or leave what `inspect --json` prints as it is. Files of earlier versions have no
checksum: there only crashes, endless runs and messages of several lines are counted as bad.
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile

TEST = '[test]\nname = "small"\n[output]\nsnapshots_every = 2\n[[stage]]\nkind = "simple_shear"\nto_strain = 1e-3\n' \
       'record_every = 2e-4\n'


def answer(program, path):
    done = subprocess.run([program, "inspect", path, "--json"], capture_output=True, timeout=120)
    return done.returncode, done.stdout, done.stderr.decode(errors="replace")


def measures(output, path):
    listing = json.loads(output)
    del listing["file"]
    return listing


def flip(program, original, number, sealed, work):
    whole = original.read_bytes()
    code, output, errors = answer(program, original)
    if code != 0:
        sys.exit(f"damage: {original} cannot be read: {errors}")
    reference = measures(output, original)
    rng = random.Random(len(whole))
    counts = {"refused": 0, "without effect": 0, "opened and differed": 0, "bad": 0}
    damaged = work / "damaged.h5"
    for _ in range(number):
        at, bit = rng.randrange(len(whole)), rng.randrange(8)
        bytes_ = bytearray(whole)
        bytes_[at] ^= 1 << bit
        damaged.write_bytes(bytes_)
        code, output, errors = answer(program, damaged)
        if code == 0:
            same = measures(output, damaged) == reference
            counts["without effect" if same else "opened and differed"] += 1
        elif code in (1, 2) and errors.count("\n") == 1 and errors.startswith("rvelab: "):
            counts["refused"] += 1
        else:
            counts["bad"] += 1
            print(f"  byte {at} bit {bit}: exit code {code}, {errors!r}")
    print(f"{original.name}: {len(whole)} bytes, {number} flips: " + ", ".join(f"{n} {k}" for k, n in counts.items()))
    return counts["bad"] == 0 and not (sealed and counts["opened and differed"])


def main():
    program, number = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    good = True
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "small.toml").write_text(TEST)
        for words in (["pack", "pack_dense", "-o", "S.h5", "--set", "pack.number=64"],
                      ["run", "small.toml", "--specimen", "S.h5", "-o", "R.h5"]):
            subprocess.run([program, *words], cwd=work, check=True, capture_output=True)
        for name in ("S.h5", "R.h5"):
            good &= flip(program, work / name, number, True, work)
        older = pathlib.Path(__file__).resolve().parents[2] / "tests/data/compat"
        for name in ("specimen_1_2.h5", "records_1_2.h5"):
            good &= flip(program, older / name, number, False, work)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
