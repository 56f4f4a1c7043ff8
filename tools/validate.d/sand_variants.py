"""tools/validate sand_variants: rough contacts, cones and clumps, agitated as the recipe karlsruhe, beside its four drained tests.

    sand_variants.py RVELAB WORK RESULTS

Each is fitted on the tests and features that karlsruhe was fitted on (TMD2, TMD22, OE12; protocols/fits/karlsruhe_agitated.toml), one
specimen of 300 grains for each set of parameters and test, with the expansion of the recipe and the limits of density told below. Then
three specimens of 300 grains of each test by the means of the fit; limits as tools/validate sand, which has five specimens of 1,000.
Spheres are the recipe as it is, by the same three specimens."""

import json

import harness
import sand
from harness import PROTOCOLS, bars, once, sets, work

SOILS = PROTOCOLS / "soils"
AGITATED = ["preparation.expansion=0.0057", "preparation.least_expansion=0"]
COUNT, SETS = 3, 40
FRICTION = ["material.friction=0.2:0.6", "material.rolling_friction=0.1:1:log"]
VARIANTS = {  # recipe, settings, what is varied in the fit
    "spheres": ("karlsruhe", [], []),
    "rough": ("karlsruhe", ["contact.law=hertz_rough"],
              [*FRICTION, "material.young_modulus_Pa=4e9:70e9:log", "material.roughness_m=2e-8:1e-6:log"]),
    "cones": ("karlsruhe", ["contact.law=cones", "material.cone_slope=0.02"], [*FRICTION, "material.young_modulus_Pa=2e9:70e9:log"]),
    "clumps": ("karlsruhe_shapes", AGITATED, ["material.friction=0.2:0.6", "material.young_modulus_Pa=1e9:20e9:log"]),
}


def fit_file():
    """The tests that the recipe was fitted on, without those that it predicts; nothing varied but what the command line says."""
    text = (PROTOCOLS / "fits/karlsruhe_agitated.toml").read_text().replace('"karlsruhe/', f'"{PROTOCOLS}/fits/karlsruhe/')
    head, *tests = text.split("[[measured]]")
    head = head[:head.index("vary = [")]
    path = work / "fitted.toml"
    harness.write(path, "[[measured]]".join([head, *(each for each in tests if "predict = true" not in each)]))
    return path


def fitted(name, recipe, settings, vary):
    """KEY=VALUE of each parameter; prints them with their intervals."""
    if not vary:
        return []
    fixed = ["pack.number=300", "target.void_ratio_tolerance=0.01", *AGITATED, *settings]
    folder = once(work / f"fit_{name}", "fit", fit_file(), "--recipe", SOILS / f"{recipe}.toml", "--tests", SETS, "--count", COUNT,
                  *[word for each in vary for word in ("--vary", each)], *sets(*fixed), resume=True)
    fit = json.loads((folder / "fit.json").read_text())
    print(f"{name}, fitted by {len(fit['tests'])} sets: " + "; ".join(
        f"{each['key'].split('.')[-1]} {each['mean']:.3g} ({each['low_95']:.3g} to {each['high_95']:.3g})" for each in fit["parameters"])
        + f"; misfit {fit['misfit']:.2f}")
    return [f"{each['key']}={each['mean']:.6g}" for each in fit["parameters"]]


@bars
def beside_the_sand(name, tests):
    """Model less sand of each feature, in per cent (eps_v in points), in brackets where it is beyond its limit."""
    met = of_all = 0
    for test, role, found in tests:
        cells, own = [], 0
        for what, value, model, _ in found:
            inside, _ = sand.within(what, found)
            own += inside
            off = f"{model - value:+.1f}" if what.startswith("eps_v") else f"{100 * (model / value - 1):+.0f}"
            cells.append(off if inside else f"({off})")
        met, of_all = met + own, of_all + len(found)
        print(f"{name:<8} {test:<6} {role:<10} {own:>3} of {len(found)} " + "".join(f"{cell:>9}" for cell in cells))
    print(f"{name:<8} all                {met:>3} of {of_all}")


def main():
    print(f"{COUNT} specimens of 300 grains; model less sand in per cent, eps_v in points; in brackets: beyond the limit")
    print(f"{'':<26} {'limits met':>9} " + "".join(f"{each:>9}" for each in (
        "largest q", " at 95 %", "E50", "q 0.5 %", "q 1 %", "q 2 %", "q 5 %", "e_v 5 %", "e_v 15 %")))
    measured = [test for test in sand.of_sand()["measured"] if test["protocol"] == "triaxial"]
    for name, (recipe, settings, vary) in VARIANTS.items():
        values = fitted(name, recipe, settings, vary)
        folder = work / name
        folder.mkdir(exist_ok=True)
        tests = []
        for test in measured:
            _, _, found = sand.compared(test, count=COUNT, soil=SOILS / f"{recipe}.toml", folder=folder,
                                        more=["pack.number=300", *settings, *values])
            tests.append((test["name"], "predicted" if test.get("predict") else "fitted", found))
        beside_the_sand(name, tests)


if __name__ == "__main__":
    harness.main(main)
