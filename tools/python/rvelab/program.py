"""The program rvelab: its path, and calls that raise."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import weakref
from pathlib import Path
from typing import Any, Callable, Mapping, Sequence

from .library import RvelabError, RvelabWarning, library, warn


def program() -> str:
    """Path of the program: RVELAB_PROGRAM, else that of the library's build, installation or wheel, else in the PATH."""
    named = os.environ.get("RVELAB_PROGRAM")
    if named:
        return named
    candidates = []
    if os.sep in library._name:
        folder = Path(library._name).resolve().parent
        candidates = [folder / "rvelab", folder.parent / "bin/rvelab", folder.parent.parent / "bin/rvelab"]
    found = next((str(file) for file in candidates if file.is_file()), None) or shutil.which("rvelab")
    if found is None:
        raise FileNotFoundError("the program rvelab was not found: let RVELAB_PROGRAM name it, or add it to PATH")
    return found


class Folder:
    """A temporary folder that exists as long as this object."""

    def __init__(self) -> None:
        self.name = tempfile.mkdtemp(prefix="rvelab-")
        weakref.finalize(self, shutil.rmtree, self.name, ignore_errors=True)

    def __copy__(self) -> "Folder":
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> "Folder":
        return self

    def __reduce__(self) -> tuple[Any, ...]:  # to another process, with its files
        return _folder_of, ({file.name: file.read_bytes() for file in Path(self.name).iterdir() if file.is_file()},)


def _folder_of(files: dict[str, bytes]) -> Folder:
    made = Folder()
    for name, content in files.items():
        Path(made.name, name).write_bytes(content)
    return made



def main() -> None:
    """The command `rvelab` of the wheel: becomes the program."""
    os.execv(program(), [program(), *sys.argv[1:]])


def main_mpm() -> None:
    """The command `rvelab-mpm` of the wheel: becomes that program."""
    beside = str(Path(program()).resolve().parent / "rvelab-mpm")
    os.execv(beside, [beside, *sys.argv[1:]])


def words_of(settings: Mapping[str, Any] | None, more: Mapping[str, Any]) -> list[str]:
    """--set KEY=VALUE for each key. Keys have dots ("test.pressure_Pa"), or are tables within tables."""
    words = []
    for key, value in {**flat(settings or {}), **flat(more)}.items():
        words += ["--set", f"{key}={value if isinstance(value, str) else json.dumps(value, default=plain)}"]
    return words


def flat(table: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    found = {}
    for key, value in table.items():
        found.update(flat(value, f"{before}{key}.") if isinstance(value, Mapping) else {before + key: value})
    return found


def plain(value: Any) -> Any:
    """A number or an array of numpy as JSON has it."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a setting is {value!r}; allowed: numbers, texts, truth values and lists of them")


def ask(words: Sequence[str | os.PathLike[str]], progress: Callable[[dict[str, Any]], None] | None = None,
        made_of: Callable[[Any], Any] = lambda printed: printed) -> Any:
    """Runs the program with --json and returns its output, converted by made_of. Its warnings become RvelabWarning,
    its error RvelabError. progress: called with each of its lines of progress."""
    command = [program(), *map(os.fspath, words), "--json", *(["--progress"] if progress is not None else [])]
    printed, told = [], []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        reader = threading.Thread(target=lambda: printed.append(running.stdout.read()))
        reader.start()
        try:
            for line in running.stderr:
                if progress is not None and line.startswith("progress {"):
                    progress(json.loads(line.removeprefix("progress ")))
                else:
                    told.append(line)
        except BaseException:
            running.terminate()  # it keeps its records
            raise
        finally:
            reader.join()
    if running.returncode != 0:
        raise RvelabError("".join(told).strip() or f"{command[0]} ended with the exit code {running.returncode}")
    made = made_of(json.loads(printed[0]))
    for line in told:
        warn(RvelabWarning(line.rstrip("\n")), 3, made, "the command has ended, its files are written")
    return made
