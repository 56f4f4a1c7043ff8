#!/usr/bin/python3
"""What holding a stress costs: control.py RVELAB WORK [CASE...].

Drained compression through peak and softening, 2D and 3D, at kappa = kn/(p t) (2D) and (E*/p)^(2/3) (3D) from 1e2 to
1e6; then the deformation gradients that it recorded are prescribed again (kind = "deformation"), with the same tolerance
and spacing. Bars: at most 1 % of the records flagged; at most 1.3 times the grain-steps of the replay.
"""
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np

DATA = pathlib.Path("tests/data/yade")
# kn of the mean pair over thickness, 800 MPa * 10 mm / 2 / 0.1 m; E* = 7 GPa / (2 (1 - 0.25^2))
SCENES = {"disc": ("dense", lambda kappa: 4e7 / kappa, "biaxial", 0.15, "compression"),
          "sphere": ("hertz", lambda kappa: 7e9 / (2 * (1 - 0.25**2)) / kappa**1.5, "triaxial", 0.20, "compression")}


def run(program, *arguments):
    subprocess.run([program, "run", *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def steps_of(path):
    with h5py.File(path) as file:
        return int(np.ravel(file["test/grain_steps"][()])[0])


def case(program, work, scene, kappa):
    packing, pressure_of, protocol, to_strain, stage = SCENES[scene]
    pressure = pressure_of(kappa)
    name = work / f"{scene}_{kappa:.0e}"
    start, test, again, toml = (pathlib.Path(f"{name}{end}") for end in ("_start.h5", ".h5", "_replay.h5", ".toml"))
    specimen = work / f"{packing}.h5"
    isotropic = work / "isotropic.toml"
    isotropic.write_text('[test]\nname = "start"\npressure_Pa = 1e5\n[[stage]]\nkind = "isotropic"\n')
    run(program, isotropic, "--specimen", specimen, "-o", start, "--force", "--set", f"test.pressure_Pa={pressure!r}")
    drained = work / f"{scene}.toml"
    axis = "y" if scene == "disc" else "z"
    drained.write_text(f'[test]\nname = "drained"\npressure_Pa = 1e5\n[[stage]]\nkind = "compression"\naxis = "{axis}"\n'
                       f"to_strain = {to_strain}\nrecord_every = 0.0005\n")
    run(program, drained, "--specimen", start, "-o", test, "--force", "--set", f"test.pressure_Pa={pressure!r}",
        "--set", "solver.max_overlap_ratio=1")  # soft grains, kappa = 1e2, overlap far
    with h5py.File(test) as file:
        gradients = file["records/deformation_gradient"][:]
        stress = -file["records/stress_Pa"][:]
        flagged = 1 - file["records/target_held"][:].mean()
        held_error = file["records/held_error"][:]
    rows = ",\n".join(str([float(x) for x in f.ravel()]) for f in gradients[1:])
    toml.write_text(f'[test]\nname = "replay"\n[[stage]]\nkind = "deformation"\ngradients = [\n{rows}]\n')
    run(program, toml, "--specimen", start, "-o", again, "--force", "--set", "solver.max_overlap_ratio=1")
    k = 1 if scene == "disc" else 2
    ratio = stress[:, k, k] / stress[:, 0, 0]
    d = 2 if scene == "disc" else 3
    rotated = np.linalg.norm(gradients - gradients.transpose(0, 2, 1))
    assert rotated < 1e-12, "no shear strain was asked for"
    peak = int(np.argmax(ratio))
    return (scene, kappa, pressure, len(ratio), ratio[peak], 0.0005 * peak, ratio[-len(ratio) // 5:].mean(), flagged,
            held_error.mean(), steps_of(test), steps_of(again), steps_of(test) / steps_of(again), d)


def main():
    program, work = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    for packing, *_ in SCENES.values():
        stem = DATA / packing
        subprocess.run([program, "import", f"{stem}.particles.csv", f"{stem}.contacts.csv", f"{stem}.json", "-o",
                        work / f"{packing}.h5"], check=True, stdout=subprocess.DEVNULL)
    cases = [(scene, kappa) for scene in SCENES for kappa in (1e2, 1e3, 1e4, 1e5, 1e6)]
    if sys.argv[3:]:
        cases = [each for each in cases if f"{each[0]}_{each[1]:.0e}" in sys.argv[3:]]
    print("scene     kappa  pressure_Pa  records  peak ratio  at strain  last fifth  flagged  mean error   grain-steps"
          "      replay  times  verdict")
    failed = []
    with ThreadPoolExecutor(2) as pool:
        for row in pool.map(lambda each: case(program, work, *each), cases):
            good = row[7] <= 0.01 and row[11] <= 1.3
            if not good:
                failed.append(f"{row[0]} at kappa {row[1]:.0e}")
            print(f"{row[0]:7} {row[1]:7.0e} {row[2]:12.4g} {row[3]:8d} {row[4]:11.3f} {row[5]:10.4f} {row[6]:11.3f} "
                  f"{row[7]:8.2%} {row[8]:11.5f} {row[9]:13.4g} {row[10]:11.4g} {row[11]:6.2f}  "
                  f"{'ok' if good else 'MISSED'}", flush=True)
    if failed:
        sys.exit(f"control: {', '.join(failed)}")


main()
