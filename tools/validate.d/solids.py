"""tools/validate solids: random packings of ellipsoids without friction. solids.py RVELAB [NUMBER [SPECIMENS]]

Solid fraction and mechanical coordination number beside what is published. Without friction a random packing of
frictionless grains with all their rotations has Z up to 12, of spheres 6; ellipsoids near spheres are hypostatic (Donev et
al. 2007, Phys. Rev. E 75)."""
import collections
import csv
import json
import statistics
import subprocess
import sys
import tempfile

program, number, specimens = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 120, \
    int(sys.argv[3]) if len(sys.argv) > 3 else 2
shapes = [("spheres", [1, 1, 1], "0.64, 6"),
          ("1.25 : 1 : 0.8", [1.25, 1, 0.8], "0.735, 10 to 12 (Donev et al. 2004)"),
          ("1 : 1 : 0.6", [1, 1, 0.6], "0.68 to 0.71, about 10 (spheroids, Donev et al. 2004)"),
          ("2 : 1 : 1", [2, 1, 1], "0.68 to 0.71, about 10 (spheroids, Donev et al. 2004)")]


def skeleton(path):
    """Contacts a grain of those that have four at least, counted among themselves."""
    with open(path, encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        pairs = [(row["id1"], row["id2"]) for row in rows]
    while True:
        counts = collections.Counter(grain for pair in pairs for grain in pair)
        kept = [pair for pair in pairs if min(counts[grain] for grain in pair) >= 4]
        if len(kept) == len(pairs):
            return 2 * len(pairs) / len(counts)
        pairs = kept


print(f"{number} grains of one size, friction 0, {specimens} specimens of each; 100 kPa of 7 GPa")
print("half axes | solid fraction | Z of the skeleton | published")
for name, half, published in shapes:
    fractions, contacts = [], []
    for seed in range(1, specimens + 1):
        with tempfile.TemporaryDirectory() as folder:
            sets = ["pack.number=" + str(number), "pack.seed=" + str(seed), "grains.half_axes=" + str(half),
                    "grains.smallest_radius_m=1e-3", "grains.largest_radius_m=1e-3", "preparation.friction=0",
                    "material.quartz.friction=0", "target.pressure_Pa=1e5", "target.unbalanced=1e-3", "target.stress_tolerance=1e-2"]
            arguments = [program, "pack", "pack_ellipsoids", "-o", folder + "/s.h5"]
            for each in sets:
                arguments += ["--set", each]
            made = subprocess.run(arguments, capture_output=True, text=True)
            if made.returncode != 0:
                sys.exit(made.stderr)
            state = json.loads(subprocess.run([program, "inspect", folder + "/s.h5", "--json"], capture_output=True,
                                              text=True, check=True).stdout)
            fractions.append(1 / (1 + state["void_ratio"]))
            subprocess.run([program, "export", folder + "/s.h5", "--format", "csv", "-o", folder + "/s"],
                           capture_output=True, check=True)
            contacts.append(skeleton(folder + "/s.contacts.csv"))
    spread = statistics.stdev(fractions) if specimens > 1 else float("nan")
    print(f"{name} | {statistics.mean(fractions):.3f} +- {spread:.3f} | {statistics.mean(contacts):.2f} | {published}",
          flush=True)
