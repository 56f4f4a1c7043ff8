"""tools/validate mpm: scenes of rvelab-mpm beside pure cells and published figures.

    mpm.py RVELAB FOLDER RESULTS [CASE...]

Speed of the continuum (asked: 2 M point-steps a second on one core), the single element beside the biaxial test of its
specimen, the column of a Mohr-Coulomb soil beside Liang and Zhao (2019), and the biaxial compression of the cases named
(C1: the file without a case). Runs that are whole in FOLDER are used again."""

import pathlib
import subprocess
import sys
import tomllib

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
rvelab, folder, results = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
cases = sys.argv[4:]
mpm = pathlib.Path(rvelab).with_name("rvelab-mpm")


def run(name, scene, *options):
    """Runs a scene into FOLDER/name unless it is there and whole; its history by columns, and what it printed."""
    place = folder / name
    history, printed = place / "history.csv", folder / f"{name}.txt"
    if history.exists():
        duration = tomllib.loads((place / "scene.toml").read_text())["time"]["duration_s"]
        if float(history.read_text().splitlines()[-1].split(",")[0]) < duration:
            with printed.open("a") as file:
                subprocess.run([mpm, "--resume", place, "-q"], stdout=file, check=True)
    else:
        with printed.open("w") as file:
            subprocess.run([mpm, ROOT / "protocols/mpm" / scene, "-o", place, "--specimens", folder, "-q", *options],
                           stdout=file, check=True)
    names = history.open().readline().strip().split(",")
    return dict(zip(names, np.loadtxt(history, delimiter=",", skiprows=1).T)), printed.read_text() if printed.exists() else ""


def picture(*options):
    subprocess.run([sys.executable, "-B", ROOT / "tools/plot/mpm.py", *map(str, options)], check=True, stdout=subprocess.DEVNULL)


def cell_test():
    """Axial strain and stress (Pa) of the biaxial test of dense.h5 at 100 kPa."""
    if not (folder / "dense.h5").exists():
        subprocess.run([rvelab, "pack", "pack_dense", "-o", folder / "dense.h5"], check=True, stdout=subprocess.DEVNULL)
    if not (folder / "cell.h5").exists():
        subprocess.run([rvelab, "run", "biaxial", "--specimen", folder / "dense.h5", "-o", folder / "cell.h5", "--set",
                        "test.pressure_Pa=100e3"], check=True, stdout=subprocess.DEVNULL)
    with h5py.File(folder / "cell.h5") as file:
        last = file["records/stage"][()] == file["records/stage"][()].max()
        return file["records/strain"][()][last], -file["records/stress_Pa"][()][last][:, 1, 1]


def speed():
    best = max(float(run(f"block{k}", "elastic_block.toml", "-j", "1")[1].split()[-5]) for k in range(3))
    print(f"continuum alone, one core, 17,408 elastic points: {best:.2f} M point-steps a second (asked: 2)")


def element(strain, stress):
    h, _ = run("element", "element.toml")
    watched = np.genfromtxt(folder / "element/watched.csv", delimiter=",", names=True)
    axial = -h["top.way_y_m"]
    point = np.mean([watched[f"{k}p_Pa"] + watched[f"{k}q_Pa"] for k in (0, 1)], axis=0)
    print("\nsingle element: axial strain, axial stress (kPa) of the points, of the cell under stress control")
    for at in (0.003, 0.006, 0.01, 0.015, 0.02, 0.03, 0.04, 0.049):
        print(f"{at:<8g} {np.interp(at, axial, point) / 1e3:<8.1f} {np.interp(at, strain, stress) / 1e3:.1f}")


def column():
    h, _ = run("column_soil", "column_soil.toml")
    frame = sorted((folder / "column_soil").glob("points_*.h5"))[-1]
    with h5py.File(frame) as file:
        x = np.sort(file["position_m"][()][:, 0])
        # The deposit ends where a point has no neighbour within a cell any more.
        cell = float(file["grid_cell_m"][0])
    gaps = np.flatnonzero(np.diff(x) > cell / 2)
    front = x[gaps[0]] if len(gaps) else x[-1]
    whole = 2190 * 9.81 * 0.5
    peak = int(np.argmax(h["kinetic_J"]))
    lost = -h["potential_J"][-1] - h["kinetic_J"][-1]
    print("\ncolumn, Mohr-Coulomb soil (published: grains)\n"
          f"run-out (front - 1)/1           {front - 1:<8.2f} 1.8 (experiment 1.6)\n"
          f"peak of kinetic energy          {h['kinetic_J'][peak] / whole:<8.3f} 0.1\n"
          f"at                              {h['time_s'][peak]:<8.2f} 0.4 s\n"
          f"dissipated                      {lost / whole:<8.2f} 0.55\n"
          f"not accounted for by the ledger {h['residual_J'][-1] / whole:.4f}")
    picture(folder / "column_soil", "--field", "eps_q", "-o", results / "mpm_column_soil.png")
    picture(folder / "column_soil", "--energy", "-o", results / "mpm_column_soil_energy.png")


def biaxial(strain, stress):
    print("\nbiaxial compression, stress on the plate (kPa): case, peak, its strain, at the end, strain there; of the cell "
          f"{stress.max() / 1e3:.1f} at {strain[stress.argmax()]:.4f}; published 280 at 0.016, 220 from 0.08 on")
    for case in cases:
        options = [] if case == "C1" else ["--case", case]
        h, printed = run(case, "biaxial.toml", *options)
        axial, plate = -h["plate.way_y_m"] / 2, h["plate.force_y_N"] + 100e3
        k = plate.argmax()
        print(f"{case:<4} {plate[k] / 1e3:<7.1f} {axial[k]:<8.4f} {np.mean(plate[-10:]) / 1e3:<7.1f} {axial[-1]:.3f}")
        print("    " + "\n    ".join(printed.strip().splitlines()[-3:]))
        picture(folder / case, "--field", "eps_q", "-o", results / f"mpm_{case}.png")
    picture(*(folder / case for case in cases), "--force", "plate.force_y", "--against", "plate.way_y", "-o",
            results / "mpm_biaxial.png")


def main():
    folder.mkdir(parents=True, exist_ok=True)
    speed()
    strain, stress = cell_test()
    element(strain, stress)
    column()
    if cases:
        biaxial(strain, stress)


if __name__ == "__main__":
    main()
