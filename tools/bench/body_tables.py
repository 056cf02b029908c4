#!/usr/bin/python3
"""How well the particles of single bodies stand for them: two tables, as markdown.

    body_tables.py --fppg build/release/fppg volume [--only gear,plate]
    body_tables.py --fppg build/release/fppg layers [--only sphere]

volume  N dp^3 over the volume of the shape, centre, inertia, nearest pairs, spread and Shepard sums of bodies on
        the lattice, body-fitted and with place="inside"
layers  walls for mDBC: depths and normals of layers against the true surface, the spread in each layer, ghost nodes
        as `fppg check` judges them; beside GenCase's particles with normals from the same mesh

Every body is a mesh of tools/make_meshes.py, drawn as a filled boundary; needs python3-numpy and python3-scipy.
Distances are exact, from up to 3,000 particles of a body to its facets.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.spatial import cKDTree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import make_meshes as meshes  # noqa: E402 (found by the path above)
from particle_files import read_bi4, read_vtk  # noqa: E402

SAMPLE = 3000


def star(points=7, outer=0.5, inner=0.22, height=0.4):
    corners = [(r * math.cos(a), r * math.sin(a)) for k in range(2 * points)
               for r, a in [((outer, inner)[k % 2], math.pi * k / points)]]
    return meshes.extrude(corners, 0, height)


def wedge(angle=20.0, length=1.0, width=0.5):
    return meshes.extrude([(0, 0), (length, 0), (length, length * math.tan(math.radians(angle)))], 0, width)


def turned(mesh, degrees):
    """About the axis (1, 2, 3)."""
    axis = np.array([1.0, 2.0, 3.0]) / math.sqrt(14)
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turn = c * np.eye(3) + s * cross + (1 - c) * np.outer(axis, axis)
    out = meshes.Mesh()
    rows = [out.vertex(*(turn @ np.array(v))) for v in mesh.vertices]
    out.facets = [tuple(rows[i] for i in f) for f in mesh.facets]
    return out


def pipe(wall_dp, dp):
    """Fluid of 8 dp inside."""
    r = 4 * dp
    profile = [(r, 0), (r + wall_dp * dp, 0), (r + wall_dp * dp, 20 * dp), (r, 20 * dp)]
    return meshes.revolve(profile, 64, closed=True)


def tower():
    """Storeys that step back, and a mast of 1.5 dp: corners and edges a few dp apart."""
    steps = ((1.0, 0), (1.0, 0.6), (0.8, 0.6), (0.8, 1.2), (0.62, 1.2), (0.62, 1.8), (0.46, 1.8), (0.46, 2.3),
             (0.06, 2.3), (0.06, 2.9))
    return meshes.loft([[(x * s / 2, y * s / 2, z) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                        for s, z in steps])


# Name: (mesh, distances dp).
VOLUME = {
    "ball": (lambda dp: meshes.icosphere(0.5, 4), (0.1, 0.05, 0.025)),
    **{f"gear, {n} dp across": (lambda dp: meshes.gear(module=0.02, teeth=36, width=0.12, bore=0.2), (0.76 / n,))
       for n in (6, 10, 20, 40, 100)},
    "tyre": (lambda dp: meshes.tyre(), (0.04, 0.02, 0.01)),
    "blade": (lambda dp: meshes.impeller(), (0.006, 0.003, 0.002)),
    "thin ring": (lambda dp: meshes.torus(10 * dp, 1.5 * dp), (0.02,)),
    "wedge of 20 degrees": (lambda dp: wedge(), (0.05, 0.025, 0.0125)),
    "star prism": (lambda dp: star(), (0.05, 0.025, 0.0125)),
    **{f"plate of {t} dp": (lambda dp, t=t: meshes.box(1, 0.7, t * dp), (0.05,)) for t in (0.5, 1, 2, 3, 4)},
    **{f"plate of 3 dp at {a} degrees": (lambda dp, a=a: turned(meshes.box(1, 0.7, 3 * dp), a), (0.05,)) for a in (17, 30)},
    **{f"block at {a} degrees": (lambda dp, a=a: turned(meshes.box(0.8, 0.5, 0.4), a), (0.05,)) for a in (0, 17, 30)},
}
LAYERS = {
    "sphere": (lambda dp: meshes.icosphere(0.5, 5), (0.05,)),
    "cylinder": (lambda dp: meshes.cylinder(0.4, 0.9, 128), (0.05,)),
    "box": (lambda dp: meshes.box(1.0, 0.8, 0.7), (0.05,)),
    "wedge of 20 degrees": (lambda dp: wedge(), (0.025,)),
    "gear": (lambda dp: meshes.gear(module=0.05, teeth=18, width=0.4, bore=0.3), (0.02,)),
    "tyre": (lambda dp: meshes.tyre(), (0.01,)),
    "pipe, wall 4 dp": (lambda dp: pipe(4, dp), (0.02,)),
    "pipe, wall 2 dp": (lambda dp: pipe(2, dp), (0.02,)),
    "tower": (lambda dp: tower(), (0.04,)),
}


def definition(mesh, dp, fitted, more="", normals=""):
    v = np.array(mesh.vertices)
    low, high = v.min(0) - 8 * dp, v.max(0) + 8 * dp
    box = ["".join(f' {a}="{x:.9g}"' for a, x in zip("xyz", p)) for p in (low, high)]
    # Without this the solver's domain would end at the body, and fluid could not come to its faces.
    room = ["".join(f' {a}="default {sign} {8 * dp:.9g}"' for a in "xyz") for sign in "-+"]
    return f"""<?xml version="1.0" encoding="UTF-8" ?>
<case><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" /><rhopgradient value="1" />
<hswl value="1" auto="false" /><gamma value="7" /><speedsystem value="1" auto="false" /><coefsound value="20" />
<speedsound value="20" auto="false" /><coefh value="1" /><cflnumber value="0.2" /></constantsdef>
<mkconfig boundcount="240" fluidcount="9" /><geometry><definition dp="{dp:.9g}"><pointmin{box[0]} /><pointmax{box[1]} />
</definition><commands><mainlist><setdrawmode mode="full" /><setmkbound mk="0" />
<drawfilestl file="body.stl" autofill="true" />{more}</mainlist></commands></geometry>{normals}{fitted}</casedef>
<execution><parameters><parameter key="Boundary" value="{2 if normals or 'mdbc' in fitted else 1}" />
<parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" />
<simulationdomain><posmin{room[0]} /><posmax{room[1]} /></simulationdomain></parameters></execution></case>"""


def run(fppg, folder, mesh, text, options=()):
    """(the lines of the log, seconds) of a run."""
    with open(os.path.join(folder, "body.stl"), "wb") as file:
        file.write(meshes.stl_bytes(mesh, "body"))
    with open(os.path.join(folder, "Body_Def.xml"), "w", encoding="utf-8") as file:
        file.write(text)
    began = time.perf_counter()
    done = subprocess.run([fppg, "Body_Def", "Body", "-log-json", *options], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stdout[-600:] + done.stderr[-600:])
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")], time.perf_counter() - began


def positions_of(folder):
    _, arrays = read_bi4(os.path.join(folder, "Body.bi4"))
    return np.array(arrays["Posd"] if "Posd" in arrays else arrays["Pos"], float), arrays


def shepard(p, dp, h=1.3):
    """At particles at least 2h within the hull of their neighbours: of those with a full support."""
    tree = cKDTree(p)
    deep = p[[len(n) > 0.93 * 4 / 3 * math.pi * (2 * h) ** 3 for n in tree.query_ball_point(p, 2 * h * dp)]]
    if len(deep) == 0:
        return "-"
    sums = []
    for at in deep[:: max(1, len(deep) // SAMPLE)]:
        q = np.linalg.norm(p[tree.query_ball_point(at, 2 * h * dp)] - at, axis=1) / (h * dp)
        sums.append((21 / (16 * math.pi * h**3) * (1 - q / 2) ** 4 * (2 * q + 1)).sum())
    return f"{min(sums):.3f} to {max(sums):.3f}"


def volume_row(fppg, mesh, dp, mode):
    fitted = {"lattice": "", "body-fitted": "<fppg><bodyfitted /></fppg>",
              "inside": '<fppg><bodyfitted place="inside" /></fppg>'}[mode]
    with tempfile.TemporaryDirectory() as folder:
        lines, seconds = run(fppg, folder, mesh, definition(mesh, dp, fitted))
        p, _ = positions_of(folder)
    bodies = [line for line in lines if line.get("event") == "body"]
    if bodies:
        shape, own = bodies[0]["shape"], bodies[0]["particles"]
        # Particles on the surface share what nodes leave of the volume; the others stand for dp^3 each.
        volume = (len(p) * dp**3 if mode == "inside" else own["volume"]) / shape["volume"]
        centre = np.subtract(own["centre"], shape["centre"])
        inertia = np.max(np.abs(np.array(own["inertia"]) / np.array(shape["inertia"]) - 1))
        words = [f"{np.linalg.norm(centre) / dp:.4f}", f"{100 * inertia:.2f} %"]
    else:
        volume, words = len(p) * dp**3 / mesh.volume(), ["", ""]
    near = cKDTree(p).query(p, k=2)[0][:, 1] / dp
    return [f"{len(p):,}", f"{100 * (volume - 1):+.2f} %", *words, f"{near.min():.2f}", f"{near.std() / near.mean():.3f}",
            shepard(p, dp), f"{seconds:.2f}"]


def nearest_points(p, mesh):
    """The nearest point of the facets to each of p (Ericson, Real-Time Collision Detection, 5.1.5)."""
    v = np.array(mesh.vertices)
    a, b, c = (v[[f[k] for f in mesh.facets]] for k in range(3))
    out = np.empty_like(p)
    for i, q in enumerate(p):
        ab, ac, ap = b - a, c - a, q - a
        d1, d2 = (ab * ap).sum(1), (ac * ap).sum(1)
        bp, cp = q - b, q - c
        d3, d4, d5, d6 = (ab * bp).sum(1), (ac * bp).sum(1), (ab * cp).sum(1), (ac * cp).sum(1)
        va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
        with np.errstate(divide="ignore", invalid="ignore"):
            inner = a + ab * (vb / (va + vb + vc))[:, None] + ac * (vc / (va + vb + vc))[:, None]
            on_ab = a + ab * np.clip(d1 / (d1 - d3), 0, 1)[:, None]
            on_ac = a + ac * np.clip(d2 / (d2 - d6), 0, 1)[:, None]
            on_bc = b + (c - b) * np.clip((d4 - d3) / ((d4 - d3) + (d5 - d6)), 0, 1)[:, None]
        is_in = (va > 0) & (vb > 0) & (vc > 0)
        best = np.where(is_in[:, None], inner, on_ab)
        for other in (on_ab, on_ac, on_bc, a, b, c):
            nearer = np.linalg.norm(other - q, axis=1) < np.linalg.norm(best - q, axis=1)
            take = (nearer & ~is_in) | ~np.isfinite(best).all(1)
            best = np.where(take[:, None], other, best)
        out[i] = best[np.argmin(np.linalg.norm(best - q, axis=1))]
    return out


def edge_points(mesh, step):
    """Points a step apart on the edges whose facets turn by more than 30 degrees."""
    v, facets = np.array(mesh.vertices), np.array(mesh.facets)
    normals = np.cross(v[facets[:, 1]] - v[facets[:, 0]], v[facets[:, 2]] - v[facets[:, 0]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    first, out = {}, []
    for f, corners in enumerate(facets):
        for a, b in zip(corners, np.roll(corners, -1)):
            other = first.setdefault((min(a, b), max(a, b)), f)
            if other != f and normals[f] @ normals[other] < math.cos(math.radians(30)):
                count = 1 + math.ceil(np.linalg.norm(v[b] - v[a]) / step)
                out.append(v[a] + np.linspace(0, 1, count)[:, None] * (v[b] - v[a]))
    return np.concatenate(out) if out else np.empty((0, 3))


def spread(near):
    return f"{near.std() / near.mean():.3f}" if len(near) >= 20 else "-"


def layers_row(fppg, mesh, dp, mode):
    fitted = {"lattice": "", "layers": '<fppg><bodyfitted boundary="mdbc" /><fluidband active="false" /></fppg>'}[mode]
    # The lattice gets its normals as v5.4's examples do, from the mesh itself.
    normals = "" if mode == "layers" else (
        '<normals><distanceh value="2.0" /><geometryfile file="[CaseName]_hdp_Actual.vtk" /></normals>')
    more = "" if mode == "layers" else '<shapeout file="hdp" />'
    # Fluid all round: without any, `fppg check` takes the box of the body for the room that fluid has.
    v = np.array(mesh.vertices)
    low, high = v.min(0) - 8 * dp, v.max(0) + 8 * dp
    box = ["".join(f' {a}="{x:.9g}"' for a, x in zip("xyz", p)) for p in (low + 2 * dp, low, high - low)]
    more += f'<setmkfluid mk="0" /><fillbox{box[0]}><modefill>void</modefill><point{box[1]} /><size{box[2]} /></fillbox>'
    with tempfile.TemporaryDirectory() as folder:
        run(fppg, folder, mesh, definition(mesh, dp, fitted, more, normals), ("-save:vtkall",))
        check = os.path.join(folder, "check.json")
        subprocess.run([fppg, "check", "Body", "--json", check], cwd=folder, capture_output=True)
        with open(check, encoding="utf-8") as file:
            found = json.load(file)
        p, arrays = positions_of(folder)
        names = read_vtk(os.path.join(folder, "Body_All.vtk"))
    n = np.array(arrays["BoundNor"], float)
    has = np.linalg.norm(n, axis=1) > 0
    p = p[:len(n)]
    layer = np.array(names["Layer"]).ravel().astype(int)[:len(n)] if "Layer" in names else np.zeros(len(p), int)
    order = np.random.default_rng(1).permutation(np.flatnonzero(has & (layer > 0 if "Layer" in names else has)))[:SAMPLE]
    exact = nearest_points(p[order], mesh) - p[order]
    depth = np.linalg.norm(exact, axis=1)
    length = np.linalg.norm(n[order], axis=1)
    angle = np.degrees(np.arccos(np.clip((exact * n[order]).sum(1) / np.maximum(depth * length, 1e-300), -1, 1)))
    # Nearest places of two faces may be equally far; lengths tell whether the vector is right.
    words = [f"{np.mean(angle <= 0.1) * 100:.1f} %", f"{np.quantile(np.abs(depth - length), 0.99) / dp:.1e}"]
    depths, spreads, plain = [], [], []
    edges = edge_points(mesh, dp / 4)
    for k in sorted(set(layer[layer > 0])) if "Layer" in names else []:
        at = np.flatnonzero(layer == k)
        if len(at) < 20:
            continue
        near = cKDTree(p[at]).query(p[at], k=2)[0][:, 1] / dp
        spreads.append(spread(near))
        # The edge of a layer under one that stands out is sqrt(2) times its depth away; two dp more along the layer.
        reach = dp * math.hypot(k - 0.5, k + 1.5)
        plain.append(spread(near[cKDTree(edges).query(p[at])[0] > reach] if len(edges) else near))
        of = layer[order] == k
        if of.any():
            depths.append(f"{np.median(depth[of]) / dp:.2f}")
    f = next(m for m in found["mks"] if m["type"] != "fluid")
    bad = f["faults"]
    near = max(1, f["near_fluid"])
    good = 1 - (bad["weak_kernel"] + bad["ill_conditioned"]) / near
    return [f"{len(p):,}", *words, ", ".join(depths) or "-", ", ".join(spreads) or "-",
            ", ".join(plain) or "-", str(bad["no_normal"]),
            str(bad["through_wall"] + bad["looks_away"] + bad["ghost_in_wall"]), f"{100 * good:.1f} %",
            str(bad["wet_on_both_sides"])]


TABLES = {
    "volume": (VOLUME, ("lattice", "body-fitted", "inside"), volume_row,
               "particles | volume | centre off, dp | inertia off | nearest pair, dp | spread | Shepard sums | s"),
    "layers": (LAYERS, ("lattice", "layers"), layers_row,
               "particles | normals within 0.1 degree | length off (99 %), dp | depths of layers, dp | spread in them | "
               "away from edges | no normal | through or into walls | ghosts in order | wet on both sides"),
}


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fppg", required=True)
    parser.add_argument("--only", default="", help="bodies whose names begin so, separated by commas")
    parser.add_argument("table", choices=TABLES)
    given = parser.parse_args(words)
    shapes, modes, row, head = TABLES[given.table]
    print(f"| body, dp | particles are | {head} |\n" + "| --- " * (3 + head.count("|")) + "|")
    for name, (make, distances) in shapes.items():
        if not name.startswith(tuple(given.only.split(","))):
            continue
        for dp in distances:
            for mode in modes:
                try:
                    cells = row(os.path.abspath(given.fppg), make(dp), dp, mode)
                except (RuntimeError, KeyError) as error:
                    cells = [str(error).strip().replace("\n", " ")[:120]]
                print(f"| {name}, {dp:.4g} | {mode} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
