#!/usr/bin/python3
"""Broken meshes in every way that a case uses a mesh, judged against the particles of the clean mesh.

    check_dirty_meshes.py PROGRAM TOOLS TABLE [--write]

TABLE is dirty_meshes.md, which says what becomes of each; --write writes it anew. What is not allowed in any row: a
crash, a hang, or particles that differ from those of the clean mesh without a warning.
"""

import math
import os
import random
import re
import struct
import subprocess
import sys
import tempfile

import numpy as np

from sanitized import times_slower

PROGRAM, TOOLS, TABLE = sys.argv[1:4]
sys.path.insert(0, TOOLS)
from make_meshes import icosphere  # noqa: E402 (found by the path above)
from particle_files import read_bi4, read_particles  # noqa: E402

DP = 0.05
CASE = """<case xmlns:fppg="urn:fppg"><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" />
<hswl value="0" auto="true" /><gamma value="7" /><coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" />
</constantsdef><mkconfig boundcount="240" fluidcount="9" /><geometry><definition dp="{dp}">
<pointmin x="{low}" y="{low}" z="{low}" /><pointmax x="{high}" y="{high}" z="{high}" /></definition><commands><mainlist>
<setdrawmode mode="full" /><setmkbound mk="0" />{draws}</mainlist></commands></geometry><fppg>{fit}</fppg></casedef>
<execution><parameters><parameter key="Boundary" value="{boundary}" /><parameter key="SlipMode" value="2" />
<parameter key="NoPenetration" value="1" /><parameter key="TimeMax" value="1" /></parameters></execution></case>
"""
MESH = '<drawfilestl file="mesh.stl" {} />'
# @ stands before places and % before lengths: far from the origin both are other numbers.
BLOCK = ('<setmkbound mk="1" /><drawbox fppg:name="block"><boxfill>solid</boxfill><point x="@0.2" y="@0.2" z="@0.5" />'
         '<size x="%0.6" y="%0.6" z="%0.5" /></drawbox>')
FAR = 1e6
FAR_DP = 1e-3
# GenCase's rule for the nodes of a facet (tests/golden/rules.md) depends on how a surface is cut into facets.
MOST_OF_COUNT = 0.2
# name -> draws, <fppg>, option, Boundary.
MODES = {
    "lattice": (MESH.format('autofill="true"'), "", "-fit:off", 1),
    "lattice, inside": (MESH.format('fppg:fill="inside"'), "", "-fit:off", 1),
    "fitted": (MESH.format('fppg:fill="inside"'), "", "-fit:raw", 1),
    "Boolean": (MESH.format('fppg:name="ball"') + BLOCK, '<bodyfitted mkbound="0-9" /><boolean op="difference" '
                'mkbound="1"><part ref="block" /><part ref="ball" /></boolean>', "-fit:raw", 1),
    "fill": (MESH.format(""), '<fill mkfluid="0" seed="@0.5,@0.5,@0.3" percent="66" />', "-fit:off", 1),
    "mDBC": (MESH.format(""), '<bodyfitted mkbound="0" boundary="mdbc" />', "-fit:raw", 2),
}


def ball(radius=0.3437, at=(0.5131, 0.4967, 0.5083), subdivisions=2):
    """Facets as rows of three corners."""
    mesh = icosphere(radius, subdivisions)
    return [[[mesh.vertices[i][k] + at[k] for k in range(3)] for i in facet] for facet in mesh.facets]


def binary(facets, count=None, head=b"fppg"):
    out = head.ljust(80)[:80] + struct.pack("<I", len(facets) if count is None else count)
    for facet in facets:
        out += struct.pack("<12fH", 0, 0, 0, *(x for corner in facet for x in corner), 0)
    return out


def text(facets, number="{:.9g}", end="\n"):
    lines = ["solid ball"]
    for facet in facets:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex " + " ".join(number.format(x) for x in corner) for corner in facet]
        lines += ["endloop", "endfacet"]
    return (end.join(lines + ["endsolid ball"]) + end).encode()


def scaled(facets, factor):
    return [[[factor * x for x in corner] for corner in facet] for facet in facets]


def moved(facets, by):
    return [[[x + by for x in corner] for corner in facet] for facet in facets]


def far_away(facets):
    return moved(scaled(facets, FAR_DP / DP), FAR)


def halved(facets):
    """Each tenth facet has a corner in the middle of its first edge, which the neighbour lacks."""
    out = []
    for i, (a, b, c) in enumerate(facets):
        m = [(a[k] + b[k]) / 2 for k in range(3)]
        out += [[a, m, c], [m, b, c]] if i % 10 == 0 else [[a, b, c]]
    return out


def slivers(facets, count):
    """Fans of slivers along the first edge of every facet; both sides of an edge are cut alike."""
    out = []
    each = max(1, count // len(facets))
    for a, b, c in facets:
        points = [[a[k] + (b[k] - a[k]) * i / each for k in range(3)] for i in range(each + 1)]
        out += [[points[i], points[i + 1], c] for i in range(each)]
    return out


def pushed_in(facets):
    """One corner is pulled through the other side of the ball."""
    spot = facets[0][0]
    far = [1 - x + (0.15 if k == 0 else 0) * (1 if spot[0] < 0.5 else -1) for k, x in enumerate(spot)]
    return [[far if corner == spot else corner for corner in facet] for facet in facets]


def jittered(facets, by):
    numbers = random.Random(3)
    return [[[x + numbers.uniform(-by, by) for x in corner] for corner in facet] for facet in facets]


def defects():
    """name -> bytes of the file, facets of the clean twin (None: there is none, an error or a warning is wanted). Names
    that begin with "near 1e6" are of balls there, as large as their dp."""
    clean = ball()
    nan = [[list(corner) for corner in facet] for facet in clean]
    nan[7][1][2] = float("nan")
    huge = clean + [[[1e30, 0, 0], [0, 1e30, 0], [0, 0, 1e30]]]
    fin = clean + [[clean[0][0], clean[0][1], [0.5, 0.5, 1.1]]]
    other = ball(0.2037, (0.7171, 0.4967, 0.5083))
    return {
        "clean": (binary(clean), clean),
        "hole of one facet": (binary(clean[1:]), clean),
        "hole of a fifth": (binary([f for f in clean if f[0][2] < 0.7]), None),
        "facets twice": (binary(clean + clean[:40]), clean),
        "two shells in one place": (binary(clean + clean), clean),
        "a shell inside": (binary(clean + ball(0.1937)), clean),
        "facets without area": (binary(clean + [[f[0], f[0], f[1]] for f in clean[:30]]), clean),
        "one facet inverted": (binary([clean[0][::-1]] + clean[1:]), clean),
        "all facets inverted": (binary([f[::-1] for f in clean]), clean),
        "two balls that cross": (binary(clean + other), "union"),
        "crosses itself": (binary(pushed_in(clean)), None),
        "T-junctions": (binary(halved(clean)), clean),
        "cracks": (binary(jittered(clean, 1e-5)), clean),
        "not a number": (binary(nan), clean),
        "a corner at 1e30": (binary(huge), clean),
        "cut off": (binary(clean)[:-777], None),
        "count too large": (binary(clean, len(clean) + 9), None),
        "count too small": (binary(clean, len(clean) - 9), None),
        "a fin": (binary(fin), clean),
        "empty": (b"", None),
        "header alone": (binary([]), None),
        "text, no STL": (b"solid\nhello\n", None),
        "ASCII, CR LF, upper case": (text(clean, end="\r\n").replace(b"vertex", b"VERTEX"), clean),
        "ASCII, decimal commas": (text(clean).replace(b".", b","), None),
        "ASCII, cut off": (text(clean)[:-555], None),
        "binary that begins with solid": (binary(clean, head=b"solid ball"), clean),
        "1000 times too large": (binary(scaled(clean, 1000)), None),
        "1000 times too small": (binary(scaled(clean, 0.001)), None),
        "near 1e6 m with dp 1e-3, ASCII": (text(far_away(clean), "{:.17g}"), clean),
        "near 1e6 m with dp 1e-3, binary": (binary(far_away(clean)), None),
        "20,000 slivers": (binary(slivers(clean, 20000)), clean),
    }


class Run:
    """What a case gave: code, warnings, error, particles with mk, and vectors of boundary particles."""

    def __init__(self, folder, mode, mesh, low=0.0, dp=DP):
        def put(text):
            text = re.sub(r"@([0-9.]+)", lambda m: repr(low + dp / DP * float(m.group(1))), text)
            return re.sub(r"%([0-9.]+)", lambda m: repr(dp / DP * float(m.group(1))), text)

        draws, fit, option, boundary = MODES[mode]
        with open(os.path.join(folder, "mesh.stl"), "wb") as file:
            file.write(mesh)
        with open(os.path.join(folder, "Case_Def.xml"), "w", encoding="utf-8") as file:
            file.write(CASE.format(dp=dp, low=repr(low), high=repr(low + dp / DP), draws=put(draws), fit=put(fit), boundary=boundary))
        done = subprocess.run([PROGRAM, "Case_Def", "out/Case", "-threads:2", option], cwd=folder, check=False,
                              timeout=100 * times_slower(PROGRAM), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.code, self.out = done.returncode, done.stdout
        assert self.code in (0, 3, 4), f"{mode}: exit code {self.code}\n{self.out}"
        self.error = "".join(re.findall(r"\n\*\*\* Error: (.*)", self.out))
        self.warnings = [w for w in re.findall(r"\*\*\* WARNING: (.*)", self.out) if "mesh.stl" in w or "facet" in w or
                         "surface" in w or "Case_Def.xml:" in w]
        if self.code == 0:
            stem = os.path.join(folder, "out/Case")
            self.places, self.mk = read_particles(stem)
            _, arrays = read_bi4(stem + ".bi4")
            self.normals = np.array(arrays.get("BoundNor", np.zeros((0, 3))), float).reshape(-1, 3)
            # As if it were the clean case.
            self.places, self.normals = (self.places - low) * (DP / dp), self.normals * (DP / dp)


def farthest(a, b):
    """Of all points of a, the largest distance to the nearest of b."""
    most = 0.0
    for begin in range(0, len(a), 500):
        d = np.linalg.norm(a[begin:begin + 500, None, :] - b[None, :, :], axis=2)
        most = max(most, d.min(axis=1).max())
    return most


def difference(run, twin, mode):
    """In words; empty where nobody would notice one; "near" where facets cut otherwise have other nodes beside them."""
    near = ""
    for mk in sorted(set(twin.mk) | set(run.mk)):
        a, b = run.places[run.mk == mk], twin.places[twin.mk == mk]
        if len(a) == 0 or len(b) == 0:
            return f"{len(a)} particles of mk {mk}, clean {len(b)}"
        if mode in ("fitted", "Boolean", "mDBC"):
            # Rows of particles begin elsewhere on other facets, so they are not the same ones.
            apart = max(farthest(a, b), farthest(b, a))
            if apart > 1.01 * DP or abs(len(a) / len(b) - 1) > 0.03:
                return f"{len(a)} particles of mk {mk}, clean {len(b)}, up to {apart / DP:.2g} dp apart"
        else:
            only = len(set(map(tuple, np.round(a / DP).astype(int))) ^ set(map(tuple, np.round(b / DP).astype(int))))
            if only > 0 and mode in ("lattice", "fill") and farthest(a, b) < 1.01 * DP > farthest(b, a) and \
                    abs(len(a) / len(b) - 1) < MOST_OF_COUNT:
                near = "near"
            elif only > 0:
                return f"{only} of {len(b)} nodes of mk {mk} differ"
    if mode == "mDBC" and len(run.normals) and len(twin.normals):
        n = len(run.normals)
        if abs(np.linalg.norm(run.normals, axis=1).mean() / np.linalg.norm(twin.normals, axis=1).mean() - 1) > 0.05:
            return "normals are longer or shorter"
        # Away from the centre or towards it.
        from_centre = run.places[:n] - 0.5
        along = (run.normals * from_centre).sum(axis=1)
        of_twin = (twin.normals * (twin.places[:len(twin.normals)] - 0.5)).sum(axis=1)
        if (along > 0).mean() < (of_twin > 0).mean() - 0.02:
            return f"{(along <= 0).sum()} of {n} normals look the other way"
    return near


def judge(folder, mode, mesh, clean, clean_text):
    run = Run(folder, mode, mesh, *((FAR, FAR_DP) if clean_text.startswith("near 1e6") else ()))
    if run.code != 0:
        assert "mesh.stl" in run.error or "Case_Def.xml" in run.error, f"{mode}: {run.error}"
        return "error" if clean_text != "clean" else "ERROR"
    warned = bool(run.warnings)
    if clean is None:
        return "warning" if warned else "SILENT"
    other = difference(run, clean, mode)
    if other in ("", "near"):
        return (other or "same") + (", warning" if warned else "")
    return "warning" if warned else f"SILENT: {other}"


def union_twin(folder, mode):
    """Two balls as two draws; as parts of a Boolean, or in modes without one, of files of their own."""
    draws, fit, option, boundary = MODES[mode]
    if mode in ("Boolean", "mDBC", "fitted"):
        return None
    with open(os.path.join(folder, "other.stl"), "wb") as file:
        file.write(binary(ball(0.2037, (0.7171, 0.4967, 0.5083))))
    MODES["twin"] = (draws + draws.replace("mesh.stl", "other.stl"), fit, option, boundary)
    return Run(folder, "twin", binary(ball()))


def rows():
    found = {}
    with tempfile.TemporaryDirectory(prefix="fppg-dirty-") as folder:
        names = list(MODES)
        clean = {mode: Run(folder, mode, binary(ball())) for mode in names}
        for mode, run in clean.items():
            assert run.code == 0, f"{mode}: {run.out}"
        for name, (mesh, twin) in defects().items():
            found[name] = []
            for mode in names:
                of = None if twin is None else union_twin(folder, mode) if twin == "union" else clean[mode]
                found[name].append(judge(folder, mode, mesh, of, name))
    return names, found


def main():
    names, found = rows()
    lines = ["| defect | " + " | ".join(names) + " |", "| --- |" + " --- |" * len(names)]
    lines += [f"| {name} | " + " | ".join(row) + " |" for name, row in found.items()]
    table = "\n".join(lines) + "\n"
    print(table)
    with open(TABLE, encoding="utf-8") as file:
        known = file.read()
    head = known[:known.index("| defect |")] if "| defect |" in known else known
    if "--write" in sys.argv:
        with open(TABLE, "w", encoding="utf-8") as file:
            file.write(head + table)
    bad = [f"{name}, {mode}: {what}" for name, row in found.items() for mode, what in zip(names, row) if what.isupper()
           or what.startswith("SILENT")]
    assert not bad, "\n".join(bad)
    assert known == head + table or "--write" in sys.argv, f"{TABLE} says otherwise; --write writes it anew"


if __name__ == "__main__":
    main()
