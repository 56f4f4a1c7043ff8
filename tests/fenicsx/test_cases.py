"""The cases of python3 -m rvelab.fenicsx, small, beside what theory says of them. Argument: folder."""
import csv
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import stand_in  # skips without dolfinx
import numpy as np

FOLDER = Path(sys.argv.pop(1)).resolve()
FOLDER.mkdir(parents=True, exist_ok=True)
stand_in.FOLDER = FOLDER


def case(*words, code=0):
    done = subprocess.run([sys.executable, "-W", "ignore", "-m", "rvelab.fenicsx", *words], cwd=FOLDER, capture_output=True,
                          text=True, env={**os.environ, "OMP_NUM_THREADS": "1"}, timeout=280)
    if done.returncode != code:
        raise AssertionError(done.stdout + done.stderr)
    return done.stdout if code == 0 else done.stderr


def curve(name):
    with open(FOLDER / name / "curve.csv", newline="") as file:
        rows = list(csv.reader(file))
    return {each: np.array([float(row[k]) for row in rows[1:]]) for k, each in enumerate(rows[0])}


class Cases(unittest.TestCase):
    def test_biaxial_is_the_test_of_its_specimen_and_is_resumed(self):
        file = stand_in.specimen()
        options = ("--specimens", file, "--elements", "1", "--frames", "2", "--keep", "2", "--to", "0.004")
        case("biaxial", *options)
        whole = curve("biaxial")
        import rvelab
        own = rvelab.run("biaxial", file, {"test.pressure_Pa": 100e3, "stage.compression.to_strain": 0.004})
        expected = np.interp(whole["t"], own["strain"], -own["stress_Pa"][:, 1, 1] / 100e3)
        np.testing.assert_allclose(whole["load_ratio"], expected, rtol=0.03)
        self.assertTrue((FOLDER / "biaxial/fields/points.xdmf").exists())
        case("biaxial", *options[:-1], "0.002", "-o", "parts")
        self.assertIn("4 rows of the run before\n ", case("biaxial", *options, "-o", "parts", "--resume"))
        np.testing.assert_array_equal(curve("parts")["load_ratio"], whole["load_ratio"])
        said = case("rve", "parts/checkpoint", "3", "-o", "three.h5")
        self.assertIn("three.h5: the RVE of point 3", said)
        self.assertEqual(len(rvelab.Rve(FOLDER / "three.h5").radii), 50)

    def test_small_strains_give_the_volume_of_finite_ones_at_the_beginning(self):
        options = ("--specimens", stand_in.specimen(), "--elements", "1", "--frames", "0", "--keep", "0", "--to", "0.001")
        volumes = []
        for strains in ("finite", "small"):
            case("biaxial", *options, "--strains", strains, "-o", strains)
            volumes.append(curve(strains)["volume_strain"])
        self.assertGreater(np.abs(volumes[0]).max(), 1e-5)
        np.testing.assert_allclose(volumes[1], volumes[0], atol=0.05 * np.abs(volumes[0]).max())

    def test_footing_is_stiffer_rough_and_below_its_capacity(self):
        options = ("--grains", "50", "--draws", "1", "--elements", "1", "--to", "0.004", "--frames", "0", "--keep", "0")
        said = case("footing", *options, "--unit-weight", "10e3", "--at-rest", "0.6")
        self.assertRegex(said, r"by the formula \d+\.\d by \d+\.\d degrees \(peak\), \d+\.\d by")
        rough = curve("footing")["pressure_ratio"]
        self.assertTrue((np.diff(rough) > 0).all() and 1 < rough[-1] < 20)
        case("footing", *options, "--unit-weight", "10e3", "--at-rest", "0.6", "--smooth", "-o", "smooth")
        self.assertLess(curve("smooth")["pressure_ratio"][-1], rough[-1])

    def test_wall_begins_at_rest_and_goes_to_either_side(self):
        options = ("--grains", "50", "--draws", "1", "--elements", "2", "--frames", "0", "--keep", "0", "--first", "2e-4")
        case("wall", *options, "--to", "0.001")
        case("wall", *options, "--to", "0.001", "--passive", "-o", "passive")
        active, passive = curve("wall")["K"], curve("passive")["K"]
        self.assertTrue((np.diff(active) < 0).all() and (np.diff(passive) > 0).all())
        self.assertAlmostEqual(active[0] - (active[1] - active[0]), 0.5, delta=0.02)  # extrapolated to no displacement
        self.assertGreater(active[-1], 0.15)
        case("wall", *options, "--to", "0.001", "--rough", "-o", "rough")
        rough = curve("rough")
        self.assertLess(rough["K"][-1], 0.5)
        self.assertTrue((np.diff(rough["wall_friction_deg"]) > 0).all() and 0 < rough["wall_friction_deg"][-1] < 40)

    def test_coulomb_wedge(self):
        """Tabulated (Das, Principles of foundation engineering; from memory): phi 30, delta 20: K_a 0.2973, K_p 6.105."""
        from rvelab.fenicsx import wall
        phi, delta = np.radians((30, 20))
        self.assertAlmostEqual(wall.coulomb(phi, delta, False) / np.cos(delta), 0.2973, delta=1e-4)
        self.assertAlmostEqual(wall.coulomb(phi, delta, True) / np.cos(delta), 6.105, delta=1e-3)
        self.assertAlmostEqual(wall.coulomb(phi, 0, True), 3, delta=1e-9)

    def test_cavity_begins_elastic(self):
        """The first pressures follow p0 + 2 G u/a; the outer boundary and chords take some per cent."""
        case("cavity", "--grains", "100", "--draws", "1", "--to", "2e-5", "--first", "1e-5", "--frames", "0", "--keep", "0",
             "--elements", "8")
        found = curve("cavity")
        self.assertAlmostEqual(np.diff(found["pressure_ratio"])[0] / np.diff(found["elastic"])[0], 1, delta=0.1)
        self.assertAlmostEqual(found["pressure_ratio"][0], 1, delta=0.01)

    def test_triaxial_with_smooth_plates_is_the_test_of_its_specimen(self):
        said = case("triaxial", "--grains", "60", "--elements", "1", "--to", "0.002", "--frames", "0", "--keep", "0",
                    "--smooth")
        load, alone = map(float, re.search(r"at the end ([\d.]+); .* at that strain ([\d.]+)", said).groups())
        self.assertAlmostEqual(load / alone, 1, delta=0.05)

    def test_the_whole_wall_of_the_cylinder_is_pressed(self):
        from mpi4py import MPI
        from rvelab.fenicsx import compat, triaxial
        for n in (1, 2, 3, 7):
            body = triaxial.quarter(MPI.COMM_SELF, n)
            self.assertEqual(len(compat.locate(body, 2, triaxial.wall(n))), 2 * n * 2 * n)

    def test_an_interrupt_names_the_checkpoint_of_its_run(self):
        shutil.rmtree(FOLDER / "stopped", ignore_errors=True)
        for keep, file, names in (("1", "checkpoint/host.npz", "stopped/checkpoint holds the last checkpoint, --resume goes on "
                                   "from it"), ("0", "curve.csv", r"no checkpoint was made yet \(--keep\)")):
            (FOLDER / "stopped/curve.csv").unlink(missing_ok=True)
            running = subprocess.Popen([sys.executable, "-W", "ignore", "-m", "rvelab.fenicsx", "biaxial", "--specimens",
                                        stand_in.specimen(), "--elements", "1", "--frames", "0", "--keep", keep, "-o", "stopped"],
                                       cwd=FOLDER, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            while running.poll() is None and not (FOLDER / "stopped" / file).exists():
                time.sleep(0.05)
            running.send_signal(signal.SIGINT)
            said = running.communicate()[1]
            self.assertRegex(said.strip(), rf"^rvelab.fenicsx: stopped after t = [\d.e-]+; {names}$")
            self.assertEqual(running.returncode, 130)

    def test_mistakes_are_told_in_a_sentence(self):
        self.assertIn("there is no case 'biaxal'; allowed: biaxial,", case("biaxal", code=2))
        self.assertEqual(case("biaxial", "--elemnts", "3", code=2).splitlines(), ["rvelab.fenicsx: there is no option --elemnts; the "
                         "nearest is --elements (python3 -m rvelab.fenicsx biaxial --help lists all)"])
        self.assertIn("there is no file none.h5", case("biaxial", "--specimens", "none.h5", code=2))
        with_file = ("--specimens", stand_in.specimen())
        self.assertIn("no checkpoint was made there", case("biaxial", *with_file, "--resume", "-o", "new", code=2))
        self.assertIn("tolerance is 2; allowed: 1e-6 to 0.1", case("wall", *with_file, "--tolerance", "2", code=2))
        self.assertIn("argument --tolerance: 0: allowed are numbers above 0", case("wall", *with_file, "--tolerance", "0", code=2))
        self.assertIn("usage", case("--help"))


if __name__ == "__main__":
    unittest.main()
