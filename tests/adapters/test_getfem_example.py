"""The example of getfem gives the test of its specimen: uniform stresses, the load of `rvelab run biaxial`. Argument:
folder."""
import re
import subprocess
import sys
import unittest
from pathlib import Path

try:
    import getfem  # noqa: F401
except ModuleNotFoundError:
    print("skipped: this Python has no getfem (apt-get install python3-getfem)")
    sys.exit(77)
import numpy as np
import rvelab

EXAMPLE = Path(__file__).resolve().parents[2] / "tools/examples/getfem_biaxial.py"
FOLDER = Path(sys.argv.pop(1))


class Getfem(unittest.TestCase):
    def test_the_block_is_the_test_of_its_specimen(self):
        FOLDER.mkdir(parents=True, exist_ok=True)
        file = FOLDER / "S.h5"
        rvelab.pack("pack_dense", file, {"pack.number": 50}, overwrite=True)
        done = subprocess.run([sys.executable, "-W", "ignore", EXAMPLE, file], capture_output=True, text=True, check=True)
        rows = re.findall(r"strain ([\d.]+)  load ratio ([\d.]+)  iterations (\d+)  .* ([\d.e-]+)$", done.stdout, re.M)
        strain, load, iterations, apart = np.array(rows, float).T
        self.assertEqual(len(rows), 8)
        self.assertLess(apart.max(), 1e-10)
        self.assertTrue((iterations <= 4).all())
        own = rvelab.run("biaxial", file, {"test.pressure_Pa": 100e3, "stage.compression.to_strain": 0.002})
        np.testing.assert_allclose(load, np.interp(strain, own["strain"], -own["stress_Pa"][:, 1, 1] / 100e3), rtol=0.03)


if __name__ == "__main__":
    unittest.main()
