"""A case by YADE: yade -n -x -j1 run_yade.py CASE_FOLDER SETTING.json OUT.json. Runs inside YADE, which brings O and the engines.

SETTING: {"steps": n} over the path, quasi-statically, with Cundall's damping 0.3; {"time_step": f} at a rate, in contact
times of the case. Discs are spheres with the masses and moments of inertia of discs.
"""
import json
import math
import os
import sys
import time

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
import case as cases

HEIGHT = 0.1          # of the cell of discs, m, so that no disc meets its image along z
DAMPING, STEP = 0.3, 0.4  # quasi-static: Cundall's damping, time step over the contact time
SERVO_MASS = 1.0      # of PeriTriaxController, over that of the grains


def build(case, specimen):
    law, scale = case.law, HEIGHT if case.disc else specimen.cell[2]
    O.reset()
    O.periodic = True
    O.cell.hSize = Matrix3(specimen.cell[0], 0, 0, 0, specimen.cell[1], 0, 0, 0, scale)
    angle, density = math.atan(law["friction"]), law["density_kg_m3"]
    if law["kind"] == "hertz_mindlin":
        O.materials.append(FrictMat(young=law["young_modulus_Pa"], poisson=law["poisson_ratio"], frictionAngle=angle,
                                    density=density))
        damping = dict(en=law["restitution"], es=1.0) if "restitution" in law else {}
        loop = InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_MindlinPhys(**damping)],
                               [Law2_ScGeom_MindlinPhys_Mindlin()])
    elif case.rolling:
        O.materials.append(CohFrictMat(young=law["young_modulus_Pa"], poisson=law["stiffness_ratio"], density=density,
                                       frictionAngle=angle, momentRotationLaw=True, isCohesive=False, alphaKtw=0,
                                       alphaKr=law["rolling_stiffness"], etaRoll=law["rolling_friction"]))
        law2 = Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True, always_use_moment_law=True)
        loop = InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D()], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()], [law2])
    else:
        O.materials.append(FrictMat(young=law["young_modulus_Pa"], poisson=law["stiffness_ratio"], frictionAngle=angle,
                                    density=density))
        loop = InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                               [Law2_ScGeom_FrictPhys_CundallStrack()])
    for g in specimen.grains:
        x = (g.x[0], g.x[1], HEIGHT / 2 if case.disc else g.x[2])
        body = O.bodies[O.bodies.append(sphere(x, g.r))]
        if case.disc:
            body.state.blockedDOFs = "zXY"
            body.state.mass = case.mass(g.r, specimen.cell[2])
            body.state.inertia = Vector3(1, 1, 1) * 0.5 * body.state.mass * g.r**2
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()], allowBiggerThanPeriod=True), loop,
                 NewtonIntegrator(damping=0.0 if case.rate else DAMPING)]
    return specimen.cell[2] / HEIGHT if case.disc else 1.0


def record(start, thin):
    h, s = O.cell.hSize, getStress()
    f = [h[k, k] / start[k, k] - 1 for k in range(3)]
    return f + [(s[i, j] + s[j, i]) / 2 / thin for i, j in cases.PLACES]


def root(dH, n):
    """G with (I + G)^n = I + dH, by the series: YADE's cell grows by (I + G) a step."""
    term, total, k = np.eye(3), np.zeros((3, 3)), 1
    while np.abs(term).max() > 1e-18 and k < 60:
        term = term @ dH * (1 / n - k + 1) / k
        total, k = total + term, k + 1
    return total


class Clock:
    def __init__(self):
        self.seconds = 0.0
        self.steps = 0

    def run(self, n):
        begin = time.process_time()
        O.run(n, True)
        self.seconds += time.process_time() - begin
        self.steps += n


def strain_path(case, targets, rate, thin, start, clock, records):
    """From record to record. YADE's cell obeys a gradient from the step after the next: it is set one step early."""
    at, wanted = np.eye(3), [np.eye(3) + np.array(target) for target in targets]
    plan = []
    for f in wanted:
        length = np.abs(f - at).max()
        n = max(round(length / (rate * O.dt)), 1)
        plan.append((n, root((f - at) @ np.linalg.inv(at), n), length / (rate * n)))
        at = f
    dt = O.dt

    def prepare(k):
        if case.rate:  # the time of a record is given
            O.dt = plan[k][2]
        g = plan[k][1] / (plan[k][2] if case.rate else dt)
        O.cell.velGrad = Matrix3(*g.flatten().tolist())

    prepare(0)
    clock.run(1)
    for k, (n, _, _) in enumerate(plan):
        if n > 1:
            clock.run(n - 1)
        if k + 1 < len(plan):
            prepare(k + 1)
        clock.run(1)
        records.append(record(start, thin))


def held_leg(case, leg, targets, rate, thin, start, clock, records):
    """The axis that is not held shortens at a rate; the others are held by YADE's controller."""
    axis = next(k for k in range(3) if leg.gradient[k][k] and cases.COMPONENTS[k] not in leg.held_Pa)
    names = [cases.COMPONENTS[k] for k in range(3)]
    goal = [leg.held_Pa[name] * thin if name in leg.held_Pa else 0.0 for name in names]
    goal[axis] = math.copysign(10.0, leg.gradient[axis][axis])
    most = [1e3 * rate if name in leg.held_Pa else 0.0 for name in names]
    most[axis] = rate
    servo = PeriTriaxController(goal=goal, stressMask=sum(1 << k for k, name in enumerate(names) if name in leg.held_Pa),
                                maxStrainRate=most, dynCell=True, globUpdate=1,
                                mass=SERVO_MASS * sum(body.state.mass for body in O.bodies))
    O.engines = O.engines[:-1] + [servo, O.engines[-1]]
    for target in targets:
        wanted = (1 + target[axis][axis]) * start[axis, axis]
        while True:
            n = round(abs(math.log(O.cell.hSize[axis, axis] / wanted)) / (rate * O.dt))
            if n < 1:
                break
            clock.run(n)
        records.append(record(start, thin))
    O.engines = O.engines[:-2] + [O.engines[-1]]


def made(case, specimen, setting):
    thin = build(case, specimen)
    start, records, clock = O.cell.hSize, [], Clock()
    O.dt = (STEP if not case.rate else setting["time_step"]) * case.contact_time()
    length = sum(case.length(k) for k in range(len(case.legs)))
    rate = case.rate or length / (setting["steps"] * O.dt)
    O.step()  # contacts are made; at rest nothing moves
    records.append(record(start, thin))
    targets = case.targets()
    moves = [of for of, _ in targets if not of.held_Pa]
    if moves and len(moves) < len(targets):
        sys.exit(f"{case.name}: legs with and without held stresses: this script runs one kind in a case")
    if moves:
        strain_path(case, [target for _, target in targets], rate, thin, start, clock, records)
    else:
        for leg in case.legs:
            held_leg(case, leg, [target for of, target in targets if of is leg], rate, thin, start, clock, records)
    return {"seconds": clock.seconds, "steps": clock.steps, "records": records}


case = cases.Case(sys.argv[1])
with open(sys.argv[2], encoding="utf-8") as file:
    setting = json.load(file)
found = [made(case, specimen, setting) for specimen in case.specimens]
with open(sys.argv[3], "w", encoding="utf-8") as file:
    json.dump(found, file)
sys.stdout.flush()
os._exit(0)  # YADE's own end waits for its threads
