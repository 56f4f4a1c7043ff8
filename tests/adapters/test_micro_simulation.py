"""The Micro Manager's class, driven as the manager drives it. Arguments: a folder with discs.h5, then unittest's."""
import csv
import gc
import os
import pickle
import sys
import unittest
import warnings
from pathlib import Path

import numpy as np

folder = Path(sys.argv.pop(1)).resolve()
os.environ["RVELAB_SPECIMEN"] = str(folder / "discs.h5")
os.chdir(folder)

import micro_simulation  # noqa: E402  reads its environment
import rvelab  # noqa: E402

windows = np.zeros((4, 3, 3))
windows[:, :2, :2] = np.random.default_rng(1).uniform(-1e-3, 1e-3, (4, 2, 2))


def data_of(dH: np.ndarray, n: int = 3) -> dict[str, np.ndarray]:
    return {"dH_" + "xyz"[i]: dH[i, :n] for i in range(n)}


def matrix_of(rows: dict[str, np.ndarray]) -> np.ndarray:
    return np.array([rows["sigma_" + axis] for axis in "xyz"])


def simulation_class() -> type:
    """As the manager makes one: a class of its own over that of the file."""
    base = micro_simulation.MicroSimulation

    class Simulation(base):
        def __init__(self, global_id: int) -> None:
            base.__init__(self, global_id)

    return Simulation


def reference() -> list[np.ndarray]:
    rve = rvelab.Rve(folder / "discs.h5")
    return [rve.apply(dH) for dH in windows]


class MicroSimulationTest(unittest.TestCase):
    def setUp(self) -> None:
        gc.collect()
        warnings.simplefilter("ignore", rvelab.RvelabWarning)

    def test_implicit_windows_iterate_from_their_checkpoint(self) -> None:
        simulations = [simulation_class()(k) for k in range(2)]
        expected = reference()
        self.assertIsNone(simulations[0].initialize())  # the manager tries the first before it calls all
        for one in simulations:
            one.initialize()
        self.assertEqual(len(micro_simulation.MicroSimulation._pool.ids()), 2)
        for window, dH in enumerate(windows):
            kept = [one.get_state() for one in simulations]
            for guess in (0.5 * dH, 1.5 * dH, dH):
                found = [one.solve(data_of(guess), 0.1) for one in simulations]
                if guess is not dH:
                    for one, state in zip(simulations, kept):
                        one.set_state(state)
            for rows in found:
                self.assertEqual(matrix_of(rows).tobytes(), expected[window].tobytes())
            for one in simulations:
                one.output()
        with open("rve_1.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["output"] for row in rows], ["1", "2", "3", "4"])
        p = -(expected[-1][0, 0] + expected[-1][1, 1]) / 2
        self.assertAlmostEqual(float(rows[-1]["p"]), p, delta=1e-9 * p)

    def test_explicit_windows_follow_each_other(self) -> None:
        one = simulation_class()(3)
        found = [one.solve(data_of(dH), 0.1) for dH in windows]
        self.assertEqual(matrix_of(found[-1]).tobytes(), reference()[-1].tobytes())

    def test_a_state_goes_to_another_simulation_by_way_of_another_rank(self) -> None:
        there, here = simulation_class()(4), simulation_class()(5)
        there.solve(data_of(windows[0]), 0.1)
        here.set_state(pickle.loads(pickle.dumps(there.get_state())))
        here.set_global_id(4)
        self.assertEqual(here.get_global_id(), 4)
        self.assertEqual(matrix_of(here.solve(data_of(windows[1]), 0.1)).tobytes(), reference()[1].tobytes())

    def test_vectors_of_two_in_a_mesh_of_two_dimensions(self) -> None:
        found = simulation_class()(6).solve(data_of(windows[0], 2), 0.1)
        self.assertEqual(sorted(found), ["sigma_x", "sigma_y"])
        self.assertEqual(np.array([found["sigma_x"], found["sigma_y"]]).tobytes(),
                         reference()[0][:2, :2].tobytes())

    def test_a_window_is_physical_time_where_that_is_asked_for(self) -> None:
        class Timed(micro_simulation.MicroSimulation):
            physical_time = True

        rve = rvelab.Rve(folder / "discs.h5")
        found = Timed(7).solve(data_of(windows[0]), 1e-5)
        self.assertEqual(matrix_of(found).tobytes(), rve.apply(windows[0], 1e-5).tobytes())
        self.assertNotEqual(matrix_of(found).tobytes(), reference()[0].tobytes())

    def test_simulations_that_are_let_go_of_free_their_rves(self) -> None:
        one = simulation_class()(8)
        one.initialize()
        pool = micro_simulation.MicroSimulation._pool
        before = len(pool.ids())
        del one
        self.assertEqual(len(pool.ids()), before - 1)

    def test_without_a_specimen_the_remedy_is_told(self) -> None:
        class Empty(micro_simulation.MicroSimulation):
            specimen = None

        with self.assertRaisesRegex(ValueError, "RVELAB_SPECIMEN"):
            Empty(9)

    def test_a_forked_worker_has_a_pool_of_its_own(self) -> None:
        parent = simulation_class()(0)
        parent.initialize()
        parent.solve(data_of(windows[0]), 1.0)
        state, told = parent.get_state(), os.pipe()
        child = os.fork()
        if child == 0:
            said = []
            try:
                parent.solve(data_of(windows[1]), 1.0)
            except RuntimeError as error:
                said.append("before the process was forked" in str(error))
            own = simulation_class()(7)
            own.set_state(state)
            said.append(matrix_of(own.solve(data_of(windows[1]), 1.0)).tobytes())
            parent.set_state(state)
            said.append(matrix_of(parent.solve(data_of(windows[1]), 1.0)).tobytes())
            del own, parent
            gc.collect()
            os.write(told[1], pickle.dumps(said))
            os._exit(0)
        os.waitpid(child, 0)
        said = pickle.loads(os.read(told[0], 65536))
        expected = matrix_of(parent.solve(data_of(windows[1]), 1.0)).tobytes()
        self.assertEqual(said, [True, expected, expected])


if __name__ == "__main__":
    unittest.main()
