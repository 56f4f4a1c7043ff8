"""tools/validate mpm_threads: what threads share of a step with three bodies on 10,000 points. mpm_threads.py RVELAB
WORK RESULTS

The same bits on 1, 2, 3 and 5 threads; the share of a step's instructions that are made in pieces (callgrind, any
machine), and what two cores can make of it; best wall time of three on one and on two threads (a quiet machine)."""

import re
import shutil

import harness
from harness import mpm, sets, work

SCENE = """
[scene]
name = "three bodies on 10,000 points"
[grid]
cell_m = 0.02
[time]
duration_s = 0.3
[loads]
gravity_m_s2 = [0, -9.81]
[initial]
stress = "geostatic"
surface_m = 1
[[material]]
name = "soil"
kind = "elastic"
young_modulus_Pa = 1e7
[[region]]
material = "soil"
lower_m = [0, 0]
upper_m = [1, 1]
[[body]]
name = "base"
kind = "half_space"
centre_m = [0, 0]
normal = [0, 1]
[[body]]
name = "footing"
kind = "box"
centre_m = [0.3, 1.1]
size_m = [0.2, 0.2]
motion = [[0, 0, -0.1]]
[[body]]
name = "pipe"
kind = "disc"
centre_m = [0.7, 1.1]
radius_m = 0.1
motion = [[0, 0, -0.1]]
[output]
frame_every_s = 0.3
checkpoint_every_s = 0.3
"""


def run(threads, *before, stop="0.3"):
    out = work / f"threads_{threads}"
    shutil.rmtree(out, ignore_errors=True)
    done = harness.run(*before, mpm, work / "three.toml", "-o", out, "-q", "-j", threads,
                       *sets(f"time.duration_s={stop}"))
    return out, float(re.search(r"wall ([\d.e+-]+) s", done.stdout)[1])


def counted():
    """Instructions of Solver::step and stable_step, and of what they make in pieces."""
    out = work / "callgrind.out"
    run(1, "valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", stop="0.03")
    listed = harness.run("callgrind_annotate", "--inclusive=yes", "--threshold=100", out).stdout.splitlines()

    def of(name):
        return sum(int(line.split("(")[0].replace(",", "")) for line in listed if f"{name}(" in line)
    return of("mpm::Solver<2>::step") + of("mpm::Solver<2>::stable_step"), of("rvelab::Workers::share")


def main():
    (work / "three.toml").write_text(SCENE)
    ends = [{path.name: path.read_bytes() for path in run(threads)[0].iterdir() if path.name != "scene.toml"}
            for threads in (1, 2, 3, 5)]
    same = all(end == ends[0] for end in ends)
    print(f"1, 2, 3 and 5 threads: {'the same bits' if same else 'OTHER BITS'} in {len(ends[0])} files")
    whole, shared = counted()
    part = shared / whole
    print(f"instructions of a step in pieces: {100 * part:.1f} %; two cores could be {1 / (1 - part / 2):.2f} times as fast as one",
          flush=True)
    one, two = (min(run(threads)[1] for _ in range(3)) for threads in (1, 2))
    print(f"wall time, best of three: {one:.2f} s on one thread, {two:.2f} s on two: {one / two:.2f} times as fast")
    return not (same and 1 / (1 - part / 2) > 1.8)


if __name__ == "__main__":
    harness.main(main)
