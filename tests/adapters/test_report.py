"""A report in a browser without a window: no message on its console, every figure has a size, the film plays, nothing is
loaded from elsewhere. Arguments: a folder to work in, then unittest's. Exit code 77: no chromium here.

RVELAB_PROGRAM names the program, CHROMIUM the browser (default: chromium in the PATH)."""
import html
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

folder = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(".").resolve()
browser = os.environ.get("CHROMIUM") or shutil.which("chromium")

# Appended to a copy of the page: what the browser made of it, as text of the document.
PROBE = """<script>
const errors = [];
addEventListener('error', event => errors.push(event.message || event.target.src.slice(0, 40)), true);
addEventListener('load', async () => {
  const films = [...document.querySelectorAll('video')];
  await Promise.all(films.map(film => film.readyState > 1 ? 0 : new Promise(done => {
    film.addEventListener('loadeddata', done); film.addEventListener('error', done); setTimeout(done, 8000); })));
  const sizes = [...document.images].map(image => [image.alt, image.naturalWidth, image.naturalHeight,
                                                   image.getBoundingClientRect().width]);
  document.body.innerHTML = '<pre id="found">' + JSON.stringify({errors, sizes,
    films: films.map(film => [film.videoWidth, film.duration]),
    loaded: performance.getEntriesByType('resource').map(entry => entry.name.slice(0, 5))}) + '</pre>';
});
</script>"""


def run(*words: object) -> str:
    return subprocess.run([os.environ["RVELAB_PROGRAM"], *map(str, words)], check=True, capture_output=True, text=True,
                          cwd=folder).stdout


def browse(page: Path, *words: str) -> subprocess.CompletedProcess:
    with tempfile.TemporaryDirectory(dir=folder) as profile:
        return subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                               f"--user-data-dir={profile}", "--enable-logging=stderr", "--autoplay-policy=no-user-gesture-"
                               "required", "--virtual-time-budget=20000", *words, page.as_uri()],
                              capture_output=True, text=True, timeout=240)


class Texts(html.parser.HTMLParser):
    """Sources of figures and texts of headings."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.sources, self.headings, self._heading = [], [], False
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list) -> None:
        self.sources += [value for name, value in attributes if name in ("src", "href")]
        self._heading = tag in ("h2", "h3")

    def handle_data(self, text: str) -> None:
        if self._heading:
            self.headings.append(text)
            self._heading = False


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "records").mkdir(parents=True)
        run("pack", "pack_dense", "-o", "S.h5", "--count", 2, "--set", "pack.number=64", "--set", "target.void_ratio=0.2")
        for name in "12":
            run("run", "biaxial", "--specimen", f"S_{name}.h5", "-o", f"records/biaxial_{name}.h5", "--set",
                "stage.compression.to_strain=0.06", "--set", "output.snapshots_every=30")
        run("run", "cyclic_shear", "--specimen", "S_1.h5", "-o", "records/cyclic.h5", "--set", "stage.cycles.cycles=1")
        run("report", "records", "-o", "report.html")
        cls.page = folder / "report.html"
        cls.text = cls.page.read_text()

    def test_the_page_holds_all_of_its_parts_and_refers_to_nothing_outside(self) -> None:
        found = Texts(self.text)
        self.assertTrue(all(source.startswith("data:") for source in found.sources), found.sources)
        self.assertIn("default-src 'none'", self.text)
        self.assertEqual([found.headings.count(name) for name in ("Curves", "Force chains", "Film")], [2, 2, 1])
        for heading in ("What was asked", "Specimen", "Results", "Curves", "Mohr circles", "Contact rose", "Force chains",
                        "Film", "Error and run time"):
            self.assertIn(heading, found.headings)

    def test_the_browser_says_nothing_and_shows_every_figure(self) -> None:
        picture = folder / "report.png"
        done = browse(self.page, "--window-size=1140,4000", f"--screenshot={picture}")
        self.assertNotIn("CONSOLE", done.stderr)
        self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))

        probed = folder / "probed.html"
        without_policy = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', PROBE, self.text, count=1)
        self.assertNotEqual(without_policy, self.text)
        probed.write_text(without_policy)
        done = browse(probed, "--dump-dom")
        self.assertNotIn("CONSOLE", done.stderr)
        told = re.search(r'<pre id="found">(\{.*?\})</pre>', done.stdout, re.S)
        self.assertIsNotNone(told, done.stdout[-400:] + done.stderr[-400:])
        found = json.loads(html.unescape(told.group(1)))
        self.assertEqual(found["errors"], [])
        self.assertEqual(len(found["sizes"]) + len(found["films"]), self.text.count("<figure>"))
        self.assertGreaterEqual(len(found["sizes"]), 12)
        for name, width, height, shown in found["sizes"]:
            self.assertTrue(width > 100 and height > 100 and shown > 100, (name, width, height, shown))
        for width, duration in found["films"]:
            self.assertGreater(width, 100)
            self.assertGreater(duration, 0.3)
        self.assertEqual([name for name in found["loaded"] if name != "data:"], [])


if __name__ == "__main__":
    if browser is None:
        print("no chromium in the PATH; apt-get install chromium, or let CHROMIUM name one")
        sys.exit(77)
    unittest.main()
