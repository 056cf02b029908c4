#!/usr/bin/python3
"""Holds the attributes that the reader of definitions knows against the schema.

    check_known_names.py SCHEMA SOURCE            exits with 1 where they differ
    check_known_names.py --rows SCHEMA            prints the rows of the table for the source

SOURCE is src/casedef/known_names.cpp. A row of its table is {"attributes", "elements"}; an element
is "name", or "parent/name" where the same name has other attributes elsewhere; "*" is any attribute.
"""

import collections
import re
import sys
import xml.etree.ElementTree as ElementTree

XS = "{http://www.w3.org/2001/XMLSchema}"


class Schema:
    """Attributes of all elements by (parent, name), without those that every element may have."""

    def __init__(self, path):
        self.named = {(c.tag, c.get("name")): c for c in ElementTree.parse(path).getroot()}
        remarks = self.named[XS + "attributeGroup", "remarks"]
        self.common = {a.get("name") for a in remarks}
        self.elements = {}
        self.seen = set()
        self.read(self.named[XS + "element", "case"], "")

    def read(self, element, parent):
        name = element.get("name")
        kind = element.find(XS + "complexType")
        if kind is None:
            kind = self.named.get((XS + "complexType", element.get("type")))
        if name.startswith("_") or (parent, name, id(kind)) in self.seen:
            return
        self.seen.add((parent, name, id(kind)))
        attributes = self.elements.setdefault((parent, name), set())
        if kind is not None:
            self.read_type(kind, attributes, name)

    def read_type(self, node, attributes, name):
        for child in node:
            if child.tag == XS + "attribute":
                attributes |= {child.get("name")} - self.common
            elif child.tag == XS + "anyAttribute" and child.get("namespace") != "urn:fppg":
                attributes.add("*")
            elif child.tag == XS + "element":
                self.read(child, name)
            elif child.tag == XS + "group":
                self.read_type(self.named[XS + "group", child.get("ref")], attributes, name)
            elif child.tag != XS + "complexType":
                self.read_type(child, attributes, name)

    def rows(self):
        """Elements by their attributes, both sorted."""
        by_name = collections.defaultdict(lambda: collections.defaultdict(list))
        for (parent, name), attributes in self.elements.items():
            by_name[name][" ".join(sorted(attributes))].append(f"{parent}/{name}")
        rows = collections.defaultdict(set)
        for name, kinds in by_name.items():
            for attributes, paths in kinds.items():
                rows[attributes] |= {name} if len(kinds) == 1 else set(paths)
        return dict(sorted(rows.items(), key=lambda row: row[0].split()))


def literals(text):
    """A text as C++ literals of at most 82 columns, one a line."""
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) > 80:
            lines[-1] += " "
            lines.append("")
        lines[-1] += (" " if lines[-1] else "") + word
    return "\n".join(f'"{line}"' for line in lines)


def table_of(source):
    with open(source, encoding="utf-8") as file:
        text = file.read().split("// clang-format off")[1].split("// clang-format on")[0]
    cells = ["".join(re.findall(r'"([^"]*)"', cell)) for cell in re.findall(r'(?:"[^"]*"\s*)+', text)]
    return {a: set(e.split()) for a, e in zip(cells[::2], cells[1::2])}


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    if arguments[0] == "--rows":
        for attributes, elements in Schema(arguments[1]).rows().items():
            print(f"    {{{literals(attributes)},\n{literals(' '.join(sorted(elements)))}}},")
        return 0
    wanted, found = Schema(arguments[0]).rows(), table_of(arguments[1])
    for attributes in sorted(wanted.keys() | found.keys()):
        missing = wanted.get(attributes, set()) - found.get(attributes, set())
        extra = found.get(attributes, set()) - wanted.get(attributes, set())
        for element in sorted(missing):
            print(f"{element}: the schema gives it the attributes '{attributes}', the table does not")
        for element in sorted(extra):
            print(f"{element}: the table gives it the attributes '{attributes}', the schema does not")
    return 1 if wanted != found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
