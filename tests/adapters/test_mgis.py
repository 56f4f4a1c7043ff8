"""The behaviours of MFront's generic interface, by the client beside this file. Arguments: a folder, librvelab_umat.so."""
import os
import subprocess
import sys
import unittest
import warnings
from pathlib import Path

import numpy as np

folder, library = Path(sys.argv.pop(1)).resolve(), str(Path(sys.argv.pop(1)).resolve())
folder.mkdir(parents=True, exist_ok=True)
os.chdir(folder)
Path("rvelab_umat.log").unlink(missing_ok=True)
os.environ["RVELAB_UMAT"] = "materials.toml"
Path("materials.toml").write_text("".join(f'[[material]]\nnumber = {k}\nspecimen = "{name}.h5"\n'
                                          for k, name in enumerate(("discs", "spheres"), 1)))
for recipe, *words in (("pack_dense", "discs.h5", "pack.number=64", "target.void_ratio=0.2"),
                       ("pack_hertz", "spheres.h5", "pack.number=60", "target.void_ratio=0.62",
                        "target.void_ratio_tolerance=0.05")):
    settings = [word for setting in words[1:] for word in ("--set", setting)]
    subprocess.run([os.environ["RVELAB_PROGRAM"], "pack", recipe, "-o", words[0], "--force", *settings], check=True,
                   capture_output=True)

import rvelab  # noqa: E402
from mgis_client import (ALL, AND_SPEED, CONSISTENT_TANGENT, NO_TANGENT, PREDICTION, SIZES, Behaviour,  # noqa: E402
                         Point, matrix, symmetric)

SPECIMEN = {1: "discs.h5", 2: "spheres.h5"}
FIRST = {material: rvelab.Rve(name).sigma for material, name in SPECIMEN.items()}
TURN = np.array([[np.cos(0.2), -np.sin(0.2), 0], [np.sin(0.2), np.cos(0.2), 0], [0, 0, 1]])


def finite(material: int = 1, hypothesis: str = "PlaneStrain", measure: int = 0, tangent: int = 0, density: float = 0,
           physical: int = 0) -> Point:
    return Point(Behaviour(library, "GranularRve", hypothesis, measure, tangent), FIRST[material], [material, physical],
                 density)


def stepped(point: Point, *gradients: np.ndarray, wanted: float = CONSISTENT_TANGENT) -> Point:
    """Accepts all steps but the last."""
    for k, gradient in enumerate(gradients):
        if k > 0:
            point.update()
        point.set(gradient)
        if point.call(wanted) != 1:
            raise AssertionError(point.message)
    return point


def reference(material: int, *gradients: np.ndarray, dt: float = 0) -> tuple[np.ndarray, np.ndarray]:
    """Stress and tangent (xx yy zz yz xz xy) by the C interface."""
    pool, F = rvelab.Pool(workers=1), np.eye(3)
    rve = pool.spawn(pool.template(SPECIMEN[material]))
    for gradient in gradients:
        batch = pool.trial(rve, ((gradient - F) @ np.linalg.inv(F))[None], dt, want=("tangent",))
        pool.commit(rve)
        F = gradient
    return batch.sigma[0], batch.tangent[0]


def contracted(tangent: np.ndarray, d: np.ndarray) -> np.ndarray:
    s = tangent @ [d[0, 0], d[1, 1], d[2, 2], 2 * d[1, 2], 2 * d[0, 2], 2 * d[0, 1]]
    return np.array([[s[0], s[5], s[4]], [s[5], s[1], s[3]], [s[4], s[3], s[2]]])


# A strain that is not small for grains, after a turn; in the plane, and the same with a strain along z.
PLANE = [TURN @ (np.eye(3) + scale * np.array([[1, 2, 0], [0, -2, 0], [0, 0, 0]])) for scale in (1e-4, 2e-4)]
SPACE = [TURN @ (np.eye(3) + scale * np.array([[1, 2, 1], [0, -2, 0], [1, 0, 1]])) for scale in (1e-4, 2e-4)]
CASES = ((1, "PlaneStrain", PLANE), (1, "Tridimensional", PLANE), (2, "Tridimensional", SPACE))


class Mgis(unittest.TestCase):
    def setUp(self) -> None:
        warnings.simplefilter("ignore", rvelab.RvelabWarning)

    def close(self, found: np.ndarray, expected: np.ndarray, tolerance: float) -> None:
        self.assertLessEqual(np.linalg.norm(found - expected), tolerance * np.linalg.norm(expected))

    def test_a_host_reads_what_the_behaviours_are(self) -> None:
        for hypothesis in SIZES:
            for name, gradient, kind in (("GranularRve", "DeformationGradient", 3), ("GranularRveSmallStrain", "Strain", 1)):
                behaviour = Behaviour(library, name, hypothesis)
                self.assertEqual((behaviour.gradients, behaviour.gradient_types), ([gradient], [kind]))
                self.assertEqual((behaviour.forces, behaviour.force_types), (["Stress"], [1]))
                self.assertEqual(behaviour.blocks, ["Stress", gradient])
                self.assertEqual(behaviour.properties, ["Material", "PhysicalTime"])
                self.assertEqual((behaviour.states, behaviour.state_types), (["RveId", "RveToken"], [0, 0]))
                self.assertEqual((behaviour.external, behaviour.parameters, behaviour.functions), ([], [], []))
                self.assertEqual((behaviour.interface, behaviour.orthotropic, behaviour.energies), ("Generic", False, 0))

    def test_stress_measures_are_those_of_the_cauchy_stress_of_the_c_interface(self) -> None:
        for material, hypothesis, path in CASES:
            sigma, _ = reference(material, *path)
            sigma, F = (sigma + sigma.T) / 2, path[-1]
            J, inverse = np.linalg.det(F), np.linalg.inv(F)
            for measure, expected in enumerate((sigma, J * inverse @ sigma @ inverse.T, J * sigma @ inverse.T)):
                with self.subTest(material=material, hypothesis=hypothesis, measure=measure):
                    self.close(stepped(finite(material, hypothesis, measure), *path).stress, expected, 1e-6)

    def test_tangents_are_one_material_in_four_measures(self) -> None:
        rng = np.random.default_rng(3)
        for material, hypothesis, path in CASES:
            sigma, tangent = reference(material, *path)
            sigma, F0, F1 = (sigma + sigma.T) / 2, *path
            points = [stepped(finite(material, hypothesis, tangent=k), *path) for k in range(4)]
            n, m = points[0].behaviour.symmetric, points[0].behaviour.all
            for _ in range(3):
                dF = matrix(rng.uniform(-1, 1, m))
                if material == 1:
                    dF[2, :] = dF[:, 2] = 0  # discs take no strain along z
                l = dF @ np.linalg.inv(F1)
                spin = (l - l.T) / 2
                cauchy = contracted(tangent, (l + l.T) / 2) + spin @ sigma - sigma @ spin
                self.close(points[0].tangent @ [dF[at] for at in ALL[:m]], symmetric(cauchy, n), 1e-5)
                J = np.linalg.det(F1)
                kirchhoff = J * (np.trace(l) * sigma + cauchy)
                dL = dF @ np.linalg.inv(F0)
                self.close(points[3].tangent @ [dL[at] for at in ALL[:m]], symmetric(kirchhoff, n), 1e-5)
                # Piola's by differences of F, with the stress that the first tangent foretells.
                h = 1e-6

                def piola(turns: float) -> np.ndarray:
                    F = F1 + turns * h * dF
                    return np.linalg.det(F) * (sigma + turns * h * cauchy) @ np.linalg.inv(F).T

                first = (piola(1) - piola(-1)) / (2 * h)
                self.close(points[2].tangent @ [dF[at] for at in ALL[:m]], np.array([first[at] for at in ALL[:m]]), 1e-5)
                second = (np.linalg.solve(F1 + h * dF, piola(1)) - np.linalg.solve(F1 - h * dF, piola(-1))) / (2 * h)
                strain = (F1.T @ dF + dF.T @ F1) / 2
                self.close(points[1].tangent @ symmetric(strain, n), symmetric(second, n), 1e-5)

    def test_small_strain_is_the_exponential_of_the_increment(self) -> None:
        strain = np.array([[1e-4, 2e-4, 0], [2e-4, -3e-4, 0], [0, 0, 0]])
        for hypothesis in ("PlaneStrain", "Tridimensional"):
            point = Point(Behaviour(library, "GranularRveSmallStrain", hypothesis), FIRST[1], [1, 0])
            stepped(point, strain, 2 * strain)
            values, axes = np.linalg.eigh(strain)
            stretch = axes @ np.diag(np.exp(values)) @ axes.T
            sigma, tangent = reference(1, stretch, stretch @ stretch)
            self.close(point.stress, (sigma + sigma.T) / 2, 1e-6)
            n = point.behaviour.symmetric
            columns = [symmetric(contracted(tangent, matrix(np.eye(n)[k])), n) for k in range(n)]
            self.close(point.tangent, np.array(columns).T, 1e-5)

    def test_spheres_in_axial_symmetry(self) -> None:
        # Of a strain of 2^-12 what the start leaves of motion may still be above what the second step allows.
        path = [np.eye(3) + k * np.diag([2.0**-16, -(2.0**-14), 2.0**-15]) for k in (1, 2)]
        sigma, _ = reference(2, *path)
        self.close(stepped(finite(2, "Axisymmetrical"), *path).stress[:2, :2], (sigma + sigma.T)[:2, :2] / 2, 1e-9)
        self.assertAlmostEqual(stepped(finite(2, "Axisymmetrical"), *path).stress[2, 2], sigma[2, 2], delta=1e-4)

    def test_steps_from_the_start_of_each_have_the_bits_of_the_c_interface(self) -> None:
        # F - I of each step is exact, so that both hand the same bits in.
        point, pool = finite(), rvelab.Pool(workers=1)
        rve, none = pool.spawn(pool.template(SPECIMEN[1])), point.s0["gradients"].copy()
        for step in range(1, 31):
            dH = np.diag([step * 2.0**-18, -(2.0**-12), 0])
            for tried in (0.5, 1.5, 1):
                point.set(np.eye(3) + tried * dH)
                self.assertEqual(point.call(), 1, point.message)
            np.testing.assert_array_equal(point.s1["thermodynamic_forces"], symmetric(pool.apply(rve, dH), 4))
            point.update()
            point.s0["gradients"][:] = none
        self.assertLess(point.stress[1, 1], 2 * FIRST[1][1, 1])  # it was loaded

    def test_each_try_of_a_first_step_may_be_accepted_and_points_are_their_own(self) -> None:
        one, other = finite(), finite()
        paths = [[np.eye(3) + scale * np.diag([2.0**-13, -(2.0**-12), 0]) for scale in (first, 2)] for first in (0.5, 1.5, 1)]
        tries = []
        for path in paths:
            stepped(one, path[0])
            tries.append(one.s1["internal_state_variables"].copy())
        stepped(other, paths[-1][0])
        np.testing.assert_array_equal(other.stress, one.stress)
        found = [other.s1["internal_state_variables"][0]]
        for path, states in zip(paths, tries):
            point = finite()
            point.set(path[0])
            point.s1["internal_state_variables"][:] = states
            point.update()
            sigma, _ = reference(1, *path)
            self.close(stepped(point, path[1]).stress, (sigma + sigma.T) / 2, 1e-9)
            found.append(point.s1["internal_state_variables"][0])
        self.assertEqual(len(set(found)), 4)

    def test_a_prediction_is_the_tangent_at_the_start_and_no_step(self) -> None:
        at_start = finite(density=2000)
        at_start.set(np.eye(3) + np.diag([1e-4, -2e-4, 0]))
        before = {name: array.copy() for name, array in at_start.s1.items()}
        for wanted in (-1, -2, PREDICTION, AND_SPEED + PREDICTION):
            self.assertEqual(at_start.call(wanted), 1, at_start.message)
            for name, array in before.items():
                np.testing.assert_array_equal(at_start.s1[name], array)
        self.assertGreater(at_start.speed[0], 10)
        self.close(at_start.tangent, stepped(finite(), np.eye(3)).tangent, 1e-12)
        later = stepped(finite(), *PLANE)
        tangent = later.tangent.copy()
        later.update()
        self.assertEqual(later.call(PREDICTION), 1, later.message)
        self.close(later.tangent, tangent, 1e-9)

    def test_the_speed_of_sound_is_that_of_the_fastest_direction(self) -> None:
        for material, hypothesis, path in CASES:
            point = stepped(finite(material, hypothesis, density=2650), *path, wanted=AND_SPEED + NO_TANGENT)
            _, tangent = reference(material, *path)
            directions = np.random.default_rng(5).normal(size=(3000, 3))
            if material == 1:
                directions[:, 2] = 0
            fastest = 0
            for n in directions / np.linalg.norm(directions, axis=1)[:, None]:
                units = np.eye(3)
                acoustic = np.array([contracted((tangent + tangent.T) / 2, (np.outer(u, n) + np.outer(n, u)) / 2) @ n
                                     for u in units])
                fastest = max(fastest, np.linalg.eigvalsh((acoustic + acoustic.T) / 2)[-1])
            expected = np.sqrt(fastest * np.linalg.det(path[-1]) / 2650)
            self.assertLessEqual(point.speed[0], 1.01 * expected)
            self.assertGreaterEqual(point.speed[0], 0.999 * expected)

    def test_time_counts_where_that_is_asked_for(self) -> None:
        gradient = np.eye(3) + np.diag([0, -(2.0**-12), 0])
        point = finite(physical=1)
        point.dt = 1e-5
        sigma, _ = reference(1, gradient, dt=1e-5)
        self.close(stepped(point, gradient).stress, (sigma + sigma.T) / 2, 1e-12)
        self.assertGreater(abs(stepped(finite(), gradient).stress[1, 1] - sigma[1, 1]), 1)

    def test_a_step_that_cannot_be_made_asks_for_a_smaller_one(self) -> None:
        point = stepped(finite(), np.eye(3))
        point.update()
        before = {name: array.copy() for name, array in point.s1.items()}
        point.set(np.eye(3) + np.diag([0, -0.6, 0]))
        before["gradients"] = point.s1["gradients"].copy()
        self.assertEqual(point.call(), -1)
        self.assertTrue(0 < point.rdt[0] < 1)
        self.assertIn("RVELAB_DISCARD", point.message)
        for name, array in before.items():
            np.testing.assert_array_equal(point.s1[name], array)

    def test_what_cannot_be_is_told_with_value_and_remedy(self) -> None:
        def told(words: str, spoil: object, point: Point | None = None, wanted: float = CONSISTENT_TANGENT,
                 **missing: bool) -> None:
            point = point or finite()
            spoil(point)
            with self.subTest(words):
                self.assertEqual(point.call(wanted, **missing), -1)
                self.assertIn(words, point.message)
                self.assertLess(len(point.message), 512)
                self.assertIn(words, Path("rvelab_umat.log").read_text())

        def set_to(name: str, k: int, value: float, state: str = "s1") -> object:
            return lambda point: getattr(point, state)[name].__setitem__(k, value)

        told("the material property Material is 9; materials.toml has the materials 1, 2",
             set_to("material_properties", 0, 9))
        told("the material property Material is 1.5", set_to("material_properties", 0, 1.5))
        told("PhysicalTime is 2; allowed: 0 (quasi-static) or 1", set_to("material_properties", 1, 2))
        told("K[1] is 5; allowed: 0 (Cauchy stress)", lambda point: setattr(point.behaviour, "measure", 5))
        told("K[2] is 4; allowed: 0 (d sigma/dF)", lambda point: setattr(point.behaviour, "tangent", 4))
        told("K[0] is 40; allowed: -3 to 4", lambda point: None, wanted=40)
        told("K is null", lambda point: None, K=False)
        told("the Cauchy stress of s0 (11 22 33 12) of the first call is", set_to("thermodynamic_forces", 1, -2e5, "s0"))
        told("determinant of DeformationGradient of s1 is -1", set_to("gradients", 0, -1))
        told("RveToken is 0.5", set_to("internal_state_variables", 1, 0.5, "s0"))
        told("RVELAB_E_ID", set_to("internal_state_variables", 0, 12345, "s0"))
        told("mass_density is 0; give the density", lambda point: None, wanted=AND_SPEED)
        told("dH_zz = 0.01 in a 2D cell", set_to("gradients", 2, 1.01))


if __name__ == "__main__":
    unittest.main()
