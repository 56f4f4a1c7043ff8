"""What holding a stress costs: control.py RVELAB WORK RESULTS [CASE...].

Drained compression through peak and softening, 2D and 3D, at kappa = kn/(p t) (2D) and (E*/p)^(2/3) (3D) from 1e2 to
1e6. Then the recorded strain path is prescribed again with the same tolerance and spacing, and the grain-steps compared:

- each increment from the state of the record before it (every tenth: "again"), so that both do the same work;
- the whole path in one run ("path"). A path is chaotic: prescribed to stiff grains after the peak, p drifts by orders
  of magnitude, and with it the strain increments, so that its cost says little. It is shown and not judged where p at
  its end is off by more than a half. Where it has not ended after ten minutes it is given up ("nan").

Bars: at most 1 % of the records flagged; at most 1.3 times the grain-steps.
"""
import pathlib
import subprocess

import h5py
import numpy as np

import harness
from harness import imported, in_turn, rvelab, sets, work

EVERY = 10
# kn of the mean pair over thickness: 800 MPa * 5 mm / 0.1 m; E* = 7 GPa / (2 (1 - 0.25^2)). Steps per strain grow as
# kappa: stiff packings, whose peak comes early, go less far.
SCENES = {"disc": ("dense", lambda kappa: 4e7 / kappa, "y",
                   {1e2: 0.15, 1e3: 0.15, 1e4: 0.10, 1e5: 0.04, 1e6: 0.02}),
          "sphere": ("hertz", lambda kappa: 7e9 / (2 * (1 - 0.25**2)) / kappa**1.5, "z",
                     {1e2: 0.20, 1e3: 0.20, 1e4: 0.06, 1e5: 0.02, 1e6: 0.006})}
RECORDS = 300


def run(*arguments, seconds=None):
    # kappa = 1e2 is soft: overlaps are large.
    rvelab("run", *arguments, "--force", *sets("solver.max_overlap_ratio=1"), timeout=seconds)


def steps_of(path):
    with h5py.File(path) as file:
        return int(np.ravel(file["test/grain_steps"][()])[0])


def deformations(path, gradients):
    rows = ",\n".join(str([float(x) for x in f.ravel()]) for f in gradients)
    path.write_text(f'[test]\nname = "replay"\n[output]\nquantities = []\n[[stage]]\nkind = "deformation"\n'
                    f"gradients = [\n{rows}]\n")
    return path


def again(name, file, gradients, substeps, grains):
    """Grain-steps of every tenth increment, under control and prescribed from the same state."""
    state, sealed, toml, out = (pathlib.Path(f"{name}_one{end}") for end in (".h5", "_sealed.h5", ".toml", "_R.h5"))
    controlled = prescribed = 0
    for k in range(0, len(gradients) - 1, EVERY):
        with h5py.File(state, "w") as single:
            for key in file[f"snapshots/{k:06d}"]:
                file.copy(f"snapshots/{k:06d}/{key}", single)
            single.attrs["format"], single.attrs["format_version"] = np.bytes_("rvelab specimen"), file.attrs["format_version"]
        # Made by another program, it has no checksum.
        rvelab("seal", state, "-o", sealed, "--force")
        run(deformations(toml, [gradients[k + 1] @ np.linalg.inv(gradients[k])]), "--specimen", sealed, "-o", out)
        controlled += int(substeps[k + 1]) * grains
        prescribed += steps_of(out)
    return controlled, prescribed


def case(scene, kappa):
    packing, pressure_of, axis, ends = SCENES[scene]
    pressure = f"test.pressure_Pa={pressure_of(kappa)!r}"
    name = work / f"{scene}_{kappa:.0e}"
    start, test, whole = (pathlib.Path(f"{name}{end}") for end in ("_start.h5", ".h5", "_replay.h5"))
    isotropic, drained = pathlib.Path(f"{name}_start.toml"), pathlib.Path(f"{name}.toml")
    isotropic.write_text('[test]\nname = "start"\n[[stage]]\nkind = "isotropic"\n')
    run(isotropic, "--specimen", work / f"{packing}.h5", "-o", start, *sets(pressure))
    drained.write_text(f'[test]\nname = "drained"\n[output]\nquantities = []\nsnapshots_every = {EVERY}\n'
                       f'[[stage]]\nkind = "compression"\naxis = "{axis}"\nto_strain = {ends[kappa]}\n'
                       f"record_every = {ends[kappa] / RECORDS!r}\n")
    run(drained, "--specimen", start, "-o", test, *sets(pressure))
    with h5py.File(test) as file:
        gradients, stress = file["records/deformation_gradient"][:], -file["records/stress_Pa"][:]
        flagged = 1 - file["records/target_held"][:].mean()
        held_error, substeps = file["records/held_error"][:], file["records/substeps"][:]
        grains = len(file["specimen/grains/radius_m"])
        controlled, prescribed = again(name, file, gradients, substeps, grains)
    path = drift = np.nan
    try:
        run(deformations(pathlib.Path(f"{name}_replay.toml"), gradients[1:]), "--specimen", start, "-o", whole,
            seconds=600)
        path = steps_of(test) / steps_of(whole)
        with h5py.File(whole) as file:
            drift = np.trace(file["records/stress_Pa"][-1]) / -np.trace(stress[-1])
    except subprocess.TimeoutExpired:
        pass
    k = 1 if scene == "disc" else 2
    ratio = stress[:, k, k] / stress[:, 0, 0]
    peak = int(np.argmax(ratio))
    times = controlled / prescribed
    good = flagged <= 0.01 and times <= 1.3 and not (path > 1.3 and abs(drift - 1) <= 0.5)
    return (f"{scene:7} {kappa:7.0e} {pressure_of(kappa):12.4g} {ratio[peak]:11.3f} {ends[kappa] / RECORDS * peak:10.4f} "
            f"{ratio[-RECORDS // 5:].mean():11.3f} {flagged:8.2%} {held_error.mean():11.5f} {steps_of(test):12.4g} "
            f"{times:6.2f} {path:6.2f} {drift:8.3g} ", good)


def main():
    for packing, *_ in SCENES.values():
        imported(packing)
    cases = [(scene, kappa) for kappa in (1e2, 1e3, 1e4, 1e5, 1e6) for scene in SCENES]
    if harness.words:
        cases = [each for each in cases if f"{each[0]}_{each[1]:.0e}" in harness.words]
    print("scene     kappa  pressure_Pa  peak ratio  at strain  last fifth  flagged  mean error  grain-steps  again   path"
          "  p drift  verdict")
    for text, good in in_turn(lambda each: case(*each), cases):
        harness.row(text, good, good="ok")


if __name__ == "__main__":
    harness.main(main)
