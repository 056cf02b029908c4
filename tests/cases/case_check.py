"""What the checks of cases share: one run of the program on a case, and values held against those
recorded.
"""

import glob
import json
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))


def differences(found, expected, is_same, place=""):
    """Yields a line for every recorded value that differs, with its path.

    is_same(found, expected, place) judges single values. What is found beyond the record is not
    looked at, nor is the name of the program that recorded.
    """
    if isinstance(expected, dict) and isinstance(found, dict):
        for key in expected:
            if key != "recorded_with":
                yield from differences(found.get(key), expected[key], is_same, f"{place}/{key}")
    elif isinstance(expected, list) and isinstance(found, list) and len(found) == len(expected):
        for i, (a, b) in enumerate(zip(found, expected)):
            yield from differences(a, b, is_same, f"{place}/{i}")
    elif not is_same(found, expected, place):
        yield f"{place}: expected {expected}, found {found}"


def check(arguments, usage, summarise, record, find_faults):
    """The whole of a check from its command line; returns the exit code, 1 where there are faults.

    summarise(case)                      what is recorded of the files with that path and stem
    record                               name of the file with the record in a case's folder
    find_faults(case, folder, expected)  yields a line for every fault of a run
    """
    if len(arguments) == 2 and arguments[0] == "--summary":
        print(json.dumps(summarise(arguments[1]), indent=1))
        return 0
    if len(arguments) != 3:
        sys.exit(usage)
    program, folder, work = (os.path.abspath(a) for a in arguments)
    definition, = glob.glob(os.path.join(glob.escape(folder), "*_Def.xml"))
    name = os.path.basename(definition)[:-len("_Def.xml")]
    out = os.path.join(work, name)
    for old in glob.glob(glob.escape(out) + "*"):
        os.remove(old)
    run = subprocess.run([program, name + "_Def", out, "-save:all"], cwd=folder,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if run.returncode != 0:
        print(run.stdout)
        print(f"{name}: the program stopped with {run.returncode}")
        return 1
    with open(os.path.join(folder, record), encoding="utf-8") as file:
        expected = json.load(file)
    lines = list(find_faults(out, folder, expected))
    for line in lines:
        print(f"{name}: {line}")
    print(f"{name}: {len(lines)} faults")
    return 1 if lines else 0
