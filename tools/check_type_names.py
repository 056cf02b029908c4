#!/usr/bin/python3
"""Checks that each type of the library has a name of its own: check_type_names.py FOLDER...

Two types of one name in one namespace are undefined behaviour, which no compiler or linker reports: what the compiler
does not inline of one can serve the other. Types in unnamed namespaces of .cpp files are free. Prints each name that is
defined twice with its places, and then exits with 1.
"""

import pathlib
import re
import sys
from collections import defaultdict

TYPE = re.compile(r"(?:struct|class|enum class|enum|union)\s+(\w+)(?:\s+final)?\s*(?::(?!:)[^;{]*)?\{?")


def definitions(text):
    """Yields (name, line) of the types that a file defines in a named namespace, one that begins at column 0."""
    is_unnamed = False
    lines = text.split("\n")
    for number, line in enumerate(lines, 1):
        if line in ("namespace", "namespace {"):
            is_unnamed = True
        elif line == "} // namespace":
            is_unnamed = False
        elif not is_unnamed and not line.rstrip().endswith(";"):
            match = TYPE.fullmatch(line.rstrip())
            if match:
                yield match[1], number


def main(folders):
    places = defaultdict(list)
    files = sorted(f for folder in folders for f in pathlib.Path(folder).rglob("*") if f.suffix in (".h", ".cpp"))
    for file in files:
        for name, line in definitions(file.read_text(encoding="utf-8")):
            places[name].append(f"{file}:{line}")
    faults = {name: at for name, at in places.items() if len(at) > 1}
    for name, at in sorted(faults.items()):
        print(f"{name} is defined in {' and '.join(at)}")
    if not files:
        print(f"no source in {' '.join(folders)}")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
