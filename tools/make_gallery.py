#!/usr/bin/python3
"""Makes ten cases from folders of parts by `fppg new`, runs them, and prints a table.

    make_gallery.py FPPG FOLDER [--solver DUALSPHYSICS] [--particles 60k] [--pictures FOLDER]

FOLDER gets the parts, the definitions and the results. With --solver every case runs two steps in that
program. --pictures copies the pictures, as they are in cases/new. Exits with 1 where a case fails.
"""

import argparse
import os
import re
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import make_meshes as m  # noqa: E402


def placed(mesh, x=0.0, y=0.0, z=0.0):
    return mesh.moved(x, y, z)


def upright(mesh):
    """What stands about y stands about z."""
    out = m.Mesh()
    for facet in mesh.facets:
        corners = (mesh.vertices[i] for i in facet)
        out.triangle(*(out.vertex(x, -z, y) for x, y, z in corners))
    return out


def cup(radius=0.12, height=0.2, wall=0.008, sides=64):
    """A vessel about z, open above."""
    profile = [(0, 0), (radius + wall, 0), (radius + wall, height), (radius, height), (radius, wall), (0, wall)]
    return m.revolve(profile, sides, closed=False)


def gearbox():
    axis = 75.0
    parts = {"case": m.gearbox_case(), "lid": m.lid(),
             "pinion": m.gear(module=3, teeth=20, width=20, bore=19, backlash=0.4),
             "wheel": placed(m.gear(module=3, teeth=30, width=16, bore=25, backlash=0.4, turned=6), axis),
             "pinion_shaft": m.shaft(), "wheel_shaft": placed(m.shaft(journal=16, seat=26, collar=34), axis)}
    for side, z in (("front", -20.0), ("back", 20.0)):
        parts["pinion_bearing_" + side] = placed(m.bearing(), 0, 0, z)
        parts["wheel_bearing_" + side] = placed(m.bearing(outer=29, inner=15.5), axis, 0, z)
    return parts


def vehicle():
    parts = {"body": m.estate_body()}
    for name, x in (("front", 1.33), ("rear", -1.33)):
        for side, y in (("left", 0.77), ("right", -0.77)):
            parts[f"wheel_{name}_{side}"] = placed(m.road_wheel(), x, y, 0.3563)
    return parts


def pump():
    # The housing's cavity is from z = 0 to 0.5.
    a = placed(m.gear(module=0.075, teeth=12, width=0.4, bore=0, backlash=0.02), 0, 0, 0.25)
    b = placed(m.gear(module=0.075, teeth=12, width=0.4, bore=0, backlash=0.02, turned=15), 0.9, 0, 0.25)
    return {"housing": m.housing(radius_b=0.6, height=0.5), "gear_left": a, "gear_right": b}


# Name, parts, options.
CASES = (
    ("Gearbox", gearbox, ["--up", "y", "--rotate", "pinion=3000deg/s", "--fill", "oil=0.09l@case"]),
    ("Pump", pump, ["--rotate", "gear_left=120rpm", "--fill", "oil=50%@housing"]),
    ("Wading", vehicle, ["--water", "0.36", "--speed", "5"]),
    ("WetRoad", lambda: {"tyre": placed(m.road_wheel(), 0, 0, 0.3563)},
     ["--kind", "wading", "--water", "0.06", "--speed", "15"]),
    ("Tank", lambda: {"tank": m.basin()}, ["--up", "y", "--fill", "water=60%"]),
    ("Stirred", lambda: {"vessel": cup(), "impeller": placed(m.impeller(), 0, 0, 0.06)},
     ["--rotate", "impeller=300rpm", "--fill", "water=5.5l@vessel"]),
    ("Hull", lambda: {"hull": m.hull()}, ["--water", "0.06", "--float", "hull=400"]),
    ("Buoys", lambda: {"ball": m.icosphere(radius=0.1), "drum": placed(m.cylinder(radius=0.08, height=0.16), 0.35)},
     ["--water", "0", "--float", "ball=500", "--float", "drum=1.2kg"]),
    ("Obstacle", lambda: {"corner": m.l_shape()}, ["--water", "0.15", "--speed", "1.2"]),
    ("Torus", lambda: {"torus": upright(placed(m.torus(ring_radius=0.2, tube_radius=0.05), 0, 0.25, 0))},
     ["--kind", "obstacle", "--water", "0.3", "--speed", "1"]),
)


def run(words, log, **more):
    done = subprocess.run(words, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    with open(log, "w", encoding="utf-8") as file:
        file.write(done.stdout)
    return done


def one_case(options, name, parts, words):
    folder = os.path.join(options.folder, name)
    os.makedirs(os.path.join(folder, "parts"), exist_ok=True)
    for part, mesh in parts().items():
        m.write_stl(mesh, os.path.join(folder, "parts", part + ".stl"), part)
    start = time.time()
    made = run([options.fppg, "new", "parts", "-o", f"Case{name}_Def.xml", "--particles", options.particles, *words],
               os.path.join(folder, "new.log"), cwd=folder)
    proposed = time.time() - start
    if made.returncode:
        return f"| {name} | new fails: {made.stdout.splitlines()[-1]} |", False
    start = time.time()
    result = run([options.fppg, f"Case{name}_Def", f"out/Case{name}"], os.path.join(folder, "run.log"), cwd=folder)
    seconds = time.time() - start
    if result.returncode:
        return f"| {name} | the run fails: {result.stdout.splitlines()[-1]} |", False
    total = re.search(r"Total particles: ([\d,]+)", result.stdout).group(1)
    steps = "-"
    if options.solver:
        solved = run([options.solver, f"out/Case{name}", "out/solver", "-dirdataout", "data", "-nsteps:2"],
                     os.path.join(folder, "solver.log"), cwd=folder)
        found = re.search(r"Steps of simulation\.*: (\d+)", solved.stdout)
        excluded = re.search(r"Excluded particles\.*: (\d+)", solved.stdout)
        if solved.returncode or not found:
            return f"| {name} | the solver fails: {os.path.join(folder, 'solver.log')} |", False
        steps = f"{found.group(1)} steps, {excluded.group(1) if excluded else '?'} excluded"
    if options.pictures:
        os.makedirs(options.pictures, exist_ok=True)
        run([options.fppg, "render", f"out/Case{name}", "-o", os.path.abspath(f"{options.pictures}/{name}.png"), "--size",
             "640x480", "--palette"], os.path.join(folder, "render.log"), cwd=folder)
    command = f"fppg new parts -o Case{name}_Def.xml {' '.join(words)}"
    return (f"| {name} | `{command}` | {len(parts())} | {proposed:.1f} s | {total} in {seconds:.0f} s | {steps} |", True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fppg")
    parser.add_argument("folder")
    parser.add_argument("--solver")
    parser.add_argument("--particles", default="60k")
    parser.add_argument("--pictures")
    parser.add_argument("--only", help="a name")
    options = parser.parse_args()
    options.fppg = os.path.abspath(options.fppg)
    print("| case | command | parts | new | particles | solver |\n| --- | --- | --- | --- | --- | --- |")
    is_good = True
    for name, parts, words in CASES:
        if options.only and name != options.only:
            continue
        row, is_right = one_case(options, name, parts, words)
        is_good &= is_right
        print(row, flush=True)
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
