"""YADE's bridge between two spheres that are moved apart: runs inside YADE for tools/validate interactions_peers.

usage: yade -n -x -j1 interactions_bridges_yade.py JOB.json OUT.json
"""
import json
import os
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    JOB = json.load(file)


def pulls(law):
    """Force on the second sphere at each gap, N; first they touch, so that the bridge forms."""
    first, second = JOB["radii"]
    O.reset()
    O.materials.append(ViscElCapMat(kn=1e3, ks=1e3, cn=0, cs=0, frictionAngle=0.3, density=2650, Capillar=True,
                                    CapillarType=law, Vb=JOB["volume"], gamma=JOB["surface_tension"],
                                    theta=JOB["angle_deg"], dcap=0))
    O.bodies.append([sphere((0, 0, 0), first, fixed=True),
                     sphere((first + second - 1e-6 * second, 0, 0), second, fixed=True)])
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.5)]),
                 InteractionLoop([Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.5)],
                                 [Ip2_ViscElCapMat_ViscElCapMat_ViscElCapPhys()], [Law2_ScGeom_ViscElCapPhys_Basic()]),
                 NewtonIntegrator(damping=0)]
    O.dt = 1e-12
    O.step()
    O.step()
    found = []
    for gap in JOB["gaps"]:
        O.bodies[1].state.pos = Vector3(first + second + gap, 0, 0)
        O.step()
        found.append(-O.forces.f(1)[0])
    return found


with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump({law: pulls(law) for law in JOB["laws"]}, file)
sys.stdout.flush()
os._exit(0)  # YADE's own end waits for its threads
