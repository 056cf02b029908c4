"""Cuts one period out of a case with one wall and one fluid, as the solver wants it for a pipe that goes on without end."""

import re
import struct

import numpy as np
from particle_files import read_bi4

# numpy type: the code of the container, by bytes of a number and width.
CODES = {("uint32", 1): 8, ("float32", 1): 11, ("float32", 3): 22, ("float64", 3): 23}
NEAREST = 0.5  # dp: of a pair nearer than this across the cut one goes


def seam_pairs(pos, vector, dp):
    """Which particles go, as each has a partner nearer than NEAREST dp one period on; few, near the cut only."""
    near = np.flatnonzero(pos[:, 0] < dp)
    far = np.flatnonzero(pos[:, 0] > vector[0] - 2 * dp)
    distance = np.linalg.norm(pos[near][:, None] + vector - pos[far][None], axis=2)
    go = np.zeros(len(pos), bool)
    go[far[(distance < NEAREST * dp).any(0)]] = True
    return go


def array_block(name, values):
    width = values.shape[1] if values.ndim > 1 else 1
    text = struct.pack("<I", 6) + b"\nARRAY" + struct.pack("<I", len(name)) + name.encode()
    text += struct.pack("<iiII", 0, CODES[values.dtype.name, width], len(values), values.nbytes)
    return struct.pack("<I", len(text)) + text + np.ascontiguousarray(values).tobytes()


def patch(data, name, code, form, *values):
    """Overwrites a value of the container in place."""
    key = struct.pack("<I", len(name)) + name.encode() + struct.pack("<i", code)
    at = data.find(key)
    if at < 0:
        raise ValueError(f"no value {name}; expected a case file")
    struct.pack_into(form, data, at + len(key), *values)


def cut_period(case, dp, period, vector):
    """Keeps the particles with x from -dp/2 to period - dp/2, in Case.bi4 and Case.xml, in place.

    The solver's period is CasePosMax - CasePosMin + dp in x: both are written so that it is `period`, for with particles off
    the lattice the outermost ones do not say it. vector: to the next copy, (period, 0, rise).
    """
    with open(case + ".bi4", "rb") as file:
        data = bytearray(file.read())
    _, arrays = read_bi4(case + ".bi4")
    with open(case + ".xml", encoding="utf-8") as file:
        xml = file.read()
    n_wall = int(re.search(r'<particles [^>]*\bnb="(\d+)"', xml)[1])
    pos = arrays["Posd"]
    is_in = (pos[:, 0] >= -dp / 2 * (1 - 1e-9)) & (pos[:, 0] < period - dp / 2 * (1 + 1e-9))
    keep = np.zeros(len(pos), bool)
    for part in (slice(0, n_wall), slice(n_wall, len(pos))):
        ids = np.flatnonzero(is_in[part]) + (part.start or 0)
        keep[ids[~seam_pairs(pos[ids], np.array(vector), dp)]] = True
    walls, fluid = int(keep[:n_wall].sum()), int(keep[n_wall:].sum())
    out = {"Idp": np.arange(walls + fluid, dtype=np.uint32)}
    out.update({k: arrays[k][keep] for k in ("Posd", "Vel", "Rhop")})
    if "BoundNor" in arrays:
        out["BoundNor"] = arrays["BoundNor"][keep[:n_wall]]
    low, high = out["Posd"].min(0), out["Posd"].max(0)
    low[0], high[0] = 0, period - dp
    for name, count in (("CaseNp", walls + fluid), ("CaseNfixed", walls), ("CaseNfluid", fluid)):
        patch(data, name, 10, "<Q", count)
    patch(data, "Npok", 8, "<I", walls + fluid)
    patch(data, "CasePosMin", 23, "<3d", *low)
    patch(data, "CasePosMax", 23, "<3d", *high)
    start = data.find(b"\nARRAY") - 8
    with open(case + ".bi4", "wb") as file:
        file.write(bytes(data[:start]) + b"".join(array_block(k, v) for k, v in out.items()))
    xml = re.sub(r'(<particles np=")\d+(" nb=")\d+(" nbf=")\d+', rf"\g<1>{walls + fluid}\g<2>{walls}\g<3>{walls}", xml)
    xml = re.sub(r'(<fixed [^>]*begin=")\d+(" count=")\d+', rf"\g<1>0\g<2>{walls}", xml)
    xml = re.sub(r'(<fluid [^>]*begin=")\d+(" count=")\d+', rf"\g<1>{walls}\g<2>{fluid}", xml)
    with open(case + ".xml", "w", encoding="utf-8") as file:
        file.write(xml)
    return int((is_in & ~keep).sum())
