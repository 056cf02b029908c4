"""Reads what the solver wrote for a trial, and judges it."""

import csv
import glob
import json
import os
import subprocess

import numpy as np
from particle_files import read_bi4, read_blocks

from case_xml import read_xml


class Run:
    """A trial's folder after the solver: the particles of the case and its outputs.

    trial   the Trial
    folder  with Case.xml, Case.bi4 and sim/data
    """

    def __init__(self, trial, folder, fppg):
        self.trial, self.folder, self.fppg = trial, folder, fppg
        self.blocks = read_blocks(os.path.join(folder, "Case.xml"))
        self.first_fluid = min(b["begin"] for b in self.blocks if b["type"] == "fluid")
        self.parts = sorted(glob.glob(os.path.join(folder, "sim", "data", "Part_[0-9]*.bi4")))
        self.fluid_at_start = sum(b["count"] for b in self.blocks if b["type"] == "fluid")
        self.walls = sum(b["count"] for b in self.blocks) - self.fluid_at_start

    def constant(self, name):
        element = read_xml(os.path.join(self.folder, "Case.xml")).find(f"case/execution/constants/{name}")
        return float(element.get("value"))

    def outputs(self):
        """(time, fluid, shift) of each: fluid is a dict of id, pos, vel, rho; shift how far the walls have moved."""
        start = None
        for path in self.parts:
            values, arrays = read_bi4(path)
            ids = arrays["Idp"]
            order = np.argsort(ids)
            ids = ids[order]
            pos = (arrays["Posd"] if "Posd" in arrays else arrays["Pos"])[order].astype(float)
            is_fluid = ids >= self.first_fluid
            wall = pos[~is_fluid].mean(0)
            start = wall if start is None else start
            vel, rho = (arrays[k][order][is_fluid].astype(float) for k in ("Vel", "Rhop"))
            yield values["TimeStep"], {"id": ids[is_fluid], "pos": pos[is_fluid], "vel": vel, "rho": rho}, wall - start

    def excluded(self):
        """Particles that the solver took out, by cause, over the run."""
        with open(os.path.join(self.folder, "sim", "RunPARTs.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file, delimiter=";"))
        out = {}
        for row in rows:
            for key, value in row.items():
                if key and key.startswith("NpOut"):
                    out[key] = out.get(key, 0) + int(float((value or "0").replace(",", "")))
        return out


def series_of(run, more):
    """One dict for each output: time, speeds, lost, in_wall (deeper than 1 dp behind the true surface) and what `more` adds."""
    out = []
    for time, fluid, shift in run.outputs():
        speed = np.linalg.norm(fluid["vel"], axis=1)
        depth = run.trial.depth(fluid["pos"], shift) / run.trial.dp
        row = {"time": time, "largest_speed": speed.max(initial=0), "mean_speed": speed.mean() if len(speed) else 0,
               "lost": run.fluid_at_start - len(speed), "in_wall": int((depth > 1).sum()), "deepest_dp": depth.max(initial=-1),
               "rho": [float(fluid["rho"].min()), float(fluid["rho"].max())]}
        row.update(more(time, fluid, shift, depth))
        out.append({k: float(v) if isinstance(v, np.floating) else v for k, v in row.items()})
    return out


def still_water(run):
    """Speeds; errors of the pressure against that of the depth below the level that fits best, over rho g H."""
    b, gravity = run.constant("b"), 9.81
    height = run.trial.facts["water_depth"]

    def pressure(time, fluid, shift, depth):
        z = fluid["pos"][:, 2]
        p = b * ((fluid["rho"] / 1000) ** 7 - 1)
        # Level of the water that the pressures say; the spray above 2 dp below it has none.
        level = float(np.median(p / (1000 * gravity) + z))
        under = z < level - 2 * run.trial.dp
        error = (p - 1000 * gravity * (level - z))[under] / (1000 * gravity * height)
        near = (depth > -2)[under]
        size = np.abs(error)
        return {"level": level, "p_rms": float(np.sqrt((error**2).mean())) if len(error) else 0,
                "p_largest": float(size.max(initial=0)),
                "p_99": float(np.percentile(size, 99)) if len(size) else 0,
                "p_rms_near_wall": float(np.sqrt((error[near] ** 2).mean())) if near.any() else 0}

    series = series_of(run, pressure)
    last = series[-max(1, len(series) // 5):]
    result = {k: float(np.mean([r[k] for r in last])) for k in ("mean_speed", "p_rms", "p_99", "p_rms_near_wall")}
    result.update({k: float(np.max([r[k] for r in last])) for k in ("largest_speed", "p_largest")})
    result["largest_ever"] = max(r["largest_speed"] for r in series)
    result["mean_ever"] = float(np.mean([r["mean_speed"] for r in series[1:]]))
    result["lost"], result["in_wall"] = series[-1]["lost"], max(r["in_wall"] for r in series)
    result["deepest_dp"] = max(r["deepest_dp"] for r in series)
    return result, series


def parted_water(run):
    """Water that went from one side of a wall to the other, and the speeds."""
    middle = run.trial.facts["middle"]
    start = {}

    def crossed(time, fluid, shift, depth):
        is_first = fluid["pos"][:, 0] < middle
        if not start:
            start.update(zip(fluid["id"].tolist(), is_first.tolist()))
        deep = (depth > 0.5).sum()
        return {"crossed": int(sum(start[i] != f for i, f in zip(fluid["id"].tolist(), is_first.tolist()))), "deep": int(deep)}

    series = series_of(run, crossed)
    last = series[-max(1, len(series) // 5):]
    return {"mean_speed": float(np.mean([r["mean_speed"] for r in last])), "largest_speed": max(r["largest_speed"] for r in last),
            "largest_ever": max(r["largest_speed"] for r in series), "crossed": max(r["crossed"] for r in series),
            "deeper_than_half_dp": max(r["deep"] for r in series), "lost": series[-1]["lost"]}, series


def pipe_flow(radius, viscosity, force, times, nodes=400):
    """Speeds (times, nodes) on the radii (nodes) of flow that starts from rest, by finite volumes and Crank-Nicolson."""
    edges = np.linspace(0, radius, nodes + 1)
    r = (edges[1:] + edges[:-1]) / 2
    dr, volume = edges[1], (edges[1:] ** 2 - edges[:-1] ** 2) / 2
    operator = np.zeros((nodes, nodes))
    for i in range(nodes - 1):
        flux = edges[i + 1] / dr
        operator[i, i] -= flux
        operator[i, i + 1] += flux
        operator[i + 1, i + 1] -= flux
        operator[i + 1, i] += flux
    operator[-1, -1] -= radius / (dr / 2)
    values, vectors = np.linalg.eig(viscosity * operator / volume[:, None])
    weights = np.linalg.solve(vectors, np.full(nodes, force))
    speeds = [(vectors @ (weights * np.expm1(values * t) / values)).real for t in times]
    return r, np.array(speeds)


def poiseuille(run):
    """The profile of the speed along the axis against that of a flow that started from rest, relative L2 error."""
    facts = run.trial.facts
    axis = np.array(facts["axis"])
    outputs = list(run.outputs())
    radii, exact = pipe_flow(facts["radius"], facts["viscosity"], facts["force"], [t for t, _, _ in outputs])
    rows = iter(exact)

    def profile(time, fluid, shift, depth):
        speeds = next(rows)
        r = depth * run.trial.dp + facts["radius"]
        along = fluid["vel"] @ axis
        want = np.interp(r, np.append(radii, facts["radius"]), np.append(speeds, 0))
        if not time or not len(r):
            return {"error_l2": 0.0}
        edges = np.linspace(0, facts["radius"], 9)
        where = np.digitize(r, edges)
        bins = [[float(np.mean(v[where == k])) if (where == k).any() else None for k in range(1, 9)] for v in (along, want)]
        across = np.linalg.norm(fluid["vel"] - along[:, None] * axis, axis=1)
        return {"error_l2": float(np.sqrt(((along - want) ** 2).sum() / (want**2).sum())),
                "flux": float(along.mean() / want.mean()), "peak": float(along.max() / speeds.max()),
                "cross": float(np.sqrt((across**2).mean()) / speeds.max()), "profile": bins}

    series = series_of(run, profile)
    last = series[-1]
    result = {k: last[k] for k in ("error_l2", "flux", "peak", "cross", "lost") if k in last}
    result["in_wall"] = max(r["in_wall"] for r in series)
    return result, series


def jerked_vessel(run):
    """Fluid through the sheet: more than half a dp outside, below the rim, and never above it before; lost: likewise."""
    over, lost = set(), []
    first = np.arange(run.first_fluid, run.first_fluid + run.fluid_at_start)
    rim = run.trial.facts["rim"]

    def through(time, fluid, shift, depth):
        z = fluid["pos"][:, 2] - shift[2]
        over.update(fluid["id"][z > rim].tolist())
        out = fluid["id"][(depth > 0.5) & (z <= rim)]
        lost[:] = [i for i in np.setdiff1d(first, fluid["id"]).tolist() if i not in over]
        return {"through": int(sum(i not in over for i in out.tolist())), "over_rim": len(over), "lost": len(lost),
                "shift": float(shift[0])}

    series = series_of(run, through)
    result = {"through": max(r["through"] for r in series), "lost": series[-1]["lost"],
              "largest_speed": max(r["largest_speed"] for r in series), "over_rim": len(over)}
    return result, series


def turning_gear(run):
    """Fluid in solids by `fppg leak`, and the speeds."""
    path = os.path.join(run.folder, "leak.json")
    subprocess.run([run.fppg, "leak", os.path.join(run.folder, "Case"), os.path.join(run.folder, "sim", "data"), "--threads", "1",
                    "--definition", os.path.join(run.folder, "Case_Def.xml"), "--json", path], check=False, capture_output=True)
    with open(path, encoding="utf-8") as file:
        leak = json.load(file)
    series = series_of(run, lambda *_: {})
    told = leak["outputs"]
    for row, there in zip(series, told):
        row.update({k: there[k] for k in ("inside", "deeper_than_half_dp", "deepest_dp")})
    result = {"inside": max(o["inside"] for o in told), "deeper_than_half_dp": max(o["deeper_than_half_dp"] for o in told),
              "deepest_dp": max(o["deepest_dp"] for o in told), "lost": series[-1]["lost"],
              "largest_speed": max(r["largest_speed"] for r in series), "last_largest": series[-1]["largest_speed"],
              "mean_speed": series[-1]["mean_speed"]}
    return result, series


def afloat(run):
    """How far the middle of a ball that should float on the water's surface stands above it, and its mass over the true one.

    The surface is half a dp above the highest particles of columns of dp beyond 1.5 radii from the ball.
    """
    facts, dp = run.trial.facts, run.trial.dp
    radius = facts["radius"]
    block = next(b for b in run.blocks if b["type"] == "floating")
    series, start = [], None
    for path in run.parts:
        values, arrays = read_bi4(path)
        order = np.argsort(arrays["Idp"])
        ids, pos = arrays["Idp"][order], (arrays["Posd"] if "Posd" in arrays else arrays["Pos"])[order].astype(float)
        body = pos[(ids >= block["begin"]) & (ids < block["begin"] + block["count"])].mean(0)
        start = body if start is None else start
        middle = np.array(facts["middle"]) + body - start
        fluid = pos[ids >= run.first_fluid]
        speed = np.linalg.norm(arrays["Vel"][order][ids >= run.first_fluid], axis=1)
        far = fluid[np.hypot(fluid[:, 0] - middle[0], fluid[:, 1] - middle[1]) > 1.5 * radius]
        _, column = np.unique(np.floor(far[:, :2] / dp).astype(int), axis=0, return_inverse=True)
        tops = np.full(column.max() + 1, -np.inf)
        np.maximum.at(tops, column.ravel(), far[:, 2])
        surface = float(np.median(tops)) + dp / 2
        series.append({"time": float(values["TimeStep"]), "above_mm": float(1000 * (middle[2] - surface)),
                       "risen_mm": float(1000 * (middle[2] - facts["middle"][2])),
                       "aside_mm": float(1000 * np.hypot(*(middle - facts["middle"])[:2])),
                       "largest_speed": float(speed.max()), "lost": run.fluid_at_start - len(fluid)})
    last = series[-len(series) // 2:]
    mass = float(read_xml(os.path.join(run.folder, "Case.xml")).find("case/execution/particles/floating/massbody").get("value"))
    true = facts["density"] * 4 / 3 * np.pi * radius**3
    return {"mass": mass / true, "above_mm": float(np.mean([r["above_mm"] for r in last])),
            "swing_mm": max(r["above_mm"] for r in last) - min(r["above_mm"] for r in last),
            "aside_mm": series[-1]["aside_mm"], "largest_speed": max(r["largest_speed"] for r in last),
            "lost": series[-1]["lost"]}, series
