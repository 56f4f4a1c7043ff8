"""What a page of the manual is: its blocks with the markers above them, its links. The rules: README.md."""
from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = Path(__file__).resolve().parent / "pages"

FENCE = re.compile(r"^(?P<indent> *)```(?P<kind>[a-z0-9+]*) *$")
MARKER = re.compile(r"^ *<!-- (?P<what>not run|needs|file|fails): (?P<value>.*\S) -->$")
RUN = {"bash", "python"}
WRITTEN = {"c", "cpp", "fortran", "toml", "cmake", "xml", "json", "ini"}
SHOWN = {"text", "output"}
COMMAND = re.compile(r"^\s*(\$ |rvelab(-mpm|-voids)? |tools/|cmake |ctest |apt|pip |python3 |/usr/bin/python3 |mpirun )")


class PageError(Exception):
    """A mistake in a page, with its file and line."""


@dataclass
class Block:
    page: Path
    line: int  # of the opening fence, from 1
    end: int  # of the closing one
    kind: str
    text: str
    not_run: str | None = None
    needs: str | None = None  # a program without which the block is left out
    file: str | None = None
    fails: int = 0

    @property
    def place(self) -> str:
        return f"{name_of(self.page)}:{self.line}"


def name_of(path: Path) -> str:
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else str(path)


def read(page: Path) -> list[str]:
    return page.read_text(encoding="utf-8").splitlines()


def blocks_of(page: Path) -> list[Block]:
    """The blocks of a page, each checked against the rules of README.md."""
    lines, found, at = read(page), [], 0
    while at < len(lines):
        opening = FENCE.match(lines[at])
        if not opening:
            at += 1
            continue
        indent = len(opening["indent"])
        end = next((k for k in range(at + 1, len(lines)) if lines[k].strip() == "```"), None)
        if end is None:
            raise PageError(f"{name_of(page)}:{at + 1}: the block has no end; close it with ```")
        text = "".join(line[indent:] + "\n" for line in lines[at + 1 : end])
        block = Block(page, at + 1, end + 1, opening["kind"], text)
        marker = MARKER.match(lines[at - 1]) if at else None
        if marker:
            what, value = marker["what"], marker["value"]
            if what == "not run":
                block.not_run = value
            elif what == "needs":
                block.needs = value
            elif what == "file":
                block.file = value
            elif not value.isdigit() or int(value) == 0:
                raise PageError(f"{name_of(page)}:{at}: fails: {value} is no exit code; write a number above 0")
            else:
                block.fails = int(value)
        elif at and lines[at - 1].lstrip().startswith("<!--"):
            raise PageError(f"{name_of(page)}:{at}: {lines[at - 1].strip()} is no marker; write <!-- not run: why -->, "
                            "<!-- file: NAME -->, <!-- needs: PROGRAM --> or <!-- fails: N -->")
        _check(block, found)
        found.append(block)
        at = end + 1
    for number, block in enumerate(found):
        later = "".join(each.text for each in found[number + 1 :] if each.kind in RUN and not each.not_run)
        if block.file and block.file.rsplit("/", 1)[-1] not in later:
            raise PageError(f"{block.place}: {block.file} is a file that no block uses; add the command that does")
    return found


def _check(block: Block, before: list[Block]) -> None:
    if block.kind in SHOWN:
        if block.kind == "output" and not any(b.kind in RUN and not b.not_run for b in before):
            raise PageError(f"{block.place}: an output block without a block before it that runs")
        if block.kind == "text":
            for number, line in enumerate(block.text.splitlines(), block.line + 1):
                if COMMAND.match(line):
                    raise PageError(f"{name_of(block.page)}:{number}: a command in a text block; make it a bash block, "
                                    "with <!-- not run: why --> above it where it cannot run")
    elif block.kind in RUN:
        if block.file:
            raise PageError(f"{block.place}: a {block.kind} block runs and is no file; leave out <!-- file: ... -->")
    elif block.kind in WRITTEN:
        if not block.file and not block.not_run:
            raise PageError(f"{block.place}: a {block.kind} block that nothing tests; write <!-- file: NAME --> above it "
                            "and use the file in a bash block, or <!-- not run: why -->")
    else:
        allowed = ", ".join(sorted(RUN | WRITTEN | SHOWN))
        raise PageError(f"{block.place}: a block of kind \"{block.kind}\"; allowed: {allowed}")


ENTRY = re.compile(r"^- \[(?P<title>[^\]]+)\]\((?P<file>[a-z0-9_]+\.md)\)")


def order() -> list[tuple[str, list[str]]]:
    """The parts of the manual with their pages, in the order of reading: the lists of pages/index.md."""
    parts: list[tuple[str, list[str]]] = []
    for line in read(PAGES / "index.md"):
        if line.startswith("## "):
            parts.append((line[3:], []))
        elif (entry := ENTRY.match(line)) and parts:
            parts[-1][1].append(entry["file"])
    parts = [(title, pages) for title, pages in parts if pages]
    listed = [page for _, pages in parts for page in pages]
    there = {path.name for path in PAGES.glob("*.md")} - {"index.md"}
    for page in sorted(there - set(listed)):
        raise PageError(f"{name_of(PAGES / page)}: the page is not in the lists of pages/index.md; add it")
    if doubles := sorted({page for page in listed if listed.count(page) > 1}):
        raise PageError(f"pages/index.md: {', '.join(doubles)} stands twice")
    return parts


def pages() -> list[Path]:
    """Every page of pages/, in the order of reading; pages that are generated are left out."""
    names = ["index.md"] + [name for _, part in order() for name in part]
    return [PAGES / name for name in names if (PAGES / name).exists()]
