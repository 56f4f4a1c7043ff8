"""The checks of the manual find what they are for: test_manual.py FOLDER BUILD. Small manuals, each with one mistake, in a copy
of tools/manual; the message must name file, line and cause. Exit code 0: all were found, and a page without a mistake passes."""
from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

folder, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
root = Path(__file__).resolve().parents[2]
shutil.rmtree(folder, ignore_errors=True)
tree = folder / "tree"
shutil.copytree(root / "tools/manual", tree / "tools/manual", ignore=shutil.ignore_patterns("pages", "__pycache__"))
pages = tree / "tools/manual/pages"
pages.mkdir()
for name in ("include", "rvelab", "protocols", "tests"):
    (tree / name).mkdir()
(tree / "include/rvelab").mkdir()
shutil.copy(root / "include/rvelab/rvelab.h", tree / "include/rvelab")
shutil.copytree(root / "rvelab/cli", tree / "rvelab/cli", ignore=shutil.ignore_patterns("*.md"))
for name in ("tools/mpm/scene", ):  # what generated pages link to
    (tree / name).mkdir(parents=True)
    (tree / name / "README.md").write_text("# Keys of a scene\n")
(pages / "index.md").write_text("# A manual\n\n## Part\n\n- [One](one.md): a page\n- [Keys](keys.md): keys\n"
                                "- [Commands](commands.md): commands\n- [C](c_api.md): calls\n- [Host](host_c.md): a host\n")
(pages / "host_c.md").write_text("# A host\n")
failures = 0


def build_manual(page: str, *words: str, readme: str = "# A program\n") -> tuple[int, str]:
    (pages / "one.md").write_text("# One\n\n" + page)
    (tree / "README.md").write_text(readme)
    done = subprocess.run([sys.executable, "-B", tree / "tools/manual/build", folder / "site", "--build", build, *words],
                          capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def expect(what: str, code: int, wanted: int, said: str, *parts: str) -> None:
    global failures
    missing = [part for part in parts if part not in said]
    good = code == wanted and not missing
    print(("passed: " if good else "FAILED: ") + what)
    if not good:
        failures += 1
        print(f"  exit code {code}, asked {wanted}; not said: {missing}\n  " + said.strip().replace("\n", "\n  "))


def refused(what: str, page: str, *parts: str, words=("--only", "run"), **more) -> None:
    code, said = build_manual(page, *words, **more)
    expect(what, code, 1, said, *parts)


fence = "```"
refused("a block that fails", f"{fence}bash\ntrue\nrvelab no_such_command\n{fence}\n", "one.md:3", "no_such_command", "failed")
refused("a block in the middle of a page", f"{fence}bash\ntrue\n{fence}\n\n{fence}bash\nfalse\n{fence}\n", "one.md:7", "failed")
refused("a block of README.md that fails", "", "README.md:3", "failed", readme=f"# A program\n\n{fence}bash\nfalse\n{fence}\n")
refused("Python that fails", f"{fence}python\nimport no_such_module\n{fence}\n", "one.md:3", "no_such_module")
refused("a block that should fail and does not", f"<!-- fails: 2 -->\n{fence}bash\ntrue\n{fence}\n", "exit code 0 instead of 2")
refused("C that nothing compiles", f"{fence}c\nint main(void) {{ return 0; }}\n{fence}\n", "one.md:3", "a c block that nothing tests")
refused("a file that no block uses", f"<!-- file: lost.toml -->\n{fence}toml\na = 1\n{fence}\n", "one.md:4", "lost.toml", "no block uses")
refused("a command that hides in text", f"{fence}text\nrvelab pack pack_dense -o S.h5\n{fence}\n", "one.md:4", "a command in a text block")
refused("a kind that is not known", f"{fence}shell\ntrue\n{fence}\n", "one.md:3", 'of kind "shell"')
refused("output that was not printed", f"{fence}bash\necho one\n{fence}\n\n{fence}output\ntwo\n{fence}\n", "one.md:7", '"two"')
refused("a marker with a mistake", f"<!-- not run -->\n{fence}bash\ntrue\n{fence}\n", "one.md:3", "not run: why")
(pages / "two.md").write_text("# Two\n")
refused("a page that is in no list", "", "two.md", "not in the lists")
(pages / "two.md").unlink()

try:
    import furo  # noqa: F401
    import myst_parser  # noqa: F401
except ImportError as error:
    print(f"SKIPPED, sites of broken pages were NOT made: {error}; apt-get install furo python3-myst-parser, or tools/setup tests")
else:
    def broken(what: str, page: str, *parts: str) -> None:
        refused(what, page, *parts, words=())

    broken("a dead link", "See [there](gone.md).\n", "one.md:3", "a link to gone.md")
    broken("a dead link to a file", "See [there](../../../rvelab/gone.hpp).\n", "one.md:3", "gone.hpp")
    broken("a picture that no block made", "![A picture](gone.png)\n", "one.md:3", "gone.png", "no block")
    refused("a dead link in README.md", "", "README.md:3", "gone.md", words=(), readme="# A program\n\n[there](gone.md)\n")
    broken("a dead anchor", "See [there](host_c.md#gone).\n", "one.md", "gone")
    broken("an equation that cannot be drawn", "$\\nosuchsymbol{x}$\n", "cannot be drawn")
    broken("a picture from another machine", '<img src="https://example.org/x.png" alt="x">\n', "example.org", "another machine")
    code, said = build_manual(f"$\\sigma$, [a host](host_c.md#a-host)\n\n{fence}bash\necho one two\n{fence}\n\n{fence}output\none\n{fence}\n")
    site = (folder / "site/one.html")
    expect("a page without a mistake", code, 0, said + (site.read_text() if site.exists() else ""), "one two", "<math")
sys.exit(1 if failures else 0)
