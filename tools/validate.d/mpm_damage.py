"""tools/validate mpm_damage: single flipped bits in what rvelab-mpm reads back. mpm_damage.py RVELAB FOLDER [NUMBER]

Runs of grains, dry and saturated, and one with a rock are stopped, rows that a kill might have left are added, and one bit at a time is
flipped, seeded, NUMBER (1000) in each file that --resume reads. Each must be refused (exit code 2, one line that names
the file) or be without effect: the run goes on to the same bytes."""

import pathlib
import random
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
rvelab, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
number = int(sys.argv[3]) if len(sys.argv) > 3 else 1000
mpm = rvelab.with_name("rvelab-mpm")
SCENES = {"dry": ("element", "0.1", "0.13"), "saturated": ("undrained_element", "0.01", "0.02"),
          "rocks": ("block_slide", "0.002", "0.0022")}  # stopped, end; s


def resume(run):
    done = subprocess.run([mpm, "--resume", run, "-q", "-j", "1"], capture_output=True, timeout=300)
    return done.returncode, done.stderr.decode(errors="replace")


def outcome(run):
    return {path.name: path.read_bytes() for path in sorted(run.iterdir())}


def main():
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    subprocess.run([rvelab, "pack", ROOT / "protocols/pack_dense.toml", "-o", folder / "dense.h5", "--set", "pack.number=60"], check=True,
                   stdout=subprocess.DEVNULL)
    bad = 0
    for name, (scene, stop, end) in SCENES.items():
        print(name)
        bad += flipped(folder / name, ROOT / f"protocols/mpm/{scene}.toml", stop, end)
    sys.exit(1 if bad else 0)


def flipped(place, scene, stop, duration):
    """How many flips were neither refused nor without effect."""
    kept, run = place / "kept", place / "run"
    subprocess.run([mpm, scene, "-o", kept, "--specimens", folder, "-q", "-j", "1", "--stop-at", stop, "--set",
                    f"time.duration_s={duration}", "--set", f"output.history_every_s={float(stop) / 10}"], check=True,
                   stdout=subprocess.DEVNULL)
    for name in ("history.csv", "watched.csv"):
        rows = (kept / name).read_text()
        (kept / name).write_text(rows + rows.splitlines()[-1] + "\n")
    start = outcome(kept)
    shutil.copytree(kept, run)
    code, errors = resume(run)
    assert code == 0, errors
    end = outcome(run)
    bad = 0
    for name in sorted(start):
        if name.startswith(("points", "rocks")):
            continue  # frames are not read
        rng = random.Random(len(start[name]))
        counts = {"refused": 0, "without effect": 0, "bad": 0}
        for _ in range(number):
            at, bit = rng.randrange(len(start[name])), rng.randrange(8)
            shutil.rmtree(run)
            shutil.copytree(kept, run)
            damaged = bytearray(start[name])
            damaged[at] ^= 1 << bit
            (run / name).write_bytes(damaged)
            code, errors = resume(run)
            if code == 2 and errors.count("\n") == 1 and name in errors:
                counts["refused"] += 1
            elif code == 0 and outcome(run) == end:
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
    main()
