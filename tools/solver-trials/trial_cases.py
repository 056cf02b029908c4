"""Small cases whose answer is known, as definitions and meshes; CASES, at the end, names them.

Each function named like a case takes keyword arguments (dp and what the case varies, in metres, m/s, degrees) and gives
a Trial. Geometry is in its final place in the meshes; the definitions only draw it. Walls of closed bodies are 4 dp thick
where the case can choose.
"""

import math
import os
import sys
from dataclasses import dataclass, field

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import make_meshes  # noqa: E402 (found by the path above)
from make_meshes import Mesh  # noqa: E402

GRAVITY = 9.81


@dataclass
class Trial:
    """One case at one size, for any variant.

    meshes      file name: mesh, its mkbound by the order; `is_sheet`: open, drawn as facets without an inside
    domain      (low, high) corners of the lattice, m
    seed, level fluid is what the walls enclose round the seed, below the level z, m
    second      another seed and level, for water apart from the first; or None
    gravity     m/s^2; a body force along the pipe there
    speed_sound m/s, the same for every variant; None: 20 sqrt(g depth) by coefsound
    depth       points (n, 3), shift of the walls (3) -> how far behind the true wet surface, m, (n); negative in the fluid
    measure     name of the function of trial_measures that judges the outputs
    """
    name: str
    dp: float
    meshes: dict
    domain: tuple
    seed: tuple
    level: float
    time: float
    outputs: int
    depth: object
    measure: str
    gravity: tuple = (0.0, 0.0, -GRAVITY)
    speed_sound: float = None
    is_sheet: bool = False
    box: tuple = None  # the sheet as a <drawbox> without its top: (low corner, size)
    density_gradient: int = 2
    parameters: dict = field(default_factory=dict)
    motion: str = ""
    floating: str = ""
    second: tuple = None
    solver_domain: tuple = ("default", "default", "default", "default", "default", "default")
    facts: dict = field(default_factory=dict)


def placed(mesh, rows, shift=(0.0, 0.0, 0.0)):
    """The mesh turned by a rotation matrix, given by rows, then moved."""
    out = Mesh()
    turn = np.array(rows, float)
    for facet in mesh.facets:
        corners = (turn @ np.array(mesh.vertices[i]) + shift for i in facet)
        out.triangle(*(out.vertex(*p) for p in corners))
    return out


Y_UP = ((1, 0, 0), (0, 0, -1), (0, 1, 0))  # y of a mesh becomes z


def box_depth(points, length, width):
    """Depth behind the four sides of a box that spans 0 to length in x and the width about y = 0."""
    return np.maximum(np.maximum(-points[:, 0], points[:, 0] - length), np.abs(points[:, 1]) - width / 2)


def wet_part(trial, mesh):
    """The facets of a wall's mesh that fluid can touch; the whole mesh of a body that the trial's depth does not know."""
    corners = np.array(mesh.vertices)
    is_wet = np.abs(trial.depth(corners, np.zeros(3))) < 1e-4 * trial.dp
    out = Mesh()
    for facet in mesh.facets:
        if all(is_wet[i] for i in facet):
            out.triangle(*(out.vertex(*mesh.vertices[i]) for i in facet))
    return out if out.facets else mesh


def around(low, high, margin):
    return tuple(v - margin for v in low), tuple(v + margin for v in high)


def rest(dp=0.01, time=0.2):
    """Water at rest in the tank of cases/rest, whose floor is a sine."""
    length, width, height, bottom, swing, wall, level = 0.5, 0.1, 0.24, 0.06, 0.04, 0.04, 0.2

    def depth(p, shift):
        phase = 2 * np.pi * p[:, 0] / length
        slope = 2 * np.pi * swing / length * np.cos(phase)
        floor = (bottom + swing * np.sin(phase) - p[:, 2]) / np.sqrt(1 + slope**2)
        return np.maximum(box_depth(p, length, width), floor)

    mesh = placed(make_meshes.basin(length, width, height, bottom, swing, wall), Y_UP)
    low, high = (-wall, -width / 2 - wall, -wall), (length + wall, width / 2 + wall, height)
    return Trial("rest", dp, {"basin.stl": mesh}, around(low, high, 2 * dp), (length / 2, 0, level - 2 * dp), level, time, 10,
                 depth, "still_water", facts={"water_depth": level - bottom + swing})


def tank(dp=0.01, time=0.2):
    """Water at rest in a cuboid of 0.2 x 0.2 m, 0.12 m deep."""
    length, width, height, level, wall = 0.2, 0.2, 0.16, 0.12, 4 * dp

    def depth(p, shift):
        return np.maximum(box_depth(p, length, width), -p[:, 2])

    mesh = placed(make_meshes.trough([(0, 0), (length, 0)], length, width, height, wall), Y_UP)
    low, high = (-wall, -width / 2 - wall, -wall), (length + wall, width / 2 + wall, height)
    return Trial("tank", dp, {"tank.stl": mesh}, around(low, high, 2 * dp), (length / 2, 0, level / 2), level, time, 10,
                 depth, "still_water", facts={"water_depth": level})


def wedge(dp=0.0075, time=0.2, angle=20.0):
    """Still water over a wedge on the floor of a tank, its tip up; tank and wedge are one body."""
    length, width, height, level, wall, tip = 0.2, 0.06, 0.15, 0.12, 4 * dp, 0.08
    half = math.radians(angle / 2)
    foot = tip * math.tan(half)

    def depth(p, shift):
        # Distance to the wedge's faces, within the wedge the smaller of the two.
        x, z = np.abs(p[:, 0] - length / 2), p[:, 2]
        face = (tip - z) * math.sin(half) - x * math.cos(half)
        return np.maximum(np.maximum(box_depth(p, length, width), -z), face)

    floor = [(0, 0), (length / 2 - foot, 0), (length / 2, tip), (length / 2 + foot, 0), (length, 0)]
    mesh = placed(make_meshes.trough(floor, length, width, height, wall), Y_UP)
    low, high = (-wall, -width / 2 - wall, -wall), (length + wall, width / 2 + wall, height)
    return Trial("wedge", dp, {"wedge.stl": mesh}, around(low, high, 2 * dp), (0.03, 0, level / 2), level, time, 15,
                 depth, "still_water", facts={"water_depth": level})


def turned_about_y(angle):
    """Turns +z towards +x; degrees."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return ((c, 0, s), (0, 1, 0), (-s, 0, c))


ABOUT_Z = np.array(((math.cos(0.01), -math.sin(0.01), 0), (math.sin(0.01), math.cos(0.01), 0), (0, 0, 1)))


def cup(dp=0.0075, time=0.2, angle=25.0):
    """Still water in a round cup of 0.06 m radius whose axis is tilted."""
    radius, height, level, wall = 0.06, 0.2, 0.1, 4 * dp
    turn = np.array(turned_about_y(angle))

    def depth(p, shift):
        local = p @ turn  # the inverse of a rotation is its transpose
        return np.maximum(np.hypot(local[:, 0], local[:, 1]) - radius, -local[:, 2])

    profile = [(0, -wall), (radius + wall, -wall), (radius + wall, height), (radius, height), (radius, 0), (0, 0)]
    # Turned about its axis too: GenCase's advanced filling leaves holes where vertices lie in a plane of nodes.
    mesh = placed(make_meshes.revolve(profile, 128, closed=False), turn @ ABOUT_Z)
    corners = np.array(mesh.vertices)
    lowest = -radius * math.sin(math.radians(angle))
    return Trial("cup", dp, {"cup.stl": mesh}, around(corners.min(0), corners.max(0), 2 * dp), (0, 0, 0.04), level, time, 15,
                 depth, "still_water", facts={"water_depth": level - lowest})


def pipe_trial(name, across, reynolds, periods, tilt_steps, length_steps):
    """A pipe of 0.1 m, its axis along (length_steps, 0, tilt_steps); one period of length_steps dp in x."""
    radius, viscosity = 0.05, 1e-3
    dp = 2 * radius / across
    slope = tilt_steps / length_steps
    axis = np.array((1.0, 0.0, slope)) / math.hypot(1, slope)
    largest = reynolds * viscosity / (2 * radius)
    force = 4 * viscosity * largest / radius**2
    angle = math.degrees(math.atan(slope))
    wall, period = 4 * dp, length_steps * dp
    # The domain goes on beyond the period, which is cut out of it, and the tube beyond the domain.
    margin = 6 * dp
    over = 8 * dp + margin + (radius + wall) * slope
    rings = [[((radius + r) * c, (radius + r) * s) for c, s in make_meshes.turn(192)] for r in (wall, 0)]
    span = math.hypot(1, slope)
    mesh = placed(make_meshes.extrude_ring(*rings, -over * span, (period + over) * span),
                  np.array(turned_about_y(90 - angle)) @ ABOUT_Z)

    def distance(p):
        """From the axis of the pipe, and along it."""
        along = p @ axis
        return np.linalg.norm(p - along[:, None] * axis, axis=1), along

    def depth(p, shift):
        return distance(p)[0] - radius

    reach = radius + wall + 2 * dp
    rise = reach / math.cos(math.radians(angle))
    low = (-margin, -reach, -rise - margin * slope)
    high = (period + margin, reach, (period + margin) * slope + rise)
    time = periods * radius**2 / viscosity
    parameters = {"XPeriodicIncZ": f"{-period * slope:.12g}", "ViscoTreatment": 3, "Visco": viscosity, "DensityDT": 1}
    facts = {"radius": radius, "viscosity": viscosity, "force": force, "largest_speed": largest, "axis": axis.tolist(),
             "rise": period * slope, "period": period, "angle": angle, "across": across}
    return Trial(name, dp, {"pipe.stl": mesh}, (low, high), (dp, 0, dp * slope), high[2] + 1.0, time, 10, depth,
                 "poiseuille", tuple(force * axis), 20 * largest, density_gradient=1, parameters=parameters, facts=facts)


def pipe(across=16, reynolds=5.0, periods=1.0):
    """Poiseuille flow in a pipe along x, `across` particles wide."""
    return pipe_trial("pipe", across, reynolds, periods, 0, 16)


def tilted(across=16, reynolds=5.0, periods=1.0):
    """The same, tilted by 29.98 degrees: 15 steps up in 26, so that a period maps the lattice on itself."""
    return pipe_trial("tilted", across, reynolds, periods, 15, 26)


def gear(dp=0.01, time=0.15):
    """The gear of cases/gear, one turn a second, in a bath of oil with walls of 4 dp."""
    length, width, height, level, wall = 0.56, 0.16, 0.22, 0.15, 4 * dp
    bath = placed(make_meshes.trough([(0, 0), (length, 0)], length, width, height, wall), Y_UP)
    wheel = make_meshes.gear(module=0.02, teeth=20, width=0.1, bore=0.1)
    middle = (length / 2, 0, 0.27)
    # The gear of make_meshes is about z; its middle in z goes to y = 0.
    zs = [v[2] for v in wheel.vertices]
    wheel = placed(wheel, Y_UP, (middle[0], (min(zs) + max(zs)) / 2, middle[2]))

    def depth(p, shift):
        return np.maximum(box_depth(p, length, width), -p[:, 2])

    motion = f"""<motion><objreal ref="1"><begin mov="1" start="0" /><mvrot id="1" duration="10" anglesunits="degrees">
        <vel ang="360" /><axisp1 x="{middle[0]}" y="0" z="{middle[2]}" /><axisp2 x="{middle[0]}" y="1" z="{middle[2]}" />
        </mvrot></objreal></motion>"""
    corners = np.array(bath.vertices + wheel.vertices)
    return Trial("gear", dp, {"bath.stl": bath, "gear.stl": wheel}, around(corners.min(0), corners.max(0), 4 * dp),
                 (0.05, 0, 0.05), level, time, 15, depth, "turning_gear", motion=motion,
                 parameters={"Visco": 0.05}, facts={"water_depth": level})


def vessel(dp=0.01, speed=4.0, sound=10.0, time=0.04):
    """An open box of one sheet, its facets looking inwards, jerked along x to a speed within four steps.

    sound  the speed of sound over that speed, at least 20 sqrt(g H), which is what 0 stands for
    """
    length, width, height, level = 0.12, 0.08, 0.2, 0.08
    y = width / 2
    mesh = Mesh()
    c = {k: mesh.vertex(*p) for k, p in {
        "a": (0, -y, 0), "b": (length, -y, 0), "c": (length, y, 0), "d": (0, y, 0),
        "e": (0, -y, height), "f": (length, -y, height), "g": (length, y, height), "h": (0, y, height)}.items()}
    for side in ("abcd", "aefb", "bfgc", "cghd", "dhea"):
        mesh.quad(*(c[k] for k in side))

    def depth(p, shift):
        q = p - shift
        return np.maximum(box_depth(q, length, width), -q[:, 2])

    sound = max(20 * math.sqrt(GRAVITY * level), sound * speed)
    # In four steps of speed, the last without end: a duration of -1 is a jump at once in v5.4.
    step = 0.2 * math.sqrt(3) * dp / sound
    ends = [f'duration="{step:.6g}" next="{k + 1}"' for k in (1, 2, 3)] + ['duration="10"']
    moves = "".join(f'<mvrect id="{k}" {end}><vel x="{speed * k / 4:.6g}" y="0" z="0" /></mvrect>' for k, end in enumerate(ends, 1))
    motion = f'<motion><objreal ref="0"><begin mov="1" start="0" />{moves}</objreal></motion>'
    low, high = (0, -y, 0), (length, y, height)
    return Trial("vessel", dp, {"vessel.stl": mesh}, around(low, high, 5 * dp), (length / 2, 0, level / 2), level, time, 20,
                 depth, "jerked_vessel", speed_sound=sound, is_sheet=True, box=(low, (length, width, height)), motion=motion,
                 solver_domain=("default - 0.1", "default - 0.1", "default - 0.1",
                                f"default + {speed * time + 0.1:.6g}", "default + 0.1", "default + 0.3"),
                 parameters={"DtIni": f"{step / 2:.6g}"}, facts={"water_depth": level, "rim": height, "speed": speed})


def ball(dp=0.0125, time=1.0, density=500.0):
    """A ball of 0.06 m radius, as heavy as half of the water that it can displace, laid into still water to its middle."""
    length, width, height, level, wall, radius = 0.3, 0.3, 0.24, 0.18, 4 * dp, 0.06
    tank_mesh = placed(make_meshes.trough([(0, 0), (length, 0)], length, width, height, wall), Y_UP)
    # Not on nodes, as a body that floats never is.
    middle = np.array((length / 2 + 0.3 * dp, 0.2 * dp, level))
    sphere = placed(make_meshes.icosphere(radius, 4), ABOUT_Z, middle)

    def depth(p, shift):
        return np.maximum(box_depth(p, length, width), -p[:, 2])

    low, high = (-wall, -width / 2 - wall, -wall), (length + wall, width / 2 + wall, level + radius + 4 * dp)
    return Trial("ball", dp, {"tank.stl": tank_mesh, "ball.stl": sphere}, around(low, high, 2 * dp), (0.05, 0, level / 2), level, time,
                 40, depth, "afloat", floating=f'<floatings><floating mkbound="1" rhopbody="{density:g}" /></floatings>',
                 facts={"water_depth": level, "radius": radius, "density": density, "middle": middle.tolist()})


def sphere(dp=0.0075, time=0.2, radius=0.08):
    """A closed hollow sphere half full of still water."""
    mesh = make_meshes.icosphere(radius + 4 * dp, 5)
    inside = placed(make_meshes.icosphere(radius, 5), ABOUT_Z)
    rows = [mesh.vertex(*v) for v in inside.vertices]
    for a, b, c in inside.facets:
        mesh.triangle(rows[a], rows[c], rows[b])
    reach = radius + 4 * dp
    return Trial("sphere", dp, {"sphere.stl": mesh}, around((-reach,) * 3, (reach,) * 3, 2 * dp), (0, 0, -radius / 2), 0.0, time, 10,
                 lambda p, shift: np.linalg.norm(p, axis=1) - radius, "still_water", facts={"water_depth": radius})


def level_of_rows(level, dp, offset):
    """The surface of the water of a <fillbox> up to a level, half a dp above its highest row: nodes on the sides of the box are not filled."""
    return (math.floor(level / dp + 0.25 - offset) - 0.5 + offset) * dp


def boat(dp=0.0125, time=0.2, density=500.0, offset=0.0):
    """A box afloat at the depth where it rests in the water that the particles are, at rest."""
    length, width, height, level, wall = 0.3, 0.2, 0.18, 0.12, 4 * dp
    sides = np.array((0.15, 0.1, 0.08))
    surface = level_of_rows(level, dp, offset)
    middle = np.array((length / 2 + 0.3 * dp, 0.2 * dp, surface + sides[2] * (0.5 - density / 1000)))
    tank_mesh = placed(make_meshes.trough([(0, 0), (length, 0)], length, width, height, wall), Y_UP)

    def depth(p, shift):
        inside = (sides / 2 - np.abs(p - middle)).min(1)
        return np.maximum(np.maximum(box_depth(p, length, width), -p[:, 2]), inside)

    low, high = (-wall, -width / 2 - wall, -wall), (length + wall, width / 2 + wall, height + 4 * dp)
    return Trial("boat", dp, {"tank.stl": tank_mesh, "boat.stl": placed(make_meshes.box(*sides), np.eye(3), middle)},
                 around(low, high, 2 * dp), (0.02, 0, level / 2), level, time, 10, depth, "still_water",
                 floating=f'<floatings><floating mkbound="1" rhopbody="{density:g}" /></floatings>', facts={"water_depth": surface})


def partition(dp=0.01, thick=4.0, time=0.2, level=0.12, low_level=0.06):
    """A tank cut in two by a wall `thick` dp thick, a part of its own; water at two levels on its sides."""
    length, width, height, wall = 0.2, 0.1, 0.18, 4 * dp
    tank_mesh = placed(make_meshes.trough([(0, 0), (length, 0)], length, width, height, wall), Y_UP)
    half = thick * dp / 2
    plate = placed(make_meshes.box(2 * half, width + 4 * dp, height + 2 * dp), np.eye(3), (length / 2, 0, height / 2 - dp))

    def depth(p, shift):
        inside = half - np.abs(p[:, 0] - length / 2)
        return np.maximum(np.maximum(box_depth(p, length, width), -p[:, 2]), inside)

    low, high = (-wall, -width / 2 - wall, -wall), (length + wall, width / 2 + wall, height)
    return Trial("partition", dp, {"tank.stl": tank_mesh, "plate.stl": plate}, around(low, high, 2 * dp), (0.02, 0, low_level / 2),
                 level, time, 10, depth, "parted_water", second=((length - 0.02, 0, low_level / 2), low_level),
                 facts={"water_depth": level, "middle": length / 2})


def gears(dp=0.005, gap=3.0, turn=60.0, sound=40.0, still=0.0):
    """Two gears of 12 and 16 teeth that turn in mesh in oil, in the plane y = 0; flanks and tips stay `gap` dp or more apart.

    turn   of the smaller one, degrees
    sound  speed of sound over that of the tips
    still  for so long, s, they stand instead, the oil at rest; 0: they turn
    """
    module, apart, rim = 8 * dp, 3 * dp, 4 * dp
    small, large = 6 * module, 8 * module  # pitch radii
    # Half of the play is in front of a tooth; the shafts that are moved apart give some of it.
    backlash = max(0.0, 2 * (gap * dp - apart * math.sin(math.radians(20)))) / math.cos(math.radians(20))
    length = 2 * (small + large) + apart + 2 * (module + rim)
    height = 2 * (large + module + rim)
    axis = height / 2
    level = axis + 20 * dp
    tank_mesh = placed(make_meshes.trough([(0, 0), (length, 0)], length, 8 * dp, height, 4 * dp), Y_UP)
    at_small = rim + module + small
    at_large = at_small + small + large + apart
    meshes, motions = {"tank.stl": tank_mesh}, []
    speed_sound = 20 * math.sqrt(GRAVITY * level)
    spin = math.degrees(speed_sound / sound / (small + module))
    for mk, (name, teeth, radius, x, turned, speed) in enumerate((
            ("small", 12, small, at_small, 0.0, spin), ("large", 16, large, at_large, 180 / 16, -spin * 12 / 16)), 1):
        mesh = make_meshes.gear(module, teeth, 6 * dp, 2 * (radius - 2.5 * module), backlash=backlash, turned=turned)
        meshes[name + ".stl"] = placed(mesh, Y_UP, (x, 0, axis))
        motions.append(f"""<objreal ref="{mk}"><begin mov="1" start="0" /><mvrot id="1" duration="10" anglesunits="degrees">
            <vel ang="{speed:.9g}" /><axisp1 x="{x:.9g}" y="0" z="{axis:.9g}" /><axisp2 x="{x:.9g}" y="1" z="{axis:.9g}" />
            </mvrot></objreal>""")

    def depth(p, shift):
        return np.maximum.reduce([-p[:, 0], p[:, 0] - length, -p[:, 2]])

    low, high = around((0, 0, 0), (length, 0, height), 30 * dp)
    if still:
        return Trial("gears", dp, meshes, ((low[0], 0, low[2]), (high[0], 0, high[2])), (length / 2, 0, 2 * dp), level, still, 10,
                     depth, "turning_gear", parameters={"Visco": 0.05}, facts={"water_depth": level})
    return Trial("gears", dp, meshes, ((low[0], 0, low[2]), (high[0], 0, high[2])), (length / 2, 0, 2 * dp), level, turn / spin, 15,
                 depth, "turning_gear", speed_sound=speed_sound, motion=f"<motion>{''.join(motions)}</motion>",
                 parameters={"Visco": 0.05}, facts={"water_depth": level})


CASES = {f.__name__: f for f in (rest, tank, wedge, cup, sphere, pipe, tilted, gear, gears, vessel, ball, boat, partition)}
