#!/usr/bin/env python3
"""A report of laboratory tests as one HTML page: report.py DIR|RECORDS.h5... -o report.html (folders: their *.h5).

For each test (name and dimension) what was asked, the specimen, results, curves, Mohr circles with their interval, contact
rose, force chains, a film where a file has snapshots, error and run time. All figures are within the page; it loads
nothing.
"""

import argparse
import base64
import html
import json
import os
import pathlib
import re
import shutil
import tempfile

import records  # first: it says which package is missing
import chains
import curves as kinds
import e_log_p
import envelope
import fabric
import film
import loops
import mohr
import rose
import state as states
import stiffness
import stress_force_fabric
import stress_path
import stress_strain
import tables
import volumetric
import matplotlib.pyplot as plt

LARGEST_SVG = 1_500_000  # bytes; beyond, a figure is a PNG
MOST_STATES = 20  # of a rose

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222; background: #fff; max-width: 1080px;
       margin: 2em auto; padding: 0 1.5em; }
h1 { font-size: 1.6em; margin-bottom: 0.2em; }
h2 { font-size: 1.25em; margin-top: 2em; border-bottom: 1px solid #ccc; padding-bottom: 0.2em; }
h3 { font-size: 1.05em; margin: 1.6em 0 0.4em; }
table { border-collapse: collapse; font-size: 0.9em; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 0.2em 0.9em 0.2em 0; vertical-align: top; border-bottom: 1px solid #eee; }
th { font-weight: 600; border-bottom: 1px solid #999; }
.wide { overflow-x: auto; }
figure { margin: 1em 0; }
figure img, figure video { max-width: 100%; height: auto; }
figcaption { font-size: 0.85em; color: #555; max-width: 60em; }
pre { background: #f6f6f6; padding: 0.8em; font-size: 0.8em; overflow-x: auto; }
@media print { h2 { break-before: page; } figure, table { break-inside: avoid; } video { display: none; } }
"""

# Nothing but what is in the page may be loaded.
POLICY = "default-src 'none'; img-src data:; media-src data:; style-src 'unsafe-inline'"


def data_uri(kind, content):
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def settled(svg):
    """The SVG without its date, and with clip paths numbered in their order: matplotlib names some by addresses."""
    svg = re.sub(rb"<metadata>.*?</metadata>", b"", svg, flags=re.S)
    number = {name: b"clip%d" % k for k, name in enumerate(dict.fromkeys(re.findall(rb'id="(p[0-9a-f]{10})"', svg)))}
    return re.sub(rb"(?<=[\"#])p[0-9a-f]{10}(?=[\")])", lambda found: number.get(found.group(), found.group()), svg)


def figure_of(module, given, options, folder, caption):
    """HTML of a figure that a script's draw makes of `given`; "" where that figure is none of these tests'."""
    path = folder / "figure.svg"
    try:
        said = module.draw(given, argparse.Namespace(**{**vars(options), "output": str(path)}))
    except ValueError:
        return ""
    finally:
        plt.close("all")
    content, kind = settled(path.read_bytes()), "image/svg+xml"
    if len(content) > LARGEST_SVG:
        path = folder / "figure.png"
        module.draw(given, argparse.Namespace(**{**vars(options), "output": str(path)}))
        plt.close("all")
        content, kind = path.read_bytes(), "image/png"
    name = module.__name__.replace("_", " ")
    told = said.replace(str(path), "").replace(str(folder / "figure.svg"), "").lstrip(": ")
    told = (told[:1].upper() if told[1:2].isalpha() else told[:1]) + told[1:] + "."  # "a = 0.3" stays
    return (f'<figure><img alt="{name}" src="{data_uri(kind, content)}">'
            f"<figcaption>{html.escape(caption)} {html.escape(told).replace(chr(10), '<br>')}</figcaption></figure>")


def film_of(path, folder):
    """HTML of the film of a record file, or why there is none."""
    kind = "mp4" if shutil.which("ffmpeg") else "gif"
    output = folder / f"film.{kind}"
    try:
        count = film.save(film.pictures_of_grains(path, "chains"), output, 8)
    except ValueError as error:
        return f"<p>None: {html.escape(str(error).replace(str(output), path.name))}.</p>"
    content = output.read_bytes()
    shown = (f'<video controls muted loop autoplay playsinline src="{data_uri("video/mp4", content)}"></video>'
             if kind == "mp4" else f'<img alt="film" src="{data_uri("image/gif", content)}">')
    return f"<figure>{shown}<figcaption>{html.escape(path.name)}: {count} states.</figcaption></figure>"


def table_of(rows):
    """HTML of a table; a head of empty texts is left out."""
    if len(rows) < 2:
        return ""
    head, body = rows[0], rows[1:]
    text = "".join(f"<th>{html.escape(cell)}</th>" for cell in head)
    lines = [f"<tr>{text}</tr>"] if any(head) else []
    lines += ["<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in body]
    return '<div class="wide"><table>' + "\n".join(lines) + "</table></div>"


def section(title, *parts):
    """A heading and what is below it; "" where there is nothing."""
    content = "\n".join(part for part in parts if part)
    return f"<h3>{html.escape(title)}</h3>\n{content}" if content else ""


def curves_of(stages, options, folder):
    """The figures that these stages have."""
    driven = [stage for stage in stages if stage.kind not in ("envelope", "relax", "isotropic")]
    parts = []
    if driven:
        cyclic = [stage for stage in driven if stage.cyclic]
        one = [stage for stage in driven if not stage.cyclic]
        if cyclic:
            first = [stage for stage in driven if stage.path == cyclic[0].path]
            parts.append(figure_of(loops, first, options, folder, f"Loops of {cyclic[0].path.name}."))
            parts.append(figure_of(stiffness, cyclic, options, folder, "Shear modulus and damping of the loops."))
        for module, caption in ((stress_strain, "Mobilised stress ratio and volumetric strain."),
                                (e_log_p, "Void ratio against mean stress."), (volumetric, "Void ratio."),
                                (stress_path, "Stress paths."), (fabric, "Anisotropy of the contact network."),
                                (stress_force_fabric, "Stress, force and fabric.")):
            given = one if module is stress_strain else driven
            parts.append(figure_of(module, given, options, folder, caption) if given else "")
    for path in list(dict.fromkeys(stage.path for stage in stages if stage.kind == "envelope"))[:1]:
        parts.append(figure_of(envelope, [stage for stage in stages if stage.path == path], options, folder,
                               f"Response envelopes of {path.name}."))
    return parts


def with_snapshots(tests):
    """The first record file that holds a film; None."""
    for test in tests:
        with records.h5py.File(test[0].path, "r") as file:
            if len(file.get("snapshots", ())) > 1:
                return test[0].path
    return None


def section_of_test(name, tests, options, folder):
    """All there is about tests of one name."""
    stages = [stage for test in tests for stage in test]
    last = [test[-1] for test in tests]
    _, _, protocol, _ = records.read_columns(tests[0][0].path)
    found = states.read_states([test[0].path for test in tests[:MOST_STATES]])
    rose_options = argparse.Namespace(of="normals", plane=None, together=True)
    filmed = with_snapshots(tests)
    drained = [stage for stage in last if stage.drained and not stage.cyclic]
    parts = [
        section("What was asked", table_of(tables.asked(tests, protocol)),
                "<details><summary>the protocol with every default</summary><pre>"
                + html.escape(protocol_text(tests[0][0].path)) + "</pre></details>"),
        section("Specimen", table_of(tables.specimen(tests[0][0].path, tests[0][0]))),
        section("Results", table_of(tables.results(tests)),
                "<p>Means and standard errors over the specimens.</p>" if len(tests) > 1 and tables.results(tests) else ""),
        section("Curves", *curves_of(stages, options, folder)),
        section("Mohr circles", figure_of(mohr, drained, options, folder, "Circles at the peak.") if drained else ""),
        section("Contact rose", figure_of(rose, found, rose_options, folder,
                                          f"End state of {records.counted(len(found), 'test')}.")),
        section("Force chains", figure_of(chains, found[:1], options, folder, f"End state of {tests[0][0].path.name}.")),
        section("Film", film_of(filmed, folder) if filmed else ""),
        section("Error and run time", table_of(tables.error_and_time(tests)),
                f"<p>{tables.ERROR_IN_WORDS}</p>")]
    return f"<h2>{html.escape(name)}</h2>\n" + "\n".join(part for part in parts if part)


def protocol_text(path):
    with records.h5py.File(path, "r") as file:
        return records.texts(file["provenance/protocol"])[0]


def tests_by_name(files):
    """{name of the test and dimension: [stages of one file, ...]}, in the order of their pressures."""
    found = {}
    for path in files:
        stages = records.stages_of(path)
        if not stages:
            continue
        with records.h5py.File(path, "r") as file:
            name = records.texts(file["test/protocol"])[0]
        found.setdefault(f"{name}, {stages[0].dimension}D", []).append(stages)
    for own in found.values():
        own.sort(key=lambda stages: (round(stages[-1].pressure, -1), str(stages[0].path)))
    return found


def page(paths, options):
    files = records.files_of(paths)
    tests = tests_by_name(files)
    if not tests:
        raise ValueError(f"{', '.join(map(str, paths))}: no record file with records there; give files that `rvelab run -o` "
                         "or `rvelab calibrate -o` wrote, or their folder")
    version = next(iter(tests.values()))[0][0].origin.version
    title = options.title or "Laboratory report" + (": " + ", ".join(tests) if len(tests) < 3 else "")
    with tempfile.TemporaryDirectory() as folder:
        sections = [section_of_test(name, own, options, pathlib.Path(folder)) for name, own in tests.items()]
    for path in paths:
        sections.append(section(f"Means over the specimens of {pathlib.Path(path).name}", table_of(tables.summary(path))))
    count = sum(len(own) for own in tests.values())
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title>
<meta http-equiv="Content-Security-Policy" content="{POLICY}">
<meta name="viewport" content="width=device-width"><link rel="icon" href="data:,">
<style>{STYLE}</style></head><body>
<h1>{html.escape(title)}</h1>
<p>{records.counted(count, 'test')}, rvelab {html.escape(version)}. SI units; compression is positive in this page.</p>
{chr(10).join(filter(None, sections))}
</body></html>
""", count


def draw(paths, options):
    text, count = page(paths, options)
    output = pathlib.Path(options.output)
    part = output.with_name(output.name + ".tmp")
    part.write_text(text, encoding="utf-8")
    part.replace(output)
    figures, size = text.count("<figure>"), len(text.encode())
    if options.json:
        return json.dumps({"report": str(output), "tests": count, "figures": figures, "bytes": size}, indent=1)
    return f"{output}: {records.counted(count, 'test')}, {records.counted(figures, 'figure')}, {size / 1e6:.1f} MB"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog=os.environ.get("RVELAB_CALLED_AS", "report.py"), description=__doc__.splitlines()[0])
    kinds.add_options(parser, "report.html")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--title", help="of the page; default: the names of the tests")
    records.run(draw, parser, read=lambda paths: paths)
