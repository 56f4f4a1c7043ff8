"""YADE's half of tools/bench/shapes: runs inside YADE, which brings O, Vector3 and the engines.

usage: yade -n -x -j1 shapes_yade.py JOB.json OUT.json

The job holds rigid bodies of spheres in a periodic cell, their contact law, and the steps to go from rest.
"""
import json
import os
import sys
import time

import numpy as np

with open(sys.argv[1], encoding="utf-8") as file:
    JOB = json.load(file)


def matrix(of):
    return np.array([[of[a, b] for b in range(3)] for a in range(3)])


def build():
    O.periodic = True
    O.cell.hSize = Matrix3(*[v for row in JOB["lattice"] for v in row])
    if "young" in JOB:
        O.materials.append(FrictMat(young=JOB["young"], poisson=JOB["poisson"], frictionAngle=np.arctan(JOB["friction"])))
        stiffness, law = Ip2_FrictMat_FrictMat_MindlinPhys(), Law2_ScGeom_MindlinPhys_Mindlin()
    else:
        O.materials.append(FrictMat(frictionAngle=np.arctan(JOB["friction"])))
        stiffness = Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(matches=((0, 0, JOB["kn"]),)),
                                                    ks=MatchMaker(matches=((0, 0, JOB["kt"]),)))
        law = Law2_ScGeom_FrictPhys_CundallStrack()
    bodies = []
    for members, radii, mass, inertia in zip(JOB["x"], JOB["r"], JOB["mass"], JOB["inertia"]):
        body, ids = O.bodies.appendClumped([sphere(x, r) for x, r in zip(members, radii)], discretization=0)
        state = O.bodies[body].state
        # Axes and centre follow from the members, of equal radii and symmetric; mass and moments are those of the union.
        axes = matrix(state.ori.toRotationMatrix())
        moments = axes.T @ np.array(inertia) @ axes
        if np.abs(moments - np.diag(np.diag(moments))).max() > 1e-6 * moments.max():
            sys.exit("YADE's axes are not the principal ones")
        state.mass, state.inertia = mass, Vector3(*np.diag(moments))
        bodies.append((body, ids))
    # Arms to the middle of the overlap: the slip of rvelab.
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()], allowBiggerThanPeriod=True),
                 InteractionLoop([Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False)], [stiffness], [law]),
                 NewtonIntegrator(damping=0)]
    return bodies


def resultant(body, ids):
    """Force and torque about the centre of gravity, of the contacts of the members."""
    centre = O.bodies[body].state.pos
    force, torque = Vector3.Zero, Vector3.Zero
    for member in ids:
        force += O.forces.f(member)
        torque += O.forces.t(member) + (O.bodies[member].state.pos - centre).cross(O.forces.f(member))
    return [*force, *torque]


clumps = build()
begun = [list(O.bodies[body].state.pos) for body, _ in clumps]
O.dt = 1e-30  # a first step that goes nowhere
O.run(1, True)
forces = [resultant(*one) for one in clumps]
for one in O.bodies:
    one.state.vel = one.state.angVel = one.state.angMom = Vector3.Zero
O.dt = JOB["dt"]
begin = time.process_time()
O.run(JOB["steps"], True)
seconds = time.process_time() - begin
moved = [list(O.bodies[body].state.pos - Vector3(*first)) for (body, _), first in zip(clumps, begun)]
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump({"seconds": seconds, "forces": forces, "moved": moved}, file)
sys.stdout.flush()
os._exit(0)  # YADE's own end waits for its threads
