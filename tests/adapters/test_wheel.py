"""The wheel: built offline, twice the same bytes, installed alone it packs, tests and draws. Arguments: folder, build."""
import os
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

folder, build = Path(sys.argv[1]), sys.argv[2]
del sys.argv[1:3]
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/python"))
from elf_needs import Needs, is_elf  # noqa: E402

# Nothing that leads to the checkout or its build.
BARE = {name: value for name, value in os.environ.items() if not name.startswith(("RVELAB_", "PYTHONPATH"))}

SCRIPT = """
import micro_simulation, rvelab, sys
assert rvelab.__file__.startswith(sys.argv[1]), rvelab.__file__
file = rvelab.pack("pack_dense", "S.h5", {"pack.number": 36, "target.void_ratio": 0.2}, overwrite=True)
rve = rvelab.Rve(file)
records = rvelab.run("biaxial", rve, {"stage.compression.to_strain": 0.005})
print(rvelab.__version__, len(records["strain"]), len(rve.radii))
"""


def run(*words: object, **more: str) -> str:
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, env=BARE | more, cwd=folder)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}: {done.stdout}{done.stderr}")
    return done.stdout


class Wheel(unittest.TestCase):
    def test_the_wheel_stands_alone(self) -> None:
        with tempfile.TemporaryDirectory(dir=folder) as place:
            place = Path(place).resolve()
            builder = ROOT / "tools/python/wheel_builder.py"
            made = [Path(run(sys.executable, "-B", builder, place / name, RVELAB_BUILD=build).strip()) for name in "ab"]
            self.assertEqual(made[0].read_bytes(), made[1].read_bytes())
            site = place / "site"
            if subprocess.run([sys.executable, "-m", "pip", "--version"], capture_output=True).returncode == 0:
                offline = ("--no-index", "--no-deps", "--disable-pip-version-check")
                run(sys.executable, "-B", "-m", "pip", "wheel", *offline, "--no-build-isolation", "-w", place / "c",
                    ROOT / "tools/python", RVELAB_BUILD=build)
                self.assertEqual(next((place / "c").glob("*.whl")).read_bytes(), made[0].read_bytes())
                run(sys.executable, "-B", "-m", "pip", "install", *offline, "--target", site, made[0])
            else:
                with zipfile.ZipFile(made[0]) as wheel:
                    wheel.extractall(site)
                for program in (site / "rvelab/native/bin").iterdir():
                    program.chmod(0o755)
            (place / "work").mkdir()
            (place / "work/script.py").write_text(SCRIPT)
            printed = run(sys.executable, "-B", "-W", "ignore", place / "work/script.py", site, PYTHONPATH=str(site))
            version, records, grains = printed.split()
            self.assertEqual((records, grains), ("11", "36"))
            said = run(sys.executable, "-B", "-c", "import sys; sys.argv[1:] = ['--version']; from rvelab.program import main; "
                       "main()", PYTHONPATH=str(site))
            self.assertEqual(said.strip(), f"rvelab {version}")
            said = run(sys.executable, "-B", "-c", "import sys; sys.argv[1:] = ['--version']; from rvelab.program import "
                       "main_mpm; main_mpm()", PYTHONPATH=str(site))
            self.assertEqual(said.strip(), f"rvelab-mpm {version}")
            # The tests that the installed fit compares with are there: it stops at its folder alone.
            (place / "K").mkdir()
            (place / "K/asked.json").write_text("{}")
            fit = subprocess.run([site / "rvelab/native/bin/rvelab", "fit", "karlsruhe", "-o", place / "K"],
                                 capture_output=True, text=True, env=BARE)
            self.assertIn("asked.json", fit.stderr)
            # Its name is true: manylinux if it counts on nothing but glibc and libgcc_s, and then on no newer glibc.
            needs = Needs([file for file in (site / "rvelab/native").rglob("*") if file.is_file() and is_elf(file)])
            tag = made[0].stem.split("-")[-1]
            self.assertEqual(tag, needs.platform_tag())
            self.assertEqual(tag.startswith("manylinux_2_"), not needs.others())
            self.assertIn(f"Tag: py3-none-{tag}\n", next(site.glob("rvelab-*.dist-info/WHEEL")).read_text())

    def test_a_build_that_lacks_something_is_told(self) -> None:
        done = subprocess.run([sys.executable, "-B", ROOT / "tools/python/wheel_builder.py", folder / "none"], text=True,
                              capture_output=True, env=BARE | {"RVELAB_BUILD": str(folder / "nowhere")})
        self.assertEqual(done.returncode, 1)
        self.assertIn("librvelab.so.1 is not there; build first", done.stderr)


if __name__ == "__main__":
    folder.mkdir(parents=True, exist_ok=True)
    unittest.main()
