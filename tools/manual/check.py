"""What the finished site must be: every link and anchor leads somewhere, every picture is there, nothing comes from another
machine, every key, command and call stands in it."""
from __future__ import annotations

import json
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from pages import ROOT, PageError


class Page(HTMLParser):
    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.links: list[str] = []  # what a reader may follow
        self.loads: list[str] = []  # what a browser fetches by itself
        self.ids: set[str] = set()

    def handle_starttag(self, tag: str, attributes) -> None:
        have = {name: value or "" for name, value in attributes}
        if "id" in have:
            self.ids.add(have["id"])
        if tag == "a" and "href" in have:
            self.links.append(have["href"])
        elif tag == "link" and "href" in have and have.get("rel") not in ("index", "search", "next", "prev", "author"):
            self.loads.append(have["href"])
        elif "src" in have:
            self.loads.append(have["src"])


def parsed(path: Path) -> Page:
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page


def dead_links(site: Path) -> list[str]:
    pages = {path: parsed(path) for path in sorted(site.rglob("*.html")) if "files" not in path.relative_to(site).parts}
    if not pages:
        raise PageError(f"{site} holds no page")
    errors = []
    for path, page in pages.items():
        name = path.relative_to(site)
        for target in page.loads + page.links:
            parts = urlsplit(target)
            if parts.scheme == "data":
                continue
            if parts.scheme or parts.netloc:
                if target in page.loads:
                    errors.append(f"{name}: loads {target} from another machine")
                continue
            there = path if not parts.path else (path.parent / unquote(parts.path)).resolve()
            if not there.is_file():
                errors.append(f"{name}: {target} is not there")
            elif parts.fragment and there in pages and unquote(parts.fragment) not in pages[there].ids:
                errors.append(f"{name}: {target} has no such anchor")
    for sheet in site.rglob("*.css"):
        for target in re.findall(r"url\(\s*[\"']?([^)\"']+)", sheet.read_text(encoding="utf-8", errors="replace")):
            if re.match(r"(https?:)?//", target):
                errors.append(f"{sheet.relative_to(site)}: loads {target} from another machine")
    return errors


def missing_entries(site: Path, build: Path) -> list[str]:
    """Keys, commands and calls by a reading of their own, so that a list that is cut short is noticed."""
    errors = []

    def need(page: str, names, what: str) -> None:
        text = (site / page).read_text(encoding="utf-8")
        names = list(names)
        if not names:
            errors.append(f"{page}: there is no {what} to look for")
        for name in names:
            if not re.search(rf"(?<![\w.]){re.escape(name)}(?![\w.]*\w)", text):
                errors.append(f"{page}: the {what} {name} is missing")

    listed = subprocess.run([build / "bin" / "rvelab", "keys"], capture_output=True, text=True, check=True).stdout
    need("keys.html", re.findall(r"^([a-z][\w.]*)  \(", listed, re.M), "key")
    header = (ROOT / "include/rvelab/rvelab.h").read_text()
    need("c_api.html", re.findall(r"^\S+ (rvelab_\w+)\(", header, re.M) + re.findall(r"^#define (RVELAB_\w+) ", header, re.M)
         + re.findall(r"^\} (rvelab_\w+);", header, re.M), "name")
    commands = (ROOT / "rvelab/cli").glob("*.cpp")
    described = set()
    for path in commands:
        described |= set(re.findall(r"add_subcommand\(\s*\"([a-z-]+)\"", path.read_text()))
    need("commands.html", sorted(f"rvelab {name}" for name in described), "command")
    return errors


def main(site: Path, build: Path) -> None:
    errors = dead_links(site) + missing_entries(site, build)
    for path in site.rglob("*.html"):
        if str(build) in path.read_text(encoding="utf-8"):
            errors.append(f"{path.relative_to(site)}: names a folder of this machine, {build}")
    if not (site / "searchindex.js").is_file():
        errors.append("searchindex.js is missing: the site has no search")
    if errors:
        raise PageError("\n".join(errors))


if __name__ == "__main__":
    try:
        main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
    except PageError as error:
        sys.exit(f"manual: {error}")
