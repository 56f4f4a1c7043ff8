"""tools/validate shapes: friction angles against the shape of grains in space, beside what was published.

    shapes.py RVELAB WORK RESULTS [SPECIMENS]

Triaxial compression at 100 kPa to 15 %, dense specimens of 200 grains: highest angle, and mean of 12 to 15 %.
1. Against the aspect ratio of prolate ellipsoids: rises with elongation, then levels (Azema and Radjai 2010, Phys. Rev. E 81, 051304; Ng 2009,
   Int. J. Numer. Anal. Methods Geomech. 33, 511-527).
2. Against the exponents of superellipsoids of equal axes: rises with blockiness (Zhao, Evans and Zhou 2018, Int. J. Solids
   Struct. 150, 268-281).
3. Clumps of two spheres beside spheres with rolling friction: a rolling friction stands for the shape in strength, at less
   than the mean eccentricity of the clump over its radius (Wensrich and Katterfeld 2012, Powder Technol. 217, 409-417), and
   strength levels with it (Estrada, Taboada and Radjai 2008, Phys. Rev. E 78, 021301).
Packings and contacts a grain without friction: tools/validate solids."""

import math

import harness
from harness import PROTOCOLS, answer, kept, mean_error, specimens, verdict, work

count = int(harness.words[0]) if harness.words else 5


def settings(of):
    return [f"{key.replace('__', '.')}={value}" for key, value in of.items()]


def in_words(mean_error, digits):
    return "{:.{d}f} +- {:.{d}f}".format(*mean_error, d=digits)


def recipe_of(shape):
    """pack_ellipsoids with other grains."""
    text = (PROTOCOLS / "pack_ellipsoids.toml").read_text()
    file = work / f"{shape}.toml"
    if shape == "clump":
        text = text.replace('shape = "ellipsoid"', 'shape = "clump"\nmembers = "sphere"').replace("half_axes = [1.25, 1, 0.8]", 'clump = "pair"')
    else:
        text = text.replace('shape = "ellipsoid"', 'shape = "sphere"').replace("half_axes = [1.25, 1, 0.8]\n", "")
        text = text.replace('law = "hertz_mindlin"', 'law = "hertz_mindlin"\nrolling = true') + "rolling_stiffness = 1\n"
    file.write_text(text)
    return file


def angles(name, recipe="pack_ellipsoids", **of):
    """Highest friction angle and that of 12 to 15 %, degrees."""
    def make():
        files = specimens(recipe, f"sheared_{name}", count, "pack.number=200", *settings(of))
        tests = answer("run", "triaxial", "--specimen", *files, "-o", work / f"R_{name}", "--force", "--threads", 1,
                       *harness.sets("stage.compression.to_strain=0.15"))["tests"]
        return [(test["friction_angle_deg"], test["large_strain_friction_angle_deg"]) for test in tests]
    return [mean_error(column) for column in zip(*kept(name, make))]


def rises(series, first, last, column):
    """Rise of an angle between two of a series, and its standard error."""
    (a, da), (b, db) = series[first][column], series[last][column]
    return b - a, math.hypot(da, db)


def clumps():
    """Pairs beside spheres of one grading with rolling friction."""
    print(f"\n{'rolling friction':<28} {'highest angle, degrees':<22} at 12 to 15 %")
    frictions, spheres = (0, 0.05, 0.1, 0.2, 0.4, 0.8), []
    for friction in frictions:
        spheres.append(angles(f"rolling_{friction:g}", recipe_of("sphere"), material__quartz__rolling_friction=friction))
        print(f"{friction:<28g} {in_words(spheres[-1][0], 1):<22} {in_words(spheres[-1][1], 1)}", flush=True)
    pairs = angles("pairs", recipe_of("clump"))
    print(f"{'clumps of two spheres':<28} {in_words(pairs[0], 1):<22} {in_words(pairs[1], 1)}")
    # Normals pass through the centres of members of radius 1, 1/2 from that of the clump: the lever arm is that times the
    # sine of the angle to the axis, pi/4 in the mean. The union of both has the volume 9 pi/4.
    eccentricity = math.pi / 8 / (27 / 16) ** (1 / 3)
    for column, angle in enumerate(("highest angle", "angle at 12 to 15 %")):
        means, clump = [each[column][0] for each in spheres], pairs[column][0]
        error = math.hypot(pairs[column][1], spheres[0][column][1])
        verdict(f"clumps: {angle} above spheres without rolling", f"{clump - means[0]:.1f} +- {error:.1f}", "> 2 standard errors",
                clump - means[0] > 2 * error)
        above = next((k for k, mean in enumerate(means) if mean >= clump), None)
        stands = None if not above else frictions[above - 1] + (frictions[above] - frictions[above - 1]) * (
            clump - means[above - 1]) / (means[above] - means[above - 1])
        verdict(f"clumps: rolling friction of the same {angle}", "none up to 0.8" if stands is None else f"{stands:.2f}",
                f"< e/R = {eccentricity:.2f}", stands is not None and stands < eccentricity)
    rise = [spheres[b][0][0] - spheres[a][0][0] for a, b in ((0, 3), (4, 5))]
    verdict("rolling friction: levels, 0.4 to 0.8 beside 0 to 0.2", f"{rise[1]:.1f}", f"< half of {rise[0]:.1f}", rise[1] < 0.5 * rise[0])


def main():
    print(f"{count} specimens each; mean +- standard error")
    for title, values, setting, claim in (
            ("aspect ratio", (1, 1.25, 1.5, 2, 3), lambda v: {"grains__half_axes": [v, 1, 1]}, (1, 1.5)),
            ("exponents", (2, 3, 4), lambda v: {"pack__shape": "superellipsoid", "grains__half_axes": [1, 1, 1],
                                                 "grains__exponents": [v, v]}, (2, 4))):
        print(f"\n{title:<28} {'highest angle, degrees':<22} at 12 to 15 %")
        series = {}
        for value in values:
            series[value] = angles(f"{title.split()[0]}_{value:g}", **setting(value))
            print(f"{value:<28g} {in_words(series[value][0], 1):<22} {in_words(series[value][1], 1)}", flush=True)
        for column, angle in enumerate(("highest angle", "angle at 12 to 15 %")):
            rise = rises(series, *claim, column)
            verdict(f"{title}: {angle} rises from {claim[0]:g} to {claim[1]:g}", in_words(rise, 1), "> 2 standard errors",
                    rise[0] > 2 * rise[1])
        if title == "aspect ratio":
            early, late = rises(series, 1, 1.5, 1), rises(series, 2, 3, 1)
            verdict("aspect ratio: levels, 2 to 3 beside 1 to 1.5", f"{late[0]:.1f} +- {late[1]:.1f}", f"< half of {early[0]:.1f}",
                    late[0] < 0.5 * early[0])
    clumps()


if __name__ == "__main__":
    harness.main(main)
