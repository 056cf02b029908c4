#!/usr/bin/python3
"""Records what GenCase makes of random cases, for tests that run without it.

    record_random.py GENCASE FOLDER [--seed N] [--cases N] [--most PARTICLES] [--timeout SECONDS]

GENCASE is a program, or a script that starts one; it is run in a folder of its own with relative paths. Each case of
1 to PARTICLES particles that GenCase accepts becomes a folder `sSEEDcNUMBER` in FOLDER: the definition, its files, and
the recorded particles in the form of tests/golden. fppg takes no part. Needs python3-numpy.
"""

import argparse
import gzip
import io
import json
import os
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
from case_grammar import random_case  # noqa: E402 (found by the path above)
from case_runs import NAME, program_path, read_outcome, start_program, write_case  # noqa: E402


def record(program, case, name, folder, options):
    """The number of recorded particles, or None where nothing was recorded."""
    with tempfile.TemporaryDirectory() as work:
        write_case(case, work)
        os.rename(os.path.join(work, NAME + "_Def.xml"), os.path.join(work, name + "_Def.xml"))
        inputs = sorted(os.listdir(work))
        words = [name + "_Def", f"out/{name}", "-save:bi"]
        run = start_program(program, work, words, os.path.join(work, "out"), options.timeout)
        base = os.path.join(work, "out", name)
        if run.status != "accepts" or not os.path.exists(base + ".bi4"):
            return None
        outcome = read_outcome(base)
        if not 0 < len(outcome.mks) <= options.most:
            return None
        target = os.path.join(folder, name)
        shutil.rmtree(target, ignore_errors=True)
        os.makedirs(target)
        for file in inputs:
            shutil.copy(os.path.join(work, file), target)
        with open(os.path.join(work, "out", "said.txt"), encoding="utf-8", errors="replace") as said:
            version = next((line.strip() for line in said if "GenCase v" in line), "GenCase")
    write_record(os.path.join(target, name), outcome, version)
    return len(outcome.mks)


def write_record(base, outcome, version):
    rows = io.StringIO()
    rows.write("id,type,mk,i,j,k,x,y,z\n")
    for number, (kind, mk, place) in enumerate(zip(outcome.types, outcome.mks, outcome.positions)):
        rows.write(f"{number},{kind},{mk},,,,{place[0]:.9g},{place[1]:.9g},{place[2]:.9g}\n")
    with open(base + ".expected.csv.gz", "wb") as file:
        # Without name and time: the same record has the same bytes.
        with gzip.GzipFile(filename="", mode="wb", fileobj=file, mtime=0) as packed:
            packed.write(rows.getvalue().encode())
    values = outcome.values
    expected = {"case": os.path.basename(base), "recorded_with": version.strip("<> "), "dp": values["Dp"],
                "lattice_origin": [0.0, 0.0, 0.0], "np": len(outcome.mks),
                "posmin": list(values["CasePosMin"]), "posmax": list(values["CasePosMax"])}
    with open(base + ".expected.json", "w", encoding="utf-8") as file:
        json.dump(expected, file, indent=1)
        file.write("\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gencase")
    parser.add_argument("folder")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", type=int, default=100, help="how many to record (default 100)")
    parser.add_argument("--most", type=int, default=4000, help="particles of a case (default 4000)")
    parser.add_argument("--timeout", type=float, default=60)
    options = parser.parse_args()
    program = program_path(options.gencase)
    recorded = tried = 0
    while recorded < options.cases:
        name = f"s{options.seed}c{tried}"
        n = record(program, random_case(options.seed, tried), name, options.folder, options)
        tried += 1
        if n is not None:
            recorded += 1
            print(f"{name}: {n} particles", flush=True)
    print(f"{recorded} recorded of {tried} tried")


if __name__ == "__main__":
    main()
