"""The Python module against the program and against itself. Arguments: an empty folder to work in, then unittest's.

RVELAB_LIBRARY and RVELAB_PROGRAM name what is tested, PYTHONPATH the module and the examples."""
import contextlib
import ctypes
import io
import math
import os
import re
import shutil
import subprocess
import sys
import threading
import unittest
import warnings
from pathlib import Path

import element_test
import numpy as np
import rvelab
from rvelab import library as rvelab_library

folder = Path(sys.argv.pop(1)) if len(sys.argv) > 1 else Path(".")
specimen = folder / "discs.h5"
zero = np.zeros((3, 3))


def gradients(n: int, size: float, seed: int = 1) -> np.ndarray:
    """Increments in the plane, spin included."""
    drawn = np.zeros((n, 3, 3))
    drawn[:, :2, :2] = np.random.default_rng(seed).uniform(-size, size, (n, 2, 2))
    return drawn


def setUpModule() -> None:
    warnings.simplefilter("ignore", rvelab.RvelabWarning)
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([os.environ["RVELAB_PROGRAM"], "pack", "pack_dense", "-o", specimen, "--force", "--set",
                    "pack.number=64", "--set", "target.void_ratio=0.2"], check=True, capture_output=True)


class Stages(unittest.TestCase):
    """What a test makes of a specimen, a host makes of an RVE: the same bits."""

    cement = {"kind": "cement", "gap": 0.05, "young_modulus_Pa": 50e6, "tensile_strength_Pa": 2e5, "cohesion_Pa": 2e5}
    dissolve = {"kind": "dissolve", "radius_left": 0.5, "step_count": 2}

    def test_stages_are_those_of_the_program(self) -> None:
        protocol, ended = folder / "stages.toml", folder / "stages.h5"
        text = '[test]\nname = "t"\n' + rvelab.pool.stages_text([self.cement, self.dissolve])
        protocol.write_text(text)
        subprocess.run([os.environ["RVELAB_PROGRAM"], "run", protocol, "--specimen", specimen, "-o", ended, "--force"],
                       check=True, capture_output=True)
        for stages in ([self.cement, self.dissolve], text):
            rve = rvelab.Rve(specimen)
            sigma, wanted = rve.run_stages(stages), rvelab.Rve(ended)
            np.testing.assert_array_equal(sigma, wanted.sigma)
            for name in ("bonds/radius_m", "bonds/shear_force_N", "grains/position_m", "contacts/force_N"):
                np.testing.assert_array_equal(rve.array(name), wanted.array(name))
            self.assertGreater(len(rve.array("bonds/radius_m")), 0)
            dH = [[0, 1e-4, 0], [0, 0, 0], [0, 0, 0]]
            np.testing.assert_array_equal(rve.apply(dH), wanted.apply(dH))

    def test_many_at_once_and_mistakes_by_name(self) -> None:
        with rvelab.Pool() as pool:
            rves = pool.spawn(pool.template(specimen), 3)
            sigma = pool.run_stages(rves[:2], self.cement)
            self.assertEqual(sigma.shape, (2, 3, 3))
            self.assertEqual([len(pool.array(rve, "bonds/radius_m")) > 0 for rve in rves], [True, True, False])
            with self.assertRaisesRegex(rvelab.RvelabError, "young_modulus_Pa"):
                pool.run_stages(rves, {"kind": "cement"})
            with self.assertRaisesRegex(rvelab.RvelabError, "bond"):
                pool.run_stages(rves[2:], self.dissolve)
            with self.assertRaisesRegex(TypeError, "stages"):
                pool.run_stages(rves, ["cement"])


class Places(unittest.TestCase):
    """Without RVELAB_LIBRARY and PYTHONPATH."""

    def python(self, *arguments: str, **more: str) -> str:
        environment = {k: v for k, v in os.environ.items() if not k.startswith(("RVELAB_", "PYTHONPATH"))}
        return subprocess.run([sys.executable, *arguments], env=environment | more, check=True, capture_output=True,
                              text=True).stdout

    def test_an_installed_module_finds_the_library_of_its_prefix(self) -> None:
        prefix = (folder / "prefix").resolve()
        modules = prefix / "lib/python3/dist-packages"
        shutil.rmtree(prefix, ignore_errors=True)
        shutil.copytree(Path(rvelab.__file__).parent, modules / "rvelab", ignore=shutil.ignore_patterns("__pycache__"))
        (prefix / "lib/librvelab.so.1").symlink_to(os.environ["RVELAB_LIBRARY"])
        found = self.python("-c", "import rvelab.library; print(rvelab.library.library._name)", PYTHONPATH=str(modules))
        self.assertEqual(found.strip(), str(prefix / "lib/librvelab.so.1"))

    def test_the_example_finds_the_module_of_its_checkout(self) -> None:
        printed = self.python(element_test.__file__, str(specimen), "0.001", RVELAB_LIBRARY=os.environ["RVELAB_LIBRARY"])
        self.assertTrue(printed.startswith("0.0010"))


class ElementTest(unittest.TestCase):
    def test_the_example_and_the_program_give_the_same_bits(self) -> None:
        protocol = folder / "shear.toml"
        protocol.write_text('[test]\nname = "shear"\n[[stage]]\nname = "shear"\nkind = "simple_shear"\n'
                            'to_strain = 0.1\nrecord_every = 1e-4\n')
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            stresses = element_test.shear(str(specimen), 0.005)
        records = rvelab.run(protocol, specimen, **{"stage.shear.to_strain": 0.005})
        self.assertEqual(stresses.tobytes(), records["stress_Pa"].tobytes())
        self.assertEqual(len(records["strain"]), 51)
        self.assertEqual(len(printed.getvalue().splitlines()), 5)
        self.assertGreater(abs(stresses[-1, 0, 1]), 1e4)
        self.assertEqual(records.summary["end_strain"], 0.005)
        self.assertEqual(records["target_held"].dtype, np.bool_)

    def test_a_mistake_in_a_protocol_is_told_by_the_program(self) -> None:
        with self.assertRaisesRegex(rvelab.RvelabError, "nearest known key is stage.shear.to_strain"):
            rvelab.run("simple_shear", specimen, **{"stage.shear.to_stran": 0.005})


class PoolTest(unittest.TestCase):
    def setUp(self) -> None:
        self.pool = rvelab.Pool(workers=2)
        self.addCleanup(self.pool.close)
        self.template = self.pool.template(specimen)

    def test_a_batch_gives_the_bits_of_single_calls(self) -> None:
        ids, alone = self.pool.spawn(self.template, 5), self.pool.spawn(self.template, 5)
        for step in range(3):
            dH = gradients(5, 1e-3, step)
            found = self.pool.batch(ids, dH)
            for k in range(5):
                self.assertEqual(found.sigma[k].tobytes(), self.pool.apply(alone[k], dH[k]).tobytes())
        self.assertEqual(len(set(found.sigma[:, 0, 1])), 5)
        self.assertEqual([self.pool.info(k).void_ratio for k in ids], [self.pool.info(k).void_ratio for k in alone])

    def test_a_trial_is_pure_and_what_is_asked_for_changes_no_bit(self) -> None:
        (rve,) = self.pool.spawn(self.template)
        before = self.pool.snapshot(rve)
        dH = gradients(1, 1e-3)
        first = self.pool.trial(rve, dH)
        self.pool.trial(rve, 3 * dH)
        again = self.pool.trial(rve, dH, want=rvelab.MEASURES)
        self.assertEqual(first.sigma.tobytes(), again.sigma.tobytes())
        self.assertIsNone(first.tangent)
        self.assertGreater(again.tangent[0, 5, 5], 1e6)
        self.assertGreater(again.error_estimate[0], 0)
        self.assertEqual(again.contact.tobytes(), again.sigma.tobytes())  # dt = 0: no Reynolds stress
        self.pool.revert()
        fresh = self.pool.spawn(self.pool.template(before))[0]
        self.assertEqual(self.pool.info(fresh).void_ratio, self.pool.info(rve).void_ratio)
        self.pool.batch([rve, fresh], np.repeat(dH, 2, 0))
        self.assertEqual(self.pool.apply(rve, dH[0]).tobytes(), self.pool.apply(fresh, dH[0]).tobytes())

    def test_tokens_name_the_state_that_a_step_starts_from(self) -> None:
        line, committed = self.pool.spawn(self.template, 2)
        dH = gradients(4, 1e-3)
        token = self.pool.info(line).token
        for step in range(3):
            kept = self.pool.trial(line, dH[step:step + 1], tokens=token)
            self.pool.trial(line, -dH[step:step + 1], tokens=float(token))  # a line search; a token out of a double
            token = kept.tokens[0]
        last = self.pool.trial(line, dH[3:], tokens=token)
        for step in range(3):
            self.pool.apply(committed, dH[step])
        self.assertEqual(last.sigma[0].tobytes(), self.pool.apply(committed, dH[3]).tobytes())
        with self.assertRaisesRegex(rvelab.StaleToken, "valid: "):
            self.pool.trial(line, dH[3:], tokens=1)

    def test_arrays_are_not_copied_and_those_of_results_used_again(self) -> None:
        ids = self.pool.spawn(self.template, 2)
        kept = rvelab.Batch(2, ("tangent",))
        place = kept.sigma.ctypes.data, kept.tangent.ctypes.data
        found = self.pool.trial(ids, gradients(2, 1e-3), out=kept)
        self.assertIs(found, kept)
        self.assertEqual(place, (found.sigma.ctypes.data, found.tangent.ctypes.data))
        self.assertTrue(np.isfinite(found.tangent).all())
        dH = gradients(2, 1e-3)
        self.assertIs(rvelab_library.gradients_of(dH, dH.shape), dH)
        self.assertIs(rvelab_library.numbers_of(ids, "ids"), ids)

    def test_arrays_that_the_library_cannot_write_to_are_refused(self) -> None:
        ids, dH = self.pool.spawn(self.template, 4), gradients(4, 1e-4)
        good, read_only = self.pool.trial(ids, dH, want=rvelab.MEASURES), np.zeros((4, 3, 3))
        read_only.flags.writeable = False
        unaligned = np.frombuffer(bytearray(4 * 72 + 1), np.uint8)[1:].view(np.float64).reshape(4, 3, 3)
        for name, array, text in [
                ("sigma", np.zeros((4, 3, 3), np.float32), "float32"), ("sigma", np.zeros((4, 3, 3), ">f8"), ">f8"),
                ("sigma", np.zeros((4, 6, 3))[:, ::2], "not contiguous"), ("sigma", np.zeros((4, 2, 2)), r"\(4, 2, 2\)"),
                ("sigma", np.zeros((4, 3, 3), order="F"), "not contiguous"), ("sigma", read_only, "read-only"),
                ("sigma", unaligned, "not aligned"), ("sigma", [0] * 36, "allowed"), ("sigma", None, "allowed"),
                ("tangent", np.zeros((4, 3, 3)), r"\(4, 6, 6\)"), ("contact", np.zeros(4), r"\(4, 3, 3\)"),
                ("reynolds", np.zeros((3, 3, 3)), "allowed"), ("error_estimate", np.zeros(2), r"\(4,\)"),
                ("dt_scale", np.zeros(3), r"\(4,\)"), ("status", np.zeros(4, np.int64), "int32"),
                ("tokens", np.zeros(4), "int64")]:
            with self.subTest(name=name, text=text):
                out = rvelab.Batch(4, rvelab.MEASURES)
                setattr(out, name, array)
                with self.assertRaisesRegex(ValueError, f"out.{name}.*{text}"):
                    self.pool.trial(ids, dH, out=out)
        out = rvelab.Batch(4, rvelab.MEASURES)
        out.contact = out.sigma
        with self.assertRaisesRegex(ValueError, "out.(sigma and out.contact|contact and out.sigma) share memory"):
            self.pool.trial(ids, dH, out=out)
        out = rvelab.Batch(4, rvelab.MEASURES)
        out.sigma = np.zeros((8, 3, 3))[2:6]  # a part of an array of one's own
        self.assertEqual(self.pool.trial(ids, dH, out=out).sigma.tobytes(), good.sigma.tobytes())

    def test_arguments_in_the_forms_that_python_has_for_them(self) -> None:
        (rve,) = self.pool.spawn(self.template)
        self.pool.apply(rve, gradients(1, 1e-3)[0])
        bits, stress = self.pool.snapshot(rve), self.pool.info(rve).sigma
        for given in (bits, bytearray(bits), memoryview(bits), np.frombuffer(bits, np.uint8)):
            self.pool.apply(rve, gradients(1, 1e-3, 2)[0])
            self.pool.restore(rve, given)
            self.assertEqual(self.pool.snapshot(rve), bits)
            self.assertEqual(self.pool.info(self.pool.spawn(self.pool.template(given))).sigma.tobytes(), stress.tobytes())
        for wrong in ("text", None, 12):
            with self.assertRaisesRegex(TypeError, "a snapshot is bytes"):
                self.pool.restore(rve, wrong)
        one, several = (self.pool.trial(rve, zero[None], want=want) for want in ("tangent", ["tangent"]))
        self.assertEqual(one.tangent.tobytes(), several.tangent.tobytes())
        self.assertIsNone(one.contact)
        self.assertEqual(self.pool.info(float(rve)).token, self.pool.info(np.int64(rve)).token)
        self.pool.close()
        for call in (lambda: self.pool.trial(rve, zero[None]), lambda: self.pool.info(rve), self.pool.ids,
                     lambda: self.pool.template(specimen)):
            with self.assertRaisesRegex(rvelab.RvelabError, "this pool was closed"):
                call()

    def test_one_that_fails_is_told_and_the_others_are_there(self) -> None:
        ids = self.pool.spawn(self.template, 3)
        dH = gradients(3, 1e-3)
        dH[1, 0, 0] = math.nan
        spawned = self.pool.info(ids[1]).token
        with self.assertRaisesRegex(rvelab.RvelabError, "RVELAB_E_INPUT: entry 1") as caught:
            self.pool.batch(ids, dH)
        found = caught.exception.batch
        self.assertEqual(caught.exception.status, -2)
        self.assertEqual(found.status[1], -2)
        self.assertEqual((found.tokens[1], found.dt_scale[1]), (0, 0))
        self.assertTrue(np.isnan(found.sigma[1]).all())
        self.assertTrue(np.isfinite(found.sigma[[0, 2]]).all())
        self.assertEqual([self.pool.info(k).token for k in ids], [found.tokens[0], spawned, found.tokens[2]])

    def test_a_step_too_large_is_discarded_with_the_state_as_before(self) -> None:
        (rve,) = self.pool.spawn(self.template)
        pool = rvelab.Pool(workers=1, max_substeps=3)
        short = pool.spawn(pool.template(self.pool.snapshot(rve)))
        with self.assertRaises(rvelab.Discard) as caught:
            pool.trial(short, gradients(1, 1e-2))
        self.assertTrue(0 < caught.exception.batch.dt_scale[0] < 1)
        self.assertEqual(pool.info(short).void_ratio, self.pool.info(rve).void_ratio)

    def test_bad_arguments_name_what_is_allowed(self) -> None:
        (rve,) = self.pool.spawn(self.template)
        for call, text in [(lambda: self.pool.apply(rve, np.zeros((2, 2))), r"\(2, 2\); allowed: \(3, 3\)"),
                           (lambda: self.pool.trial([rve], np.zeros((2, 3, 3))), r"allowed: \(1, 3, 3\)"),
                           (lambda: self.pool.apply(1.5, zero), "single precision"),
                           (lambda: self.pool.trial(rve, zero[None], want=["stress"]), "allowed: contact, reynolds"),
                           (lambda: self.pool.trial(rve, zero[None], tokens=[1, 1]), "allowed: 1, one for each"),
                           (lambda: self.pool.trial(rve, zero[None], out=rvelab.Batch(2)), r"\(2, 3, 3\); allowed:.*\(1, 3, 3\)"),
                           (lambda: self.pool.trial(rve, zero[None], want="tangent", out=rvelab.Batch(1)), "no array"),
                           (lambda: self.pool.trial(rve, zero[None], want="stress", out=rvelab.Batch(1)), "allowed"),
                           (lambda: self.pool.trial(np.int32([rve & 0x7fffffff]), zero[None]), "int32 are cut.*int64"),
                           (lambda: self.pool.trial(np.float32([rve]), zero[None]), "float32 are cut.*int64"),
                           (lambda: self.pool.trial(None, zero[None]), "ids is None"),
                           (lambda: self.pool.release(["one"]), "whole numbers"),
                           (lambda: self.pool.apply([], zero), "no ids are given"),
                           (lambda: self.pool.apply(self.pool.spawn(self.template, 2), zero), "2 ids.*for one RVE"),
                           (lambda: self.pool.info([rve, rve]), "2 ids.*for one RVE")]:
            with self.assertRaisesRegex(ValueError, text):
                call()
        with self.assertRaisesRegex(TypeError, "no option 'worker'; allowed: workers"):
            rvelab.Pool(worker=2)
        for call, text in [(lambda: rvelab.Pool(workers=-1), "RVELAB_E_INPUT.*workers is -1"),
                           (lambda: self.pool.template(folder / "none.h5"), "RVELAB_E_FILE"),
                           (lambda: self.pool.restore(rve, b"none"), "RVELAB_E_SNAPSHOT"),
                           (lambda: self.pool.commit(rve), "RVELAB_E_NO_TRIAL"),
                           (lambda: self.pool.trial([rve, rve], np.zeros((2, 3, 3))), "RVELAB_E_DUPLICATE"),
                           (lambda: self.pool.info(12), "RVELAB_E_ID")]:
            with self.assertRaisesRegex(rvelab.RvelabError, text):
                call()

    def test_population_snapshots_and_files(self) -> None:
        first, second = self.pool.spawn(self.template, 2)
        self.pool.apply(first, gradients(1, 1e-3)[0])
        copy = self.pool.clone(first)
        self.assertEqual(sorted(self.pool.ids()), sorted([first, second, copy]))
        self.pool.restore(second, self.pool.snapshot(first))
        self.pool.write(folder / "pool.h5")
        self.assertGreater(self.pool.cost(first)[0], 0)
        dH = gradients(1, 1e-3, 2)[0]
        expected = [self.pool.apply(k, dH).tobytes() for k in (first, second, copy)]
        self.assertEqual(len(set(expected)), 1)
        self.pool.release([first, second])
        self.assertEqual(list(self.pool.ids()), [copy])
        with self.assertRaisesRegex(rvelab.RvelabError, "RVELAB_E_ID"):
            self.pool.apply(first, dH)
        self.pool.close()
        with rvelab.Pool(workers=1) as other:
            ids = other.read(folder / "pool.h5")
            self.assertEqual(sorted(ids), sorted([first, second, copy]))
            self.assertEqual([other.apply(k, dH).tobytes() for k in ids], expected)

    def test_threads_work_on_different_rves_at_once(self) -> None:
        ids, alone = self.pool.spawn(self.template, 4), self.pool.spawn(self.template, 4)
        dH = gradients(20, 1e-4)
        found = {}

        def work(rve: int) -> None:
            found[rve] = [self.pool.apply(rve, increment).tobytes() for increment in dH]

        threads = [threading.Thread(target=work, args=(rve,)) for rve in ids]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        expected = [self.pool.apply(alone[0], increment).tobytes() for increment in dH]
        self.assertEqual([found.get(rve) for rve in ids], 4 * [expected])


class RveTest(unittest.TestCase):
    def test_measures_are_attributes_in_their_shapes(self) -> None:
        rve = rvelab.Rve(specimen)
        sigma = rve.apply(zero)
        self.assertAlmostEqual(rve.p, -(sigma[0, 0] + sigma[1, 1]) / 2, delta=1e-9 * rve.p)
        self.assertEqual((rve.dimension, rve.grains, rve.lattice.shape), (2, 64, (3, 3)))
        self.assertAlmostEqual(np.trace(rve.fabric), 1)
        self.assertEqual(rve.tangent().shape, (6, 6))
        self.assertEqual(rve.bytes_trial, 0)
        with self.assertRaisesRegex(AttributeError, "voidratio"):
            rve.voidratio
        trial = rve.trial(gradients(1, 1e-3)[0])
        rve.commit()
        self.assertEqual(rve.token, trial.tokens[0])

    def test_an_rve_that_ends_leaves_neither_itself_nor_its_template_in_the_pool(self) -> None:
        with rvelab.Pool(workers=1) as pool:
            made, template = [], pool.template
            pool.template = lambda source: made.append(template(source)) or made[-1]
            with rvelab.Rve(specimen, pool) as rve:
                self.assertEqual(list(pool.ids()), [rve.id])
                rve.apply(zero)
            with self.assertRaisesRegex(rvelab.RvelabError, "RVELAB_E_ID"):
                rve.apply(zero)
            rve.close()  # once more
            rvelab.Rve(specimen, pool)  # no reference to it is left
            kept = rvelab.Rve(specimen, pool)
            self.assertEqual(list(pool.ids()), [kept.id])
            for number in made:
                with self.assertRaisesRegex(rvelab.RvelabError, "it was released"):
                    pool.spawn(number)
            pool.close()
            kept.close()  # its pool has gone before it
        own = rvelab.Rve(specimen)
        own.close()
        with self.assertRaisesRegex(rvelab.RvelabError, "was closed"):
            own.apply(zero)

    def test_the_interpreter_ends_with_pools_and_rves_alive(self) -> None:
        script = ("import sys, rvelab\n"
                  "own, pool = rvelab.Rve(sys.argv[1]), rvelab.Pool(workers=2)\n"
                  "shared = [rvelab.Rve(sys.argv[1], pool) for k in range(3)]\n"
                  "own.cycle, pool.cycle = [own, shared], [pool, shared]\n"
                  "pool.trial([rve.id for rve in shared], [[[0] * 3] * 3] * 3)\n")
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", script, specimen], capture_output=True, text=True,
                              timeout=60)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_a_warning_is_one_of_python_and_points_to_the_call(self) -> None:
        rve = rvelab.Rve(specimen, tolerance_rel=2e-3, tolerance_abs=2e-5)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("default")
            for dH in gradients(30, 1e-3):
                rve.apply(dH)
        self.assertEqual(len(told), 1)  # once for a line, though the figures differ
        self.assertEqual((told[0].category, told[0].filename), (rvelab.RvelabWarning, __file__))
        self.assertEqual(told[0].message.status, 1)
        self.assertRegex(told[0].message.detail, "expected error of [0-9.]+ Pa")

    def test_the_structs_are_those_of_the_header(self) -> None:
        header = (Path(__file__).resolve().parents[2] / "include/rvelab/rvelab.h").read_text()
        plain = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
        sizes = {"uint32_t": 4, "int32_t": 4}
        for struct, name in [(rvelab.Info, "info"), (rvelab_library.BatchStruct, "batch"),
                             (rvelab_library.Definition, "pool_def")]:
            body = plain.split(f"typedef struct rvelab_{name} {{")[1].split("}")[0]
            declared = [re.fullmatch(r"([\w ]+\*?)\s*(\b\w+)(\[9\])?", field.strip()).groups()
                        for field in body.split(";")[:-1]]
            fields = [(field, sizes.get(kind.strip(), 8) * (9 if nine else 1)) for kind, field, nine in declared]
            ours = [(field, ctypes.sizeof(kind)) for field, kind in struct._fields_]
            self.assertEqual(fields[:len(ours)], ours)


if __name__ == "__main__":
    unittest.main()
