"""The Fortran example against the Python module, bit for bit. Arguments: a folder with discs.h5, the program."""
import subprocess
import sys
import unittest
import warnings
from pathlib import Path

import numpy as np
import rvelab

specimen, program = Path(sys.argv.pop(1)) / "discs.h5", sys.argv.pop(1)


class FortranTest(unittest.TestCase):
    def test_the_example_prints_the_stresses_of_the_python_module(self) -> None:
        warnings.simplefilter("ignore", rvelab.RvelabWarning)
        printed = subprocess.run([program, specimen], check=True, capture_output=True, text=True).stdout
        rve, dH = rvelab.Rve(specimen), np.zeros((3, 3))
        dH[0, 1] = 1 / 8192
        stresses = [rve.apply(dH) for _ in range(40)]
        found = [[float(word) for word in line.split()] for line in printed.splitlines()]
        self.assertEqual([row[1:] for row in found], [[sigma[0, 1], sigma[1, 1]] for sigma in stresses[7::8]])
        self.assertAlmostEqual(found[-1][0], 40 / 8192, delta=1e-5)

    def test_an_error_ends_the_program_with_its_text(self) -> None:
        done = subprocess.run([program, "none.h5"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("element_test: none.h5: no such file; give the path", done.stderr)

    def test_wrong_arguments_are_told_without_a_backtrace(self) -> None:
        for words in ([], [specimen, "2"]):
            done = subprocess.run([program, *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn("usage: element_test SPECIMEN.h5", done.stderr)
            self.assertNotIn("Backtrace", done.stderr)


if __name__ == "__main__":
    unittest.main()
