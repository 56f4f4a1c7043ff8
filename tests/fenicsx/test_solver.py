"""Equilibrium: patch tests, convergence, increments that are cut, checkpoints, output. Argument: folder."""
import sys
import unittest
import warnings
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import stand_in
from stand_in import P, block, edges, specimen, with_law
import numpy as np
import rvelab
from dolfinx import mesh
from rvelab import fenicsx

stand_in.FOLDER = FOLDER = Path(sys.argv.pop(1))
FOLDER.mkdir(parents=True, exist_ok=True)
warnings.simplefilter("ignore")
ALL = edges("left", "right", "top", "bottom")


def held_at_its_edge(material, gradient):
    """All nodes of the boundary follow u = t gradient x."""
    solver = fenicsx.Solver(material)
    x = material.space.tabulate_dof_coordinates()
    for node in range(len(x)):
        on_edge = np.isclose(x[node, 0], (0, 1)).any() or np.isclose(x[node, 1], (0, 1.5)).any()
        for k in range(2) if on_edge else ():
            at = lambda p, node=node: np.isclose(p[0], x[node, 0]) & np.isclose(p[1], x[node, 1])  # noqa: E731
            solver.fix(at, k, lambda t, node=node, k=k: t * gradient[k] @ x[node, :2], at="points")
    return solver, x


def compressed(material, strain_rate=1.5):
    """Plane biaxial compression between smooth plates; t: axial strain."""
    solver = fenicsx.Solver(material)
    solver.fix(edges("bottom"), 1)
    solver.fix(edges("top"), 1, lambda t: -strain_rate * t)
    solver.fix(lambda x: np.isclose(x[0], 0) & np.isclose(x[1], 0), 0, at="points")
    solver.pressure(edges("left", "right"), P)
    return solver


class Patch(unittest.TestCase):
    def test_distorted_elements_keep_a_uniform_strain(self):
        gradient = np.array([[1e-4, 5e-5], [-3e-5, -2e-4]])
        for cell in (mesh.CellType.quadrilateral, mesh.CellType.triangle):
            material = fenicsx.Material(block((3, 3), cell=cell, distorted=0.25), specimen(), tolerance=1e-5)
            solver, x = held_at_its_edge(material, gradient)
            step = list(solver.march(1, 1))[-1]
            found = material.u.x.array.reshape(-1, 2)
            self.assertLess(np.abs(found - x[:, :2] @ gradient.T).max(), 2e-3 * np.abs(found).max())
            self.assertLess(np.ptp(material.sigma, axis=0).max(), 2e-3 * P)
            self.assertLess(step.residual, 1e-4)

    def test_with_an_exact_law_to_round_off(self):
        gradient = np.array([[0.1, 0.05], [-0.03, -0.2]])
        material = with_law(fenicsx.Material(block((3, 3), distorted=0.25), specimen()))
        solver, x = held_at_its_edge(material, gradient)
        solver.tolerance = 1e-11
        list(solver.march(1, 1))
        np.testing.assert_allclose(material.u.x.array.reshape(-1, 2), x[:, :2] @ gradient.T, atol=1e-10)


class Convergence(unittest.TestCase):
    def assert_quadratic(self, residuals, end):
        """Each residual below 0.5 is at most some times the square of the one before, to the end."""
        logs = np.log(residuals)
        orders = logs[1:] / logs[:-1]
        falling = [k for k in range(len(orders)) if residuals[k] < 3e-2 and residuals[k] ** 2 > end]
        self.assertTrue(falling, residuals)
        for k in falling:
            self.assertGreater(orders[k], 1.6, residuals)

    def test_it_is_quadratic_at_large_strains(self):
        material = with_law(fenicsx.Material(block(distorted=0.2), specimen()))
        solver = compressed(material)
        solver.fix(edges("top", "bottom"), 0)  # rough plates: the strain is not uniform
        solver.tolerance = 1e-12
        step = next(solver.march(0.1, 0.1))
        self.assert_quadratic(step.residuals, 1e-12)

    def test_it_reaches_the_tolerance_where_the_stiffness_is_a_million_pressures(self):
        material = with_law(fenicsx.Material(block(distorted=0.2), specimen()), shear=50e9, lame=40e9)
        step = next(compressed(material).march(1e-6, 1e-6))
        self.assertLess(step.residual, material.tolerance)

    def test_it_is_quadratic_with_rves_of_frozen_contacts(self):
        """Hertz contacts without sliding: their stiffness grows with the overlap, so that the RVE is curved but smooth."""
        file = specimen("frozen", 50, "pack_dense", **{"contact.law": "hertz_mindlin", "contact.rolling": False,
                                                       "material.poisson_ratio": 0.3})
        material = fenicsx.Material(block((1, 2), distorted=0.0), file, tolerance=1e-6, tolerance_rel=1e-4)
        for k in material.points.pool.ids():
            material.points.pool.set_parameters(k, {"material.friction_angle_deg": 85})
        solver = compressed(material)
        solver.tolerance = 1e-9
        step = next(solver.march(3e-4, 3e-4))
        self.assertEqual({material.points.pool.info(k).sliding_fraction for k in material.points.pool.ids()}, {0.0})
        self.assertLess(step.residuals[1], step.residuals[0] ** 1.5)
        self.assertLess(step.iterations, 4)

    def test_rves_that_resolve_no_more_end_the_iterations_and_it_is_said(self):
        material = fenicsx.Material(block(), [specimen(), specimen("loose", 50, "pack_loose")], tolerance_rel=1)
        solver = compressed(material)
        solver.tolerance = 2e-4  # below what the tolerance of the RVEs, 1e-3, resolves
        steps = list(solver.march(3e-3, 1e-3))
        self.assertTrue(any(step.resolved for step in steps))
        for step in steps:
            self.assertEqual(step.resolved, step.residual > 2e-4)
            self.assertLessEqual(step.residual, max(2e-4, min(step.resolution, 5 * 2e-4)))
        self.assertTrue(any("stopped at what the RVEs resolve" in line for line in fenicsx.summary(solver)))


    def test_tangents_are_asked_for_where_they_are_worth_it(self):
        """In the first trial of an increment, and after an iteration that left more than SLOW of the residual: fewer than
        in all trials (SLOW 0), to the same loads."""
        from unittest import mock
        from rvelab.fenicsx import solver as module
        loads, asked = {}, {}
        for slow in (0, module.SLOW):
            material = fenicsx.Material(block(), [specimen(), specimen("loose", 50, "pack_loose")])
            solver, told = compressed(material), []
            trial = material.points.trial
            material.points.trial = lambda dH, tangent, trial=trial, told=told: told.append(tangent) or trial(dH, tangent)
            with mock.patch.object(module, "SLOW", slow):
                steps = list(solver.march(4e-3, 5e-4))
            loads[slow], asked[slow] = solver.reaction(edges("top"))[1], sum(told)
            self.assertEqual(len(told), sum(step.trials for step in steps))
            if slow == 0:
                self.assertTrue(all(told))
        self.assertGreaterEqual(asked[module.SLOW], len(steps))
        self.assertLess(asked[module.SLOW], 0.7 * asked[0])
        self.assertAlmostEqual(loads[module.SLOW] / loads[0], 1, delta=5e-3)


class Increments(unittest.TestCase):
    def test_one_that_is_refused_is_cut_and_the_next_ones_grow(self):
        material = fenicsx.Material(block((1, 1)), specimen())
        solver = compressed(material)
        steps = []
        for step in solver.march(0.8, 0.8, least=1e-3):
            steps.append(step)
            if len(steps) == 3:
                break
        self.assertGreater(steps[0].refused, 0)
        self.assertLess(steps[0].dt, 0.8)

    def test_a_displacement_that_is_not_zero_at_the_beginning_is_applied(self):
        material = with_law(fenicsx.Material(block((1, 2)), specimen()))
        solver = fenicsx.Solver(material)
        solver.fix(edges("bottom"), 1, 2e-3)
        solver.fix(edges("top"), 1, lambda t: 3e-3 - t)
        solver.fix(lambda x: np.isclose(x[0], 0) & np.isclose(x[1], 0), 0, at="points")
        solver.pressure(edges("left", "right"), P)
        solver.tolerance = 1e-10
        x, steps = material.space.tabulate_dof_coordinates(), list(solver.march(1e-2, 5e-3))
        self.assertEqual(len(steps), 2)
        vertical = 2e-3 + (3e-3 - 1e-2 - 2e-3) * x[:, 1] / 1.5
        np.testing.assert_allclose(material.u.x.array.reshape(-1, 2)[:, 1], vertical, atol=1e-12)

    def test_a_clipped_increment_that_is_refused_is_cut(self):
        solver, tried = compressed(with_law(fenicsx.Material(block((1, 1)), specimen()))), []
        increment = solver._increment

        def refuses(dt):
            tried.append(dt)
            return (None, 0.5) if dt > 2e-3 else increment(dt)
        solver._increment = refuses
        list(solver.march(4e-3, 1.0, least=1e-4))
        np.testing.assert_allclose(tried[:2], (4e-3, 2e-3))
        solver._increment, solver.dt = increment, 1.0  # as after a checkpoint
        self.assertLessEqual(max(step.dt for step in solver.march(6e-3, 1e-3)), 1e-3 * (1 + 1e-9))

    def test_failure_under_loads_is_an_error_and_leaves_the_state_before(self):
        material = fenicsx.Material(block((1, 1)), specimen())
        solver = fenicsx.Solver(material)
        solver.fix(edges("bottom"), 1)
        solver.fix(lambda x: np.isclose(x[0], 0) & np.isclose(x[1], 0), 0, at="points")
        solver.pressure(edges("left", "right"), P)
        solver.pressure(edges("top"), lambda t: P * (1 + 5 * t))  # more than it carries
        with self.assertRaisesRegex(fenicsx.NotConverged, "the body fails under its loads"):
            for step in solver.march(1, 0.1, least=0.02):
                pass
        self.assertTrue(0 < solver.t < 1)
        self.assertLess(solver.forms.residual()[0] / solver.forms.residual()[1], 5e-3)

    def test_where_that_is_nowhere_is_an_error(self):
        solver = fenicsx.Solver(fenicsx.Material(block((1, 1)), specimen()))
        with self.assertRaisesRegex(ValueError, "true on no facets"):
            solver.pressure(lambda x: x[0] > 5, P)
        with self.assertRaisesRegex(ValueError, "component is 2; allowed: 0 to 1"):
            solver.fix(edges("top"), 2)


class Shared(unittest.TestCase):
    def test_sharing_leaves_the_load_curve_and_makes_fewer_rves(self):
        """A weight on the middle of a block: its edge stays elastic."""
        curves, made = [], []
        for share in (True, 0):
            material = fenicsx.Material(block((6, 4), size=(1.5, 1.5)), specimen(), share=share, strains="small")
            solver = fenicsx.Solver(material)
            for side in ("left", "right"):
                solver.fix(edges(side, size=(1.5, 1.5)), 0)
            solver.fix(edges("bottom"), 1)
            footing = lambda x: np.isclose(x[1], 1.5) & (x[0] < 0.26)  # noqa: E731
            solver.fix(footing, 1, lambda t: -t)
            solver.pressure(lambda x: np.isclose(x[1], 1.5) & (x[0] > 0.24), P)
            curves.append([solver.reaction(footing)[1] for step in solver.march(6e-5, 2e-5)])
            made.append(int(material.points.made.sum()))
        self.assertEqual(made[1], 96)
        self.assertTrue(0 < made[0] < 80, made)
        np.testing.assert_allclose(curves[0], curves[1], rtol=3e-3)


class Ground(unittest.TestCase):
    def test_the_family_is_in_equilibrium_under_its_weight(self):
        size = (1.0, 1.5)
        material = fenicsx.Material(block((2, 4)), specimen(), initial=fenicsx.geostatic(1.5, 20e3, 0.5, 50e3))
        solver = fenicsx.Solver(material)
        solver.fix(edges("bottom"), 1)
        solver.fix(edges("left", "right"), 0)
        solver.pressure(edges("top"), 50e3)
        solver.body_force((0, -20e3))
        list(solver.march(1, 1))
        # Moduli of 100 MPa times the height: a wrong weight would settle by 20e3 1.5^2/2/1e8 = 2e-4 m.
        self.assertLess(np.abs(material.u.x.array).max(), 2e-5)
        push = solver.reaction(edges("left"))[0]
        self.assertAlmostEqual(push / (0.5 * (50e3 * size[1] + 20e3 * size[1] ** 2 / 2)), 1, delta=0.01)


class Files(unittest.TestCase):
    def test_a_run_that_is_resumed_is_the_run(self):
        def made():
            return compressed(fenicsx.Material(block(), [specimen(), specimen("loose", 50, "pack_loose")]))
        whole = made()
        curve = [whole.reaction(edges("top"))[1] for _ in whole.march(4e-3, 5e-4)]
        first = made()
        for step in first.march(4e-3, 5e-4):
            if step.t > 1.9e-3:
                break
        fenicsx.save(first, FOLDER / "kept")
        fenicsx.save(first, FOLDER / "kept")  # again: the first one's pool files go
        self.assertEqual(len(list((FOLDER / "kept").iterdir())), 2)
        second = made()
        fenicsx.load(second, FOLDER / "kept")
        self.assertEqual(second.t, first.t)
        np.testing.assert_array_equal(second.reaction(edges("top")), first.reaction(edges("top")))
        rest = [second.reaction(edges("top"))[1] for _ in second.march(4e-3, 5e-4)]
        self.assertEqual(rest, curve[-len(rest):])
        other = compressed(fenicsx.Material(block((1, 1)), specimen()))
        with self.assertRaisesRegex(ValueError, "holds 24 points in 2D, and the mesh has 4"):
            fenicsx.load(other, FOLDER / "kept")
        with self.assertRaisesRegex(ValueError, "no checkpoint was made there"):
            fenicsx.load(other, FOLDER / "none")
        small = compressed(fenicsx.Material(block(), specimen(), strains="small"))
        with self.assertRaisesRegex(ValueError, "made with strains finite, and this material has strains small: set strains"):
            fenicsx.load(small, FOLDER / "kept")
        fenicsx.rve(FOLDER / "kept", 5, FOLDER / "five.h5")
        point = second.material.points
        rve = rvelab.Rve(FOLDER / "five.h5")
        np.testing.assert_allclose(rve.stress[:2, :2], first.material.sigma[first.material.numbers == 5][0], atol=1e-4 * P)
        self.assertTrue(point.made.all())

    def test_fields_for_paraview(self):
        import h5py
        material = fenicsx.Material(block(), specimen())
        solver, output = compressed(material), fenicsx.Output(material, FOLDER / "fields")
        for step in solver.march(1e-3, 5e-4):
            output.write(step.t)
        output.close()
        for name in ("cells", "points"):
            ElementTree.parse(FOLDER / "fields" / f"{name}.xdmf")
        with h5py.File(FOLDER / "fields/points.h5") as file:
            last, order = file["1"], np.argsort(material.numbers)
            self.assertEqual(last["rve"][:].tolist(), list(range(24)))
            np.testing.assert_allclose(last["stress_yy_Pa"][:], material.sigma[order, 1, 1])
            np.testing.assert_allclose(last["position"][:, 1], material.x[order, 1] * (1 - 1e-3), rtol=1e-6)
            e = material.points.info()["void_ratio"][order]
            np.testing.assert_allclose(last["void_ratio"][:], e)
            volume = 1 + last["volumetric_strain"][:]
            np.testing.assert_allclose((1 + e) / (1 + e[0]), volume / volume[0], rtol=1e-6)
        with h5py.File(FOLDER / "fields/cells.h5") as file:
            means = np.ravel(list(file["Function/stress_yy_Pa"].values())[-1][:])
            np.testing.assert_allclose(np.sort(means), np.sort(material.sigma[:, 1, 1].reshape(-1, 4).mean(axis=1)))


if __name__ == "__main__":
    unittest.main()
