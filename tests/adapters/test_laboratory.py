"""pack, run, calibrate and plot of the Python package, and an RVE as arrays. Arguments: a folder to work in, then
unittest's.

RVELAB_LIBRARY and RVELAB_PROGRAM name what is tested, PYTHONPATH the package."""
import copy
import os
import pickle
import shutil
import subprocess
import sys
import unittest
import warnings
from pathlib import Path

import numpy as np
import rvelab

folder = Path(sys.argv.pop(1)) if len(sys.argv) > 1 else Path(".")
specimens = {}


def setUpModule() -> None:
    warnings.simplefilter("ignore", rvelab.RvelabWarning)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, recipe, settings in [("discs", "pack_dense", {"pack.number": 64, "target.void_ratio": 0.2}),
                                   ("spheres", "pack_hertz", {"pack": {"number": 80}}),
                                   ("ellipses", "pack_bedded", {"pack.number": 40})]:
        specimens[name] = rvelab.pack(recipe, folder / f"{name}.h5", settings)


class Arrays(unittest.TestCase):
    def test_the_stress_is_the_sum_of_forces_and_branches(self) -> None:
        for name, specimen in specimens.items():
            with self.subTest(name):
                rve = rvelab.Rve(specimen)
                rve.apply([[1e-4, 2e-4, 0], [0, -2e-4, 0], [0, 0, 0]])
                contacts = rve.contacts
                force = contacts.normal_force[:, None] * contacts.normal + contacts.tangential_force
                love = -np.einsum("ci,cj->ij", force, contacts.branch) / rve.volume
                # Strain waits for the next sub-step: its share of the stress is bounded by the absolute tolerance.
                self.assertLess(np.abs(love - rve.stress).max(), 1e-3 * rve.p)
                self.assertGreater(abs(rve.stress[0, 1]), 0.01 * rve.p)

    def test_grains_lie_in_the_cell_and_touch_where_there_is_a_contact(self) -> None:
        rve = rvelab.Rve(specimens["spheres"])
        self.assertEqual((rve.positions.shape, rve.radii.shape), ((80, 3), (80,)))
        parts = np.linalg.solve(rve.rotation @ rve.lattice, rve.positions.T)
        self.assertLess(np.abs(parts).max(), 0.5 + 1e-12)
        solid = np.sum(4 / 3 * np.pi * rve.radii**3)
        self.assertAlmostEqual(rve.volume / solid - 1, rve.void_ratio, places=12)
        contacts = rve.contacts
        overlap = rve.radii[contacts.first] + rve.radii[contacts.second] - np.linalg.norm(contacts.branch, axis=1)
        self.assertTrue((overlap[contacts.normal_force > 0] > 0).all())
        np.testing.assert_allclose(np.linalg.norm(contacts.normal, axis=1), 1, atol=1e-14)
        self.assertLess(np.abs(np.einsum("ci,ci->c", contacts.normal, contacts.tangential_force)).max(),
                        1e-12 * contacts.normal_force.max())

    def test_parameters_that_are_set_are_those_of_the_test_that_a_protocol_overrides(self) -> None:
        dH = [[0, 2e-4, 0], [0, 0, 0], [0, 0, 0]]
        rve, other = rvelab.Rve(specimens["discs"]), rvelab.Rve(specimens["discs"])
        before = rve.parameters()
        self.assertEqual(before["material"][0]["name"], "sand")
        rve.set_parameters({"material.friction": 0.1, "solver": {"relative_tolerance": 1e-3}})
        after = rve.parameters()
        self.assertEqual((after["material"][0]["friction"], after["solver"]["relative_tolerance"]), (0.1, 1e-3))
        before["material"][0]["friction"], before["solver"]["relative_tolerance"] = 0.1, 1e-3
        self.assertEqual(after, before)
        other.set_parameters(after)
        np.testing.assert_array_equal(rve.apply(dH), other.apply(dH))
        with self.assertRaisesRegex(rvelab.RvelabError, "friction"):
            rve.set_parameters({"material.frictoin": 0.1})
        self.assertEqual(rve.parameters(), after)

    def test_arrays_are_those_of_the_state_and_the_callers_own(self) -> None:
        rve = rvelab.Rve(specimens["discs"])
        before = rve.positions
        before[:] = 0
        self.assertGreater(np.abs(rve.positions).max(), 0)
        first = rve.positions
        rve.apply([[0, 1e-3, 0], [0, 0, 0], [0, 0, 0]])
        self.assertGreater(np.abs(rve.positions - first).max(), 0)

    def test_arrays_are_listed_with_unit_and_shape(self) -> None:
        for name, specimen in specimens.items():
            with self.subTest(name):
                rve = rvelab.Rve(specimen)
                arrays = rve.arrays()
                self.assertEqual("grains/semi_major_m" in arrays, name == "ellipses")
                for key, about in arrays.items():
                    self.assertEqual(rve.array(key).shape, about.shape())
                self.assertEqual(rve.array("contacts/i").dtype, np.int64)
                self.assertEqual(arrays["grains/position_m"].unit, b"m")
                self.assertAlmostEqual(float(rve.array("void_ratio")), rve.void_ratio, places=14)
                np.testing.assert_array_equal(rve.stress, rve.sigma)
                with self.assertRaisesRegex(rvelab.RvelabError, "grains/radius_m"):
                    rve.array("grains/radius")

    def test_a_drained_biaxial_test_by_held_steps_has_the_bits_of_run(self) -> None:
        (folder / "consolidate.toml").write_text('[test]\nname = "c"\ndimension = 2\npressure_Pa = 20e3\n[[stage]]\n'
                                                 'kind = "isotropic"\nshear = "zero_strain"\n')
        (folder / "compress.toml").write_text('[test]\nname = "c"\ndimension = 2\npressure_Pa = 20e3\n[[stage]]\n'
                                              'kind = "compression"\nto_strain = 0.005\nrecord_every = 0.0005\n')
        rvelab.run(folder / "consolidate.toml", specimens["discs"], output=folder / "C.h5")
        records = rvelab.run(folder / "compress.toml", folder / "C.h5", output=folder / "D.h5")
        rve, deformation = rvelab.Rve(folder / "C.h5"), np.eye(3)
        self.assertEqual(len(records["strain"]), 11)
        for strain, stress in zip(records["strain"][1:], records["stress_Pa"][1:]):
            dH = np.zeros((3, 3))
            dH[1, 1] = (1 - strain) / deformation[1, 1] - 1
            step = rve.apply_held(dH, {"xx": -20e3})
            deformation = (np.eye(3) + step.dH[0]) @ deformation
            self.assertEqual(step.sigma[0].tobytes(), np.ascontiguousarray(stress).tobytes())
        with self.assertRaisesRegex(ValueError, "zz"):
            rve.apply_held(dH, {"zz": -20e3})
        self.assertLessEqual(abs(rve.relax(1e-4)[0, 0] + 20e3), 0.05 * 20e3)

    def test_the_stress_leaves_a_trial_pending(self) -> None:
        rve = rvelab.Rve(specimens["discs"])
        before = rve.stress
        trial = rve.trial([[0, 1e-3, 0], [0, 0, 0], [0, 0, 0]])
        self.assertEqual(rve.stress.tobytes(), before.tobytes())
        rve.commit()
        self.assertEqual(rve.token, trial.tokens[0])
        self.assertAlmostEqual(rve.p, -np.trace(rve.stress) / 2, delta=1e-9 * rve.p)
        self.assertEqual(len(rve.pool.ids()), 1)

    def test_pickle_and_copy_go_on_with_the_same_bits(self) -> None:
        rve = rvelab.Rve(specimens["discs"])
        dH = [[0, 1e-3, 0], [0, -1e-3, 0], [0, 0, 0]]
        rve.apply(dH)
        twins = pickle.loads(pickle.dumps(rve)), copy.deepcopy(rve), rvelab.Rve(rve.snapshot())
        expected = rve.apply(dH).tobytes()
        self.assertEqual([twin.apply(dH).tobytes() for twin in twins], [expected] * 3)

    def test_two_lines_say_what_it_is_and_dir_names_what_it_has(self) -> None:
        rve = rvelab.Rve(specimens["discs"])
        self.assertEqual(len(repr(rve).splitlines()), 2)
        self.assertIn("64 grains, 2D", repr(rve))
        self.assertIn(f"void ratio {rve.void_ratio:.4f}", repr(rve))
        for name in ("void_ratio", "fabric", "positions", "contacts", "apply", "stress"):
            self.assertIn(name, dir(rve))
        for name in dir(rve):
            getattr(rve, name)
        rve.close()
        self.assertIn("closed", repr(rve))


class Laboratory(unittest.TestCase):
    short = {"test.pressure_Pa": 50e3, "stage.compression.to_strain": 0.02}

    def test_an_rve_is_a_specimen_and_stays_as_it_is(self) -> None:
        rve = rvelab.Rve(specimens["discs"])
        before = rve.snapshot()
        by_file = rvelab.run("biaxial", specimens["discs"], self.short)
        by_rve = rvelab.run("biaxial", rve, {"test": {"pressure_Pa": np.float64(50e3)},
                                             "stage": {"compression": {"to_strain": 0.02}}})
        self.assertEqual(by_file["stress_Pa"].tobytes(), by_rve["stress_Pa"].tobytes())
        self.assertEqual(rve.snapshot(), before)
        self.assertEqual(by_rve["stress_Pa"].shape, (41, 3, 3))
        # Records as specimen: the test goes on where it ended.
        further = rvelab.run("simple_shear", by_rve, {"stage.shear.to_strain": 1e-3})
        self.assertLess(np.abs(further["stress_Pa"][0] - by_rve["stress_Pa"][-1]).max(), 1e-3 * 50e3)

    def test_progress_is_told_while_the_test_runs(self) -> None:
        moments = []
        records = rvelab.run("biaxial", specimens["discs"], {"stage.compression.to_strain": 0.15,
                                                            "stage.compression.record_every": 3e-5},
                             progress=moments.append)
        made = [moment.records for moment in moments]
        self.assertEqual(made, sorted(made))
        self.assertEqual(made[-1], len(records["strain"]))
        self.assertGreater(len(moments), 1, "the test took less than the time between two readings")
        for moment in moments:
            self.assertEqual(moment.strain, records["strain"][moment.records - 1])
            self.assertEqual(moment.stage, records["stage"][moment.records - 1])

    def test_files_are_kept_where_asked_for_and_else_vanish_with_the_records(self) -> None:
        kept = rvelab.run("biaxial", specimens["discs"], self.short, output=folder / "kept.h5")
        self.assertEqual(kept.file, folder / "kept.h5")
        with self.assertRaisesRegex(rvelab.RvelabError, "--force"):
            rvelab.run("biaxial", specimens["discs"], self.short, output=folder / "kept.h5")
        rvelab.run("biaxial", specimens["discs"], self.short, output=folder / "kept.h5", overwrite=True)
        records = rvelab.run("biaxial", specimens["discs"], self.short)
        file = records.file
        self.assertTrue(file.exists())
        del records
        self.assertFalse(file.exists())

    def test_pack_makes_as_many_as_asked_for(self) -> None:
        made = rvelab.pack("pack_dense", folder / "several.h5", {"pack.number": 36, "target.void_ratio": 0.2}, count=2)
        self.assertEqual([path.name for path in made], ["several_1.h5", "several_2.h5"])
        angles = [rvelab.calibrate("biaxial", path, [20e3], {"stage.compression.to_strain": 0.05})["friction_angle_deg"]
                  for path in made]
        both = rvelab.calibrate("biaxial", [made[0], rvelab.Rve(made[1])], [20e3], {"stage.compression.to_strain": 0.05},
                                output=folder / "both")
        self.assertAlmostEqual(both["friction_angle_mean_deg"], np.mean(angles), places=6)
        self.assertAlmostEqual(both["friction_angle_standard_error_deg"], abs(angles[0] - angles[1]) / 2, places=6)
        self.assertEqual(len(list((folder / "both").glob("R_*.h5"))), 2)

    def test_a_setting_that_is_none_names_itself(self) -> None:
        with self.assertRaisesRegex(rvelab.RvelabError, "test.presure_Pa"):
            rvelab.run("biaxial", specimens["discs"], {"test.presure_Pa": 1})
        with self.assertRaisesRegex(TypeError, "allowed: numbers"):
            rvelab.run("biaxial", specimens["discs"], {"test.pressure_Pa": object()})


ENSEMBLE = b"--against" in subprocess.run([os.environ["RVELAB_PROGRAM"], "run", "--help"], capture_output=True).stdout


@unittest.skipUnless(ENSEMBLE, "this program runs one specimen at a time")
class Ensemble(unittest.TestCase):
    def test_the_summary_of_several_specimens_is_that_of_single_tests(self) -> None:
        made = rvelab.pack("pack_dense", folder / "group.h5", {"pack.number": 36, "target.void_ratio": 0.2}, count=3)
        settings = {"stage.compression.to_strain": 0.04}
        found = rvelab.ensemble("biaxial", made, settings, output=folder / "group")
        alone = [rvelab.run("biaxial", path, settings).summary["peak_friction_angle_deg"] for path in made]
        (row,) = [row for row in found["summary"] if row["measure"] == "friction_angle_deg"]
        self.assertEqual(row["n"], 3)
        self.assertAlmostEqual(row["mean"], np.mean(alone), places=5)
        self.assertAlmostEqual(row["standard_deviation"], np.std(alone, ddof=1), places=5)


FIT = subprocess.run([os.environ["RVELAB_PROGRAM"], "fit", "--help"], capture_output=True).returncode == 0


@unittest.skipUnless(FIT, "this program has no subcommand fit")
class Fit(unittest.TestCase):
    def test_a_fit_is_that_of_the_program_and_is_drawn(self) -> None:
        short = {"stage.compression.to_strain": 0.04}
        found = rvelab.fit("biaxial", {"material.friction": (0.1, 0.9)}, {"friction_angle_deg": (30, 2)},
                           specimens=[specimens["discs"]], same_specimens=True, tests=8, settings=short, output=folder / "fit")
        (parameter,) = found["parameters"]
        self.assertEqual(parameter["key"], "material.friction")
        self.assertTrue(0.1 <= parameter["low_95"] < parameter["mean"] < parameter["high_95"] <= 0.9)
        self.assertEqual((len(found["tests"]), found["same_specimens"]), (8, True))
        rvelab.plot("fit", folder / "fit", output=folder / "fit.svg")
        swept = rvelab.fit("biaxial", {"material.friction": (0.2, 0.6, 2)}, specimens=specimens["discs"], settings=short,
                           output=folder / "sweep")
        self.assertEqual([point["material.friction"] for point in swept["sweep"]], [0.2, 0.6])
        rvelab.plot("fit", folder / "sweep", output=folder / "sweep.svg")


class Figures(unittest.TestCase):
    def test_a_figure_is_shown_saved_and_of_the_format_asked_for(self) -> None:
        records = rvelab.run("biaxial", specimens["discs"], {"stage.compression.to_strain": 0.06})
        picture = rvelab.plot("stress_strain", records)
        self.assertTrue(picture._repr_mimebundle_()["image/png"].startswith(b"\x89PNG"))
        picture.save(folder / "saved.png")
        self.assertTrue((folder / "saved.png").read_bytes().startswith(b"\x89PNG"))
        with self.assertRaisesRegex(ValueError, "output="):
            picture.save(folder / "saved.pdf")
        rvelab.plot("mohr", [records, records.file], output=folder / "mohr.pdf")
        self.assertTrue((folder / "mohr.pdf").read_bytes().startswith(b"%PDF"))
        vector = rvelab.plot("rose", rvelab.Rve(specimens["ellipses"]), of="orientations", output=folder / "rose.svg")
        self.assertIn("<svg", vector._repr_mimebundle_()["image/svg+xml"])
        for name in ("chains", "rose"):
            rvelab.plot(name, [rvelab.Rve(specimens["spheres"])])

    def test_mistakes_name_what_is_allowed(self) -> None:
        with self.assertRaisesRegex(ValueError, "allowed: bonds, chains.* volumetric"):
            rvelab.plot("records", specimens["discs"])
        with self.assertRaisesRegex(rvelab.RvelabError, "not a record file"):
            rvelab.plot("stress_strain", specimens["discs"])


if __name__ == "__main__":
    unittest.main()
