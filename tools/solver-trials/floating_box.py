#!/usr/bin/python3
"""A tilted box afloat in the DualSPHysics v5.4 solver, in 2D, against linear theory.

    floating_box.py --fppg FPPG --solver SOLVER --work DIR [--library-path FOLDER] [--dp 0.0125] [--variant lattice-dbc,inside]
                    [--again]

The box, 0.3 x 0.1 m and half as heavy as water, is let go in a tank 1.5 m wide and 0.3 m deep, tilted by 10 degrees and
10 mm too deep. It rolls and heaves, sends waves out, and comes to rest level and half in water. Judged are its mass (over the
true one), draught and tilt (means over the last second) and the periods of roll and heave (from where they pass their means).

Theory: the box's equations of motion with added mass and damping of a wave that goes out from it, in water of that depth,
by finite volumes of potential flow; roll is coupled with sway. Walls send waves back to the box after about 2 s.

lattice-dbc   what GenCase makes of it: dynamic boundaries, box and tank on the lattice
lattice-mdbc  the same with modified boundaries, normals from the drawn shapes, walls half a dp from the surface
surface-dbc   particles on the true surface
inside        dynamic boundaries, the box's particles inside it, half a dp behind its faces
layers        modified boundaries, layers behind the true surface
"""

import argparse
import glob
import math
import os
import subprocess
import sys

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from case_xml import read_xml  # noqa: E402 (found by the path above)
from particle_files import read_bi4, read_blocks  # noqa: E402

BREADTH, HEIGHT, DENSITY = 0.3, 0.1, 500.0  # m, m, kg/m^3
TANK, LEVEL, RIM = 1.5, 0.3, 0.42           # width, depth of the water, height, m
TILT, DEEPER, TIME = 10.0, 0.01, 2.0        # degrees, m, s
GRAVITY, WATER = 9.81, 1000.0
DRAUGHT = HEIGHT * DENSITY / WATER
MASS = DENSITY * BREADTH * HEIGHT
INERTIA = MASS * (BREADTH**2 + HEIGHT**2) / 12
VARIANTS = ("lattice-dbc", "lattice-mdbc", "surface-dbc", "inside", "layers")


def radiation(omega, cell=0.005, reach=2.0):
    """Added mass + i damping / omega (3, 3) of sway, heave and roll about the middle of the box, per m, at a frequency, 1/s.

    One half of the fluid in square cells; the box's faces lie between cells. Time goes as exp(-i omega t).
    """
    nx, nz = round(reach / cell), round(LEVEL / cell)
    half, deep = round(BREADTH / 2 / cell), round(DRAUGHT / cell)
    number = -np.ones((nx, nz), int)  # of a cell; z from the floor up
    wet = np.ones((nx, nz), bool)
    wet[:half, nz - deep:] = False
    number[wet] = np.arange(wet.sum())
    k = wave_number(omega)
    surface = omega**2 / GRAVITY
    out = np.zeros((3, 3), complex)
    faces, normals = [], []  # cells at the box, and sway, heave, roll of their faces
    for i in range(half):
        faces.append(number[i, nz - deep - 1])
        normals.append((0.0, -1.0, (i + 0.5) * cell))
    for j in range(nz - deep, nz):
        faces.append(number[half, j])
        z = (j + 0.5) * cell - LEVEL - (HEIGHT / 2 - DRAUGHT)
        normals.append((1.0, 0.0, z))
    faces, normals = np.array(faces), np.array(normals)
    for is_odd, modes in ((True, (0, 2)), (False, (1,))):
        rows, columns, values = [], [], []

        def link(a, b):
            for i, j, v in ((a, a, -1.0), (a, b, 1.0), (b, b, -1.0), (b, a, 1.0)):
                rows.append(i), columns.append(j), values.append(np.full(len(a), v, complex))

        def put(a, v):
            rows.append(a), columns.append(a), values.append(np.full(len(a), v, complex))

        for a, b in ((number[:-1], number[1:]), (number[:, :-1], number[:, 1:])):
            both = (a >= 0) & (b >= 0)
            link(a[both], b[both])
        put(number[half:, -1], surface * cell / (1 - surface * cell / 2))
        put(number[-1], 1j * k * cell)
        if is_odd:  # nothing on the middle line, half a cell away
            middle = number[0]
            put(middle[middle >= 0], -2.0)
        matrix = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))).tocsc()
        for mode in modes:
            flux = np.zeros(matrix.shape[0], complex)
            np.add.at(flux, faces, normals[:, mode] * cell)  # the box moves out: what enters the cells
            potential = spsolve(matrix, -flux)
            for other in modes:
                out[other, mode] = 2 * WATER * (potential[faces] * normals[:, other] * cell).sum()
    return out if out[1, 1].real > 0 else -out


def wave_number(omega):
    k = omega**2 / GRAVITY
    for _ in range(50):
        k -= (GRAVITY * k * math.tanh(k * LEVEL) - omega**2) / (
            GRAVITY * (math.tanh(k * LEVEL) + k * LEVEL / math.cosh(k * LEVEL) ** 2))
    return k


def theory():
    """Periods of roll and heave, s, by the roots of the equations of motion."""
    metacentre = BREADTH**2 / 12 / DRAUGHT + DRAUGHT / 2 - HEIGHT / 2
    springs = {"roll": MASS * GRAVITY * metacentre, "heave": WATER * GRAVITY * BREADTH}
    periods = {}
    for name, spring in springs.items():
        omega = 8.0 + 0j
        for _ in range(30):
            added = radiation(omega.real)
            if name == "heave":
                inertia = MASS + added[1, 1]
            else:
                inertia = INERTIA + added[2, 2] - added[0, 2] * added[2, 0] / (MASS + added[0, 0])
            before, omega = omega, np.sqrt(spring / inertia)
            if abs(omega - before) < 1e-4:
                break
        periods[name] = 2 * math.pi / omega.real
    return periods


def box_at(low, high, name=""):
    """A filled box in the plane, m."""
    words = f' fppg:name="{name}"' if name else ""
    (x, z), (x1, z1) = low, high
    return f"""<drawbox{words}><boxfill>solid</boxfill><point x="{x:.12g}" y="-1" z="{z:.12g}" />
<endpoint x="{x1:.12g}" y="1" z="{z1:.12g}" /></drawbox>"""


def middle_at_start():
    return np.array((TANK / 2 + 0.0031, LEVEL - DEEPER + HEIGHT / 2 - DRAUGHT))


def floating_box():
    """The box, its side at large x down."""
    x, z = middle_at_start()
    half = BREADTH / 2, HEIGHT / 2
    return (f'<statesave /><move x="{x:.12g}" y="0" z="{z:.12g}" /><rotate ang="{-TILT:g}" x="0" y="1" z="0" />' +
            box_at((-half[0], -half[1]), half) + "<stateload />")


def definition(variant, dp):
    is_fitted = not variant.startswith("lattice")
    is_mdbc = variant in ("lattice-mdbc", "layers")
    wall = 4 * dp
    outer = (-wall, -wall), (TANK + wall, RIM)
    # Nodes on the surface are those of the wall, as GenCase's users draw it; between them and under mDBC it lies half-way.
    inset = dp / 2 if variant == "lattice-dbc" else 0
    inner = (inset, inset), (TANK - inset, RIM + wall)
    half = dp / 2 if is_mdbc else 0
    # Later draws cut earlier ones: fitted walls cut the water, the water lies in what was cut out of walls on the lattice.
    if is_fitted:
        tank = '<setmkbound mk="0" />' + box_at(*outer, "outer") + box_at(*inner, "inner")
    else:
        tank = '<setmkbound mk="0" />' + box_at(*outer) + "<setmkvoid />" + box_at(*inner)
    fluid = (inset + half, inset + half) if not is_fitted else (0, 0)
    water = '<setmkfluid mk="0" />' + box_at(fluid, (TANK - fluid[0], LEVEL - 0.25 * dp))
    filled_tank = water + tank if is_fitted else tank + water
    body = '<setmkbound mk="1" />' + floating_box()
    attributes = {"inside": 'place="inside"', "layers": 'boundary="mdbc"'}.get(variant, "")
    fitted = f"""<fppg><bodyfitted mkbound="0-1" {attributes} /><fluidband mkfluid="0" width="3" />
        <boolean op="difference"><part ref="outer" /><part ref="inner" /></boolean></fppg>"""
    shapes = normals = ""
    if variant == "lattice-mdbc":
        lines = [(0, RIM), (0, 0), (TANK, 0), (TANK, RIM)]
        rows = "".join(f'<point x="{x:.12g}" y="-1" z="{z:.12g}" />' for x, z in lines)
        sheet = f'<drawextrude closed="false">{rows}<extrude x="0" y="2" z="0" /></drawextrude>'
        shapes = f"""<setshapemode>actual | bound</setshapemode><setactive drawpoints="false" drawshapes="true" />
            <setdrawmode mode="face" /><setnormalinvert invert="true" /><setmkbound mk="0" />{sheet}
            <setnormalinvert invert="false" /><setmkbound mk="1" />{floating_box()}
            <shapeout file="surface" /><setactive drawpoints="true" drawshapes="false" /><setdrawmode mode="full" />"""
        normals = """<normals active="true"><norgeometry><geometryfile file="[CaseName]_surface_Actual.vtk" />
            <distanceh v="2" /></norgeometry></normals>"""
    values = {"SavePosDouble": 0, "Boundary": 2 if is_mdbc else 1, "SlipMode": 2, "NoPenetration": int(is_mdbc),
              "StepAlgorithm": 2, "Kernel": 2, "ViscoTreatment": 1, "Visco": 0.01, "DensityDT": 2, "DensityDTvalue": 0.1,
              "Shifting": 0, "CoefDtMin": 0.05, "TimeMax": TIME, "TimeOut": 0.01, "RhopOutMin": 700, "RhopOutMax": 1300}
    parameters = "".join(f'<parameter key="{k}" value="{v}" />' for k, v in values.items())
    low, high = (-wall - 2 * dp, -wall - 2 * dp), (TANK + wall + 2 * dp, RIM + 2 * dp)
    return f"""<?xml version="1.0" encoding="UTF-8" ?>
<case xmlns:fppg="urn:fppg"><casedef><constantsdef><gravity x="0" y="0" z="-{GRAVITY}" /><rhop0 value="{WATER}" />
<rhopgradient value="2" /><hswl value="0" auto="true" /><gamma value="7" /><speedsystem value="0" auto="true" />
<coefsound value="20" /><speedsound value="0" auto="true" /><coefh value="1" /><cflnumber value="0.2" /></constantsdef>
<mkconfig boundcount="240" fluidcount="9" />
<geometry><definition dp="{dp:.9g}"><pointref x="{half:.9g}" y="0" z="{half:.9g}" />
<pointmin x="{low[0]:.9g}" y="0" z="{low[1]:.9g}" /><pointmax x="{high[0]:.9g}" y="0" z="{high[1]:.9g}" /></definition>
<commands><mainlist><setdrawmode mode="full" />{shapes}{filled_tank}{body}</mainlist></commands></geometry>
<floatings><floating mkbound="1" rhopbody="{DENSITY:g}" /></floatings>{normals}{fitted if is_fitted else ""}</casedef>
<execution><parameters>{parameters}<simulationdomain><posmin x="default" y="default" z="default" />
<posmax x="default" y="default" z="default + 50%" /></simulationdomain></parameters></execution></case>
"""


def poses(folder, dp):
    """Times (n), (draught, tilt in degrees) (n, 2) and fluid lost of a run; the water's level is its mean over the last second."""
    blocks = read_blocks(os.path.join(folder, "Case.xml"))
    block = next(b for b in blocks if b["type"] == "floating")
    first = min(b["begin"] for b in blocks if b["type"] == "fluid")
    start, times, heights, tilts, levels, count = None, [], [], [], [], []
    for path in sorted(glob.glob(os.path.join(folder, "sim", "data", "Part_[0-9]*.bi4"))):
        values, arrays = read_bi4(path)
        order = np.argsort(arrays["Idp"])
        ids, p = arrays["Idp"][order], arrays["Pos"][order].astype(float)[:, (0, 2)]
        body = p[(ids >= block["begin"]) & (ids < block["begin"] + block["count"])]
        start = body if start is None else start
        a, b = start - start.mean(0), body - body.mean(0)
        turn = math.atan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
        c, s = math.cos(turn), math.sin(turn)
        off = middle_at_start() - start.mean(0)
        middle = body.mean(0) + (off[0] * c - off[1] * s, off[0] * s + off[1] * c)
        fluid = p[ids >= first]
        far = fluid[np.abs(fluid[:, 0] - middle[0]) > BREADTH]
        column = np.floor(far[:, 0] / dp).astype(int)
        tops = np.full(column.max() - column.min() + 1, -np.inf)
        np.maximum.at(tops, column - column.min(), far[:, 1])
        # Far from the box; columns there slosh to and fro about their mean.
        levels.append(tops[np.isfinite(tops)].mean() + dp / 2)
        times.append(values["TimeStep"])
        heights.append(middle[1])
        tilts.append(math.degrees(turn) - TILT)
        count.append(len(fluid))
    times = np.array(times)
    level = np.array(levels)[times > times[-1] - 1].mean()
    return times, np.stack((level - np.array(heights) + HEIGHT / 2, tilts), 1), count[0] - count[-1]


def period_of(times, values, most):
    """Twice the mean time between passes through 0; nan where there are fewer than two; at most so many count."""
    at = np.flatnonzero(values[:-1] * values[1:] < 0)
    passes = times[at] - values[at] * (times[at + 1] - times[at]) / (values[at + 1] - values[at])
    passes = passes[:most]
    return 2 * (passes[-1] - passes[0]) / (len(passes) - 1) if len(passes) > 1 else math.nan


def judge(folder, dp):
    times, rows, lost = poses(folder, dp)
    last = rows[times > times[-1] - 1].mean(0)
    mass = read_xml(os.path.join(folder, "Case.xml")).find("case/execution/particles/floating/massbody").get("value")
    return {"mass": float(mass) / MASS, "draught": last[0], "tilt": last[1], "roll": period_of(times, rows[:, 1] - last[1], 3),
            "heave": period_of(times, rows[:, 0] - last[0], 2), "lost": lost}


def run_case(told, variant, dp):
    """The folder of a run, which is not made again where it is there."""
    folder = os.path.join(told.work, f"box_{variant}_{dp:g}")
    if os.path.exists(os.path.join(folder, "done")) and not told.again:
        return folder
    os.makedirs(folder, exist_ok=True)
    case = os.path.join(folder, "Case")
    with open(case + "_Def.xml", "w", encoding="utf-8") as file:
        file.write(definition(variant, dp))
    environment = {**os.environ, "LD_LIBRARY_PATH": told.library_path}
    for program in ([told.fppg, case + "_Def", case, "-threads:1", "-save:all"],
                    [told.solver, case, os.path.join(folder, "sim"), "-cpu", "-ompthreads:1"]):
        with open(os.path.join(folder, "log.txt"), "ab") as log:
            subprocess.run(["nice", "-n", "10", *program], check=True, stdout=log, stderr=log,
                           env=environment if program[0] == told.solver else None)
    with open(os.path.join(folder, "done"), "w", encoding="utf-8"):
        pass
    return folder


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("--fppg", "--solver", "--work"):
        parser.add_argument(name, required=True)
    parser.add_argument("--library-path", default="", help="LD_LIBRARY_PATH of the solver")
    parser.add_argument("--dp", default="0.0125", help="m")
    parser.add_argument("--variant", default=",".join(VARIANTS))
    parser.add_argument("--again", action="store_true", help="runs what was run")
    told = parser.parse_args(words)
    exact = theory()
    print("| variant | dp | mass | draught, mm | tilt, degrees | period of roll, s | of heave, s | lost |\n" + "| --- " * 8 + "|")
    print(f"| theory | | 1 | {1e3 * DRAUGHT:.1f} | 0 | {exact['roll']:.3f} | {exact['heave']:.3f} | 0 |", flush=True)
    for dp in map(float, told.dp.split(",")):
        for variant in told.variant.split(","):
            r = judge(run_case(told, variant, dp), dp)
            print(f"| {variant} | {dp:g} | {r['mass']:.3f} | {1e3 * r['draught']:.1f} | {r['tilt']:.2f} | {r['roll']:.3f} | "
                  f"{r['heave']:.3f} | {r['lost']} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
