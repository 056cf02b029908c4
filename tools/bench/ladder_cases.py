"""The cases of the ladder, in GenCase's own language, so that both programs run the same file.

Geometry is that of `cases/`, as drawn there, and two meshes made here: a sphere of radius 1 and a
lumpy body that stands in a tank. `dp` in the files is a beginning; the ladder sets it.
"""

import json
import math
import os
import struct
import sys

HEAD = """<?xml version="1.0" encoding="UTF-8" ?>
<!-- Made by tools/bench: {what} -->
<case>
    <casedef>
        <constantsdef>
            <gravity x="0" y="0" z="-9.81" />
            <rhop0 value="1000" />
            <hswl value="0" auto="true" />
            <gamma value="7" />
            <speedsystem value="0" auto="true" />
            <coefsound value="20" />
            <speedsound value="0" auto="true" />
            <coefh value="1" />
            <cflnumber value="0.2" />
        </constantsdef>
        <mkconfig boundcount="240" fluidcount="9" />
        <geometry>
            <definition dp="{dp:g}">
                <pointmin x="{low[0]:g}" y="{low[1]:g}" z="{low[2]:g}" />
                <pointmax x="{high[0]:g}" y="{high[1]:g}" z="{high[2]:g}" />
            </definition>
            <commands>
                <mainlist>
                    <setdrawmode mode="full" />
"""

TAIL = """                </mainlist>
            </commands>
        </geometry>
    </casedef>
    <execution>
        <parameters>
            <parameter key="TimeMax" value="1" />
        </parameters>
    </execution>
</case>
"""


def sphere_facets(halvings, radius_at):
    """An icosahedron, each facet halved `halvings` times, its vertices at a radius that depends on
    the direction: a list of facets of three points."""
    golden = (1 + math.sqrt(5)) / 2
    vertices = [(a, b, 0) for a in (-1, 1) for b in (-golden, golden)]
    vertices += [(0, a, b) for a in (-1, 1) for b in (-golden, golden)]
    vertices += [(b, 0, a) for a in (-1, 1) for b in (-golden, golden)]
    edge = 2.0001
    near = [[math.dist(p, q) < edge for q in vertices] for p in vertices]
    facets = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                if near[i][j] and near[j][k] and near[i][k]:
                    facets.append((vertices[i], vertices[j], vertices[k]))

    def unit(p):
        length = math.sqrt(sum(x * x for x in p))
        return tuple(x / length for x in p)

    def middle(p, q):
        return unit(tuple((x + y) / 2 for x, y in zip(p, q)))

    facets = [tuple(unit(p) for p in facet) for facet in facets]
    for _ in range(halvings):
        facets = [part for a, b, c in facets
                  for ab, bc, ca in [(middle(a, b), middle(b, c), middle(c, a))]
                  for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]

    def outwards(a, b, c):
        u = [y - x for x, y in zip(a, b)]
        v = [y - x for x, y in zip(a, c)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        return (a, b, c) if sum(x * y for x, y in zip(normal, a)) > 0 else (a, c, b)

    # A vertex is made from its direction alone, so facets meet exactly.
    scaled = {}
    for facet in facets:
        for p in facet:
            key = tuple(round(x, 12) for x in p)
            if key not in scaled:
                r = radius_at(key)
                scaled[key] = tuple(r * x for x in key)
    return [tuple(scaled[tuple(round(x, 12) for x in p)] for p in outwards(*facet))
            for facet in facets]


def write_stl(path, facets):
    """Writes a binary STL file; normals are left to the reader."""
    with open(path, "wb") as file:
        file.write(b"made by tools/bench".ljust(80) + struct.pack("<I", len(facets)))
        for facet in facets:
            file.write(struct.pack("<12fH", 0, 0, 0, *[x for p in facet for x in p], 0))


def lump_radius(direction):
    x, y, z = direction
    return 0.05 * (1 + 0.18 * math.sin(5 * x + 1) * math.cos(4 * y) + 0.12 * math.sin(7 * z + 3 * x))


def stl(path, move=None, scale=None):
    lines = [f'                    <drawfilestl file="{path}">']
    if move:
        lines.append('                        <drawmove x="{:g}" y="{:g}" z="{:g}" />'.format(*move))
    if scale:
        lines.append(f'                        <drawscale x="{scale:g}" y="{scale:g}" z="{scale:g}" />')
    lines.append("                    </drawfilestl>")
    return "\n".join(lines) + "\n"


def bound(mk):
    return f'                    <setmkbound mk="{mk}" />\n'


def seed(x, y, z):
    return (f'                    <fillpoint x="{x:g}" y="{y:g}" z="{z:g}">\n'
            "                        <modefill>void</modefill>\n                    </fillpoint>\n")


FLUID = '                    <setmkfluid mk="0" />\n'


def tank(low, size, depth, at):
    """A box without a lid, with water of a depth in all that is empty."""
    point = '<point x="{:g}" y="{:g}" z="{:g}" />'.format(*low)
    walls = ("                    <drawbox>\n"
             "                        <boxfill>bottom | left | right | front | back</boxfill>\n"
             f"                        {point}\n"
             '                        <size x="{:g}" y="{:g}" z="{:g}" />\n'.format(*size) +
             "                    </drawbox>\n")
    water = ('                    <fillbox x="{:g}" y="{:g}" z="{:g}">\n'.format(*at) +
             "                        <modefill>void</modefill>\n"
             f"                        {point}\n"
             f'                        <size x="{size[0]:g}" y="{size[1]:g}" z="{depth:g}" />\n'
             "                    </fillbox>\n")
    return walls, water


def write_case(path, what, dp, low, high, commands):
    with open(path, "w", encoding="utf-8") as file:
        file.write(HEAD.format(what=what, dp=dp, low=low, high=high) + commands + TAIL)
    return path


def write_domain_case(work, n, dp):
    """A tank of 0.7 x 0.52 x 0.3 m with 0.2 m of water in the middle of a domain of n nodes along
    each axis; the path of the definition."""
    low = tuple(n // 2 * dp - x for x in (0.35, 0.26, 0.15))
    walls, water = tank(low, (0.7, 0.52, 0.3), 0.2, tuple(x + 0.1 for x in low))
    return write_case(os.path.join(work, f"CaseDomain{n}_Def.xml"),
                      f"a tank amid {n} nodes along each axis", dp, (0, 0, 0),
                      ((n - 0.5) * dp,) * 3, bound(0) + walls + FLUID + water)


def write_ladder_cases(work, repository):
    """Writes the definitions and their meshes into a folder; name -> path of the definition."""
    cases = os.path.join(repository, "cases")
    made = {}

    def write(name, what, dp, low, high, commands):
        made[name] = write_case(os.path.join(work, f"Case{name.capitalize()}_Def.xml"), what, dp,
                                low, high, commands)

    write_stl(os.path.join(work, "sphere.stl"), sphere_facets(5, lambda _: 1.0))
    write("sphere", "a sphere of radius 1 (20,480 facets), filled with fluid", 0.05,
          (-1.2, -1.2, -1.2), (1.2, 1.2, 1.2),
          bound(0) + stl("sphere.stl") + FLUID + seed(0, 0, 0))

    write_stl(os.path.join(work, "lump.stl"), sphere_facets(6, lump_radius))
    walls, water = tank((-0.1, -0.1, 0), (0.2, 0.2, 0.16), 0.12, (-0.08, -0.08, 0.02))
    write("lump", "a lumpy body (81,920 facets) in a tank of water", 0.004,
          (-0.12, -0.12, -0.02), (0.12, 0.12, 0.2),
          bound(1) + stl("lump.stl", (0, 0, 0.08)) + bound(0) + walls + FLUID + water)

    write("gear", "a gear, filled", 0.01, (-0.3, -0.3, -0.1), (0.3, 0.3, 0.1),
          bound(0) + stl(os.path.join(cases, "gear", "gear.stl")) + seed(0.13, 0, 0))

    walls, water = tank((-3.5, -1.8, 0), (7, 3.6, 1.2), 0.5, (-3.2, 0, 0.2))
    ford = os.path.join(cases, "ford")
    wheels = "".join(bound(2 + i) + stl(os.path.join(ford, "wheel.stl"), (x, y, 0.4))
                     for i, (x, y) in enumerate([(1.3, 0.77), (1.3, -0.77), (-1.3, 0.77),
                                                 (-1.3, -0.77)]))
    write("vehicle", "a vehicle in a ford", 0.05, (-3.7, -2, -0.2), (3.7, 2, 1.8),
          bound(0) + walls + bound(1) + stl(os.path.join(ford, "body.stl"), (0, 0, 0.08)) +
          wheels + FLUID + water)

    box = os.path.join(cases, "gearbox")
    parts = [("case", None, 0), ("lid", None, 1), ("pinion", None, 2), ("pinion_shaft", None, 3),
             ("wheel", (0.075, 0, 0), 4), ("wheel_shaft", (0.075, 0, 0), 5)]
    write("gearbox", "the parts of a gearbox as shells, with oil", 0.002,
          (-0.06, -0.08, -0.04), (0.16, 0.09, 0.04),
          "".join(bound(mk) + stl(os.path.join(box, part + ".stl"), move, 0.001)
                  for part, move, mk in parts) +
          FLUID + '                    <fillbox x="0.045" y="-0.045" z="0">\n'
          "                        <modefill>void</modefill>\n"
          '                        <point x="-0.05" y="-0.07" z="-0.03" />\n'
          '                        <size x="0.19" y="0.07" z="0.06" />\n'
          "                    </fillbox>\n")
    return made


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: ladder_cases.py FOLDER")
    here = os.path.dirname(os.path.abspath(__file__))
    print(json.dumps(write_ladder_cases(sys.argv[1], os.path.dirname(os.path.dirname(here)))))
