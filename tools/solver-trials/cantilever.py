#!/usr/bin/python3
"""A flexible beam under its own weight in the DualSPHysics v5.4 solver, against what is known of it.

    cantilever.py --fppg FPPG --solver SOLVER --work DIR [--library-path FOLDER] [--beam short,csm3] [--across 5,10]
                  [--angle 0,30] [--place inside,lattice] [--again]

The beam, 0.02 m thick in 2D (plane strain), is clamped at one end and let go at once; it swings about its deflection at
rest. Turned by an angle, weight and beam turn together, so that the answer stays. `inside` is <bodyfitted
place="inside">, `lattice` the nodes inside the beam, half a dp from its faces where it is not turned.

short  0.2 m long, judged where the particles of the free end are: deflection against Timoshenko's, period against that of
       the first mode
csm3   the structure of Turek and Hron (2006), test CSM3, 0.35 m long: how the middle of its free end moves, mean +- amplitude,
       and how often, against their figures. Here its clamped end is flat, theirs lies on a cylinder of 0.05 m radius, so that
       the edges of their beam are 1 mm longer (up to 1.2 % of the deflection).
"""

import argparse
import glob
import math
import os
import subprocess
import sys
from dataclasses import dataclass

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from particle_files import read_bi4  # noqa: E402 (found by the path above)

THICKNESS, WEIGHT = 0.02, 2.0  # m, m/s^2
YOUNG, POISSON, DENSITY = 1.4e6, 0.4, 1000.0
CLAMP = 6  # dp long
PLANE_STRAIN = YOUNG / (1 - POISSON**2)


@dataclass
class Beam:
    length: float  # m

    @property
    def period(self):
        """Of the first mode, s."""
        stiffness = PLANE_STRAIN * THICKNESS**3 / 12
        return 2 * math.pi / 1.875104**2 * math.sqrt(DENSITY * THICKNESS * self.length**4 / stiffness)

    def deflection(self, x):
        """At rest, by Timoshenko, m."""
        load, stiffness = DENSITY * WEIGHT * THICKNESS, PLANE_STRAIN * THICKNESS**3 / 12
        shear = 5 / 6 * YOUNG / (2 * (1 + POISSON)) * THICKNESS
        bending = load * x * x * (6 * self.length**2 - 4 * self.length * x + x * x) / (24 * stiffness)
        return bending + load * (self.length * x - x * x / 2) / shear


BEAMS = {"short": Beam(0.2), "csm3": Beam(0.35)}
# Turek and Hron, CSM3: mean and amplitude of the ways along and across the beam, mm, and their frequency, Hz.
REFERENCE = {"along": (-14.305, 14.305), "across": (-63.607, 65.160), "frequency": 1.0995}


def draw(beam, place, dp, ends, turn):
    """The commands that draw the beam from one end to another, m along it."""
    (c, s), (low, high) = turn, ends

    def placed(x, z):
        return x * c - z * s, x * s + z * c

    if place == "lattice":
        reach = range(-int(1.2 * beam.length / dp) - 10, int(1.2 * beam.length / dp) + 10)
        nodes = [((i + 0.5) * dp, (k + 0.5) * dp) for i in reach for k in reach]
        return "".join(f'<drawpoint x="{x:.9g}" y="0" z="{z:.9g}" />' for x, z in nodes
                       if low <= x * c + z * s < high and 0 <= z * c - x * s < THICKNESS)
    corners = [placed(*p) for p in ((low, 0), (high, 0), (high, THICKNESS), (low, THICKNESS))]
    points = "".join(f'<point x="{x:.9g}" y="{y}" z="{z:.9g}" />' for y in (-1, 1) for x, z in corners)
    return f'<drawprism mask="0">{points}</drawprism>'


def definition(beam, place, across, angle):
    dp = THICKNESS / across
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    box = [(x * c - z * s, x * s + z * c) for x in (-8 * dp, 1.1 * beam.length)
           for z in (-0.6 * beam.length, THICKNESS + 4 * dp)]
    low, high = [min(p[k] for p in box) for k in (0, 1)], [max(p[k] for p in box) for k in (0, 1)]
    values = {"SavePosDouble": 1, "Boundary": 1, "StepAlgorithm": 2, "Kernel": 2, "ViscoTreatment": 1, "Visco": 0.01,
              "DensityDT": 0, "CoefDtMin": 0.05, "TimeMax": round(2 * beam.period, 3), "TimeOut": round(beam.period / 60, 5)}
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
<setmkbound mk="0" />{draw(beam, place, dp, (-CLAMP * dp, 0), (c, s))}
<setmkbound mk="1" />{draw(beam, place, dp, (0, beam.length), (c, s))}</mainlist></commands></geometry>
<motion><objreal ref="1"><begin mov="1" start="0" /><mvnull id="1" /></objreal></motion>{fitted}</casedef>
<execution><special><flexstrucs><flexstrucbody mkbound="1" mkclamp="0"><density value="{DENSITY}" />
<youngmod value="{YOUNG}" /><poissratio value="{POISSON}" /><constitmodel value="1" /><hgfactor value="0.1" />
</flexstrucbody></flexstrucs></special><parameters>{parameters}<simulationdomain>
<posmin x="default - 0.2" y="default" z="default - 0.2" /><posmax x="default + 0.2" y="default" z="default + 0.2" />
</simulationdomain></parameters></execution></case>
"""


def end_of(folder, across, angle):
    """(particles, x of the last column, times (n), ways along and across (n, 2) of the last column and of the free end) of
    a run; the way of the end goes on from the last four columns in a straight line."""
    c, s, dp = math.cos(math.radians(angle)), math.sin(math.radians(angle)), THICKNESS / across
    times, last, end, start = [], [], [], None
    for path in sorted(glob.glob(os.path.join(folder, "sim", "data", "Part_[0-9]*.bi4"))):
        values, arrays = read_bi4(path)
        p = (arrays["Posd"] if "Posd" in arrays else arrays["Pos"])[np.argsort(arrays["Idp"])].astype(float)
        at = np.stack((p[:, 0] * c + p[:, 2] * s, p[:, 2] * c - p[:, 0] * s), 1)
        if start is None:
            start, tip = at, at[:, 0].max()
            column = start[:, 0] > tip - 0.8 * dp
            columns = start[:, 0] > tip - 3.8 * dp
            rows = np.stack((np.ones(columns.sum()), start[columns, 0] - tip - 0.5 * dp), 1)
        times.append(values["TimeStep"])
        last.append((at - start)[column].mean(0))
        end.append(np.linalg.lstsq(rows, (at - start)[columns], rcond=None)[0][0])
    return len(start), start[column, 0].mean(), np.array(times), np.array(last), np.array(end)


def swing(beam, t, w):
    """(middle, period) of what swings with one frequency: the best fit over all frequencies."""
    best = None
    for period in np.linspace(0.6 * beam.period, 1.8 * beam.period, 1201):
        phase = 2 * math.pi * t / period
        rows = np.stack((np.ones_like(t), np.cos(phase), np.sin(phase), t * np.cos(phase), t * np.sin(phase)), 1)
        found = np.linalg.lstsq(rows, w, rcond=None)[0]
        error = np.square(rows @ found - w).sum()
        if best is None or error < best[0]:
            best = (error, found[0], period)
    return best[1:]


def row_of_short(beam, told):
    n, x, times, last, _ = told
    rest, period = swing(beam, times, -last[:, 1])
    return (f"{n} | {1e3 * rest:.3f} | {100 * (rest / beam.deflection(x) - 1):+.1f} % | {period:.4f} | "
            f"{100 * (period / beam.period - 1):+.1f} %")


def row_of_csm3(beam, told):
    n, _, times, _, end = told
    frequency = 1 / swing(beam, times, end[:, 1])[1]
    words = []
    for ways, (_, amplitude) in zip(1e3 * end.T, (REFERENCE["along"], REFERENCE["across"])):
        middle, half = (ways.max() + ways.min()) / 2, (ways.max() - ways.min()) / 2
        words.append(f"{middle:.2f} +- {half:.2f} | {100 * (half / amplitude - 1):+.1f} %")
    return f"{n} | {' | '.join(words)} | {frequency:.4f} | {100 * (frequency / REFERENCE['frequency'] - 1):+.1f} %"


TABLES = {"short": (row_of_short, "particles | deflection, mm | of theory | period, s | of theory"),
          "csm3": (row_of_csm3, "particles | along, mm | amplitude off | across, mm | amplitude off | frequency, Hz | off")}


def run_case(told, beam, place, across, angle):
    """The folder of a run, which is not made again where it is there."""
    folder = os.path.join(told.work, f"{beam}_{place}_{across}_{angle:g}")
    if os.path.exists(os.path.join(folder, "done")) and not told.again:
        return folder
    os.makedirs(folder, exist_ok=True)
    case = os.path.join(folder, "Case")
    with open(case + "_Def.xml", "w", encoding="utf-8") as file:
        file.write(definition(BEAMS[beam], place, across, angle))
    environment = {**os.environ, "LD_LIBRARY_PATH": told.library_path}
    for program in ([told.fppg, case + "_Def", case, "-threads:1"],
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
    parser.add_argument("--beam", default="short", help=", ".join(BEAMS))
    parser.add_argument("--across", default="5,10", help="particles across the beam")
    parser.add_argument("--angle", default="0,30", help="degrees")
    parser.add_argument("--place", default="inside,lattice")
    parser.add_argument("--again", action="store_true", help="runs what was run")
    told = parser.parse_args(words)
    for name in told.beam.split(","):
        row, head = TABLES[name]
        print(f"| beam | place | across | angle | {head} |\n" + "| --- " * (5 + head.count("|")) + "|")
        for across in map(int, told.across.split(",")):
            for angle in map(float, told.angle.split(",")):
                for place in told.place.split(","):
                    folder = run_case(told, name, place, across, angle)
                    print(f"| {name} | {place} | {across} | {angle:g} | {row(BEAMS[name], end_of(folder, across, angle))} |",
                          flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
