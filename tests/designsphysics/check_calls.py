#!/usr/bin/python3
"""Calls the program as the FreeCAD add-on DesignSPHysics (0.8, January 2026) calls GenCase, and reads what it reads.

    check_calls.py PROGRAM CASES WORK_FOLDER

The program stands as GenCase_linux64 in a folder "bin". The add-on asks it for its version and its features, runs it
with absolute paths in the folder of the case, reads the number and the limits of the particles from what it prints,
and looks for files in CASE_out. A failure is told by the exit code, and its cause is in what was printed.
"""

import glob
import json
import os
import shutil
import struct
import subprocess
import sys
import xml.etree.ElementTree

MAIN_LIST = """<setdrawmode mode="full" />
<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0.1" y="0.1" z="0.1" /><size x="0.8" y="0.8" z="0.4" />
</drawbox>
<setmkbound mk="0" /><drawfilestl file="{stl}" autofill="false"><drawscale x="1" y="1" z="1" /></drawfilestl>
<shapeout file="" />"""
DEFINITION = """<?xml version="1.0" encoding="UTF-8" ?>
<case>
 <casedef>
  <constantsdef>
   <gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" /><hswl value="0" auto="true" /><gamma value="7" />
   <speedsystem value="0" auto="true" /><coefsound value="20" /><speedsound value="0" auto="true" />
   <coefh value="1.2" /><cflnumber value="0.2" />
  </constantsdef>
  <mkconfig boundcount="240" fluidcount="9" />
  <geometry>
   <definition dp="{dp}"><pointref x="0" y="0" z="0" /><pointmin x="-0.5" y="-0.5" z="-0.5" /><pointmax x="1.5" y="1.5" z="1.5" />
   </definition>
   <commands><mainlist>{main_list}</mainlist></commands>
  </geometry>
 </casedef>
 <execution><parameters><parameter key="TimeMax" value="1" /></parameters></execution>
</case>
"""


def write_box(path):
    """An open box as a binary STL, as FreeCAD exports bodies that are no primitives."""
    corners = [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]
    quads = [(0, 2, 6, 4), (0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6)]
    facets = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(facets)))
        for facet in facets:
            file.write(struct.pack("<12f", 0, 0, 0, *(v for i in facet for v in corners[i])) + bytes(2))


def call(program, arguments, folder):
    """Starts it with the folder of the program as LD_LIBRARY_PATH; the output is UTF-8, or else Latin-1."""
    environment = dict(os.environ, LD_LIBRARY_PATH=os.path.dirname(program))
    done = subprocess.run([program, *arguments], cwd=folder, env=environment, check=False, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE)
    try:
        return done.returncode, done.stdout.decode("utf-8")
    except UnicodeDecodeError:
        return done.returncode, done.stdout.decode("latin-1")


def read_counts_and_limits(text):
    """The number of particles and three pairs of limits, cut out of the output by its words and colons alone."""
    number = int(text.split("Total particles: ")[1].split(" (bound=")[0].replace(",", ""))
    fields = text.split("Particle limits:")[1].split("Time of execution")[0].split(":")
    limits = []
    for field in fields[1:4]:
        low, high = field.split("[m]")[0].split(" to ")
        limits.append((float(low), float(high)))
    return number, limits


def run_case(program, work, name, dp, stl="box.stl"):
    folder = os.path.join(work, name)
    os.makedirs(folder, exist_ok=True)
    write_box(os.path.join(folder, "box.stl"))
    with open(os.path.join(folder, name + "_Def.xml"), "w", encoding="utf-8") as file:
        file.write(DEFINITION.format(dp=dp, main_list=MAIN_LIST.format(stl=stl)))
    out = os.path.join(folder, name + "_out")
    # Folders in the output are removed before a run, the files stay.
    for old in glob.glob(os.path.join(glob.escape(out), "*", "")):
        shutil.rmtree(old)
    code, text = call(program, [os.path.join(folder, name + "_Def"), os.path.join(out, name), "-save:+all"], folder)
    return out, code, text


def check_files(out, name, number, limits):
    assert glob.glob(os.path.join(glob.escape(out), "*.vtk")), "no VTK to show"
    for ending in (".xml", ".bi4", ".out", "_All.vtk", "_Bound.vtk", "_Fluid.vtk"):
        assert os.path.getsize(os.path.join(out, name + ending)) > 0, ending
    case = xml.etree.ElementTree.parse(os.path.join(out, name + ".xml")).getroot()
    particles = case.find("execution/particles")
    assert int(particles.get("np")) == number
    blocks = sum(int(block.get("count")) for kind in ("fixed", "moving", "floating", "fluid")
                 for block in particles.findall(kind))
    assert blocks == number
    low, high = (case.find(f"execution/particles/_summary/positions/{key}") for key in ("posmin", "posmax"))
    for axis, (first, last) in zip("xyz", limits):
        assert abs(float(low.get(axis)) - first) < 1e-6 and abs(float(high.get(axis)) - last) < 1e-6


def main(program, cases, work):
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(os.path.join(work, "bin"))
    installed = os.path.join(work, "bin", "GenCase_linux64")
    shutil.copy(program, installed)
    os.chmod(installed, os.stat(installed).st_mode | 0o111)

    code, text = call(installed, ["-ver"], work)
    assert code == 0 and "gencase" in text.lower(), text
    code, text = call(installed, ["-info"], work)
    information = json.loads(text)
    assert code == 0 and information["FullName"] and isinstance(information["Features"], dict), text

    for name in ("Case", "a case with blanks"):
        out, code, text = run_case(installed, work, name, 0.05)
        assert code == 0, text
        number, limits = read_counts_and_limits(text)
        assert number > 3000, number
        assert [tuple(round(x, 6) for x in pair) for pair in limits] == [(0, 1), (0, 1), (0, 1)], limits
        check_files(out, name, number, limits)

    # Again with another dp, over the old results and beside a folder that the solver left.
    os.makedirs(os.path.join(work, "Case/Case_out/data"))
    out, code, text = run_case(installed, work, "Case", 0.1)
    assert code == 0 and read_counts_and_limits(text)[0] < number, text
    check_files(out, "Case", *read_counts_and_limits(text))

    # The cause of a failure is among the last lines that are shown to the user.
    _, code, text = run_case(installed, work, "Broken", 0.1, stl="missing.stl")
    assert code != 0
    assert "missing.stl" in "".join(text.splitlines(keepends=True)[-6:]), text

    # Cases from elsewhere, with numbers of particles above a thousand separator.
    shutil.copytree(os.path.join(cases, "dambreak"), os.path.join(work, "CaseDambreak"))
    folder = os.path.join(work, "CaseDambreak")
    out = os.path.join(folder, "CaseDambreak_out")
    code, text = call(installed, [os.path.join(folder, "CaseDambreak_Def"), os.path.join(out, "CaseDambreak"),
                                  "-save:+all"], folder)
    assert code == 0, text
    number, limits = read_counts_and_limits(text)
    assert number > 100000, number
    check_files(out, "CaseDambreak", number, limits)


if __name__ == "__main__":
    main(*(os.path.abspath(argument) for argument in sys.argv[1:4]))
