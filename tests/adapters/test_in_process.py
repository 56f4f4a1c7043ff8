"""The Python module in processes as users have them: Ctrl-C, warnings made errors, copies, forks, embedded interpreters.
Arguments: a folder with discs.h5, then unittest's. RVELAB_LIBRARY and RVELAB_PROGRAM name what is tested."""
import asyncio
import copy
import multiprocessing
import os
import pickle
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest
import unittest.mock
import warnings
from pathlib import Path
from typing import Any, Callable

import numpy as np
import rvelab

folder = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(".").resolve()
specimen = folder / "discs.h5"
large = np.array([[0, 0.3, 0], [0.1, -0.2, 0], [0, 0, 0]])
small = np.array([[0, 1e-4, 0], [0, 0, 0], [0, 0, 0]])
endless = 'kind = "relax"\nunbalanced = 1e-300\nmax_steps = 1000000000\n'


def setUpModule() -> None:
    warnings.simplefilter("ignore", rvelab.RvelabWarning)


class CtrlC(unittest.TestCase):
    def seconds(self, call: Callable[[], Any], after: float = 0.2) -> float:
        """From a SIGINT that comes while call() is at work to its KeyboardInterrupt."""
        sent: list[float] = []

        def send() -> None:
            time.sleep(after)
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=send)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            try:
                call()
            finally:
                thread.join()
        return time.monotonic() - sent[0]

    def long_calls(self, pool: rvelab.Pool, ids: np.ndarray) -> dict[str, Callable[[], Any]]:
        """None of them ends within a minute."""
        rows = np.zeros((1, 3, 3, 3))
        for k, (i, j) in enumerate(((0, 0), (1, 1), (0, 1))):
            rows[0, k, i, j] = rows[0, k, j, i] = 1 if i == j else 0.5
        gradients = np.repeat(large[None], len(ids), 0)
        return {
            "relax": lambda: pool.relax(ids[0], 1e-300, 10**9),
            "apply": lambda: pool.apply(ids[0], large),
            "trial": lambda: pool.trial(ids, gradients),
            "batch": lambda: pool.batch(ids, gradients),
            "apply_mixed": lambda: pool.apply_mixed(ids[0], rows, 0 * rows, [[0.1, -0.2, 0.4]], np.ones((1, 3))),
            "run_stages": lambda: pool.run_stages(ids, "[[stage]]\n" + endless),
        }

    def test_ends_every_long_call_and_the_rves_are_as_before(self) -> None:
        for workers in (1, 3):
            with rvelab.Pool(workers=workers, tolerance_rel=1e-7, tolerance_abs=1e-9, max_substeps=10**9) as pool:
                ids = pool.spawn(pool.template(specimen), 3)
                pool.relax(ids[0], 1e-3)
                before = [pool.snapshot(rve) for rve in ids]
                for name, call in self.long_calls(pool, ids).items():
                    with self.subTest(call=name, workers=workers):
                        self.assertLess(self.seconds(call), 1)
                        self.assertEqual([pool.snapshot(rve) for rve in ids], before)

    def test_the_rve_goes_on_with_the_bits_of_one_that_was_not_disturbed(self) -> None:
        disturbed, alone = rvelab.Rve(specimen, counted_ids=True), rvelab.Rve(specimen, counted_ids=True)
        self.assertLess(self.seconds(lambda: disturbed.relax(1e-300, 10**9)), 1)
        for rve in (disturbed, alone):
            rve.apply(small)
        self.assertEqual(disturbed.snapshot(), alone.snapshot())

    def test_a_handler_of_ones_own_runs_when_the_call_has_ended(self) -> None:
        rve, alone, seen = rvelab.Rve(specimen, counted_ids=True), rvelab.Rve(specimen, counted_ids=True), []
        before = signal.signal(signal.SIGINT, lambda *_: seen.append(1))
        try:
            timer = threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                rve.relax(1e-300, 20_000)
            timer.join()
            time.sleep(0.01)
        finally:
            signal.signal(signal.SIGINT, before)
        alone.relax(1e-300, 20_000)
        self.assertEqual(seen, [1])
        self.assertEqual(rve.snapshot(), alone.snapshot())

    def test_descriptors_of_event_loops_get_their_signals_and_their_place_back(self) -> None:
        theirs, ours = socket.socketpair()
        ours.setblocking(False)
        theirs.settimeout(5)
        rve = rvelab.Rve(specimen)
        before = signal.set_wakeup_fd(ours.fileno())
        time.sleep(0.01)
        try:
            self.assertLess(self.seconds(lambda: rve.relax(1e-300, 10**9)), 1)
            self.assertEqual(theirs.recv(1), bytes([signal.SIGINT]))
            self.assertEqual(signal.set_wakeup_fd(-1), ours.fileno())
        finally:
            signal.set_wakeup_fd(before)
            theirs.close()
            ours.close()

        async def at_work() -> None:  # a loop that takes the descriptor, and leaves none behind
            loop = asyncio.get_running_loop()
            loop.add_signal_handler(signal.SIGUSR1, lambda: None)
            loop.remove_signal_handler(signal.SIGUSR1)

        asyncio.run(at_work())
        time.sleep(0.01)
        self.assertLess(self.seconds(lambda: rve.relax(1e-300, 10**9)), 1)

    def test_reaches_calls_of_a_forked_process_too(self) -> None:
        rve = rvelab.Rve(specimen)
        rve.apply(small)
        told, tell = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                own = rvelab.Rve(specimen)
                os.write(tell, b"1")
                own.relax(1e-300, 10**9)
            except KeyboardInterrupt:
                os._exit(7)
            finally:
                os._exit(1)
        os.read(told, 1)
        time.sleep(0.2)
        os.kill(child, signal.SIGINT)
        begin = time.monotonic()
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 7)
        self.assertLess(time.monotonic() - begin, 1)
        rve.apply(small)  # nothing of it came here

    def test_ends_commands_of_the_program(self) -> None:
        text = f'[test]\nname = "t"\n[[stage]]\n{endless}'
        (folder / "endless.toml").write_text(text)
        self.assertLess(self.seconds(lambda: rvelab.run(folder / "endless.toml", specimen), 0.5), 1.5)
        many = {"pack.number": 5000}
        self.assertLess(self.seconds(lambda: rvelab.pack("pack_dense", folder / "many.h5", many), 0.5), 1.5)
        self.assertFalse((folder / "many.h5").exists())


class WarningsAsErrors(unittest.TestCase):
    """A warning that a filter makes an error says what the state is, and holds what the call gave."""

    def setUp(self) -> None:
        self.pool, self.alone = (rvelab.Pool(counted_ids=True, workers=1, tolerance_rel=1e-9, tolerance_abs=1e-9,
                                             max_substeps=10**6) for _ in range(2))
        for pool in (self.pool, self.alone):
            self.addCleanup(pool.close)
        self.ids, self.twins = (pool.spawn(pool.template(specimen), 2) for pool in (self.pool, self.alone))
        self.gradients = np.repeat(small[None], 2, 0)

    def raised(self, call: Callable[[], Any]) -> rvelab.RvelabWarning:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(rvelab.RvelabWarning) as caught:
                call()
        self.assertIsNotNone(caught.exception.status)
        return caught.exception

    def same(self) -> bool:
        return all(self.pool.snapshot(a) == self.alone.snapshot(b) for a, b in zip(self.ids, self.twins))

    def test_one_rve(self) -> None:
        for name, arguments in (("apply", (small,)), ("relax", (1e-300, 10))):
            with self.subTest(call=name):
                warning = self.raised(lambda: getattr(self.pool, name)(self.ids[0], *arguments))
                self.assertIn("the state is that after the call", str(warning))
                wanted = getattr(self.alone, name)(self.twins[0], *arguments)
                self.assertEqual(warning.result.tobytes(), wanted.tobytes())
                self.assertTrue(self.same())

    def test_trials_are_pending_and_those_of_batch_committed(self) -> None:
        warning = self.raised(lambda: self.pool.trial(self.ids, self.gradients))
        self.assertIn("its trials are pending", str(warning))
        self.pool.commit(self.ids)
        self.assertEqual(warning.result.sigma.tobytes(), self.alone.batch(self.twins, self.gradients).sigma.tobytes())
        self.assertTrue(self.same())
        warning = self.raised(lambda: self.pool.batch(self.ids, self.gradients))
        self.assertIn("its trials are committed", str(warning))
        self.assertEqual(warning.result.sigma.tobytes(), self.alone.batch(self.twins, self.gradients).sigma.tobytes())
        self.assertTrue(self.same())

    def test_a_tangent_leaves_no_trial(self) -> None:
        rve, trial = rvelab.Rve(specimen, self.pool), self.pool.trial

        def affine(*arguments: Any, **more: Any) -> None:  # as of a network without an elastic tangent
            trial(*arguments, **more)
            raise rvelab.RvelabWarning("RVELAB_W_TANGENT_AFFINE: its trials are pending", 4)

        with unittest.mock.patch.object(self.pool, "trial", affine):
            self.assertIn("the state is as before", str(self.raised(rve.tangent)))
        self.assertEqual(rve.bytes_trial, 0)

    def test_commands_of_the_program(self) -> None:
        script = folder / "warns"
        script.write_text('#!/bin/sh\necho "a warning of the program" >&2\nexec "$RVELAB_REAL" "$@"\n')
        script.chmod(0o755)
        real = os.environ["RVELAB_PROGRAM"]
        os.environ.update(RVELAB_PROGRAM=str(script), RVELAB_REAL=real)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                with self.assertRaisesRegex(rvelab.RvelabWarning, "a warning of the program.*files are written") as caught:
                    rvelab.run("biaxial", specimen, {"stage.compression.to_strain": 0.002})
        finally:
            os.environ["RVELAB_PROGRAM"] = real
        records = caught.exception.result
        self.assertTrue(records.file.exists())
        self.assertEqual(len(records["strain"]), len(records["stress_Pa"]))


def run_short(to_strain: float = 0.002) -> rvelab.Records:
    return rvelab.run("biaxial", specimen, {"stage.compression.to_strain": to_strain})


class Copies(unittest.TestCase):
    def test_records_take_their_file_along(self) -> None:
        with multiprocessing.get_context("fork").Pool(1) as others:
            travelled = others.map(run_short, [0.002])[0]
        first = run_short()
        content = first.file.read_bytes()
        made = {"multiprocessing": travelled, "copy": copy.copy(first), "deepcopy": copy.deepcopy(first),
                "copy()": first.copy(), "pickle": pickle.loads(pickle.dumps(first)),
                "deepcopy of a list": copy.deepcopy([first])[0]}
        first_file = first.file
        del first
        for name, records in made.items():
            with self.subTest(way=name):
                self.assertIsInstance(records, rvelab.Records)
                self.assertEqual(len(records.file.read_bytes()), len(content))
                self.assertIn("protocol", records.summary)
                self.assertGreater(len(rvelab.run("biaxial", records, {"stage.compression.to_strain": 0.001})["strain"]), 1)
        made.clear()
        del records, travelled
        self.assertFalse(first_file.exists())

    def test_records_with_an_output_name_their_file(self) -> None:
        here = os.getcwd()
        os.chdir(folder)
        try:
            records = rvelab.run("biaxial", specimen, {"stage.compression.to_strain": 0.002}, output="relative.h5",
                                 overwrite=True)
        finally:
            os.chdir(here)
        self.assertEqual(records.file, folder / "relative.h5")
        self.assertEqual(pickle.loads(pickle.dumps(records)).file, records.file)
        records.file.unlink()

    def test_pictures_take_their_file_along(self) -> None:
        try:
            import h5py  # noqa: F401
            import matplotlib  # noqa: F401
        except ImportError:
            self.skipTest("h5py or matplotlib is missing")
        picture = rvelab.plot("stress_strain", run_short())
        made = copy.deepcopy(picture), pickle.loads(pickle.dumps(picture))
        del picture
        for each in made:
            self.assertTrue(each.path.read_bytes().startswith(b"\x89PNG"))


class EmbeddedPython(unittest.TestCase):
    def test_a_figure_needs_a_python(self) -> None:
        records = run_short()
        for name in ("", "/usr/bin/true"):
            with unittest.mock.patch.object(sys, "executable", name):
                with self.assertRaisesRegex(rvelab.RvelabError, "RVELAB_PYTHON"):
                    rvelab.plot("stress_strain", records)
        output = folder / "not_drawn.png"
        output.write_bytes(b"of before")
        for name, said in (("/usr/bin/true", "has not written"), ("/none/python3", "cannot be run")):
            with unittest.mock.patch.dict(os.environ, RVELAB_PYTHON=name):
                with self.assertRaisesRegex(rvelab.RvelabError, f"{name} {said}"):
                    rvelab.plot("stress_strain", records, output=output)
        output.unlink()


class OtherHdf5(unittest.TestCase):
    def test_h5py_before_and_after(self) -> None:
        if subprocess.run([sys.executable, "-c", "import h5py"], capture_output=True).returncode != 0:
            self.skipTest("h5py is missing")
        use = "r = rvelab.Rve(sys.argv[1]); r.apply([[0, 1e-4, 0], [0, 0, 0], [0, 0, 0]])\n"
        look = "print(len(h5py.File(sys.argv[1])['grains/radius_m']) == r.grains)\n"
        for script in ("import sys, h5py, rvelab\n" + use + look, "import sys, rvelab\n" + use + "import h5py\n" + look,
                       "import sys, os\nsys.setdlopenflags(os.RTLD_NOW | os.RTLD_GLOBAL)\nimport h5py, rvelab\n" + use + look):
            done = subprocess.run([sys.executable, "-c", script, specimen], capture_output=True, text=True)
            self.assertEqual((done.stdout, done.stderr), ("True\n", ""))


if __name__ == "__main__":
    unittest.main()
