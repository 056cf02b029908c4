#!/usr/bin/python3
"""Runs the program on a case and compares the particles with the case's expected.json.

    check_case.py PROGRAM CASE_FOLDER WORK_FOLDER   runs, compares, exits with 1 at a difference
    check_case.py --summary OUT/Case                prints what expected.json holds, from files
                                                    that are there
"""

import hashlib
import math
import sys

import numpy as np

sys.dont_write_bytecode = True
from case_check import check, differences  # noqa: E402 (leaves no file beside it)
from particle_files import read_bi4, read_blocks  # noqa: E402 (case_check adds its path)


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


def is_same(found, expected, place):
    """Numbers to nine digits, densities to float32."""
    if isinstance(expected, float) and isinstance(found, (int, float)):
        tolerance = 1e-6 if place.endswith("rhop_max") else 1e-9
        return math.isclose(found, expected, rel_tol=tolerance, abs_tol=1e-9)
    return found == expected


def faults(case, _, expected):
    """Yields a line for every value that differs from the recorded one."""
    yield from differences(summarise(case), expected, is_same)


if __name__ == "__main__":
    sys.exit(check(sys.argv[1:], __doc__, summarise, "expected.json", faults))
