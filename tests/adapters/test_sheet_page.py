"""The page of a data sheet in a browser without a window: what stands first, at widths from a telephone to a wall and on
paper. Arguments: a folder to work in, then unittest's. Exit code 77: no chromium here.

RVELAB_TEST_SHEET names the program that writes the page, CHROMIUM the browser (default: chromium in the PATH)."""
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from browser import Browser

folder = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(".").resolve()
browser_program = os.environ.get("CHROMIUM") or shutil.which("chromium")
READY = "document.documentElement.dataset.ready"
WIDEST = "Math.max(...[...document.querySelectorAll('section, .sheet-figure')].map((box) => box.getBoundingClientRect().right))"


class SheetPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([os.environ["RVELAB_TEST_SHEET"], "[page]"], check=True, capture_output=True,
                       env=os.environ | {"RVELAB_SHEET": str(folder)})
        cls.browser = Browser(browser_program).__enter__()

    @classmethod
    def tearDownClass(cls) -> None:
        cls.browser.__exit__()

    def open(self, width: int) -> Browser:
        self.browser.open((folder / "index.html").as_uri(), width=width, height=900, phone=width < 500, ready=READY)
        return self.browser

    def test_the_critical_angle_with_its_interval_is_in_sight_first(self) -> None:
        for width in (390, 1280, 2560):
            browser = self.open(width)
            first = browser.value("document.querySelector('#headline .card').innerText")
            self.assertRegex(first, r"critical friction angle \u03c6\s*cs")
            self.assertRegex(first, "31\\.00? ?.*\u00b0")
            self.assertIn("95 % interval", first)
            self.assertIn("published 33.0\u00b0 (somebody)", first)
            self.assertLess(browser.value("document.querySelector('#headline .card').getBoundingClientRect().bottom"), 450)
            self.assertEqual(browser.complaints() + browser.requests(), [])

    def test_nothing_leaves_the_page_from_390_to_2560_px_and_in_print(self) -> None:
        for width in (390, 600, 860, 1280, 1920, 2560):
            browser = self.open(width)
            browser.value("document.querySelectorAll('details').forEach((part) => { part.open = true; })")
            self.assertLessEqual(browser.value("document.documentElement.scrollWidth"), width)
            self.assertLessEqual(browser.value(WIDEST), width)
        browser = self.open(794)
        browser.call("Emulation.setEmulatedMedia", media="print")
        browser.value("dispatchEvent(new Event('beforeprint'))")
        self.assertLessEqual(browser.value(WIDEST), 794)
        self.assertTrue(browser.value("[...document.querySelectorAll('details')].every((part) => part.open)"))
        browser.call("Emulation.setEmulatedMedia", media="")

    def test_every_figure_is_drawn_within_its_own_axes_with_a_legend(self) -> None:
        browser = self.open(1280)
        figures = browser.value("""[...document.querySelectorAll('.sheet-figure')].map((box) => ({
            lines: box.querySelectorAll('svg g path').length, clip: box.querySelector('clipPath').id,
            legend: box.querySelectorAll('.legend span').length, text: box.querySelector('.plot-area').innerHTML}))""")
        self.assertGreaterEqual(len(figures), 7)
        self.assertEqual(len({figure["clip"] for figure in figures}), len(figures))
        for figure in figures:
            self.assertGreater(figure["lines"], 4)
            self.assertGreater(figure["legend"], 1)
            self.assertNotIn("NaN", figure["text"])
            self.assertNotIn("Infinity", figure["text"])

    def test_a_theme_redraws_the_figures(self) -> None:
        browser = self.open(1280)
        before = browser.value("document.querySelector('.plot-area').innerHTML")
        browser.value("document.getElementById('theme').click()")
        self.assertNotEqual(browser.value("document.querySelector('.plot-area').innerHTML"), before)


if __name__ == "__main__":
    if browser_program is None:
        print("no chromium in the PATH; apt-get install chromium, or let CHROMIUM name one")
        sys.exit(77)
    unittest.main()
