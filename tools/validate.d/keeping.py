"""Kept tables of tools/validate: results/tables/NAME.json, and results/NAME.txt, which is made from it."""

import json
import os
import pathlib
import re
import subprocess

from harness import ENTRY, ROOT, text_of, write

RESULTS = ROOT / "tools/validate.d/results"
FILES = {"study": "study_tolerance"}  # parts whose table has another name


def name_of(part):
    return FILES.get(part, part)


def version_of(program):
    return subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()


def provenance(program):
    """Where figures come from: no dates, no host names."""
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    model = re.search(r"^model name.*: (.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M)
    return {"program": version_of(program), "compiler": compiler, "cores": len(os.sched_getaffinity(0)),
            "processor": model[1] if model else ""}


def entries_of(lines):
    """Of what a part prints, line by line: texts, rows, groups of rows that were judged together."""
    found = open_ = []
    for line in lines:
        each = json.loads(line[1:]) if line.startswith(ENTRY) else line
        if isinstance(each, dict) and "bars" in each:
            open_ = each["entries"] = []
            found.append(each)
        elif isinstance(each, dict) and "end" in each:
            open_ = found
        else:
            open_.append(each)
    return found


def text(table):
    head = [f"# {table['command']}", "# " + ", ".join(str(each) for each in (
        table["program"], table["compiler"], table["cores"] and f"{table['cores']} cores", table["processor"]) if each)]
    head += [f"# {note}" for note in table.get("notes", [])]
    if "not_again" in table:
        hours = table["not_again"]["minutes"] / 60
        head.append(f"# not made again by {table['not_again']['by']}: {hours:.1f} hours of a core")
    return "\n".join(head + [line for each in table["entries"] for line in text_of(each)]) + "\n"


def keep(name, table, folder=None):
    """Both files, each whole or as it was."""
    path_of(name, folder).parent.mkdir(parents=True, exist_ok=True)
    head = json.dumps({key: value for key, value in table.items() if key != "entries"}, indent=1, ensure_ascii=False)
    lines = ",\n  ".join(json.dumps(each, ensure_ascii=False) for each in table["entries"])
    write(path_of(name, folder), f'{head[:-2]},\n "entries": [\n  {lines}\n ]\n}}\n')
    write((folder or RESULTS) / f"{name}.txt", text(table))


def path_of(name, folder=None):
    return (folder or RESULTS) / "tables" / f"{name}.json"


def read(name, folder=None):
    path = path_of(name, folder)
    return json.loads(path.read_text()) if path.exists() else None


def rows(entries):
    """All rows with a verdict."""
    for each in entries:
        if isinstance(each, dict):
            yield from rows(each["entries"]) if "bars" in each else [each] if "row" in each else []


def number(version):
    """Of `rvelab 2.0.0`, to be compared; of no version the lowest."""
    return tuple(int(each) for each in re.findall(r"\d+", version or "")[:3])


def minutes(part, table):
    """Of a core: as measured when the table was made, else as the list of parts says."""
    return (table or {}).get("core_minutes") or part.minutes


def stale(part, now, failures, folder=None):
    """Why the table of a part is out of date, None where it is not. now: the version at hand; failures: folder of what
    parts printed that failed."""
    table = read(name_of(part.name), folder)
    if (failures / f"{part.name}.txt").exists():
        return "failed"
    if table is None:
        return "never kept"
    if not part.without_rvelab and table["program"] != now and table.get("not_again", {}).get("by") != now:
        return f"by {table['program']}"
    if any(each["verdict"] == "MISSED" and not each.get("why") for each in rows(table["entries"])):
        return "a row MISSED without a cause"
    return None


def out_of_date(parts, now, failures, folder=None):
    """(part, why, minutes of a core): the oldest version first, the cheapest first among equals."""
    found = []
    for part in parts:
        why, table = stale(part, now, failures, folder), read(name_of(part.name), folder)
        if why and part.kept:
            found.append((number(table["program"]) if table else (), minutes(part, table), part, why))
    found.sort(key=lambda each: each[:2])
    return [(part, why, cost) for _, cost, part, why in found]
