#!/usr/bin/python3
"""Compares whole Case.xml files with those that GenCase v5.4 wrote, element by element.

    check_case_xml.py PROGRAM FOLDER WORK_FOLDER KNOWN

FOLDER holds a folder a case, with NAME_Def.xml and what GenCase made of it, NAME.expected.xml (a file a zone where
there is <vres>). KNOWN is a table of what is known to differ, and why: case, place, kind, what (as in
tools/case_xml.py), reason, with tabs between. Fails for a difference that is not in the table, and for a line of the
table that differs no more.
"""

import csv
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
sys.dont_write_bytecode = True
from case_xml import compare_case_xml  # noqa: E402 (found by the path above)


def differences_of(program, folder, work):
    """(case, difference) of each in the folder, or (case, text) where the program stops."""
    for case in sorted(os.listdir(folder)):
        run = subprocess.run([program, case + "_Def", os.path.join(work, case, case), "-save:-all"], check=False,
                             cwd=os.path.join(folder, case), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if run.returncode != 0:
            yield case, f"the program stops with {run.returncode}:\n{run.stdout}"
            continue
        expected = [f for f in os.listdir(os.path.join(folder, case)) if f.endswith(".expected.xml")]
        for name in sorted(expected):
            written = os.path.join(work, case, name.replace(".expected", ""))
            for difference in compare_case_xml(written, os.path.join(folder, case, name)):
                yield case, difference
        if not expected:
            yield case, "there is no NAME.expected.xml"


def read_known(path):
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    if any(not row["reason"] for row in rows):
        sys.exit(f"{path}: every line needs a reason")
    return {(row["case"], row["place"], row["kind"], row["what"]) for row in rows}


def main(arguments):
    if len(arguments) != 4:
        sys.exit(__doc__)
    program, folder, work, known_file = (os.path.abspath(a) for a in arguments)
    known, seen, lines = read_known(known_file), set(), []
    for case, difference in differences_of(program, folder, work):
        if isinstance(difference, str):
            lines.append(f"{case}: {difference}")
            continue
        key = (case, difference.place, difference.kind, difference.what)
        seen.add(key)
        if key not in known:
            lines.append(f"{case}: {difference.line()}")
    lines += [f"{' '.join(key)}: differs no more, so take it off the list" for key in sorted(known - seen)]
    print("\n".join([*lines, f"{len(os.listdir(folder))} cases, {len(seen)} differences, {len(known)} known"]))
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
