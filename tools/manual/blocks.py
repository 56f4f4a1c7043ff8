"""Runs the blocks of pages in a folder that looks like a checkout with a build, and keeps what each printed."""
from __future__ import annotations

import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from pages import ROOT, Block, PageError, blocks_of, name_of, pages

SECONDS = 240  # of a page, on a machine with other work


def checkout(folder: Path, build: Path) -> Path:
    """A folder like the root of the tree: what is looked up there, as links; what is made there stays in the folder."""
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "build").mkdir(parents=True)
    for name in ("tools", "protocols", "include", "rvelab", "tests", "README.md"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "build" / "release").symlink_to(build)
    return folder


def environment(folder: Path) -> dict[str, str]:
    # RVELAB_LIBRARY, RVELAB_PROGRAM: the package looks for build/release, and this build may have another name.
    return {**os.environ, "PATH": f"{folder}/build/release/bin:{os.environ['PATH']}",
            "PYTHONPATH": f"{folder}/tools/python", "RVELAB_PROGRAM": f"{folder}/build/release/bin/rvelab",
            "RVELAB_LIBRARY": f"{folder}/build/release/lib/librvelab.so.1", "PYTHONDONTWRITEBYTECODE": "1",
            "MPLBACKEND": "Agg", "LC_ALL": "C.UTF-8"}


def outputs_of(page: Path, kept: Path) -> list[str]:
    """What each block of a page printed, empty where it did not run."""
    file = kept / f"{page.stem}.json"
    if not file.exists():
        raise PageError(f"{name_of(page)}: its blocks have not run to the end; run them first (without --only site)")
    return json.loads(file.read_text())


def lacks(block: Block, folder: Path) -> bool:
    """Whether the build is without a program that the block needs."""
    return block.needs is not None and not (folder / "build/release/bin" / block.needs).exists()


def _script(page: Path, found: list[Block], scratch: Path, folder: Path) -> str:
    """One shell for the whole page, so that what a block exports holds for the next."""
    lines = ["set -euo pipefail"]
    for number, block in enumerate(found):
        if block.not_run or block.kind in ("text", "output") or lacks(block, folder):
            continue
        source = scratch / f"{page.stem}_{number}"
        source.write_text(block.text)
        lines.append(f"echo {number} >{scratch}/at; date +%s.%N >{scratch}/{page.stem}_{number}.begin")
        to = f">{scratch}/{page.stem}_{number}.out 2>&1 </dev/null"
        if block.file:
            lines.append(f"mkdir -p $(dirname {shlex.quote(block.file)}); cp {source} {shlex.quote(block.file)}")
        elif block.kind == "python":
            lines.append(f"/usr/bin/python3 {source} {to}")
        elif block.fails:
            lines.append(f"code=0; bash -euo pipefail {source} {to} || code=$?\n"
                         f"[ $code -eq {block.fails} ] || {{ echo \"exit code $code instead of {block.fails}\""
                         f" >>{scratch}/{page.stem}_{number}.out; exit 1; }}")
        else:
            lines.append(f"{{\n{block.text}\n}} {to}")
        lines.append(f"date +%s.%N >{scratch}/{page.stem}_{number}.end")
    return "\n".join(lines) + "\n"


def run_page(page: Path, folder: Path, kept: Path, seconds: float = SECONDS, tell=print) -> float:
    """Runs the blocks of one page, in order, in `folder`; what they printed goes to `kept`. PageError at the first that
    fails, with its place and what it printed. Returns the seconds it took."""
    found = blocks_of(page)
    scratch = kept / "scratch"
    scratch.mkdir(parents=True, exist_ok=True)
    (scratch / "at").write_text("-1")
    begin = time.monotonic()
    # A group of its own: what a block has left running ends with the page.
    process = subprocess.Popen(["bash", "-c", _script(page, found, scratch, folder)], cwd=folder, env=environment(folder),
                               start_new_session=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    late = False
    try:
        said, _ = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        late = True
        os.killpg(process.pid, signal.SIGKILL)
        said, _ = process.communicate()
    printed = []
    for number in range(len(found)):
        out = scratch / f"{page.stem}_{number}.out"
        if lacks(found[number], folder):
            tell(f"  left out: {found[number].place} needs {found[number].needs}, which this build lacks")
            printed.append(f"({found[number].needs} was not built)\n")
        else:
            printed.append(out.read_text(errors="replace") if out.exists() else "")
    if process.returncode != 0:
        block = found[int((scratch / "at").read_text())]
        tail = (printed[found.index(block)] + said).strip().splitlines()[-15:]
        cause = f"was not done after {seconds:.0f} s" if late else "failed"
        raise PageError(f"{block.place}: the block {cause}:\n" + "".join(f"    {line}\n" for line in block.text.splitlines())
                        + "it printed:\n" + "".join(f"    {line}\n" for line in tail))
    for number, block in enumerate(found):
        if block.kind == "output":
            selected(block, printed_before(found, printed, number))  # each line that is asked for was printed
    (kept / f"{page.stem}.json").write_text(json.dumps(printed))
    return time.monotonic() - begin


def printed_before(found: list[Block], printed: list[str], number: int) -> str:
    """What the last block before an output block printed that ran."""
    return next(printed[k] for k in range(number - 1, -1, -1) if found[k].kind in ("bash", "python") and not found[k].not_run)


def selected(block: Block, printed: str) -> str:
    """The lines of `printed` that an output block asks for: all, or those that one of its lines is part of."""
    wanted = [line.strip() for line in block.text.splitlines() if line.strip()]
    lines = printed.splitlines()
    for line in wanted:
        if not any(line in each for each in lines):
            raise PageError(f"{block.place}: \"{line}\" is not in what the block before printed:\n"
                            + "".join(f"    {each}\n" for each in lines[-20:]))
    shown = [each for each in lines if not wanted or any(line in each for line in wanted)]
    return "".join(line.rstrip() + "\n" for line in shown)


def run(build: Path, work: Path, tell=print) -> None:
    """All pages in one folder, README.md of the root in another."""
    build = build.resolve()
    for program in ("rvelab", "rvelab-mpm"):
        if not (build / "bin" / program).exists():
            raise PageError(f"{build}/bin/{program} is missing; build it, or name a build by --build")
    kept = work / "printed"
    shutil.rmtree(kept, ignore_errors=True)
    kept.mkdir(parents=True)
    readme = checkout(work / "readme", build)
    tell(f"{run_page(ROOT / 'README.md', readme, kept):6.1f} s  README.md")
    folder = checkout(work / "run", build)
    for page in pages():
        seconds = run_page(page, folder, kept)
        if blocks_of(page):
            tell(f"{seconds:6.1f} s  {name_of(page)}")
            sys.stdout.flush()
