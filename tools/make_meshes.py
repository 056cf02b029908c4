#!/usr/bin/python3
"""Makes closed triangle meshes of parametric bodies, as binary STL, PLY, OBJ, OFF or VTK.

    make_meshes.py SHAPE FILE.stl [name=value ...]   one mesh; angles in degrees
    make_meshes.py --all DIR                         every shape with its default parameters
    make_meshes.py --cases DIR                       the meshes that the cases in DIR read
    make_meshes.py --templates DIR                   the meshes that the case templates read
    make_meshes.py --list                            shapes, their parameters and defaults

Every mesh is checked before it is written: each edge has exactly two facets that run along it in
opposite directions, no facet is degenerate, and the signed volume is positive (normals point
outwards). The same parameters give the same bytes. Needs the Python standard library only.
"""

import inspect
import math
import os
import struct
import sys


class Mesh:
    """Vertices shared by index; facets counter-clockwise seen from outside."""

    def __init__(self):
        self.vertices = []
        self.facets = []
        self._index = {}

    def vertex(self, x, y, z):
        """The index of a point; points that are equal as float32 are one vertex."""
        point = struct.unpack("<3f", struct.pack("<3f", x, y, z))
        point = tuple(0.0 if c == 0 else c for c in point)
        if point not in self._index:
            self._index[point] = len(self.vertices)
            self.vertices.append(point)
        return self._index[point]

    def triangle(self, a, b, c):
        """Adds a facet; one with two equal corners has no area and is left out."""
        if a != b and b != c and c != a:
            self.facets.append((a, b, c))

    def quad(self, a, b, c, d):
        self.triangle(a, b, c)
        self.triangle(a, c, d)

    def add(self, other, flip=False):
        """Adds another mesh, inside out where `flip` is set (a cavity)."""
        for facet in other.facets:
            a, b, c = (self.vertex(*other.vertices[i]) for i in facet)
            self.triangle(a, c, b) if flip else self.triangle(a, b, c)

    def moved(self, dx, dy, dz):
        out = Mesh()
        for facet in self.facets:
            corners = (self.vertices[i] for i in facet)
            out.triangle(*(out.vertex(x + dx, y + dy, z + dz) for x, y, z in corners))
        return out

    def volume(self):
        """Signed volume: positive when the normals point outwards."""
        total = 0.0
        for a, b, c in self.facets:
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (self.vertices[i] for i in (a, b, c))
            total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        return total / 6

    def check(self, name):
        """Raises ValueError unless the mesh is closed, consistently turned and outward."""
        edges = {}
        for a, b, c in self.facets:
            for edge in ((a, b), (b, c), (c, a)):
                edges[edge] = edges.get(edge, 0) + 1
        for (a, b), count in edges.items():
            if count != 1 or edges.get((b, a), 0) != 1:
                raise ValueError(f"{name}: the edge {self.vertices[a]} - {self.vertices[b]} is not "
                                 "shared by exactly two facets in opposite directions")
        for a, b, c in self.facets:
            if not any(normal(*(self.vertices[i] for i in (a, b, c)))):
                raise ValueError(f"{name}: a facet at {self.vertices[a]} has no area")
        if not self.volume() > 0:
            raise ValueError(f"{name}: volume {self.volume()}, normals point inwards")


def normal(a, b, c):
    """Unit normal of a triangle, or zeros."""
    u = [b[i] - a[i] for i in range(3)]
    v = [c[i] - a[i] for i in range(3)]
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(k * k for k in n))
    return [k / length for k in n] if length > 0 else [0.0, 0.0, 0.0]


def stl_bytes(mesh, name):
    """Binary STL: 80 bytes of name, the number of facets, 50 bytes a facet. Open meshes are taken as they are."""
    data = bytearray(f"fppg {name}".encode().ljust(80)[:80])
    data += struct.pack("<I", len(mesh.facets))
    for facet in mesh.facets:
        corners = [mesh.vertices[i] for i in facet]
        data += struct.pack("<12fH", *normal(*corners), *corners[0], *corners[1], *corners[2], 0)
    return bytes(data)


def write_stl(mesh, path, name):
    mesh.check(name)
    with open(path, "wb") as file:
        file.write(stl_bytes(mesh, name))
    print(f"{path}: {len(mesh.facets)} facets, volume {mesh.volume():.6g}")


def text_rows(mesh):
    """Vertices and facets as lines of text."""
    points = [" ".join(f"{c:.9g}" for c in p) for p in mesh.vertices]
    return points, [" ".join(str(i) for i in f) for f in mesh.facets]


def ply_text(mesh):
    points, facets = text_rows(mesh)
    return "\n".join(["ply", "format ascii 1.0", f"element vertex {len(points)}"]
                     + [f"property float {axis}" for axis in "xyz"]
                     + [f"element face {len(facets)}", "property list uchar int vertex_indices",
                        "end_header"] + points + ["3 " + f for f in facets]) + "\n"


def vtk_text(mesh):
    points, facets = text_rows(mesh)
    return "\n".join(["# vtk DataFile Version 3.0", "fppg", "ASCII", "DATASET POLYDATA",
                      f"POINTS {len(points)} float"] + points
                     + [f"POLYGONS {len(facets)} {4 * len(facets)}"]
                     + ["3 " + f for f in facets]) + "\n"


def xml_array(name, numbers, kind, more=""):
    return f'<DataArray type="{kind}" Name="{name}"{more} format="ascii">\n{numbers}\n</DataArray>\n'


def vtk_xml_text(mesh, is_polydata):
    """A .vtp or a .vtu of triangles; GenCase v5.4 wants PointData and CellData, empty or not."""
    points, facets = text_rows(mesh)
    corners = xml_array("connectivity", " ".join(facets), "Int64")
    corners += xml_array("offsets", " ".join(str(3 * i + 3) for i in range(len(facets))), "Int64")
    kind = "PolyData" if is_polydata else "UnstructuredGrid"
    if is_polydata:
        empty = xml_array("connectivity", "", "Int64") + xml_array("offsets", "", "Int64")
        count = f'NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{len(facets)}"'
        cells = "".join(f"<{part}>\n{empty}</{part}>\n" for part in ("Verts", "Lines", "Strips"))
        cells += f"<Polys>\n{corners}</Polys>\n"
    else:
        count = f'NumberOfCells="{len(facets)}"'
        cells = "<Cells>\n" + corners
        cells += xml_array("types", " ".join("5" for _ in facets), "UInt8") + "</Cells>\n"
    return (f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" '
            f'header_type="UInt64">\n<{kind}>\n<Piece NumberOfPoints="{len(points)}" {count}>\n'
            "<PointData>\n</PointData>\n<CellData>\n</CellData>\n<Points>\n"
            + xml_array("Points", " ".join(points), "Float32", ' NumberOfComponents="3"')
            + f"</Points>\n{cells}</Piece>\n</{kind}>\n</VTKFile>\n")


def obj_text(mesh):
    points, _ = text_rows(mesh)
    return "\n".join(["v " + p for p in points]
                     + ["f " + " ".join(str(i + 1) for i in f) for f in mesh.facets]) + "\n"


def off_text(mesh):
    points, facets = text_rows(mesh)
    return "\n".join(["OFF", f"{len(points)} {len(facets)} 0"] + points
                     + ["3 " + f for f in facets]) + "\n"


TEXT_FORMATS = {".ply": ply_text, ".obj": obj_text, ".off": off_text, ".vtk": vtk_text,
                ".vtp": lambda mesh: vtk_xml_text(mesh, True),
                ".vtu": lambda mesh: vtk_xml_text(mesh, False)}


def write_mesh(mesh, path, name):
    """Binary STL, or text in the format that the file's ending names."""
    ending = os.path.splitext(path)[1]
    if ending not in TEXT_FORMATS:
        write_stl(mesh, path, name)
        return
    mesh.check(name)
    with open(path, "w", encoding="ascii") as file:
        file.write(TEXT_FORMATS[ending](mesh))
    print(f"{path}: {len(mesh.facets)} facets, volume {mesh.volume():.6g}")


# --- Ways to make a surface ---


def turn(count):
    """cos and sin of `count` equal steps round the circle."""
    return [(math.cos(2 * math.pi * i / count), math.sin(2 * math.pi * i / count))
            for i in range(count)]


def triangulate(polygon):
    """Ear clipping of a polygon (x, y), counter-clockwise; concave is allowed.

    It is simple, but for cuts to holes, along which it runs twice.
    """

    def area(o, a, b):
        return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])

    left = list(range(len(polygon)))
    triangles = []
    while len(left) > 3:
        best = None
        for k, b in enumerate(left):
            a, c = left[k - 1], left[(k + 1) % len(left)]
            pa, pb, pc = polygon[a], polygon[b], polygon[c]
            if area(pa, pb, pc) <= 0:
                continue
            if any(area(pa, pb, q) >= 0 and area(pb, pc, q) >= 0 and area(pc, pa, q) >= 0
                   for q in (polygon[i] for i in left) if q not in (pa, pb, pc)):
                continue
            length = math.dist(pa, pc)
            if best is None or length < best[0]:
                best = (length, k, (a, b, c))
        if best is None:
            raise ValueError("the polygon crosses itself or runs clockwise")
        triangles.append(best[2])
        del left[best[1]]
    return triangles + [tuple(left)]


def loft(loops):
    """Walls between consecutive loops of (x, y, z) with equal numbers of points, caps at both ends.

    The loops run counter-clockwise seen against the direction in which they follow one another;
    the first and last are flat in z. Points that two loops share make no wall.
    """
    mesh = Mesh()
    rows = [[mesh.vertex(*p) for p in loop] for loop in loops]
    for low, high in zip(rows, rows[1:]):
        for i in range(len(low)):
            k = (i + 1) % len(low)
            mesh.quad(low[i], low[k], high[k], high[i])
    for row, loop, up in ((rows[0], loops[0], False), (rows[-1], loops[-1], True)):
        for a, b, c in triangulate([p[:2] for p in loop]):
            mesh.triangle(*((row[a], row[b], row[c]) if up else (row[a], row[c], row[b])))
    return mesh


def extrude(polygon, z0, z1):
    """A prism over a polygon (x, y), counter-clockwise."""
    return loft([[(x, y, z) for x, y in polygon] for z in (z0, z1)])


def extrude_ring(outer, inner, z0, z1):
    """A prism between two polygons with equal numbers of points, both counter-clockwise."""
    mesh = Mesh()
    count = len(outer)
    o0, o1, i0, i1 = ([mesh.vertex(x, y, z) for x, y in ring]
                      for ring, z in ((outer, z0), (outer, z1), (inner, z0), (inner, z1)))
    for i in range(count):
        k = (i + 1) % count
        mesh.quad(o0[i], o0[k], o1[k], o1[i])
        mesh.quad(i0[i], i1[i], i1[k], i0[k])
        mesh.quad(o1[i], o1[k], i1[k], i1[i])
        mesh.quad(o0[i], i0[i], i0[k], o0[k])
    return mesh


def prism_about_axis(polygon, z0, z1):
    """A prism over a polygon that is seen whole from the origin; its caps are fans."""
    mesh = Mesh()
    low, high = ([mesh.vertex(x, y, z) for x, y in polygon] for z in (z0, z1))
    low_centre, high_centre = mesh.vertex(0, 0, z0), mesh.vertex(0, 0, z1)
    for i in range(len(polygon)):
        k = (i + 1) % len(polygon)
        mesh.quad(low[i], low[k], high[k], high[i])
        mesh.triangle(low_centre, low[k], low[i])
        mesh.triangle(high_centre, high[i], high[k])
    return mesh


def revolve(profile, sides, closed):
    """Turns a profile of (r, z) about z, the solid on its left.

    profile  either a closed curve away from the axis, or an open one that starts and ends on it
    """
    mesh = Mesh()
    rows = [[mesh.vertex(r * c, r * s, z) for c, s in turn(sides)] for r, z in profile]
    pairs = list(zip(rows, rows[1:])) + ([(rows[-1], rows[0])] if closed else [])
    for low, high in pairs:
        for i in range(sides):
            k = (i + 1) % sides
            mesh.quad(low[i], low[k], high[k], high[i])
    return mesh


# --- The bodies ---


def box(x=1.0, y=1.0, z=1.0):
    """A box of the given sides, centred at the origin."""
    return extrude([(-x / 2, -y / 2), (x / 2, -y / 2), (x / 2, y / 2), (-x / 2, y / 2)],
                   -z / 2, z / 2)


def icosphere(radius=0.5, subdivisions=3):
    """A sphere: an icosahedron whose facets are cut in four `subdivisions` times."""
    g = (1 + math.sqrt(5)) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g),
              (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    facets = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
              (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
              (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(subdivisions):
        middle = {}

        def half(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(points)
                points.append(tuple((points[a][i] + points[b][i]) / 2 for i in range(3)))
            return middle[key]

        finer = []
        for a, b, c in facets:
            ab, bc, ca = half(a, b), half(b, c), half(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        facets = finer
    mesh = Mesh()
    rows = [mesh.vertex(*(radius * c / math.hypot(*p) for c in p)) for p in points]
    for a, b, c in facets:
        mesh.triangle(rows[a], rows[b], rows[c])
    return mesh


def cylinder(radius=0.5, height=1.0, sides=48):
    """A cylinder about z, centred at the origin."""
    return extrude([(radius * c, radius * s) for c, s in turn(sides)], -height / 2, height / 2)


def torus(ring_radius=0.5, tube_radius=0.2, sides=48, tube_sides=24):
    """A torus about z."""
    profile = [(ring_radius + tube_radius * c, tube_radius * s) for c, s in turn(tube_sides)]
    return revolve(profile, sides, closed=True)


def l_shape(length=1.0, thickness=0.4, depth=0.5):
    """Two legs of `length` at a right angle, their outer corner at the origin."""
    a, t = length, thickness
    return extrude([(0, 0), (a, 0), (a, t), (t, t), (t, a), (0, a)], 0, depth)


def gear_outline(module, teeth, pressure_angle, backlash=0.0, turned=0.0):
    """Outline of a spur gear with involute flanks, counter-clockwise; its polar angle only grows."""
    pitch = module * teeth / 2
    tip, root = pitch + module, pitch - 1.25 * module
    base = pitch * math.cos(math.radians(pressure_angle))

    def involute(radius):
        ratio = math.acos(min(1.0, base / radius))
        return math.tan(ratio) - ratio

    half_tooth = math.pi / (2 * teeth) + involute(pitch) - backlash / (4 * pitch)
    start = max(base, root)
    half_root = half_tooth - involute(start)
    # Below the base circle there is no involute; the flank leans out a little instead.
    foot = half_root + 0.2 * (math.pi / teeth - half_root)
    steps = 5
    radii = [start + (tip - start) * i / steps for i in range(steps + 1)]
    flank = [(root, foot)] + [(r, half_tooth - involute(r)) for r in radii]
    outline = []
    for tooth in range(teeth):
        axis = 2 * math.pi * tooth / teeth + math.radians(turned)
        polar = [(r, axis - a) for r, a in flank] + [(r, axis + a) for r, a in reversed(flank)]
        outline += [(r * math.cos(a), r * math.sin(a)) for r, a in polar]
    return outline


def gear(module=0.1, teeth=18, width=0.3, bore=0.4, pressure_angle=20.0, backlash=0.0, turned=0.0):
    """A spur gear about z with involute teeth; `bore` is a diameter, 0 for a full gear.

    backlash  play between the flanks of two such gears, half of it taken off the teeth of each
    turned    angle of the first tooth from x; half a pitch puts a gap there
    """
    outline = gear_outline(module, teeth, pressure_angle, backlash, turned)
    if bore == 0:
        return prism_about_axis(outline, -width / 2, width / 2)
    inner = [(bore / 2 * x / math.hypot(x, y), bore / 2 * y / math.hypot(x, y)) for x, y in outline]
    return extrude_ring(outline, inner, -width / 2, width / 2)


def wheel(radius=0.32, width=0.22, shoulder=0.03, hub_radius=0.12, hub_depth=0.04, sides=48):
    """A full wheel about y with rounded shoulders and a hub set back on both sides."""
    w, s = width / 2, shoulder
    corner = [(radius - s + s * math.sin(a), s - s * math.cos(a))
              for a in (math.radians(30 * i) for i in range(4))]
    half = [(0, -w + hub_depth), (hub_radius, -w + hub_depth), (hub_radius + hub_depth, -w)]
    half += [(r, -w + d) for r, d in corner]
    profile = half + [(r, -z) for r, z in reversed(half)]
    return about_y(revolve(profile, sides, closed=False))


def about_y(mesh):
    """Lays a body that stands about z along y, by a turn of 90 degrees about x."""
    out = Mesh()
    for facet in mesh.facets:
        out.triangle(*(out.vertex(x, -z, y) for x, y, z in (mesh.vertices[i] for i in facet)))
    return out


def tyre(radius=0.32, width=0.22, rim_radius=0.2, tread_depth=0.01, blocks=24):
    """A tyre about y: a ring whose tread is cut by cross grooves and one groove round the middle.

    blocks  tread blocks round the circumference; a quarter of each is groove
    """
    w, t, base = width / 2, tread_depth, radius - tread_depth
    # (r, z, has tread): the hole, the side wall, the tread with its middle groove, the other side.
    half = [(rim_radius, -0.7 * w, False), (base - 0.15 * radius, -w, False),
            (base - 0.03 * radius, -0.95 * w, False), (base, -0.85 * w, False),
            (base, -0.84 * w, True), (base, -0.11 * w, True), (base, -0.1 * w, False)]
    profile = half + [(r, -z, has_tread) for r, z, has_tread in reversed(half)]
    angles = []
    for block in range(blocks):
        for part, raised in ((0.0, True), (0.37, True), (0.74, True), (0.76, False),
                             (0.98, False)):
            angles.append((2 * math.pi * (block + part) / blocks, raised))
    mesh = Mesh()
    rows = [[mesh.vertex(*((r + (t if has_tread and raised else 0)) * f(a)
                           for f in (math.cos, math.sin)), z)
             for a, raised in angles] for r, z, has_tread in profile]
    for low, high in zip(rows, rows[1:] + rows[:1]):
        for i in range(len(angles)):
            k = (i + 1) % len(angles)
            mesh.quad(low[i], low[k], high[k], high[i])
    return about_y(mesh)


def vehicle_body(length=4.2, width=1.8, height=1.45, clearance=0.25, wheelbase=2.6,
                 axle_height=0.32, arch_radius=0.42, arch_depth=0.36):
    """A closed car body along x, its front at the larger x, four wheel arches cut into its sides.

    The ground is z = 0 and the middle of the wheelbase x = 0. clearance is the height of the floor
    above the ground, arch_depth how far an arch reaches in from the side.
    """
    spread = math.acos((clearance - axle_height) / arch_radius)  # from the top of an arch to the floor
    low, back, front = clearance, -length / 2, length / 2
    arch, flat = [], []
    for centre in (-wheelbase / 2, wheelbase / 2):
        for i in range(15):
            a = -spread + 2 * spread * i / 14
            x = centre + arch_radius * math.sin(a)
            arch.append((x, axle_height + arch_radius * math.cos(a) if 0 < i < 14 else low))
            flat.append((x, low))
    roof = [(front - 0.15, low), (front, low + 0.25), (front - 0.05, low + 0.45),
            (front - 1.05, 0.66 * height), (front - 1.75, height), (back + 0.75, height),
            (back + 0.1, 0.7 * height), (back, low + 0.3), (back + 0.12, low)]
    w, d = width / 2, arch_depth

    def loop(bottom, y):
        return [(x, z, y) for x, z in bottom + roof]

    solid = loft([loop(arch, -w), loop(arch, -w + d), loop(flat, -w + d), loop(flat, w - d),
                  loop(arch, w - d), loop(arch, w)])
    # Lofted along z; a turn of 90 degrees about x lays that direction along -y.
    return about_y(solid)


def stadium(radius_a, radius_b, distance, sides):
    """Convex hull of two circles at x = 0 and x = distance, counter-clockwise, 2 `sides` points."""
    lean = math.acos((radius_a - radius_b) / distance)
    points = []
    for centre, radius, begin, end in ((distance, radius_b, -lean, lean),
                                       (0, radius_a, lean, 2 * math.pi - lean)):
        for i in range(sides):
            a = begin + (end - begin) * i / (sides - 1)
            points.append((centre + radius * math.cos(a), radius * math.sin(a)))
    return points


def housing(radius_a=0.6, radius_b=0.45, distance=0.9, height=0.5, wall=0.06, lid=1, sides=32):
    """A gearbox housing round two parallel shafts along z, `distance` apart, hollow inside.

    radius_a, radius_b  inner radii round the two shafts
    lid                 1: closed, its cavity a second surface; 0: open at the top
    """
    inner = stadium(radius_a, radius_b, distance, sides)
    outer = stadium(radius_a + wall, radius_b + wall, distance, sides)
    if lid:
        mesh = extrude(outer, -wall, height + wall)
        mesh.add(extrude(inner, 0, height), flip=True)
        return mesh

    def level(ring, z):
        return [(x, y, z) for x, y in ring]

    return loft([level(outer, -wall), level(outer, height), level(inner, height), level(inner, 0)])


def ring_on(mesh, outline, holes, z, up):
    """A flat face at height z between an outline and holes in it; all counter-clockwise.

    Each hole is joined to the outline by a cut to its nearest corner.
    """
    boundary = list(outline)
    for hole in holes:
        i, k = min(((i, k) for i in range(len(boundary)) for k in range(len(hole))),
                   key=lambda pair: math.dist(boundary[pair[0]], hole[pair[1]]))
        backwards = [hole[(k - n) % len(hole)] for n in range(len(hole) + 1)]
        boundary[i:i] = [boundary[i]] + backwards
    rows = [mesh.vertex(x, y, z) for x, y in boundary]
    for a, b, c in triangulate(boundary):
        mesh.triangle(*((rows[a], rows[b], rows[c]) if up else (rows[a], rows[c], rows[b])))


def walls_along(mesh, outline, z0, z1, closed=True, flip=False):
    """Walls over a line of (x, y), looking to its right; `flip`: to its left."""
    low, high = ([mesh.vertex(x, y, z) for x, y in outline] for z in (z0, z1))
    for i in range(len(outline) if closed else len(outline) - 1):
        k = (i + 1) % len(outline)
        if flip:
            mesh.quad(low[i], high[i], high[k], low[k])
        else:
            mesh.quad(low[i], low[k], high[k], high[i])


def gearbox_case(radius_a=38.0, radius_b=53.0, distance=75.0, width=34.0, wall=6.0, height=62.0,
                 bore_a=22.0, bore_b=28.0, sides=24):
    """A trough round two parallel shafts along z, open at y = `height`, with bores for bearings.

    radius_a, radius_b  inner radii round the shafts, which stand at x = 0 and x = distance, y = 0
    width               between the two walls with the bores, which are at z = -width/2 and width/2
    bore_a, bore_b      diameters of the bores
    """

    def trough(a, b):
        """From the top of the far side down, round below and up, and its two upper corners."""
        lean = math.acos((a - b) / distance)
        # The common tangent below touches both circles at the same angle from x.
        right = [(distance + b * math.cos(t), b * math.sin(t))
                 for t in (-lean + lean * i / sides for i in range(sides + 1))]
        left = [(a * math.cos(t), a * math.sin(t))
                for t in (-math.pi + (math.pi - lean) * i / sides for i in range(sides + 1))]
        return [(-a, height)] + left + right + [(distance + b, height)]

    def bore(x, diameter):
        return [(x + diameter / 2 * c, diameter / 2 * s) for c, s in turn(2 * sides)]

    inner, outer = trough(radius_a, radius_b), trough(radius_a + wall, radius_b + wall)
    bores = [bore(0, bore_a), bore(distance, bore_b)]
    levels = [-width / 2 - wall, -width / 2, width / 2, width / 2 + wall]
    mesh = Mesh()
    # The rim of the walls with bores has corners where the trough between them begins.
    whole = outer + [inner[-1], inner[0]]
    between = outer + inner[::-1]
    for z, holes, up in ((levels[0], bores, False), (levels[3], bores, True)):
        ring_on(mesh, whole, holes, z, up)
    for z, up in ((levels[1], True), (levels[2], False)):
        ring_on(mesh, inner, bores, z, up)
    for low, high in ((levels[0], levels[1]), (levels[2], levels[3])):
        walls_along(mesh, whole, low, high)
        for hole in bores:
            walls_along(mesh, hole, low, high, flip=True)
    walls_along(mesh, between, levels[1], levels[2])
    return mesh


def lid(left=-46.0, right=136.0, width=50.0, low=59.0, high=65.0, radius=5.0, plug=10.0):
    """A plate with round corners from x = left to right, and a filler plug on it; up is y.

    low, high  the plate along y
    plug       diameter of the plug, which stands in the middle and is as high as the plate is thick
    """
    x, z = (right - left) / 2 - radius, width / 2 - radius
    corners = [(x, z), (-x, z), (-x, -z), (x, -z)]
    plate = [(a + radius * math.cos(t), b + radius * math.sin(t))
             for n, (a, b) in enumerate(corners)
             for t in (math.pi / 2 * (n + i / 6) for i in range(7))]
    round_plug = [(plug / 2 * c, plug / 2 * s) for c, s in turn(24)]
    thickness = high - low
    mesh = Mesh()
    ring_on(mesh, plate, [], 0, False)
    walls_along(mesh, plate, 0, thickness)
    ring_on(mesh, plate, [round_plug], thickness, True)
    walls_along(mesh, round_plug, thickness, 2 * thickness)
    ring_on(mesh, round_plug, [], 2 * thickness, True)
    middle, out = (left + right) / 2, Mesh()
    for facet in mesh.facets:
        out.triangle(*(out.vertex(middle + a, low + c, -b)
                       for a, b, c in (mesh.vertices[i] for i in facet)))
    return out


def shaft(length=50.0, journal=12.0, seat=20.0, seat_length=26.0, collar=26.0, collar_length=6.0,
          sides=48):
    """A stepped shaft about z: journals at both ends, between them a seat and a collar at its end.

    journal, seat, collar  diameters
    length                 of the whole shaft; the seat with the collar stands in its middle
    """
    z = [-length / 2, -seat_length / 2, seat_length / 2 - collar_length, seat_length / 2,
         length / 2]
    j, s, c = journal / 2, seat / 2, collar / 2
    profile = [(0, z[0]), (j, z[0]), (j, z[1]), (s, z[1]), (s, z[2]), (c, z[2]), (c, z[3]),
               (j, z[3]), (j, z[4]), (0, z[4])]
    return revolve(profile, sides, closed=False)


def bearing(outer=23.0, inner=11.5, width=8.0, chamfer=1.0, sides=48):
    """A bearing as one ring about z with chamfers outside; `outer` and `inner` are diameters."""
    r, w, c = outer / 2, width / 2, chamfer
    profile = [(inner / 2, -w), (r - c, -w), (r, c - w), (r, w - c), (r - c, w), (inner / 2, w)]
    return revolve(profile, sides, closed=True)


def road_wheel(radius=0.3563, width=0.235, rim_radius=0.23, tread_depth=0.012, blocks=24, dish=0.07):
    """A treaded tyre on a closed rim, about y; the blocks of its two shoulders are staggered.

    rim_radius   where the tyre meets the rim
    tread_depth  of the cross grooves and of the groove round the middle
    blocks       tread blocks round the circumference; a quarter of each is groove
    dish         how far the middle of the rim is set back from the side wall, on both sides
    """
    w, base = width / 2, radius - tread_depth
    # (r, z, which rows of blocks): from the axis over one side wall and the tread to the axis again.
    half = [(0, -w + dish, 0), (0.3 * rim_radius, -w + dish, 0),
            (0.92 * rim_radius, -w + 0.85 * dish, 0), (rim_radius, -0.75 * w, 0),
            (radius - 0.16 * radius, -w, 0), (base - 0.03 * radius, -0.94 * w, 0),
            (base, -0.84 * w, 0), (base, -0.83 * w, 1), (base, -0.13 * w, 1), (base, -0.12 * w, 0)]
    profile = half + [(r, -z, 2 * row) for r, z, row in reversed(half)]
    # Row 1 is raised in the first 0.74 of a block, row 2 in all but 0.26 at the middle of it.
    steps = ((0.0, 1, 1), (0.24, 1, 1), (0.26, 1, 0), (0.48, 1, 0), (0.5, 1, 1), (0.74, 1, 1),
             (0.76, 0, 1), (0.98, 0, 1))
    angles = [(2 * math.pi * (block + part) / blocks, (0, first, second))
              for block in range(blocks) for part, first, second in steps]
    mesh = Mesh()
    rows = [[mesh.vertex(*((r + (tread_depth if raised[row] else 0)) * f(a)
                           for f in (math.cos, math.sin)), z) if r > 0 else mesh.vertex(0, 0, z)
             for a, raised in angles] for r, z, row in profile]
    for low, high in zip(rows, rows[1:]):
        for i in range(len(angles)):
            k = (i + 1) % len(angles)
            mesh.quad(low[i], low[k], high[k], high[i])
    return about_y(mesh)


def estate_body(length=4.4, width=1.86, height=1.65, clearance=0.22, wheelbase=2.66,
                axle_height=0.3563, arch_radius=0.44, arch_depth=0.4, belt=0.93, lean=0.16,
                rounding=0.2):
    """A closed car body along x, its front at the larger x: bonnet, cabin, four wheel arches.

    The ground is z = 0 and the middle of the wheelbase x = 0.

    clearance   height of the flat floor above the ground
    arch_depth  how far an arch reaches in from the side
    belt        height of the lower edge of the side windows; the windows above it lean in by `lean`
    rounding    how far the corners of both bumpers are drawn in, seen from above
    """
    spread = math.acos((clearance - axle_height) / arch_radius)  # from the top of an arch to the floor
    c, back, front = clearance, -length / 2, length / 2
    arch, flat = [], []
    for centre in (-wheelbase / 2, wheelbase / 2):
        for i in range(19):
            a = -spread + 2 * spread * i / 18
            x = centre + arch_radius * math.sin(a)
            arch.append((x, axle_height + arch_radius * math.cos(a) if 0 < i < 18 else c))
            flat.append((x, c))
    roof = [(front - 0.24, c), (front - 0.03, c + 0.16), (front, c + 0.3), (front - 0.05, c + 0.48),
            (front - 0.13, 0.53 * height), (front - 0.5, 0.59 * height),
            (front - 1.15, 0.635 * height), (front - 1.85, 0.955 * height), (front - 2.4, height),
            (back + 1.2, 0.993 * height), (back + 0.5, 0.94 * height), (back + 0.14, 0.65 * height),
            (back + 0.03, 0.56 * height), (back, c + 0.42), (back + 0.04, c + 0.18), (back + 0.3, c)]
    reach = front - 0.6  # only what is beyond it is drawn in

    def loop(bottom, depth, shoulder, pulled, side):
        """The outline at `depth` from a side: `shoulder` of the cabin's height, corners pulled in."""
        points = list(bottom)
        for x, z in roof:
            over = max(0.0, abs(x) - reach) / 0.6
            points.append((x - math.copysign(pulled * over, x),
                           belt + shoulder * (z - belt) if z > belt else z))
        return [(x, z, side * (width / 2 - depth)) for x, z in points]

    # depth, part of the cabin's height, part of the rounding
    levels = ((0.0, 0.02, 1.0), (0.05, 0.1, 0.45), (0.05 + lean, 0.92, 0.1), (0.14 + lean, 1.0, 0.0))
    half = [loop(arch, depth, part, rounding * pull, -1) for depth, part, pull in levels]
    half += [loop(bottom, arch_depth, 1.0, 0.0, -1) for bottom in (arch, flat)]
    # Lofted along z; a turn of 90 degrees about x lays that direction along -y.
    return about_y(loft(half + [[(x, z, -y) for x, z, y in ring] for ring in reversed(half)]))


def estate_panels(length=4.4, width=1.86, clearance=0.22, wheelbase=2.66, arch_radius=0.44,
                  thickness=0.016):
    """Panels of `estate_body`, each a closed plate: four mud flaps, a guard under the engine, sills.

    Their upper ends reach into the body by up to three times the thickness.
    """
    mesh, c, t = Mesh(), clearance, thickness

    def plate(outline, y0, y1):
        mesh.add(about_y(extrude(outline, y0, y1)))

    for side in (-1, 1):
        inner, outer = sorted((side * (width / 2 - 0.29), side * (width / 2 - 0.04)))
        for centre in (-wheelbase / 2, wheelbase / 2):
            x = centre - arch_radius - 0.1
            plate([(x - 0.05, c - 0.13), (x - 0.05 + t, c - 0.13), (x + t, c + 3 * t), (x, c + 3 * t)],
                  inner, outer)
        inner, outer = sorted((side * (width / 2 - 0.06), side * (width / 2 + 0.05)))
        begin, end = -wheelbase / 2 + arch_radius + 0.14, wheelbase / 2 - arch_radius - 0.2
        plate([(begin, c + 0.04), (end, c + 0.04), (end, c + 0.04 + 2 * t), (begin, c + 0.04 + 2 * t)],
              inner, outer)
    nose = length / 2 - 0.3
    plate([(nose - 1.0, c - 0.07), (nose - 0.12, c - 0.07), (nose, c + t), (nose - 0.012, c + 2 * t),
           (nose - 0.12, c - 0.07 + t), (nose - 1.0, c - 0.07 + t)], -0.42, 0.42)
    return mesh



def pipe_bend(radius=0.05, wall=0.015, bend_radius=0.15, inlet=0.25, outlet=0.25, angle=90.0,
              sides=48, stations=24):
    """The wall of a pipe with a bend, open at both ends: along x, then up by `angle` in the x-z plane.

    radius       inner radius; the outer one is larger by `wall`
    bend_radius  of the axis; the bend begins at the origin
    inlet        length of the straight part before it, outlet of the one behind
    stations     rings in the bend
    """
    end = math.radians(angle)
    path = [(-inlet, 0.0, 0.0)]  # x, z, direction
    for i in range(stations + 1):
        a = end * i / stations
        path.append((bend_radius * math.sin(a), bend_radius * (1 - math.cos(a)), a))
    x, z, _ = path[-1]
    path.append((x + outlet * math.cos(end), z + outlet * math.sin(end), end))
    mesh = Mesh()
    tubes = [[[mesh.vertex(x - r * c * math.sin(a), r * s, z + r * c * math.cos(a))
               for c, s in turn(sides)] for x, z, a in path] for r in (radius + wall, radius)]
    # Once round the wall: along the outside, back along the inside.
    rings = tubes[0] + tubes[1][::-1]
    for low, high in zip(rings, rings[1:] + rings[:1]):
        for i in range(sides):
            k = (i + 1) % sides
            mesh.quad(low[k], low[i], high[i], high[k])
    return mesh


def tilted_tube(radius=0.05, wall=0.025, length=0.32, rise=15.0, run=26.0, x=0.078125, sides=96):
    """A straight tube along (run, 0, rise) through the origin, open at both ends, its middle at x."""
    sine, cosine = (v / math.hypot(rise, run) for v in (rise, run))
    rings = [[(r * c, r * s) for c, s in turn(sides)] for r in (radius + wall, radius)]
    out = Mesh()
    middle = x / cosine
    straight = extrude_ring(*rings, middle - length / 2, middle + length / 2)
    for facet in straight.facets:
        corners = (straight.vertices[i] for i in facet)
        # The axis turns from z to (cosine, 0, sine); the ring's x goes down.
        out.triangle(*(out.vertex(sine * px + cosine * pz, py, sine * pz - cosine * px) for px, py, pz in corners))
    return out


def impeller(radius=0.06, hub_radius=0.014, height=0.03, thickness=0.006, blades=4, twist=40.0,
             levels=8):
    """An impeller about z, its middle at the origin: a hub with blades that turn by `twist` over its height.

    radius     of the tips of the blades
    thickness  of the blades
    levels     layers of facets over the height
    """
    gap = math.asin(thickness / 2 / hub_radius)
    tip = math.asin(thickness / 2 / radius)
    outline = []
    for blade in range(blades):
        middle, pitch = 2 * math.pi * blade / blades, 2 * math.pi / blades
        outline += [(hub_radius, middle - gap), (radius, middle - tip), (radius, middle),
                    (radius, middle + tip), (hub_radius, middle + gap)]
        outline += [(hub_radius, middle + gap + (pitch - 2 * gap) * i / 4) for i in range(1, 4)]

    def loop(level):
        turned = math.radians(twist) * (level / levels - 0.5)
        return [(r * math.cos(a + turned), r * math.sin(a + turned), height * (level / levels - 0.5))
                for r, a in outline]

    return loft([loop(level) for level in range(levels + 1)])


def trough(floor, length, width, height, wall):
    """An open tank along x, extruded along z; up is y, its underside at y = -wall.

    floor   (x, y) of the floor's corners, from x = 0 to x = length
    height  of the rim, over y = 0
    wall    thickness of the four sides
    """
    inner = [(0, height)] + floor + [(length, height)]
    outer = [(-wall, height), (-wall, -wall), (length + wall, -wall), (length + wall, height)]
    levels = [-width / 2 - wall, -width / 2, width / 2, width / 2 + wall]
    mesh = Mesh()
    # The rim of the two long walls has corners where the basin between them begins.
    whole = outer + [inner[-1], inner[0]]
    for z, outline, up in ((levels[0], whole, False), (levels[3], whole, True),
                           (levels[1], inner, True), (levels[2], inner, False)):
        ring_on(mesh, outline, [], z, up)
    for low, high in ((levels[0], levels[1]), (levels[2], levels[3])):
        walls_along(mesh, whole, low, high)
    walls_along(mesh, outer + inner[::-1], levels[1], levels[2])
    return mesh


def basin(length=0.5, width=0.1, height=0.24, bottom=0.06, swing=0.04, wall=0.04, sides=48):
    """An open tank along x whose floor rises and falls once, extruded along z; up is y.

    bottom, swing  the floor is at bottom + swing * sin(2 pi x / length)
    height         of the rim, over y = 0
    wall           of the four sides; the underside is at y = -wall
    """
    floor = [(length * i / sides, bottom + swing * math.sin(2 * math.pi * i / sides))
             for i in range(sides + 1)]
    return trough(floor, length, width, height, wall)


def hull(length=0.6, beam=0.24, depth=0.14, deadrise=0.03, bow=0.6, rake=0.08, sections=24):
    """A boat along x, bow at +x, with a keel, two chines and a flat deck; its lowest point is z = 0.

    deadrise  height of the chines over the keel, at the stern
    bow       part of the length in which the sides run together
    rake      of the stem, how far the deck reaches over it
    """
    mesh, rows = Mesh(), []
    for i in range(sections + 1):
        t = i / sections
        s = max(0.0, (t - 1 + bow) / bow)
        half = beam / 2 * (1 - s ** 2)
        rise = 0.6 * depth
        keel, chine = rise * s ** 3, deadrise + (rise - deadrise) * s ** 2
        row = []
        for y, z in ((0, keel), (0.85 * half, chine), (half, depth), (-half, depth),
                     (-0.85 * half, chine)):
            row.append(mesh.vertex(length * (t - 0.5) - rake * s ** 2 * (1 - z / depth), y, z))
        rows.append(row)
    for low, high in zip(rows, rows[1:]):
        for i in range(5):
            k = (i + 1) % 5
            mesh.quad(low[i], low[k], high[k], high[i])
    for i in range(1, 4):
        mesh.triangle(rows[0][0], rows[0][i + 1], rows[0][i])
    return mesh


SHAPES = {f.__name__: f for f in (box, icosphere, cylinder, torus, l_shape, gear, tyre, wheel,
                                  vehicle_body, housing, gearbox_case, lid, shaft, bearing,
                                  road_wheel, estate_body, estate_panels, pipe_bend, impeller, basin,
                                  hull, tilted_tube)}

# The meshes that the cases read: file, shape, parameters.
CASE_MESHES = (
    ("tank/buoy.stl", "cylinder", {"radius": 0.1, "height": 0.16, "sides": 48}),
    ("tank/gear.stl", "gear", {"module": 0.02, "teeth": 14, "width": 0.12, "bore": 0}),
    ("ford/body.stl", "vehicle_body", {}),
    ("ford/wheel.stl", "wheel", {}),
    ("gear/gear.stl", "gear", {"module": 0.02, "teeth": 20, "width": 0.1, "bore": 0.1}),
    ("tyre/tyre.stl", "tyre", {"tread_depth": 0.016, "blocks": 18}),
    # In millimetres, as drawings of machines are.
    ("gearbox/case.stl", "gearbox_case", {}),
    ("gearbox/lid.stl", "lid", {}),
    ("gearbox/pinion.stl", "gear", {"module": 3, "teeth": 20, "width": 20, "bore": 19,
                                    "backlash": 0.4}),
    ("gearbox/wheel.stl", "gear", {"module": 3, "teeth": 30, "width": 16, "bore": 25,
                                   "backlash": 0.4, "turned": 6}),
    ("gearbox/pinion_shaft.stl", "shaft", {}),
    ("gearbox/wheel_shaft.stl", "shaft", {"journal": 16, "seat": 26, "collar": 34}),
    ("gearbox/pinion_bearing.stl", "bearing", {}),
    ("gearbox/wheel_bearing.stl", "bearing", {"outer": 29, "inner": 15.5}),
    ("wading/body.stl", "estate_body", {}),
    ("wading/panels.stl", "estate_panels", {}),
    ("wading/wheel.stl", "road_wheel", {}),
    ("pipe/pipe.stl", "pipe_bend", {}),
    ("stirred/impeller.stl", "impeller", {}),
    ("rest/basin.stl", "basin", {}),
    ("floating/hull.stl", "hull", {}),
    ("pipe-tilted/tube.stl", "tilted_tube", {}),
)

# Those of the case templates, in every format that a draw command reads.
PART = ("l_shape", {"length": 0.6, "thickness": 0.25, "depth": 0.3})
TEMPLATE_MESHES = (
    ("part.stl", *PART), ("part.ply", *PART), ("part.obj", *PART), ("part.off", *PART), ("part.vtk", *PART), ("part.vtp", *PART),
    ("part.vtu", *PART),
    ("block.stl", "box", {"x": 0.4, "y": 0.4, "z": 0.4}),
    ("block.vtp", "box", {"x": 0.4, "y": 0.4, "z": 0.4}),
    ("ball.stl", "icosphere", {"radius": 0.25, "subdivisions": 2}),
    ("shaft.stl", "cylinder", {"radius": 0.15, "height": 0.5, "sides": 24}),
    ("plate.stl", "box", {"x": 0.6, "y": 0.4, "z": 0.01}),
)


def parameters(shape):
    return {p.name: p.default for p in inspect.signature(shape).parameters.values()}


def parse(shape, words):
    """name=value words as keyword arguments of a shape; whole numbers stay whole."""
    known, given = parameters(shape), {}
    for word in words:
        name, mark, value = word.partition("=")
        if not mark or name not in known:
            sys.exit(f"make_meshes.py: {word}: expected name=value with one of {', '.join(known)}")
        try:
            given[name] = type(known[name])(value)
        except ValueError:
            sys.exit(f"make_meshes.py: {word}: not a number")
    return given


def main(words):
    if words == ["--list"]:
        for name, shape in SHAPES.items():
            defaults = " ".join(f"{k}={v}" for k, v in parameters(shape).items())
            print(f"{name}: {inspect.getdoc(shape)}\n    {defaults}\n")
    elif len(words) == 2 and words[0] == "--all":
        os.makedirs(words[1], exist_ok=True)
        for name, shape in SHAPES.items():
            write_stl(shape(), os.path.join(words[1], name + ".stl"), name)
    elif len(words) == 2 and words[0] == "--cases":
        for file, name, given in CASE_MESHES:
            path = os.path.join(words[1], file)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            write_stl(SHAPES[name](**given), path, name)
    elif len(words) == 2 and words[0] == "--templates":
        os.makedirs(words[1], exist_ok=True)
        for file, name, given in TEMPLATE_MESHES:
            write_mesh(SHAPES[name](**given), os.path.join(words[1], file), name)
    elif len(words) >= 2 and words[0] in SHAPES:
        shape = SHAPES[words[0]]
        write_stl(shape(**parse(shape, words[2:])), words[1], words[0])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
