"""Pages of `rvelab report` in Chromium: pictures at 1280 and 390 pixels, and how fast a page of 1,000 grains and 200 records
with a state each opens and answers. Arguments: folder for the pictures, programs rvelab and rvelab-mpm.

The pages are those of tests/adapters/test_report.py, with larger specimens."""
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "tests/adapters"))
from browser import EMPTY, Browser  # noqa: E402

READY = "document.documentElement.dataset.ready && document.getElementById('stage').dataset.drawn == 'fine'"
results, rvelab, mpm = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
folder = pathlib.Path(tempfile.mkdtemp())


def run(program, *words):
    subprocess.run([str(program), *map(str, words)], check=True, capture_output=True, text=True, cwd=folder)


def make_pages():
    tests = ("--set", "stage.compression.to_strain=0.06", "--set", "output.snapshots_every=10")
    for group, void_ratio in (("dense", 0.19), ("loose", 0.23)):
        run(rvelab, "pack", "pack_dense", "-o", f"{group}.h5", "--count", 3, "--set", "pack.number=200", "--set",
            f"target.void_ratio={void_ratio}")
        run(rvelab, "run", "biaxial", "--specimen", f"{group}_*.h5", "-o", group, "--set", "test.pressure_Pa=100e3", *tests)
    recipe = subprocess.run([str(rvelab), "protocols", "pack_dense"], check=True, capture_output=True, text=True).stdout
    recipe = "\n".join(line for line in recipe.splitlines() if not line.startswith("thickness_m"))
    (folder / "spheres.toml").write_text(recipe.replace('"disc"', '"sphere"').replace("0.1874", "0.6").replace("400", "300"))
    run(rvelab, "pack", "spheres.toml", "-o", "spheres.h5")
    run(rvelab, "run", "triaxial", "--specimen", "spheres.h5", "-o", "triaxial.h5", *tests)
    run(mpm, root / "protocols/mpm/column_soil.toml", "-o", "column")
    run(mpm, root / "protocols/mpm/boulders.toml", "-o", "rocks", "--set", "time.duration_s=0.6")
    run(rvelab, "pack", "pack_dense", "-o", "large.h5", "--set", "pack.number=1000", "--set", "target.void_ratio=0.2")
    run(rvelab, "run", "biaxial", "--specimen", "large.h5", "-o", "large_test.h5", "--set", "stage.compression.to_strain=0.02",
        "--set", "stage.compression.record_every=1e-4", "--set", "output.snapshots_every=1")
    for page, words in (("groups", ("dense", "loose")), ("space", ("triaxial.h5",)), ("mpm", ("column",)), ("rocks", ("rocks",)),
                        ("large", ("large_test.h5",))):
        run(rvelab, "report", *words, "-o", f"{page}.html")
    (folder / "empty.html").write_text(EMPTY)


def address(page):
    return (folder / f"{page}.html").as_uri()


make_pages()
with Browser(shutil.which("chromium")) as browser:
    for page, width, height in (("groups", 1280, 700), ("space", 1280, 620), ("mpm", 1280, 620), ("rocks", 1280, 620), ("groups", 390, 700)):
        browser.open(address(page), width, height, width < 500, READY)
        browser.picture(str(results / f"report_{page}_{width}.png"))
    empty = statistics.median(browser.open(address("empty")) for _ in range(5))
    nothing = statistics.median(browser.answers_to_drags())
    print("median of five\n\n| page | opens in (s) | over an empty page | size (MB) |\n| --- | --- | --- | --- |")
    print(f"| empty | {empty:.3f} | 1 | 0.0 |")
    for page in ("groups", "space", "mpm", "large"):
        time = statistics.median(browser.open(address(page), ready=READY.split(" &&")[0]) for _ in range(5))
        print(f"| {page} | {time:.2f} | {time / empty:.0f} | {(folder / f'{page}.html').stat().st_size / 1e6:.1f} |")
    browser.wait("document.getElementById('stage').dataset.record")
    answers = browser.answers_to_drags()
    print(f"\nlarge: 1,000 grains, 201 records with a state each; a movement of its slider is drawn after {statistics.median(answers):.0f} ms "
          f"in the median of 30, {max(answers):.0f} at most; in the empty page {nothing:.0f} ms. Drawn by the processor, without a "
          "graphics card.")
shutil.rmtree(folder)
