"""The benchmark of RVEs: its cases are read, a quick reference is met within its bar, broken files are refused with words.
Arguments: a folder to work in, the program. Peers are not run."""
import csv
import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

work, program = Path(sys.argv.pop(1)).resolve(), sys.argv.pop(1)
root = Path(__file__).resolve().parents[2]
benchmark, folder = root / "tools/bench/benchmark", root / "tools/bench/rve_benchmark/cases"
sys.path.insert(0, str(root / "tools/bench/rve_benchmark"))

import answers  # noqa: E402
import case as cases  # noqa: E402


def run(*words: object) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-B", benchmark, "--rvelab", program, *map(str, words)], capture_output=True, text=True)


def broken(name: str, file: str, old: str, new: str) -> Path:
    """A copy of a case with one place changed, which must be there."""
    copy = work / "broken"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(folder / name, copy)
    text = (copy / file).read_text()
    assert old in text, (file, old)
    (copy / file).write_text(text.replace(old, new, 1))
    return copy


class CasesTest(unittest.TestCase):
    def test_ten_cases_are_read_and_small(self) -> None:
        names = cases.names()
        self.assertEqual(len(names), 10)
        self.assertEqual(sorted(names), sorted(path.name for path in folder.iterdir() if path.is_dir()))
        found = [cases.Case(str(folder / name)) for name in names]
        self.assertEqual({(c.dimension, c.law["kind"], c.rolling) for c in found},
                         {(2, "linear", False), (2, "linear", True), (3, "hertz_mindlin", False), (3, "hertz_mindlin", True)})
        self.assertEqual({bool(c.rate) for c in found}, {True, False})
        self.assertLess(sum(file.stat().st_size for file in folder.rglob("*") if file.is_file()), 1_000_000)

    def test_references_start_at_100_kPa_and_have_bars_below_their_changes(self) -> None:
        for name in cases.names():
            case = cases.Case(str(folder / name))
            reference = answers.Reference(case)
            with self.subTest(name):
                self.assertLess(reference.bar(), 0.2 if case.windows else 5e-3)
                if not case.windows:
                    for value in reference.rows[0, 3:3 + case.dimension]:
                        self.assertAlmostEqual(value, -100e3, delta=2)
                for leg in case.legs:
                    for key, held in leg.held_Pa.items():
                        for value in reference.rows[:, 3 + cases.COMPONENTS.index(key)]:
                            self.assertAlmostEqual(value / held, 1, delta=6e-3)

    def test_the_packings_are_at_rest_by_the_formulas_of_the_readme(self) -> None:
        """Forces from the overlaps alone: they balance on every grain, and their stress is that of record 0."""
        for name in ("disc_shear", "sphere_isotropic"):
            case = cases.Case(str(folder / name))
            specimen, d = case.specimens[0], case.dimension
            forces, moment, largest = [[0.0] * d for _ in specimen.grains], [0.0] * d, 0.0
            for i, a in enumerate(specimen.grains):
                for j, b in enumerate(specimen.grains[:i]):
                    l = [x - y - c * round((x - y) / c) for x, y, c in zip(b.x[:d], a.x[:d], specimen.cell)]
                    distance = sum(x * x for x in l) ** 0.5
                    overlap = a.r + b.r - distance
                    if overlap <= 0:
                        continue
                    f = case.pair(a.r, b.r)[0] * overlap ** (1 if case.law["kind"] == "linear" else 1.5)
                    largest = max(largest, f)
                    for k in range(d):
                        forces[i][k] -= f * l[k] / distance
                        forces[j][k] += f * l[k] / distance
                        moment[k] += f * l[k] ** 2 / distance
            volume = specimen.cell[0] * specimen.cell[1] * specimen.cell[2]
            reference = answers.Reference(case)
            with self.subTest(name):
                self.assertLess(max(abs(f) for grain in forces for f in grain), 1e-7 * largest)
                for k in range(d):
                    self.assertAlmostEqual(-moment[k] / volume / reference.rows[0, 3 + k], 1, delta=1e-6)


class CommandTest(unittest.TestCase):
    def test_a_quick_case_is_within_the_bar_of_its_reference(self) -> None:
        done = run("--quick")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("within it", done.stdout)

    def test_a_coarse_run_is_worse_than_a_fine_one_and_written_as_table_numbers_and_picture(self) -> None:
        out = work / "out"
        shutil.rmtree(out, ignore_errors=True)
        done = run("--case", "disc_isotropic", "--code", "rvelab", "-o", out)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(out / "benchmark.csv", encoding="utf-8", newline="") as file:
            errors = [float(row["error"]) for row in csv.DictReader(file)]
        self.assertEqual(len(errors), 6)
        self.assertGreater(errors[0], 10 * errors[-1])
        self.assertIn("disc_isotropic", (out / "benchmark.md").read_text())
        self.assertEqual((out / "benchmark.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_an_answer_of_another_code_is_scored(self) -> None:
        case = cases.Case(str(folder / "disc_isotropic"))
        reference = answers.Reference(case)
        head = ["specimen", "record", *cases.STRAINS, *cases.STRESSES]
        answer = work / "answer.csv"
        work.mkdir(parents=True, exist_ok=True)

        def score(change) -> str:
            with open(answer, "w", encoding="utf-8", newline="") as file:
                table = csv.writer(file)
                table.writerow(head)
                for k, row in enumerate(reference.rows):
                    table.writerow([1, k, *row[:3], *change(k, row[3:])])
            done = run("--case", "disc_isotropic", "--score", answer)
            return done.stdout + done.stderr

        self.assertIn("error 0.00e+00", score(lambda k, s: s))
        off = 0.01 * reference.scale
        self.assertIn("error 1.00e-02", score(lambda k, s: [s[0] + off, *s[1:]]))
        self.assertIn("line 4", score(lambda k, s: [*s[:5], "much"] if k == 2 else s))
        self.assertIn("record 3: not a finite number", score(lambda k, s: [*s[:5], "nan"] if k == 3 else s))

    def test_what_a_code_lacks_is_said(self) -> None:
        for code, name, words in (("yade", "sphere_triaxial_rolling", "rolling stiffness"), ("liggghts", "disc_shear", "no discs"),
                                  ("liggghts", "sphere_flow", "tilted cells"), ("lammps", "sphere_triaxial_rolling", "rolling stiffness")):
            if shutil.which({"lammps": "lmp"}.get(code, code)):
                done = run("--case", name, "--code", code, "-o", work / "lacks")
                self.assertIn("not run: ", done.stdout)
                self.assertIn(words, done.stdout)
            else:
                done = run("--case", name, "--code", code)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn("apt-get install", done.stderr)

    def test_broken_files_are_refused_with_words(self) -> None:
        name = "disc_isotropic"
        for file, old, new, words in (
                ("case.toml", "friction = 0.5", "fricton = 0.5", ("unknown key law.fricton", "law.friction")),
                ("case.toml", "friction = 0.5", "", ("law.friction is missing",)),
                ("case.toml", "friction = 0.5", "friction = -0.5", ("law.friction is -0.5", "0 or more")),
                ("case.toml", 'kind = "linear"', 'kind = "lineer"', ("law.kind is 'lineer'", "hertz_mindlin")),
                ("case.toml", "records = 5", "records = 0", ("path.leg[0].records is 0", "1 or more")),
                ("case.toml", "[law]", "[law", ("not TOML",)),
                ("case.toml", "grains.csv", "grain.csv", ("grain.csv", "No such file")),
                ("case.toml", "records = 5", "records = 6", ("reference.csv", "13 rows", "14")),
                ("grains.csv", "id,x_m", "id,x", ("the first line is id,x,", "id,x_m,y_m,z_m,r_m")),
                ("grains.csv", "\n3,", "\n4,", ("line 4", "3 here")),
                ("grains.csv", ",0.005\n", ",-0.005\n", ("line 2", "radius above 0")),
                ("reference.csv", "\n2,", "\n2,x", ("reference.csv, line 4",))):
            with self.subTest(f"{file}: {old} -> {new}"):
                done = run("--case", broken(name, file, old, new), "--code", "rvelab", "-o", work / "never")
                self.assertNotEqual(done.returncode, 0)
                self.assertNotIn("Traceback", done.stderr)
                for word in words:
                    self.assertIn(word, done.stderr)
        for words, said in ((("--case", "disc"), "neither a folder nor one of disc_isotropic"), (("--code", "pfc"), "known: rvelab"),
                            (("--with", "mine"), "NAME=COMMAND"), (("--with", "mine=true"), "--settings"),
                            (("--rounds", "0"), "1 or more"), (("--score", "x.csv"), "needs one --case")):
            with self.subTest(" ".join(words)):
                done = run(*words)
                self.assertNotEqual(done.returncode, 0)
                self.assertNotIn("Traceback", done.stderr)
                self.assertIn(said, done.stderr)

    def test_an_own_code_is_run_beside_and_its_nonsense_refused(self) -> None:
        work.mkdir(parents=True, exist_ok=True)
        (work / "settings.json").write_text(json.dumps([{"steps": 1}]))
        mine = work / "mine.py"
        mine.write_text("import json, sys\njson.dump([{'seconds': 1.0, 'records': [[0.0] * 9] * 3}], open(sys.argv[3], 'w'))\n")
        done = run("--case", "disc_isotropic", "--code", "mine", "--with", f"mine={sys.executable} {mine}", "--settings",
                   work / "settings.json", "-o", work / "own")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("1 specimens of 13 records", done.stderr)
        mine.write_text(mine.read_text().replace("* 3}", "* 13}"))
        done = run("--case", "disc_isotropic", "--code", "mine", "--with", f"mine={sys.executable} {mine}", "--settings",
                   work / "settings.json", "-o", work / "own")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("disc_isotropic | mine | steps 1", done.stdout)


if __name__ == "__main__":
    os.environ.pop("RVELAB_LIBRARY", None)
    unittest.main()
