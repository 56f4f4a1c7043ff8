"""What the parts of tools/validate are called with that test ensembles of specimens."""
import argparse
import pathlib


def options(documentation):
    """PROGRAM WORK [FIGURE] [--count]: .program, .work (made), .figure or None, .count of specimens."""
    parser = argparse.ArgumentParser(description=documentation.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("figure", nargs="?")
    parser.add_argument("--count", type=int, default=5)
    found = parser.parse_args()
    found.program = str(pathlib.Path(found.program).resolve())
    found.work.mkdir(parents=True, exist_ok=True)
    return found
