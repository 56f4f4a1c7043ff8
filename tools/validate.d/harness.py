"""What the checks of tools/validate share. A check is called as CHECK.py PROGRAM WORK RESULTS [WORD...] and ends with

    if __name__ == "__main__":
        harness.main(main)

PROGRAM: rvelab. WORK: a folder of its own, in which runs that are whole are used again. RESULTS: where figures go.

Rows with a limit end in `met`; DIFFERS, where the published number is another one and the cause is known, with the
cause on the next line; or MISSED. A cause is given together with the range in which it explains what was found: a
figure that leaves that range is MISSED again. A function under @bars judges plain figures: these are kept beside its
rows, so that `tools/validate --judge` can judge them by other limits without the runs."""

import concurrent.futures
import functools
import json
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROTOCOLS = ROOT / "protocols"
YADE = ROOT / "tests/data/yade"  # packings
REFERENCE = ROOT / "../shared/reference"
program, work, results = (pathlib.Path(word).resolve() for word in (*sys.argv[1:4], "rvelab", "work", "results")[:3])
mpm = program.with_name("rvelab-mpm")
words = sys.argv[4:]

ENTRY = "\x01"  # begins a line of standard output that is an entry of the kept table, as JSON
COMPLETE_BUT_MISSED = 3  # exit code
judges, missed, different = {}, [], []
totals = False  # whether the rows are counted at the end


# --- runs -------------------------------------------------------------------------------------------------------------

def sets(*settings):
    """KEY=VALUE as options of rvelab and rvelab-mpm."""
    return [word for each in settings for word in ("--set", str(each))]


def run(*command, codes=(0,), **options):
    """Any command, its output captured; exits with its error where it ends with another code. codes=None: all are
    taken."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if codes is not None and done.returncode not in codes:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}: {(done.stderr or done.stdout).strip()[-500:]}")
    return done


def rvelab(*command, **options):
    """What `rvelab COMMAND` prints."""
    return run(program, *command, **options).stdout


def answer(*command, **options):
    """The same of `rvelab COMMAND --json`."""
    return json.loads(rvelab(*command, "--json", **options))


@functools.cache
def version():
    return run(program, "--version").stdout.strip()


def write(path, text):
    """A file is there whole or as it was."""
    part = path.with_name(path.name + ".part")
    part.write_text(text)
    part.replace(path)


def once(out, *command, make=None, resume=False, codes=(0,)):
    """OUT of `rvelab COMMAND -o OUT`, made unless it is there, whole, by the same command and files .toml of the same
    version. make: a function that makes it instead; resume: what a run that was stopped left is continued; codes: of a
    run that is whole, None: any that leaves OUT."""
    out = pathlib.Path(out)
    mark = out.with_name(out.name + ".whole")
    texts = [word.read_text() for word in command if isinstance(word, pathlib.Path) and word.suffix == ".toml"]
    asked = "\n".join([version(), *map(str, command), *texts])

    def family():  # a file for each depth
        return list(out.parent.glob(f"{out.stem}_*Pa.h5"))

    if mark.exists() and mark.read_text() == asked and (out.exists() or family()):
        return out
    begun = out.with_name(out.name + ".begun")
    continued = resume and begun.exists() and begun.read_text() == asked
    mark.unlink(missing_ok=True)
    if not continued:
        shutil.rmtree(out, ignore_errors=True)
        for left in (out, out.with_name(out.name + ".journal"), *family()):
            left.unlink(missing_ok=True)
        write(begun, asked)
    if make:
        make(out)
    else:
        done = run(program, *command, "-o", out, *(["--resume"] if resume else []), codes=codes)
        if not (out.exists() or family()):
            sys.exit(f"{out}: {done.stderr.strip()[-500:]}")
    write(mark, asked)
    begun.unlink(missing_ok=True)
    return out


def kept(name, make):
    """What make() gives, of plain figures, kept in WORK with the version."""
    path = work / f"{name}.json"
    if path.exists():
        found = json.loads(path.read_text())
        if found["version"] == version():
            return found["figures"]
    write(path, json.dumps({"version": version(), "figures": plain(make())}))
    return json.loads(path.read_text())["figures"]


def packed(recipe, name, *settings, options=()):
    """WORK/NAME.h5, packed by a recipe."""
    return once(work / f"{name}.h5", "pack", recipe, *options, *sets(*settings))


def specimens(recipe, name, count, *settings, options=()):
    """WORK/NAME_1.h5 and so on, of seeds from 1."""
    return [packed(recipe, f"{name}_{seed}", f"pack.seed={seed}", *settings, options=options)
            for seed in range(1, count + 1)]


def imported(name):
    """WORK/NAME.h5 of a packing by YADE."""
    return once(work / f"{name}.h5", "import", *(YADE / f"{name}{end}"
                                                 for end in (".particles.csv", ".contacts.csv", ".json")))


def protocol_without(name, kind):
    """WORK/NAME_without_KIND.toml: a protocol less its stages of a kind."""
    stages = (PROTOCOLS / f"{name}.toml").read_text().split("[[stage]]")
    path = work / f"{name}_without_{kind}.toml"
    write(path, "[[stage]]".join(each for each in stages if f'kind = "{kind}"' not in each))
    return path


def in_turn(function, items, threads=2):
    """function(item) of each, on threads; the results in the order of the items, each as soon as those before it are
    there."""
    with concurrent.futures.ThreadPoolExecutor(threads) as pool:
        yield from pool.map(function, items)


# --- figures ----------------------------------------------------------------------------------------------------------

def records(path, *names, last=False):
    """Arrays of a record file; last: of the last stage alone."""
    import h5py
    with h5py.File(path) as file:
        stage = file["records/stage"][:]
        rows = stage == stage.max() if last else slice(None)
        return {name: file[f"records/{name}"][:][rows] for name in names}


def columns(path):
    """Arrays of a table with names in its first line (history.csv, watched.csv)."""
    import numpy as np
    with open(path) as file:
        names = file.readline().strip().split(",")
    return dict(zip(names, np.atleast_2d(np.genfromtxt(path, delimiter=",", skip_header=1)).T))


def mean_error(values):
    """Mean and its standard error."""
    import numpy as np
    values = np.asarray(values, float)
    return values.mean(), values.std(ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.nan


def in_words(values, scale=1.0, digits=1):
    """MEAN +- STANDARD ERROR."""
    return "{:.{d}f} +- {:.{d}f}".format(*(scale * each for each in mean_error(values)), d=digits)


def sine_of(sigma_1, sigma_3):
    """Of the mobilised friction angle."""
    return (sigma_1 - sigma_3) / (sigma_1 + sigma_3)


def degrees_of(sigma_1, sigma_3):
    import numpy as np
    return np.degrees(np.arcsin(sine_of(sigma_1, sigma_3)))


def envelope(sigma_3, sigma_1):
    """Cohesion (Pa) and friction angle (degrees) of Mohr's straight envelope, sigma_1 = 2 c sqrt(k) + k sigma_3."""
    import numpy as np
    k, b = np.polyfit(sigma_3, sigma_1, 1)
    return b / (2 * np.sqrt(k)), degrees_of(k, 1)


def pyplot():
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot
    return matplotlib.pyplot


# --- rows with verdicts -----------------------------------------------------------------------------------------------

def plain(value):
    """Of numbers, texts, lists and dictionaries, as JSON has them."""
    if isinstance(value, dict):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, (str, bool, int, float)) or value is None:
        return value
    if hasattr(value, "tolist"):
        return value.tolist()
    return [plain(each) for each in value]


def entry(found):
    """Prints an entry: for tools/validate, which keeps it, as JSON, else as text."""
    if "RVELAB_ENTRIES" in os.environ:
        print(ENTRY + json.dumps(found), flush=True)
    elif "row" in found or "total" in found:
        print("\n".join(text_of(found)), flush=True)


def text_of(found):
    """Lines of an entry of a kept table: of a text, a row, or rows that were judged together."""
    if isinstance(found, str):
        return [found]
    if "bars" in found:
        return [line for each in found["entries"] for line in text_of(each)]
    if "total" in found:
        missed, different = found["total"]
        return ["", f"{len(missed)} missed" + (": " + "; ".join(missed) if missed else "") +
                f"; {different} differ from their source, with the cause"]
    why = [f"    why: {found['why']}"] if found.get("why") else []
    return "\n".join([f"{found['row']} {found['verdict']}".rstrip(), *why]).split("\n")


def row(text, met, explained=False, cause="", good="met", what=None, reason=""):
    """A row with its verdict. explained: whether the figure lies where `cause` (one sentence, with the run that
    isolates it) puts it; good: the word where the limit holds; reason: by what it is missed, printed below MISSED."""
    word = good if met else "DIFFERS" if explained and cause else "MISSED"
    given({"row": text, "verdict": word, "why": {"DIFFERS": cause, "MISSED": reason}.get(word, ""),
           "what": what or " ".join(text.split()[:6])})
    return bool(met)


def given(found):
    """Counts and prints a row."""
    for word, names in (("MISSED", missed), ("DIFFERS", different)):
        if found["verdict"] == word:
            names.append(found["what"])
    entry(found)


def verdict(what, found, asked, met, explained=False, cause="", width=76, reason=""):
    """The same of what was found and asked, as texts; main() counts these at the end."""
    global totals
    totals = True
    return row(f"{what:<{width}} {found:<22} {asked:<24}", met, explained, cause, what=what, reason=reason)


def bars(judge):
    """Of a function that prints rows with verdicts from plain figures, its arguments. Its answer is kept by no
    table."""
    @functools.wraps(judge)
    def keeping(*figures, **named):
        entry({"bars": judge.__name__, "figures": plain(figures), "named": plain(named)})
        given = judge(*figures, **named)
        entry({"end": judge.__name__})
        return given
    judges[judge.__name__] = judge
    return keeping


def main(check):
    """Runs it; with `--judge NAME.json` judges the figures of a kept table instead, whose other entries are printed
    again."""
    global totals
    if words[:1] == ["--judge"]:
        for found in json.loads(pathlib.Path(words[1]).read_text())["entries"]:
            if isinstance(found, str):
                print(found, flush=True)
            elif "bars" in found:
                bars(judges[found["bars"]])(*found["figures"], **found.get("named", {}))
            elif "row" in found:
                given(found)
            totals |= "total" in found
        failed = False
    else:
        work.mkdir(parents=True, exist_ok=True)
        results.mkdir(parents=True, exist_ok=True)
        failed = check()
    if totals:
        entry({"total": [missed, len(different)]})
    sys.exit(COMPLETE_BUT_MISSED if missed or failed else 0)
