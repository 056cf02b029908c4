#!/usr/bin/python3
"""Runs the program on a case with body-fitted meshes and looks at the particles themselves.

    check_fitted_case.py PROGRAM CASE_FOLDER WORK_FOLDER   exits with 1 when something is wrong
    check_fitted_case.py --summary OUT/Case                counts as expected_fitted.json holds them

Held against the mesh, not against a recording: the distance of the wall's particles to its
facets, the volume that the body's particles stand for, no fluid inside the clearance. Where several
meshes are united, no particle of a wall is inside another one. The counts of expected_fitted.json
may be off by half a per cent, as the last digits of sines and roots differ between machines.

expected_fitted.json names the mesh with its mk and place, or a list of them as "parts" with the
"volume" of their union, and the speeds of the case's rotations in their order as "turns". "fluid_from" is how
near to the mesh fluid may be, dp: 0.2 where it is balanced, by the rule of the balance, else 0.5.
"depth" is how far behind the mesh the outermost particles stand, dp: 0.5 for place="inside", else 0.

A record may hold "bodies" instead, a list of mesh, mk, turn and move of bodies that stand apart;
"volume_within" in one is how far the volume that its particles stand for may be off (default 0.01; more
where edges are closer than dp), null where they are not meant to stand for it.

A record with "layers" in its counts is of one mesh with layers for mDBC: layer k stands (k - 1/2) dp behind
the mesh, to 1e-4 dp, and no normal of it is missing or leads elsewhere. No fluid is in the wall, nearer than
0.1 dp to it or nearer than 0.5 dp to a particle of it. It has "volume_within" too. "period" is the
vector to the next copy of a case that is periodic along x: the solver's period, CasePosMax - CasePosMin + dp,
is that, and no two particles are nearer than half a dp across it.
"""

import os
import re
import sys

import numpy as np

sys.dont_write_bytecode = True
from case_check import check, differences  # noqa: E402 (leaves no file beside it)
from particle_files import read_bi4, read_blocks, read_vtk  # noqa: E402 (case_check adds its path)

VOLUME = 3  # of the array Kind; smaller numbers are corners, edges, surface


def read_stl(path):
    with open(path, "rb") as file:
        data = file.read()
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    return np.frombuffer(data, facet, offset=84)["corners"].astype(float)


def distances(points, facets):
    """From every point to the nearest facet, by the barycentric form; a few thousand points."""
    a, b, c = facets[:, 0], facets[:, 1], facets[:, 2]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    best = np.full(len(points), np.inf)
    for p_begin in range(0, len(points), 200):
        p = points[p_begin:p_begin + 200, None, :]
        height = np.einsum("pfk,fk->pf", p - a, normal)
        foot = p - height[..., None] * normal
        inside = np.ones(height.shape, bool)
        sides = np.full(height.shape, np.inf)
        for u, v in ((a, b), (b, c), (c, a)):
            inside &= np.einsum("pfk,fk->pf", np.cross(v - u, foot - u), normal) >= 0
            t = np.einsum("pfk,fk->pf", p - u, v - u) / np.sum((v - u) ** 2, axis=1)
            on_side = u + np.clip(t, 0, 1)[..., None] * (v - u)
            sides = np.minimum(sides, np.linalg.norm(p - on_side, axis=2))
        best[p_begin:p_begin + 200] = np.where(inside, np.abs(height), sides).min(axis=1)
    return best


def nearest_between(points, others):
    """The least distance between two sets of points, by sorting the others along x."""
    others = others[np.argsort(others[:, 0])]
    best = np.inf
    for p in points:
        low, high = np.searchsorted(others[:, 0], [p[0] - best, p[0] + best])
        if high > low:
            best = min(best, np.linalg.norm(others[low:high] - p, axis=1).min())
    return best


def sample(values):
    """A few thousand of them, evenly."""
    return values[::max(7, len(values) // 2000)]


def volume_of(facets):
    return np.einsum("fk,fk->f", facets[:, 0], np.cross(facets[:, 1], facets[:, 2])).sum() / 6


def is_inside(points, facets):
    """Whether each point is inside closed facets, by the sum of their solid angles."""
    inside = np.zeros(len(points), bool)
    near = np.all((points > facets.min(axis=(0, 1))) & (points < facets.max(axis=(0, 1))), axis=1)
    for chunk in np.array_split(np.flatnonzero(near), max(1, np.count_nonzero(near) // 200)):
        a, b, c = (facets[None, :, k] - points[chunk, None] for k in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=2) for v in (a, b, c))
        above = np.einsum("pfk,pfk->pf", a, np.cross(b, c))
        below = la * lb * lc
        for u, v, length in ((a, b, lc), (b, c, la), (c, a, lb)):
            below += np.einsum("pfk,pfk->pf", u, v) * length
        inside[chunk] = np.arctan2(above, below).sum(axis=1) > np.pi
    return inside


def summarise(case):
    values, _ = read_bi4(case + ".bi4")
    picture = read_vtk(case + "_All.vtk")
    kinds = np.bincount(np.asarray(picture["Kind"]).ravel(), minlength=4)
    layers = np.bincount(np.asarray(picture["Layer"]).ravel())[1:]
    return {
        **({"layers": [int(n) for n in layers]} if len(layers) > 1 else {}),
        "np": values["CaseNp"],
        "blocks": [{k: b[k] for k in ("type", "mk", "count")} for b in read_blocks(case + ".xml")],
        "corners": int(kinds[0]), "edges": int(kinds[1]), "surface": int(kinds[2]),
    }


def is_same(found, expected, place):
    """Counts to half a per cent, all else exactly."""
    if isinstance(expected, int) and found is not None and not place.endswith("/mk"):
        return abs(found - expected) <= 0.005 * expected
    return found == expected


def body_faults(record, folder, dp, positions, kind, mk):
    """Yields a line for everything that is wrong about the particles of one body, or near it."""
    body = mk == record["mk"]
    facets = read_stl(os.path.join(folder, record["mesh"])) @ np.array(record["turn"]).T
    facets += np.array(record["move"])
    volume = np.einsum("fk,fk->f", facets[:, 0], np.cross(facets[:, 1], facets[:, 2])).sum() / 6

    wall = positions[body & (kind < VOLUME)][::7]
    farthest = distances(wall, facets).max() / dp
    if farthest > 1e-4:
        yield f"a wall particle of mk {record['mk']} is {farthest:.3g} dp off the mesh"
    inside = np.count_nonzero(body & (kind == VOLUME))
    stands_for = (inside + 0.5 * np.count_nonzero(body & (kind < VOLUME))) * dp ** 3
    within = record.get("volume_within", 0.01)
    if within is not None and abs(stands_for / volume - 1) > within:
        yield f"mk {record['mk']} stands for {stands_for:.6g} m3, the body has {volume:.6g}"
    fluid = positions[mk == 1]
    low, high = facets.min(axis=(0, 1)) - dp, facets.max(axis=(0, 1)) + dp
    near = fluid[np.all((fluid > low) & (fluid < high), axis=1)]
    nearest = distances(sample(near), facets).min() / dp
    if nearest < 0.499:
        yield f"fluid stands {nearest:.3g} dp from the mesh of mk {record['mk']}"


def layer_depths(points, depth, facets):
    """How much deeper than `depth` each point is. Behind an edge that runs into the wall, where the nearest
    place is the edge itself, depth is the largest distance to the planes of the facets that meet there (a
    mitre), at least the distance over 1.8; a layer whose mitre would tear has the distance there too."""
    distance = distances(points, facets)
    off = distance - depth
    a, b, c = facets[:, 0], facets[:, 1], facets[:, 2]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    for i in np.flatnonzero(off > 1e-5 * depth):
        reach = distance[i] * (1 + 1e-6)
        box = np.all((facets.min(axis=1) < points[i] + reach) & (facets.max(axis=1) > points[i] - reach), axis=1)
        at = [f for f in np.flatnonzero(box) if distances(points[i:i + 1], facets[f:f + 1])[0] < reach]
        planes = np.einsum("fk,fk->f", a[at] - points[i], normal[at]).max()
        off[i] = max(planes, distance[i] / 1.8) - depth[i]
    return off


def is_on_middle(point, facets, within=0.02):
    """Whether two sides that face away from each other are as far as the nearest one: there a sheet is between the
    layers of both."""
    nearest = distances(point[None], facets)[0]
    reach = nearest * (1 + within)
    box = np.all((facets.min(axis=1) < point + reach) & (facets.max(axis=1) > point - reach), axis=1)
    at = [f for f in np.flatnonzero(box) if distances(point[None], facets[f:f + 1])[0] < reach]
    normal = np.cross(facets[at, 1] - facets[at, 0], facets[at, 2] - facets[at, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return (normal @ normal.T).min() < -0.5


def layer_faults(case, folder, expected):
    """Yields a line for everything that is wrong about a wall in layers."""
    values, arrays = read_bi4(case + ".bi4")
    picture = read_vtk(case + "_All.vtk")
    dp, positions = values["Dp"], arrays["Posd"]
    layer, mk = np.asarray(picture["Layer"]).ravel(), np.asarray(picture["Mk"]).ravel()
    facets = read_stl(os.path.join(folder, expected["mesh"])) @ np.array(expected["turn"]).T
    facets += np.array(expected["move"])
    wall = sample(np.flatnonzero((layer > 0) & (mk == expected["mk"])))
    off = layer_depths(positions[wall], (layer[wall] - 0.5) * dp, facets) / dp
    for i in np.flatnonzero(np.abs(off) > 1e-4):
        if is_on_middle(positions[wall][i], facets):
            off[i] = 0
    if np.abs(off).max() > 1e-4:
        yield (f"particles of layers are {off.min():.3g} to {off.max():.3g} dp off their depth, "
               f"{np.count_nonzero(np.abs(off) > 1e-4)} of {len(off)} by more than 1e-4")
    normals = arrays["BoundNor"][wall].astype(float)
    length = np.linalg.norm(normals, axis=1) / dp
    feet = distances(positions[wall] + normals, facets)[length > 0].max() / dp
    if feet > 1e-4:
        yield f"a normal ends {feet:.3g} dp from the mesh"
    if np.count_nonzero(length == 0) > 0:
        yield f"{np.count_nonzero(length == 0)} of {len(length)} particles of layers have no normal"
    body = mk == expected["mk"]
    volume, within = volume_of(facets), expected.get("volume_within", 0.01)
    if within is not None and abs(np.count_nonzero(body) * dp ** 3 / volume - 1) > within:
        yield f"the particles stand for {np.count_nonzero(body) * dp ** 3:.6g} m3, the body has {volume:.6g}"
    fluid = positions[mk == 1]
    near = fluid[np.all((fluid > facets.min(axis=(0, 1)) - dp) & (fluid < facets.max(axis=(0, 1)) + dp), axis=1)]
    # Before layers nodes stay from 0.1 dp on; the first layer is half a dp behind.
    inside = np.count_nonzero(is_inside(near, facets))
    if inside > 0:
        yield f"{inside} particles of fluid are in the wall"
    nearest = distances(near, facets).min() / dp
    if nearest < 0.1:
        yield f"fluid stands {nearest:.3g} dp from the mesh"
    nearest = nearest_between(near, positions[body]) / dp
    if nearest < 0.5:
        yield f"fluid stands {nearest:.3g} dp from a particle of the wall"
    if "period" in expected:
        yield from period_faults(values, positions, expected["period"])
    yield from differences(summarise(case), expected["counts"], is_same)


def period_faults(values, positions, period):
    dp, low, high = values["Dp"], values["CasePosMin"], values["CasePosMax"]
    if abs(high[0] - low[0] + dp - period[0]) > 1e-9:
        yield f"the solver takes {high[0] - low[0] + dp:.9g} m for the period, expected {period[0]:.9g}"
    steps = (positions[:, 0] - low[0]) / dp
    if steps.min() < -0.5 - 1e-5 or steps.max() > period[0] / dp - 0.5:
        yield f"particles from {steps.min():.6g} to {steps.max():.6g} dp along x are not of one period"
    if steps.min() > -0.4 or steps.max() < period[0] / dp - 0.6:
        yield f"particles from {steps.min():.6g} to {steps.max():.6g} dp along x do not fill the period"
    begin, end = positions[steps < 1] + period, positions[steps > period[0] / dp - 2]
    nearest = min(np.linalg.norm(end - p, axis=1).min() for p in begin) / dp
    if nearest < 0.499:
        yield f"two particles are {nearest:.3g} dp apart across the period"


def faults(case, folder, expected):
    """Yields a line for everything about the particles that is wrong."""
    if "layers" in expected["counts"]:
        yield from layer_faults(case, folder, expected)
        return
    values, arrays = read_bi4(case + ".bi4")
    picture = read_vtk(case + "_All.vtk")
    dp, positions = values["Dp"], arrays["Posd"]
    kind, mk = np.asarray(picture["Kind"]).ravel(), np.asarray(picture["Mk"]).ravel()
    if "bodies" in expected:
        for record in expected["bodies"]:
            yield from body_faults(record, folder, dp, positions, kind, mk)
        yield from differences(summarise(case), expected["counts"], is_same)
        return
    parts = []
    for part in expected.get("parts", [expected]):
        facets = read_stl(os.path.join(folder, part["mesh"])) @ np.array(part["turn"]).T
        parts.append((part["mk"], facets * part.get("scale", 1) + np.array(part["move"])))
    body = np.isin(mk, [part_mk for part_mk, _ in parts])

    depth = expected.get("depth", 0)
    wall = body & (kind < VOLUME)
    wall_sample = sample(np.flatnonzero(wall))
    for part_mk in sorted({part_mk for part_mk, _ in parts}):
        own = np.concatenate([facets for k, facets in parts if k == part_mk])
        of_mk = positions[wall_sample[mk[wall_sample] == part_mk]]
        off = np.abs(distances(of_mk, own) / dp - depth).max()
        if off > 1e-4:
            yield f"a wall particle of mk {part_mk} is {off:.3g} dp off its place"
    if len(parts) > 1:
        for i, (_, facets) in enumerate(parts):
            within = positions[wall_sample][is_inside(positions[wall_sample], facets)]
            deepest = distances(within, facets).max() / dp if len(within) else 0
            if deepest > 1e-4:
                yield f"a wall particle is {deepest:.3g} dp inside part {i}"
    inside = np.count_nonzero(body & (kind == VOLUME))
    stands_for = (inside + (1 if depth else 0.5) * np.count_nonzero(wall)) * dp ** 3
    volume = expected["volume"] if len(parts) > 1 else volume_of(parts[0][1])
    if abs(stands_for / volume - 1) > (0.001 if depth else 0.01):
        yield f"the particles stand for {stands_for:.6g} m3, the body has {volume:.6g}"
    fluid = positions[mk == 1]
    every = np.concatenate([facets for _, facets in parts])
    low, high = every.min(axis=(0, 1)) - dp, every.max(axis=(0, 1)) + dp
    near = fluid[np.all((fluid > low) & (fluid < high), axis=1)]
    nearest = distances(sample(near), every).min() / dp
    if nearest < expected.get("fluid_from", 0.5) - 0.001:
        yield f"fluid stands {nearest:.3g} dp from the mesh"
    with open(case + ".xml", encoding="utf-8") as file:
        turns = [float(v) for v in re.findall(r'<vel ang="([-+.\de]+)"', file.read())]
    if turns != expected.get("turns", turns):
        yield f"rotations at {turns}, expected {expected['turns']}"
    yield from differences(summarise(case), expected["counts"], is_same)


if __name__ == "__main__":
    sys.exit(check(sys.argv[1:], __doc__, summarise, "expected_fitted.json", faults))
