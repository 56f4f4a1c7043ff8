"""Pages as Sphinx takes them: what blocks printed and drew is put in, links of the tree become links of the site.

A page of pages/ keeps its name. Every README.md and .md of the tree becomes tree/<folder>_<name>.md, so that developers find
them by the same search; another file that is linked is copied to files/, and the link leads to the copy.
"""
from __future__ import annotations

import html
import os
import re
import shutil
import subprocess
from pathlib import Path

import blocks
from pages import FENCE, MARKER, PAGES, ROOT, PageError, blocks_of, name_of, order, pages, read

LINK = re.compile(r"(?P<image>!?)\[(?P<text>(?:[^\[\]]|\[[^\[\]]*\])*)\]\((?P<target>[^()\s]+)\)")
CODE = re.compile(r"(`+)(.+?)\1(?!`)")
GENERATED = ("keys.md", "commands.md", "c_api.md")


def tracked() -> list[Path]:
    """Markdown of the tree beside the pages: what git knows, or where there is no git what is there."""
    def git(*words: str) -> str:
        done = subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else ""

    top = git("rev-parse", "--show-toplevel").strip()  # a tree that was unpacked into the checkout of another has none
    if top and Path(top).resolve() == ROOT:
        found = [ROOT / line for line in git("ls-files", "-co", "--exclude-standard", "*.md").splitlines()]
    else:
        found = [path for path in ROOT.rglob("*.md") if "build" not in path.relative_to(ROOT).parts]
    return sorted(path for path in found if path.exists() and path.parent != PAGES)


def site_name(path: Path) -> str:
    """Where a Markdown file of the tree stands in the site, without its ending."""
    if path.parent == PAGES:
        return path.stem
    parts = path.relative_to(ROOT).with_suffix("").parts
    parts = parts[:-1] if parts[-1] == "README" and len(parts) > 1 else parts
    return "tree/" + "_".join(part.lstrip(".") for part in parts)


class Source:
    """The folder that Sphinx reads: `folder`; files beside the pages: `extra`."""

    def __init__(self, work: Path, build: Path) -> None:
        # Paths of this machine in what programs print, and what they are for a reader.
        self.places = {str(build): "build/release", str(work / "run") + "/": "", str(ROOT) + "/": ""}
        self.work, self.folder, self.extra = work, work / "source", work / "extra"
        for each in (self.folder, self.extra):
            shutil.rmtree(each, ignore_errors=True)
            each.mkdir(parents=True)
        self.errors: list[str] = []
        self.seen: set[Path] = set()  # files copied so far

    # ---- links ----

    def _file(self, path: Path, into: Path) -> str:
        """Copies a file of the tree beside the pages, once."""
        name = "/".join(path.relative_to(ROOT).parts)
        target = into / name
        if target not in self.seen:
            self.seen.add(target)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, target)
        return name

    def link_to(self, path: Path) -> str:
        """A link from a page of the first level to a file of the tree."""
        return f'<a href="files/{html.escape(self._file(path, self.extra / "files"))}">{path.name}</a>'

    def _link(self, match: re.Match, page: Path, line: int, depth: int, drawn: Path | None) -> str:
        target, text = match["target"], match["text"]
        if re.match(r"[a-z]+:", target) or target.startswith("#"):
            return match[0]
        place, _, anchor = target.partition("#")
        up = "../" * depth
        if match["image"]:
            if drawn is not None and "/" not in place and (drawn / place).exists():
                picture = self.folder / "pictures" / page.stem / place
                picture.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(drawn / place, picture)
                return f"![{text}]({up}pictures/{page.stem}/{place})"
            path = (page.parent / place).resolve()
            if not path.is_file():
                self.errors.append(f"{name_of(page)}:{line}: the picture {place} is not in the tree, and no block of the page "
                                   "has made it")
                return text
            return f"![{text}]({up}files/{self._file(path, self.folder / 'files')})"
        path = Path(os.path.normpath(page.parent / place))
        if path.parent == PAGES and path.name in GENERATED:
            return f"[{text}]({up}{path.name}{'#' + anchor if anchor else ''})"
        if path.is_dir() and (path / "README.md").is_file():
            path = path / "README.md"
        if not path.is_file() or not path.is_relative_to(ROOT):
            self.errors.append(f"{name_of(page)}:{line}: a link to {target}, which is not in the tree"
                               + (" (a folder without a README.md)" if path.is_dir() else ""))
            return text
        if path.suffix == ".md":
            return f"[{text}]({up}{site_name(path)}.md{'#' + anchor if anchor else ''})"
        return f'<a href="{up}files/{html.escape(self._file(path, self.extra / "files"))}">{text}</a>'

    def _links(self, lines: list[str], page: Path, first: int, depth: int, drawn: Path | None) -> list[str]:
        """Links outside of code spans, in lines that follow each other; a link may go over the end of a line."""
        text = "\n".join(lines)
        spans = [match.span() for match in CODE.finditer(text)]

        def replaced(match: re.Match) -> str:
            if any(begin < match.start() < end for begin, end in spans):
                return match[0]
            return self._link(match, page, first + text.count("\n", 0, match.start()), depth, drawn)

        return LINK.sub(replaced, text).split("\n")

    # ---- pages ----

    def page(self, path: Path, drawn: Path | None = None, printed: list[str] | None = None) -> None:
        """A Markdown file of the tree as a page of the site."""
        name = site_name(path)
        depth = name.count("/")
        lines, out, at = read(path), [], 0
        if not any(line.startswith("# ") for line in lines):
            out += [f"# {name_of(path)}", ""]
        found = {block.line: (number, block) for number, block in enumerate(blocks_of(path))} if printed is not None else {}
        caption = None
        while at < len(lines):
            line = lines[at]
            marker = MARKER.match(line)
            if marker:
                caption = marker["value"] if marker["what"] == "file" else None
                at += 1
                continue
            opening = FENCE.match(line)
            if opening:
                end = next((k for k in range(at + 1, len(lines)) if lines[k].strip() == "```"), len(lines) - 1)
                body = lines[at + 1 : end]
                if found:
                    number, block = found[at + 1]
                    if block.kind == "output":
                        all_blocks = [each for _, each in found.values()]
                        body = blocks.selected(block, blocks.printed_before(all_blocks, printed, number)).splitlines()
                        for there, shown in self.places.items():
                            body = [each.replace(there, shown) for each in body]
                indent, kind = opening["indent"], {"output": "text", "": "text"}.get(opening["kind"], opening["kind"])
                out.append(f"{indent}````{{code-block}} {kind}")
                if caption:
                    out.append(f"{indent}:caption: {caption}")
                if opening["kind"] == "output":
                    out.append(f"{indent}:class: output")
                out += ["", *(body if opening["kind"] != "output" else [indent + each for each in body]), f"{indent}````"]
                caption, at = None, end + 1
                continue
            run = [line]
            while at + len(run) < len(lines) and not MARKER.match(lines[at + len(run)]) and not FENCE.match(lines[at + len(run)]):
                run.append(lines[at + len(run)])
            out += self._links(run, path, at + 1, depth, drawn)
            at += len(run)
        target = self.folder / f"{name}.md"
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text("\n".join(out) + "\n", encoding="utf-8")

    def contents(self) -> None:
        """The order of the pages for Sphinx, hidden: readers see the lists of index.md."""
        index = self.folder / "index.md"
        text = index.read_text(encoding="utf-8")
        for title, names in order():
            names = [name.removesuffix(".md") for name in names]
            text += f"\n```{{toctree}}\n:hidden:\n:caption: {title}\n\n" + "\n".join(names) + "\n```\n"
        tree = sorted(site_name(path) for path in tracked())
        (self.folder / "tree").mkdir(exist_ok=True)
        (self.folder / "tree" / "index.md").write_text(
            "# The README files of the tree\n\nDocumentation for developers is beside the code; these are the same files.\n\n"
            "```{toctree}\n:titlesonly:\n\n" + "\n".join(name.removeprefix("tree/") for name in tree) + "\n```\n")
        text += "\n```{toctree}\n:hidden:\n:caption: In the tree\n\ntree/index\n```\n"
        index.write_text(text, encoding="utf-8")

    def everything(self) -> None:
        drawn, kept = self.work / "run", self.work / "printed"
        for path in pages():
            self.page(path, drawn, blocks.outputs_of(path, kept))
        for path in tracked():
            self.page(path)
        self.contents()
        if self.errors:
            raise PageError("\n".join(self.errors))
