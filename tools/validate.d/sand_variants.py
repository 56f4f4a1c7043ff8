"""tools/validate sand_variants: rough contacts, and clumps, agitated as the recipe karlsruhe, beside its four drained tests.

    sand_variants.py RVELAB WORK RESULTS

Three specimens of 300 grains of each test, limits as tools/validate sand, which has five specimens of 1,000. Nothing is fitted: only law or
shape differs from the recipe. Rough contacts, 0.3 um, have the E with which they are as stiff under 100 kPa as those of the recipe
(f_n some p d^2 = 2 mN: 1.4e4 N/m); there the asperities carry, so that their stiffness goes with p^0.6. Clumps of four spheres have friction
in place of rolling resistance, by karlsruhe_shapes; their densities are relative to its limits. Spheres: the recipe as it is. Rough
contacts on the two dense tests alone: a loose specimen of them takes more than a minute of a core."""

import harness
import sand
from harness import PROTOCOLS, bars, work

COUNT, GRAINS = 3, 300
VARIANTS = {  # recipe, settings, number of tests, the dense ones first: loose ones take more draws
    "spheres": ("karlsruhe", [], 4),
    "clumps": ("karlsruhe_shapes", ["material.young_modulus_Pa=5.1e9", "preparation.expansion=0.0057", "preparation.least_expansion=0"], 4),
    "rough": ("karlsruhe", ["contact.law=hertz_rough", "material.roughness_m=3e-7", "material.young_modulus_Pa=15e9"], 2),
}
FEATURES = ["largest q", "at 95 %", "E50", "q 0.5 %", "q 1 %", "q 2 %", "q 5 %", "e_v 5 %", "e_v 15 %"]


@bars
def beside_the_sand(name, test, found):
    """Model less sand of each feature, in per cent (eps_v in points), in brackets where it is beyond its limit."""
    cells, met = [], 0
    for what, value, model, _ in found:
        inside, _ = sand.within(what, found)
        met += inside
        off = f"{model - value:+.1f}" if what.startswith("eps_v") else f"{100 * (model / value - 1):+.0f}"
        cells.append(off if inside else f"({off})")
    print(f"{name:<8} {test:<6} {met:>2} of {len(found)} " + "".join(f"{cell:>10}" for cell in cells))


def main():
    print(f"{COUNT} specimens of {GRAINS} grains; model less sand in per cent, eps_v in points; in brackets: beyond the limit")
    print(f"{'':<15} {'met':<7} " + "".join(f"{each:>10}" for each in FEATURES))
    measured = sorted((test for test in sand.of_sand()["measured"] if test["protocol"] == "triaxial"), key=sand.density_of,
                      reverse=True)
    for name, (recipe, settings, count) in VARIANTS.items():
        folder = work / name
        folder.mkdir(exist_ok=True)
        for test in measured[:count]:
            _, _, found = sand.compared(test, count=COUNT, soil=PROTOCOLS / f"soils/{recipe}.toml", folder=folder,
                                        more=[f"pack.number={GRAINS}", *settings])
            beside_the_sand(name, test["name"], found)


if __name__ == "__main__":
    harness.main(main)
