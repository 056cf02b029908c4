#!/usr/bin/python3
"""Runs the program on a case and compares the particles with the case's expected.json.

    check_case.py PROGRAM CASE_FOLDER WORK_FOLDER   runs, compares, exits with 1 at a difference
    check_case.py --summary OUT/Case                prints what expected.json holds, from files
                                                    that are there
"""

import glob
import hashlib
import json
import math
import os
import subprocess
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
sys.dont_write_bytecode = True
from particle_files import read_bi4, read_blocks  # noqa: E402 (found by the path above)


def summarise(case):
    """What the files Case.bi4 and Case.xml hold, short enough to be kept.

    nodes_sha256 is over the lattice node of every particle in id order, as three little-endian
    32-bit integers counted from posmin: equal digests mean equal particles with equal ids.
    """
    values, arrays = read_bi4(case + ".bi4")
    positions, dp = arrays["Posd"], values["Dp"]
    low = positions.min(axis=0)
    nodes = np.rint((positions - low) / dp)
    off_lattice = np.abs((positions - low) / dp - nodes).max()
    if off_lattice > 1e-6:
        raise ValueError(f"{case}.bi4: a particle stands {off_lattice} dp off the lattice")
    if not np.array_equal(arrays["Idp"], np.arange(len(positions))):
        raise ValueError(f"{case}.bi4: ids do not count up from 0")
    blocks = []
    for block in read_blocks(case + ".xml"):
        part = positions[block["begin"]:block["begin"] + block["count"]]
        blocks.append({**block, "posmin": part.min(axis=0).tolist(),
                       "posmax": part.max(axis=0).tolist()})
    bound = values["CaseNfixed"] + values["CaseNmoving"] + values["CaseNfloat"]
    return {
        "recorded_with": values["AppName"],
        "np": values["CaseNp"], "nb": bound, "nbf": values["CaseNfixed"],
        "nmoving": values["CaseNmoving"], "nfloat": values["CaseNfloat"],
        "nfluid": values["CaseNfluid"],
        "data2d": values["Data2d"], "dp": dp, "h": values["H"], "b": values["B"],
        "massbound": values["MassBound"], "massfluid": values["MassFluid"],
        "rhop_max": arrays["Rhop"].max().item(),
        "posmin": low.tolist(), "posmax": positions.max(axis=0).tolist(),
        "nodes_sha256": hashlib.sha256(nodes.astype("<i4").tobytes()).hexdigest(),
        "blocks": blocks,
    }


def differences(found, expected, place=""):
    """Yields a line for every value that differs; numbers to nine digits, densities to float32."""
    if isinstance(expected, dict) and isinstance(found, dict):
        for key in expected:
            if key != "recorded_with":
                yield from differences(found.get(key), expected[key], f"{place}/{key}")
    elif isinstance(expected, list) and isinstance(found, list) and len(found) == len(expected):
        for i, (a, b) in enumerate(zip(found, expected)):
            yield from differences(a, b, f"{place}/{i}")
    elif isinstance(expected, float) and isinstance(found, (int, float)):
        tolerance = 1e-6 if place.endswith("rhop_max") else 1e-9
        if not math.isclose(found, expected, rel_tol=tolerance, abs_tol=1e-9):
            yield f"{place}: expected {expected}, found {found}"
    elif found != expected:
        yield f"{place}: expected {expected}, found {found}"


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "--summary":
        print(json.dumps(summarise(arguments[1]), indent=1))
        return 0
    if len(arguments) != 3:
        sys.exit(__doc__)
    program, folder, work = (os.path.abspath(a) for a in arguments)
    definition, = glob.glob(os.path.join(glob.escape(folder), "*_Def.xml"))
    name = os.path.basename(definition)[:-len("_Def.xml")]
    out = os.path.join(work, name)
    for old in glob.glob(glob.escape(out) + "*"):
        os.remove(old)
    run = subprocess.run([program, name + "_Def", out, "-save:all"], cwd=folder,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if run.returncode != 0:
        print(run.stdout)
        print(f"{name}: the program stopped with {run.returncode}")
        return 1
    with open(os.path.join(folder, "expected.json"), encoding="utf-8") as file:
        expected = json.load(file)
    lines = list(differences(summarise(out), expected))
    for line in lines:
        print(f"{name}{line}")
    print(f"{name}: {len(lines)} differences from {expected['recorded_with']}")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
