"""Reads particle files into numpy arrays: Case.bi4 with Case.xml, and legacy VTK.

Used by the scripts of this folder and by tests/cases; the program does not need it.
"""

import mmap
import os
import struct
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from case_xml import read_xml  # noqa: E402 (found by the path above)

# JBinaryData type codes: numpy type and numbers an element.
JBD_TYPES = {3: ("<i1", 1), 4: ("<u1", 1), 5: ("<i2", 1), 6: ("<u2", 1), 7: ("<i4", 1),
             8: ("<u4", 1), 9: ("<i8", 1), 10: ("<u8", 1), 11: ("<f4", 1), 12: ("<f8", 1),
             20: ("<i4", 3), 21: ("<u4", 3), 22: ("<f4", 3), 23: ("<f8", 3)}
TEXT, BOOL = 1, 2

TYPES = {"fixed": 0, "moving": 1, "floating": 2, "fluid": 3}

VTK_TYPES = {"unsigned_char": ">u1", "char": ">i1", "unsigned_short": ">u2", "short": ">i2",
             "unsigned_int": ">u4", "int": ">i4", "float": ">f4", "double": ">f8"}


class _Jbd:
    """A cursor over the bytes of a JBinaryData file."""

    def __init__(self, data):
        self.data, self.at = data, 64
        self.is_wide = data[61] == 1  # array sizes as 64-bit integers

    def number(self, code):
        value, = struct.unpack_from("<" + code, self.data, self.at)
        self.at += struct.calcsize("<" + code)
        return value

    def text(self):
        size = self.number("I")
        self.at += size
        return self.data[self.at - size:self.at].decode("latin-1")

    def tag(self, expected):
        found = self.text()
        if found != expected:
            raise ValueError(f"expected {expected!r} at byte {self.at}, found {found!r}")

    def value(self, kind):
        if kind == TEXT:
            return self.text()
        if kind == BOOL:
            return self.number("i") != 0
        code, count = JBD_TYPES[kind]
        out = np.frombuffer(self.data, code, count, self.at)
        self.at += out.nbytes
        return out[0].item() if count == 1 else out.tolist()

    def item(self):
        """(name, values, arrays, items)"""
        self.number("I")
        self.tag("\nITEM\n")
        name = self.text()
        self.number("i"), self.number("i")
        self.text(), self.text()
        n_arrays, n_items, value_size = self.number("I"), self.number("I"), self.number("I")
        values, arrays, items = {}, {}, {}
        if value_size:
            self.tag("\nVALUES")
            for _ in range(self.number("I")):
                key, kind = self.text(), self.number("i")
                values[key] = self.value(kind)
        for _ in range(n_arrays):
            self.number("I")
            self.tag("\nARRAY")
            key = self.text()
            self.number("i")
            kind = self.number("i")
            count, size = (self.number("Q" if self.is_wide else "I") for _ in range(2))
            code, width = JBD_TYPES[kind]
            array = np.frombuffer(self.data, code, count * width, self.at)
            arrays[key] = array.reshape(-1, width) if width > 1 else array
            self.at += size
        for _ in range(n_items):
            key, *rest = self.item()
            items[key] = rest
        return name, values, arrays, items


def read_bi4(path, is_mapped=False):
    """Values and arrays of a case file, or of the solver's Part_NNNN.bi4: constants, Idp, Pos or Posd, Vel, Rhop.

    is_mapped  the arrays are views of the mapped file, of which only what is looked at is read; nobody may change the
               file meanwhile
    """
    with open(path, "rb") as file:
        if file.read(21) != b"#FileJBD JPartDataBi4":
            raise ValueError(f"{path}: not a particle file of a case")
        file.seek(0)
        data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) if is_mapped else file.read()
    _, values, _, items = _Jbd(data).item()
    part, = (item for key, item in items.items() if key.startswith("PART_"))
    part_values, arrays, _ = part
    return {**values, **part_values}, arrays


def read_blocks(path):
    """The blocks in a Case.xml: dicts with type, mk, mk_type, begin, count, in id order."""
    particles = read_xml(path).find("case/execution/particles")
    if particles is None:
        raise ValueError(f"{path}: no <particles>; expected the XML written beside a .bi4")
    blocks = []
    for element in particles:
        if element.tag in ("fixed", "moving", "floating", "fluid"):
            mk_type = element.get("mkfluid" if element.tag == "fluid" else "mkbound")
            blocks.append({"type": element.tag, "mk": int(element.get("mk")),
                           "mk_type": int(mk_type), "begin": int(element.get("begin")),
                           "count": int(element.get("count"))})
    return blocks


def find_case_xml(path, case_name):
    """The Case.xml of a .bi4: beside it, or by the name of the case beside it or one folder above, as for the
    solver's outputs; None where there is none."""
    folder = os.path.dirname(os.path.abspath(path))
    for name in (os.path.splitext(os.path.abspath(path))[0] + ".xml", os.path.join(folder, case_name + ".xml"),
                 os.path.join(folder, "..", case_name + ".xml")):
        if os.path.isfile(name):
            return os.path.normpath(name)
    return None


def find_blocks(ids, blocks):
    """The index of the block that holds each id (int32, n); -1 where none does.

    blocks  as read_blocks() gives them
    """
    out = np.full(len(ids), -1, np.int32)
    order = sorted(range(len(blocks)), key=lambda b: blocks[b]["begin"])
    if not order:
        return out
    begins = np.array([blocks[b]["begin"] for b in order], np.int64)
    ends = begins + np.array([blocks[b]["count"] for b in order], np.int64)
    at_once = 1 << 20  # of many millions, so that memory does not hold all ids as 64-bit numbers
    for first in range(0, len(ids), at_once):
        chosen = ids[first:first + at_once].astype(np.int64)
        place = np.searchsorted(begins, chosen, side="right") - 1
        is_inside = (place >= 0) & (chosen < ends[place])
        out[first:first + at_once][is_inside] = np.array(order, np.int32)[place[is_inside]]
    return out


def particle_arrays(path):
    """Positions (n x 3), point data by name, the index of each particle's block or None, and the blocks of a .bi4."""
    values, arrays = read_bi4(path, is_mapped=True)
    if values.get("Npiece", 1) != 1:
        raise ValueError(f"{path}: one of {values['Npiece']} pieces, expected all particles in one file")
    arrays = dict(arrays)
    positions = arrays.pop("Pos") if "Pos" in arrays else arrays.pop("Posd")
    arrays.pop("Posd", None)
    count = len(positions)
    data = {}
    for name, array in arrays.items():
        if len(array) < count:  # of boundary particles only, which come first
            array = np.concatenate([array, np.zeros((count - len(array), *array.shape[1:]), array.dtype)])
        data[name] = array
    xml = find_case_xml(path, values.get("CaseName", ""))
    if xml is None:
        return positions, data, None, []
    blocks = read_blocks(xml)
    of_block = find_blocks(data["Idp"], blocks)
    # Particles that the solver added, as at inlets, belong to no block.
    data["Mk"] = np.array([b["mk"] for b in blocks] + [-1], np.int32)[of_block]
    data["Type"] = np.array([TYPES[b["type"]] for b in blocks] + [TYPES["fluid"]], np.uint8)[of_block]
    return positions, data, of_block, blocks


def read_vtk(path):
    """Points and point data of a legacy binary VTK file with vertices: dict of numpy arrays."""
    with open(path, "rb") as file:
        data = file.read()
    out, at, n_points = {}, 0, 0

    def line():
        nonlocal at
        while True:
            end = data.find(b"\n", at)
            end = len(data) if end < 0 else end
            words = data[at:end].decode("latin-1").split()
            at = end + 1
            if words or at >= len(data):
                return words

    def block(kind, count, width=1):
        nonlocal at
        array = np.frombuffer(data, VTK_TYPES[kind], count * width, at)
        at += array.nbytes
        return array.reshape(-1, width) if width > 1 else array

    if not data.startswith(b"# vtk DataFile"):
        raise ValueError(f"{path}: not a legacy VTK file")
    line(), line()
    if line() != ["BINARY"]:
        raise ValueError(f"{path}: only binary VTK is read")
    while at < len(data):
        words = line()
        if not words:
            break
        if words[0] == "POINTS":
            n_points = int(words[1])
            out["points"] = block(words[2], n_points, 3)
        elif words[0] in ("VERTICES", "LINES", "POLYGONS"):
            at += 4 * int(words[2])
        elif words[0] == "SCALARS":
            line()  # LOOKUP_TABLE
            out[words[1]] = block(words[2], n_points)
        elif words[0] == "FIELD":
            for _ in range(int(words[2])):
                name, width, count, kind = line()
                out[name] = block(kind, int(count), int(width))
    return out


def read_particles(path):
    """Positions (float64, n x 3) and absolute mk (n) of a VTK file, or of a case.

    path  a .vtk with Mk; or a case: Case.bi4, Case.xml or Case, of which both files are read
    """
    stem, extension = os.path.splitext(path)
    if extension == ".vtk":
        data = read_vtk(path)
        return data["points"].astype(np.float64), data["Mk"].astype(np.int64)
    stem = stem if extension in (".bi4", ".xml") else path
    _, arrays = read_bi4(stem + ".bi4")
    positions = arrays["Posd"] if "Posd" in arrays else arrays["Pos"].astype(np.float64)
    mk = np.zeros(len(positions), np.int64)
    for block in read_blocks(stem + ".xml"):
        mk[block["begin"]:block["begin"] + block["count"]] = block["mk"]
    return positions, mk
