"""Functions of tools/plot, without figures and records: test_plot_functions.py."""
import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/plot"))
import records  # first: it chooses the backend
import curves
import e_log_p
import loops
import matplotlib.pyplot as plt
import mohr
import numpy as np


class Indices(unittest.TestCase):
    def test_are_found_of_a_path_of_straight_parts_and_where_first_loading_bends(self) -> None:
        # First loading 10 to 100 kPa by 0.05 and on to 1600 by 0.30, swelling to 100 by 0.04, reloading by 0.06.
        x = np.concatenate([np.linspace(1, 3.2, 23), np.linspace(3.2, 2, 13), np.linspace(2, 3.2, 13)[1:]])
        e = np.concatenate([1 - 0.05 * (x[:23] - 1) - 0.25 * np.maximum(x[:23] - 2, 0), np.zeros(25)])
        e[23:36] = e[22] + 0.04 * (3.2 - x[23:36])
        e[36:] = e[35] - 0.06 * (x[36:] - 2)
        found = e_log_p.fits_of(1e3 * 10**x, e)
        self.assertEqual([fit[0] for fit in found], ["C_c", "C_s", "C_r"])
        np.testing.assert_allclose([fit[1] for fit in found], [0.3, 0.04, 0.06], atol=5e-5)
        np.testing.assert_allclose([fit[2] for fit in found], 0, atol=5e-5)
        np.testing.assert_allclose([fit[4] for fit in found], [1e5, 1e3 * 10**3.2, 1e5], rtol=5e-3)

    def test_a_straight_path_has_no_bend_and_one_within_the_tolerance_of_a_held_stress_does_not_turn(self) -> None:
        p = 10 ** np.linspace(4, 5, 20) * (1 + 1e-3 * (-1) ** np.arange(20))
        (fit,) = e_log_p.fits_of(p, 1 - 0.2 * np.log10(p))
        self.assertEqual(fit[0], "C_c")
        self.assertAlmostEqual(fit[1], 0.2, places=3)


class Axes(unittest.TestCase):
    def test_a_logarithmic_one_has_four_numbers_or_more_and_no_two_that_touch(self) -> None:
        for low, high in ((1, 1.55), (0.36, 0.72), (0.0025, 0.011), (0.055, 0.21), (0.3, 6), (10, 2000), (1e-5, 3)):
            subs = curves.ticks_of_decade(low, high)
            ticks = sorted(s * 10.0**k for s in subs for k in range(-7, 6) if low <= s * 10.0**k <= high)
            near = min(math.log(b / a) for a, b in zip(ticks, ticks[1:])) / math.log(high / low)
            with self.subTest(low=low, high=high):
                self.assertTrue(4 <= len(ticks) <= 10)
                self.assertGreater(near, 0.05)

    def test_a_logarithmic_one_stands_zeros_negative_values_and_a_single_decade(self) -> None:
        figure, axes = plt.subplots()
        curves.log_axis(axes.xaxis, [-5, 0, float("nan"), 20, 60])
        axes.plot([-5, 0, 20, 60], [1, 2, 3, 4])
        figure.canvas.draw()
        low, high = axes.get_xlim()
        ticks = [float(t.get_text()) for t in axes.get_xticklabels() if t.get_text()]
        self.assertEqual(axes.get_xscale(), "log")
        self.assertTrue(15 < low < 20 and 60 < high < 80)
        self.assertGreaterEqual(sum(low <= t <= high for t in ticks), 3)
        self.assertRaisesRegex(ValueError, "pressure above 0", curves.log_axis, axes.xaxis, [0, -1])


class Numbers(unittest.TestCase):
    def test_have_the_digits_that_their_error_leaves_and_no_exponent_where_it_can_be_read_without(self) -> None:
        plain = [records.plain(x) for x in (1600.4, 99950, 0.18736, 20000, 2.5e7, 0, 1e-7)]
        self.assertEqual(plain, ["1600", "100000", "0.187", "20000", "2.5e+07", "0", "1e-07"])
        pairs = ((0.04483, 0.0036), (37.62, 6.41), (1234.5, 56), (2.345, 0))
        self.assertEqual([records.with_error(*pair) for pair in pairs],
                         ["0.0448 +- 0.0036", "37.6 +- 6.4", "1234 +- 56", "2.35"])

    def test_cycles_are_counted_by_the_strain_travelled_a_quarter_to_the_first_turn(self) -> None:
        self.assertEqual(list(loops.cycles_of(np.array([0, 2, 4, 0, -4, -1, 4, 1]))),
                         [0, 0.125, 0.25, 0.5, 0.75, 0.9375, 1.25, 1.4375])
        self.assertEqual(list(loops.cycles_of(np.array([0, 4, 0]))), [0, 0.25, 0.5])

    def test_quantiles_of_student_are_those_of_the_printed_tables(self) -> None:
        np.testing.assert_allclose([mohr.student(n) for n in (1, 10, 20, 60)], [12.706, 2.228, 2.086, 2.000], atol=5e-4)


unittest.main()
