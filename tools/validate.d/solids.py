"""tools/validate solids: random packings of ellipsoids without friction. solids.py RVELAB WORK RESULTS [NUMBER
[SPECIMENS]]

Solid fraction and mechanical coordination number beside what is published. Without friction a random packing has as many
contacts as its grains have degrees of freedom, two a contact: Z is 6 of spheres, at most 10 of spheroids and 12 of ellipsoids;
near spheres they are hypostatic (Donev et al. 2007, Phys. Rev. E 75). Spheres that do not slide: 4. The grains are pressed,
and have a little more."""
import collections
import csv
import statistics

import harness
from harness import answer, rvelab, verdict, work

number, specimens = map(int, [*harness.words, *(200, 5)[len(harness.words):]])
# Half axes, friction, solid fraction and Z as published.
shapes = [("spheres", [1, 1, 1], 0, (0.64, 0.64), (6, 6)),
          ("spheres that do not slide", [1, 1, 1], 100, None, (4, 4)),
          ("1.25 : 1 : 0.8 (Donev et al. 2004)", [1.25, 1, 0.8], 0, (0.735, 0.735), (10, 12)),
          ("1 : 1 : 0.6 (Donev et al. 2004)", [1, 1, 0.6], 0, (0.68, 0.71), (10, 10)),
          ("2 : 1 : 1 (Donev et al. 2004)", [2, 1, 1], 0, (0.68, 0.71), (10, 10))]


def skeleton(path, least):
    """Contacts a grain of those that have `least` at least, counted among themselves."""
    with open(path, encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        pairs = [(row["id1"], row["id2"]) for row in rows]
    while True:
        counts = collections.Counter(grain for pair in pairs for grain in pair)
        kept = [pair for pair in pairs if min(counts[grain] for grain in pair) >= least]
        if len(kept) == len(pairs):
            return 2 * len(pairs) / len(counts)
        pairs = kept


def packed(half, friction, seed):
    """Solid fraction and contacts a grain of one packing."""
    file = harness.packed("pack_ellipsoids", f"{'_'.join(map(str, half))}_{friction}_{seed}", f"pack.number={number}",
                          f"pack.seed={seed}",
                          f"grains.half_axes={half}", "grains.smallest_radius_m=1e-3", "grains.largest_radius_m=1e-3",
                          f"preparation.friction={friction}", f"material.quartz.friction={friction}",
                          "target.pressure_Pa=1e5",
                          "target.unbalanced=1e-3", "target.stress_tolerance=1e-2")
    rvelab("export", file, "--format", "csv", "-o", work / file.stem, "--force")
    return 1 / (1 + answer("inspect", file)["void_ratio"]), skeleton(work / f"{file.stem}.contacts.csv",
                                                                     2 if friction else 4)


def between(value, bounds, below, above):
    return bounds[0] - below <= value <= bounds[1] + above


def span(bounds, below, above):
    return f"{bounds[0]:g}" + (f" to {bounds[1]:g}" if bounds[1] > bounds[0] else "") + (
        f" +- {below:g}" if below == above else f" - {below:g} + {above:g}")


def main():
    print(f"{number} grains of one size, {specimens} specimens of each; 100 kPa of 7 GPa; mean +- standard deviation")
    for name, half, friction, fraction, Z in shapes:
        fractions, contacts = zip(*(packed(half, friction, seed) for seed in range(1, specimens + 1)))
        for what, values, asked, margin in (("solid fraction", fractions, fraction, (0.01, 0.01)),
                                            ("Z of the skeleton", contacts, Z, (0.2, 0.6))):
            if asked:
                verdict(f"{name}: {what}", f"{statistics.mean(values):.3f} +- {statistics.stdev(values):.3f}",
                        span(asked, *margin),
                        between(statistics.mean(values), asked, *margin))


if __name__ == "__main__":
    harness.main(main)
