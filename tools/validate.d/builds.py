#!/usr/bin/python3
"""The cases of tests/extreme of two builds, say with and without optimisation: the same outcomes and the same bits.

Both files are what test_extreme wrote (RVELAB_JSON). A hash is that of the stresses after every increment of a case.

    tools/validate.d/builds.py release.json other.json
"""
import json
import pathlib
import sys

first, second = ({case["name"]: case for case in json.loads(pathlib.Path(name).read_text())["cases"]}
                 for name in sys.argv[1:3])
if first.keys() != second.keys():
    sys.exit(f"builds: not the same cases; only in one: {sorted(first.keys() ^ second.keys())[:5]}")
hashed = differing = wrong = 0
for name, case in first.items():
    other = second[name]
    wrong += other["outcome"] == "WRONG"
    hashed += "hash" in case
    if (case["outcome"], case.get("hash")) != (other["outcome"], other.get("hash")):
        differing += 1
        print(f"{name}: {case['outcome']} {case.get('hash')}, {other['outcome']} {other.get('hash')}: "
              f"{other['status']}")
print(f"{len(first)} cases, {hashed} with a hash of their stresses: {differing} differ; "
      f"the second build has {wrong} WRONG")
sys.exit(differing > 0 or wrong > 0)
