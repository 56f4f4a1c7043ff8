"""YADE's half of tools/validate yade_increments: runs inside YADE, which brings O, Vector3 and the engines.

usage: yade -n -x -j1 yade_scene.py biaxial PARENT STATE STRAIN    a state of a drained biaxial test, relaxed
       yade -n -x -j1 yade_scene.py timed STATE STRAIN OUT.json    a drained biaxial test: time and records
       yade -n -x -j1 yade_scene.py increments STATE JOB.json OUT.json

PARENT and STATE name files without .particles.csv, .contacts.csv, .json: packings with their contact history, as YADE's
reference packings are.
"""
import csv
import json
import math
import os
import sys
import time

import numpy as np

RELAX_BLOCK = 25
THICKNESS = 0.1


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def build(base):
    """The packing at rest with its shear forces and rolling moments."""
    with open(base + ".json", encoding="utf-8") as file:
        meta = json.load(file)
    (ax, bx), (ay, by) = meta["hSize_columns_are_cell_vectors"]
    O.periodic = True
    O.cell.hSize = Matrix3(ax, bx, 0, ay, by, 0, 0, 0, THICKNESS)
    O.materials.append(CohFrictMat(young=meta["E_Pa"], poisson=meta["kt_over_kn"], density=meta["density"],
                                   frictionAngle=math.radians(meta["phi_deg"]), momentRotationLaw=True, isCohesive=False,
                                   alphaKr=meta["beta"], alphaKtw=0, etaRoll=meta["eta"]))
    for row in rows(base + ".particles.csv"):
        r = float(row["r"])
        body = O.bodies[O.bodies.append(sphere((float(row["x"]), float(row["y"]), THICKNESS / 2), r))]
        body.state.blockedDOFs = "zXY"
        body.state.mass = math.pi * r * r * THICKNESS * meta["density"]
        body.state.inertia = Vector3(1, 1, 1) * 0.5 * body.state.mass * r * r
    law = Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True, always_use_moment_law=True)
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()], allowBiggerThanPeriod=True),
                 InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D()], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()], [law]),
                 NewtonIntegrator(damping=0.3)]
    # In its first step a contact forgets its shear force: that step goes nowhere, and the forces are given after it.
    O.dt = 1e-30
    O.run(1, True)
    found = {(i.id1, i.id2): i for i in O.interactions}
    contacts = rows(base + ".contacts.csv")
    if len(found) != len(contacts):
        sys.exit(f"{base}: YADE finds {len(found)} contacts, the file holds {len(contacts)}")
    for row in contacts:
        first, second, sign = int(row["id1"]), int(row["id2"]), 1
        if (first, second) not in found:
            first, second, sign = second, first, -1
        contact = found[first, second]
        contact.phys.shearForce = Vector3(sign * float(row["fsx"]), sign * float(row["fsy"]), 0)
        contact.phys.moment_bending = Vector3(0, 0, sign * float(row["mz"]))
    stop()
    return meta


def stop():
    for body in O.bodies:
        body.state.vel = body.state.angVel = Vector3(0, 0, 0)


def p_wave_time_step(meta):
    """YADE's own, whose density is that of a sphere of the disc's mass: min r / sqrt(E / density)."""
    return min(math.sqrt(body.state.mass / (4 / 3 * math.pi * meta["E_Pa"] * body.shape.radius)) for body in O.bodies)


def stress():
    s = getStress()
    return [[s[0, 0], s[0, 1]], [s[1, 0], s[1, 1]]]


def relax(limit, most):
    made = 0
    while made < most:
        O.run(RELAX_BLOCK, True)
        made += RELAX_BLOCK
        if unbalancedForce() < limit:
            break
    return made


def write(base, meta):
    h = O.cell.hSize
    meta = {key: meta[key] for key in ("E_Pa", "kt_over_kn", "phi_deg", "beta", "eta", "p0_Pa", "density", "thickness_m")}
    meta.update(dim=2, hSize_columns_are_cell_vectors=[[h[0, 0], h[0, 1]], [h[1, 0], h[1, 1]]],
                stress_tension_positive_Pa=stress(), unbalanced_force_ratio=unbalancedForce())
    with open(base + ".json", "w", encoding="utf-8") as file:
        json.dump(meta, file, indent=1)
    with open(base + ".particles.csv", "w", encoding="utf-8") as file:
        file.write("id,x,y,r\n")
        for body in O.bodies:
            x = body.state.pos
            file.write(f"{body.id},{x[0]!r},{x[1]!r},{body.shape.radius!r}\n")
    with open(base + ".contacts.csv", "w", encoding="utf-8") as file:
        file.write("id1,id2,sx,sy,fn,fsx,fsy,mz\n")
        for i in O.interactions:
            if not i.isReal:
                continue
            shear, shift = i.phys.shearForce, i.cellDist
            file.write(f"{i.id1},{i.id2},{shift[0]},{shift[1]},{i.phys.normalForce.norm()!r},{shear[0]!r},{shear[1]!r},"
                       f"{i.phys.moment_bending[2]!r}\n")


def compress(meta, rate, time_step):
    """Engines of a drained biaxial test as YADE's users run one: y shortened at a rate (1/s), x held by a servo."""
    O.dt = time_step * p_wave_time_step(meta)
    newton = O.engines[-1]
    newton.damping = 0.1
    mass = sum(body.state.mass for body in O.bodies)
    servo = PeriTriaxController(goal=(-meta["p0_Pa"], -10, 0), stressMask=1, maxStrainRate=(1, rate, 0), dynCell=True,
                                mass=mass, globUpdate=1)
    O.engines = O.engines[:-1] + [servo, newton]
    return newton


def biaxial(parent, state, strain):
    """As the recorded tests: y shortened at 0.04 1/s, x held by a servo; then relaxed at fixed cell."""
    meta = build(parent)
    newton = compress(meta, 0.04, 0.8)
    height = O.cell.hSize[1, 1]
    while O.cell.hSize[1, 1] > (1 - strain) * height:
        O.run(20, True)
    O.engines = O.engines[:-2] + [newton]
    O.cell.velGrad = Matrix3.Zero
    newton.damping = 0.3
    made = relax(1e-10, 200_000)
    for _ in range(2):
        stop()
        O.run(1, True)
    stop()
    write(state, meta)
    print(f"{state}: relaxed in {made} steps to an unbalanced ratio of {unbalancedForce():.1e}")


def timed(state, strain, out):
    """At the rate and time step of the recorded tests (0.06 1/s, 0.9 of the P-wave step), records every 0.05 %."""
    meta = build(state)
    compress(meta, 0.06, 0.9)
    height, every, seconds, made, records = O.cell.hSize[1, 1], 5e-4, 0.0, 0, []
    steps = round(every / (0.06 * O.dt))
    while O.cell.hSize[1, 1] > (1 - strain) * height:
        begin = time.perf_counter()
        O.run(steps, True)
        seconds += time.perf_counter() - begin
        made += steps
        s = getStress()
        records.append([1 - O.cell.hSize[1, 1] / height, s[0, 0], s[1, 1], unbalancedForce()])
    with open(out, "w", encoding="utf-8") as file:
        json.dump({"seconds": seconds, "steps": made, "records": records}, file)


def gradient_of_step(increment, steps):
    """G with (I + G)^steps = I + dH, so that the cell ends where the increment says."""
    dxx, dxy, dyy = increment[0][0], increment[0][1], increment[1][1]
    if dxy == 0:
        return np.diag([math.expm1(math.log1p(dxx) / steps), math.expm1(math.log1p(dyy) / steps)])
    if dxx or dyy or increment[1][0]:
        raise ValueError(f"{increment}: neither along the axes nor simple shear")
    return np.array([[0, dxy / steps], [0, 0]])


def one_by_one(steps):
    for _ in range(steps):
        O.step()


class Increments:
    def __init__(self, base):
        self.meta = build(base)
        self.longest = p_wave_time_step(self.meta)
        self.scene = O.sceneToString()
        self.start = O.cell.hSize

    def restored(self, job):
        """The state from its copy. `warm`: with a first step made, which sorts all grains again."""
        O.stringToScene(self.scene)
        O.dt = job["time_step"] * self.longest
        O.engines[-1].damping = job["damping"]
        if job.get("warm"):
            O.cell.velGrad = Matrix3.Zero
            O.run(1, True)

    def set_rate(self, increment, steps):
        g = gradient_of_step(increment, steps) / O.dt
        O.cell.velGrad = Matrix3(g[0, 0], g[0, 1], 0, g[1, 0], g[1, 1], 0, 0, 0, 0)

    def applied(self, increment, job):
        """Processor time of stepping, s. `after`: steps at zero gradient; the first gives the cell the last part of the
        increment, which YADE's cell receives a step late. `warm`: step by step, which costs no thread of O.run's (0.5 ms
        a call)."""
        self.restored(job)
        run = one_by_one if job.get("warm") else lambda steps: O.run(steps, True)
        self.set_rate(increment, job["steps"])
        begin = time.process_time()
        run(job["steps"])
        if job["after"]:
            O.cell.velGrad = Matrix3.Zero
            run(job["after"])
        return time.process_time() - begin

    def expect_increment(self, increment):
        h = self.start
        for i in range(2):
            for j in range(2):
                wanted = h[i, j] + sum(increment[i][k] * h[k, j] for k in range(2))
                if abs(O.cell.hSize[i, j] - wanted) > 1e-9 * h[0, 0] * max(map(max, increment)):
                    sys.exit(f"YADE's cell did not receive the increment: {O.cell.hSize}, {wanted} wanted")

    def resolved(self, increment, steps):
        """As finely as is asked for, then at rest."""
        self.applied(increment, {"steps": steps, "after": 1, "damping": 0.3, "time_step": 0.8, "warm": True})
        self.expect_increment(increment)
        made = relax(1e-9, 100_000)
        return {"steps": steps, "relax_steps": made, "unbalanced": unbalancedForce(), "stress": stress()}

    def coupling(self, increment):
        """A call as YADE's FEMxDEM coupling makes it, part by part: processor and elapsed time, s."""
        self.restored({"damping": 0.1, "time_step": 0.8, "warm": True})
        scene = O.sceneToString()
        parts = {}

        def part(name, make):
            begin = time.process_time(), time.perf_counter()
            made = make()
            parts[name] = [time.process_time() - begin[0], time.perf_counter() - begin[1]]
            return made

        steps = max(int(1e5 * max(abs(x) for row in increment for x in row)), 2)
        part("scene from its copy", lambda: O.stringToScene(scene))
        self.set_rate(increment, steps)
        part(f"{steps} steps", lambda: O.run(steps, True))
        part("stress", stress)
        part("copy of the scene", O.sceneToString)
        return parts


    def beside(self):
        """Processor time, s, of what a trial of the coupling takes beside its steps (simDEM.py: shear2D, then
        getStressAndTangent2D): two scenes from their copies, stress and tangent, a copy."""
        self.restored({"damping": 0.1, "time_step": 0.8, "warm": True})
        scene, parts = O.sceneToString(), {}
        for name, make in (("scene", lambda: O.stringToScene(scene)), ("copy", O.sceneToString),
                           ("scene again", lambda: O.stringToScene(scene)),
                           ("stress and tangent", lambda: getStressAndTangent(symmetry=True))):
            begin = time.process_time()
            make()
            parts[name] = time.process_time() - begin
        return parts


def increments(base, job_path, out_path):
    with open(job_path, encoding="utf-8") as file:
        job = json.load(file)
    state = Increments(base)
    found = []
    for increment in job["increments"]:
        state.restored({"damping": 0.3, "time_step": 0.8, "warm": True})
        of = {"start": stress(), "resolved": [state.resolved(increment, n) for n in job.get("resolved", [])],
              "points": [], "coupling": [state.coupling(increment) for _ in range(job.get("couplings", 0))]}
        if job.get("tangent"):
            of["beside"] = state.beside()
        for point in job["points"]:
            if "only" in point and point["only"] != len(found):
                continue
            times = [state.applied(increment, point) for _ in range(job["repeats"])]
            of["points"].append({**point, "seconds": times, "stress": stress()})
        found.append(of)
    with open(out_path, "w", encoding="utf-8") as file:
        json.dump(found, file)


{"biaxial": lambda: biaxial(sys.argv[2], sys.argv[3], float(sys.argv[4])),
 "timed": lambda: timed(sys.argv[2], float(sys.argv[3]), sys.argv[4]),
 "increments": lambda: increments(*sys.argv[2:5])}[sys.argv[1]]()
sys.stdout.flush()
os._exit(0)  # YADE's own end waits for its threads
