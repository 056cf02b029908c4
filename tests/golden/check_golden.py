#!/usr/bin/python3
"""Runs the program on a recorded case and compares what it wrote with what GenCase v5.4 wrote.

    check_golden.py PROGRAM CASE_FOLDER WORK_FOLDER                 compare
    check_golden.py PROGRAM CASE_FOLDER WORK_FOLDER --refused TEXT  the program must refuse the case
    check_golden.py PROGRAM CASE_FOLDER WORK_FOLDER --known FILE    compare; FILE lists nodes and normals that differ

CASE_FOLDER is nodes/NAME or fields/NAME and holds NAME_Def.xml, the files it uses,
NAME.expected.csv.gz (one line a particle) and NAME.expected.json.

nodes/   type, mk and lattice node of every particle, in id order: equal, no tolerance. A position
         stands within 1e-6 dp of its node, and so do the limits of all. Where the record has particles off the lattice, all positions
         are compared in id order, within 1e-6 dp.
fields/  the particles of equal id: mk equal; positions within 1e-7 dp + 1e-9 m, velocities within
         1e-6 relative + 1e-5 m/s, densities within 2e-6 rhop0 (both are float32 in the
         file), normals within 1e-4 dp. Constants in Case.bi4 within 1e-9 relative; numbers in Case.xml, of which GenCase
         prints six digits, within 1.5e-5 of themselves, vectors and tensors of their largest entry,
         centres of their length + dp.
"""

import csv
import glob
import gzip
import json
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
sys.dont_write_bytecode = True
from particle_files import read_bi4, read_blocks  # noqa: E402 (found by the path above)


def run_case(program, folder, work):
    """Runs the definition in `folder`; returns (path of the output without extension, exit code, text)."""
    definition, = glob.glob(os.path.join(glob.escape(folder), "*_Def.xml"))
    name = os.path.basename(definition)[:-len("_Def.xml")]
    os.makedirs(work, exist_ok=True)
    out = os.path.join(work, name)
    for old in glob.glob(glob.escape(out) + "*"):
        os.remove(old)
    run = subprocess.run([program, name + "_Def", out, "-save:bi"], cwd=folder, check=False,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return out, run.returncode, run.stdout


def particles_of(case):
    """The arrays of Case.bi4 and, per particle, type and mk from the blocks of Case.xml."""
    values, arrays = read_bi4(case + ".bi4")
    if not np.array_equal(arrays["Idp"], np.arange(len(arrays["Idp"]))):
        raise ValueError(f"{case}.bi4: ids do not count up from 0")
    types, mks = [], []
    for block in read_blocks(case + ".xml"):
        if block["begin"] != len(mks):
            raise ValueError(f"{case}.xml: a block begins at {block['begin']}, expected {len(mks)}")
        types += [block["type"]] * block["count"]
        mks += [block["mk"]] * block["count"]
    if len(mks) != len(arrays["Idp"]):
        raise ValueError(f"{case}: the blocks hold {len(mks)} particles, the file {len(arrays['Idp'])}")
    return values, arrays, types, mks


def read_known(path, case):
    """Lines `case missing|extra mk i j k` of a list of nodes that are known to differ."""
    known = {"missing": set(), "extra": set()}
    if path is None:
        return known
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split("#")[0].split()
            if words and words[0] == case and words[1] in known:
                known[words[1]].add(tuple(int(w) for w in words[2:]))
    return known


def compare_nodes(case, rows, expected, known):
    """Yields a line for every kind of difference."""
    values, arrays, types, mks = particles_of(case)
    if mks:
        for name, limit in (("CasePosMin", "posmin"), ("CasePosMax", "posmax")):
            if np.abs(np.array(values[name]) - expected[limit]).max() > 1e-6 * expected["dp"]:
                yield f"{name} is {values[name]}, expected {expected[limit]}"
    origin, dp = np.array(expected["lattice_origin"]), expected["dp"]
    if any(not r["i"] for r in rows):
        # Particles off the lattice or two a node: every place is compared, in id order.
        if [(r["type"], int(r["mk"])) for r in rows] != list(zip(types, mks)):
            yield "types or mks differ"
        elif np.abs(arrays["Posd"] - [[float(r[a]) for a in "xyz"] for r in rows]).max() > 1e-6 * dp:
            yield "positions differ"
        return
    steps = (arrays["Posd"] - origin) / dp
    nodes = np.rint(steps).astype(int)
    if len(steps) and np.abs(steps - nodes).max() > 1e-6:
        yield "a particle stands off its lattice node"
    found = [(t, m, *n) for t, m, n in zip(types, mks, nodes.tolist())]
    wanted = [(r["type"], int(r["mk"]), int(r["i"]), int(r["j"]), int(r["k"])) for r in rows]
    missing, extra = set(wanted) - set(found), set(found) - set(wanted)
    for word, nodes_of_word in (("missing", missing), ("extra", extra)):
        new = {n for n in nodes_of_word if n[1:] not in known[word]}
        healed = known[word] - {n[1:] for n in nodes_of_word}
        if new:
            yield f"{len(new)} {word} (type, mk, i, j, k): {sorted(new)[:5]}"
        if healed:
            yield f"no longer {word}, so take it off the list of known ones: {sorted(healed)[:5]}"
    # What both have comes in the same order; without differences that is all.
    order_found = [n for n in found if n not in extra]
    order_wanted = [n for n in wanted if n not in missing]
    if order_found != order_wanted:
        at = next((i for i, (a, b) in enumerate(zip(order_found, order_wanted)) if a != b), "the end")
        yield f"the order of ids differs from {at} on"


def column(rows, *names):
    return np.array([[float(r[n]) for n in names] for r in rows]).reshape(len(rows), len(names))


def is_near(found, expected, relative, absolute=0.0):
    """Numbers, text, or nested lists of numbers, which are measured by their largest entry."""
    if isinstance(expected, (bool, str)) or found is None:
        return found == expected
    a, b = np.asarray(found, float), np.asarray(expected, float)
    if b.shape == (3, 3) and a.shape == (3,):
        a = np.diag(a)  # GenCase writes a tensor whose other entries are zero as x, y, z
    if a.shape != b.shape:
        return False
    if b.shape == (3, 3) and not np.array_equal(a == 0, b == 0):
        return False  # they decide in which form GenCase writes it
    return bool(np.all(np.abs(a - b) <= absolute + relative * (np.abs(b).max() if b.size else 0)))


def value_of(element):
    """What an element of Case.xml says: its value attribute, x y z, or a tensor v11 to v33."""
    rows = element.findall("values")
    if rows:
        return [[float(row.get(f"v{i}{j}")) for j in (1, 2, 3)] for i, row in enumerate(rows, 1)]
    text = element.get("value")
    if text is None:
        return [float(element.get(axis)) for axis in "xyz"] if element.get("x") is not None else None
    if text in ("true", "false"):
        return text == "true"
    return float(text)


def compare_xml(case, expected):
    execution = ElementTree.parse(case + ".xml").getroot().find("execution")
    for name, value in expected["constants"].items():
        element = execution.find("constants/" + name)
        found = None if element is None else value_of(element)
        if not is_near(found, value, 1.5e-5):
            yield f"Case.xml {name}: {found}, expected {value}"
    particles = execution.find("particles")
    for name, value in expected["particles"].items():
        if particles.get(name) != str(value):
            yield f"Case.xml particles {name}: {particles.get(name)}, expected {value}"
    blocks = [e for e in particles if e.tag in ("fixed", "moving", "floating", "fluid")]
    if len(blocks) != len(expected["blocks"]):
        yield f"Case.xml has {len(blocks)} blocks, expected {len(expected['blocks'])}"
    for element, block in zip(blocks, expected["blocks"]):
        found = {"type": element.tag, **element.attrib}
        for name, value in block.items():
            if isinstance(value, (float, list)):
                child = element.find(name)
                got = None if child is None else value_of(child)
                if got is None and name.endswith("DOF"):
                    got = [1.0, 1.0, 1.0]
                if name == "center":
                    length = max(abs(c) for c in value) + expected["bi4"]["Dp"]
                    near = is_near(got, value, 0, 1.5e-5 * length)
                else:
                    near = is_near(got, value, 1.5e-5)
            else:
                got = found.get(name)
                near = got == str(value)
            if not near:
                yield f"Case.xml block mk {block['mk']} {name}: {got}, expected {value}"


def read_known_normals(path, case):
    """Ids in the lines `case normal id` of a list of what is known to differ."""
    if path is None:
        return set()
    with open(path, encoding="utf-8") as file:
        lines = [line.split("#")[0].split() for line in file]
    return {int(words[2]) for words in lines if words[:2] == [case, "normal"]}


def compare_fields(case, rows, expected, known_normals):
    """Yields a line for every kind of difference."""
    values, arrays, _, mks = particles_of(case)
    if len(mks) != len(rows):
        yield f"{len(mks)} particles, expected {len(rows)}"
        return
    rows.sort(key=lambda r: int(r["idp"]))
    if mks != [int(r["mk"]) for r in rows]:
        yield "mk differs"
    dp, rhop0 = expected["bi4"]["Dp"], expected["bi4"]["Rhop0"]
    velocity = column(rows, "velx", "vely", "velz")
    for name, array, wanted, tolerance in (
            ("position", arrays["Posd"], column(rows, *"xyz"), 1e-7 * dp + 1e-9),
            ("velocity", arrays["Vel"], velocity, 1e-5 + 1e-6 * np.abs(velocity)),
            ("density", arrays["Rhop"][:, None], column(rows, "rhop"), 2e-6 * rhop0)):
        error = np.abs(array - wanted)
        wrong = ~(error <= tolerance).all(axis=1)
        if wrong.any():
            first = int(np.argmax(wrong))
            yield (f"{name}: {wrong.sum()} of {len(rows)} differ, first id {first}: "
                   f"{array[first]}, expected {wanted[first]}")
    if ("BoundNor" in arrays) != expected["has_normals"]:
        yield f"BoundNor is {'there' if 'BoundNor' in arrays else 'missing'}"
    elif expected["has_normals"]:
        # Where the nearest shape is decided by rounding alone, nskip is 1.
        told = [r for r in rows[:len(arrays["BoundNor"])] if r["norx"] and r["nskip"] == "0"]
        error = np.abs(arrays["BoundNor"][[int(r["idp"]) for r in told]] - column(told, "norx", "nory", "norz"))
        wrong = {int(r["idp"]) for r, is_near in zip(told, (error <= 1e-4 * dp).all(axis=1)) if not is_near}
        if wrong - known_normals:
            yield f"normals: {len(wrong - known_normals)} of {len(told)} differ, first id {min(wrong - known_normals)}"
        if known_normals - wrong:
            yield f"normals no longer differ, so take them off the list of known ones: {sorted(known_normals - wrong)[:5]}"
    for name, value in expected["bi4"].items():
        place = 1e-12 if name.startswith(("CasePos", "Data2dPos")) else 0.0
        if not is_near(values.get(name), value, 1e-9, place):
            yield f"Case.bi4 {name}: {values.get(name)}, expected {value}"
    yield from compare_xml(case, expected)


def main(arguments):
    if len(arguments) not in (3, 5) or (len(arguments) == 5 and arguments[3] not in ("--refused", "--known")):
        sys.exit(__doc__)
    program, folder, work = (os.path.abspath(a) for a in arguments[:3])
    case, code, text = run_case(program, folder, work)
    name = os.path.basename(case)
    if arguments[3:4] == ["--refused"]:
        if code == 0:
            print(f"{name} is supported now; take it off not_yet.txt")
        elif code != 3 or arguments[4] not in text:
            print(f"{name}: expected exit code 3 and \"{arguments[4]}\", found {code} and:\n{text}")
        leftovers = [f for f in glob.glob(glob.escape(case) + "*") if f != case + ".out"]
        for file in leftovers:
            print(f"{file} was written")
        return 0 if code == 3 and arguments[4] in text and not leftovers else 1
    if code != 0:
        print(f"{text}\n{name}: the program stopped with {code}")
        return 1
    base = os.path.join(folder, name + ".expected")
    with open(base + ".json", encoding="utf-8") as file:
        expected = json.load(file)
    with gzip.open(base + ".csv.gz", "rt", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    known_file = arguments[4] if len(arguments) == 5 else None
    if rows and "idp" in rows[0]:
        lines = list(compare_fields(case, rows, expected, read_known_normals(known_file, name)))
    else:
        known = read_known(known_file, name)
        lines = list(compare_nodes(case, rows, expected, known))
    for line in lines:
        print(f"{name}: {line}")
    print(f"{name}: {len(rows)} particles, {len(lines)} differences from {expected['recorded_with']}")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
