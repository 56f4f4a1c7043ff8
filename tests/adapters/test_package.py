"""What is installed, and what the files that tell of rvelab say. Arguments: folder, build, cmake."""
import json
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

folder, build, cmake = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3]
del sys.argv[1:4]
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/python"))
from elf_needs import Needs, is_elf  # noqa: E402

VERSION = re.search(r'version = "([0-9.]+)"', (ROOT / "rvelab/io/version.hpp").read_text()).group(1)
# Nothing that leads to the checkout or its build.
BARE = {name: value for name, value in os.environ.items()
        if not name.startswith(("RVELAB_", "PYTHONPATH", "LD_LIBRARY_PATH"))} | {"PYTHONDONTWRITEBYTECODE": "1"}


def run(*words: object, **more: str) -> subprocess.CompletedProcess:
    return subprocess.run([*map(str, words)], capture_output=True, text=True, env=BARE | more, cwd=folder)


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        made = run(cmake, "--install", build, "--prefix", folder / "first")
        if made.returncode != 0:
            raise AssertionError(made.stdout + made.stderr)
        (folder / "first").rename(folder / "moved")
        cls.prefix = folder / "moved"
        cls.files = sorted(file for file in cls.prefix.rglob("*") if file.is_file())
        cls.program = cls.prefix / "bin/rvelab"

    def test_every_program_has_a_manual_page_and_tells_its_version(self) -> None:
        programs = sorted((self.prefix / "bin").iterdir())
        self.assertGreaterEqual({program.name for program in programs}, {"rvelab", "rvelab-mpm"})
        for program in programs:
            with self.subTest(program.name):
                page = (self.prefix / f"share/man/man1/{program.name}.1").read_text()
                if program.name == "rvelab-mpm-mpi":  # runs under mpirun
                    self.assertEqual(page, ".so man1/rvelab-mpm.1\n")
                    continue
                said = run(program, "--version")
                self.assertEqual(said.stdout, f"{program.name} {VERSION}\n", said.stderr)
                options = re.findall(r"--[a-z][a-z-]+", run(program, "--help").stdout)
                for option in options:
                    self.assertIn(option.replace("-", r"\-"), page)
                self.assertIn(f'"{program.name} {VERSION}"', page.splitlines()[0])
                self.assertTrue((self.prefix / f"share/bash-completion/completions/{program.name}").is_file())

    def test_readmes_licences_examples_and_scenes_are_there(self) -> None:
        doc = self.prefix / "share/doc/rvelab"
        self.assertEqual((doc / "copyright").read_text(), (ROOT / "LICENSE").read_text())
        for name in ("README.md", "CHANGELOG.md", "CITATION.cff", "protocols/README.md", "tools/mpm/README.md"):
            self.assertEqual((doc / name).read_bytes(), (ROOT / name).read_bytes())
        for file in (ROOT / "tools/examples").rglob("*"):
            if file.is_file() and "__pycache__" not in file.parts:
                self.assertTrue((doc / file.relative_to(ROOT)).is_file(), file.name)
        installed = {str(file.relative_to(self.prefix / "share/rvelab/protocols"))
                     for file in (self.prefix / "share/rvelab/protocols").rglob("*.toml")}
        self.assertEqual(installed, {str(file.relative_to(ROOT / "protocols")) for file in (ROOT / "protocols").rglob("*.toml")})

    def test_links_of_the_installed_readmes_lead_to_readmes_that_are_installed(self) -> None:
        doc, seen = self.prefix / "share/doc/rvelab", 0
        for readme in doc.rglob("*.md"):
            for link in re.findall(r"\]\(([^)#: ]+\.md)[)#]", readme.read_text()):
                seen += 1
                if "validate.d/results" not in link:  # kept tables of longer checks stay in the source
                    self.assertTrue((readme.parent / link).is_file(), f"{readme.relative_to(doc)}: {link}")
        self.assertGreater(seen, 20)

    def test_nothing_installed_names_the_folder_of_source_or_build(self) -> None:
        for file in self.files:
            content = file.read_bytes()
            if is_elf(file) and b".debug_line" in content:
                continue  # the debugger is told, until stripped
            # A checkout may be called /rvelab, and "/rvelab" alone ends many a path that is right.
            for place in (f"{build}/", *(f"{ROOT}/{folder}/" for folder in ("rvelab", "include", "tools", "tests"))):
                found = re.search(rb"(?<![\w./-])" + re.escape(place.encode()), content)
                self.assertIsNone(found, f"{file} names {place}")

    def test_the_moved_program_finds_what_was_installed(self) -> None:
        listed = run(self.program, "protocols")
        self.assertIn("pack_dense", listed.stdout, listed.stderr)
        printed = run(sys.executable, "-c", "import rvelab; print(rvelab.__file__, rvelab.__version__)",
                      PYTHONPATH=str(self.prefix / "lib/python3/dist-packages"))
        self.assertEqual(printed.stdout, f"{self.prefix}/lib/python3/dist-packages/rvelab/__init__.py {VERSION}\n", printed.stderr)

    def test_without_numpy_the_import_says_so_in_one_sentence(self) -> None:
        for words, expected in ((["-S", "-c", "import rvelab"], 1),  # -S: no site-packages, and so no numpy
                                (["-S", "-c", "try:\n import rvelab\nexcept ImportError as error: print(error)"], 0)):
            said = run(sys.executable, *words, PYTHONPATH=str(ROOT / "tools/python"))
            self.assertEqual(said.returncode, expected)
            last = (said.stderr or said.stdout).strip().splitlines()[-1]
            self.assertIn(f"rvelab needs numpy, which {sys.executable} does not have: apt-get install python3-numpy", last)
        self.assertEqual(said.stdout.count("\n"), 1)

    def test_what_is_asked_of_a_system_is_read_from_the_symbols(self) -> None:
        needs = Needs([self.program])
        by_linker = run("ldd", self.program).stdout
        for library in needs.libraries:
            self.assertIn(library, by_linker)
        self.assertIn("libc.so.6", needs.libraries)
        self.assertGreaterEqual(needs.versions["GLIBC"], (2, 17))
        tag = needs.platform_tag("x86_64")
        self.assertEqual(tag.startswith("manylinux"), not needs.others(), f"{tag}: {needs}")
        # A library among the files is not asked for.
        libraries = [file for file in self.files if file.name.startswith("librvelab") and not file.is_symlink()]
        self.assertIn("librvelab.so.1", Needs([self.prefix / "bin/rvelab-mpm"]).others())
        self.assertNotIn("librvelab.so.1", Needs([self.prefix / "bin/rvelab-mpm", *libraries]).others())

    def test_the_files_about_rvelab_tell_one_version(self) -> None:
        self.assertEqual(json.loads((ROOT / "codemeta.json").read_text())["version"], VERSION)
        self.assertIn(f"\nversion: {VERSION}\n", (ROOT / "CITATION.cff").read_text())
        self.assertEqual(re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), re.M).group(1), VERSION)


if __name__ == "__main__":
    unittest.main()
