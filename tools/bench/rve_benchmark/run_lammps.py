"""A case by LAMMPS, or by LIGGGHTS, which split off from it: run_lammps.py PROGRAM CASE_FOLDER SETTING.json OUT.json

SETTING: {"steps": n} over the path, quasi-statically, with dashpots of restitution 0.3; {"time_step": f} at a rate, in
contact times of the case. LAMMPS: pair_style granular, every pair of sizes with the constants of the case; a held stress
by fix press/berendsen. LIGGGHTS: Hertz contacts.
"""
import json
import math
import os
import re
import resource
import subprocess
import sys
import tempfile

import case as cases

RESTITUTION, STEP, MODULUS = 0.3, 0.4, 3000  # quasi-static; step over contact time; of the servo, over the stress
# No tangential dashpots: with them LAMMPS' grains spin without bounds at this step, and are right at a quarter of it.


def tsuji(zeta):
    """e whose polynomial in LAMMPS' `damping tsuji` is sqrt(5) zeta, the dashpot of Hertz contacts."""
    value = lambda e: (1.2728 - 4.2783 * e + 11.087 * e**2 - 22.348 * e**3 + 27.467 * e**4 - 18.022 * e**5 + 4.8218 * e**6)
    low, high = 0.0, 1.0
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if value(middle) > math.sqrt(5) * zeta else (low, middle)
    return low


def sizes(specimen):
    return sorted({g.r for g in specimen.grains})


def lammps_law(case, specimen):
    law, lines, radii = case.law, ["pair_style granular"], sizes(specimen)
    if law["kind"] == "hertz_mindlin":
        e = tsuji(case.damping_ratio()) if case.rate else RESTITUTION
        return lines + [f"pair_coeff * * hertz/material {law['young_modulus_Pa']!r} {e!r} {law['poisson_ratio']!r} tangential "
                        f"mindlin_rescale/force NULL 0 {law['friction']!r} damping tsuji"]
    log = 0.0 if case.rate else -math.log(RESTITUTION)
    for a, ri in enumerate(radii):
        for b, rj in enumerate(radii[a:], a):
            kn, kt, kr, cap = case.pair(ri, rj)
            mi, mj = (case.mass(r, specimen.cell[2]) for r in (ri, rj))
            dashpot = 2 * log / math.hypot(math.pi, log) * math.sqrt(kn * mi * mj / (mi + mj))
            reduced = ri * rj / (ri + rj)
            rolling = f" rolling sds {kr / reduced**2!r} 0 {cap / reduced!r}" if case.rolling else ""
            lines.append(f"pair_coeff {a + 1} {b + 1} hooke {kn!r} {dashpot!r} tangential linear_history {kt!r} "
                         f"0 {law['friction']!r}{rolling} damping velocity")
    return lines


def liggghts_law(case):
    law = case.law
    return [f"fix m1 all property/global youngsModulus peratomtype {law['young_modulus_Pa']!r} {law['young_modulus_Pa']!r}",
            f"fix m2 all property/global poissonsRatio peratomtype {law['poisson_ratio']!r} {law['poisson_ratio']!r}",
            f"fix m3 all property/global coefficientRestitution peratomtypepair 2 {' '.join([str(RESTITUTION)] * 4)}",
            f"fix m4 all property/global coefficientFriction peratomtypepair 2 {' '.join([repr(law['friction'])] * 4)}",
            "pair_style gran model hertz tangential history tangential_damping off", "pair_coeff * *"]


def write_data(case, specimen, path, liggghts):
    radii, rho = sizes(specimen), case.law["density_kg_m3"]
    lx, ly, lz = specimen.cell
    low = -0.5 * lz if case.disc else 0.0
    with open(path, "w", encoding="utf-8") as out:
        out.write(f"grains\n\n{len(specimen.grains)} atoms\n{len(radii)} atom types\n\n0 {lx!r} xlo xhi\n0 {ly!r} ylo yhi\n"
                  f"{low!r} {low + lz!r} zlo zhi\n\nAtoms{'' if liggghts else ' # sphere'}\n\n")
        for k, g in enumerate(specimen.grains, 1):
            out.write(f"{k} {radii.index(g.r) + 1} {2 * g.r!r} {rho!r} {g.x[0]!r} {g.x[1]!r} {g.x[2]!r}\n")


def leg_lines(case, k, specimen, rate, step, servo):
    """Lines of leg k: the box moves linearly in time, and the grains get the change of velocity of their places."""
    leg, cell = case.legs[k], specimen.cell
    length = case.length(k)
    every = max(round(length / leg.records / (rate * step)), 1)
    change = lambda a, i, j: case.end(a)[i][j] - case.end(a - 1)[i][j] if a >= 0 else 0.0
    gradient = lambda a, i, j: change(a, i, j) / case.length(a) * rate if a >= 0 else 0.0
    lines, sides = [], []
    for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
        name = "xyz"[i] + ("xyz"[j] if i != j else "")
        if i == j and cases.COMPONENTS[i] in leg.held_Pa:
            continue
        if change(k, i, j):
            delta = repr(change(k, i, j) * cell[j])
            sides.append(f"{name} delta {'0 ' if i == j else ''}{delta}")
        turn = gradient(k, i, j) - gradient(k - 1, i, j)
        if turn:
            lines.append(f"velocity all ramp v{'xyz'[i]} 0 {turn * cell[j]!r} {'xyz'[j]} 0 {cell[j]!r} sum yes units box")
    lines += [f"timestep {length / leg.records / rate / every!r}", f"fix box all deform 1 {' '.join(sides)} units box remap v"]
    if leg.held_Pa:
        thin = cell[2] if case.disc else 1.0
        held = " ".join(f"{name[0]} {-p * thin!r} {-p * thin!r} {step!r}" for name, p in leg.held_Pa.items())
        modulus = MODULUS * max(abs(p) for p in leg.held_Pa.values()) * thin
        lines += [f"fix servo all press/berendsen {held} modulus {modulus!r}", "fix_modify servo press p"]
    lines += ["reset_timestep 0", f"thermo {every}", f"run {every * leg.records}", "unfix box", *(["unfix servo"] if leg.held_Pa else [])]
    return lines, every


def script(case, specimen, setting, liggghts):
    step = (setting["time_step"] if case.rate else STEP) * case.contact_time()
    rate = case.rate or sum(case.length(k) for k in range(len(case.legs))) / (setting["steps"] * step)
    mean = sum(g.r for g in specimen.grains) / len(specimen.grains)
    lines = ["units si", f"dimension {case.dimension}"]
    if liggghts:
        lines += ["atom_style granular", "atom_modify map array", "boundary p p p", "newton off", "communicate single vel yes",
                  "hard_particles yes", "read_data data", *liggghts_law(case)]
    else:
        lines += ["atom_style sphere", "boundary p p p", "newton off", "comm_modify vel yes", "read_data data",
                  *(["change_box all triclinic"] if case.lacks("shear") else []),
                  *([f"set group all density/disc {case.law['density_kg_m3'] * specimen.cell[2]!r}"] if case.disc else []),
                  *lammps_law(case, specimen)]
    lines += [f"fix 1 all nve/sphere{' disc' if case.disc else ''}", *(["fix 2 all enforce2d"] if case.disc else []),
              f"neighbor {0.2 * mean!r} bin", f"neigh_modify delay 0{'' if liggghts else ' every 1 check yes'}",
              "compute p all pressure " + ("thermo_temp virial" if liggghts else "NULL virial"),
              "thermo_style custom step lx ly lz c_p[1] c_p[2] c_p[3] c_p[6] c_p[5] c_p[4]",
              "thermo_modify norm no format float %.12g", "velocity all set 0 0 0", f"timestep {step!r}"]
    steps = 0
    for k, leg in enumerate(case.legs):
        more, every = leg_lines(case, k, specimen, rate, step, None)
        lines += more
        steps += every * leg.records
    return "\n".join(lines) + "\n", steps


def called(program, text, folder):
    """What it printed, and the processor time of its process, s."""
    with open(folder + "/in", "w", encoding="utf-8") as out:
        out.write(text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "-in", "in", "-log", "none"], cwd=folder, capture_output=True, text=True, check=False,
                          env=dict(os.environ, OMP_NUM_THREADS="1"))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def made(program, case, specimen, setting):
    liggghts = os.path.basename(program) == "liggghts"
    text, steps = script(case, specimen, setting, liggghts)
    with tempfile.TemporaryDirectory() as folder:
        write_data(case, specimen, folder + "/data", liggghts)
        done, whole = called(program, text, folder)
        if liggghts:  # it prints elapsed times alone: the process, less one that makes no step
            whole -= called(program, re.sub(r"run \d+", "run 0", text), folder)[1]
    if done.returncode:
        sys.exit(f"{program}: {(done.stdout + done.stderr)[-1500:]}")
    found = done.stdout
    rows, seconds = [], 0.0
    for k, part in enumerate(re.split(r"\n *Step ", found)[1:]):
        table, _, rest = part.partition("Loop time of ")
        own = [[float(word) for word in line.split()] for line in table.splitlines()[1:] if line.strip()]
        if len(own) != case.legs[k].records + 1:
            sys.exit(f"{program}: {len(own)} rows in leg {k}, {case.legs[k].records + 1} expected: {table[-500:]}")
        rows += own[1:] if k else own
        share = re.search(r"([\d.]+)% CPU use", rest)
        seconds += float(rest.split()[0]) * float(share.group(1)) / 100 if share else 0.0
    if liggghts:
        seconds = max(whole, 1e-3)
    thin, first = specimen.cell[2] if case.disc else 1.0, rows[0][1:4]
    records = [[*(now / then - 1 for now, then in zip(row[1:4], first)), *(-p / thin for p in row[4:10])] for row in rows]
    return {"seconds": seconds, "steps": steps, "records": records}


def main():
    case = cases.Case(sys.argv[2])
    with open(sys.argv[3], encoding="utf-8") as file:
        setting = json.load(file)
    found = [made(sys.argv[1], case, specimen, setting) for specimen in case.specimens]
    with open(sys.argv[4], "w", encoding="utf-8") as file:
        json.dump(found, file)


if __name__ == "__main__":
    main()
