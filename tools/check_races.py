#!/usr/bin/python3
"""Runs every stage that has parallel loops with a program of the preset tsan, and fails where its sanitizer tells of a race.

    check_races.py PROGRAM [NAME...]

Each step is a small case that still has enough particles for several threads to get some of them.
"""

import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
THREADS = "-threads:4"


def case(name, *arguments):
    folder = {"dambreak": "CaseDambreak", "gear": "CaseGear", "tyre": "CaseTyre", "pipe": "CasePipe", "tank": "CaseTank",
              "gearbox": "CaseGearbox", "rest": "CaseRest", "floating": "CaseFloating", "wading": "CaseWading"}
    return [f"{ROOT}/cases/{name}/{folder[name]}_Def", *arguments, THREADS]


def template(name, *arguments):
    return [f"{ROOT}/xml-templates/{name}_Def", *arguments, THREADS]


# What runs, and the exit codes that are right; later steps use the results of earlier ones.
STEPS = {
    "lattice": (case("dambreak", "lattice/Case", "-dp:0.017", "-save:all"), (0,)),
    "lattice of meshes": (case("tyre", "meshes/Case", "-fit:off", "-dp:0.014"), (0,)),
    "fitted": (case("gear", "fitted/Case", "-fit:raw", "-dp:0.012", "-save:all"), (0,)),
    "relaxed": (case("gear", "relaxed/Case", "-fit", "-dp:0.012", "-save:all"), (0,)),
    "boolean": (case("gearbox", "boolean/Case", "-fit:raw", "-dp:0.003"), (0,)),
    "layers and normals": (case("pipe", "layers/Case", "-dp:0.01", "-save:all"), (0,)),
    "band of fluid": (case("rest", "band/Case", "-dp:0.02"), (0,)),
    "floating": (case("floating", "floating/Case", "-dp:0.02"), (0,)),
    "fill": (case("tank", "fill/Case", "-dp:0.02"), (0,)),
    "inside": (template("FittedInside", "inside/Case"), (0,)),
    "normals of shapes": (template("NormalsShapes", "shapes/Case"), (0,)),
    "normals of nodes": (template("NormalsOld", "nodes/Case"), (0,)),
    "off the lattice": (template("OffLattice", "off/Case"), (0,)),
    "bathymetry": (template("DrawBathymetry", "ground/Case"), (0,)),
    "estimate": (["estimate", *case("gear", "-fit")], (0,)),
    "inspect": (["inspect", f"{ROOT}/cases/gear/gear.stl", "--dp", "10", "--threads", "4"], (0,)),
    "compare": (["compare", "fitted/Case", "relaxed/Case", "--html", "c.html", "--threads", "4"], (0, 1, 2)),
    "check": (["check", "layers/Case", "--threads", "4"], (0,)),
    "motion": (["check", "relaxed/Case", "--motion", "--step", "2", "--threads", "4"], (0,)),
    "render": (["render", "relaxed/Case", "lattice/Case", "-o", "p.png", "--size", "320x240", "--threads", "4"], (0,)),
    "convert": (["convert", "relaxed/Case", "--to", "vtu", "-o", "a.vtu"], (0,)),
    "report": (["report", "relaxed/Case", "-o", "r.html", "--threads", "4"], (0,)),
    "leak": (["leak", "relaxed/Case", "Part_0000.bi4", "--threads", "4"], (0, 1)),
}
NEEDS = {"compare": ("fitted", "relaxed"), "check": ("layers and normals",), "motion": ("relaxed",), "render": ("relaxed", "lattice"),
         "convert": ("relaxed",), "report": ("relaxed",), "leak": ("relaxed",)}


def text(word):
    return struct.pack("<I", len(word)) + word


def array_of(bi4, name):
    head = b"\nARRAY" + text(name)
    at = bi4.index(head) + len(head)
    count, size = struct.unpack_from("<II", bi4, at + 8)
    return count, bi4[at + 16:at + 16 + size]


def part_of(bi4):
    """An output of the solver that holds the particles of a case."""
    def item(name, values, inside, arrays, items):
        content = text(b"\nVALUES") + struct.pack("<I", len(values)) + b"".join(values)
        head = text(b"\nITEM\n") + text(name) + bytes(8) + text(b"%.7E") + text(b"%.15E")
        head += struct.pack("<III", arrays, items, len(content))
        return struct.pack("<I", len(head)) + head + content + inside

    def array(name, kind, count, data):
        head = text(b"\nARRAY") + text(name) + struct.pack("<iiII", 0, kind, count, len(data))
        return struct.pack("<I", len(head)) + head + data

    count, ids = array_of(bi4, b"Idp")
    _, places = array_of(bi4, b"Posd")
    single = struct.pack(f"<{3 * count}f", *struct.unpack(f"<{3 * count}d", places))
    values = [text(b"TimeStep") + struct.pack("<id", 12, 0.0), text(b"NpTotal") + struct.pack("<iQ", 10, count)]
    part = item(b"PART_0001", values, array(b"Idp", 8, count, ids) + array(b"Pos", 22, count, single), 2, 0)
    return b"#FileJBD JPartDataBi4".ljust(58) + b"\n\0\0\0\0\0" + item(b"JPartDataBi4", [], part, 0, 1)


def run(program, name, folder):
    environment = dict(os.environ, TSAN_OPTIONS=f"ignore_noninstrumented_modules=1 suppressions={ROOT}/tools/tsan.supp")
    if name == "leak":
        with open(os.path.join(folder, "relaxed/Case.bi4"), "rb") as bi4, open(os.path.join(folder, "Part_0000.bi4"), "wb") as part:
            part.write(part_of(bi4.read()))
    arguments, codes = STEPS[name]
    done = subprocess.run([program, *arguments], cwd=folder, env=environment, check=False, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    races = re.findall(r"SUMMARY: ThreadSanitizer: (.*)", done.stdout)
    if not races and done.returncode in codes:
        print(f"{name}: no race", flush=True)
        return True
    tale = re.search(r"={10,}\nWARNING: ThreadSanitizer.*?SUMMARY[^\n]*", done.stdout, flags=re.S)
    print(f"{name}: {len(races)} races, exit code {done.returncode}\n{tale.group() if tale else done.stdout}", flush=True)
    return False


def main():
    program = os.path.abspath(sys.argv[1])
    wanted = sys.argv[2:] or list(STEPS)
    names = [n for n in STEPS if n in wanted or any(n in NEEDS.get(w, ()) for w in wanted)]
    folder = tempfile.mkdtemp(prefix="fppg-races-")
    try:
        results = [run(program, name, folder) for name in names]
    finally:
        shutil.rmtree(folder)
    print(f"{results.count(True)} of {len(results)} stages without a race")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
