"""tools/validate mpm_grains: triaxial tests of mixtures with every grain as a rock, and with the fine ones as points.

    mpm_grains.py RVELAB FOLDER RESULTS

Three packings each of 0, 20 and 40 % of coarse grains (Li et al. 2023, 4.3: half their edge, fine grains of a fifth of
the size) are pressed between smooth plates (mixture_grains.toml) and sheared at 50 kPa three times in the same plates: all
grains as rocks; and the fine grains as material points of a softening soil, each of which touches the coarse ones as
the ball that it was, in cells of 3.75 mm, two points a side, and in cells of one point. The soil's constants are fitted
to the tests of all fine grains. Runs that are whole in FOLDER are used again."""

import numpy as np

import harness
from harness import sets, verdict
from mpm import between_plates, folder, peak_of, run, softening_curve

DRAWN, PRESSURE, NU, SOLID = 0.045, 50e3, 0.12, 2600
SEEDS = (1, 2, 3)
STRAINS = np.array([0.5, 1, 2, 3, 4, 6, 8, 10, 12, 15]) / 100
BEGINS = 0.02  # s
POINTS = {"points": "cells of 3.75 mm", "single": "cells of one point"}


def pressed(share, seed):
    """Edges (m), parts of volume of coarse grains and of pores in the soil between them, the cell (m) of one fine grain
    with its pores, and the folder of tables."""
    name = f"pressed_{share}_{seed}"
    case = ("--case", f"rocks_{share}", *sets(f"rocks.coarse.seed={seed}")) if share else ()
    h, _ = run(name, "mixture_grains.toml", "-j", "1", *case, *sets(f"rocks.fine.seed={seed}"))
    edges = [DRAWN + float(h[f"{plate}.displacement_{axis}_m"][-1]) for plate, axis in (("right", "x"), ("back", "y"), ("top", "z"))]
    radii = {group: np.loadtxt(folder / name / f"rocks_{group}.csv", delimiter=",", skiprows=1)[:, 3]
             for group in (("fine", "coarse") if share else ("fine",))}
    solids = {group: 4 / 3 * np.pi * (r**3).sum() for group, r in radii.items()}
    soil = np.prod(edges) - solids.get("coarse", 0)
    return (edges, 1 - soil / np.prod(edges), 1 - solids["fine"] / soil, np.cbrt(soil / len(radii["fine"])),
            (folder / name).resolve())


def shear(kind, share, seed, soil=None):
    """Axial and volumetric strain and deviatoric stress of one test. soil: keys of the material of the points."""
    edges, _, pores, cell, pressed_in = pressed(share, seed)
    table = {group: f'{{name="{group}", material="grain", table="{pressed_in}/rocks_{group}.csv"}}'
             for group in ("fine", "coarse")}
    groups = ["coarse"] if share else []
    keys = [f"body.{plate}.centre_m={[edge if k == axis else 0 for k in range(3)]}"
            for axis, (plate, edge) in enumerate(zip(("right", "back", "top"), edges))]
    keys += ["time.duration_s=0.145", "body.top.motion=[[0,0,0,0],[0.02,0,0,0],[0.022,0,0,-0.05]]",
             "output.frame_every_s=0.07"]
    if kind == "grains":
        groups.append("fine")
        keys += ["region=[]", "time.rock_steps_per_collision=10"]
    else:
        keys += [f'region=[{{material="soil", table="{pressed_in}/rocks_fine.csv", porosity={pores}}}]',
                 f"material.soil.density_kg_m3={SOLID * (1 - pores)}", *(f"material.soil.{key}={value}" for key, value in soil.items())]
        if kind == "single":
            keys.append(f"grid.cell_m={cell:.3g}")
        if share:
            keys.append('rock_soil={contact="ghost", friction=0.35}')
    if groups:
        keys += ['rock_material=[{name="grain", density_kg_m3=2600, young_modulus_Pa=0.8e9, poisson_ratio=0.12, friction=0.35, '
                 'restitution=0.5}]', f"rocks=[{', '.join(table[group] for group in groups)}]"]
    name = f"{kind}_{share}_{seed}"
    h, _ = run(name, "mixture_triaxial.toml", "-j", "1", *sets(*keys))
    return between_plates(h, edges, BEGINS)


def law(constants):
    """Axial strain, deviatoric stress (Pa), volumetric strain of an element of the soil."""
    young, peak, at, residual, decay, dilation = constants
    ep = np.linspace(0, 0.3, 3001)
    angle = np.where(ep < at, peak - (peak - residual) * (1 - ep / at)**3, residual + (peak - residual) * np.exp(-decay * (ep - at)))
    return (np.concatenate(([0], each)) for each in softening_curve(ep, angle, dilation, PRESSURE, young, NU))


def fitted(young, q, volumetric):
    """Constants of the soil by least squares (Gauss and Newton, damped) over STRAINS: q (Pa), volumetric strain."""
    def error(x):
        strain, stress, volume = law([young, *np.exp(x)])
        return np.concatenate(((np.interp(STRAINS, strain, stress) - q) / q.max(),
                               np.interp(STRAINS, strain, volume) - volumetric))

    x, damping = np.log([0.43, 0.01, 0.33, 6, 0.15]), 1e-3
    for _ in range(200):
        e = error(x)
        slopes = np.array([(error(x + 1e-4 * unit) - e) / 1e-4 for unit in np.eye(len(x))]).T
        step = np.linalg.solve(slopes.T @ slopes + damping * np.eye(len(x)), -slopes.T @ e)
        better = (error(x + step)**2).sum() < (e**2).sum()
        x, damping = (x + step, damping / 3) if better else (x, damping * 4)
    return [young, *np.exp(x)], np.sqrt((error(x)[:len(STRAINS)]**2).mean())


def keys_of(constants):
    young, peak, at, residual, decay, dilation = constants
    d = peak - residual
    return {"young_modulus_Pa": young, "dilatancy_angle_deg": np.degrees(dilation), "peak_plastic_strain": at, "decay": decay,
            "cubic_rad": [float(x) for x in (d / at**3, -3 * d / at**2, 3 * d / at, residual)],
            "peak_friction_angle_deg": np.degrees(peak), "residual_friction_angle_deg": np.degrees(residual)}


def row(title, values):
    print(f"{title:<36}" + " ".join(f"{x:6.1f}" for x in values), flush=True)


found, stiff = {}, {}
n = len(STRAINS)


def tests(kind, soil=None):
    for share in (0, 20, 40):
        for seed in SEEDS:
            edges, coarse, pores, _, _ = pressed(share, seed)
            axial, volumetric, q = shear(kind, share, seed, soil)
            peak = peak_of(axial, q)
            rows = (axial > 5e-4) & (axial < 3e-3)
            stiff.setdefault((kind, share), []).append(np.polyfit(axial[rows], q[rows], 1)[0])
            found.setdefault((kind, share), []).append([*peak, *np.interp(STRAINS, axial, q / 1e3), *np.interp(STRAINS, axial, 100 * volumetric)])
            print(f"{share:2d} %  {seed:<5} {' '.join(f'{1e3 * e:.2f}' for e in edges)}    {coarse:.3f}   {pores:<18.3f} {peak[0]:<10.1f} "
                  f"{100 * peak[1]:<13.2f} {peak[2]:.1f}", flush=True)


def mean(kind, share):
    return np.mean(found[kind, share], axis=0)


def scatter_of(kind, share, k):
    """Standard error of the mean over the mean."""
    return np.std([one[k] for one in found[kind, share]], ddof=1) / np.sqrt(len(SEEDS)) / mean(kind, share)[k]


def flat_top(share, within):
    """Strains between which q of the grains (mean curve, straight between STRAINS) is within that part of its largest."""
    q, fine = mean("grains", share)[3:3 + n], np.linspace(STRAINS[0], STRAINS[-1], 10_000)
    near = fine[np.interp(fine, STRAINS, q) >= (1 - within) * q.max()]
    return near[0], near[-1]


def main():
    print(f"All grains as rocks, 50 kPa, plates at 0.05 m/s, packings 1 to {len(SEEDS)}\n")
    print("part  seed  edges, mm            coarse  pores of the soil  peak, kPa  at strain, %  10 to 16 %, kPa")
    tests("grains")
    fine = mean("grains", 0)
    constants, error = fitted(np.mean(stiff["grains", 0]), 1e3 * fine[3:3 + n], fine[3 + n:] / 100)
    soil = keys_of(constants)
    print(f"\nSoil fitted to fine grains alone: E {constants[0] / 1e6:.2f} MPa, friction {np.degrees(constants[1]):.2f} degrees at a plastic "
          f"strain of {constants[2]:.4f}, residual {np.degrees(constants[3]):.2f}, decay {constants[4]:.2f}, dilation "
          f"{np.degrees(constants[5]):.2f} degrees; root mean square {100 * error:.1f} % of the peak\n")
    for kind, cells in POINTS.items():
        print(f"Fine grains as points, {cells}\n")
        tests(kind, soil)
        print()
    print(f"{'axial strain, %':<36}" + " ".join(f"{100 * s:6.1f}" for s in STRAINS))
    for share in (0, 20, 40):
        for kind, name in {"grains": "grains", **POINTS}.items():
            row(f"{share:2d} %, {name}: q, kPa", mean(kind, share)[3:3 + n])
            row("      volumetric, %", mean(kind, share)[3 + n:])
    print()
    # B-splines of second order: the error of a cell h falls as h^2, and that of half of it is a third of their
    # difference.
    MESH = ("nodes of cells of two points a side carry soil of both sides of a rock: the same packings in cells of one point, half "
            "as wide, lose more than half of the excess")
    REST = ("what is left of the mesh: the excess of cells twice as wide, extrapolated with the square of the cell over both tables, "
            "is within the bar")
    strain, stress, _ = law(constants)
    of_law = strain[np.argmax(stress)]
    FIT = (f"the fitted soil itself peaks at {100 * of_law:.2f} %: its constants are fitted to q and to the volume, "
           "not to where q is largest")
    for kind, cells in POINTS.items():
        print(f"Points in {cells} over grains, means of {len(SEEDS)}")
        for share in (0, 20, 40):
            for k, what in ((0, "peak"), (2, "mean from 10 to 16 %")):
                wide, narrow = (mean(each, share)[k] / mean("grains", share)[k] for each in POINTS)
                ratio = wide if kind == "points" else narrow
                spread = ratio * np.hypot(scatter_of(kind, share, k), scatter_of("grains", share, k))
                explained = (share > 0 and ratio > 1 and
                             (abs(narrow - 1) <= 0.5 * (wide - 1) if kind == "points"
                              else abs(narrow - (wide - narrow) / 3 - 1) < 0.1))
                verdict(f"{share} %, {what}", f"{ratio:.3f} +- {spread:.3f}", "1 +- 0.1", abs(ratio - 1) < 0.1,
                        explained,
                        MESH if kind == "points" else REST)
            # The top of a curve is flat: where it is largest is known to where it is as large within two standard
            # deviations, of the fit of the soil and of the mean of both.
            within = 2 * np.sqrt(error**2 + scatter_of(kind, share, 0)**2 + scatter_of("grains", share, 0)**2)
            low, high = flat_top(share, within)
            at = mean(kind, share)[1]
            verdict(f"{share} %, strain at the peak, %: where q of the grains is within {100 * within:.1f} % of its peak",
                    f"{100 * at:.2f}", f"{100 * low:.2f} to {100 * high:.2f}", low <= at <= high,
                    abs(at - of_law) < 1e-3 if share == 0 else kind == "points"
                    and low <= mean("single", share)[1] <= high,
                    FIT if share == 0 else MESH)
        print()


if __name__ == "__main__":
    harness.main(main)
