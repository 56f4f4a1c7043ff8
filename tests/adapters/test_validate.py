"""tools/validate: verdicts, runs that were cut off, what is out of date, and that a table is kept only when it is
whole. Argument: a folder to work in. A shell script stands for rvelab."""
import importlib.machinery
import importlib.util
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest
from pathlib import Path

work = Path(sys.argv.pop(1)).resolve()
root = Path(__file__).resolve().parents[2]
checks = root / "tools/validate.d"
sys.path.insert(0, str(checks))
import keeping  # noqa: E402
from parts import BY_NAME, PARTS, Part  # noqa: E402

# Writes its last word (-o OUT) line by line; `broken`, if it is there, stops it between the lines.
PROGRAM = """#!/bin/sh
here=$(dirname "$0")
[ "$1" = --version ] && exec cat "$here/version"
echo "$*" >>"$here/runs"
for out; do :; done
echo first >"$out"
[ -e "$here/broken" ] && exit 1
echo second >>"$out"
"""
CHECK = """
import harness
from harness import bars, once, verdict, work

@bars
def judged(strength, limit=10):
    verdict("strength", f"{{strength:.1f}}", f"{{limit}}", strength <= limit, strength <= 12, "softer grains, in a run with stiff ones 9.8")

def main():
    print("a line")
    once(work / "out", "run", "one")
    judged({strength})
    verdict("second", "1", "2", True)
    {more}

if __name__ == "__main__":
    harness.main(main)
"""


class Bench(unittest.TestCase):
    def setUp(self) -> None:
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        self.program, self.check = work / "rvelab", work / "check.py"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        (work / "version").write_text("rvelab 2.0.0\n")

    def write_check(self, strength: float, more: str = "") -> None:
        self.check.write_text(CHECK.format(strength=strength, more=more))

    def run_check(self, *words: object, entries: bool = False) -> subprocess.CompletedProcess:
        environment = {**os.environ, "PYTHONPATH": str(checks), **({"RVELAB_ENTRIES": "1"} if entries else {})}
        return subprocess.run([sys.executable, "-B", self.check, self.program, work / "w", work / "r",
                               *map(str, words)], env=environment,
                              capture_output=True, text=True)

    def runs(self) -> int:
        return len((work / "runs").read_text().splitlines()) if (work / "runs").exists() else 0


class Verdicts(Bench):
    def word_of(self, strength: float) -> tuple[str, int]:
        self.write_check(strength)
        done = self.run_check()
        line = next(line for line in done.stdout.splitlines() if line.startswith("strength"))
        return line.split()[-1], done.returncode

    def test_a_cause_holds_only_in_its_range(self) -> None:
        self.assertEqual(self.word_of(9), ("met", 0))
        self.assertEqual(self.word_of(11), ("DIFFERS", 0))
        self.assertEqual(self.word_of(13), ("MISSED", 3))

    def test_rows_are_judged_again_from_their_figures(self) -> None:
        self.write_check(11)
        table = {"command": "c", "program": "rvelab 2.0.0", "compiler": "", "cores": 2, "processor": "",
                 "entries": keeping.entries_of(self.run_check(entries=True).stdout.splitlines())}
        self.assertIn("    why: softer grains", keeping.text(table))
        self.assertIn("1 differ from their source", keeping.text(table))
        (work / "kept.json").write_text(json.dumps(table))
        self.check.write_text(self.check.read_text().replace("limit=10", "limit=11"))
        made = self.runs()
        again = self.run_check("--judge", work / "kept.json", entries=True)
        table["entries"] = keeping.entries_of(again.stdout.splitlines())
        self.assertEqual(again.returncode, 0)
        self.assertNotIn("DIFFERS", keeping.text(table))
        self.assertIn("0 differ from their source", keeping.text(table))
        self.assertEqual([row["what"] for row in keeping.rows(table["entries"])], ["strength", "second"])
        self.assertEqual(self.runs(), made)


class Runs(Bench):
    def test_a_run_is_made_once_and_again_by_another_version(self) -> None:
        self.write_check(9)
        self.assertEqual([self.run_check().returncode, self.run_check().returncode, self.runs()], [0, 0, 1])
        (work / "version").write_text("rvelab 2.1.0\n")
        self.run_check()
        self.assertEqual(self.runs(), 2)

    def test_what_a_run_that_was_cut_off_left_is_not_taken(self) -> None:
        self.write_check(9)
        (work / "broken").touch()
        self.assertNotEqual(self.run_check().returncode, 0)
        self.assertEqual((work / "w/out").read_text(), "first\n")
        (work / "broken").unlink()
        self.assertEqual(self.run_check().returncode, 0)
        self.assertEqual((work / "w/out").read_text(), "first\nsecond\n")


class Kept(Bench):
    def setUp(self) -> None:
        super().setUp()
        loader = importlib.machinery.SourceFileLoader("validate", str(root / "tools/validate"))
        spec = importlib.util.spec_from_loader("validate", loader)
        self.validate = importlib.util.module_from_spec(spec)
        loader.exec_module(self.validate)
        v = self.validate
        v.ROOT, v.PROGRAM, v.WORK = work, self.program, work / "validate"
        v.STAGED, v.FAILED = v.WORK / "staged", v.WORK / "failed"
        v.install = lambda packages: None
        v.build = lambda targets: "1"
        keeping.RESULTS = work / "results"
        self.addCleanup(setattr, keeping, "RESULTS", root / "tools/validate.d/results")

    def part(self, command: str, **more: object) -> Part:
        return Part("one", 1, "a part", command, **more)

    def make(self, command: str) -> str:
        return self.validate.make(self.part(command))

    def text(self) -> str:
        return (work / "results/one.txt").read_text()

    def test_nothing_is_kept_of_a_part_that_fails(self) -> None:
        self.assertIsNone(self.make("echo whole; echo figure >$results/one.png"))
        self.assertIn("whole", self.text())
        before = self.text()
        self.assertIn("exit code 1", self.make("echo half; echo half >$results/one.png; exit 1"))
        self.assertEqual(self.text(), before)
        self.assertEqual((work / "results/one.png").read_text(), "figure\n")
        self.assertEqual(keeping.stale(self.part(""), "rvelab 2.0.0", self.validate.FAILED, work / "results"), "failed")
        self.assertIsNone(self.make("echo whole again"))
        self.assertIsNone(keeping.stale(self.part(""), "rvelab 2.0.0", self.validate.FAILED, work / "results"))

    def test_a_table_with_missed_bars_is_kept_and_told(self) -> None:
        self.write_check(13)
        reported = self.make(f"PYTHONPATH={checks} {sys.executable} -B {self.check} {self.program} {work}/w $results")
        self.assertIn("missed", reported)
        self.assertIn("MISSED", self.text())
        self.assertEqual(json.loads((work / "results/tables/one.json").read_text())["entries"][1]["figures"], [13])

    def test_a_part_that_is_stopped_leaves_what_was_kept_and_no_process(self) -> None:
        self.assertIsNone(self.make("echo whole"))
        before = self.text()

        def stop(*_: object) -> None:
            raise KeyboardInterrupt

        def once_begun() -> None:
            while not (work / "pid").exists() or not (work / "pid").read_text():
                time.sleep(0.05)
            os.kill(os.getpid(), signal.SIGALRM)

        signal.signal(signal.SIGALRM, stop)
        threading.Thread(target=once_begun, daemon=True).start()
        with self.assertRaises(KeyboardInterrupt):
            self.make(f"echo half; echo $$ >{work}/pid; sleep 600; echo late")
        self.assertEqual(self.text(), before)
        process = Path(f"/proc/{(work / 'pid').read_text().strip()}")
        for _ in range(100):
            if not process.exists():
                break
            time.sleep(0.1)
        self.assertFalse(process.exists())


class Stale(unittest.TestCase):
    def setUp(self) -> None:
        shutil.rmtree(work, ignore_errors=True)
        (work / "failed").mkdir(parents=True)

    def keep(self, name: str, version: str, **more: object) -> None:
        keeping.keep(name, {"command": name, "program": version, "compiler": "", "cores": 1, "processor": "",
                            "entries": [], **more}, work)

    def stale(self, *parts: Part) -> list[tuple[str, str]]:
        return [(part.name, why) for part, why, _ in keeping.out_of_date(parts, "rvelab 2.0.0", work / "failed", work)]

    def test_the_oldest_come_first_and_the_cheapest_among_equals(self) -> None:
        parts = [Part(name, minutes, "") for name, minutes in
                 (("hours", 90), ("minutes", 5), ("old", 50), ("present", 1), ("never", 70), ("failed", 1),
                  ("speed", 1))]
        for name, version in (("hours", "1.10.0"), ("minutes", "1.10.0"), ("old", "1.9.0"), ("present", "2.0.0"),
                              ("failed", "2.0.0")):
            self.keep(name, f"rvelab {version}")
        (work / "failed/failed.txt").touch()
        self.keep("minutes", "rvelab 1.10.0", core_minutes=95)
        parts[-1] = Part("speed", 1, "", kept=False)
        self.assertEqual(self.stale(*parts), [("never", "never kept"), ("old", "by rvelab 1.9.0"),
                                              ("hours", "by rvelab 1.10.0"),
                                              ("minutes", "by rvelab 1.10.0"), ("failed", "failed")])

    def test_what_is_not_made_again_says_so_and_is_not_stale_for_that_version(self) -> None:
        part = Part("hours", 180, "")
        self.keep("hours", "rvelab 0.1.0", not_again={"by": "rvelab 2.0.0", "minutes": 180})
        self.assertEqual(self.stale(part), [])
        self.assertIn("not made again by rvelab 2.0.0: 3.0 hours", (work / "hours.txt").read_text())
        self.keep("hours", "rvelab 0.1.0", not_again={"by": "rvelab 1.0.0", "minutes": 180})
        self.assertEqual(len(self.stale(part)), 1)

    def test_a_missed_row_without_a_cause_is_stale(self) -> None:
        row = {"row": "x", "verdict": "MISSED", "why": "", "what": "x"}
        self.keep("one", "rvelab 2.0.0", entries=["text", {"bars": "judged", "figures": [], "entries": [row]}])
        self.assertEqual(len(self.stale(Part("one", 1, ""))), 1)
        row["why"] = "by its sub-steps"
        self.keep("one", "rvelab 2.0.0", entries=[row])
        self.assertEqual(self.stale(Part("one", 1, "")), [])


class Parts(unittest.TestCase):
    def test_every_check_that_a_part_names_is_there(self) -> None:
        self.assertEqual(len(BY_NAME), len(PARTS))
        for part in PARTS:
            for line in part.run().splitlines():
                if line.split()[:1] == ["check"]:
                    self.assertTrue((checks / f"{line.split()[1]}.py").exists(), part.name)

    def test_the_text_of_every_kept_table_is_made_from_its_json(self) -> None:
        folder = checks / "results"
        names = sorted(path.stem for path in (folder / "tables").glob("*.json"))
        self.assertEqual(names, sorted(path.stem for path in folder.glob("*.txt")))
        for name in names:
            self.assertEqual(keeping.text(keeping.read(name, folder)), (folder / f"{name}.txt").read_text(), name)


if __name__ == "__main__":
    unittest.main()
