#!/usr/bin/env python3
"""Makes the wheel of rvelab from a build: wheel_builder.py [FOLDER] (default: the folder build/release/wheel).

It is the backend of pyproject.toml, so `pip wheel --no-build-isolation --no-deps tools/python` and `pip install`
also work, offline. The wheel contains the modules and, under rvelab/native, both libraries, the programs, the protocols with
the curves that fits compare with, and the scripts of the figures. RVELAB_BUILD names another build, or the prefix of an
installation. The same build gives the same bytes.
Its name shows its requirements: manylinux_2_N for a portable build (tools/package), linux if it needs libraries of this
machine.
"""

import base64
import hashlib
import os
import pathlib
import re
import sys
import tomllib
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))  # pip imports this file from elsewhere
from elf_needs import Needs, is_elf  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PROGRAMS = "bin/rvelab", "bin/rvelab-mpm"
FIRST_DAY = (1980, 1, 1, 0, 0, 0)  # of the zip format: no dates in the wheel


def build_folder():
    return pathlib.Path(os.environ.get("RVELAB_BUILD", ROOT / "build/release"))


def native_files():
    """(name in rvelab/native, file) of the build; SystemExit names a missing file."""
    build = build_folder()
    found = [(f"lib/{name}", build / "lib" / name) for name in ("librvelab.so.1", "librvelab-h5.so.1")]
    found += [(program, build / program) for program in PROGRAMS]
    for folder, ending in (("share/rvelab/protocols", "*.toml"), ("share/rvelab/protocols", "*.csv"),
                           ("share/rvelab/plot", "*.py")):
        files = sorted((build / folder).rglob(ending))
        found += [(f"{folder}/{file.relative_to(build / folder)}", file) for file in files]
        if not files:
            found.append((folder, build / folder / ending))
    for name, file in found:
        if not file.is_file():
            raise SystemExit(f"wheel_builder: {file} is not there; build first (cmake --preset release && cmake --build "
                             "--preset release), or let RVELAB_BUILD name a build")
    return found


def version():
    return re.search(r'version = "([0-9.]+)"', (ROOT / "rvelab/io/version.hpp").read_text()).group(1)


def platform_tag():
    return "py3-none-" + Needs([file for _, file in native_files() if is_elf(file)]).platform_tag()


def licences():
    """(name, bytes) of the licence of rvelab and, if the installation has them, of compiled-in libraries."""
    yield "LICENSE", (ROOT / "LICENSE").read_bytes()
    for file in sorted((build_folder() / "share/doc/rvelab/licences").glob("*")):
        yield f"licences/{file.name}", file.read_bytes()


def metadata(project):
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version()}", f"Summary: {project['description']}",
             f"License: {project['license']['text']}", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {needed}" for needed in project["dependencies"]]
    for extra, packages in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {needed}; extra == "{extra}"' for needed in packages]
    return "\n".join([*lines, "Description-Content-Type: text/markdown", "", (HERE / project["readme"]).read_text()])


def contents():
    """(name in the wheel, bytes, is a program) of all but RECORD."""
    project = tomllib.loads((HERE / "pyproject.toml").read_text())["project"]
    info = f"rvelab-{version()}.dist-info"
    for file in [HERE / "micro_simulation.py", *sorted((HERE / "rvelab").glob("*.py"))]:
        yield str(file.relative_to(HERE)), file.read_bytes(), False
    for file in sorted((ROOT / "tools/fenicsx").glob("*.py")):
        yield f"rvelab/fenicsx/{file.name}", file.read_bytes(), False
    for name, file in native_files():
        yield f"rvelab/native/{name}", file.read_bytes(), name in PROGRAMS
    yield f"{info}/METADATA", metadata(project).encode(), False
    wheel = f"Wheel-Version: 1.0\nGenerator: wheel_builder\nRoot-Is-Purelib: false\nTag: {platform_tag()}\n"
    yield f"{info}/WHEEL", wheel.encode(), False
    scripts = "".join(f"{name} = {place}\n" for name, place in project["scripts"].items())
    yield f"{info}/entry_points.txt", f"[console_scripts]\n{scripts}".encode(), False
    for name, text in licences():
        yield f"{info}/{name}", text, False


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """PEP 517: writes the wheel and returns its name."""
    name = f"rvelab-{version()}-{platform_tag()}.whl"
    record = f"rvelab-{version()}.dist-info/RECORD"
    rows = []
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        def add(place, content, is_program):
            entry = zipfile.ZipInfo(place, FIRST_DAY)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if is_program else 0o100644) << 16
            wheel.writestr(entry, content)
        for place, content, is_program in contents():
            add(place, content, is_program)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            rows.append(f"{place},sha256={digest},{len(content)}")
        add(record, "\n".join([*rows, f"{record},,", ""]).encode(), False)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """PEP 517 wants it; a wheel needs the build of a checkout."""
    raise SystemExit("wheel_builder: a source distribution cannot be built without the checkout; make the wheel")


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else build_folder() / "wheel"
    folder.mkdir(parents=True, exist_ok=True)
    print(folder / build_wheel(folder))
