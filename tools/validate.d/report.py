"""Pages of `rvelab report` in Chromium: pictures at 1280 and 390 pixels, and how fast a page of 1,000 grains and 200 records
with a state each opens and answers: report.py RVELAB WORK RESULTS

The pages are those of tests/adapters/test_report.py, with larger specimens."""
import functools
import shutil
import statistics
import sys

import harness
from harness import PROTOCOLS, mpm, results, sets
from harness import work as folder

sys.path.insert(0, str(harness.ROOT / "tests/adapters"))
from browser import EMPTY, Browser  # noqa: E402

READY = "document.documentElement.dataset.ready && document.getElementById('stage').dataset.drawn == 'fine'"
rvelab = functools.partial(harness.rvelab, cwd=folder)


def make_pages():
    shutil.rmtree(folder)
    folder.mkdir()
    tests = sets("stage.compression.to_strain=0.06", "output.snapshots_every=10")
    for group, void_ratio in (("dense", 0.19), ("loose", 0.23)):
        rvelab("pack", "pack_dense", "-o", f"{group}.h5", "--count", 3,
               *sets("pack.number=200", f"target.void_ratio={void_ratio}"))
        rvelab("run", "biaxial", "--specimen", f"{group}_*.h5", "-o", group, *sets("test.pressure_Pa=100e3"), *tests)
    recipe = "\n".join(line for line in rvelab("protocols", "pack_dense").splitlines()
                       if not line.startswith("thickness_m"))
    (folder / "spheres.toml").write_text(recipe.replace('"disc"', '"sphere"').replace("0.1874", "0.6").replace("400", "300"))
    rvelab("pack", "spheres.toml", "-o", "spheres.h5")
    rvelab("run", "triaxial", "--specimen", "spheres.h5", "-o", "triaxial.h5", *tests)
    harness.run(mpm, PROTOCOLS / "mpm/column_soil.toml", "-o", folder / "column")
    harness.run(mpm, PROTOCOLS / "mpm/boulders.toml", "-o", folder / "rocks", *sets("time.duration_s=0.6"))
    rvelab("pack", "pack_dense", "-o", "large.h5", *sets("pack.number=1000", "target.void_ratio=0.2"))
    rvelab("run", "biaxial", "--specimen", "large.h5", "-o", "large_test.h5",
           *sets("stage.compression.to_strain=0.02", "stage.compression.record_every=1e-4", "output.snapshots_every=1"))
    for page, words in (("groups", ("dense", "loose")), ("space", ("triaxial.h5",)), ("mpm", ("column",)), ("rocks", ("rocks",)),
                        ("large", ("large_test.h5",))):
        rvelab("report", *words, "-o", f"{page}.html")
    (folder / "empty.html").write_text(EMPTY)


def address(page):
    return (folder / f"{page}.html").as_uri()


def main():
    make_pages()
    with Browser(shutil.which("chromium")) as browser:
        for page, width, height in (("groups", 1280, 700), ("space", 1280, 620), ("mpm", 1280, 620),
                                    ("rocks", 1280, 620), ("groups", 390, 700)):
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


if __name__ == "__main__":
    harness.main(main)
