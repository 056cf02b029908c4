#!/usr/bin/python3
"""STEP files from the CAD model to particles, against formulas.

    check_step.py PROGRAM FOLDER NAME     runs the test of this name
    check_step.py PROGRAM FOLDER --table  runs the measuring ones and prints what they found

FOLDER/models holds the files of make_step_models, and known.json what the formulas say of them. Lengths
here are metres, as in the case.
"""

import json
import os
import re
import shutil
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tools"))
sys.dont_write_bytecode = True
from particle_files import read_bi4, read_blocks, read_vtk  # noqa: E402 (found by the path above)

SKIPPED = 77
PARTS = ("cylinder", "torus", "gear", "block", "roof")
VOLUME = 3  # kind of particles that stand on no surface
found_table = []


def note(what, value):
    found_table.append((what, value))


class Work:
    def __init__(self, program, folder, name):
        self.program, self.models = program, os.path.join(folder, "models")
        self.folder = os.path.join(folder, "work_" + name)
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        known = os.path.join(self.models, "known.json")
        self.known = json.load(open(known, encoding="utf-8")) if os.path.exists(known) else {}

    def step(self, name):
        return os.path.join(self.models, name + ".step")

    def run(self, *arguments, **more):
        done = subprocess.run([self.program, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False, **more)
        return done.returncode, done.stdout

    def inspect(self, file, *options):
        code, text = self.run("inspect", file, "--json", *options)
        assert code == 0, text
        return json.loads(text)

    def case(self, name, draws, fppg="", dp=0.004, box=((-0.2, -0.25, -0.2), (0.25, 0.3, 0.2)), normals="", options=()):
        """Runs a case and returns its particles."""
        low, high = (" ".join(f'{axis}="{v}"' for axis, v in zip("xyz", p)) for p in box)
        with open(os.path.join(self.folder, name + "_Def.xml"), "w", encoding="utf-8") as file:
            file.write(f"""<?xml version="1.0" encoding="UTF-8" ?>
<case xmlns:fppg="urn:fppg"><casedef><constantsdef>
<gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" /><rhopgradient value="2" /><hswl value="0" auto="true" />
<gamma value="7" /><speedsystem value="0" auto="true" /><coefsound value="20" /><speedsound value="0" auto="true" />
<coefh value="1" /><cflnumber value="0.2" /></constantsdef><mkconfig boundcount="240" fluidcount="9" />
<geometry><definition dp="{dp}"><pointmin {low} /><pointmax {high} /></definition><commands><mainlist>
{draws}
</mainlist></commands></geometry>{normals}<fppg>{fppg}</fppg></casedef>
<execution><parameters><parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" />
<parameter key="TimeMax" value="0.1" /><parameter key="TimeOut" value="0.01" /></parameters></execution></case>
""")
        code, text = self.run(name + "_Def", os.path.join("out", name), "-save:all", *options)
        return Result(os.path.join(self.folder, "out", name), code, text)


class Result:
    def __init__(self, case, code, text):
        self.code, self.text, self.case = code, text, case
        if code != 0:
            return
        self.values, self.arrays = read_bi4(case + ".bi4")
        self.dp, self.positions = self.values["Dp"], self.arrays["Posd"]
        self.mk = np.concatenate([np.full(b["count"], b["mk"]) for b in read_blocks(case + ".xml")])
        picture = read_vtk(case + "_All.vtk")
        self.kind = np.asarray(picture["Kind"]).ravel() if "Kind" in picture else np.full(len(self.mk), VOLUME)
        self.normals = self.arrays["BoundNor"].astype(float) if "BoundNor" in self.arrays else None


# --- Exact distances with directions, metres; positive outside ---


def unit(v):
    return v / np.linalg.norm(v, axis=1)[:, None]


def of_torus(p, big, small):
    """Distance, unit normal of the surface nearest to each point."""
    radius = np.hypot(p[:, 0], p[:, 1])
    center = np.stack((p[:, 0] / radius * big, p[:, 1] / radius * big, 0 * radius), 1)
    out = p - center
    return np.linalg.norm(out, axis=1) - small, unit(out)


def of_tube(p, radius):
    flat = p * (1, 1, 0)
    return np.linalg.norm(flat, axis=1) - radius, unit(flat)


def degrees_between(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.sum(a * b, axis=1)))


def relative(found, wanted):
    return abs(found / wanted - 1)


# --- Tests: each yields what is wrong ---


def test_volumes_areas_and_edges(work):
    for name in PARTS:
        found = work.inspect(work.step(name))["cad_parts"]
        if len(found) != 1:
            yield f"{name}: {len(found)} parts, expected 1"
            continue
        part, known = found[0], work.known[name]
        for what, scale in (("volume", 1e-9), ("area", 1e-6), ("sharp_length", 1e-3)):
            wanted = known[what] * scale
            off = abs(part[what] - wanted) / wanted if wanted else abs(part[what])
            note(f"{name}: {what} off by", f"{off:.1e}")
            if off > 1e-6:
                yield f"{name}: {what} is {part[what]}, expected {wanted}"
        for what in ("sharp_edges", "smooth_edges"):
            if part[what] != known[what]:
                yield f"{name}: {part[what]} {what}, expected {known[what]}"


def test_assembly(work):
    """Five parts in their places, with the names of instances and parts, and colours."""
    parts = work.inspect(work.step("assembly"))["cad_parts"]
    wanted = {"wheel": ("gear", "#cc1a1a"), "axle": ("cylinder", "#1a991a"), "ring": ("torus", "#1a33e6"),
              "housing1": ("block", "#1a9933"), "lid": ("roof", "#1a33e6")}
    if [p["name"] for p in parts] != list(wanted):
        yield f"parts {[p['name'] for p in parts]}, expected {list(wanted)}"
        return
    for part in parts:
        known, color = work.known[wanted[part["name"]][0]], wanted[part["name"]][1]
        if relative(part["volume"], known["volume"] * 1e-9) > 1e-6 or relative(part["area"], known["area"] * 1e-6) > 1e-6:
            yield f"{part['name']}: volume {part['volume']}, area {part['area']}"
        near = np.abs([int(part["color"][k:k + 2], 16) - int(color[k:k + 2], 16) for k in (1, 3, 5)]).max()
        if near > 26:
            yield f"{part['name']}: colour {part['color']}, expected about {color}"
    # Where make_models.cpp puts them: the middle of each part, turned and moved.
    places = {"wheel": ((0, 0, 10), (1, 2, 3), 0.7, (100, 20, 30)), "axle": ((0, 0, 0), (1, 2, 3), 0.7, (100, 20, 30)),
              "ring": ((0, 0, 0), (1, 0, 0), 0.4, (-80, 0, 10)), "housing1": ((30, 20, 15), (0, 0, 1), 0.3, (0, 150, 0))}
    for part in parts:
        if part["name"] not in places:
            continue
        own, axis, angle, move = (np.array(v, float) for v in places[part["name"]])
        axis = axis / np.linalg.norm(axis)
        turned = own * np.cos(angle) + np.cross(axis, own) * np.sin(angle) + axis * np.dot(axis, own) * (1 - np.cos(angle))
        off = np.abs((turned + move) / 1000 - part["centre"]).max()
        if off > 1e-9:
            yield f"{part['name']}: its middle is {off} m from where it was put"


def test_features(work):
    """Lines are the CAD edges that bend: also one of 8 degrees, and none where faces are tangent."""
    for name in PARTS:
        found, known = work.inspect(work.step(name), "--dp", "0.002"), work.known[name]
        length = found["features"]["length"]
        wanted = known["sharp_length"] * 1e-3
        note(f"{name}: length of feature lines to that of CAD edges, dp 0.002", f"{length:.8g} / {wanted:.8g}")
        # Chords are shorter than arcs, by 0.01 dp of their height.
        if abs(length - wanted) > 2e-3 * wanted + 1e-12:
            yield f"{name}: feature lines of {length} m, the CAD edges that bend have {wanted}"
    found = work.inspect(work.step("roof"), "--dp", "0.002", "--angle", "15")
    if abs(found["features"]["length"] - (work.known["roof"]["sharp_length"] * 1e-3 - 0.04)) > 1e-9:
        yield "an angle of 15 that is asked for does not leave the ridge of 8 degrees out"


DRAWS = """<setdrawmode mode="full" />
<setmkbound mk="1" /><drawfilestep file="{0}/cylinder.step" autofill="true" />
<setmkbound mk="2" /><drawfilestep file="{0}/torus.step" autofill="true"><drawmove x="0" y="0.15" z="0" /></drawfilestep>
<setmkbound mk="3" /><drawfilestep file="{0}/gear.step" autofill="true"><drawmove x="0.1" y="0" z="0" /></drawfilestep>
<setmkbound mk="4" /><drawfilestep file="{0}/block.step" autofill="true"><drawmove x="0.1" y="0.15" z="0" /></drawfilestep>
<setmkbound mk="5" /><drawfilestep file="{0}/roof.step" autofill="true"><drawmove x="-0.15" y="-0.1" z="0" /></drawfilestep>
"""


def exact_of(work, p, mk):
    """Distances and normals to the nearest exact curved face of a part, by its mk."""
    k = work.known
    if mk == 11:
        return of_tube(p, k["cylinder_radius"] / 1000)
    if mk == 12:
        return of_torus(p - (0, 0.15, 0), k["torus_big"] / 1000, k["torus_small"] / 1000)
    if mk == 13:
        out = p - (0.1, 0, 0)
        faces = [of_tube(out, k[r] / 1000) for r in ("gear_tip", "gear_root", "gear_bore")]
        best = np.argmin([np.abs(f[0]) for f in faces], axis=0)
        distance = np.choose(best, [f[0] for f in faces])
        return distance, faces[0][1] * np.where(best == 2, -1, 1)[:, None]
    return None


def test_exact_walls(work):
    """Particles on the surface stand on the exact faces and edges; their normals are exact."""
    found = work.case("walls", DRAWS.format(work.models), '<bodyfitted mkbound="1-5" boundary="dbc" />')
    if found.code != 0:
        yield found.text
        return
    for mk, name in ((11, "cylinder"), (12, "torus")):
        own = found.positions[(found.mk == mk) & (found.kind < VOLUME)]
        distance, _ = exact_of(work, own, mk)
        if mk == 11:  # the covers are planes
            on_tube = (own[:, 2] > 1e-9) & (own[:, 2] < 0.08 - 1e-9)
            rim = (found.kind[(found.mk == mk) & (found.kind < VOLUME)] == 1)
            note("cylinder: particles on rims off the circle, dp", f"{np.abs(distance[rim]).max() / found.dp:.1e}")
            if not rim.any() or np.abs(distance[rim]).max() > 1e-7 * found.dp:
                yield "a particle on the rim of the cylinder is off its circle"
            distance = distance[on_tube]
        note(f"{name}: particles off the exact face, dp", f"{np.abs(distance).max() / found.dp:.1e}")
        if len(distance) < 100 or np.abs(distance).max() > 1e-7 * found.dp:
            yield f"{name}: a particle is {np.abs(distance).max() / found.dp:.2g} dp off the exact face"
    own = found.positions[(found.mk == 15) & (found.kind == 1)] - (-0.15, -0.1, 0)
    ridge = np.abs(own[:, 0] - 0.03) < 1e-9
    if np.count_nonzero(ridge) < 5:
        yield "no particles stand on the ridge of 8 degrees"
    own = found.positions[(found.mk == 14) & (found.kind < 2)] - (0.1, 0.15, 0)
    between = (own[:, 2] > 0.001) & (own[:, 2] < 0.029)
    if between.any():
        yield f"{np.count_nonzero(between)} particles of edges stand on tangent edges of the block"


def test_exact_layers(work):
    """Layers of mDBC: depths and normals by the exact faces, to 0.01 degrees."""
    fluid = """<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="-0.19" y="-0.24" z="-0.19" />
<size x="0.43" y="0.53" z="0.02" /></drawbox>"""
    found = work.case("layers", DRAWS.format(work.models) + fluid, '<bodyfitted mkbound="1-5" boundary="mdbc" />', dp=0.002)
    if found.code != 0:
        yield found.text
        return
    for mk, name in ((11, "cylinder"), (12, "torus"), (13, "gear")):
        at = (found.mk == mk) & (found.kind < VOLUME)
        own, given = found.positions[at], found.normals[np.flatnonzero(at)]
        distance, normal = exact_of(work, own, mk)
        length = np.linalg.norm(given, axis=1)
        # Those that look to a curved face, and to the inside of it: not to an edge.
        curved = degrees_between(given, normal) < 3
        foot = own + given
        if mk != 12:
            top = 0.08 if mk == 11 else 0.02
            curved &= (foot[:, 2] > 1e-6) & (foot[:, 2] < top - 1e-6)
        if mk == 13:  # within a tooth's arc
            share = np.degrees(np.arctan2(foot[:, 1], foot[:, 0] - 0.1)) % 15
            curved &= (share > 0.5) & (share < 14.5)
        off = degrees_between(given, normal)[curved]
        deep = np.abs(length - np.abs(distance))[curved] / found.dp
        note(f"{name}: normals of layers off, degrees (largest of {len(off)})", f"{off.max():.1e}")
        note(f"{name}: lengths of normals off the exact depth, dp", f"{deep.max():.1e}")
        if len(off) < 500:
            yield f"{name}: only {len(off)} normals look to a curved face"
        if off.max() > 0.01:
            yield f"{name}: a normal is {off.max()} degrees off, {np.count_nonzero(off > 0.01)} of {len(off)} above 0.01"
        if deep.max() > 1e-4:
            yield f"{name}: a normal is {deep.max()} dp too long or short"


def test_exact_layers_2d(work):
    """In a plane case layers see the lines in which exact faces meet it: a circle, an ellipse, and that of a torus."""
    known, fluid = work.known, """<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="-0.19" y="-1" z="-0.19" />
<size x="0.38" y="2" z="0.02" /></drawbox>"""
    half, dp = known["cylinder_length"] / 2000, 0.002
    for degrees in (90, 40):
        turn = np.radians(degrees)
        axis, middle = np.array((0, -np.sin(turn), np.cos(turn))), np.array((0, 0, 0.05))
        move = middle - half * axis
        draws = f"""<setdrawmode mode="full" /><setmkbound mk="1" />
<drawfilestep file="{work.models}/cylinder.step" autofill="true"><drawmove x="0" y="{move[1]}" z="{move[2]}" />
<drawrotate angx="{degrees}" angy="0" angz="0" /></drawfilestep><setmkbound mk="2" />
<drawfilestep file="{work.models}/torus.step" autofill="true"><drawmove x="0" y="0.009" z="-0.05" /></drawfilestep>"""
        found = work.case("plane", draws + fluid, '<bodyfitted mkbound="1-2" boundary="mdbc" />', dp=dp,
                          box=((-0.2, 0, -0.2), (0.2, 0, 0.2)))
        if found.code != 0:
            yield found.text
            return
        for mk, name in ((11, f"cylinder cut at {degrees} degrees"), (12, "torus")):
            at = (found.mk == mk) & (found.kind < VOLUME)
            given = found.normals[np.flatnonzero(at)]
            foot = found.positions[at] + given
            if mk == 11:
                own = foot - middle
                across = own - np.outer(own @ axis, axis)
                distance, normal = np.linalg.norm(across, axis=1) - known["cylinder_radius"] / 1000, unit(across)
            else:
                distance, normal = of_torus(foot - (0, 0.009, -0.05), known["torus_big"] / 1000, known["torus_small"] / 1000)
            slope = np.hypot(normal[:, 0], normal[:, 2])
            off = degrees_between(given, normal * (1, 0, 1))
            beside = np.abs(distance / slope) / dp
            note(f"2D, {name}: normals of layers off, degrees (largest of {len(off)})", f"{off.max():.1e}")
            if len(off) < 40 or off.max() > 0.01:
                yield f"{name}: a normal of {len(off)} is {off.max()} degrees off"
            if beside.max() > 1e-6:
                yield f"{name}: a normal ends {beside.max()} dp beside the exact line"


def test_lattice_normals(work):
    """norgeometry on the lattice: facets of the shape file stand for exact faces."""
    draw = """<setdrawmode mode="full" /><setshapemode>actual | bound</setshapemode>
<setactive drawpoints="{}" drawshapes="{}" /><setmkbound mk="2" />
<drawfilestep file="{}/torus.step" autofill="true"><drawmove x="0" y="0.15" z="0" /></drawfilestep>{}"""
    draws = (draw.format("false", "true", work.models, '<shapeout file="part" />')
             + draw.format("true", "false", work.models, ""))
    normals = """<normals active="true"><norgeometry><geometryfile file="[CaseName]_part_Actual.vtk" /><distanceh v="2" />
</norgeometry></normals>"""
    found = work.case("lattice", draws, dp=0.002, normals=normals)
    if found.code != 0:
        yield found.text
        return
    at = found.mk == 12
    distance, normal = exact_of(work, found.positions[at], 12)
    given = found.normals[np.flatnonzero(at)]
    inside = (np.linalg.norm(given, axis=1) > 0.1 * found.dp) & (distance < -0.1 * found.dp)
    off = degrees_between(given[inside], normal[inside])
    note(f"torus on the lattice: normals off, degrees (largest of {len(off)})", f"{off.max():.1e}")
    note("torus on the lattice: share within 0.01 degrees", f"{np.mean(off < 0.01):.4f}")
    if len(off) < 1000 or np.mean(off < 0.01) < 0.999:
        yield f"{np.count_nonzero(off > 0.01)} of {len(off)} normals are more than 0.01 degrees off, at most {off.max()}"


def test_boolean(work):
    """Of a Boolean of CAD parts the particles stand on the exact faces, and where these cross."""
    draws = f"""<setdrawmode mode="full" /><setmkbound mk="1" />
<drawfilestep file="{work.models}/block.step" autofill="true" fppg:name="block" />
<setmkbound mk="2" /><drawfilestep file="{work.models}/cylinder.step" autofill="true" fppg:name="drill">
<drawmove x="0.03" y="0.02" z="-0.01" /></drawfilestep>"""
    fppg = """<bodyfitted mkbound="1" boundary="dbc" /><boolean name="bored" op="difference"><part ref="block" />
<part ref="drill" /></boolean>"""
    found = work.case("bored", draws, fppg, dp=0.003)
    if found.code != 0:
        yield found.text
        return
    at = (found.mk == 11) & (found.kind < VOLUME)
    own, kind = found.positions[at] - (0.03, 0.02, 0), found.kind[at]
    distance, _ = of_tube(own, 0.01)
    bore = np.abs(distance) < 0.3 * found.dp
    rim = bore & (kind < 2)
    note("bored block: particles of the bore off the exact face, dp", f"{np.abs(distance[bore]).max() / found.dp:.1e}")
    if np.count_nonzero(bore) < 100 or np.abs(distance[bore]).max() > 1e-7 * found.dp:
        yield f"a particle of the bore is {np.abs(distance[bore]).max() / found.dp} dp off"
    heights = np.minimum(np.abs(own[rim, 2]), np.abs(own[rim, 2] - 0.03))
    if np.count_nonzero(rim) < 20 or heights.max() > 1e-9:
        yield "particles of the rims of the bore are not on both faces"


def test_parts_and_faults(work):
    file = work.step("assembly")

    def draw(parts, command="drawfilestep"):
        part = f' fppg:part="{parts}"' if parts else ""
        return f'<setdrawmode mode="full" /><setmkbound mk="1" /><{command} file="{file}"{part} fppg:fill="inside" />'

    counts = {}
    for parts in ("wheel", "axle", "drive1", "drive", "wheel, axle", "gear", ""):
        found = work.case("parts", draw(parts), dp=0.004)
        if found.code != 0:
            yield f"{parts}: {found.text}"
            return
        counts[parts] = found.positions
    for same in (("drive1", "drive"), ("drive1", "wheel, axle"), ("wheel", "gear")):
        if not np.array_equal(counts[same[0]], counts[same[1]]):
            yield f"{same[0]} and {same[1]} are not the same"
    if not len(counts["wheel"]) < len(counts["drive"]) < len(counts[""]):
        yield "parts have not fewer particles than all"
    if not np.array_equal(work.case("parts", draw("wheel", "drawfile"), dp=0.004).positions, counts["wheel"]):
        yield "drawfile draws another part than drawfilestep"
    found = work.case("fault", draw("whel"))
    for words in ("fault_Def.xml:7:", "<drawfilestep>", "no part named 'whel'", "wheel"):
        if found.code == 0 or words not in found.text:
            yield f"a part that is not there: \"{words}\" is missing in {found.text}"
    found = work.case("fault", '<drawfilestl file="x.stl" fppg:part="wheel" />')
    if "fppg:part" not in found.text or found.code == 0:
        yield f"fppg:part of an STL file: {found.text}"
    with open(os.path.join(work.folder, "wrong.step"), "w", encoding="utf-8") as wrong:
        wrong.write("no STEP\n")
    found = work.case("fault", '<setmkbound mk="1" /><drawfilestep file="wrong.step" />')
    if "is no STEP file" not in found.text or "fault_Def.xml:7:" not in found.text:
        yield f"a file that is no STEP: {found.text}"


def test_new_case(work):
    """`fppg new` draws each part from the file, in metres, and the case runs."""
    code, text = work.run("new", work.step("assembly"), "-o", "New_Def.xml", "--kind", "obstacle", "--speed", "1",
                          "--water", "0.1", "--dp", "0.011", "--no-picture")
    if code != 0:
        yield text
        return
    with open(os.path.join(work.folder, "New_Def.xml"), encoding="utf-8") as file:
        xml = file.read()
    for part in ("wheel", "axle", "ring", "housing1", "lid"):
        if f'fppg:part="{part}"' not in xml:
            yield f"the part {part} is not drawn from the STEP file"
    if "drawscale" in xml or "assembly.step" not in xml:
        yield "the parts are not drawn in metres, as STEP files are read"
    code, text = work.run("New_Def", os.path.join("out", "New"), "-save:all")
    if code != 0:
        yield text
        return
    found = Result(os.path.join(work.folder, "out", "New"), code, text)
    if len(np.unique(found.mk[found.kind < VOLUME])) < 5:
        yield "not all five parts have walls"


def test_colours(work):
    """CAD colours reach Case.xml, pictures and pages; of parts with one mk that of the largest area."""
    file = work.step("assembly")
    draw = ('<setmkbound mk="{0}" /><drawfilestep file="{1}" fppg:part="{2}" fppg:fill="inside">'
            '<drawmove x="0" y="{3}" z="0" /></drawfilestep>')
    box = '<setmkbound mk="7" /><drawbox><boxfill>solid</boxfill><point x="0.2" y="0" z="0" /><size x="0.03" y="0.03" z="0.03" /></drawbox>'
    found = work.case("colours", '<setdrawmode mode="full" />' + draw.format(1, file, "wheel", 0) + draw.format(2, file, "ring", 0)
                      + draw.format(3, file, "axle, wheel", -0.12) + box, options=("-save:all",))
    if found.code != 0:
        yield found.text
        return
    with open(found.case + ".xml", encoding="utf-8") as text:
        xml = text.read()
    given = dict(re.findall(r'mkbound="\d+" mk="(\d+)"[^>]* fppg:color="(#[0-9a-f]{6})"', xml))
    if {int(mk) for mk in given} != {11, 12, 13} or 'xmlns:fppg="' not in xml:
        yield f"Case.xml gives {given}, expected colours of 11, 12 and 13"
        return
    for mk, wanted in (("11", "#cc1919"), ("12", "#1933e5"), ("13", "#cc1919")):
        if given[mk] != wanted:
            yield f"mk {mk} has {given[mk]}, expected {wanted}"
    for name in ("colours", "colours_All.vtk", "colours.bi4"):
        code, text = work.run("render", os.path.join("out", name), "-o", "picture.png", "--size", "200x150")
        for mk, wanted in given.items():
            if code != 0 or not re.search(f"{wanted} +mk {mk}", text):
                yield f"render of {name}: no {wanted} of mk {mk} in {text}"
        if "#" not in text or re.search(f"({'|'.join(given.values())}) +mk 17", text):
            yield f"render of {name}: the box has a colour of a CAD part: {text}"
    code, text = work.run("render", os.path.join("out", "colours"), "-o", "picture.png", "--size", "200x150", "--color", "role")
    if code != 0 or any(colour in text for colour in given.values()):
        yield f"render --color role: {text}"
    code, text = work.run("report", os.path.join("out", "colours"), "-o", "page.html")
    with open(os.path.join(work.folder, "page.html"), encoding="utf-8") as page:
        scene = re.search(r'id="fppg-scene">(.*?)</script>', page.read(), re.S)
    if code != 0 or scene is None:
        print("the page has no 3-D view: this program was built without its script")
        return
    parts = json.loads(scene.group(1))["sets"][0]["parts"]
    shown = {re.match(r"mk (\d+)", part["label"]).group(1): part["colour"] for part in parts}
    for mk, wanted in given.items():
        if shown.get(mk) != wanted:
            yield f"the page shows mk {mk} in {shown.get(mk)}, expected {wanted}"


def test_mixed_folder(work):
    """A folder of STEP and STL files through new, check, inspect, batch and the solver's files."""
    parts = os.path.join(work.folder, "parts")
    os.makedirs(parts)
    shutil.copy(work.step("block"), parts)
    shutil.copy(work.step("cylinder"), parts)
    stl = os.path.join(parts, "plate.stl")  # in the files' millimetres, 1 mm over the ground
    corners = [(x, y, z) for x in (-60, 90) for y in (60, 80) for z in (1, 31)]
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    with open(stl, "w", encoding="utf-8") as file:
        file.write("solid plate\n")
        for q in quads:
            for facet in (q[:3], (q[0], q[2], q[3])):
                vertices = "".join("vertex %g %g %g\n" % corners[v] for v in facet)
                file.write(f"facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
        file.write("endsolid plate\n")
    code, text = work.run("new", "parts", "-o", "Mixed_Def.xml", "--kind", "obstacle", "--speed", "1", "--water", "0.05",
                          "--unit", "mm", "--dp", "0.005", "--allow-overlap")
    if code != 0 or not os.path.exists(os.path.join(work.folder, "Mixed.png")):
        yield f"new: {text}"
        return
    with open(os.path.join(work.folder, "Mixed_Def.xml"), encoding="utf-8") as file:
        xml = file.read()
    if xml.count("<drawfilestep ") != 2 or xml.count("<drawfilestl ") != 1:
        yield f"the definition has not two draws of STEP and one of STL: {xml}"
    code, text = work.run("inspect", os.path.join("parts", "cylinder.step"), "--dp", "0.005")
    if code != 0 or "CAD parts" not in text:
        yield f"inspect: {text}"
    code, text = work.run("batch", "Mixed_Def.xml", "--out", "batch", "--set", "Dp=0.005,0.006", "--jobs", "1")
    if code != 0:
        yield f"batch: {text}"
        return
    results = [os.path.join(folder, name) for folder, _, names in os.walk(os.path.join(work.folder, "batch"))
               for name in names if name.endswith(".bi4")]
    if len(results) != 2:
        yield f"batch made {results}, expected two cases: {text}"
    for result in results:
        mks = {block["mk"] for block in read_blocks(result[:-4] + ".xml") if block["count"] > 0}
        if len(mks) < 5:  # fluid, channel, three parts
            yield f"{result}: only mks {sorted(mks)}"
        code, text = work.run("check", result[:-4])
        if code != 0:
            yield f"check {result}: {text}"
    code, text = work.run("check", "Mixed_Def.xml", "--motion")
    if code != 0:
        yield f"check --motion: {text}"


def test_same_bytes(work):
    """Any number of threads gives the same, and so does the next run."""
    results = []
    for threads in (1, 2, 5, 2):
        found = work.case("same", DRAWS.format(work.models), '<bodyfitted mkbound="1-5" boundary="mdbc" />',
                          options=(f"-threads:{threads}",))
        if found.code != 0:
            yield found.text
            return
        results.append(open(found.case + ".bi4", "rb").read())
    if any(r != results[0] for r in results):
        yield "the particles depend on the number of threads"


def test_gmsh(work):
    """gmsh reads the same files: its volumes and areas, and edges."""
    gmsh = shutil.which("gmsh")
    if gmsh is None:
        print("gmsh is not installed: nothing to compare with")
        return SKIPPED
    for name in PARTS + ("assembly",):
        script = os.path.join(work.folder, name + ".geo")
        with open(script, "w", encoding="utf-8") as file:
            file.write(f"""SetFactory("OpenCASCADE");
Geometry.OCCTargetUnit = "MM";
Merge "{work.step(name)}";
v() = Volume "*"; s() = Surface "*";
volume = 0; area = 0;
For i In {{0:#v()-1}}
  volume += Mass Volume{{v(i)}};
EndFor
For i In {{0:#s()-1}}
  area += Mass Surface{{s(i)}};
EndFor
Printf("found %.17g %.17g %g", volume, area, #v());
""")
        done = subprocess.run([gmsh, script, "-"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        line = [text for text in done.stdout.splitlines() if "found " in text]
        if not line:
            yield f"{name}: gmsh says {done.stdout}"
            continue
        volume, area, solids = (float(v) for v in line[0].split("found ")[1].split())
        parts = work.inspect(work.step(name))["cad_parts"]
        ours = sum(p["volume"] for p in parts) * 1e9, sum(p["area"] for p in parts) * 1e6
        known = [sum(work.known[n][what] for n in (PARTS if name == "assembly" else [name])) for what in ("volume", "area")]
        off = max(relative(volume, ours[0]), relative(area, ours[1]), relative(volume, known[0]), relative(area, known[1]))
        note(f"{name}: gmsh's volume and area, ours and the formula's differ by", f"{off:.1e}")
        if off > 1e-6 or solids != len(parts):
            yield f"{name}: gmsh {volume} mm3, {area} mm2, {solids} solids; here {ours}, {len(parts)}"


def test_without_plugin(work):
    """A copy of the program without its plugins beside it."""
    alone = os.path.join(work.folder, "fppg")
    shutil.copy(work.program, alone)
    work.program = alone
    template = os.path.join(HERE, "..", "..", "xml-templates", "data", "drum_and_ring.step")
    found = work.case("fault", f'<setmkbound mk="1" /><drawfilestep file="{template}" fppg:part="ring" />')
    for words in ("fault_Def.xml:7:", "<drawfilestep file=", "libfppg_step.so", "OpenCASCADE", "STL"):
        if found.code == 0 or words not in found.text:
            yield f"\"{words}\" is missing in: {found.text}"
    code, text = work.run("inspect", template)
    if code == 0 or "OpenCASCADE" not in text:
        yield f"inspect: {text}"


TESTS = {name[len("test_"):]: f for name, f in list(globals().items()) if name.startswith("test_")}


def run_test(program, folder, name):
    faults = TESTS[name](Work(program, folder, name))
    lines = []
    iterator = iter(faults)
    while True:
        try:
            lines.append(next(iterator))
        except StopIteration as end:
            if end.value == SKIPPED:
                return SKIPPED
            break
    for line in lines:
        print(line)
    return 1 if lines else 0


def main(arguments):
    if len(arguments) != 3:
        sys.exit(__doc__)
    program, folder, name = arguments
    program, folder = os.path.abspath(program), os.path.abspath(folder)
    if name != "--table":
        return run_test(program, folder, name)
    worst = 0
    for one in TESTS:
        found_table.clear()
        code = run_test(program, folder, one)
        worst = max(worst, code if code != SKIPPED else 0)
        for what, value in found_table:
            print(f"| {what} | {value} |")
    return worst


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
