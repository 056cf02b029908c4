#!/usr/bin/python3
"""Draws particles as small shaded balls, coloured by mk, into a PNG image.

    plot_particles.py CASE out.png [--view iso] [--cut "y>0.3"] [--mk 10,11] [--hide 1] [--width 1200]

CASE is a VTK file of particles, or a case (Case.bi4 with its Case.xml). The view is orthographic:
iso, or from the front, back, left, right, top or bottom, or AZIMUTH,ELEVATION in degrees. --cut
keeps the particles for which it holds and may be given more than once. The legend on standard output names the colour of every mk.
Needs python3-numpy; writes the PNG itself.
"""

import argparse
import os
import struct
import sys
import zlib

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from particle_files import read_particles  # noqa: E402 (found by the path above)

# Azimuth: 0 looks along +y, from the front; elevation: 90 looks straight down.
VIEWS = {"iso": (30, 30), "front": (0, 0), "back": (180, 0), "left": (-90, 0), "right": (90, 0),
         "top": (0, 90), "bottom": (0, -90)}

# Told apart also with impaired colour vision; the first is for the lowest mk, mostly fluid.
PALETTE = {"blue": (86, 156, 214), "grey": (165, 165, 165), "vermilion": (213, 94, 0),
           "green": (0, 158, 115), "yellow": (240, 228, 66), "purple": (204, 121, 167),
           "orange": (230, 159, 0), "dark blue": (0, 72, 130), "brown": (120, 80, 50),
           "light green": (160, 210, 130)}


def write_png(path, image):
    """image: height x width x 3, uint8."""

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    height, width, _ = image.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each row begins with its filter, none
    rows[:, 1:] = image.reshape(height, -1)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n"
                   + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))


def view_axes(view):
    """Rows: right, up, towards the viewer."""
    try:
        azimuth, elevation = VIEWS[view] if view in VIEWS else map(float, view.split(","))
    except ValueError:
        sys.exit(f"plot_particles.py: --view {view}: expected {', '.join(VIEWS)} or two angles")
    a, e = np.radians(azimuth), np.radians(elevation)
    right = np.array([np.cos(a), np.sin(a), 0])
    towards = np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])
    return np.array([right, np.cross(towards, right), towards])


def kept(cuts, positions):
    """Which particles every --cut leaves."""
    keep = np.ones(len(positions), bool)
    for cut in cuts:
        try:
            coordinate, limit = positions[:, "xyz".index(cut[0])], float(cut[2:])
            sign = {"<": 1, ">": -1}[cut[1]]
        except (ValueError, KeyError, IndexError):
            sys.exit(f"plot_particles.py: --cut {cut}: expected for example 'y>0.3' or 'z<1'")
        keep &= sign * (coordinate - limit) <= 1e-9
    return keep


def spacing(positions):
    """Distance between lattice neighbours: the commonest small step along an axis."""
    steps = []
    for axis in range(3):
        values = np.unique(np.round(positions[:, axis], 7))
        if len(values) > 1:
            steps.append(np.median(np.diff(values)))
    return max(steps) if steps else 1.0


def draw(positions, colours, radius, axes, width):
    """An image of balls of `radius` metres; pixels of the nearest ball win."""
    seen = positions @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    margin = 0.03 * max(high[0] - low[0], high[1] - low[1]) + 2 * radius
    scale = 2 * width / (high[0] - low[0] + 2 * margin)  # drawn twice as large, then averaged
    n_x, n_y = 2 * width, 2 * max(1, round(scale * (high[1] - low[1] + 2 * margin) / 2))
    x = (seen[:, 0] - low[0] + margin) * scale
    y = (high[1] - seen[:, 1] + margin) * scale
    pixels = max(radius * scale, 0.71)
    near = np.full(n_x * n_y, -np.inf)
    owner = np.full(n_x * n_y, -1)
    bright = np.zeros(n_x * n_y)
    light = np.array([-0.4, 0.6, 0.69])
    reach = int(np.ceil(pixels))
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            left = 1 - (dx * dx + dy * dy) / pixels**2
            if left <= 0:
                continue
            column, row = np.floor(x).astype(int) + dx, np.floor(y).astype(int) + dy
            index = np.flatnonzero((column >= 0) & (column < n_x) & (row >= 0) & (row < n_y))
            place = row[index] * n_x + column[index]
            depth = seen[index, 2] + radius * np.sqrt(left)
            front = depth > near[place]
            index, place, depth = index[front], place[front], depth[front]
            order = np.lexsort((index, depth))  # of several on one pixel the last, nearest stays
            index, place, depth = index[order], place[order], depth[order]
            near[place], owner[place] = depth, index
            bright[place] = max(0.0, np.array([dx / pixels, -dy / pixels, left**0.5]) @ light)
    image = np.full((n_x * n_y, 3), 255.0)
    hit = owner >= 0
    back = 0.75 + 0.25 * (near[hit] - low[2]) / max(high[2] - low[2], 1e-12)
    image[hit] = colours[owner[hit]] * ((0.35 + 0.65 * bright[hit]) * np.clip(back, 0, 1))[:, None]
    image = image.reshape(n_y // 2, 2, n_x // 2, 2, 3).mean(axis=(1, 3))
    return np.clip(image, 0, 255).astype(np.uint8)


def numbers(text):
    return [int(word) for word in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("png")
    parser.add_argument("--view", default="iso")
    parser.add_argument("--cut", action="append", default=[], metavar="CONDITION")
    parser.add_argument("--mk", type=numbers, help="draw only these (absolute mk)")
    parser.add_argument("--hide", type=numbers, default=[], help="draw all but these")
    parser.add_argument("--width", type=int, default=1200, help="of the image, pixels")
    parser.add_argument("--radius", type=float, help="of a ball, metres; default half the spacing")
    options = parser.parse_args()

    positions, mk = read_particles(options.case)
    all_mk = np.unique(mk)
    names = list(PALETTE)
    radius = options.radius or 0.5 * spacing(positions)
    keep = kept(options.cut, positions) & ~np.isin(mk, options.hide)
    if options.mk:
        keep &= np.isin(mk, options.mk)
    if not keep.any():
        sys.exit(f"plot_particles.py: {options.case}: no particle is left to draw")
    table = np.array([PALETTE[names[i % len(names)]] for i in range(len(all_mk))], float)
    colours = table[np.searchsorted(all_mk, mk[keep])]
    image = draw(positions[keep], colours, radius, view_axes(options.view), options.width)
    write_png(options.png, image)
    for i, value in enumerate(all_mk):
        print(f"mk {value}: {names[i % len(names)]}, {np.count_nonzero(keep & (mk == value))} drawn")


if __name__ == "__main__":
    main()
