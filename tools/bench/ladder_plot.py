"""Plots a ladder: time and memory over particles, one column of panels a case, as an SVG file."""

import math

COLORS = {"lattice": "#0b6e4f", "body-fitted": "#c8553d", "relaxed": "#6a4c93", "GenCase": "#555555",
          "copying": "#2a7fff"}
PANEL_WIDTH, PANEL_HEIGHT, LEFT, TOP = 230, 200, 62, 46


def decades(values):
    low = math.floor(math.log10(min(values)) + 1e-9)
    high = math.ceil(math.log10(max(values)) - 1e-9)
    return low, max(high, low + 1)


def color_of(name):
    return next(color for word, color in COLORS.items() if name.startswith(word))


def series_of(results, case, key, scale):
    """name -> [(particles, value)], ascending; the time of copying is a series of its own."""
    series = {}
    for rung in results:
        if rung["case"] != case:
            continue
        copies = []
        for name, v in rung["variants"].items():
            if "failed" in v or not v["particles"]:
                continue
            series.setdefault(name, []).append((v["particles"], v[key] * scale))
            copies.append((v["particles"], v["cp_s"]))
        if key == "wall_s" and copies:
            series.setdefault("copying the output", []).append(copies[0])
    return {name: sorted(points) for name, points in series.items()}


def panel(out, x, y, title, unit, series, x_range, y_range):
    def place(particles, value):
        u = (math.log10(particles) - x_range[0]) / (x_range[1] - x_range[0])
        v = (math.log10(value) - y_range[0]) / (y_range[1] - y_range[0])
        return x + u * PANEL_WIDTH, y + PANEL_HEIGHT - v * PANEL_HEIGHT

    out.append(f'<rect x="{x}" y="{y}" width="{PANEL_WIDTH}" height="{PANEL_HEIGHT}" '
               'fill="none" stroke="#999"/>')
    out.append(f'<text x="{x + PANEL_WIDTH / 2}" y="{y - 8}" text-anchor="middle">{title}</text>')
    for e in range(x_range[0], x_range[1] + 1):
        px, _ = place(10.0 ** e, 10.0 ** y_range[0])
        out.append(f'<line x1="{px:.1f}" y1="{y}" x2="{px:.1f}" y2="{y + PANEL_HEIGHT}" stroke="#ddd"/>')
        out.append(f'<text x="{px:.1f}" y="{y + PANEL_HEIGHT + 16}" text-anchor="middle">'
                   f'{10.0 ** (e - 6):g}</text>')
    for e in range(y_range[0], y_range[1] + 1):
        _, py = place(10.0 ** x_range[0], 10.0 ** e)
        out.append(f'<line x1="{x}" y1="{py:.1f}" x2="{x + PANEL_WIDTH}" y2="{py:.1f}" stroke="#ddd"/>')
        out.append(f'<text x="{x - 6}" y="{py + 4:.1f}" text-anchor="end">{10.0 ** e:g}</text>')
    out.append(f'<text x="{x - 44}" y="{y + PANEL_HEIGHT / 2}" text-anchor="middle" '
               f'transform="rotate(-90 {x - 44} {y + PANEL_HEIGHT / 2})">{unit}</text>')
    for name, points in series.items():
        dash = ' stroke-dasharray="5 3"' if ", 1 thread" in name and "GenCase" not in name else ""
        places = [place(*p) for p in points]
        line = " ".join(f"{px:.1f},{py:.1f}" for px, py in places)
        color = color_of(name)
        out.append(f'<polyline points="{line}" fill="none" stroke="{color}" stroke-width="2"{dash}/>')
        out += [f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3" fill="{color}"/>' for px, py in places]


def write_plot(path, results, caption):
    """results  as run_bench.py collects them; rungs that are domains are left out."""
    cases = []
    for rung in results:
        if not rung["case"].startswith("domain") and rung["case"] not in cases:
            cases.append(rung["case"])
    rows = [("wall_s", 1, "seconds"), ("peak_rss", 1e-6, "memory, MB")]
    all_series = {(case, key): series_of(results, case, key, scale)
                  for case in cases for key, scale, _ in rows}
    points = [p for series in all_series.values() for line in series.values() for p in line]
    if not points:
        return
    x_range = decades([p[0] for p in points])
    names = list(dict.fromkeys(name for series in all_series.values() for name in series))
    width = LEFT + len(cases) * (PANEL_WIDTH + LEFT) + 10
    height = TOP + len(rows) * (PANEL_HEIGHT + TOP + 8) + 20 * ((len(names) + 2) // 3) + 30
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           'font-family="sans-serif" font-size="12">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for r, (key, _, unit) in enumerate(rows):
        values = [p[1] for case in cases for line in all_series[case, key].values() for p in line]
        y_range = decades(values)
        for c, case in enumerate(cases):
            panel(out, LEFT + c * (PANEL_WIDTH + LEFT), TOP + r * (PANEL_HEIGHT + TOP + 8),
                  case if r == 0 else "", unit, all_series[case, key], x_range, y_range)
    y = TOP + len(rows) * (PANEL_HEIGHT + TOP + 8)
    out.append(f'<text x="{LEFT}" y="{y - 12}">million particles; {caption}</text>')
    for n, name in enumerate(names):
        x = LEFT + n % 3 * 330
        row = y + 10 + 20 * (n // 3)
        dash = ' stroke-dasharray="5 3"' if ", 1 thread" in name and "GenCase" not in name else ""
        out.append(f'<line x1="{x}" y1="{row - 4}" x2="{x + 30}" y2="{row - 4}" '
                   f'stroke="{color_of(name)}" stroke-width="2"{dash}/>')
        out.append(f'<text x="{x + 38}" y="{row}">{name}</text>')
    out.append("</svg>")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n")
