"""A block of getfem whose integration points are RVEs: biaxial compression by 0.2 % at small strains.

    apt-get install python3-getfem
    rvelab pack pack_dense -o S.h5 && /usr/bin/python3 tools/examples/getfem_biaxial.py S.h5

getfem keeps stress and tangent of the points as `im_data`; its assembly language takes both from there. The points
share nothing; each has an RVE of one pool. Tension is positive."""
import sys

import getfem as gf
import numpy as np
import rvelab

WIDTH, HEIGHT, STRAIN, INCREMENTS, TOLERANCE = 1.0, 2.0, 2e-3, 8, 1e-4
PAIRS = np.array([[0, 5], [5, 1]])  # rows and columns of the tangent: xx yy zz yz xz xy
P = 100e3  # Pa, the pressure of the recipe, and on the sides

mesh = gf.Mesh("cartesian", np.linspace(0, WIDTH, 3), np.linspace(0, HEIGHT, 5))
space = gf.MeshFem(mesh, 2)
space.set_fem(gf.Fem("FEM_QK(2,1)"))
rule = gf.MeshIm(mesh, gf.Integ("IM_GAUSS_PARALLELEPIPED(2,3)"))  # 2 x 2 points a cell
TOP, BOTTOM, SIDES = 1, 2, 3
faces = mesh.outer_faces()
normals = mesh.normal_of_faces(faces)
for number, there in ((TOP, normals[1] > 0.5), (BOTTOM, normals[1] < -0.5), (SIDES, abs(normals[0]) > 0.5)):
    mesh.set_region(number, faces[:, there])

model = gf.Model("real")
model.add_fem_variable("u", space)                              # the increment of displacement
at_points = gf.MeshImData(rule, -1, [2, 2])
model.add_im_data("sigma", at_points)
model.add_im_data("C", gf.MeshImData(rule, -1, [2, 2, 2, 2]))
model.add_initialized_data("p", [P])
n = at_points.nbpts()

pool = rvelab.Pool(workers=1, tolerance_rel=0.1, tolerance_abs=TOLERANCE)
rves = pool.spawn(pool.template(sys.argv[1]), n)


def trial(strain):
    """(n, 2, 2) symmetric gradients of the increment: stress and tangent of the points go to the model."""
    dH = np.zeros((n, 3, 3))
    dH[:, :2, :2] = strain
    found = pool.trial(rves, dH, want=["tangent"])
    sigma = 0.5 * (found.sigma + np.swapaxes(found.sigma, 1, 2))[:, :2, :2]
    tangent = found.tangent[:, PAIRS[:, :, None, None], PAIRS]
    for name, values in (("sigma", sigma), ("C", tangent)):     # the first index is the fastest in getfem
        model.set_variable(name, np.concatenate([each.ravel(order="F") for each in values]))
    return sigma


def update(u):
    model.set_variable("u", u)
    gradient = model.interpolation("Sym(Grad_u)", at_points).reshape(n, 2, 2)
    return trial(gradient)


def residual():
    inside = gf.asm_generic(rule, 1, "sigma:Grad_Test_u", -1, model)
    return inside + gf.asm_generic(rule, 1, "p*Normal.Test_u", SIDES, model)


vertical = lambda region: [k for k in space.basic_dof_on_region(region) if k % 2]  # noqa: E731
corner = int(space.basic_dof_from_cvid()[0][0])                 # held sideways
fixed = np.array(sorted({*vertical(TOP), *vertical(BOTTOM), corner}))
free = np.setdiff1d(np.arange(space.nbdof()), fixed)
trial(np.zeros((n, 2, 2)))
pool.commit()
for k in range(INCREMENTS):
    u, target = np.zeros(space.nbdof()), np.zeros(space.nbdof())
    target[vertical(TOP)] = -HEIGHT * STRAIN / INCREMENTS
    for iteration in range(10):
        out_of_balance = residual()
        if iteration and np.linalg.norm(out_of_balance[free]) < TOLERANCE * np.linalg.norm(out_of_balance[fixed]):
            break
        K = gf.asm_generic(rule, 2, "(C:Grad_Test2_u):Grad_Test_u", -1, model).full()
        move = target - u
        right = -out_of_balance - K[:, fixed] @ move[fixed]
        move[free] = np.linalg.solve(K[np.ix_(free, free)], right[free])
        u += move
        sigma = update(u)
    else:
        sys.exit(f"not converged in 10 iterations at strain {(k + 1) * STRAIN / INCREMENTS:.5f}: smaller increments "
                 "(INCREMENTS), or a larger TOLERANCE")
    pool.commit()
    load = -residual()[vertical(TOP)].sum() / WIDTH
    print(f"strain {(k + 1) * STRAIN / INCREMENTS:.5f}  load ratio {load / P:.4f}  iterations {iteration}  "
          f"largest difference of stresses over p {np.ptp(sigma, axis=0).max() / P:.1e}")
