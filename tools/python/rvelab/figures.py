"""Figures and reports by the scripts of tools/plot."""
from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Iterable, Union

from .laboratory import Records
from .library import RvelabError
from .program import Folder, ask, program
from .rve import Rve

_NO_FIGURES = ("records", "state", "curves", "tables", "report")
_Source = Union[str, "os.PathLike[str]", Records, Rve]


class Picture:
    """A figure that a script drew. A notebook shows it; save() keeps it.

    path: of the file; without `output` it exists as long as this object and its copies. text: output of the script."""

    def __init__(self, path: Path, text: str, kept: Folder | None = None) -> None:
        self.path, self.text, self._kept = path, text, kept

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        if self._kept is not None:
            self.path = Path(self._kept.name, self.path.name)

    def save(self, path: str | os.PathLike[str]) -> None:
        """A copy of the file, of the same format."""
        if Path(path).suffix != self.path.suffix:
            raise ValueError(f"{path}: the figure is {self.path.suffix}; give that ending, or plot(..., output={str(path)!r})")
        shutil.copyfile(self.path, path)

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        shown: dict[str, Any] = {"text/plain": repr(self)}
        if self.path.suffix == ".png":
            shown["image/png"] = self.path.read_bytes()
        elif self.path.suffix == ".svg":
            shown["image/svg+xml"] = self.path.read_text()
        return shown

    def __repr__(self) -> str:
        return f"<rvelab.Picture {self.text}>"


def _scripts() -> Path:
    here = Path(__file__).resolve().parent
    # In the wheel; in a checkout; PREFIX/share of an installed module in PREFIX/lib/python3/dist-packages/rvelab.
    folders = here / "native/share/rvelab/plot", here.parents[1] / "plot", here.parents[3] / "share/rvelab/plot"
    found = next((folder for folder in folders if (folder / "records.py").exists()), None)
    if found is None:
        raise FileNotFoundError(f"the scripts of the figures were not found; tried {', '.join(map(str, folders))}; "
                                "install rvelab again")
    return found


def _python() -> str:
    """Path of a Python for the scripts: RVELAB_PYTHON or this one. A program with embedded Python is not one."""
    python = os.environ.get("RVELAB_PYTHON") or sys.executable
    if not os.environ.get("RVELAB_PYTHON") and not re.search("python|pypy", os.path.basename(python or "")):
        raise RvelabError(f"figures are drawn by a Python of their own, and sys.executable is {python!r}, as where Python is "
                          "embedded in another program: let RVELAB_PYTHON name a Python that has numpy, h5py and matplotlib "
                          "(os.environ[\"RVELAB_PYTHON\"] = \"/usr/bin/python3\")")
    return python


def _written(path: Path) -> tuple[int, int, int] | None:
    """Changes when the file is written again; None: there is none."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def _files(sources: _Source | Iterable[_Source], folder: str) -> list[str]:
    several = isinstance(sources, Iterable) and not isinstance(sources, (str, os.PathLike, Records))
    files = []
    for number, source in enumerate(sources if several else [sources]):
        if isinstance(source, Rve):
            files.append(os.path.join(folder, f"rve_{number}.h5"))
            source.save(files[-1])
        else:
            files.append(os.fspath(source.file if isinstance(source, Records) else source))
    return files


def plot(figure: str, sources: _Source | Iterable[_Source], *, output: str | os.PathLike[str] | None = None,
         **options: Any) -> Picture:
    """Draws a figure: stress_strain, volumetric, stress_path, fabric, mohr, e_log_p, loops, envelope, mu_I of tests
    (Records, record files, folders of them); chains, rose of states (Rve, specimen and record files); film of a record
    file with snapshots (output *.gif or *.mp4).

    output: *.png, *.pdf or *.svg. options: those of the script, plot("rose", rve, of="branches"), plot("mohr", folder,
    colour="group"); booleans are flags. Also needs h5py and matplotlib."""
    script = _scripts() / f"{figure}.py"
    names = sorted(path.stem for path in _scripts().glob("*.py") if path.stem not in _NO_FIGURES)
    if figure not in names:
        raise ValueError(f"there is no figure {figure!r}; allowed: {', '.join(names)}")
    kept = Folder()
    path = Path(output) if output is not None else Path(kept.name) / f"{figure}.{'gif' if figure == 'film' else 'png'}"
    path = path.absolute()
    words = [_python(), "-B", str(script), "-o", str(path)]
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        words += ([flag] if value else []) if isinstance(value, bool) else [f"{flag}={value}"]
    before = _written(path)
    try:
        done = subprocess.run([*words, "--", *_files(sources, kept.name)], capture_output=True, text=True,
                              env={**os.environ, "RVELAB_PROGRAM": program(), "MPLBACKEND": "Agg"})
    except OSError as error:
        raise RvelabError(f"{words[0]} cannot be run ({error.strerror}): let RVELAB_PYTHON name a Python") from None
    if done.returncode != 0:
        raise RvelabError(done.stderr.strip() or f"{script} ended with the exit code {done.returncode}")
    if _written(path) in (None, before):
        raise RvelabError(f"{words[0]} has not written {path}: let RVELAB_PYTHON name a Python that has numpy, h5py and "
                          "matplotlib" + (f"; it said {done.stdout.strip()[:200]!r}" if done.stdout.strip() else ""))
    return Picture(path, done.stdout.strip(), kept if output is None else None)


def report(sources: _Source | Iterable[_Source], output: str | os.PathLike[str], *, title: str | None = None,
           overwrite: bool = False) -> Path:
    """One HTML page about tests, all figures within it: `rvelab report`. Returns its path."""
    with tempfile.TemporaryDirectory(prefix="rvelab-") as folder:
        words = ["report", *_files(sources, folder), "-o", output]
        words += ["--title", title] if title else []
        ask(words + (["--force"] if overwrite else []))
    return Path(output)
