#!/usr/bin/python3
"""Runs the program on a recorded case and lets `fppg compare` judge it against the record of GenCase v5.4.

    compare_recorded.py PROGRAM CASE_FOLDER WORK_FOLDER [fitted]

The record (NAME.expected.csv.gz, see tests/golden) is written as Recorded_All.vtk with double positions.
They must be equal; with one particle of the record shifted by 0.25 dp, that one must be named. With "fitted", the case is made with
body-fitted walls too: what moved, by how much, and how near it is to the geometry must be told.
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


def compare(program, work, *options, name="Case"):
    run = subprocess.run([program, "compare", name, "Recorded_All.vtk", "--json", "compare.json", *options],
                         cwd=work, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    with open(os.path.join(work, "compare.json"), encoding="utf-8") as file:
        return run.returncode, run.stdout, json.load(file)


def check_fitted(program, definition, work):
    """The record has its walls on the lattice: those of A moved onto the surface, by less than the lattice is wide."""
    subprocess.run([program, definition, os.path.join(work, "Fitted"), "-save:bi", "-fit:raw"], check=True,
                   cwd=os.path.dirname(definition), stdout=subprocess.DEVNULL)
    code, text, found = compare(program, work, "--definition", definition, name="Fitted")
    assert code == 1 and not found["is_equal"], text
    walls = [mk for mk in found["mks"] if mk["type"][0] in ("fixed", "floating")]
    fluid = [mk for mk in found["mks"] if mk["type"][0] == "fluid"]
    assert walls and fluid, text
    for mk in walls:
        assert mk["moved"] > 0 and 0 < mk["moved_dp"]["mean"] < mk["moved_dp"]["largest"] <= 1, mk
        assert f"  {mk['moved_dp']['largest']:.3f}" in text and "is body-fitted" in text, text
        # Sheets with fluid on one side have layers behind it; what floats has all particles inside.
        fitted, lattice = (of["histogram"]["counts"][0] for of in mk["distance_dp"])
        on_surface = f"mk {mk['mk']}: {fitted} and {lattice} are on the surface"
        if mk["type"][0] == "floating":
            assert fitted == 0, on_surface
        else:
            assert fitted > 0.2 * mk["count"][0] and fitted > 2 * lattice, on_surface
        assert mk["count"] == [mk["same_place"] + mk["moved"] + mk["missing"] + mk["mk_changed"],
                               mk["same_place"] + mk["moved"] + mk["extra"] + mk["mk_gained"]], mk
    assert all(mk["moved"] == 0 and mk["same_place"] > 0.5 * mk["count"][1] for mk in fluid), text


def main(program, folder, work, fitted=""):
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

    if fitted:
        check_fitted(program, definition[:-len(".xml")], work)

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
