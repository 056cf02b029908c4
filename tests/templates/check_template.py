#!/usr/bin/python3
"""Runs the program on a case template: exit code 0, the files that GenCase writes too, its particle counts.

    check_template.py PROGRAM TEMPLATES_FOLDER NAME WORK_FOLDER                 run and compare
    check_template.py PROGRAM TEMPLATES_FOLDER NAME WORK_FOLDER --refused TEXT  the program must refuse the template
    check_template.py --summary OUT_FOLDER                                      what expected.json holds of a folder of results

expected.json beside this script holds what GenCase v5.4 wrote for NAME_Def.xml: for every particle file
(one, or one a region of <vres>) type, mk and number of particles, and the endings of all files. Templates
of what only this program has are run twice: with -fit:off they give GenCase's counts, then the function of
this script that has their name looks at the particles. What GenCase refuses ("refused") has counts of this
program's own.
"""

import glob
import json
import os
import shutil
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))
sys.path.insert(0, os.path.join(HERE, "..", "cases"))
sys.dont_write_bytecode = True
from check_fitted_case import VOLUME, distances, is_inside, read_stl  # noqa: E402 (found by the path above)
from particle_files import read_bi4, read_blocks, read_vtk  # noqa: E402


def summarise(folder, name):
    """Particle counts of every file of particles, and the endings of all files, of a folder of results."""
    endings = sorted(f[len(name):] for f in os.listdir(folder) if f.startswith(name))
    # The log is no result, nor are pictures for the debugging of GenCase.
    endings = [e for e in endings if e != ".out" and not e.startswith("_dbg-")]
    blocks = {}
    for ending in endings:
        if ending.endswith(".xml"):
            case = ending[:-len(".xml")]
            blocks[case] = [[b["type"], b["mk"], b["count"]] for b in read_blocks(os.path.join(folder, name + ending))]
    return {"blocks": blocks, "files": endings}


def run(program, folder, name, work, *options):
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    done = subprocess.run([program, name + "_Def", os.path.join(work, name), "-save:all", *options], cwd=folder,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return done.returncode, done.stdout


# --- Templates of what only this program has ---


class Result:
    """The particles of a run."""

    def __init__(self, folder, case):
        self.folder = folder
        values, self.arrays = read_bi4(case + ".bi4")
        self.dp, self.positions = values["Dp"], self.arrays["Posd"]
        self.mk = np.concatenate([np.full(b["count"], b["mk"]) for b in read_blocks(case + ".xml")])
        picture = read_vtk(case + "_All.vtk")
        self.volume = np.asarray(picture["Volume"]).ravel() if "Volume" in picture else None
        self.kind = np.asarray(picture["Kind"]).ravel() if "Kind" in picture else None

    def mesh(self, file, move):
        return read_stl(os.path.join(self.folder, "data", file)) + np.array(move)

    def walls(self, mk):
        return self.positions[(self.mk == mk) & (self.kind < VOLUME)]

    def steps_off_lattice(self, points):
        """How far from the nearest lattice node, dp; the lattice goes through 0."""
        steps = points / self.dp
        return np.linalg.norm(steps - np.rint(steps), axis=1)


def stand_on(result, mk, file, move):
    wall = result.walls(mk)
    if len(wall) == 0:
        yield f"mk {mk} has no particle on a surface"
        return
    farthest = distances(wall, result.mesh(file, move)).max() / result.dp
    if farthest > 1e-4:
        yield f"a particle of mk {mk} is {farthest:.3g} dp off {file}"


def check_BodyFitted(result):
    part, ball = ("part.stl", (0.31, 0.12, 0.13)), ("ball.stl", (0.83, 0.49, 0.34))
    yield from stand_on(result, 11, *part)
    yield from stand_on(result, 12, *ball)
    fluid = result.positions[result.mk == 1]
    for mesh, clearance in ((part, 0.5), (ball, 0.6)):
        nearest = distances(fluid, result.mesh(*mesh)).min() / result.dp
        if nearest < clearance - 1e-3:
            yield f"fluid stands {nearest:.3g} dp from {mesh[0]}, expected {clearance} at least"
    if result.steps_off_lattice(result.positions[result.mk == 10]).max() > 1e-6:
        yield "the tank, which is not fitted, is off the lattice"


def check_BodyFittedRelax(result):
    yield from stand_on(result, 11, "part.stl", (0.31, 0.12, 0.13))


def check_FittedNormals(result):
    mesh = result.mesh("part.stl", (0.31, 0.12, 0.13))
    yield from stand_on(result, 11, "part.stl", (0.31, 0.12, 0.13))
    normals = result.arrays["BoundNor"].astype(float)
    length = np.linalg.norm(normals, axis=1)
    wall = result.kind < VOLUME
    if not np.allclose(length[wall], 0.01 * result.dp, rtol=1e-3):
        yield "a normal on the surface is not 0.01 dp long"
    outwards = normals[wall] / length[wall, None]
    away = result.positions[wall] + 0.2 * result.dp * outwards
    if not np.all(distances(away, mesh) > 0.1 * result.dp) or np.any(is_inside(away, mesh)):
        yield "a normal on the surface does not lead out of the part"
    below = ~wall
    if distances(result.positions[below] + normals[below], mesh).max() > 1e-4 * result.dp:
        yield "a normal below the surface does not lead to it"


def check_FittedLayers(result):
    ball = result.mesh("ball.stl", (0.83, 0.39, 0.54))
    normals = result.arrays["BoundNor"].astype(float)
    bound = np.flatnonzero((result.mk > 10) & (result.kind < VOLUME))
    for mk, layers, depth in ((11, 3, lambda p: distances(p, ball)), (12, 4, lambda p: 0.21 - p[:, 2])):
        own = bound[result.mk[bound] == mk]
        positions = result.positions[own]
        steps = depth(positions) / result.dp
        for k in range(layers):
            if np.count_nonzero(abs(steps - k - 0.5) < 1e-3) < 50:
                yield f"mk {mk}: no layer stands {k + 0.5} dp behind the surface"
        if np.abs(steps - np.rint(steps - 0.5) - 0.5).max() > 1e-3 or steps.max() > layers:
            yield f"mk {mk}: particles stand between the layers"
        if np.abs(depth(positions + normals[own])).max() > 1e-3 * result.dp:
            yield f"mk {mk}: a normal does not lead to the surface"
        if np.abs(np.linalg.norm(normals[own], axis=1) / result.dp - steps).max() > 1e-3:
            yield f"mk {mk}: a normal is not the shortest way to the surface"
    if not np.all(is_inside(result.positions[result.mk == 11], ball)):
        yield "a particle of the ball is outside of it"


def check_FittedInside(result):
    ball = result.mesh("ball.stl", (0.83, 0.39, 0.34))
    cell = result.dp ** 3
    inner = result.positions[result.mk == 11]
    shell = result.walls(11)
    if np.abs(distances(shell, ball) / result.dp - 0.5).max() > 1e-3 or not np.all(is_inside(inner, ball)):
        yield "a particle on the outside of the ball is not half a dp below its surface"
    a, b, c = ball[:, 0], ball[:, 1], ball[:, 2]
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    if abs(len(inner) * cell - volume) > cell:
        yield f"{len(inner)} particles of dp^3 are {len(inner) * cell:.6g} m3, the ball has {volume:.6g}"
    if np.linalg.norm(inner.mean(axis=0) - (0.83, 0.39, 0.34)) > 0.01 * result.dp:
        yield "the particles have another centre than the ball"
    own = result.volume[result.mk == 11]
    if abs(own.sum() / volume - 1) > 1e-9 or own.min() < 0.3 * cell or own.max() > 2 * cell:
        yield "the volumes of the particles are not parts of the ball"
    plate = result.positions[result.mk == 12]
    if abs(len(plate) * cell - 0.87 * 0.53 * 0.17) > 1.5 * cell:
        yield f"the plate has {len(plate)} particles, expected {0.87 * 0.53 * 0.17 / cell:.1f}"
    sheets = np.array([0.61 + (k + 0.5) * 0.17 / 4 for k in range(4)])
    in_middle = np.all(abs(plate[:, :2] - (0.545, 0.385)) < 0.1, axis=1)
    off = abs(plate[in_middle][:, 2, None] - sheets).min(axis=1)
    if len(off) < 20 or off.max() > 1e-3 * result.dp:
        yield "the particles of the plate do not stand in four sheets"


def check_FittedPlates(result):
    heights = result.positions[result.mk == 11][:, 2]
    if not np.all(np.isclose(abs(heights - 0.21), 0.005, atol=1e-5)):
        yield "plates=\"both\": a particle stands on neither face"
    heights = result.positions[result.mk == 12][:, 2]
    if np.ptp(heights) > 1e-5 or not np.isclose(abs(heights[0] - 0.61), 0.005, atol=1e-5):
        yield "plates=\"one\": the particles stand not on one face"


def check_FluidBand(result):
    yield from stand_on(result, 11, "shaft.stl", (0.61, 0.42, 0.33))
    fluid = result.positions[result.mk == 1]
    depth = distances(fluid, result.mesh("shaft.stl", (0.61, 0.42, 0.33))) / result.dp
    off = result.steps_off_lattice(fluid)
    if not off[depth < 1.5].max() > 0.05:
        yield "no fluid near the wall was moved"
    if off[depth > 4.5].max() > 1e-6:
        yield "fluid beyond the band was moved"


def check_FillInside(result):
    def in_part(p):
        return np.all((p > 1e-9) & (p < (0.6 - 1e-9, 0.6 - 1e-9, 0.3 - 1e-9)), axis=1) & ~((p[:, 0] > 0.25 - 1e-9) & (p[:, 1] > 0.25 - 1e-9))

    def in_block(p):
        return np.all(abs(p) < 0.2 - 1e-9, axis=1)

    nodes = np.stack(np.meshgrid(*(np.arange(-2, n) for n in (26, 18, 18)), indexing="ij"), -1).reshape(-1, 3)
    for mk, place, is_in in ((10, (0.1, 0.1, 0.1), in_part), (11, (0.1, 0.1, 0.5), in_part),
                             (12, (1, 0.3, 0.2), in_block), (13, (1, 0.6, 0.65), in_block)):
        # Nodes on a face are on the shell, which is drawn too.
        inside = is_in((nodes * result.dp - np.array(place)))
        found = {tuple(n) for n in np.rint(result.positions[result.mk == mk] / result.dp).astype(int)}
        empty = [tuple(n) for n in nodes[inside] if tuple(n) not in found]
        if empty:
            yield f"mk {mk}: {len(empty)} nodes inside are empty, first {empty[0]}"
        if mk in (10, 11):
            local = result.positions[result.mk == mk] - np.array(place)
            in_notch = np.all(local[:, :2] > 0.25 + result.dp, axis=1)
            if in_notch.any():
                yield f"mk {mk}: {np.count_nonzero(in_notch)} particles stand in the notch"


def check_FillCavity(result):
    # Boxes of 7, 5 and 5 nodes along x inside, 7 along y and z.
    for mk, count, axis, top in ((1, 4 * 49, 2, 0.2), (2, 4 * 35, 2, 0.2), (3, 2 * 49, 0, 1.0)):
        fluid = result.positions[result.mk == mk]
        if len(fluid) != count:
            yield f"fluid {mk}: {len(fluid)} particles, expected {count}"
        elif abs(fluid[:, axis].max() - top) > 1e-9:
            yield f"fluid {mk} reaches to {fluid[:, axis].max()}, expected {top}"


def check_Points(result):
    file = os.path.join(result.folder, "data", "points.csv")
    points = np.loadtxt(file, delimiter=";", skiprows=1)
    c, s = np.cos(np.radians(30)), np.sin(np.radians(30))
    turned = 0.5 * points @ np.array(((c, s, 0), (-s, c, 0), (0, 0, 1)))
    for mk, wanted in ((11, points + (0.5, 0.5, 0.25)), (1, turned + (0.7, 0.2, 0.53))):
        found = result.positions[result.mk == mk]
        if len(found) != len(wanted):
            yield f"mk {mk}: {len(found)} particles, expected {len(wanted)}"
            continue
        gaps = np.linalg.norm(wanted[:, None, :] - found[None, :, :], axis=2).min(axis=1)
        if gaps.max() > 1e-6:
            yield f"mk {mk}: a point of the file is {gaps.max()} m from every particle"


def check_Boolean(result):
    def from_axis(p):
        return np.hypot(p[:, 0] - 0.41, p[:, 1] - 0.37)

    block = from_axis(result.positions[result.mk == 11])
    if len(block) == 0 or block.min() < 0.14 - 0.6 * result.dp:
        yield "the hole of the block is not empty"
    plug = result.positions[result.mk == 12]
    if np.count_nonzero(from_axis(plug) < 0.14 - 0.6 * result.dp) < 100:
        yield "what block and hole share is not filled"


def check_InitialVelocityProfile(result):
    fluid, speed = result.positions[result.mk == 1], result.arrays["Vel"][result.mk == 1]
    z = fluid[:, 2]
    linear = fluid[:, 0] < 0.6 - 1e-6
    wanted = 0.1 + 0.2 * (z - 0.05) / 0.25
    if not np.allclose(speed[linear, 0], wanted[linear], atol=1e-5):
        yield "velocity2 is not the line between its two values"
    rest = fluid[:, 0] > 0.6 + 1e-6
    for height, value in ((0.05, 0.1), (0.2, 0.2), (0.35, 0.25)):
        at = rest & np.isclose(z, height)
        if not at.any() or not np.allclose(speed[at, 0], value, atol=1e-5):
            yield f"velocity3 is not {value} at z = {height}"


CHECKS = {name[len("check_"):]: f for name, f in list(globals().items()) if name.startswith("check_")}


def differences(found, wanted):
    for case, blocks in wanted["blocks"].items():
        if found["blocks"].get(case) != blocks:
            yield f"particles{case}: expected {blocks}, found {found['blocks'].get(case)}"
    for file in sorted(set(wanted["files"]) - set(found["files"])):
        yield f"the file {file} is missing"


def check(program, folder, name, work):
    with open(os.path.join(HERE, "expected.json"), encoding="utf-8") as file:
        expected = json.load(file)
    wanted = expected["templates"][name]
    options = ["-fit:off"] if wanted.get("fit") == "off" else []
    code, text = run(program, folder, name, work, *options)
    if code != 0:
        yield f"the program stopped with {code}:\n{text}"
        return
    found = summarise(work, name)
    if wanted.get("own"):  # GenCase passes over what makes these particles
        wanted = {"blocks": {}, "files": wanted["files"]}
    yield from differences(found, wanted)
    if name not in CHECKS:
        return
    if options:
        code, text = run(program, folder, name, work)
        if code != 0:
            yield f"the program stopped with {code}:\n{text}"
            return
        missing = set(wanted.get("own_files", [])) - set(summarise(work, name)["files"])
        if missing:
            yield f"files are missing: {sorted(missing)}"
    yield from CHECKS[name](Result(folder, os.path.join(work, name)))


def check_refusal(program, folder, name, work, wanted):
    code, text = run(program, folder, name, work)
    if code == 0:
        yield "is supported now; take it off not_yet.txt"
    elif code != 3 or wanted not in text:
        yield f"expected exit code 3 and \"{wanted}\", found {code} and:\n{text}"
    left = [f for f in glob.glob(os.path.join(glob.escape(work), name + "*")) if not f.endswith(".out")]
    if code != 0 and left:
        yield f"files were written: {left}"


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "--summary":
        name = os.path.basename(os.path.normpath(arguments[1]))
        print(json.dumps(summarise(arguments[1], name)))
        return 0
    if len(arguments) not in (4, 6) or (len(arguments) == 6 and arguments[4] != "--refused"):
        sys.exit(__doc__)
    program, folder = os.path.abspath(arguments[0]), os.path.abspath(arguments[1])
    name, work = arguments[2], os.path.abspath(arguments[3])
    if len(arguments) == 6:
        lines = list(check_refusal(program, folder, name, work, arguments[5]))
    else:
        lines = list(check(program, folder, name, work))
    for line in lines:
        print(f"{name}: {line}")
    print(f"{name}: {len(lines)} faults")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
