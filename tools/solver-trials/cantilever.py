#!/usr/bin/python3
"""A flexible beam under its own weight in the DualSPHysics v5.4 solver, against beam theory.

    cantilever.py --fppg FPPG --solver SOLVER --work DIR [--library-path FOLDER] [--across 5,10] [--angle 0,30]
                  [--place inside,lattice]

The beam, 0.2 x 0.02 m in 2D (plane strain), is clamped at one end and let go at once; it swings about its deflection at
rest. Turned by an angle, weight and beam turn together, so that the answer stays. `inside` is <bodyfitted
place="inside">, `lattice` the nodes inside the beam, half a dp from its faces where it is not turned. Both are judged where
the particles of the free end are: deflection against Timoshenko's, period against that of the first mode.
"""

import argparse
import glob
import math
import os
import subprocess
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from particle_files import read_bi4  # noqa: E402 (found by the path above)

LENGTH, THICKNESS, WEIGHT = 0.2, 0.02, 2.0  # m, m, m/s^2
YOUNG, POISSON, DENSITY = 1.4e6, 0.4, 1000.0
CLAMP = 6  # dp long
PLANE_STRAIN = YOUNG / (1 - POISSON**2)
PERIOD = 2 * math.pi / 1.875104**2 * math.sqrt(DENSITY * THICKNESS * LENGTH**4 / (PLANE_STRAIN * THICKNESS**3 / 12))


def deflection(x):
    """Of the beam at rest, by Timoshenko, m."""
    load, stiffness = DENSITY * WEIGHT * THICKNESS, PLANE_STRAIN * THICKNESS**3 / 12
    shear = 5 / 6 * YOUNG / (2 * (1 + POISSON)) * THICKNESS
    bending = load * x * x * (6 * LENGTH**2 - 4 * LENGTH * x + x * x) / (24 * stiffness)
    return bending + load * (LENGTH * x - x * x / 2) / shear


def draw(place, dp, low, high, turn):
    """The commands that draw the beam from low to high along it."""
    (c, s) = turn

    def placed(x, z):
        return x * c - z * s, x * s + z * c

    if place == "lattice":
        reach = range(-int(1.2 * LENGTH / dp) - 10, int(1.2 * LENGTH / dp) + 10)
        nodes = [((i + 0.5) * dp, (k + 0.5) * dp) for i in reach for k in reach]
        return "".join(f'<drawpoint x="{x:.9g}" y="0" z="{z:.9g}" />' for x, z in nodes
                       if low <= x * c + z * s < high and 0 <= z * c - x * s < THICKNESS)
    corners = [placed(*p) for p in ((low, 0), (high, 0), (high, THICKNESS), (low, THICKNESS))]
    points = "".join(f'<point x="{x:.9g}" y="{y}" z="{z:.9g}" />' for y in (-1, 1) for x, z in corners)
    return f'<drawprism mask="0">{points}</drawprism>'


def definition(place, across, angle):
    dp = THICKNESS / across
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    box = [(x * c - z * s, x * s + z * c) for x in (-8 * dp, 1.1 * LENGTH) for z in (-0.6 * LENGTH, THICKNESS + 4 * dp)]
    low, high = [min(p[k] for p in box) for k in (0, 1)], [max(p[k] for p in box) for k in (0, 1)]
    values = {"SavePosDouble": 1, "Boundary": 1, "StepAlgorithm": 2, "Kernel": 2, "ViscoTreatment": 1, "Visco": 0.01,
              "DensityDT": 0, "CoefDtMin": 0.05, "TimeMax": round(2 * PERIOD, 3), "TimeOut": round(PERIOD / 60, 5)}
    parameters = "".join(f'<parameter key="{k}" value="{v}" />' for k, v in values.items())
    fitted = '<fppg><bodyfitted place="inside" /></fppg>' if place == "inside" else ""
    half = dp / 2 if place == "lattice" else 0
    return f"""<?xml version="1.0" encoding="UTF-8" ?>
<case><casedef><constantsdef><gravity x="{WEIGHT * s:.9g}" y="0" z="{-WEIGHT * c:.9g}" /><rhop0 value="1000" />
<rhopgradient value="1" /><hswl value="0.1" auto="false" /><gamma value="7" /><speedsystem value="1" auto="false" />
<coefsound value="20" /><speedsound value="20" auto="false" /><coefh value="1" /><cflnumber value="0.2" /></constantsdef>
<mkconfig boundcount="240" fluidcount="9" />
<geometry><definition dp="{dp:.9g}"><pointref x="{half:.9g}" y="0" z="{half:.9g}" />
<pointmin x="{low[0]:.9g}" y="0" z="{low[1]:.9g}" /><pointmax x="{high[0]:.9g}" y="0" z="{high[1]:.9g}" /></definition>
<commands><mainlist><setdrawmode mode="full" />
<setmkbound mk="0" />{draw(place, dp, -CLAMP * dp, 0, (c, s))}
<setmkbound mk="1" />{draw(place, dp, 0, LENGTH, (c, s))}</mainlist></commands></geometry>
<motion><objreal ref="1"><begin mov="1" start="0" /><mvnull id="1" /></objreal></motion>{fitted}</casedef>
<execution><special><flexstrucs><flexstrucbody mkbound="1" mkclamp="0"><density value="{DENSITY}" />
<youngmod value="{YOUNG}" /><poissratio value="{POISSON}" /><constitmodel value="1" /><hgfactor value="0.1" />
</flexstrucbody></flexstrucs></special><parameters>{parameters}<simulationdomain>
<posmin x="default - 0.1" y="default" z="default - 0.1" /><posmax x="default + 0.1" y="default" z="default + 0.1" />
</simulationdomain></parameters></execution></case>
"""


def measure(folder, across, angle):
    """(particles, x of the free end, its deflection at rest, the period) of a run."""
    c, s, dp = math.cos(math.radians(angle)), math.sin(math.radians(angle)), THICKNESS / across
    times, sags, end = [], [], None
    for path in sorted(glob.glob(os.path.join(folder, "sim", "data", "Part_[0-9]*.bi4"))):
        values, arrays = read_bi4(path)
        p = (arrays["Posd"] if "Posd" in arrays else arrays["Pos"])[np.argsort(arrays["Idp"])].astype(float)
        along, up = p[:, 0] * c + p[:, 2] * s, p[:, 2] * c - p[:, 0] * s
        if end is None:
            end, start, at = np.flatnonzero(along > along.max() - 0.8 * dp), up, along
        times.append(values["TimeStep"])
        sags.append((start - up)[end].mean())
    t, w = np.array(times), np.array(sags)
    # About a rest, with one frequency: the best fit over all frequencies.
    best = None
    for period in np.linspace(0.6 * PERIOD, 1.8 * PERIOD, 601):
        phase = 2 * math.pi * t / period
        rows = np.stack((np.ones_like(t), np.cos(phase), np.sin(phase), t * np.cos(phase), t * np.sin(phase)), 1)
        found = np.linalg.lstsq(rows, w, rcond=None)[0]
        error = np.square(rows @ found - w).sum()
        if best is None or error < best[0]:
            best = (error, period, found[0])
    return len(at), at[end].mean(), best[2], best[1]


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("--fppg", "--solver", "--work"):
        parser.add_argument(name, required=True)
    parser.add_argument("--library-path", default="", help="LD_LIBRARY_PATH of the solver")
    parser.add_argument("--across", default="5,10", help="particles across the beam")
    parser.add_argument("--angle", default="0,30", help="degrees")
    parser.add_argument("--place", default="inside,lattice")
    told = parser.parse_args(words)
    print("| place | across | angle | particles | deflection, mm | of theory | period, s | of theory |\n" + "| --- " * 8 + "|")
    for across in map(int, told.across.split(",")):
        for angle in map(float, told.angle.split(",")):
            for place in told.place.split(","):
                folder = os.path.join(told.work, f"{place}_{across}_{angle:g}")
                os.makedirs(folder, exist_ok=True)
                case = os.path.join(folder, "Case")
                with open(case + "_Def.xml", "w", encoding="utf-8") as file:
                    file.write(definition(place, across, angle))
                environment = {**os.environ, "LD_LIBRARY_PATH": told.library_path}
                for program in ([told.fppg, case + "_Def", case, "-threads:1"],
                                [told.solver, case, os.path.join(folder, "sim"), "-cpu", "-ompthreads:1"]):
                    with open(os.path.join(folder, "log.txt"), "ab") as log:
                        subprocess.run(["nice", "-n", "10", *program], check=True, stdout=log, stderr=log,
                                       env=environment if program[0] == told.solver else None)
                n, x, rest, period = measure(folder, across, angle)
                print(f"| {place} | {across} | {angle:g} | {n} | {1e3 * rest:.3f} | {100 * (rest / deflection(x) - 1):+.1f} % "
                      f"| {period:.4f} | {100 * (period / PERIOD - 1):+.1f} % |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
