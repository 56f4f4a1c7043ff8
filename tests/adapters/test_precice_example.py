"""tools/examples/precice as it is: its macro code and its configuration files beside a stand-in for the Micro Manager,
which calls the class in the manager's order, coupled by a stand-in for preCICE. Arguments: a folder with discs.h5."""
import csv
import importlib
import inspect
import json
import os
import runpy
import shutil
import sys
import threading
import unittest
import warnings
from pathlib import Path

import numpy as np

packed, case = Path(sys.argv.pop(1)).resolve(), Path(__file__).resolve().parents[2] / "tools/examples/precice"
folder = packed / "precice"
shutil.rmtree(folder, ignore_errors=True)
shutil.copytree(case, folder)
os.environ["RVELAB_SPECIMEN"] = str(packed / "discs.h5")
os.chdir(folder)
sys.path.insert(0, str(Path(__file__).parent / "precice_stub"))

import precice  # noqa: E402  the stand-in
import rvelab  # noqa: E402


def micro_manager(config_file: str) -> None:
    """The loop of the Micro Manager (micro_manager.py, 0.7) without adaptivity and logging."""
    config = json.loads(Path(config_file).read_text())
    coupling, mesh = config["coupling_params"], config["coupling_params"]["macro_mesh_name"]
    participant = precice.Participant("Micro-Manager", coupling["precice_config_file_name"], 0, 1)
    bounds = config["simulation_params"]["macro_domain_bounds"]
    assert len(bounds) == 2 * participant.get_mesh_dimensions(mesh)
    participant.set_mesh_access_region(mesh, bounds)
    participant.initialize()
    ids, _ = participant.get_mesh_vertex_ids_and_coordinates(mesh)
    micro = importlib.import_module(config["micro_file_name"]).MicroSimulation
    assert inspect.getfullargspec(micro.initialize).args == ["self"]

    class Simulation(micro):
        def __init__(self, global_id: int) -> None:
            micro.__init__(self, global_id)

    simulations = [Simulation(int(k)) for k in ids]
    for one in simulations:
        one.initialize()
    states, windows = [], 0
    while participant.is_coupling_ongoing():
        dt = min(participant.get_max_time_step_size(), config["simulation_params"]["micro_dt"])
        if participant.requires_writing_checkpoint():
            states = [one.get_state() for one in simulations]
        columns = {name: participant.read_data(mesh, name, ids, dt) for name in coupling["read_data_names"]}
        found = [one.solve({name: values[k] for name, values in columns.items()}, dt)
                 for k, one in enumerate(simulations)]
        for name in coupling["write_data_names"]:
            participant.write_data(mesh, name, ids, [rows[name] for rows in found])
        participant.advance(dt)
        if participant.requires_reading_checkpoint():
            for one, state in zip(simulations, states):
                one.set_state(state)
        if participant.is_time_window_complete():
            windows += 1
            if windows % config["diagnostics"]["micro_output_n"] == 0:
                for one in simulations:
                    one.output()
    participant.finalize()


class PreciceExample(unittest.TestCase):
    def test_the_example_holds_the_lateral_stress_with_the_bits_of_the_c_interface(self) -> None:
        failures = []

        def macro() -> None:
            try:
                runpy.run_path("macro.py", run_name="__main__")
            except BaseException as error:  # noqa: BLE001  it is told by the test
                failures.append(error)

        other = threading.Thread(target=macro, daemon=True)
        other.start()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rvelab.RvelabWarning)
            micro_manager("micro-manager-config.json")
        other.join(60)
        self.assertEqual((failures, other.is_alive()), ([], False))
        with open("biaxial.csv", newline="") as file:
            rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        self.assertEqual([(row["window"], row["point"]) for row in rows], [(w, k) for w in range(1, 11) for k in range(3)])
        rves = [rvelab.Rve(packed / "discs.h5") for _ in range(3)]
        for row in rows:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", rvelab.RvelabWarning)
                sigma = rves[int(row["point"])].apply(np.diag([row["dH_xx"], row["dH_yy"], 0]))
            self.assertEqual((sigma[0, 0], sigma[1, 1]), (row["sigma_xx"], row["sigma_yy"]))
            self.assertLess(abs(row["sigma_xx"] / -100e3 - 1), 0.02)
        self.assertLess(rows[-1]["sigma_yy"], -150e3)
        with open("rve_2.csv", newline="") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 10)


if __name__ == "__main__":
    unittest.main()
