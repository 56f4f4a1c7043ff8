"""tools/validate mpm_fluid_scenes, mpm_shaking: saturated grains beside exact answers, cells and published figures.

    mpm_fluid_scenes.py RVELAB FOLDER RESULTS                 # all parts but shaking
    mpm_fluid_scenes.py RVELAB FOLDER RESULTS PART...         # of the list at the end

Published: Liang, Zhao, Wu, Zhao and Wang (2023, Comput. Methods Appl. Mech. Eng. 405, 115871). Each line: what, found,
asked for, verdict. consolidation: the specimen's own modulus and the exact answer of the two-phase equations.
undrained, drained, cyclic: blocks beside the test of their specimen. mandel: the analytic answer. column, wave, scan:
trends that the paper describes, at reduced size; shaking: the same, hours. Runs that are whole in FOLDER are used
again, and those that were stopped go on."""

import os
import subprocess
import sys

import h5py
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../plot"))
from records import STYLE, plt  # noqa: E402
from mpm import cases, folder, picture, results, rvelab, specimen  # noqa: E402
import mpm as scenes  # noqa: E402

# Of the environment: threads of each run, more options of rvelab-mpm for single parts, seeds of the shaken soils.
THREADS = ["-j", os.environ["RVELAB_MPM_THREADS"]] if "RVELAB_MPM_THREADS" in os.environ else []
SOLIDS, WATER, GRAVITY = 2650.0, 1000.0, 9.81  # kg/m3, m/s2
missed = []


def run(name, scene, *options):
    return scenes.run(name, scene, *options, *THREADS)


def verdict(what, found, asked, met):
    if not met:
        missed.append(what)
    print(f"{what:<80} {found:<24} {asked:<26} {'met' if met else 'MISSED'}", flush=True)


def told(options):
    """What a part was run with beside its scene."""
    return f"\n(with {' '.join(options)})" if options else ""


def columns(path):
    names = path.open().readline().strip().split(",")
    return dict(zip(names, np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2).T))


def watched(name):
    return columns(folder / name / "watched.csv")


def frames(name):
    return sorted((folder / name).glob("points_*.h5"))


def frame_at(name, time):
    """The frame next to that time; fields by name."""
    def time_of(path):
        with h5py.File(path) as file:
            return float(file["time_s"][0])
    found = min(frames(name), key=lambda path: abs(time_of(path) - time))
    with h5py.File(found) as file:
        return {key: file[key][()] for key in file if isinstance(file[key], h5py.Dataset)}


def costs(name):
    """The last lines that runs printed: steps, seconds, grain-steps."""
    print("    " + "\n    ".join((folder / f"{name}.txt").read_text().strip().splitlines()[-3:]))


def cell_test(name, protocol, packed, *settings):
    """Strains (1 - F_yy) and stresses (Pa, compression positive, xx and yy) of the last stage of a test."""
    path = folder / f"{name}.h5"
    if not path.exists():
        subprocess.run([rvelab, "run", protocol, "--specimen", folder / f"{packed}.h5", "-o", path,
                        *(word for each in settings for word in ("--set", each))],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with h5py.File(path) as file:
        stage = file["records/stage"][()]
        last = stage == stage.max()
        stress = -file["records/stress_Pa"][()][last]
        return file["records/strain"][()][last], stress[:, 0, 0], stress[:, 1, 1], {
            key: stage == key for key in np.unique(stage)}, -file["records/stress_Pa"][()], file["records/strain"][()]


# --- consolidation ----------------------------------------------------------------------------------------------------


class Column:
    """Sudden load p0 on the drained top of a column on a closed base, exact for incompressible grains and water.

    Nothing leaves at the base, so that (1 - n) v_s + n v_f = 0. The water's equation gives
    dp/dy = rho_f (1 - n)/n u'' + (rho_f g/k) u', and the mixture's r u'' + d u' = M d2u/dy2 with
    r = (1 - n) rho_s + rho_f (1 - n)^2/n and d = rho_f g/k; u = 0 at the base, M du/dy = -p0 at the top. u is the final
    settlement plus modes sin(w y), w = (2 m + 1) pi/2H, each a damped oscillator that starts at rest."""

    def __init__(self, modulus, porosity, conductivity, load, height=1.0, modes=4000):
        self.modulus, self.load, self.height, self.porosity = modulus, load, height, porosity
        inertia = (1 - porosity) * SOLIDS + WATER * (1 - porosity)**2 / porosity
        m = np.arange(modes)
        self.wave = (2 * m + 1) * np.pi / (2 * height)
        self.first = 2 * load / (modulus * height * self.wave**2) * (-1.0)**m
        self.damping, self.square = WATER * GRAVITY / conductivity / (2 * inertia), modulus / inertia * self.wave**2
        self.rate = np.sqrt((self.damping**2 - self.square).astype(complex))
        # Lanczos factors: the series of the pressure alone rings at the drained end.
        self.smooth = np.sinc(m / modes)
        self.diffusivity = conductivity * modulus / (WATER * GRAVITY)

    def modes(self, time):
        """Amplitudes and their accelerations over the first amplitude."""
        a, s = self.damping, self.rate
        slow, fast = np.exp(-(a - s) * time), np.exp(-(a + s) * time)
        value = ((a + s) * slow - (a - s) * fast) / (2 * s)
        acceleration = ((a + s) * (a - s)**2 * slow - (a - s) * (a + s)**2 * fast) / (2 * s)
        return value.real, acceleration.real

    def settlement(self, y, time):
        value, _ = self.modes(time)
        return self.load * y / self.modulus - np.sum(self.first * value * np.sin(self.wave * y))

    def pressure(self, y, time):
        """From the mixture's equation, integrated from the top down."""
        value, acceleration = self.modes(time)
        shape = self.smooth * self.first * np.cos(self.wave * y)
        strain = -self.load / self.modulus + np.sum(shape * self.wave * value)
        inertia = np.sum(shape * acceleration / self.wave)
        return self.modulus * strain + self.load + (1 - self.porosity) * (SOLIDS - WATER) * inertia


T_PRINTED = (0.010, 0.041, 0.10, 0.21, 0.31, 0.52, 0.72, 1.02)


def oedometer(packed):
    """MPa: C11 and C12 of small strains, and the secant of C11 over the first 10 kPa; the void ratio."""
    strain, side, axial, stages, stress, strains = cell_test(
        f"oedometer_{packed}", "oedometer", packed, "stage.large.to_strain=0.0008", "stage.large.record_every=2e-5")
    small = stages[sorted(stages)[-2]]
    fit = lambda i: np.polyfit(strains[small], stress[small][:, i, i], 1)[0] / 1e6
    secant = 10e3 / np.interp(axial[0] + 10e3, axial, strain) / 1e6
    with h5py.File(folder / f"{packed}.h5") as file:
        return fit(1), fit(0), secant


def consolidation():
    print("Specimens of the consolidation test (pack_consolidation, 100 kPa), five seeds: void ratio; C11 and C12 at\n"
          "strains of 1e-5, and C11 as secant over 10 kPa more (MPa)\n\nseed    e       C11     C12     secant")
    rows = []
    for seed in range(1, 6):
        name = "consolidation" if seed == 1 else f"consolidation_{seed}"
        specimen(name, "--set", f"pack.seed={seed}", recipe="pack_consolidation")
        found = oedometer(name)
        rows.append((void_ratio(name), *found))
        print(f"{seed:<8}" + "{:<8.4f}{:<8.2f}{:<8.2f}{:.2f}".format(*rows[-1]))
    mean, scatter = np.mean(rows, axis=0), np.std(rows, axis=0, ddof=1)
    print("mean    " + "{:<8.4f}{:<8.2f}{:<8.2f}{:.2f}".format(*mean))
    print("+-      " + "{:<8.4f}{:<8.2f}{:<8.2f}{:.2f}".format(*scatter) + "\n")
    verdict("void ratio of the five specimens", f"{mean[0]:.4f} +- {scatter[0]:.4f}", "0.192 within 0.002",
            abs(mean[0] - 0.192) < 0.002)
    verdict("M = C11 at small strains, MPa", f"{mean[1]:.2f} +- {scatter[1]:.2f}", "25.06 within 15 %",
            abs(mean[1] / 25.06 - 1) < 0.15)
    verdict("K - 2 G/3 = C12 at small strains, MPa", f"{mean[2]:.2f} +- {scatter[2]:.2f}", "3.93 within 15 %",
            abs(mean[2] / 3.93 - 1) < 0.15)

    run("consolidation_grains", "consolidation.toml", "--case", "grains", "--set",
        "output.watched_points_m=[[0.005, 0.005], [0.005, 0.505], [0.005, 0.995]]")
    w = watched("consolidation_grains")
    e, _, _, secant = rows[0]
    exact = Column(secant * 1e6, e / (1 + e), 1e-3, 10e3)
    places = [w[f"{k}.y_m"][0] for k in range(3)]
    print("\n50 cells with four points of the specimen of seed 1, k 1e-3 m/s: degree of consolidation (settlement of the\n"
          f"top point over the final one) and pressure over 10 kPa at {places[0]:g} and {places[1]:g} m; exact: of\n"
          f"M = {secant:.2f} MPa\n\n"
          "T       t (s)     U       exact   p(0)    exact   p(1/2)  exact")
    worst = np.zeros(3)
    for T in T_PRINTED:
        t = T / exact.diffusivity
        final = exact.load * places[2] / exact.modulus
        settled = w["2.y_m"][0] - np.interp(t, w["time_s"], w["2.y_m"])
        pairs = [(settled / final, exact.settlement(places[2], t) / final)]
        for k in (0, 1):
            pairs.append((np.interp(t, w["time_s"], w[f"{k}.pore_pressure_Pa"]) / 10e3,
                          exact.pressure(places[k], t) / 10e3))
        if t <= w["time_s"][-1]:
            worst = np.maximum(worst, [abs(a - b) for a, b in pairs])
            print(f"{T:<8g}{t:<10.5f}" + "".join(f"{a:<8.4f}{b:<8.4f}" for a, b in pairs))
    print()
    verdict("consolidation: U beside the exact answer, largest difference", f"{worst[0]:.4f}", "0.02", worst[0] <= 0.02)
    verdict("consolidation: p/p0 at the base, largest difference", f"{worst[1]:.4f}", "0.02", worst[1] <= 0.02)
    verdict("consolidation: p/p0 in the middle, largest difference", f"{worst[2]:.4f}", "0.02", worst[2] <= 0.02)
    costs("consolidation_grains")


def void_ratio(packed):
    with h5py.File(folder / f"{packed}.h5") as file:
        for place in ("records/void_ratio", "void_ratio"):
            if place in file:
                return float(np.ravel(file[place][()])[-1])
    told = subprocess.run([rvelab, "inspect", folder / f"{packed}.h5"], check=True, capture_output=True,
                          text=True).stdout
    return float(next(line for line in told.splitlines() if line.startswith("void_ratio")).split()[1])


# --- blocks beside the test of their specimen -------------------------------------------------------------------------


def mean_of(w, column, points=4):
    return np.mean([w[f"{k}.{column}"] for k in range(points)], axis=0)


ELASTIC = """[[material]]
name = "soil"
kind = "elastic"
density_kg_m3 = {density:g}
young_modulus_Pa = {young:g}
poisson_ratio = {poisson:g}

"""


def elastic_scene(name, scene, edits, **moduli):
    """FOLDER/name.toml: a scene without its cases, an elastic soil in place of its grains, and further edits."""
    text = (scenes.ROOT / "protocols/mpm" / scene).read_text().split("\n[case.")[0]
    begin, end = text.index("[[material]]"), text.index("[[region]]")
    text = text[:begin] + ELASTIC.format(**moduli) + text[end:]
    for old, new in edits:
        text = text.replace(old, new)
    path = folder / f"{name}.toml"
    path.write_text(text)
    return path.resolve()


def elastic_volume(cfl):
    """Relative change of the volume of the undrained block of elastic soil."""
    name = f"undrained_elastic_{cfl:g}"
    scene = elastic_scene(name, "undrained_element.toml", [
        ("conductivity_m_s = 1e-9", "conductivity_m_s = 1e-9\nporosity = 0.161")], density=0.839 * SOLIDS, young=24e6,
                          poisson=0.1356)
    run(name, scene, "--set", f"time.cfl={cfl:g}")
    volumes = [np.sum(frame_at(name, time)["volume_m3"]) for time in (0, 1e9)]
    return volumes[1] / volumes[0] - 1


def undrained():
    specimen()
    h, _ = run("undrained", "undrained_element.toml")
    w = watched("undrained")
    strain, side, axial, *_ = cell_test("undrained_cell", "biaxial_undrained", "dense",
                                        "stage.compression.to_strain=0.045",
                                        "solver.target_unbalanced=0")
    p, q, at = (axial + side) / 2, (axial - side) / 2, -h["top.displacement_y_m"]
    found_p, found_q, water = mean_of(w, "p_Pa"), mean_of(w, "q_Pa"), mean_of(w, "pore_pressure_Pa")
    print("\nUndrained block, 2 x 2 cells with four points of the dense specimen: p', q and pore pressure (kPa), mean of\n"
          "the watched points, beside the constant-volume test of the specimen\n\n"
          "strain  p'      cell    q       cell    pore    100 - (p' - q)")
    for a in (0.001, 0.0025, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04):
        values = [np.interp(a, at, found_p), np.interp(a, strain, p), np.interp(a, at, found_q),
                  np.interp(a, strain, q),
                  np.interp(a, at, water), 100e3 - np.interp(a, at, found_p - found_q)]
        print(f"{a:<8g}" + "".join(f"{value / 1e3:<8.2f}" for value in values))
    print()
    for low, high, bar in ((0.0005, 0.015, 0.02), (0.015, 0.0395, 0.05)):
        grid = np.linspace(low, high, 200)
        off = max(np.max(abs(np.interp(grid, at, mine) - np.interp(grid, strain, cell)))
                  for mine, cell in ((found_p, p), (found_q, q))) / 100e3
        verdict(f"undrained: p', q beside the cell, strains {low:g} to {high:g}, over p0", f"{off:.4f}", f"{bar:g}",
                off <= bar)
    all_frames = [frame_at("undrained", t) for t in np.linspace(0, h["time_s"][-1], 9)]
    total = np.array([np.sum(frame["volume_m3"]) for frame in all_frames])
    lateral = np.array([np.sum(frame["volume_m3"] * (frame["pore_pressure_Pa"] - frame["stress_Pa"][:, 0]))
                        for frame in all_frames])
    off = np.max(abs(lateral[1:] / total[1:] / 100e3 - 1))
    verdict("undrained: mean of pore pressure - sigma'_xx over 100 kPa, less 1", f"{off:.5f}", "0.005", off <= 0.005)
    single = np.max(abs(water - (100e3 - (found_p - found_q)))[at > 0.0005]) / 100e3
    print(f"    by the mean of the four watched points alone the largest difference is {single:.4f}: points of a cell differ")
    off = np.max(abs(total / total[0] - 1))
    verdict("undrained: volume of the block, largest change", f"{off:.2e}", "1e-6", off <= 1e-6)
    print("    what the time step leaves of it: elastic soil at time.cfl = 0.4, 0.2, 0.1 changes its volume by "
          + ", ".join(f"{elastic_volume(cfl):.1e}" for cfl in (0.4, 0.2, 0.1)))
    off = max(np.max(abs(frame["eps_v"])) for frame in all_frames)
    verdict("undrained: volumetric strain of any point", f"{off:.2e}", "1e-3", off <= 1e-3)
    costs("undrained")


def drained():
    specimen()
    run("element", "element.toml")
    run("element_drained", "element.toml", "--set", "fluid.conductivity_m_s=1")
    run("element_step", "element.toml", "--set", "time.cfl=0.39")
    print()
    for until in (0.015, 0.049):
        grid = np.linspace(0.001, until, 200)
        stress = []
        for name in ("element", "element_drained", "element_step"):
            at, w = -columns(folder / name / "history.csv")["top.displacement_y_m"], watched(name)
            stress.append(np.interp(grid, at, mean_of(w, "p_Pa", 2) + mean_of(w, "q_Pa", 2)))
        off, chance = (np.max(abs(other / stress[0] - 1)) for other in stress[1:])
        verdict(f"drained limit, k = 1 m/s: axial stress beside element.toml to {until:g}", f"{off:.4f}", "0.005",
                off <= 0.005)
        print(f"    element.toml with a time step 2.5 % smaller differs by {chance:.4f}: paths of grains part by chance")


def cyclic():
    print("\nUndrained block, platen +-0.2 %, beside the constant-volume test of the specimen: p' (kPa) at the ends of\n"
          "the half cycles, block and cell")
    specimen()
    specimen("loose", recipe="pack_loose")
    for soil, duration in (("dense", 4.1), ("loose", 1.33)):
        strain, side, axial, *_ = cell_test(f"cyclic_cell_{soil}", "biaxial_undrained", soil,
                                            "stage.compression.to_strain=0.002",
                                            "stage.compression.cycles=10", "stage.compression.record_every=1e-4",
                                            "solver.target_unbalanced=0")
        h, _ = run(f"cyclic_{soil}", "undrained_element.toml", "--case", "cyclic", "--set",
                   f'material.soil.specimens=["{soil}.h5"]', "--set", f"time.duration_s={duration}")
        way = lambda strain: np.concatenate([[0], np.cumsum(abs(np.diff(strain)))])
        cell_way, cell = way(strain), (axial + side) / 2
        block_way, block = way(h["top.displacement_y_m"]), mean_of(watched(f"cyclic_{soil}"), "p_Pa")
        end = min(cell_way[-1], block_way[-1])
        turns = np.arange(0.002, end, 0.004)
        for name, along, values in (("block", block_way, block), ("cell", cell_way, cell)):
            print(f"{soil:<8}{name:<8}" + " ".join(f"{np.interp(at, along, values) / 1e3:.1f}" for at in turns))
        grid = np.linspace(0, end, 400)
        off = np.max(abs(np.interp(grid, block_way, block) - np.interp(grid, cell_way, cell))) / 100e3
        verdict(f"cyclic, {soil}: p' beside the cell, over p0, {end / 0.008:.1f} cycles", f"{off:.4f}", "0.05",
                off <= 0.05)
        if soil == "loose":
            fallen = [np.flatnonzero(values < 5e3) for values in (block, cell)]
            cycles = [along[k[0]] / 0.008 if len(k) else np.inf for along, k in zip((block_way, cell_way), fallen)]
            verdict("cyclic, loose: cycles until p' < 5 % of p0, block and cell", "{:.2f}, {:.2f}".format(*cycles),
                    "within one cycle", abs(np.ceil(cycles[0]) - np.ceil(cycles[1])) <= 1)
            w = watched(f"cyclic_{soil}")
            each = [np.flatnonzero(w[f"{k}.p_Pa"] < 5e3) for k in range(4)]
            print("    soil that softens does not stay uniform: cycles until p' < 5 % of p0 at single points "
                  + ", ".join(f"{block_way[k[0]] / 0.008:.2f}" if len(k) else "never" for k in each))
        costs(f"cyclic_{soil}")


def mandel():
    run("mandel", "mandel.toml")
    w = watched("mandel")
    diffusivity = 0.2555895  # m2/s, of the scene
    at, p = diffusivity * w["time_s"], w["0.pore_pressure_Pa"] / 5e3
    print()
    peak = int(np.argmax(p * (at > 0.02)))
    for what, found, exact in (("Mandel: peak of p(0)/p0", p[peak], 1.124),
                               ("Mandel: p(0)/p0 at c t/a2 = 0.5", np.interp(0.5, at, p), 0.631),
                               ("Mandel: p(0)/p0 at c t/a2 = 1", np.interp(1, at, p), 0.291)):
        verdict(what, f"{found:.4f}", f"{exact} within 2 %", abs(found / exact - 1) <= 0.02)
    print(f"    the peak lies at c t/a2 = {at[peak]:.3f} (0.076; from 0.06 to 0.09 the answer stays within 0.4 % of it)")


# --- column -----------------------------------------------------------------------------------------------------------

VOID_RATIOS = {"dense": 0.21, "medium": 0.23, "loose": 0.24}
GATE = 0.1  # s, when it is removed


def family(soil, seed=1):
    """Names of the specimens of a geostatic family."""
    name = soil if seed == 1 else f"{soil}_seed{seed}"
    if not (folder / f"{name}_1645Pa.h5").exists():
        specimen(name, "--set", f"target.void_ratio={VOID_RATIOS[soil]}", "--set", f"pack.seed={seed}",
                 recipe="pack_saturated")
    return [f"{name}_{p}Pa.h5" for p in (1645, 4935, 8225, 11515)]


def front(frame, apart=1):
    """Where the deposit ends, m: the first gap of more than so many cells along x."""
    x = np.sort(frame["position_m"][:, 0])
    gaps = np.flatnonzero(np.diff(x) > apart * frame["grid_cell_m"][0])
    return x[gaps[0]] if len(gaps) else x[-1]


COLUMN_OPTIONS = os.environ.get("RVELAB_MPM_COLUMN", "").split()


def column():
    for soil in ("dense", "medium", "loose"):
        family(soil)
    print("\nSaturated column, 1 x 1 m, k 1e-2 m/s, from the removal of the gate on: front beyond 1 m (m), mean excess\n"
          "pore pressure of all points (Pa), kinetic and potential energy over the first potential energy" + told(COLUMN_OPTIONS))
    found = {}
    for case in ("dry", "medium", "dense", "loose"):
        name = f"column_saturated_{case}"
        h, _ = run(name, "column_saturated.toml", "--case", case, *COLUMN_OPTIONS)
        t = h["time_s"] - GATE
        first = frame_at(name, 0)
        n = 0.0 if case == "dry" else np.mean(first["porosity"])
        e = np.mean(first["void_ratio"])
        whole = (SOLIDS / (1 + e) + WATER * n) * GRAVITY * 0.5
        mean = lambda at, field: np.nan if case == "dry" else np.mean(frame_at(name, GATE + at)[f"{field}_Pa"])
        found[case] = {"e": e, "front 0.5": front(frame_at(name, GATE + 0.5)) - 1,
                       "excess 0.06": mean(0.06, "excess_pore_pressure"),
                       "water 0.06": mean(0.06, "pore_pressure"),
                       "front": front(frame_at(name, 1e9)) - 1, "peak": h["kinetic_J"].max() / whole,
                       "peak at": t[np.argmax(h["kinetic_J"])], "potential": (h["potential_J"] / whole, t),
                       "end": t[-1], "excess": [mean(at, "excess_pore_pressure") for at in (0.06, 0.2, 0.5, t[-1])]}
        f = found[case]
        print(f"{case}: e {e:.4f}; front at 0.5 s {f['front 0.5']:.3f}, at {f['end']:.2f} s {f['front']:.3f}; excess at 0.06, "
              "0.2, 0.5 s and the end " + ", ".join(f"{value:.0f}" for value in f["excess"])
              + f"; E_k peak {f['peak']:.4f} at {f['peak at']:.2f} s")
        costs(name)
        if f["end"] > 1:
            picture(folder / name, "--field", "excess_pore_pressure_Pa" if case != "dry" else "eps_q", "-o",
                    results / f"mpm_{name}.png")
    print()
    wet = ("dense", "medium", "loose")
    excess = [found[case]["excess 0.06"] for case in wet]
    verdict("column: mean excess pressure at 0.06 s, dense, medium, loose (Pa)",
            ", ".join(f"{value:.0f}" for value in excess),
            "rising, medium < 0 < loose", excess[0] < excess[1] < 0 < excess[2])
    water = [found[case]["water 0.06"] for case in wet]
    verdict("column: the pore pressure itself (the cut face loses that of rest too)",
            ", ".join(f"{value:.0f}" for value in water), "the same", water[0] < water[1] < 0 < water[2])
    fronts = [found[case]["front 0.5"] for case in wet]
    verdict("column: front beyond 1 m at 0.5 s, dry", f"{found['dry']['front 0.5']:.3f}", "> 1 m",
            found["dry"]["front 0.5"] > 1)
    verdict("column: the same, dense, medium, loose", ", ".join(f"{value:.3f}" for value in fronts), "< 0.2 m",
            max(fronts) < 0.2)
    verdict("column: their order", "", "dense <= medium <= loose", fronts[0] <= fronts[1] <= fronts[2])
    peaks = [found[case]["peak"] for case in wet]
    verdict("column: peak of E_k over the dry one, dense, medium, loose",
            ", ".join(f"{peak / found['dry']['peak']:.3f}" for peak in peaks), "< 0.6, rising",
            max(peaks) < 0.6 * found["dry"]["peak"] and peaks[0] < peaks[1] < peaks[2])
    if min(found[case]["end"] for case in wet) > 1.5:
        ends = [found[case]["front"] for case in wet]
        verdict("column: run-out at the end, dense, medium, loose", ", ".join(f"{value:.3f}" for value in ends),
                "within 15 %", max(ends) <= 1.15 * min(ends))
        verdict("column: run-out of the dry one", f"{found['dry']['front']:.3f}", "below all three",
                found["dry"]["front"] < min(ends))
        slopes = []
        for case in wet:
            potential, t = found[case]["potential"]
            slopes.append(np.interp(t[-1], t, potential) - np.interp(t[-1] - 0.2, t, potential))
        verdict("column: change of E_p over the last 0.2 s, dense, medium, loose",
                ", ".join(f"{slope:.1e}" for slope in slopes),
                "still falling", max(slopes) < 0)


# --- waves ------------------------------------------------------------------------------------------------------------

PACKINGS = {"bedded_0": ("R0", "pack_regular"),
            "bedded_30": ("R30", "pack_regular", "pack.number=432", "grains.bedding_angle_deg=30"),
            "isotropic": ("I", "pack_bedded", "grains.bedding_spread_deg=90")}
WAVE_OPTIONS = os.environ.get("RVELAB_MPM_WAVE", "").split()
MIDDLE, SURFACE = 10.5, 10.0  # m: of the strip
SCAN_ENDS = 0.06  # s, beyond the pulse and what it does at B
SNAPSHOTS = 0.04, 0.07, 0.09, 0.12  # s, of the published figures


def wave_run(case, conductivity=None):
    name = f"wave_{case}" + (f"_{conductivity:g}" if conductivity else "")
    packed, recipe, *keys = PACKINGS[case]
    specimen(packed, *(word for key in keys for word in ("--set", key)), recipe=recipe)
    run(name, "wave.toml", "--case", case, *WAVE_OPTIONS,
        *(("--set", f"fluid.conductivity_m_s={conductivity:g}", "--set", f"time.duration_s={SCAN_ENDS}") if conductivity
          else ()))
    return name


def modulus_of_shear(packed):
    """Pa: of gamma_xy at small strains, on the specimen as it is."""
    strain, *_, stress, strains = cell_test(f"shear_{packed}", "simple_shear", packed, "stage.shear.to_strain=1e-5",
                                            "stage.shear.record_every=1e-6", "solver.target_unbalanced=0",
                                            "solver.relative_tolerance=1e-3", "solver.absolute_tolerance=1e-6")
    return abs(np.polyfit(strains[-len(strain):], stress[-len(strain):, 0, 1], 1)[0])


def moved(w, k, axis):
    return w[f"{k}.{axis}_m"] - w[f"{k}.{axis}_m"][0]


def turned(x, y):
    """Degrees that the direction of motion of a plane path turns through in all, with its sign; its beginning and end,
    slower than a twentieth of the fastest, left out."""
    dx, dy = np.gradient(x), np.gradient(y)
    speed = np.hypot(dx, dy)
    fast = speed > 0.05 * speed.max()
    angle = np.unwrap(np.arctan2(dy[fast], dx[fast]))
    return np.degrees(angle.max() - angle.min())


def wave():
    print("\nWaves, 21 x 10 m of elliptic grains, k 1e-2 m/s: shear modulus of the specimen, Rayleigh speed\n"
          "0.955 sqrt(G/rho) of the soil with its water; speeds along the surface, 2 to 5.6 m from the strip's middle,\n"
          "right and left (a wave of 0.08 s is 7 to 11 m long: these points are nearer than one, where crests and troughs\n"
          "move apart)" + told(WAVE_OPTIONS))
    depth, asymmetry, shares = {}, {}, {}
    for case in PACKINGS:
        name = wave_run(case)
        w, packed = watched(name), PACKINGS[case][0]
        frame = frame_at(name, 0)
        n = float(np.mean(frame["porosity"]))
        density = (1 - n) * SOLIDS + n * WATER
        G = modulus_of_shear(packed)
        rayleigh = 0.955 * np.sqrt(G / density)
        speeds, sideways = [], []
        for points, sign in (((4, 6, 2), 1), ((3, 5, 0), -1)):  # right, left: outward
            where = [abs(w[f"{k}.x_m"][0] - MIDDLE) for k in points]
            speeds.append(np.polyfit([trough(w["time_s"], moved(w, k, "y")) for k in points], where, 1)[0])
            sideways.append(np.polyfit([trough(w["time_s"], sign * moved(w, k, "x")) for k in points], where, 1)[0])
        reflected = (MIDDLE + w["0.x_m"][0]) / rayleigh
        early = w["time_s"] < reflected
        turn = turned(moved(w, 0, "x")[early], moved(w, 0, "y")[early])
        pairs = [right_over_left(frame_at(name, time)) for time in SNAPSHOTS]
        asymmetry[case] = float(np.exp(np.mean(np.log(pairs))))
        depth[case], shares[case] = penetration(name), np.mean([share_below(frame_at(name,
                                                                                     time)) for time in SNAPSHOTS])
        print(f"{case}: G {G / 1e6:.2f} MPa, n {n:.3f}, Rayleigh {rayleigh:.1f} m/s; troughs of u_y {speeds[0]:.1f}, "
              f"{speeds[1]:.1f} m/s, crests of u_x towards the strip {sideways[0]:.1f}, {sideways[1]:.1f} m/s;\n"
              f"    A turns through {turn:.0f} degrees; right/left at 0.04, 0.07, 0.09, 0.12 s "
              f"{', '.join(f'{pair:.3f}' for pair in pairs)}")
        costs(name)
        off = [speed / rayleigh - 1 for speed in speeds]
        verdict(f"wave, {case}: speed of the fronts over that of Rayleigh, right and left",
                ", ".join(f"{1 + each:.3f}" for each in off),
                "1 within 10 %", max(map(abs, off)) <= 0.1)
        verdict(f"wave, {case}: A turns through, degrees, before the reflection", f"{turn:.0f}", ">= 270", turn >= 270)
        picture(folder / name, "--field", "excess_pore_pressure_Pa", "--frame", 7, "-o", results / f"mpm_{name}.png")
    verdict("wave: right over left of u_x, 0 degrees", f"{asymmetry['bedded_0']:.3f}", "1 within 0.05",
            abs(asymmetry["bedded_0"] - 1) <= 0.05)
    verdict("wave: right over left of u_x, 30 degrees", f"{asymmetry['bedded_30']:.3f}", ">= 1.2",
            asymmetry["bedded_30"] >= 1.2)
    verdict("wave: right over left of u_x, isotropic", f"{asymmetry['isotropic']:.3f}", "between",
            min(asymmetry["bedded_0"], asymmetry["bedded_30"]) < asymmetry["isotropic"] < max(asymmetry["bedded_0"],
                                                                                              asymmetry["bedded_30"]))
    verdict("wave: mean share of |p| below 5 m at 0.04 to 0.12 s: isotropic; 0, 30 degrees",
            "{:.3f}; {:.3f}, {:.3f}".format(
        shares["isotropic"], shares["bedded_0"], shares["bedded_30"]), "isotropic the least",
            shares["isotropic"] < min(shares["bedded_0"], shares["bedded_30"]))
    print("    by the depth where the largest pressure of the run falls to a quarter the order is another: "
          + ", ".join(f"{case} {depth[case]:.2f} m" for case in depth))
    lame = oedometer("I")[1] * 1e6
    near, far = [2.0, 3.5, 5.5], [2.0, 3.5, 5.5, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0]
    where, when = elastic_fronts("wave_elastic", 10.5, 10.0, near, G, lame, n)
    beside = np.polyfit(when, where, 1)[0] / rayleigh
    where, when = elastic_fronts("wave_elastic_far", 22.0, 20.0, far, G, lame, n)
    away = np.polyfit(when[-3:], where[-3:], 1)[0] / rayleigh
    verdict("wave: elastic soil, moduli of the isotropic packing: the same ratio", f"{beside:.3f}",
            f"{1 + np.mean(off):.3f} within 5 %", abs(beside / (1 + np.mean(off)) - 1) <= 0.05)
    verdict("wave: elastic soil, 44 x 20 m: speed from 14 to 18 m over that of Rayleigh", f"{away:.3f}",
            "1 within 10 %",
            abs(away - 1) <= 0.1)


def elastic_fronts(name, half_width, depth, distances, G, lame, porosity):
    """The same pulse on an elastic soil of these moduli: speeds of the troughs of u_y between the distances (m) from the
    strip's middle."""
    K = lame + 2 * G / 3
    watched_text = "watched_points_m = [[5, 10], [10.5, 10], [16, 10], [8.5, 10], [12.5, 10], [7, 10], [14, 10]]"
    edits = [("upper_m = [21, 10]", f"upper_m = [{2 * half_width:g}, {depth:g}]"),
             ("at_m = 21", f"at_m = {2 * half_width:g}"),
             ("lower_m = 10, upper_m = 11", f"lower_m = {half_width - 0.5:g}, upper_m = {half_width + 0.5:g}"),
             ("conductivity_m_s = 1e-2", f"conductivity_m_s = 1e-2\nporosity = {porosity:g}"),
             ("duration_s = 0.15", f"duration_s = {0.08 + distances[-1] / 75:g}"),
             ("frame_every_s = 0.01", "frame_every_s = 1"),
             (watched_text, f"watched_points_m = {[[half_width - d, depth] for d in distances]}")]
    scene = elastic_scene(name, "wave.toml", edits, density=(1 - porosity) * SOLIDS,
                          young=9 * K * G / (3 * K + G), poisson=(3 * K - 2 * G) / (2 * (3 * K + G)))
    run(name, scene)
    w = watched(name)
    when = np.array([trough(w["time_s"], moved(w, k, "y")) for k in range(len(distances))])
    where = np.array([half_width - w[f"{k}.x_m"][0] for k in range(len(distances))])
    return where, when


def share_below(frame):
    """Of the sum of |excess pressure|, what lies in the lower half."""
    excess = abs(frame["excess_pore_pressure_Pa"])
    low = (frame["position_m"] - frame["displacement_m"])[:, 1] < SURFACE / 2
    return np.sum(excess[low]) / np.sum(excess)


def right_over_left(frame):
    """Sums of |u_x| over the points on both sides of the strip's middle."""
    u = frame["displacement_m"]
    right = (frame["position_m"] - u)[:, 0] > MIDDLE
    return np.sum(abs(u[right, 0])) / np.sum(abs(u[~right, 0]))


def trough(time, value):
    """When a curve is lowest, by a parabola through the three least values."""
    k = int(np.clip(np.argmin(value), 1, len(value) - 2))
    a, b, _ = np.polyfit(time[k - 1:k + 2] - time[k], value[k - 1:k + 2], 2)
    return time[k] - b / (2 * a)


def penetration(name):
    """m: depth below the strip at which the largest excess pressure of the run falls to a quarter."""
    largest, height = None, None
    for path in frames(name):
        with h5py.File(path) as file:
            at, p = file["position_m"][()], file["excess_pore_pressure_Pa"][()]
        largest = p if largest is None else np.maximum(largest, p)
        height = at if height is None else height
    below = abs(height[:, 0] - MIDDLE) < 0.5
    levels = np.unique(np.round(height[below, 1], 6))[::-1]
    values = np.array([np.mean(largest[below & (abs(height[:, 1] - level) < 1e-6)]) for level in levels])
    top = int(values.argmax())
    under = np.flatnonzero(values[top:] < 0.25 * values[top])
    return SURFACE - (levels[top + under[0]] if len(under) else 0.0)


def scan():
    print("\nConductivity, 0 degrees, point B at the middle of the strip: largest settlement (mm), largest excess\n"
          "pressure (kPa), when (s)\n\nk (m/s)   settlement  pressure  when")
    ks, rows = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6), []
    for k in ks:
        name = wave_run("bedded_0", None if k == 1e-2 else k)
        w = watched(name)
        p = w["1.excess_pore_pressure_Pa"]
        until = w["time_s"] <= SCAN_ENDS
        rows.append((-moved(w, 1, "y")[until].min() * 1e3, p[until].max() / 1e3, w["time_s"][p[until].argmax()]))
        print(f"{k:<10g}{rows[-1][0]:<12.4f}{rows[-1][1]:<10.2f}{rows[-1][2]:.4f}", flush=True)
    print()
    rows = np.array(rows)
    verdict("scan: settlement of B from 1e-2 to 1e-4", "", "falls", rows[0, 0] > rows[1, 0] > rows[2, 0])
    verdict("scan: pressure of B from 1e-2 to 1e-4", "", "rises", rows[0, 1] < rows[1, 1] < rows[2, 1])
    spread = [np.ptp(rows[2:, i]) / rows[2:, i].mean() for i in (0, 1)]
    verdict("scan: settlement, pressure at 1e-4, 1e-5, 1e-6 differ by", ", ".join(f"{each:.3f}" for each in spread),
            "0.05", max(spread) <= 0.05)
    verdict("scan: the pressure peaks, s, at 1e-2, 1e-3", f"{rows[0, 2]:.4f}, {rows[1, 2]:.4f}", "before 0.02",
            rows[:2, 2].max() < 0.02)


# --- shaking ----------------------------------------------------------------------------------------------------------

SHAKING_OPTIONS = os.environ.get("RVELAB_MPM_SHAKING", "").split()
SEEDS = tuple(int(seed) for seed in os.environ.get("RVELAB_MPM_SEEDS", "1 2").split())
PERIOD = 0.4  # s


def shaking():
    print("\nShaken box, 2 x 1 m, k 1e-3 m/s: points A (top), B (middle), C (base) of the middle" + told(SHAKING_OPTIONS))
    found = {}
    for seed in SEEDS:
        for soil in ("dense", "medium"):
            names = family(soil, seed)
            name = f"shaking_{soil}_{seed}"
            listed = "[" + ",".join(f'"{each}"' for each in names) + "]"
            run(name, "shaking.toml", "--case", soil, "--set", f"material.sand.specimens={listed}", "--set",
                f"output.frame_every_s={PERIOD / 10:g}", "--set", "output.networks=false", *SHAKING_OPTIONS)
            found[soil, seed] = shaken(name)
            costs(name)
    print()
    for seed in SEEDS:
        dense, medium = found["dense", seed], found["medium", seed]
        verdict(f"shaking, seed {seed}: mean top ratio of the last quarter, medium", f"{medium['ratio']:.3f}",
                ">= 0.3 (0.4)", medium["ratio"] >= 0.3)
        verdict(f"shaking, seed {seed}: the same, dense", f"{dense['ratio']:.3f}", "-0.05 to 0.05",
                abs(dense["ratio"]) <= 0.05)
        verdict(f"shaking, seed {seed}: settlement of A, medium and dense (mm)",
                f"{medium['settled']:.2f}, {dense['settled']:.2f}",
                "medium >= 10 x dense", medium["settled"] >= 10 * abs(dense["settled"]))
        verdict(f"shaking, seed {seed}: onset at A, B, C, medium (s)", ", ".join(f"{t:.1f}" for t in medium["onset"]),
                "A < B < C",
                medium["onset"][0] < medium["onset"][1] < medium["onset"][2])
        verdict(f"shaking, seed {seed}: stiffness of B, last over second cycle, dense",
                f"{dense['stiffness']:.2f}", ">= 0.8", dense["stiffness"] >= 0.8)
        verdict(f"shaking, seed {seed}: the same, medium", f"{medium['stiffness']:.2f}", "<= 0.5",
                medium["stiffness"] <= 0.5)
        verdict(f"shaking, seed {seed}: contacts a grain of B, medium, start and end",
                "{:.2f}, {:.2f}".format(*medium["contacts"]), "falls",
                medium["contacts"][1] < medium["contacts"][0])


def shaken(name):
    w = watched(name)
    t, end = w["time_s"], w["time_s"][-1]
    late = t > 0.75 * end
    window = np.ones(max(1, round(PERIOD / np.median(np.diff(t)))))
    ratios = [np.convolve(w[f"{k}.pore_pressure_ratio"], window / len(window), mode="same") for k in (0, 1, 2)]
    onset = [next((float(time) for time, ratio in zip(t, r) if ratio > 0.05), np.inf) for r in ratios]
    # Stress and place of B in each frame; the watched point is the nearest one.
    times, shear, aside, contacts = [], [], [], []
    with h5py.File(frames(name)[0]) as file:
        at = file["position_m"][()]
    b = int(np.argmin(np.hypot(at[:, 0] - w["1.x_m"][0], at[:, 1] - w["1.y_m"][0])))
    for path in frames(name):
        with h5py.File(path) as file:
            times.append(float(file["time_s"][0]))
            shear.append(file["stress_Pa"][b, 1])
            aside.append(file["displacement_m"][b, 0])
            contacts.append(file["coordination_number"][b])
    times, shear, aside = map(np.array, (times, shear, aside))
    cycles = []
    for k in range(int(end / PERIOD)):
        within = (times >= k * PERIOD - 1e-9) & (times <= (k + 1) * PERIOD + 1e-9)
        if within.sum() > 3:
            cycles.append(np.polyfit(aside[within], shear[within], 1)[0] if np.ptp(aside[within]) > 0 else np.nan)
    told = {"ratio": float(np.mean(w["0.pore_pressure_ratio"][late])), "onset": onset,
            "settled": float((w["0.y_m"][0] - w["0.y_m"][-1]) * 1e3), "stiffness": cycles[-1] / cycles[1],
            "contacts": (contacts[0], contacts[-1])}
    parts = [(t >= a * end / 4) & (t <= (a + 1) * end / 4) for a in range(4)]
    quarters = [", ".join(f"{np.mean(r[part]):.3f}" for part in parts) for r in ratios]
    print(f"{name}: {end:.1f} s; ratio by quarters at A {quarters[0]}; B {quarters[1]}; C {quarters[2]};\n"
          f"    settlement {told['settled']:.2f} mm; stiffness of B by cycles {cycles[1]:.3g}, {cycles[len(cycles) // 2]:.3g}, {cycles[-1]:.3g} Pa/m")
    return told


PARTS = {"consolidation": consolidation, "undrained": undrained, "drained": drained, "cyclic": cyclic, "mandel": mandel,
         "column": column, "wave": wave, "scan": scan, "shaking": shaking}


def main():
    folder.mkdir(parents=True, exist_ok=True)
    plt.rcParams.update(STYLE)
    for part in cases or [part for part in PARTS if part != "shaking"]:
        PARTS[part]()
    print(f"\n{len(missed)} missed" + (": " + "; ".join(missed) if missed else ""))


if __name__ == "__main__":
    main()
