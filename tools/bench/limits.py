#!/usr/bin/env python3
"""Makes the page of tools/bench/limits from what that script leaves in its folder.

    tools/bench/limits.py WORK RVELAB
"""
import collections
import json
import pathlib
import re
import subprocess
import sys

work, program = pathlib.Path(sys.argv[1]), sys.argv[2]
SCENES = {"disc_400_linear": "400 discs, linear", "ellipse_400_linear": "400 ellipses of aspect 0.743, linear",
          "sphere_1000_hertz": "1,000 spheres, Hertz-Mindlin"}
ARITHMETIC = re.compile(r"v?(mul|add|sub|div|sqrt|max|min|cmp|blendv|and|andn|or|xor)\w*p[ds]|vps(rl|ub)q|vp(or|and|xor)|v(div|sqrt|mul|add|sub)sd")
SHUFFLE = re.compile(r"v(unpck|perm|insert|extract|shuf|broadcast|movhp|movddup)")


def counted(path):
    """Executions of each instruction, by function and address."""
    names, function, address, call = {}, None, 0, False
    counts = collections.defaultdict(collections.Counter)
    for line in open(path):
        named = re.match(r"(c?fn)=\((\d+)\)(?: (.*))?", line)
        if named:
            if named[3]:
                names[named[2]] = named[3]
            if named[1] == "fn":
                function, call = names[named[2]], False
        elif line.startswith("calls="):
            call = True
        elif cost := re.match(r"(0x[0-9a-f]+|[+-](?:0x)?[0-9a-f]+|\*) \S+(?: (\d+))?$", line):
            at = cost[1]
            address = int(at, 16) if at[0] == "0" else address if at == "*" else address + int(at, 0)
            if not call:
                counts[function][address] += int(cost[2] or 0)
            call = False
    return counts


def part_of(name):
    for word, part in (("_places", "pairs: rows and places"), ("_far_place", "pairs: a step more"),
                       ("further_step", "pairs: a step more"), ("settled_place", "pairs: a step more"),
                       ("_pairs<", "pairs: forces; of round grains rows and places too"), ("_grains<", "grains: gather, integration"),
                       ("may_touch", "far pairs looked at")):
        if word in name:
            return part
    return "list, control, the rest"


def kinds(addresses):
    """Arithmetic, shuffles, moves of vectors, integers, by address."""
    kind = {}
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", f"--start-address={min(addresses)}",
                           f"--stop-address={max(addresses) + 16}", program], capture_output=True, text=True).stdout
    for line in text.splitlines():
        if found := re.match(r" *([0-9a-f]+):\s+(\S+)", line):
            word = found[2]
            kind[int(found[1], 16)] = (0 if ARITHMETIC.match(word) else 1 if SHUFFLE.match(word) else
                                       2 if word.startswith("v") else 3)
    return kind


print("""# What a sub-step costs, and the least that it could

Made by `tools/bench/limits build/release/bin/rvelab` (callgrind counts the v3 kernels, four lanes; simple shear at the inertial number
1e-3 by 2e-3). Beside it stand the floors of the prototypes before this code: 185 M grain-steps a second in the plane and 45 in space
(AVX-512, 3.69 GHz, an estimate: 20 and 82 cycles).
""")
for scene, title in SCENES.items():
    steps = json.loads((work / f"{scene}.json").read_text())
    grain_steps = steps.get("grain_steps") or next(v["grain_steps"] for v in steps["stages"][-1:] if v)
    grains = json.loads((work / f"{scene}.inspect.json").read_text())
    counts = counted(work / f"{scene}.out")
    parts = collections.defaultdict(lambda: [0, 0, 0, 0])
    passes = 0
    for function, by_address in counts.items():
        kind = kinds(by_address) if sum(by_address.values()) > 0.002 * grain_steps else {}
        part = part_of(function)
        if "_pairs<" in function:
            passes = max(passes, max(by_address.values()))
        for address, n in by_address.items():
            parts[part][kind.get(address, 3)] += n
    near, contacts = 4 * passes / grain_steps, grains["contacts"] / grains["grains"]
    total = [sum(of[k] for of in parts.values()) for k in range(4)]
    print(f"## {title}\n\nContacts a grain {contacts:.2f}, pairs computed at every step {near:.2f}. Instructions a grain-step:\n")
    print("| part | all | arithmetic | shuffles, gathers | loads, stores | integers, branches | a pair computed | a contact |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for part, of in sorted(parts.items(), key=lambda item: -sum(item[1])) + [("sum", total)]:
        all_of = sum(of) / grain_steps
        print(f"| {part} | {all_of:.1f} | " + " | ".join(f"{v / grain_steps:.1f}" for v in of) +
              f" | {all_of / near:.1f} | {all_of / contacts:.1f} |")
    print()
print("""What is left. Arithmetic alone, at four lanes, is 0.36 of the instructions of discs and 0.46 of those of spheres: the rest fetches rows,
turns them into columns and back, and gathers. Of ellipses the arithmetic of the direction is the limit: with a first direction that
needed no step (one evaluation that confirms it, 100 instructions for four pairs, besides their rows) a grain-step would take 235.
""")

large = json.loads((work / "large.json").read_text())
case = large["sphere_256000_hertz"]
bandwidth, near = float((work / "triad.txt").read_text()), 1.02 * case["contacts_per_grain"]
rows = [  # of a grain or of a pair computed: what, bytes now, the least
    ("grain rows, 12 doubles, read and written; of 9 that move, radius read", 1, 2 * 96, 2 * 72 + 8),
    ("mass, 1/mass, 1/inertia: 3 doubles read; the least two", 1, 24, 16),
    ("tasks of the gather, 2 of 16 bits, a start of 32 bits for 4", 1, 5, 0),
    ("history: 3 of the tangential force and sqrt(overlap), read and written", near, 2 * 32, 2 * 32),
    ("rows of i and j, 32 bits each", near, 8, 8),
    ("kn, kt, friction: 3 doubles read; the least: by material and radius", near, 24, 0),
    ("force row, 8 doubles, fetched and written back; the least: none leaves the cache", near, 2 * 64, 0),
    ("slots of the gather, 2 of 32 bits", near, 8, 0),
]
print(f"""## 256,000 spheres: bytes

By `assembly.hpp` and `configuration.hpp`, {case["contacts_per_grain"]:.2f} contacts and {near:.2f} pairs computed a grain; pairs of a sub-step and grains of the
next go through memory in one sweep (`loading/sweep.hpp`), so that grain rows and force rows are fetched once. Bytes a grain-step:

| | now | least |
| --- | --- | --- |""")
for what, number, now, least in rows:
    print(f"| {what} | {number * now:.0f} | {number * least:.0f} |")
now, least = (sum(number * of[k] for _, number, *of in rows) for k in (0, 1))
speed = case["grain_steps_per_second"]
print(f"""| sum | {now:.0f} | {least:.0f} |

Measured ({large["instruction_set"]}, one thread, `rvelab bench --quick --case sphere_256000_hertz`): {speed / 1e6:.1f} M grain-steps a second, {speed * now / 1e9:.1f} GB/s of the {bandwidth / 1e9:.1f} GB/s
that a triad a = b + s c reaches beside it (32 bytes an element). At that bandwidth the bytes of now allow {bandwidth / now / 1e6:.0f} M, the least {bandwidth / least / 1e6:.0f} M: the step waits for misses of
the rows of grains that are neighbours in space and not in memory, not for bandwidth. The largest item is the force rows: two of eight
doubles hold nothing a sum needs, and rows of a block that are gathered before they leave the cache need not be kept. Both figures are
of one moment of a shared machine.""")
