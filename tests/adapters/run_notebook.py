"""Executes the code cells of a notebook in one namespace, as a kernel would: run_notebook.py NOTEBOOK FOLDER.

The last expression of a cell is shown as a notebook shows it: an object that has no picture and no text to show fails.
Outputs must be stripped in the file. The folder is made anew and is the working folder."""
import ast
import json
import os
import shutil
import sys
import traceback
from pathlib import Path


def shown(value: object) -> str:
    """What the notebook displays: the richest form that the object offers."""
    bundle = value._repr_mimebundle_() if hasattr(value, "_repr_mimebundle_") else {"text/plain": repr(value)}
    kind = next((kind for kind in ("image/png", "image/svg+xml", "text/html") if kind in bundle), "text/plain")
    if not bundle[kind]:
        raise AssertionError(f"{value!r} shows nothing")
    return f"{kind}, {len(bundle[kind])} bytes" if kind != "text/plain" else str(bundle[kind])


def execute(source: str, names: dict, place: str) -> None:
    tree = ast.parse(source, place)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, place, "exec"), names)
    if last is not None:
        value = eval(compile(ast.Expression(last.value), place, "eval"), names)
        if value is not None:
            print(shown(value))


def main(notebook: Path, folder: Path) -> int:
    content = json.loads(notebook.read_text(encoding="utf-8"))
    code = [cell for cell in content["cells"] if cell["cell_type"] == "code"]
    if not code or any(cell["outputs"] or cell["execution_count"] for cell in code):
        print(f"{notebook}: has no code, or outputs that are not stripped", file=sys.stderr)
        return 1
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    os.chdir(folder)
    names = {"__name__": "__main__"}
    for number, cell in enumerate(code, 1):
        try:
            execute("".join(cell["source"]), names, f"{notebook.name}, code cell {number}")
        except BaseException:
            traceback.print_exc()
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2])))
