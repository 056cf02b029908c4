#!/usr/bin/python3
"""Checks that xml-templates/README.md lists every element and attribute of the schema, and truly.

    check_table.py TEMPLATES_FOLDER TESTS_FOLDER           exits with 1 at a fault
    check_table.py --rows TEMPLATES_FOLDER TESTS_FOLDER    prints rows of the table for what is there

Every template must be named in README.md. A row of its table is `| element | attributes | templates | tests |`.
An element is told by itself for commands and by its parent/itself elsewhere. The templates named in the
row must have the element, and between them every attribute of the row; the tests must be those of the
templates.
"""

import os
import re
import sys
import xml.etree.ElementTree as ElementTree

XS = "{http://www.w3.org/2001/XMLSchema}"
# Lists hold the same commands; motions the same movements.
ONE_PARENT = {"list": "", "mainlist": "", "obj": "motion", "objreal": "motion"}
# Elements that may hold anything, and what the templates have in them.
FREE = {"special", "gauges", "swl", "wavepaddles", "piston", "property", "properties/property", "extra"}


def has_inside(name):
    """Whether a draw may have fppg:fill: all of files but a table of heights."""
    return name.startswith("drawfile") and name != "drawfilecsv"


def path_of(parent, name):
    parent = ONE_PARENT.get(parent, parent)
    return f"{parent}/{name}" if parent else name


class Schema:
    """Elements of the schema by path, each with its attributes; `common` are those of every element."""

    def __init__(self, path):
        self.root = ElementTree.parse(path).getroot()
        self.named = {(c.tag, c.get("name")): c for c in self.root}
        # `active` stands where entries can be switched off, `fppg:name` on draws.
        self.common = {a.get("name") for a in self.named[XS + "attributeGroup", "remarks"]} | {"active", "fppg:name"}
        self.elements = {}
        self.read(self.named[XS + "element", "case"], "")

    def read(self, element, parent):
        name = element.get("name")
        if name.startswith("_") or element.get("type") == "anything":
            return
        path = path_of(parent, name)
        if path in self.elements:
            return
        kind = element.find(XS + "complexType")
        if kind is None:
            kind = self.named[XS + "complexType", element.get("type")]
        self.elements[path] = set()
        self.read_type(kind, path, name)

    def read_type(self, node, path, name):
        for child in node:
            if child.tag == XS + "attribute":
                if child.get("name") not in self.common:
                    self.elements[path].add(child.get("name"))
            elif child.tag == XS + "anyAttribute" and has_inside(name):
                self.elements[path] |= {"fppg:fill"} | ({"fppg:part"} if name in ("drawfile", "drawfilestep") else set())
            elif child.tag == XS + "element":
                self.read(child, name)
            elif child.tag == XS + "group":
                self.read_type(self.named[XS + "group", child.get("ref")], path, name)
            elif child.tag != XS + "complexType":
                self.read_type(child, path, name)


def used_by(file):
    """(path, attribute) for all that a template holds, attribute "" for the element itself."""
    found = set()

    def walk(element, parent):
        path = path_of(parent, element.tag)
        found.add((path, ""))
        for attribute in element.attrib:
            found.add((path, attribute.replace("{urn:fppg}", "fppg:")))
        for child in element:
            if not child.tag.startswith("_"):
                walk(child, element.tag)

    walk(ElementTree.parse(file).getroot(), "")
    return found


def templates_of(folder):
    return {f[:-len("_Def.xml")]: used_by(os.path.join(folder, f))
            for f in sorted(os.listdir(folder)) if f.endswith("_Def.xml")}


def read_table(file):
    """Rows of the table of elements: path, attributes, templates, tests."""
    with open(file, encoding="utf-8") as text:
        for line in text:
            cells = [c.strip() for c in line.strip().strip("|").split(" | ")]
            if line.startswith("| `") and len(cells) == 4:
                yield cells[0].strip("`"), *(re.findall(r"`([^`]+)`|\[(\w+)\]", c) for c in cells[1:])


# Where to look first for what every case has.
FRAME = {"case": "Remarks", "casedef": "Constants", "constantsdef": "Constants", "geometry": "Definition",
         "definition": "Definition", "commands": "Lists", "mkconfig": "MkConfig", "execution": "Parameters",
         "parameters": "Parameters", "setmkbound": "SetMk", "setmkfluid": "SetMk"}


def rows(schema, templates):
    """A row for each element: the fewest templates that show it with all its attributes, the one that
    is named after it first, else the smallest."""

    def rank(name, path):
        parent = path.split("/")[0]
        named = FRAME.get(parent) == name or parent.startswith(name.lower())
        return (not named, len(templates[name]), name)

    for path, attributes in schema.elements.items():
        missing, chosen = {""} | attributes, []
        while missing:
            shows = {n: {a for p, a in u if p == path} & missing for n, u in templates.items()
                     if n != "AllCommands"}
            best = min(shows, key=lambda n: (-len(shows[n]), *rank(n, path)))
            if not shows[best]:
                break
            chosen.append(best)
            missing -= shows[best]
        yield path, sorted(attributes), chosen, missing


def faults(folder, tests):
    schema = Schema(os.path.join(folder, "fppg.xsd"))
    templates = templates_of(folder)
    with open(os.path.join(tests, "expected.json"), encoding="utf-8") as file:
        recorded = file.read()
    seen = {}
    for path, attributes, shown_by, held_by in read_table(os.path.join(folder, "README.md")):
        attributes = {a for a, _ in attributes}
        names = [b for _, b in shown_by]
        seen[path] = attributes
        if path not in schema.elements:
            yield f"{path}: is in the table, not in the schema"
            continue
        for extra in attributes - schema.elements[path]:
            yield f"{path}: the attribute {extra} is in the table, not in the schema"
        shown = {a for n in names for p, a in templates.get(n, ()) if p == path}
        for attribute in ({""} | attributes) - shown:
            yield f"{path}: none of {names} shows {attribute or 'it'}"
        for name in names:
            if f'"{name}": {{' not in recorded:
                yield f"{path}: nothing is recorded of {name}"
        if [a for a, _ in held_by] != [f"Templates.{n}" for n in names]:
            yield f"{path}: expected the tests of {names}"
    for path, attributes in schema.elements.items():
        if path not in seen:
            yield f"{path}: is missing in the table"
            continue
        for attribute in attributes - seen[path]:
            yield f"{path}: the attribute {attribute} is missing in the table"
    with open(os.path.join(folder, "README.md"), encoding="utf-8") as file:
        text = file.read()
    for name in templates:
        if f"- [{name}]({name}_Def.xml)" not in text:
            yield f"{name}: is missing in the list of templates"
    everything = set().union(*templates.values())
    known = {(p, a) for p, all_of in schema.elements.items() for a in all_of | schema.common | {""}}
    variables = {"newvar", "newvarcte", "setvar", "newvarstr", "newvarstrcte", "setvarstr"}
    for path, attribute in sorted(everything - known):
        parent, own = path.split("/")[0], path.split("/")[-1]
        if own not in FREE | variables and parent not in FREE and own != "property":
            yield f"{path} {attribute}: is in a template, not in the schema"


def main(arguments):
    if arguments[:1] == ["--rows"]:
        folder = arguments[1]
        for path, attributes, chosen, missing in rows(Schema(os.path.join(folder, "fppg.xsd")), templates_of(folder)):
            if missing:
                print(f"NOT SHOWN {path}: {missing}", file=sys.stderr)
            names = " ".join(f"`{a}`" for a in attributes) or "-"
            links = ", ".join(f"[{n}]({n}_Def.xml)" for n in chosen)
            print(f"| `{path}` | {names} | {links} | {', '.join(f'`Templates.{n}`' for n in chosen)} |")
        return 0
    if len(arguments) != 2:
        sys.exit(__doc__)
    lines = list(faults(*arguments))
    for line in lines:
        print(line)
    print(f"{len(lines)} faults")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
