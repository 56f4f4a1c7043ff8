"""A case by rvelab's Python package: run_rvelab.py CASE_FOLDER SETTING.json OUT.json

SETTING: {"relative_tolerance": r} quasi-statically (absolute tolerance r/100), {"time_step": f} at a rate, in contact
times of the case. For references also {"unbalanced": u, "substeps": n, "slip": s, "perturb": seed, "parts": n}.
"""
import json
import os
import random
import subprocess
import sys
import tempfile
import time

import numpy as np
import rvelab
from rvelab.program import program

import case as cases


def material(case):
    law = case.law
    kept = {key: law[key] for key in ("density_kg_m3", "young_modulus_Pa", "stiffness_ratio", "poisson_ratio", "friction",
                                      "rolling_stiffness", "rolling_friction") if key in law}
    lines = ["[contact]", f'law = "{law["kind"]}"', f"rolling = {str(case.rolling).lower()}", "[damping]", "local = 0.0"]
    if "restitution" in law:
        lines += ['dashpot = "restitution"', f"restitution = {law['restitution']!r}"]
    return "\n".join([*lines, "[[material]]", 'name = "grain"', *(f"{key} = {float(value)!r}" for key, value in kept.items())])


def opened(case, specimen, perturb=None):
    """The specimen at rest. perturb: centres moved by up to 1e-9 radii, by that seed."""
    draw = random.Random(perturb)
    with tempfile.TemporaryDirectory() as folder:
        with open(folder + "/grains.csv", "w", encoding="utf-8") as out:
            out.write("id,x,y,z,r\n" if not case.disc else "id,x,y,r\n")
            for k, g in enumerate(specimen.grains, 1):
                x = [v + (1e-9 * g.r * draw.uniform(-1, 1) if perturb is not None else 0) for v in g.x[:case.dimension]]
                out.write(",".join(map(repr, [k, *x, g.r])) + "\n")
        with open(folder + "/material.toml", "w", encoding="utf-8") as out:
            out.write(material(case) + "\n")
        done = subprocess.run([program(), "import", folder + "/grains.csv", "--cell", ",".join(map(repr, specimen.cell)),
                               "--dimension", str(case.dimension), "--material", folder + "/material.toml", "-o",
                               folder + "/S.h5"], capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{specimen.file}: {done.stderr.strip()}")
        return rvelab.Rve(folder + "/S.h5")


def settings_of(case, setting):
    found = {}
    if "relative_tolerance" in setting:
        r = setting["relative_tolerance"]
        found = {"solver.relative_tolerance": r, "solver.absolute_tolerance": 0.01 * r}
    if "time_step" in setting:
        found = {"solver.fixed_time_step_s": setting["time_step"] * case.contact_time(), "solver.time_step_factor": 0.99}
    for key, name in (("unbalanced", "solver.target_unbalanced"), ("substeps", "solver.fixed_substeps"),
                      ("slip", "contact.slip")):
        if key in setting:
            found[name] = setting[key]
    return found


def row_of(f, sigma):
    return [f[0, 0] - 1, f[1, 1] - 1, f[2, 2] - 1, *(float(sigma[i, j] + sigma[j, i]) / 2 for i, j in cases.PLACES)]


def made(case, specimen, setting):
    rve = opened(case, specimen, setting.get("perturb"))
    rve.set_parameters(settings_of(case, setting))
    f, records, seconds, parts = np.eye(3), [], 0.0, setting.get("parts", 1)
    records.append(row_of(f, rve.stress))
    for leg, target in case.targets():
        free = [k for k in range(3) if cases.COMPONENTS[k] in leg.held_Pa]
        wanted = np.eye(3) + np.array(target)
        for k in free:
            wanted[k, k] = f[k, k]
        step = (wanted - f) / parts
        dt = np.abs(step).max() / case.rate if case.rate else 0.0
        for _ in range(parts):
            dH = step @ np.linalg.inv(f)
            begin = time.process_time()
            if free:
                applied = rve.apply_held(dH, {key: float(v) for key, v in leg.held_Pa.items()}, dt)
                sigma, dH = applied.sigma[0], applied.dH[0]
            else:
                sigma = rve.apply(dH, dt)
            seconds += time.process_time() - begin
            f = (np.eye(3) + dH) @ f
        records.append(row_of(f, sigma - rve.reynolds if case.rate else sigma))  # stress of the contacts
    return {"seconds": seconds, "records": records}


def main():
    case = cases.Case(sys.argv[1])
    with open(sys.argv[2], encoding="utf-8") as file:
        setting = json.load(file)
    found = [made(case, specimen, setting) for specimen in case.specimens]
    with open(sys.argv[3], "w", encoding="utf-8") as file:
        json.dump(found, file)


if __name__ == "__main__":
    main()
