"""Scripts of tools/plot one after the other: run_plots.py SCRIPTS COMMANDS, a JSON list of [script, words of its command
line]; prints one of [exit code, output, errors]. Each runs in a child that has its packages already, which take half a
second to load."""
import json
import os
import pathlib
import runpy
import shlex
import sys
import traceback

scripts = pathlib.Path(sys.argv[1])
commands = json.loads(pathlib.Path(sys.argv[2]).read_text())
sys.path.insert(0, str(scripts))
import curves  # noqa: E402, F401  (with all packages)


def run(script: str, words: str) -> int:
    """As the interpreter runs a script."""
    sys.argv = [str(scripts / f"{script}.py"), *shlex.split(words)]
    try:
        runpy.run_path(sys.argv[0], run_name="__main__")
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


outcomes = []
for script, words in commands:
    child = os.fork()
    if child == 0:
        for stream, name in ((1, ".said"), (2, ".errors")):
            os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666), stream)
        code = run(script, words)
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    outcomes.append([code, pathlib.Path(".said").read_text(), pathlib.Path(".errors").read_text()])
sys.stdout.write(json.dumps(outcomes))
