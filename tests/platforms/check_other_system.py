#!/usr/bin/python3
"""The program of another system writes what the program of this one writes.

    check_other_system.py PROGRAM OTHER SOURCE RUNNER...     compares the files of cases, byte by byte

OTHER   the same program for another system, which `RUNNER... OTHER` runs, e.g. wine or qemu-aarch64
SOURCE  the repository: all cases of tests/golden, on the lattice, and some of cases/, body-fitted

Case.xml of Windows has lines that end with CR and LF, Case.out tells times; all other bytes are equal on the lattice. Body-fitted particles
are the same in number and order, each within 1e-12 dp of that of the other program. Prints how many cases have equal bytes. Exits with 77
where OTHER or its runner is not there.
"""

import concurrent.futures
import glob
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np

PROGRAM, OTHER, SOURCE, *RUNNER = sys.argv[1:]
sys.path.insert(0, os.path.join(SOURCE, "tools"))
sys.dont_write_bytecode = True
from particle_files import read_bi4  # noqa: E402 (found by the path above)

FITTED = ["gear", "tyre", "pipe-tilted"]
GREATEST = 1e-12  # dp


def run(command, folder, definition, output, options):
    environment = dict(os.environ, SOURCE_DATE_EPOCH="0", WINEDEBUG="-all")
    return subprocess.run([*command, definition, output, *options], cwd=folder, env=environment, timeout=1800,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)


def files_of(folder):
    found = {}
    for place, _, names in os.walk(folder):
        for name in [name for name in names if not name.endswith(".out")]:
            path = os.path.join(place, name)
            with open(path, "rb") as file:
                data = file.read()
            found[os.path.relpath(path, folder)] = data.replace(b"\r\n", b"\n") if name.endswith(".xml") else data
    return found


def run_both(definition, options, work):
    """The folders of both results, or a text that says how the runs differ."""
    name = os.path.basename(definition)[:-len("_Def.xml")]
    folder = os.path.join(work, name)
    shutil.copytree(os.path.dirname(definition), folder)
    codes = []
    for place, command in (("here", [PROGRAM]), ("there", [*RUNNER, OTHER])):
        done = run(command, folder, name + "_Def", place + "/" + name, options)
        codes.append(done.returncode)
        text = done.stdout
    if codes[0] != codes[1]:
        return f"exit code {codes[1]} instead of {codes[0]}: {text.decode(errors='replace')[-300:]}"
    return os.path.join(folder, "here"), os.path.join(folder, "there")


def check_lattice(definition, work):
    """What differs, or nothing."""
    both = run_both(definition, ["-save:all", "-threads:1"], work)
    if isinstance(both, str):
        return both
    here, there = (files_of(folder) for folder in both)
    if here.keys() != there.keys():
        return f"other files: {sorted(here.keys() ^ there.keys())}"
    different = [name for name, data in here.items() if there[name] != data]
    return f"other bytes in {', '.join(sorted(different))}" if different else ""


def check_fitted(definition, options, work):
    """What differs beyond GREATEST, or nothing; and the greatest distance of two particles in dp."""
    both = run_both(definition, options, work)
    if isinstance(both, str):
        return both, 0
    name = os.path.basename(definition)[:-len("_Def.xml")] + ".bi4"
    (values, here), (_, there) = (read_bi4(os.path.join(folder, name)) for folder in both)
    if len(here["Idp"]) != len(there["Idp"]):
        return f"{len(there['Idp'])} particles instead of {len(here['Idp'])}", 0
    apart = np.linalg.norm(here["Posd"] - there["Posd"], axis=1)
    farthest = float(np.max(apart)) / values["Dp"]
    return (f"{farthest:.3g} dp apart" if farthest > GREATEST else ""), farthest


def main():
    if not os.path.exists(OTHER):
        print(f"skipped: there is no {OTHER}; tools/package makes it")
        return 77
    if not shutil.which(RUNNER[0]):
        print(f"skipped: there is no {RUNNER[0]}")
        return 77
    faults = []
    with tempfile.TemporaryDirectory(prefix="fppg-systems-") as work:
        definitions = sorted(glob.glob(os.path.join(SOURCE, "tests", "golden", "*", "*", "*_Def.xml")))
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            found = list(pool.map(lambda d: check_lattice(d, work), definitions))
        faults += [f"{d}: {what}" for d, what in zip(definitions, found) if what]
        print(f"{len(definitions) - len(faults)} of {len(definitions)} lattice cases have the same bytes")
        for name in FITTED:
            definition, = glob.glob(os.path.join(SOURCE, "cases", name, "*_Def.xml"))
            what, farthest = check_fitted(definition, ["-threads:2"], work)
            print(f"cases/{name}, body-fitted: {what or f'at most {farthest:.3g} dp apart'}")
            faults += [f"cases/{name}: {what}"] if what else []
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
