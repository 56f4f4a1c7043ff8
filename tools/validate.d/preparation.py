"""tools/validate preparation: density and number of contacts of a specimen, set apart by agitation (preparation.expansion).

    preparation.py RVELAB WORK RESULTS

1. The pairs of void ratio and mechanical coordination number that recipes reach, over preparation friction and expansion.
2. States A (lubricated) and C (vibrated) of I. Agnolin and J.-N. Roux, Phys. Rev. E 76, 061302 (2007): 1000 equal spheres of glass,
   friction 0.3, at 10 kPa; moduli at 100 kPa.
3. What agitates: elastic collisions (as built), random moves without overlaps, shaking at a rate with low damping.
4. Strength of one density from both numbers of contacts, at the start and at large strain.
5. What the search costs."""

import csv
import json
import sys

import harness
from harness import PROTOCOLS, ROOT, answer, entry, in_words, kept, mean_error, once, records, run, sets, verdict, work

sys.path.insert(0, str(ROOT / "tools/python"))
FRICTIONS = (0, 0.05, 0.15, 0.4, 1e6)
EXPANSIONS = (None, 1e-3, 2e-3, 4e-3, 8e-3, 1.6e-2, 3e-2)
GLASS = """[pack]
name = "glass"
shape = "sphere"
number = 1000
[grains]
grading = "uniform"
smallest_radius_m = 0.5e-3
largest_radius_m = 0.5000001e-3
[target]
pressure_Pa = 10e3
[contact]
law = "hertz_mindlin"
[[material]]
name = "glass"
density_kg_m3 = 2500
young_modulus_Pa = 70e9
poisson_ratio = 0.3
friction = 0.3
"""


def without_density(name):
    """WORK/NAME.toml: a recipe less its target of the density."""
    source = next(path for path in (PROTOCOLS / f"{name}.toml", PROTOCOLS / "soils" / f"{name}.toml") if path.exists())
    dropped = ("void_ratio", "relative_density", "e_min", "e_max")
    path = work / f"{name}.toml"
    path.write_text("".join(line for line in source.read_text().splitlines(True) if not line.startswith(dropped)))
    return path


def pack(recipe, name, *settings):
    """Path, and void ratio, mechanical coordination number, part of the grains that bear nothing, seconds."""
    path = work / f"{name}.h5"
    done = answer("pack", recipe, "-o", path, "--force", *sets(*settings))
    done = done.get("specimens", [done])[0]
    bearing = done["coordination_number"] / done["mechanical_coordination_number"]  # about: one contact of a rattler aside
    return path, done["void_ratio"], done["mechanical_coordination_number"], 1 - bearing, done["wall_s"]


def reached():
    """1. Of three recipes."""
    found = {}
    for name in ("pack_dense", "pack_hertz", "toyoura"):
        recipe = without_density(name)
        pressure = [] if "pressure_Pa" in recipe.read_text() else ["target.pressure_Pa=100e3"]
        jobs = [(friction, expansion) for friction in FRICTIONS for expansion in EXPANSIONS]

        def one(job):
            friction, expansion = job
            agitation = [f"preparation.expansion={expansion}"] if expansion else []
            return job + pack(recipe, f"map_{name}_{friction}_{expansion}", f"preparation.friction={friction}",
                              "pack.number=500", *pressure, *agitation)[1:]
        found[name] = list(harness.in_turn(one, jobs))
    return found


def map_of(found):
    plt = harness.pyplot()
    figure, axes = plt.subplots(1, len(found), figsize=(4.2 * len(found), 3.8))
    for axis, (name, rows) in zip(axes, found.items()):
        for friction in FRICTIONS:
            line = [row for row in rows if row[0] == friction]
            axis.plot([row[2] for row in line], [row[3] for row in line], "o-", ms=4, lw=1,
                      label=f"friction while packed {friction:g}")
        axis.plot([row[2] for row in rows if row[1] is None], [row[3] for row in rows if row[1] is None], "k--", lw=1,
                  label="not agitated")
        axis.set(title=name, xlabel="void ratio", ylabel="mechanical coordination number")
    axes[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(harness.results / "preparation_map.png", dpi=110)
    plt.close(figure)


def glass():
    """2. Void ratio, coordination number, part that bears nothing; bulk and shear modulus, MPa, of each seed."""
    recipe = work / "glass.toml"
    recipe.write_text(GLASS)
    states = {"A": ["preparation.friction=0", "material.friction=0", "target.stress_tolerance=0.02", "target.unbalanced=1e-6"],
              "C": ["preparation.friction=0", "preparation.expansion=0.005", "target.unbalanced=1e-6"]}

    def one(job):
        state, seed, pressure = job
        path, *figures = pack(recipe, f"glass_{state}_{seed}_{pressure}", *states[state], f"pack.seed={seed}",
                              f"target.pressure_Pa={pressure}")
        stiffness = answer("probe", path, "--method", "linear")["stiffness_Pa"]
        normal = sum(stiffness[k][k] for k in range(3)) / 3
        across = sum(stiffness[i][j] for i in range(3) for j in range(3) if i != j) / 6
        shear = (sum(stiffness[k][k] for k in range(3, 6)) / 3 * 3 + (normal - across) / 2 * 2) / 5
        return [*figures, (normal + 2 * across) / 3 / 1e6, shear / 1e6]
    jobs = [(state, seed, pressure) for pressure in ("10e3", "100e3") for state in states for seed in (1, 2, 3)]
    return {" ".join(map(str, job)): figures for job, figures in zip(jobs, harness.in_turn(one, jobs))}


def random_moves(source, name, expansion, seed):
    """The specimen expanded, its grains moved one by one at random where that makes no overlap; random numbers of `seed`."""
    import numpy as np
    stem = work / name
    harness.rvelab("export", source, "--format", "csv", "-o", stem, "--force")
    lines = (work / f"{name}.particles.csv").read_text().splitlines()
    rows = list(csv.reader(lines[2:]))
    state = json.loads((work / f"{name}.json").read_text())
    cell = np.array(state["hSize"]) * (1 + expansion)
    state["hSize"], state["n_contacts"] = cell.tolist(), 0
    at = np.array([[float(value) for value in row[1:4]] for row in rows]) * (1 + expansion)
    radius = np.array([float(row[4]) for row in rows])
    random, inverse = np.random.default_rng(seed), np.linalg.inv(cell)

    def free(i, place):
        apart = (at - place) @ inverse.T
        apart = (apart - np.round(apart)) @ cell.T
        distance = np.linalg.norm(apart, axis=1)
        distance[i] = np.inf
        return (distance > radius + radius[i]).all()
    for _ in range(150):
        for i in range(len(rows)):
            place = at[i] + random.normal(size=3) * 0.5 * expansion * 2 * radius.mean()
            if free(i, place):
                at[i] = place
    text = "\n".join([*lines[:2], *(",".join([row[0], *map(repr, map(float, place)), *row[4:]])
                                    for row, place in zip(rows, at))])
    (work / f"{name}.particles.csv").write_text(text + "\n")
    (work / f"{name}.json").write_text(json.dumps(state))
    out = work / f"{name}_moved.h5"
    harness.rvelab("import", work / f"{name}.particles.csv", work / f"{name}.json", "--material", work / f"{name}.material.toml",
                   "-o", out, "--force")
    return out


def shaken(source, name, expansion):
    """The specimen expanded and sheared to and fro at a rate, twenty times by twice the expansion, with its friction and a
    local damping of 0.1."""
    import numpy as np
    import rvelab
    out = work / f"{name}_shaken.h5"
    with rvelab.Rve(source) as rve:
        rve.apply(np.eye(3) * expansion)
        for cycle in range(20):
            for sign in (1, -2, 1):
                step = np.zeros((3, 3))
                step[0, 2] = sign * 2 * expansion / 10
                for _ in range(10):
                    rve.apply(step, 2e-7 * abs(sign) * 1e2)
        rve.save(out)
    return out


def bearing_contacts(path):
    """2 Nc/N of the specimen in a record file, without grains of fewer than two contacts, removed repeatedly."""
    import h5py
    import numpy as np
    with h5py.File(path) as file:
        i, j = (file[f"specimen/contacts/{name}"][:] for name in "ij")
        bears = np.ones(len(file["specimen/grains/id"]), bool)
    while True:
        held = bears[i] & bears[j]
        count = np.bincount(np.concatenate([i[held], j[held]]), minlength=len(bears))
        loose = bears & (count < 2)
        if not loose.any():
            return 2 * held.sum() / bears.sum()
        bears &= ~loose


def compressed(path):
    """Void ratio and mechanical coordination number after isotropic compression to 100 kPa."""
    protocol = work / "iso.toml"
    protocol.write_text('[test]\nname = "iso"\ndimension = 3\npressure_Pa = 100e3\n[[stage]]\nkind = "isotropic"\n'
                        'shear = "zero_strain"\n')
    done = work / f"{path.stem}_compressed.h5"
    run(harness.program, "run", protocol, "--specimen", path, "-o", done, "--force")
    return [answer("inspect", done)["void_ratio"], bearing_contacts(done)]


def ways():
    """3. Void ratio and coordination number by each way, two seeds."""
    recipe = without_density("karlsruhe_compressed")
    common = ["target.pressure_Pa=100e3", "preparation.friction=0"]
    found = []
    for expansion in (4e-3, 8e-3, 1.6e-2):
        for seed in (1, 2):
            source = pack(recipe, f"lubricated_{seed}", *common, f"pack.seed={seed}")[0]
            collisions = pack(recipe, f"collisions_{expansion}_{seed}", *common, f"pack.seed={seed}",
                              f"preparation.expansion={expansion}")[1:3]
            name = f"ways_{expansion}_{seed}"
            found.append([expansion, seed, collisions, compressed(random_moves(source, name, expansion, seed)),
                          compressed(shaken(source, name, expansion))])
    return found


def strengths():
    """4. E50, MPa, largest q, its strain in %, and the mean q from 25 to 30 %, kPa, of three specimens."""
    recipe = PROTOCOLS / "soils/karlsruhe_compressed.toml"
    found = {}
    for name, target in (("lubricated", []), ("agitated", ["target.coordination_number=4.8"])):
        for seed in (1, 2, 3):
            path = pack(recipe, f"{name}_{seed}", "target.relative_density=0.85", f"pack.seed={seed}", *target)[0]
            test = once(work / f"sheared_{name}_{seed}.h5", "run", "triaxial", "--specimen", path,
                        *sets("stage.compression.to_strain=0.3"))
            rows = records(test, "stress_Pa", "strain", last=True)
            stress, strain = rows["stress_Pa"] / 1e3, rows["strain"] * 100
            q = (stress[:, 0, 0] + stress[:, 1, 1]) / 2 - stress[:, 2, 2]
            top = q.argmax()
            half = strain[(q >= q[top] / 2).argmax()]
            found.setdefault(name, []).append([q[top] / 2 / half / 10, q[top], strain[top], q[strain > 25].mean()])
    return found


def costs():
    """5. Processor seconds of packs of 500 spheres by density, and by density and number of contacts."""
    import resource
    recipe, found = PROTOCOLS / "soils/karlsruhe_compressed.toml", {"density": [], "both": []}
    for seed in range(1, 7):
        for name, target in (("density", []), ("both", ["target.coordination_number=4.8"])):
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            pack(recipe, f"cost_{name}_{seed}", f"pack.seed={seed}", *target)
            found[name].append(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)
    return found


def main():
    maps = kept("map", reached)
    map_of(maps)
    for name, rows in maps.items():
        entry(f"{name}: void ratio, mechanical coordination number (500 grains, one seed); seconds of all: {sum(row[-1] for row in rows):.0f}")
        entry("  friction   not agitated " + "".join(f"{'expansion ' + format(each, 'g'):>17}" for each in EXPANSIONS[1:]))
        for friction in FRICTIONS:
            entry(f"  {friction:<9g}" + "".join(f"{row[2]:>10.3f} {row[3]:>5.2f} " for row in rows if row[0] == friction))
        entry("")
    found = kept("glass", glass)
    asked = {"A": (0.639, 6.07, 1.4), "C": (0.635, 4.56, 13)}
    for state, (solid, contacts, free) in asked.items():
        rows = [figures for job, figures in found.items() if job.startswith(state) and job.endswith(" 10e3")]
        solids = [1 / (1 + row[0]) for row in rows]
        verdict(f"state {state}, solid fraction", in_words(solids, digits=4), f"{solid} +- 0.005",
                abs(mean_error(solids)[0] - solid) <= 0.005)
        verdict(f"state {state}, contacts of grains that bear", in_words([row[1] for row in rows], digits=2),
                f"{contacts} +- 0.1", abs(mean_error([row[1] for row in rows])[0] - contacts) <= 0.1)
        verdict(f"state {state}, grains that bear nothing, %", in_words([row[2] for row in rows], 100),
                f"{free} +- 2", abs(100 * mean_error([row[2] for row in rows])[0] - free) <= 2)
    for state in asked:
        rows = [figures for job, figures in found.items() if job.startswith(state) and job.endswith("100e3")]
        entry(f"state {state} at 100 kPa: bulk modulus {in_words([row[4] for row in rows], digits=0)} MPa, shear modulus "
              f"{in_words([row[5] for row in rows], digits=0)} MPa, contacts {in_words([row[1] for row in rows], digits=2)}")
    entry("")
    entry("void ratio, mechanical coordination number of two specimens of 500 spheres by what agitates them")
    entry("  expansion   elastic collisions            random moves                  shaken")
    rows = kept("ways", ways)
    for expansion in (4e-3, 8e-3, 1.6e-2):
        these = [row for row in rows if row[0] == expansion]
        entry(f"  {expansion:<9g} " + "   ".join(", ".join(f"{row[k][0]:.3f} {row[k][1]:.2f}" for row in these) + "     "
                                                 for k in (2, 3, 4)))
    entry("")
    found = kept("strengths", strengths)
    for name, rows in found.items():
        entry(f"{name}: E50 {in_words([row[0] for row in rows])} MPa, largest q {in_words([row[1] for row in rows], digits=0)} kPa at "
              f"{in_words([row[2] for row in rows])} %, q at 25 to 30 % {in_words([row[3] for row in rows], digits=0)} kPa")
    (a, da), (b, db) = (mean_error([row[3] for row in found[name]]) for name in found)
    verdict("strength at 25 to 30 %, agitated over lubricated", f"{b / a:.3f}", "1 within three errors",
            abs(a - b) <= 3 * (da**2 + db**2) ** 0.5)
    cost = kept("costs", costs)
    ratio = sum(cost["both"]) / sum(cost["density"])
    verdict("processor time of a pack of 500 spheres, both over density alone (six seeds)", f"{ratio:.2f}", "below 3",
            ratio < 3)


if __name__ == "__main__":
    harness.main(main)
