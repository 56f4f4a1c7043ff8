"""Stress and tangent of quadrature points, and the forces of elements. Argument: folder."""
import sys
import unittest
import warnings
from pathlib import Path

import stand_in
from stand_in import FOLDER, P, block, edges, response, specimen, with_law  # noqa: F401
import numpy as np
import rvelab
from dolfinx import mesh
from mpi4py import MPI
from rvelab import fenicsx
from rvelab.fenicsx import compat, family, tensors
from rvelab.fenicsx.forms import Forms
from rvelab.fenicsx.secants import Secants

stand_in.FOLDER = Path(sys.argv.pop(1))
stand_in.FOLDER.mkdir(parents=True, exist_ok=True)
warnings.simplefilter("ignore")
H = np.array([[2e-4, 3e-4], [-1e-4, -4e-4]])


def move(material, gradient):
    """du = gradient x at the nodes."""
    d = material.d
    material.du.interpolate(lambda x: np.asarray(gradient) @ x[:d])


def random_field(material, size, seed):
    material.du.x.array[:] = size * np.random.default_rng(seed).standard_normal(len(material.du.x.array))


class Stress(unittest.TestCase):
    def test_a_uniform_strain_gives_the_stress_of_one_rve_at_every_point(self):
        file = specimen()
        for strains, gradient in (("finite", H), ("small", 0.5 * (H + H.T))):
            sigma, stiffness = response(file, gradient, 1e-3)
            for cell in (mesh.CellType.quadrilateral, mesh.CellType.triangle):
                material = fenicsx.Material(block((2, 2), cell=cell, distorted=0.2), file, strains=strains, share=0)
                move(material, H)
                self.assertEqual(material.update(), 1)
                self.assertGreater(np.abs(sigma + P * np.eye(2)).max(), 0.05 * P)
                np.testing.assert_allclose(material.sigma, np.broadcast_to(sigma, material.sigma.shape), atol=1e-10 * P)
                if strains == "small":
                    tangent = material.values()[1]
                    np.testing.assert_allclose(tangent, np.broadcast_to(stiffness, tangent.shape), rtol=1e-8, atol=1e-3)

    def test_spheres_in_a_hexahedron(self):
        file = specimen("spheres", 40, "pack_hertz")
        cube = mesh.create_unit_cube(MPI.COMM_WORLD, 1, 1, 1, mesh.CellType.hexahedron)
        gradient = np.diag([1e-4, 5e-5, -2e-4])
        gradient[0, 2] = 1e-4
        material = fenicsx.Material(cube, file, share=0)
        move(material, gradient)
        material.update()
        sigma = response(file, gradient, 1e-3)[0]
        np.testing.assert_allclose(material.sigma, np.broadcast_to(sigma, (8, 3, 3)), atol=1e-10 * P)

    def test_each_tag_has_its_specimen_and_lists_are_drawn_from(self):
        file, loose = specimen(), specimen("loose", 50, "pack_loose")
        made = block()
        tags = mesh.meshtags(made, 2, np.arange(6, dtype=np.int32), np.array([7, 7, 7, 8, 8, 8], np.int32))
        material = fenicsx.Material(made, {7: file, 8: loose}, cell_tags=tags)
        void = material.points.info()["void_ratio"]
        pool = rvelab.Pool(workers=1)
        for part, source in ((slice(0, 12), file), (slice(12, 24), loose)):
            expected = pool.info(pool.spawn(pool.template(source))[0]).void_ratio
            np.testing.assert_allclose(void[part], expected, rtol=1e-6)
        drawn = fenicsx.Material(made, [file, loose]).points.info()["void_ratio"]
        self.assertEqual(len(set(np.round(drawn, 6))), 2)
        with self.assertRaisesRegex(ValueError, "cells have the tag 8, and specimens names 7; give a specimen for each"):
            fenicsx.Material(made, {7: file}, cell_tags=tags)

    def test_a_specimen_of_another_dimension_is_refused(self):
        with self.assertRaisesRegex(ValueError, "is a specimen in 3D, and the mesh is in 2D"):
            fenicsx.Material(block(), specimen("spheres", 40, "pack_hertz"))

    def test_family_is_brought_to_the_stresses_of_the_ground(self):
        material = fenicsx.Material(block((1, 3)), specimen(), initial=fenicsx.geostatic(1.5, 20e3, 0.5, 50e3))
        vertical = -(50e3 + 20e3 * (1.5 - material.x[:, 1]))
        np.testing.assert_allclose(material.sigma[:, 1, 1], vertical, rtol=1e-3)
        np.testing.assert_allclose(material.sigma[:, 0, 0], 0.5 * vertical, rtol=1e-3)
        np.testing.assert_allclose(material.sigma[:, 0, 1], 0, atol=100)
        with self.assertRaisesRegex(ValueError, "compression .negative. at every point"):
            fenicsx.Material(block((1, 1)), specimen(), initial=lambda x: np.zeros((len(x), 2, 2)))


    def test_binned_points_are_brought_to_their_stress_but_for_those_near_that_of_the_specimen(self):
        pressure = float(np.exp(576 * family.STEP_OF_LOGARITHM))  # in the middle of a bin: its member is the specimen
        file = specimen("bin", **{"target.pressure_Pa": pressure})
        p = np.linspace(0.994, 1.006, 121) * pressure
        sigma = -p[:, None, None] * np.eye(2)
        group, _, goals = family.members(MPI.COMM_SELF, [file] * len(p), sigma, 2, dict(workers=1, tolerance_abs=1e-3))
        self.assertEqual(set(group.tolist()), {0})
        own = rvelab.Rve(file).stress[:2, :2]
        near = np.abs(own - sigma).max(axis=(1, 2)) < family.NEAR * rvelab.Rve(file).p
        self.assertTrue(0 < near.sum() < 30)
        np.testing.assert_array_equal(np.isnan(goals[:, 0, 0]), near)
        np.testing.assert_array_equal(goals[~near], sigma[~near])


class Sharing(unittest.TestCase):
    def test_points_share_an_rve_until_the_tangent_errs_by_the_tolerance(self):
        file = specimen()
        material = fenicsx.Material(block(), file, strains="small")
        shared = material.points.shared[0]
        self.assertGreater(shared.range, 1e-6)
        direction = H + H.T
        direction *= shared.range / np.linalg.norm(direction)
        move(material, 0.9 * direction)
        material.update()
        self.assertFalse(material.points.made.any())
        change = np.einsum("ijkl,kl", shared.stiffness, 0.9 * direction)
        np.testing.assert_allclose(material.sigma, np.broadcast_to(shared.sigma + change, material.sigma.shape), rtol=1e-9)
        truth = response(file, 0.9 * direction, 1e-3)[0]
        self.assertLess(np.linalg.norm(truth - shared.sigma - change), 1e-3 * P)
        material.commit()
        move(material, 0.3 * direction)  # 1.2 of the range together: an RVE each, brought there
        material.update()
        self.assertTrue(material.points.made.all())
        pool = rvelab.Pool(workers=1, tolerance_rel=0.1, tolerance_abs=1e-3)
        rve = pool.spawn(pool.template(file))
        dH = np.zeros((1, 3, 3))
        dH[0, :2, :2] = 1.2 * direction
        expected = tensors.symmetric(pool.trial(rve, dH, want=["tangent", "error_estimate"]).sigma[:, :2, :2])
        np.testing.assert_allclose(material.sigma, np.broadcast_to(expected, material.sigma.shape), atol=1e-6 * P)

    def test_its_error_is_measured(self):
        material = fenicsx.Material(block(), specimen())
        solver = fenicsx.Solver(material)
        solver.fix(edges("bottom", "top", "left", "right"), 0)
        solver.fix(edges("bottom", "left", "right"), 1)
        solver.fix(edges("top"), 1, lambda t: -t)
        list(solver.march(2e-6, 1e-6))
        from rvelab.fenicsx.summary import sharing
        count, unmade, error = sharing(solver)
        self.assertEqual((count, unmade), (24, 24))
        self.assertTrue(0 < error < 1e-3)


class Average(unittest.TestCase):
    def test_a_cosine_is_damped_as_the_equation_says_and_a_constant_is_kept(self):
        length, wave = 0.1, np.pi / 0.5
        made = mesh.create_rectangle(MPI.COMM_WORLD, [(0, 0), (1, 0.1)], (60, 2), mesh.CellType.quadrilateral)
        material = fenicsx.Material(made, specimen(), length=length)
        values = np.zeros((len(material.numbers), 2, 2))
        values[:, 0, 0], values[:, 1, 0] = 3.0, np.cos(wave * material.x[:, 0])  # no flux at both ends
        averaged = material.average(values)
        np.testing.assert_allclose(averaged[:, 0, 0], 3.0, rtol=1e-12)
        np.testing.assert_allclose(averaged[:, 1, 0], values[:, 1, 0] / (1 + (length * wave) ** 2), atol=2e-3)
        np.testing.assert_allclose(averaged[:, 0, 1], 0, atol=1e-14)

    def test_stress_of_a_wave_beside_its_average_and_none_of_a_uniform_strain(self):
        length, wave, size, share = 0.1, np.pi / 0.5, 1e-6, 0.3
        made = mesh.create_rectangle(MPI.COMM_WORLD, [(0, 0), (1, 0.1)], (60, 2), mesh.CellType.quadrilateral)
        material = fenicsx.Material(made, specimen(), length=length, stiffening=share, strains="small")
        C = material.points.shared[0].stiffness
        for k in range(1, 3):  # in two increments: it is a sum over them
            material.du.interpolate(lambda x: np.array([size / wave * np.sin(wave * x[0]), 0 * x[0]]))
            material.update()
            beside = k * size * np.cos(wave * material.x[:, 0]) * (1 - 1 / (1 + (length * wave) ** 2))
            more = material.values()[0] - material.sigma
            scale = share * C[1, 1, 0, 0]
            np.testing.assert_allclose(more[:, 1, 1], scale * beside, atol=0.06 * size * scale * k)
            material.commit()
        before = material.values()[0] - material.sigma
        move(material, size * np.eye(2))
        material.update()
        np.testing.assert_allclose(material.values()[0] - material.sigma, before, atol=1e-4)


class Forces(unittest.TestCase):
    def forms(self, material, pressed=True):
        forms = Forms(material)
        if pressed:
            forms.pressure(edges("left", "top"), 2 * P)
        forms.body_force((3e5, -2e5))
        forms.set_time(0)
        return forms

    def test_stiffness_is_the_derivative_of_the_forces(self):
        """At strains and rotations of a tenth: geometric stiffness, spin of the stress, pressure that follows."""
        for strains in ("finite", "small"):
            for degree in (1, 2):
                material = with_law(fenicsx.Material(block(distorted=0.2), specimen(), strains=strains, degree=degree))
                if strains == "finite":
                    random_field(material, 0.02, 1)
                    self.assertEqual(material.update(), 1)
                    material.commit()
                random_field(material, 0.02 if strains == "finite" else 0, 2)
                here = material.du.x.array.copy()
                forms = self.forms(material)
                material.update()
                import dolfinx.fem.petsc
                matrix = dolfinx.fem.petsc.assemble_matrix(forms.stiffness)
                matrix.assemble()
                direction = np.random.default_rng(3).standard_normal(len(here))
                given, expected = matrix.createVecs()
                given.array[:] = direction
                matrix.mult(given, expected)
                sides = []
                for sign in (1, -1):
                    material.du.x.array[:] = here + sign * 1e-6 * direction
                    material.update()
                    sides.append(sum(forms.forces()))
                difference = (sides[0] - sides[1]) / 2e-6
                scale = np.abs(expected.array).max()
                np.testing.assert_allclose(difference, expected.array, atol=(1e-6 if strains == "finite" else 2e-4) * scale)

    def test_tangent_of_rves_is_the_derivative_of_their_stress(self):
        material = fenicsx.Material(block((1, 1)), specimen(), share=0, tolerance=1e-5, tolerance_rel=1e-3)
        tangent = material.values()[1][0]
        for k, direction in enumerate(([[1, 0], [0, 0]], [[0, 0], [0, 1]], [[0, 1], [1, 0]])):
            sides = []
            for sign in (1, -1):
                move(material, sign * 1e-5 * np.array(direction))
                material.update()
                sides.append(material.values()[0][0])
            difference = (sides[0] - sides[1]) / 2e-5
            expected = np.einsum("ijkl,kl", tangent, np.array(direction, float))
            self.assertLess(np.linalg.norm(difference - expected), 0.1 * np.linalg.norm(expected), k)  # rvelab.h: 0 to 10 %

    def test_a_rigid_rotation_under_a_pressure_that_follows_makes_no_force(self):
        material = with_law(fenicsx.Material(block(distorted=0.2), specimen()))
        forms = Forms(material)
        forms.pressure(edges("left", "right", "top", "bottom"), P)
        forms.set_time(0)
        angle = 0.5
        move(material, [[np.cos(angle) - 1, -np.sin(angle)], [np.sin(angle), np.cos(angle) - 1]])
        material.update()
        inside, outside = forms.forces()
        self.assertGreater(np.abs(inside).max(), 0.1 * P)
        np.testing.assert_allclose(inside + outside, 0, atol=1e-8 * P)


class Steps(unittest.TestCase):
    def test_secants_solve_a_linear_system_whatever_the_matrix_at_hand(self):
        """As GMRES does: n unknowns take n + 1 steps to the digits of the factors, where steps with that matrix alone would
        diverge; from there each further round gains as much."""
        A, b = np.diag([1.0, 2.0, 5.0, 9.0]) + 0.3, np.array([1.0, -2.0, 0.5, 3.0])
        secants, x, reached = Secants(MPI.COMM_SELF, np.arange(4)), np.zeros(4), []
        for _ in range(15):
            residual = A @ x - b
            move, rest = secants.reduce(residual)
            step = move - rest / 3
            x = x + step
            secants.add(step, A @ x - b - residual)
            reached.append(np.linalg.norm(A @ x - b))
        self.assertLess(reached[4], 1e-3)
        self.assertLess(reached[-1], 1e-9)


class Compatibility(unittest.TestCase):
    def test_points_are_where_the_elements_have_them(self):
        for cell in (mesh.CellType.quadrilateral, mesh.CellType.triangle):
            material = fenicsx.Material(block(cell=cell, distorted=0.2), specimen())
            material.du.interpolate(lambda x: np.array([x[0] * 0 + 2, 3 * x[0] + x[1]]))
            material.u.interpolate(lambda x: np.array([x[0], x[1]]))
            from dolfinx import fem
            values = compat.evaluate(fem.Expression(material.u, compat.quadrature(material.mesh, 2)[0]), material.mesh,
                                     material.cells).reshape(-1, 2)
            np.testing.assert_allclose(material.x[:, :2], values, atol=1e-14)

    def test_without_dolfinx_the_import_says_what_to_install(self):
        import subprocess
        done = subprocess.run([sys.executable, "-c", "import sys; sys.modules['dolfinx'] = None; import rvelab.fenicsx"],
                              capture_output=True, text=True)
        self.assertIn("rvelab.fenicsx needs dolfinx, which", done.stderr.splitlines()[-1])
        self.assertIn("tools/setup fenicsx", done.stderr.splitlines()[-1])
        begun = "import sys; sys.modules['dolfinx'] = None; sys.argv[0] = '-m'; sys.orig_argv = ['python3', '-m', '{}']; "
        for program, code in (("rvelab.fenicsx", 2), ("another", 7)):  # another program, started by -m, may go on
            attempt = "try:\n import rvelab.fenicsx\nexcept ImportError:\n sys.exit(7)"
            done = subprocess.run([sys.executable, "-c", begun.format(program) + "\n" + attempt], capture_output=True, text=True)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (code, 1 if code == 2 else 0))


if __name__ == "__main__":
    unittest.main()
