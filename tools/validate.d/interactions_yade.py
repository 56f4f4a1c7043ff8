"""YADE's half of tools/validate interactions_peers and of tools/bench/interactions: runs inside YADE, which brings O,
Vector3 and the engines.

usage: yade -n -x -j1 interactions_yade.py JOB.json OUT.json

The job holds a packing in a cubic cell, its bonds, and what to do with it: `forces` at small strains, a `curve` to
breaking, or `times` of increments.
"""
import json
import os
import sys
import time

with open(sys.argv[1], encoding="utf-8") as file:
    JOB = json.load(file)


def build():
    """Grains, and between those that the job names CohFrict contacts that are bonds without force."""
    edge, reach = JOB["edge"], JOB["reach"]
    O.periodic = True
    O.cell.hSize = Matrix3(edge, 0, 0, 0, edge, 0, 0, 0, edge)
    # Bonds get their own numbers below; until then nothing may break.
    O.materials.append(CohFrictMat(young=1e9, poisson=0.4, density=JOB["density"], frictionAngle=0, isCohesive=True,
                                   momentRotationLaw=True, normalCohesion=1e30, shearCohesion=1e30, alphaKr=1,
                                   alphaKtw=1, etaRoll=-1, etaTwist=-1))
    for x, r in zip(JOB["x"], JOB["r"]):
        O.bodies.append(sphere(x, r))
    box = Bo1_Sphere_Aabb(aabbEnlargeFactor=reach)
    # Without "ratcheting avoided" arms are those to the middle of gap or overlap, and no slip is scaled.
    meet = Ig2_Sphere_Sphere_ScGeom6D(interactionDetectionFactor=reach, avoidGranularRatcheting=False)
    law = Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True, always_use_moment_law=False)
    cement = Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True)
    O.engines = [ForceResetter(), InsertionSortCollider([box], allowBiggerThanPeriod=True),
                 InteractionLoop([meet], [cement], [law]),
                 NewtonIntegrator(damping=0.3)]
    O.dt = 1e-30  # a first step that goes nowhere finds the pairs
    O.run(1, True)
    cement.setCohesionNow = False  # else the next step gives all bonds the strength of the material
    box.aabbEnlargeFactor = meet.interactionDetectionFactor = 1
    bond_of = {pair: k for k, pair in enumerate(zip(JOB["i"], JOB["j"]))}
    found = {tuple(sorted((c.id1, c.id2))): c for c in O.interactions if c.isReal}
    if not set(bond_of) <= set(found):
        sys.exit(f"YADE finds {len(found)} pairs, not all of the {len(bond_of)} bonds")
    for pair in set(found) - set(bond_of):
        O.interactions.erase(*pair)
    for pair, k in bond_of.items():
        contact, phys = found[pair], found[pair].phys
        phys.unp = contact.geom.penetrationDepth
        phys.kn, phys.ks, phys.kr, phys.ktw = (JOB[name][k] for name in ("kA", "sA", "kI", "sJ"))
        phys.cohesionBroken, phys.fragile, phys.momentRotationLaw = False, True, True
        phys.normalAdhesion, phys.shearAdhesion = JOB["tension"][k], JOB["shear"][k]
        phys.shearForce = phys.moment_bending = phys.moment_twist = phys.normalForce = Vector3.Zero
    for body in O.bodies:
        body.state.vel = body.state.angVel = Vector3.Zero
    return O.sceneToString()


def load(strain, steps):
    """At a constant rate, cells being multiplied by it in each step."""
    O.dt = JOB["dt"]
    O.cell.velGrad = Matrix3(*[strain * value / (steps * O.dt) for row in JOB["dH"] for value in row])
    O.run(steps, True)


def stress():
    s = getStress()
    return [[s[a, b] for b in range(3)] for a in range(3)]


def forces():
    """On the grain of the larger id, in the order of the job's bonds."""
    found = {}
    for c in O.interactions:
        sign = 1 if c.id1 < c.id2 else -1
        force, moment = c.phys.normalForce + c.phys.shearForce, c.phys.moment_bending + c.phys.moment_twist
        found[tuple(sorted((c.id1, c.id2)))] = [sign * f for f in (*force, *moment)]
    return [found[pair] for pair in zip(JOB["i"], JOB["j"])]


def small_strains(scene):
    out = []
    for strain in JOB["strains"]:
        O.stringToScene(scene)
        load(strain, 2000)
        O.cell.velGrad = Matrix3.Zero
        made = 2000
        while made < 20000 and (made == 2000 or unbalancedForce() > 1e-11):
            O.run(200, True)
            made += 200
        out.append({"forces": forces(), "unbalanced": unbalancedForce(), "steps": made})
    return out


def curve(scene):
    O.stringToScene(scene)
    records = []
    for k in range(JOB["records"]):
        load(JOB["strain"] / JOB["records"], JOB["steps"] // JOB["records"])
        intact = sum(1 for c in O.interactions if c.isReal and not c.phys.cohesionBroken)
        records.append([O.cell.hSize[2, 2] / JOB["edge"] - 1, stress()[2][2], len(JOB["i"]) - intact])
    return records


def times(scene):
    """Processor time and stress of the increment in so many steps."""
    out = []
    for steps in JOB["ladder"]:
        O.stringToScene(scene)
        load(0, 1)  # the first step sorts all grains again
        begin = time.process_time()
        load(JOB["strain"], steps)
        out.append({"steps": steps, "seconds": time.process_time() - begin, "stress": stress()})
    return out


answer = {"forces": small_strains, "curve": curve, "times": times}[JOB["what"]](build())
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump(answer, file)
sys.stdout.flush()
os._exit(0)  # YADE's own end waits for its threads
