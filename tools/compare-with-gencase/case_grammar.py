"""Random cases of the case language: which commands there are, and how one of each may look.

Case number n of seed s is the same on every machine and does not depend on how many cases are drawn.
"""

import math
import os
import random
import struct
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import make_meshes  # noqa: E402 (found by the path above)

AXES = "xyz"
SIDES = ("bottom", "top", "left", "right", "front", "back")


@dataclass
class Case:
    """A definition and the files that it reads, by name."""
    root: ElementTree.Element
    files: dict

    def text(self):
        ElementTree.indent(self.root, "  ")
        return ElementTree.tostring(self.root, encoding="unicode") + "\n"


def element(tag, attributes=None, *children, text=None):
    """Attributes that are None are left out."""
    out = ElementTree.Element(tag, {k: str(v) for k, v in (attributes or {}).items() if v is not None})
    out.text = text
    out.extend(children)
    return out


def digits(value):
    """A number without exponent, which the expressions of GenCase do not take."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def stl_bytes(mesh):
    out = [b"mesh".ljust(80), struct.pack("<I", len(mesh.facets))]
    for facet in mesh.facets:
        a, b, c = (mesh.vertices[i] for i in facet)
        out.append(struct.pack("<12fH", *make_meshes.normal(a, b, c), *a, *b, *c, 0))
    return b"".join(out)


# Draws, and what may be drawn once something is there.
POINT_DRAWS = ("drawpoint", "drawpoints", "drawline", "drawlines", "drawlineto")
FACE_DRAWS = ("drawtriangle", "drawquadri", "drawtrianglesstrip", "drawtrianglesfan", "drawpolygon",
              "drawtriangles", "drawextrude")
BODY_DRAWS = ("drawfigure", "drawpyramid", "drawprism", "drawbox", "drawbeach", "drawsphere", "drawellipsoid",
              "drawcylinder", "drawwave")
FILE_DRAWS = ("drawfilestl", "drawfileply", "drawfilevtk", "drawfilevtm", "drawfilecsv", "drawbathymetry")
FILLS = ("fillvoidpoint", "fillpoint", "fillbox", "fillfigure", "fillprism")
REDRAWS = ("redraw", "redrawbox", "redrawnear", "redrawnearbox")
# Settings that stay until the next one of their kind; `setdrawmode` is among the frame of every case.
SETTINGS = ("setdpctes", "dpctesreset", "setboxlimitmode", "setmknextbound", "setmknextfluid", "setnormalinvert",
            "setshapemode", "setmkbackbound", "setmkbackfluid", "setmkbackvoid", "setmkbackclear", "setpattern",
            "matrixreset", "resetdraw")
TRANSFORMS = ("move", "scale", "rotate", "rotateline", "rotateadv")
CLIPS = ("clipplane", "clipbox", "clipdomain")
# Pairs round a few draws.
SAVES = {"statesave": "stateload", "matrixsave": "matrixload", "mksave": "mkload", "dpctessave": "dpctesload",
         "varssave": "varsload"}
SWITCHES = ("setfrdrawmode", "setmknextauto", "setactive", "wire")
OUTPUTS = ("shapeout", "cellsout", "pointsmkout", "debugout", "printf")
# What is no command but can be named in --only as well.
FRAME = ("lattice", "2d", "pointref", "mkorient", "list", "variables", "motion", "floatings", "constants")

DRAWS = POINT_DRAWS + FACE_DRAWS + BODY_DRAWS + FILE_DRAWS
COMMANDS = DRAWS + FILLS + REDRAWS + SETTINGS + TRANSFORMS + CLIPS + tuple(SAVES) + SWITCHES + OUTPUTS + FRAME

# GenCase refuses these in wire mode, or while drawing freely.
NOT_WIRE = ("drawcylinder",)
NOT_FREE = ("drawellipsoid", "drawwave")


class Grammar:
    """Draws one case. Lengths are in metres, sizes a few dp."""

    def __init__(self, seed, index, only=()):
        self.rng = random.Random(f"{seed} {index}")
        self.only = frozenset(only)
        self.files = {}
        self.variables = {}
        self.lists = []
        self.patterns = []
        self.bound_mks = set()
        self.is_free = False
        self.dp = self.rng.choice((0.1, 0.1, 0.1, 0.08, 0.125))
        self.is_flat = self.wants("2d", 0.1)
        self.low = [self.rng.choice((-0.5, 0.0, self.round(-0.5, 0.1))) for _ in AXES]
        cells = (18, 16, 14) if not self.is_flat else (24, 0, 20)
        self.high = [lo + n * self.dp + self.rng.choice((0, 0.03)) for lo, n in zip(self.low, cells)]
        if self.is_flat:
            self.high[1] = self.low[1]
        self.step = self.rng.choice((0.001, 0.001, self.dp, self.dp / 2))

    # --- Choices ---

    def chance(self, share):
        return self.rng.random() < share

    def wants(self, name, share):
        """Whether a part of the case that has a name comes in; more often when it is asked for."""
        drawn = self.rng.random()
        return drawn < 0.7 if name in self.only else drawn < share and not self.only

    def some_of(self, names):
        """Those of `names` that --only leaves."""
        return [n for n in names if not self.only or n in self.only]

    def round(self, low, high):
        return round(self.rng.uniform(low, high), 3)

    # --- Numbers, places, sizes ---

    def number(self, value):
        """The number, now and then as an expression that has its value."""
        text = digits(value)
        if not self.variables or self.chance(0.8):
            return text
        name, known = self.rng.choice(sorted(self.variables.items()))
        forms = (f"#{name}{'+' if value >= known else '-'}{digits(abs(value - known))}",
                 f"#({digits(2 * value)})/2", f"#Dp*{digits(value / self.dp)}", f"#min({text},99)",
                 f"#eval({name}>{digits(known - 1)},{text},7)", f"#round({digits(value * 1000)})/1000",
                 f"#{text}*cosdg(0)", f"#max({text},-99)+{name}-{name}")
        return self.rng.choice(forms)

    def along(self, axis, inset=0.0):
        """A place inside the domain along one axis, a little outside now and then."""
        lo, hi = self.low[axis], self.high[axis]
        if self.is_flat and axis == 1:
            return lo
        room = (hi - lo) * inset
        value = self.rng.uniform(lo + room - 0.1 * (inset == 0), hi - room)
        return round(lo + round((value - lo) / self.step) * self.step, 6) if self.step > 0.01 else round(value, 3)

    def place(self, inset=0.0):
        return [self.along(a, inset) for a in range(3)]

    def length(self, low=None, high=7):
        """A length of some dp; while drawing freely none that GenCase finds too sharp."""
        low = low or (3 if self.is_free else 1)
        value = self.rng.uniform(low, high) * self.dp
        return round(max(round(value / self.step), 1) * self.step, 6) if self.step > 0.01 else round(value, 3)

    def vector(self, tag, values, names=AXES):
        return element(tag, {n: self.number(v) for n, v in zip(names, values)})

    def attributes(self, values, names=AXES):
        return {n: self.number(v) for n, v in zip(names, values)}

    def point(self, inset=0.0):
        return self.vector("point", self.place(inset))

    def box_place(self, low=1, is_shape=True):
        """point and size or endpoint of a box."""
        lengths = [self.length(3 if self.is_free else low, 9) for _ in AXES]
        at = [self.along(a, 0.05) for a in range(3)]
        if self.is_flat:
            at[1], lengths[1] = round(self.low[1] - 3 * self.dp, 3), round(6 * self.dp, 3)
        elif is_shape and self.chance(0.1):
            lengths = [-x for x in lengths]
        if self.chance(0.3):
            return [self.vector("point", at), self.vector("endpoint", [p + s for p, s in zip(at, lengths)])]
        return [self.vector("point", at), self.vector("size", lengths)]

    def flag(self):
        return self.rng.choice(("true", "false"))

    def words(self, words, most=None):
        return " | ".join(self.rng.sample(words, self.rng.randint(1, most or len(words))))

    # --- Shapes ---

    def drawpoint(self):
        return [element("drawpoint", self.attributes(self.place()))]

    def drawpoints(self):
        return [element("drawpoints", {}, *(self.point() for _ in range(self.rng.randint(1, 6))))]

    def drawline(self):
        return [element("drawline", {}, self.point(), self.point())]

    def drawlines(self):
        return [element("drawlines", {}, *(self.point() for _ in range(self.rng.randint(2, 5))))]

    def drawlineto(self):
        return [element("setlinebegin", self.attributes(self.place()))] + [
            element("drawlineto", self.attributes(self.place())) for _ in range(self.rng.randint(1, 3))]

    def corners(self, count):
        """Points near each other, not in one plane."""
        at = self.place(0.2)
        reach = 5 * self.dp
        out = [[round(p + self.rng.uniform(-reach, reach), 3) for p in at] for _ in range(count)]
        if self.is_flat:
            for p in out:
                p[1] = self.low[1] + self.rng.choice((-0.2, 0.2))
        return out

    def of_points(self, tag, points):
        return [element(tag, {}, *(self.vector("point", p) for p in points))]

    def drawtriangle(self):
        return self.of_points("drawtriangle", self.corners(3))

    def drawquadri(self):
        if self.chance(0.4):
            return self.of_points("drawquadri", self.corners(4))
        return self.of_points("drawquadri", self.ring(4))

    def drawtrianglesstrip(self):
        return self.of_points("drawtrianglesstrip", self.corners(self.rng.randint(3, 6)))

    def drawtrianglesfan(self):
        return self.of_points("drawtrianglesfan", self.corners(self.rng.randint(3, 6)))

    def ring(self, count, radius=None, plane=None):
        """A convex polygon, counter-clockwise about z; in the plane z = const, or a tilted one."""
        radius = radius or self.length(3, 6)
        at, begin = self.place(0.25), self.rng.uniform(0, 6)
        slope = [0, 0] if plane == "level" or self.chance(0.5) else [self.rng.uniform(-0.6, 0.6) for _ in "xy"]
        out = []
        for i in range(count):
            angle = begin + 2 * math.pi * (i + self.rng.uniform(-0.2, 0.2)) / count
            x, y = radius * math.cos(angle), radius * math.sin(angle)
            out.append([round(v, 3) for v in (at[0] + x, at[1] + y, at[2] + slope[0] * x + slope[1] * y)])
        return out

    def drawpolygon(self):
        return self.of_points("drawpolygon", self.ring(self.rng.randint(3, 6)))

    def indexed(self, points, facets):
        # GenCase takes no expressions in these.
        return [element("points", {}, *(element("point", {n: digits(v) for n, v in zip(AXES, p)}) for p in points)),
                element("triangles", {}, *(element("triangle", dict(zip(AXES, f))) for f in facets))]

    def tetrahedron(self):
        at, size = self.place(0.3), [self.length(4, 8) for _ in AXES]
        if self.is_flat:
            at[1] -= size[1] / 4
        points = [at] + [[at[k] + (size[k] if k == axis else 0) for k in range(3)] for axis in range(3)]
        return self.indexed(points, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])

    def drawtriangles(self):
        count = self.rng.randint(3, 6)
        facets = [self.rng.sample(range(count), 3) for _ in range(self.rng.randint(1, 4))]
        return [element("drawtriangles", {}, *self.indexed(self.corners(count), facets))]

    def drawfigure(self):
        return [element("drawfigure", {}, *self.tetrahedron())]

    def mask(self, faces):
        if self.chance(0.6):
            return None
        if self.chance(0.3):
            return self.rng.randint(0, 2 ** faces - 1)
        return " | ".join(str(i) for i in sorted(self.rng.sample(range(1, faces + 1), self.rng.randint(1, faces - 1))))

    def drawpyramid(self):
        base = self.ring(self.rng.randint(3, 5), plane="level")
        height = self.length(4, 8)
        tip = [sum(p[k] for p in base) / len(base) for k in range(3)]
        tip = [round(v, 3) for v in (*tip[:2], tip[2] + height)]
        if self.chance(0.15):
            base.reverse()
        return [element("drawpyramid", {"mask": self.mask(len(base) + 1)},
                        *(self.vector("point", p) for p in [tip, *base]))]

    def prism_points(self):
        base = self.ring(self.rng.randint(3, 5))
        lift = [round(self.rng.uniform(-0.2, 0.2), 3), 0, self.length(3, 7)] if self.chance(0.4) else \
            [0, 0, self.length(3, 7)]
        if self.chance(0.15):
            base.reverse()
        return base + [[round(p + q, 3) for p, q in zip(b, lift)] for b in base]

    def drawprism(self):
        points = self.prism_points()
        return [element("drawprism", {"mask": self.mask(len(points) // 2 + 2)},
                        *(self.vector("point", p) for p in points))]

    def layers(self, share=0.3):
        if not self.chance(share):
            return []
        values = [str(self.rng.choice((-2, -1, 0, 1, 2, 0.5, 1.5, -1.5))) + self.rng.choice(("", "", "*"))
                  for _ in range(self.rng.randint(1, 3))]
        return [element("layers", {"vdp": ",".join(values)})]

    def drawbox(self):
        fill = self.rng.choice(("solid", "solid", "all", self.words(SIDES, 5)))
        return [element("drawbox", {}, element("boxfill", text=fill), *self.layers(), *self.box_place())]

    def drawbeach(self):
        y = round(self.rng.choice((-1, 1)) * self.length(3, 6), 3)
        ring = [[p[0], y, p[2]] for p in self.upright_ring(self.rng.randint(4, 6))]
        return [element("drawbeach", {"mask": self.mask(len(ring) + 2)}, *(self.vector("point", p) for p in ring))]

    def upright_ring(self, count):
        radius, at, begin = self.length(4, 7), self.place(0.25), self.rng.uniform(0, 6)
        turn = self.rng.choice((-1, 1))
        angles = [begin + turn * 2 * math.pi * i / count for i in range(count)]
        return [[round(at[0] + radius * math.cos(a), 3), at[1], round(at[2] + radius * math.sin(a), 3)]
                for a in angles]

    def drawextrude(self):
        line = self.upright_ring(self.rng.randint(3, 6))
        sweep = [0, self.length(3, 6), 0]
        if not self.is_flat and self.chance(0.3):
            sweep = [self.round(-0.2, 0.2), self.length(3, 6), self.round(-0.2, 0.2)]
        if self.is_flat:
            line = [[p[0], p[1] - sweep[1] / 2, p[2]] for p in line]
        return [element("drawextrude", {"closed": self.flag()}, *(self.vector("point", p) for p in line),
                        self.vector("extrude", sweep), *self.layers(0.4))]

    def drawsphere(self):
        return [element("drawsphere", {"radius": self.number(self.length(1, 6))}, self.point(0.1), *self.layers())]

    def drawellipsoid(self):
        a, apart = self.place(0.25), [self.rng.uniform(-2, 2) * self.dp for _ in AXES]
        if self.is_flat:
            apart[1] = 0
        radius = round(math.hypot(*apart) + self.length(2, 7), 3)
        return [element("drawellipsoid", {"radius": self.number(radius)}, self.vector("point", a),
                        self.vector("point", [round(p + q, 3) for p, q in zip(a, apart)]))]

    def drawcylinder(self):
        a, radius = self.place(0.2), self.length(1, 5)
        axis, length = self.rng.randrange(3), self.length(3, 8)
        if self.chance(0.25) and not self.is_flat:
            b = [round(p + self.rng.uniform(-0.5, 0.5), 3) for p in a]
        else:
            axis = 1 if self.is_flat else axis
            if self.is_flat:
                a[1] -= 0.2
            b = [p + (length if k == axis else 0) for k, p in enumerate(a)]
        return [element("drawcylinder", {"radius": self.number(radius), "mask": self.mask(3)},
                        self.vector("point", a), self.vector("point", b), *self.layers())]

    def drawwave(self):
        # GenCase takes no expressions in it.
        numbers = {"depth": self.length(2, 5), "hmaxwave": self.length(1, 3), "x0": self.along(0, 0.2),
                   "z0": self.along(2, 0.3)}
        at = [self.along(a, 0.05) for a in range(3)]
        size = [self.length(5, 12), self.length(4, 8), self.length(6, 12)]
        if self.is_flat:
            at[1], size[1] = round(self.low[1] - 3 * self.dp, 3), round(6 * self.dp, 3)
        return [element("drawwave", {n: digits(v) for n, v in numbers.items()},
                        *(element(tag, {n: digits(v) for n, v in zip(AXES, values)})
                          for tag, values in (("point", at), ("size", size))))]

    # --- Files ---

    def mesh(self):
        size = self.rng.uniform(4, 8) * self.dp
        shape = self.rng.choice(("box", "icosphere", "cylinder", "torus", "l_shape"))
        size = round(size, 3)
        if shape == "box":
            return make_meshes.box(size, round(size * 0.8, 3), round(size * 1.2, 3))
        if shape == "icosphere":
            return make_meshes.icosphere(size / 2, 1)
        if shape == "cylinder":
            return make_meshes.cylinder(size / 2, size, 12)
        if shape == "torus":
            return make_meshes.torus(size / 2, size / 5, 12, 8)
        return make_meshes.l_shape(size, size * 0.4, size * 0.6)

    def mesh_file(self, ending):
        name = f"mesh{len(self.files)}.{ending}"
        mesh = self.mesh()
        text = make_meshes.TEXT_FORMATS.get("." + ending)
        self.files[name] = text(mesh).encode() if text else stl_bytes(mesh)
        return name

    def placing(self, at=None):
        """The elements that put what a file holds in its place, in any order."""
        out = [self.vector("drawmove", at or self.place(0.3))]
        if self.chance(0.35):
            angles = [self.rng.choice((0, 0, 90, 45, 30, -20, round(self.rng.uniform(-180, 180), 1))) for _ in AXES]
            if self.is_flat:
                angles[0] = angles[2] = 0
            out.append(self.vector("drawrotate", angles, ("angx", "angy", "angz")))
        if self.chance(0.3):
            out.append(self.vector("drawscale", [round(self.rng.uniform(0.6, 1.4), 2) for _ in AXES]))
        if self.chance(0.2):
            out.append(self.vector("drawcenter", [self.round(-0.2, 0.2) for _ in AXES]))
        self.rng.shuffle(out)
        return out

    def from_mesh(self, tag, file, *more):
        filling, children = {}, list(more)
        if not self.is_free:
            way = self.rng.random()
            if way < 0.2:
                filling = {"autofill": "true"}
            elif way < 0.45 and not self.is_flat:
                filling = {"advanced": "true", "reverse": "true" if self.chance(0.2) else None,
                           "autofill": "true" if self.chance(0.1) else None}
                if self.chance(0.5):
                    lo = self.rng.uniform(0, 0.5) * self.dp
                    hi = lo + self.rng.uniform(1, 4) * self.dp
                    children.append(element("depth", {"depthmin": self.number(round(lo, 4)),
                                                      "depthmax": self.number(round(hi, 4)) if self.chance(0.6) else None}))
        if self.wants("clipdomain", 0.05):
            children.append(element("clipdomain", {"resize": digits(self.round(-0.2, 0.1)) if self.chance(0.7) else None}))
        return [element(tag, {"file": file, **filling}, *children, *self.placing())]

    def drawfilestl(self):
        return self.from_mesh("drawfilestl", self.mesh_file("stl"))

    def drawfileply(self):
        return self.from_mesh("drawfileply", self.mesh_file("ply"))

    def drawfilevtk(self):
        more = []
        if self.chance(0.2):
            kinds = ("points", "lines", "triangles", "quads", "otherpolys", "polygons")
            more.append(element("polyselec", text=self.words(kinds, 3)))
        return self.from_mesh("drawfilevtk", self.mesh_file(self.rng.choice(("vtk", "vtp", "vtu"))), *more)

    def drawfilevtm(self):
        parts = [self.mesh_file("vtp") for _ in range(self.rng.randint(1, 3))]
        name = f"parts{len(self.files)}.vtm"
        rows = "".join(f'<DataSet index="{i}" name="Part{i}" file="{file}"/>\n' for i, file in enumerate(parts))
        self.files[name] = ('<?xml version="1.0"?>\n<VTKFile type="vtkMultiBlockDataSet" version="1.0" '
                            'byte_order="LittleEndian">\n<vtkMultiBlockDataSet>\n<Block index="0" name="Parts">\n'
                            f'{rows}</Block>\n</vtkMultiBlockDataSet>\n</VTKFile>\n').encode()
        more = []
        if self.chance(0.5):
            i = self.rng.randrange(len(parts))
            which = {"index": i} if self.chance(0.5) else {"name": f"Part{i}"}
            mk = {"mkbound": self.rng.randint(1, 12)} if self.chance(0.4) else {}
            more.append(element("onlysurfaces", {**which, **mk}))
        return self.from_mesh("drawfilevtm", name, *more)

    def heights(self, nx, ny):
        spread = self.rng.uniform(0.5, 3) * self.dp
        return [[round(self.rng.uniform(0, spread), 3) for _ in range(nx)] for _ in range(ny)]

    def drawfilecsv(self):
        nx, ny, name = self.rng.randint(2, 5), self.rng.randint(2, 4), f"heights{len(self.files)}.csv"
        step = round(self.rng.uniform(2, 4) * self.dp, 3)
        rows = ["Y \\ X => Z;" + ";".join(digits(step * i) for i in range(nx))]
        rows += [digits(step * j) + ";" + ";".join(map(digits, row)) for j, row in enumerate(self.heights(nx, ny))]
        self.files[name] = ("\n".join(rows) + "\n").encode()
        at = [self.along(0, 0.1), self.along(1, 0.1), self.along(2, 0.4)]
        return [element("drawfilecsv", {"file": name, "mode": "bathymetry"}, *self.placing(at))]

    def drawbathymetry(self):
        nx, ny, name = self.rng.randint(3, 6), self.rng.randint(3, 5), f"heights{len(self.files)}.xyz"
        step, at = round(self.rng.uniform(1, 2.5) * self.dp, 3), [self.along(a, 0.1) for a in range(2)]
        base = self.along(2, 0.3)
        rows = [f"{digits(at[0] + step * i)} {digits(at[1] + step * j)} {digits(base + h)}"
                for j, row in enumerate(self.heights(nx, ny)) for i, h in enumerate(row)]
        self.files[name] = ("\n".join(rows) + "\n").encode()
        points = element("zpoints", {"file": name})
        if self.chance(0.3):
            points.append(self.vector("move", [0, 0, self.round(-0.1, 0.1)]))
        # GenCase v5.4 stops without a message where the grid does not reach beyond the points.
        room = round(self.rng.uniform(0.5, 2) * self.dp, 3)
        size = [step * (nx - 1) + 2 * room, step * (ny - 1) + 2 * room]
        grid = element("grid", {"dp": self.number(self.dp)},
                       element("initdomain", {}, self.vector("point", [p - room for p in at], "xy"),
                               self.vector("size", size, "xy")))
        way = self.rng.random()
        if way < 0.5:
            grid.append(element("expands", {}, *(element(
                side, {"size": self.number(self.length(1, 3)), "z": self.number(base) if self.chance(0.5) else None})
                for side in self.rng.sample(("xmin", "xmax", "ymin", "ymax"), 2))))
        elif way < 0.7:
            grid.append(element("periodicx" if self.chance(0.5) else "periodicy",
                                {"rampwidth": self.number(self.length(1, 2)), "flatwidth": self.number(self.dp)}))
        if self.chance(0.3):
            grid.append(self.vector("finalmove", [0, 0, self.round(-0.1, 0.1)]))
        return [element("drawbathymetry", {}, points, grid)]

    # --- Fills and redraws ---

    def modefill(self):
        words = self.rng.choice(("void", "void", "void | fluid", "fluid", "bound", "void | bound", "border | bound",
                                 "border | fluid | bound", "border | fluid"))
        return element("modefill", text=words)

    def narrowed(self):
        return {"mkfluid": self.rng.randint(0, 3) if self.chance(0.12) else None,
                "mkbound": self.rng.randint(0, 6) if self.chance(0.12) else None}

    def fillvoidpoint(self):
        return [element("fillvoidpoint", self.attributes(self.place(0.1)))]

    def fillpoint(self):
        return [element("fillpoint", {**self.attributes(self.place(0.1)), **self.narrowed()}, self.modefill())]

    def fillbox(self):
        at, size = self.place(0.1), [self.length(3, 9) for _ in AXES]
        if self.is_flat:
            at[1], size[1] = self.low[1] - 0.2, 0.4
        seed = [p + s / 2 for p, s in zip(at, size)]
        return [element("fillbox", {**self.attributes(seed), **self.narrowed()}, self.modefill(),
                        self.vector("point", at), self.vector("size", size))]

    def fillfigure(self):
        figure = self.tetrahedron()
        origin = figure[0][0]
        return [element("fillfigure", {**{n: "#" + origin.get(n).lstrip("#") + "+" + digits(self.dp) for n in AXES},
                                       **self.narrowed()}, *figure, self.modefill())]

    def fillprism(self):
        points = self.prism_points()
        seed = [sum(p[k] for p in points) / len(points) for k in range(3)]
        return [element("fillprism", {**self.attributes(seed), **self.narrowed()}, self.modefill(),
                        *(self.vector("point", p) for p in points))]

    def redraw(self):
        return [element("redraw", {} if self.chance(0.1) else {self.rng.choice(("mkfluid", "mkbound")): self.rng.randint(0, 6)})]

    def redrawbox(self):
        which = {self.rng.choice(("mkfluid", "mkbound")): self.rng.randint(0, 6)} if self.chance(0.8) else {}
        return [element("redrawbox", which, *self.box_place(4, is_shape=False))]

    def near(self, tag, *more):
        kinds = ("void", "fluid", "bound")
        attributes = {"targettp": self.rng.choice(kinds), "bordertp": self.rng.choice(kinds),
                      "times": self.rng.randint(1, 3) if self.chance(0.5) else None}
        for side in ("target", "border"):
            if attributes[side + "tp"] != "void" and self.chance(0.25):
                attributes[side + "mk"] = self.rng.randint(0, 5)
        children = [element("dirfilter", text=self.rng.choice(("all", self.words(SIDES, 4))))] if self.chance(0.5) else []
        return [element(tag, attributes, *children, *more)]

    def redrawnear(self):
        return self.near("redrawnear")

    def redrawnearbox(self):
        return self.near("redrawnearbox", *self.box_place(4, is_shape=False))

    # --- Settings ---

    def setdpctes(self):
        names = ("cteline", "ctetriangleweight", "ctetrianglelimits", "ctesphere", "cteellipsoid", "ctecylindertube",
                 "ctecylindercover")
        return [element("setdpctes", {n: digits(self.rng.uniform(0.4, 1.4)) for n in
                                      self.rng.sample(names, self.rng.randint(1, 3))})]

    def setboxlimitmode(self):
        return [element("setboxlimitmode", {"mode": self.rng.choice(("inner", "full"))})]

    def setmknextbound(self):
        return self.next_mk("bound")

    def setmknextfluid(self):
        return self.next_mk("fluid")

    def next_mk(self, kind):
        # There is none before the first.
        return [element("setmk" + kind, {"mk": self.rng.randint(1, 3)}),
                element("setmknext" + kind, {"next": self.flag()})]

    def setnormalinvert(self):
        return [element("setnormalinvert", {"invert": self.flag()})]

    def setshapemode(self):
        return [element("setshapemode", text=self.rng.choice(("actual | bound", "dp | all", "actual | fluid", "null")))]

    def setmkbackbound(self):
        return [element("setmkbackbound", {"mk": self.rng.randint(0, 12)})]

    def setmkbackfluid(self):
        return [element("setmkbackfluid", {"mk": self.rng.randint(0, 4)})]

    def setpattern(self):
        size = [self.rng.randint(1, 4) for _ in AXES]
        cells = "".join(self.rng.choice("XX-") for _ in range(math.prod(size)))
        name = f"pattern{len(self.patterns)}"
        pattern = element("pattern", {"name": name, "pattern": cells}, element("size", dict(zip(AXES, size))))
        scale = [self.rng.randint(1, 2) for _ in AXES]
        border = [self.rng.randint(0, 2) for _ in AXES]
        if self.chance(0.4):
            pattern.append(element("scale", dict(zip(AXES, scale))))
        else:
            scale = [1, 1, 1]
        if self.chance(0.3):
            pattern.append(element("border", dict(zip(AXES, border))))
        if self.chance(0.3):
            pattern.append(element("gap", {a: self.rng.randrange(s * k) for a, s, k in zip(AXES, size, scale)}))
        self.patterns.append(pattern)
        return [element("setpattern", {"name": name})]

    # --- Transforms and clips ---

    def move(self):
        by = [self.round(-0.3, 0.3) if self.step < 0.01 else self.rng.randint(-3, 3) * self.step for _ in AXES]
        return [element("move", self.attributes([by[0], 0 if self.is_flat else by[1], by[2]]))]

    def scale(self):
        by = [round(self.rng.uniform(0.7, 1.3), 2) for _ in AXES]
        return [element("scale", self.attributes([by[0], 1 if self.is_flat else by[1], by[2]]))]

    def rotate(self):
        axis = self.rng.choice(((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 3), (0.5, -0.3, 0.7)))
        axis = (0, 1, 0) if self.is_flat else axis
        return [element("rotate", {"ang": self.number(self.angle()), **self.attributes(axis)})]

    def angle(self):
        return self.rng.choice((90, 45, 30, -60, 180, round(self.rng.uniform(-180, 180), 1)))

    def rotateline(self):
        a = self.place(0.3)
        b = [a[0], a[1] + 0.5, a[2]] if self.is_flat else self.place(0.3)
        return [element("rotateline", {"ang": self.number(self.angle())}, self.vector("point", a),
                        self.vector("point", b))]

    def rotateadv(self):
        axes = "YYY" if self.is_flat else self.rng.choice(("XYZ", "ZYZ", "ZXY", "YXZ", "XYX"))
        centre = [self.vector("center", self.place(0.3))] if self.chance(0.6) else []
        return [element("rotateadv", {"ang1": self.number(self.angle()), "ang2": self.number(0 if self.is_flat else self.angle()),
                                      "ang3": self.number(0 if self.is_flat else self.angle()), "axes": axes, "intrinsic": self.flag()},
                        *centre)]

    def clipplane(self):
        if self.chance(0.6):
            vector = self.rng.choice(((1, 0, 0), (0, 0, -1), (0.5, 0, 1), (0.3, 0.4, 0.5), (-1, 2, 0.5)))
            return [element("clipplane", {}, self.point(0.3), self.vector("vector", vector))]
        points = [self.place(0.2) for _ in range(3)]
        return [element("clipplane", {}, *(self.vector(f"point{i + 1}", p) for i, p in enumerate(points)))]

    def clipbox(self):
        faces = [element("boxfaces", text=self.words(SIDES, 5))] if self.chance(0.3) else []
        angles = [self.vector("angles", [self.rng.choice((0, 30, -45, 70)) for _ in AXES])] if self.chance(0.2) else []
        return [element("clipbox", {}, *faces, *self.box_place(5, is_shape=False), *angles)]

    def clipdomain(self):
        return [element("clipdomain", {"resize": digits(self.round(-0.3, 0.1)) if self.chance(0.6) else None})]

    def output(self, name):
        file = f"out{self.rng.randint(0, 99)}"
        if name == "shapeout":
            return element("shapeout", {"file": file, "reset": self.rng.choice((None, "false"))})
        if name == "cellsout":
            return element("cellsout", {"file": file})
        if name == "pointsmkout":
            return element("pointsmkout", {"file": file})
        if name == "printf":
            return element("printf", {"text": "Dp is [Dp]"})
        return element("debugout")

    # --- Putting together ---

    def set_mk(self):
        kind = self.rng.random()
        if kind < 0.6:
            mk = self.rng.randint(0, 8)
            self.bound_mks.add(mk)
            return element("setmkbound", {"mk": mk})
        return element("setmkfluid", {"mk": self.rng.randint(0, 4)}) if kind < 0.92 else element("setmkvoid")

    def settings(self, names):
        """A few settings; plain words need no method."""
        out = []
        for _ in range(self.rng.choice((0, 0, 0, 1, 1, 2)) if not self.only else 1):
            if names:
                name = self.rng.choices(names, [0.15 if n == "resetdraw" else 1 for n in names])[0]
                make = getattr(self, name, None)
                out += make() if make else [element(name)]
                if name == "resetdraw":
                    out += [self.draw_mode(), self.set_mk()]
        return out

    def draw_mode(self):
        return element("setdrawmode", {"mode": self.rng.choice(("full", "full", "solid", "face"))})

    def draw(self, exclude=()):
        draws, others = self.some_of(DRAWS), self.some_of(FILLS + REDRAWS)
        if self.only and not draws:
            draws = ["drawbox", "drawsphere", "drawcylinder", "drawprism", "drawtriangle", "drawline", "drawfilestl"]
        kinds = [k for k in (POINT_DRAWS, FACE_DRAWS, BODY_DRAWS, BODY_DRAWS, FILE_DRAWS)]
        pools = [[n for n in kind if n in draws and n not in exclude] for kind in kinds]
        pools = [p for p in pools if p]
        # What needs something to act on comes after draws.
        if others and self.has_drawn and self.chance(0.25 if not self.only else 0.6):
            return getattr(self, self.rng.choice(others))()
        self.has_drawn = True
        return getattr(self, self.rng.choice(self.rng.choice(pools)))() if pools else self.drawbox()

    def group(self):
        """Settings, an mk, and a draw that may be moved, clipped or saved round."""
        out = self.settings(self.some_of(SETTINGS))
        if self.chance(0.4):
            out.append(self.draw_mode())
        out.append(self.set_mk())
        switches = self.some_of(SWITCHES)
        switch = self.rng.choice(switches) if switches and self.chance(0.15 if not self.only else 0.8) else None
        outputs = self.some_of(OUTPUTS)
        exclude = ()
        if switch == "wire":
            exclude = NOT_WIRE
        elif switch == "setfrdrawmode":
            self.is_free, exclude = True, NOT_FREE
        elif switch == "setmknextauto":
            out[-1] = element("setmkbound", {"mk": self.rng.randint(0, 8)})
        transforms = self.some_of(TRANSFORMS)
        is_turned = bool(transforms) and self.chance(0.3 if not self.only else 0.8)
        body = self.draw(exclude)
        if self.is_free and self.chance(0.4):
            body += self.draw(exclude)
        self.is_free = False
        if switch == "wire":
            body = [element("setdrawmode", {"mode": "wire"}), *body, self.draw_mode()]
        elif switch in ("setfrdrawmode", "setmknextauto"):
            body = [element(switch, {"auto": "true"}), *body, element(switch, {"auto": "false"})]
        elif switch == "setactive":
            body = [element(switch, {"drawpoints": self.flag()}), *body, element(switch, {"drawpoints": "true"})]
        clips = self.some_of(CLIPS)
        if clips and self.chance(0.12 if not self.only else 0.8):
            body = getattr(self, self.rng.choice(clips))() + body + [element("clipreset")]
        if is_turned:
            turned = [e for _ in range(self.rng.randint(1, 2)) for e in getattr(self, self.rng.choice(transforms))()]
            save = self.rng.choice(("matrixsave", "matrixsave", "statesave"))
            body = [element(save), *turned, *body, element(SAVES[save])]
        saves = self.some_of(SAVES)
        if saves and self.chance(0.12):
            save = self.rng.choice(saves)
            body = [element(save), *self.settings(self.some_of(SETTINGS[:-1])), self.set_mk(), *body, element(SAVES[save])]
        if outputs and self.chance(0.08 if not self.only else 0.6):
            body.append(self.output(self.rng.choice(outputs)))
        out += body
        if self.wants("list", 0.06):
            name = f"List{len(self.lists)}"
            self.lists.append(element("list", {"name": name, "printcall": self.rng.choice((None, "false"))}, *out))
            return [element("runlist", {"name": name, "times": self.rng.choice((None, 1, 2))})]
        return out

    def constants(self):
        rows = [element("gravity", {"x": 0, "y": 0, "z": digits(self.rng.choice((-9.81, -9.81, -1.62)))}),
                element("rhop0", {"value": 1000}), element("rhopgradient", {"value": self.rng.choice((1, 2, 2, 3))}),
                element("hswl", {"value": 0, "auto": "true"}), element("gamma", {"value": 7}),
                element("speedsystem", {"value": 0, "auto": "true"}), element("coefsound", {"value": 20}),
                element("speedsound", {"value": 0, "auto": "true"}),
                element(self.rng.choice(("coefh", "coefh", "hdp")), {"value": digits(self.round(1, 1.8))}),
                element("cflnumber", {"value": 0.2})]
        out = element("constantsdef", {}, *rows)
        if self.wants("constants", 0.15):
            rows[1].set("value", digits(self.round(800, 1200)))
            for name, value in self.rng.sample((("hswl", 0.6), ("speedsystem", 3.5), ("speedsound", 40)), 1):
                row = out.find(name)
                row.set("value", str(value))
                row.set("auto", "false")
        if self.wants("lattice", 0.07):
            out.insert(0, element("lattice", {"bound": self.rng.randint(1, 2), "fluid": self.rng.randint(1, 2)}))
        return out

    def numbering(self):
        out = element("mkconfig", {"boundcount": 240, "fluidcount": self.rng.choice((9, 9, 6))})
        for kind in ("bound", "fluid"):
            if self.wants("mkorient", 0.06):
                axes = "".join(self.rng.choice((a, a.upper())) for a in self.rng.sample(AXES, 3))
                out.append(element("mkorient" + kind, {"mk": self.rng.randint(0, 3), "orient": axes}))
        return out

    def case(self):
        self.has_drawn = False
        geometry = element("geometry")
        if self.wants("variables", 0.15):
            self.variables = {name: self.round(-1, 1) for name in ("Alpha", "Beta")}
            geometry.append(element("predefinition", {}, element("newvarcte", {"Alpha": digits(self.variables["Alpha"])}),
                                    element("newvar", {"Beta": digits(self.variables["Beta"])})))
        definition = element("definition", {"dp": digits(self.dp)})
        if self.wants("pointref", 0.2):
            definition.append(element("pointref", {a: digits(self.round(-0.2, 0.2)) for a in AXES}))
            if self.is_flat:
                definition[0].set("y", digits(self.low[1]))
        definition.append(element("pointmin", {a: digits(v) for a, v in zip(AXES, self.low)}))
        definition.append(element("pointmax", {a: digits(v) for a, v in zip(AXES, self.high)}))
        geometry.append(definition)
        main = element("mainlist", {}, self.draw_mode())
        for _ in range(self.rng.randint(1, 5)):
            main.extend(self.group())
        geometry.append(element("commands", {}, *self.lists, main))
        casedef = element("casedef", {}, self.constants(), self.numbering())
        if self.patterns:
            casedef.append(element("patterns", {}, *self.patterns))
        casedef.append(geometry)
        mks = sorted(self.bound_mks)
        if mks and self.wants("floatings", 0.08):
            casedef.append(element("floatings", {}, element("floating", {"mkbound": mks[0]}, element("massbody", {"value": 3}))))
            mks = mks[1:]
        if mks and self.wants("motion", 0.08):
            casedef.append(element("motion", {}, element("objreal", {"ref": mks[-1]}, element(
                "begin", {"mov": 1, "start": 0}), element("wait", {"id": 1, "duration": 1}))))
        root = element("case", {}, casedef, element("execution", {}, element("parameters")))
        return Case(root, dict(self.files))


def random_case(seed, index, only=()):
    """Case `index` of `seed`; of the commands named in `only` and what they need, where any is named."""
    return Grammar(seed, index, only).case()


def used_commands(root):
    """Names, as in COMMANDS, of what a case uses."""
    found = {e.tag for e in root.iter()}
    names = {n for n in COMMANDS if n in found}
    if "drawlineto" in found:
        names.add("drawlineto")
    definition = root.find(".//definition")
    if definition.find("pointmin").get("y") == definition.find("pointmax").get("y"):
        names.add("2d")
    if any(e.get("mode") == "wire" for e in root.iter("setdrawmode")):
        names.add("wire")
    if any(e.tag.startswith("mkorient") for e in root.iter()):
        names.add("mkorient")
    if root.find(".//predefinition") is not None:
        names.add("variables")
    constants = root.find(".//constantsdef")
    if any(e.get("auto") == "false" for e in constants if e.tag != "lattice"):
        names.add("constants")
    return names
