#!/usr/bin/python3
"""Runs the program on a recorded case and lets `fppg compare` judge it against the record of GenCase v5.4.

    compare_recorded.py PROGRAM CASE_FOLDER WORK_FOLDER

The record (NAME.expected.csv.gz, see tests/golden) is written as Recorded_All.vtk with double positions.
They must be equal; with one particle of the record shifted by 0.25 dp, that one must be named.
"""

import csv
import glob
import gzip
import json
import os
import subprocess
import sys

import numpy as np

TYPES = ("fixed", "moving", "floating", "fluid")


def write_vtk(path, ids, positions, mks, types, density, velocity, normals):
    n = len(ids)
    arrays = [("Idp", "unsigned_int", ids.astype(">u4")), ("Mk", "unsigned_short", mks.astype(">u2")),
              ("Type", "unsigned_char", types.astype(">u1")), ("Rhop", "float", density.astype(">f4")),
              ("Vel", "float", velocity.astype(">f4")), ("Normal", "float", normals.astype(">f4")),
              ("NormalSize", "float", np.linalg.norm(normals, axis=1).astype(">f4") if n else normals)]
    arrays = [a for a in arrays if len(a[2]) == n]
    with open(path, "wb") as file:
        file.write(b"# vtk DataFile Version 3.0\nrecord\nBINARY\nDATASET POLYDATA\n")
        file.write(b"POINTS %d double\n" % n + positions.astype(">f8").tobytes())
        file.write(b"\nPOINT_DATA %d\nFIELD FieldData %d\n" % (n, len(arrays)))
        for name, kind, values in arrays:
            width = 1 if values.ndim == 1 else values.shape[1]
            file.write(f"{name} {width} {n} {kind}\n".encode() + values.tobytes() + b"\n")


def column(rows, *names):
    return np.array([[float(r[name] or 0) for name in names] for r in rows]).reshape(len(rows), len(names))


def compare(program, work, *options):
    run = subprocess.run([program, "compare", "Case", "Recorded_All.vtk", "--json", "compare.json", *options],
                         cwd=work, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    with open(os.path.join(work, "compare.json"), encoding="utf-8") as file:
        return run.returncode, run.stdout, json.load(file)


def main(program, folder, work):
    program, folder, work = (os.path.abspath(p) for p in (program, folder, work))
    definition, = glob.glob(os.path.join(glob.escape(folder), "*_Def.xml"))
    name = os.path.basename(definition)[:-len("_Def.xml")]
    os.makedirs(work, exist_ok=True)
    subprocess.run([program, name + "_Def", os.path.join(work, "Case"), "-save:bi"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    with gzip.open(os.path.join(folder, name + ".expected.csv.gz"), "rt", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with open(os.path.join(folder, name + ".expected.json"), encoding="utf-8") as file:
        expected = json.load(file)
    is_fields = "idp" in rows[0]
    ids = column(rows, "idp" if is_fields else "id")[:, 0]
    rows = [rows[i] for i in np.argsort(ids)]
    ids = np.sort(ids)
    type_of_mk = {b["mk"]: TYPES.index(b["type"]) for b in expected["blocks"]}
    mks = column(rows, "mk")[:, 0].astype(int)
    types = np.array([type_of_mk[mk] for mk in mks])
    positions = column(rows, "x", "y", "z")
    dp = expected["bi4"]["Dp"] if is_fields else expected["dp"]
    none = np.zeros((0, 3))
    fields = (column(rows, "rhop")[:, 0], column(rows, "velx", "vely", "velz")) if is_fields else (none, none)
    has_normals = is_fields and expected["has_normals"] and all(r["nskip"] == "0" for r in rows)
    normals = column(rows, "norx", "nory", "norz") if has_normals else none
    path = os.path.join(work, "Recorded_All.vtk")

    write_vtk(path, ids, positions, mks, types, *fields, normals)
    code, text, found = compare(program, work)
    if code != 0 or not found["is_equal"]:
        sys.exit(f"{name}: expected to be equal, found\n{text}")

    shifted = len(rows) // 2
    positions[shifted, 2] += 0.25 * dp
    write_vtk(path, ids, positions, mks, types, *fields, normals)
    code, text, found = compare(program, work)
    moved = [e for e in found["examples"] if e["kind"] == "moved"]
    if code != 1 or len(moved) != 1 or moved[0]["a"]["id"] != shifted or abs(moved[0]["size"] - 0.25) > 1e-5:
        sys.exit(f"{name}: expected id {shifted} to have moved by 0.25 dp, found\n{text}")
    print(f"{name}: {len(rows)} particles, equal to {expected['recorded_with']}")


if __name__ == "__main__":
    main(*sys.argv[1:])
