"""tools/validate interactions_peers: bonds and bridges beside YADE and LAMMPS, on one packing from one state.

300 spheres that do not touch, bonded without force; what corresponds to what stands in interactions_packing.py.

1. Where the laws are the same, at small strains: the force in each bond per unit of strain, the cell sheared and
   shortened at once, every grain free. Terms of higher order are taken out by strains of both signs and several sizes
   (rvelab and YADE 1e-4 and 2e-4; LAMMPS 1, 2 and 3 %, since its angles come from an arc cosine, whose rounding is
   large at small angles). Beside them the same by one stiffness matrix of beams. Asked: 1e-8 of the forces' root mean
   square.
2. Where they are not: extension until the packing parts. Breaking by tension at the rim (moment_factor 1, infinite
   cohesion) is LAMMPS' criterion, by forces alone (moment_factor 0) YADE's. Three packings; asked: first break and peak
   on each as near as packings scatter.
3. Bridges of water of two spheres beside YADE's laws of given volume (interactions_bridges.py). Asked: Willett's fit, which is
   the best of them, as near as it is to the Young-Laplace equation (results/capillary.txt). Their packings are not compared:
   YADE's ViscElCap pulls where a gap is and not where grains touch, and its Law2_ScGeom_CapillaryPhys, of given suction, reads
   tables that Debian's package has not.
4. JKR and DMT of a packing beside LAMMPS' pair_style granular (interactions_adhesion.py). Asked: 1e-8 of the mean force.

    interactions_peers.py RVELAB WORK RESULTS [LMP]

LMP is a LAMMPS with the packages BPM, GRANULAR and MOLECULE, which Debian's has not; without it the script builds one from
Debian's source, half an hour of one core.
"""
import pathlib
import warnings

import numpy as np

import debian_source
import harness
import interactions_packing as packings
from harness import program, verdict, work
from interactions_adhesion import adhesion
from interactions_bridges import bridges

GRADIENT = np.array([[0, 1.0, 0], [0, 0, 0], [0, 0, -0.5]])
TENSION, STRAIN, RECORDS, STEPS, SEEDS = 1.5e6, 3e-3, 300, 6000, (1, 2, 3)


def built():
    """LAMMPS with its bonded particles, serial, from Debian's source package."""
    made = work / "lammps/src/lmp_serial"
    if not made.exists():
        debian_source.download("lammps", "trixie", work, "--tar-only")
        (work / "lammps").mkdir(exist_ok=True)
        harness.run("tar", "xJf", next(work.glob("lammps_*.orig.tar.xz")), "-C", work / "lammps",
                    "--strip-components=1", "--wildcards",
                    "*/src/*")
        for words in (["yes-bpm", "yes-granular", "yes-molecule"], ["serial"]):
            debian_source.make(made.parent, *words)
    return made


def odd(at, strains, weights):
    """Slope at strain 0: of at(strain) the part that changes sign with it, `weights` taking out higher orders."""
    return sum(w * (at(e) - at(-e)) / (2 * e) for w, e in zip(weights, strains))


def rvelab_slope(packing):
    def at(strain):
        rve = packing.rve()
        rve.apply(strain * GRADIENT)
        rve.relax(1e-11, 4000)
        return packings.forces_of(rve)
    return odd(at, (1e-4, 2e-4), (4 / 3, -1 / 3))


def yade_slope(packing):
    strains = [1e-4, 2e-4, -1e-4, -2e-4]
    made = dict(zip(strains, packing.yade(what="forces", strains=strains, dH=GRADIENT.tolist())))
    return odd(lambda strain: np.array(made[strain]["forces"]), (1e-4, 2e-4), (4 / 3, -1 / 3))


def lammps_slope(packing, program):
    return odd(lambda strain: packings.lammps_forces(packing, program, GRADIENT, strain), (1e-2, 2e-2, 3e-2),
               (1.5, -0.6, 0.1))


def force_network(program, folder, lmp):
    print("Force of each bond per unit of strain: largest difference over the root mean square\n")
    for what, largest in (("equal radii", 1e-3), ("radii 1:2", 2e-3)):
        packing = packings.Cemented(program, folder, largest=largest)
        exact = packings.direct(packing, GRADIENT)
        found = {"rvelab": rvelab_slope(packing), "YADE": yade_slope(packing)}
        if largest == 1e-3:
            found["LAMMPS"] = lammps_slope(packing, lmp)
        scale = [np.sqrt((exact[:, part] ** 2).sum(axis=1).mean()) for part in (slice(0, 3), slice(3, 6))]

        def row(first, second, a, b):
            for part, name in ((slice(0, 3), "force"), (slice(3, 6), "moment")):
                if min(a.shape[1], b.shape[1]) < part.stop:
                    continue
                difference = np.abs(a[:, part] - b[:, part]).max() / scale[part.start // 3]
                verdict(f"{what}, {len(packing.i)} bonds, {name}: {first} - {second}", f"{difference:.1e}", "1e-8",
                        difference < 1e-8, width=64)

        for name, slope in found.items():
            row(name, "stiffness matrix", slope, exact)
        for name in list(found)[1:]:
            row("rvelab", name, found["rvelab"], found[name])


def rvelab_curve(packing, settings, time_step=0.0):
    """time_step: of a record, 0 for quasi-static increments."""
    rve, out = packing.rve(), []
    rve.set_parameters(settings)
    height = rve.lattice[2, 2]
    for _ in range(RECORDS):
        rve.apply(np.diag([0, 0, STRAIN / RECORDS]), time_step)
        out.append([rve.lattice[2, 2] / height - 1, rve.stress[2, 2], np.count_nonzero(rve.array("bonds/broken"))])
    return out


def features(curve):
    """Strain of the first break (that of its record), peak stress, its strain, broken bonds in the end."""
    curve = np.array(curve)
    first, peak = np.argmax(curve[:, 2] > 0), np.argmax(curve[:, 1])
    return np.array([curve[first, 0], curve[peak, 1], curve[peak, 0], curve[-1, 2]])


def breaking(program, folder, lmp):
    print(f"\nExtended to {STRAIN:g}, strength {TENSION:g} Pa: mean of {len(SEEDS)} packings +- their standard deviation\n")
    print(f"{'':34} {'first break':>20} {'peak, kPa':>18} {'strain of peak':>20} {'broken':>14}")
    gradient = np.diag([0.0, 0, 1]).tolist()
    for peer, strengths in (("LAMMPS", {"factor": 1}), ("YADE", {"cohesion": TENSION, "factor": 0})):
        rows = {}
        for seed in SEEDS:
            packing = packings.Cemented(program, folder, seed=seed, tension=TENSION, **strengths)

            def put(name, curve):
                rows.setdefault(name, []).append(features(curve))

            put("rvelab, at the same rate", rvelab_curve(packing, {
                "damping.local": 0.3, "solver.fixed_time_step_s": packing.time_step, "solver.collision_steps": 0},
                STEPS // RECORDS * packing.time_step))
            put("rvelab, 10 sub-steps a record", rvelab_curve(packing, {"solver.fixed_substeps": 10}))
            put("rvelab, its own sub-steps", rvelab_curve(packing, {}))
            if peer == "YADE":
                put(peer, packing.yade(what="curve", strain=STRAIN, records=RECORDS, steps=STEPS, dH=gradient))
            else:
                put(peer, packings.lammps_curve(packing, lmp, STRAIN, STEPS, RECORDS))
                put(f"{peer}, half the rate", packings.lammps_curve(packing, lmp, STRAIN, 2 * STEPS, RECORDS))
        rows = {name: np.array(row) for name, row in rows.items()}
        for name, row in rows.items():
            mean, spread = row.mean(axis=0), row.std(axis=0, ddof=1)
            print(f"{name:34} {mean[0]:10.3e} +- {spread[0]:.0e} {mean[1] / 1e3:8.1f} +- {spread[1] / 1e3:5.1f} "
                  f"{mean[2]:11.3e} +- {spread[2]:.0e} {mean[3]:6.0f} +- {spread[3]:3.0f}")
        other = rows[peer]
        for name, own in list(rows.items())[:3]:
            for k, what in ((0, "first break"), (1, "peak")):
                difference = np.abs(own[:, k] / other[:, k] - 1).max()
                scatter = other[:, k].std(ddof=1) / other[:, k].mean()
                same = np.abs(rows["rvelab, at the same rate"][:, k] / other[:, k] - 1).max() <= scatter
                verdict(f"{what}: {name} over {peer}, largest difference", f"{100 * difference:.2f} %",
                        f"scatter, {100 * scatter:.1f} %", difference <= scatter, same and difference < 0.05,
                        "quasi-static increments by the tolerances make one or two sub-steps here, and the break-up "
                        "lags behind the strain; the same law at the peer's rate gives the peer's peak")


def main():
    warnings.simplefilter("ignore", packings.rvelab.RvelabWarning)  # without stress at first
    lmp = pathlib.Path(harness.words[0]).resolve() if harness.words else built()
    lammps = packings.run([lmp, "-h"]).split(" - ", 1)[1].split("\n")[0].strip()
    yade = packings.run(["yade", "--version"]).split(":")[1].strip()
    print(f"# {harness.version()}, YADE {yade}, LAMMPS {lammps}\n")
    force_network(program, work, lmp)
    breaking(program, work, lmp)
    bridges(program, work)
    adhesion(program, work, lmp)


if __name__ == "__main__":
    harness.main(main)
