#!/usr/bin/python3
"""Checks that every rule that the code cites, such as `rule P7` or `rules S1 to S4`, is defined.

    check_rules.py RULES_FILE FOLDER...

A rule is defined by `**P7**` in RULES_FILE, or by `P7:` at the head of a list of the file that cites it.
"""

import pathlib
import re
import sys


def cited(text):
    for words in re.findall(r"\brules?\s((?:[A-Z]\d+(?:,\s|\sto\s|\sand\s)?)+)", text.replace("\n///", "\n")):
        yield from re.findall(r"[A-Z]\d+", words)


def main(arguments):
    defined = set(re.findall(r"\*\*([A-Z]\d+)\*\*", pathlib.Path(arguments[0]).read_text(encoding="utf-8")))
    faults = 0
    files = [f for folder in arguments[1:] for f in pathlib.Path(folder).rglob("*") if f.suffix in (".h", ".cpp")]
    for file in sorted(files):
        text = file.read_text(encoding="utf-8")
        own = set(re.findall(r"- ([A-Z]\d+):", text))
        for rule in cited(text):
            if rule not in defined | own:
                print(f"{file}: rule {rule} is not defined")
                faults += 1
    print(f"{len(files)} files, {faults} faults")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
