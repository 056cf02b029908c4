#!/usr/bin/python3
"""Holds the schema of xml-templates against definitions that are right and templates that are broken.

    check_schema.py SOURCE_FOLDER WORK_FOLDER

Right: the templates, the cases, the recorded cases of tests/golden, and those of the folder that the
environment variable FPPG_SHARED names, where it is set. Broken: one line of a template is changed, and
xmllint must name that line. Exits with 77 (skipped) where there is no xmllint (package libxml2-utils).
"""

import glob
import os
import shutil
import subprocess
import sys

# Template, text in it (its first place counts), what stands there instead, part of the message.
BROKEN = (
    ("DrawSphere", "<drawsphere ", "<drawspere ", "drawspere"),
    ("DrawSphere", 'radius="0.23"', 'radius="large"', "radius"),
    ("DrawSphere", 'radius="0.23"', 'radius=""', "radius"),
    ("DrawSphere", 'radius="0.23"', 'diameter="0.46"', "radius"),
    ("DrawSphere", 'vdp="-0.5*,-1.5"', 'vdp="-0.5;-1.5"', "vdp"),
    ("DrawBox", "<boxfill>solid<", "<boxfill>solidd<", "boxfill"),
    ("DrawBox", "<boxfill>bottom | left", "<boxfill>bottom, left", "boxfill"),
    ("DrawBox", '<size x="0.3" y="0.3" z="0.3" />', '<size x="0.3" y="0.3" />', "'z'"),
    ("DrawBox", '<point x="0" y="0" z="0" />', '<point x="0" y="0,5" z="0" />', "'y'"),
    ("DrawBox", '<point x="0" y="0" z="0" />', "", "drawbox"),
    ("DrawCylinder", 'mask="1 | 2"', 'mask="1,2"', "mask"),
    ("SetDrawMode", 'mode="face"', 'mode="faces"', "mode"),
    ("SetMk", '<setmkbound mk="5" />', "<setmkbound />", "mk"),
    ("SetMk", '<setmkbound mk="5" />', '<setmkbound mk="five" />', "mk"),
    ("SetMk", '<setmknextauto auto="true" />', '<setmknextauto auto="yes" />', "auto"),
    ("Constants", '<gamma value="7"', '<gamma valeu="7"', "gamma"),
    ("MkConfig", 'orient="YxZ"', 'orient="Yx"', "orient"),
    ("Transforms", 'axes="ZYZ"', 'axes="ZYA"', "axes"),
    ("FillBox", "<modefill>void<", "<modefill>empty<", "modefill"),
    ("RedrawNear", 'bordertp="bound" />', 'bordertype="bound" />', "bordertype"),
    ("ShapeOutFormats", 'format="vtp"', 'format="obj"', "format"),
    ("DrawFileStl", 'autofill="true">', 'autofil="true">', "autofil"),
    ("DrawFileVtk", "<polyselec>triangles<", "<polyselec>triangle<", "polyselec"),
    ("Floatings", 'mkbound="1-2"', 'mkbound="1..2"', "mkbound"),
    ("MotionRect", '<mvrect id="1" duration="1.5">', '<mvrect id="1">', "duration"),
    ("MotionRotate", 'anglesunits="degrees"', 'anglesunits="degree"', "anglesunits"),
    ("NormalsShapes", "<norplane ", "<norplain ", "norplain"),
    ("InitialVelocity", "<posmin ", "<posMin ", "posMin"),
    ("BodyFitted", 'density="cell"', 'density="nodes"', "density"),
    ("BodyFittedRelax", 'band="3"', 'bands="3"', "bands"),
    ("Boolean", 'op="union"', 'op="sum"', "op"),
    ("FillCavity", 'seed="0.2,0.2,0.1"', 'seed="0.2,0.2"', "seed"),
    ("Parameters", '<parameter key="Kernel"', '<parameter kee="Kernel"', "key"),
    ("Parameters", 'y="default - 0.1"', 'y="defaults - 0.1"', "'y'"),
    ("VRes", "<dpratio ", "<ratio ", "ratio"),
)


def validate(schema, files):
    """Lines of xmllint about what is wrong."""
    done = subprocess.run(["xmllint", "--noout", "--schema", schema, *files], check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return [line for line in done.stdout.splitlines() if not line.endswith(" validates")]


def right_ones(source):
    yield from glob.glob(source + "/xml-templates/*.xml")
    for folder in ("cases", "tests/golden/nodes", "tests/golden/fields"):
        found = glob.glob(f"{source}/{folder}/*/*_Def.xml")
        if not found:
            sys.exit(f"{source}/{folder} holds no definitions")
        yield from found
    shared = os.environ.get("FPPG_SHARED")
    if shared:
        yield from glob.glob(shared + "/gencase/golden*/*/*_Def.xml")


def faults(source, work):
    schema = os.path.join(source, "xml-templates", "fppg.xsd")
    files = sorted(right_ones(source))
    for line in validate(schema, files):
        yield f"refused, though right: {line}"
    print(f"{len(files)} definitions that are right")
    for i, (name, old, new, part) in enumerate(BROKEN):
        with open(f"{source}/xml-templates/{name}_Def.xml", encoding="utf-8") as file:
            text = file.read()
        at = text.find(old)
        if at < 0:
            yield f"{name} holds no {old}"
            continue
        text = text[:at] + new + text[at + len(old):]
        # Both tags of an element are misspelt.
        if old.startswith("<") and old.endswith(" ") and new:
            text = text.replace("</" + old[1:].strip() + ">", "</" + new[1:].strip() + ">", 1)
        broken = os.path.join(work, f"broken_{i}.xml")
        with open(broken, "w", encoding="utf-8") as file:
            file.write(text)
        line = text.count("\n", 0, at) + 1
        # What lacks a child is named by its own first line.
        if not new:
            line = text.count("\n", 0, text.rfind("<" + part, 0, at)) + 1
        said = validate(schema, [broken])
        if not any(s.startswith(f"{broken}:{line}:") and part in s for s in said):
            yield f"{name}, {old} as {new}: expected line {line} and {part}, xmllint said {said}"
    print(f"{len(BROKEN)} definitions that are broken")


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    if shutil.which("xmllint") is None:
        print("skipped: xmllint is missing, package libxml2-utils has it")
        return 77
    os.makedirs(arguments[1], exist_ok=True)
    lines = list(faults(os.path.abspath(arguments[0]), os.path.abspath(arguments[1])))
    for line in lines:
        print(line)
    print(f"{len(lines)} faults")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
