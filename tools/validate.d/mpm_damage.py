"""tools/validate mpm_damage: single flipped bits in what rvelab-mpm reads back. mpm_damage.py RVELAB WORK RESULTS
[NUMBER]

Runs of grains, dry and saturated, and one with a rock are stopped, rows that a kill might have left are added, and one bit at a time is
flipped, seeded, NUMBER (1000) in each file that --resume reads. Each must be refused (exit code 2, one line that names
the file) or be without effect: the run continues to the same bytes."""

import random
import shutil

import harness
from harness import PROTOCOLS, mpm, run, sets, work

number = int(harness.words[0]) if harness.words else 1000
SCENES = {"dry": ("element", "0.1", "0.13"), "saturated": ("undrained_element", "0.01", "0.02"),
          "rocks": ("block_slide", "0.002", "0.0022")}  # stopped, end; s


def resume(folder):
    done = run(mpm, "--resume", folder, "-q", "-j", "1", codes=None, timeout=300, errors="replace")
    return done.returncode, done.stderr


def outcome(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def main():
    harness.packed("pack_dense", "dense", "pack.number=60")
    bad = 0
    for name, (scene, stop, end) in SCENES.items():
        print(name)
        bad += flipped(work / name, PROTOCOLS / f"mpm/{scene}.toml", stop, end)
    return bad


def flipped(folder, scene, stop, duration):
    """How many flips were neither refused nor without effect."""
    shutil.rmtree(folder, ignore_errors=True)
    kept, again = folder / "kept", folder / "run"
    run(mpm, scene, "-o", kept, "--specimens", work, "-q", "-j", "1", "--stop-at", stop,
        *sets(f"time.duration_s={duration}", f"output.history_every_s={float(stop) / 10}"))
    for name in ("history.csv", "watched.csv"):
        rows = (kept / name).read_text()
        (kept / name).write_text(rows + rows.splitlines()[-1] + "\n")
    start = outcome(kept)
    shutil.copytree(kept, again)
    code, errors = resume(again)
    assert code == 0, errors
    end = outcome(again)
    bad = 0
    for name in sorted(start):
        if name.startswith(("points", "rocks")):
            continue  # frames are not read
        rng = random.Random(len(start[name]))
        counts = {"refused": 0, "without effect": 0, "bad": 0}
        for _ in range(number):
            at, bit = rng.randrange(len(start[name])), rng.randrange(8)
            shutil.rmtree(again)
            shutil.copytree(kept, again)
            damaged = bytearray(start[name])
            damaged[at] ^= 1 << bit
            (again / name).write_bytes(damaged)
            code, errors = resume(again)
            if code == 2 and errors.count("\n") == 1 and name in errors:
                counts["refused"] += 1
            elif code == 0 and outcome(again) == end:
                counts["without effect"] += 1
            else:
                counts["bad"] += 1
                print(f"  {name}, byte {at} bit {bit}: exit code {code}, {errors!r}")
        # Numbers of steps are in the names of pools.
        print(f"{name}: {len(start[name])} bytes, {number} flips: " + ", ".join(f"{n} {k}" for k, n in counts.items()),
              flush=True)
        bad += counts["bad"]
    return bad


if __name__ == "__main__":
    harness.main(main)
