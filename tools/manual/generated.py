"""Pages that are made of what the programs and the header say of themselves: keys, commands, the C interface."""
from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

from pages import ROOT, PageError

STAGE = "stage."


def _said(*command: str | Path) -> str:
    done = subprocess.run([str(each) for each in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise PageError(f"{' '.join(map(str, command))} ended with exit code {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def plain(text: str) -> str:
    """Text as it is, with nothing in it that Markdown takes for more; `code` stays code."""
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(part if part.startswith("`") and len(part) > 2 else re.sub(r"([\\`*_\[\]<>$|#~])", r"\\\1", part)
                   for part in parts)


# ---- keys ----

TABLES = {"test": "[test]", "loading": "[loading]", "output": "[output]", "specimen": "[specimen]",
          "pack": "[pack], of a recipe", "grains": "[grains], or [[grains]] for each fraction of a mixture, of a recipe",
          "target": "[target], of a recipe", "preparation": "[preparation], of a recipe",
          "material": "[material], and [[material]] of a material file"}


def heading(table: str, kinds: set[str]) -> str:
    """`stage.compression` is a kind of stage; below it `stage.compression.until` is a table of its own."""
    if table == "stage":
        return "[[stage]], of every kind"
    if table.startswith(STAGE):
        name, _, rest = table.removeprefix(STAGE).partition(".")
        return f'[[stage]] kind = "{name}"' + (f", [[stage.{rest}]]" if rest else "")
    return TABLES.get(table, f"[{table}]")


def keys_page(program: Path, scene_keys: str) -> str:
    keys = json.loads(_said(program, "keys", "--json"))["keys"]
    tables: dict[str, list[dict]] = {}
    for key in keys:
        tables.setdefault(key["table"], []).append(key)
    out = ["# All keys", "",
           f"The {len(keys)} keys of protocols, recipes and material files, as `rvelab keys` prints them; `rvelab keys WORD` prints "
           "those with WORD in their name. A default in brackets is computed. "
           "Defaults of contact, damping, solver and material are those of a new specimen: in a test, what is not set stays as the "
           f"specimen has it. Scenes of rvelab-mpm have [keys of their own]({scene_keys}).", ""]
    for table, members in tables.items():
        out += [f"## {plain(heading(table, set(tables)))}", ""]
        for key in members:
            facts = [key["type"] + ("" if key["unit"] in ("-", "1") else f" in {key['unit']}"), f"allowed: {key['range']}"]
            if key["usual"]:
                facts.append(f"usual: {key['usual']}")
            facts.append("required" if key["required"] else f"default {key['default']}" if key["default"] else "no default")
            out += [f"`{key['key']}`", f": {plain(key['meaning'])}", "", f"  *{plain('; '.join(facts))}*", ""]
    return "\n".join(out)


# ---- commands ----


def _help(program: Path, *words: str) -> str:
    text = _said(program, *words, "--help").rstrip()
    return re.sub(r"Usage: \S*/(rvelab\S*)", r"Usage: \1", text)


def commands_page(folder: Path) -> str:
    rvelab = folder / "rvelab"
    overall = _help(rvelab)
    listed = overall.split("Subcommands:", 1)[-1].split("\n\n", 1)[0]
    names = re.findall(r"^  ([a-z][a-z-]*) ", listed, re.M)
    if not names:
        raise PageError("the help of rvelab lists no subcommand")
    out = ["# All commands", "", "The output of `--help` of each program.", "", "## rvelab", "", "````text", overall,
           "````", ""]
    for name in names:
        out += [f"### rvelab {name}", "", "````text", _help(rvelab, name), "````", ""]
    for name, where in (("rvelab-mpm", ""), ("rvelab-voids", "It is built where CGAL is installed.")):
        out += [f"## {name}", ""] + ([where, ""] if where else [])
        if (folder / name).exists():
            out += ["````text", _help(folder / name), "````", ""]
        else:
            out += ["This manual was made by a build without it.", ""]
    return "\n".join(out)


# ---- the C interface ----

COMMENT = re.compile(r"/\*(.*?)\*/", re.S)


def _text(comment: str) -> list[str]:
    """Paragraphs of a comment, without its stars. Lines that are lined up like a table stay lines."""
    lines = [re.sub(r"^ ?\* ?", "", line).rstrip() for line in comment.strip().splitlines()]
    lines[0] = lines[0].strip()
    return "\n".join(lines).strip().split("\n\n")


def _prose(comment: str) -> list[str]:
    out = []
    for paragraph in _text(comment):
        if re.search(r"^\w+ {3,}\S", paragraph, re.M):
            for entry in re.split(r"\n(?=\w+ {2,}\S)", paragraph):  # lined up like a table: name, what it is
                name, _, rest = entry.partition(" ")
                out += [f"`{name}`", f": {plain(' '.join(rest.split()))}", ""]
        else:
            out += [plain(" ".join(line.strip() for line in paragraph.splitlines())), ""]
    return out


def _pieces(text: str):
    """Comments and declarations of a header, in their order. A comment within a struct belongs to it."""
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.S)
    at = 0
    token = re.compile(r"/\*.*?\*/|typedef struct \w+ \{.*?\} \w+;|typedef [^{;]*;|#define RVELAB_[^\n]*|"
                       r"(?:int32_t|int64_t|const char\*) rvelab_\w+\([^;]*\);", re.S)
    for match in token.finditer(text, at):
        piece = match[0]
        yield ("comment" if piece.startswith("/*") else "code"), piece, text[match.end():match.end() + 2]


def c_api_page(header: Path, link) -> str:
    text = header.read_text(encoding="utf-8")
    out = ["# The C interface", "",
           f"Made from {link(header)}, version {'.'.join(re.findall(r'RVELAB_ABI_M..OR (.)', text))}. "
           "How a host uses it: [In C and C++](host_c.md). " + (
               f"Ranks of MPI: {link(ranks)}." if (ranks := header.with_name("rvelab_mpi.h")).exists() else ""), ""]
    waiting: list[str] = []  # prose above a declaration
    defines: list[str] = []
    first = True

    def flush() -> None:
        nonlocal defines
        if defines:
            out.extend(["````c", *defines, "````", ""])
            defines = []

    for kind, piece, _after in _pieces(text):
        if kind == "comment":
            inside = COMMENT.match(piece)[1]
            section = re.match(r"\s*---- (.*?) ----", inside)
            if re.match(r" RVELAB_RVELAB_H", inside):
                continue
            if defines and not section and "\n" not in inside and text[: text.index(piece)].rsplit("\n", 1)[-1].strip():
                defines[-1] += f" {piece}"  # beside its macro
                continue
            flush()
            if waiting:
                out.extend(waiting)
                waiting = []
            if section:
                title, _, aside = section[1].partition(": ")
                out.extend([f"## {title[0].upper()}{title[1:]}", ""])
                waiting = ([plain(aside[0].upper() + aside[1:] + "."), ""] if aside else [])
                rest = inside[section.end():].strip(" *\n")
                waiting += _prose(rest) if rest else []
                out.extend(waiting)
                waiting = []
            elif first:
                out.extend(_prose(inside))
                first = False
            else:
                waiting = _prose(inside)
        elif piece.startswith("#define"):
            if re.search(r"RVELAB_RVELAB_H\b", piece):
                continue
            if waiting:
                out.extend(waiting)
                waiting = []
            code = piece.split("/*")[0].rstrip() if piece.count("/*") > piece.count("*/") else piece
            defines.append(code)
            if code != piece:  # its comment goes on over the line
                begin = text.index(piece) + len(code)
                defines[-1] = code + " " + COMMENT.search(text, begin)[0]
        else:
            flush()
            name = re.search(r"(rvelab_\w+)\(", piece) or re.search(r"(rvelab_\w+);$", piece) or re.search(r"\*(rvelab_\w+)\)", piece)
            called = re.search(r"\(\*(rvelab_\w+)\)", piece)
            title = (called or name)[1]
            out.extend([f"### {plain(title)}", "", "````c", piece, "````", "", *waiting])
            waiting = []
    flush()
    return "\n".join(out) + "\n"


def write(build: Path, folder: Path, link, scene_keys: str = "tree/tools_mpm_scene.md") -> None:
    """`link`: a file of the tree as a link of the site. `scene_keys`: where the keys of scenes stand."""
    (folder / "keys.md").write_text(keys_page(build / "bin" / "rvelab", scene_keys), encoding="utf-8")
    (folder / "commands.md").write_text(commands_page(build / "bin"), encoding="utf-8")
    (folder / "c_api.md").write_text(c_api_page(ROOT / "include" / "rvelab" / "rvelab.h", link), encoding="utf-8")


if __name__ == "__main__":  # generated.py BUILD FOLDER: the pages beside an installation's
    write(Path(sys.argv[1]), Path(sys.argv[2]), lambda file: f"`{file.name}`", "../../mpm/scene/README.md")
