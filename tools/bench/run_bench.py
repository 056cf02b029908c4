#!/usr/bin/python3
"""Times the whole program on a ladder of sizes and writes a JSON file, Markdown tables and a plot.

    run_bench.py --fppg build/release/fppg --quick          about a minute
    run_bench.py --fppg build/release/fppg                  0.1 to 20 million particles
    run_bench.py --fppg FPPG --case My_Def.xml --dp 0.01,0.005 --gencase GenCase_linux64

Every repetition runs all variants of a rung one after the other (lattice, body-fitted, threads,
GenCase, copying the output), so that noise of the machine meets all of them; reported are medians, and medians of the
ratios within one repetition. See README.md for the columns. Needs Python 3.9 and Linux only.
"""

import argparse
import json
import math
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from ladder_cases import write_domain_case
from ladder_plot import write_plot

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
OWN_CASES = ["sphere", "lump", "gear", "vehicle", "gearbox"]
MODES = {"lattice": "-fit:off", "body-fitted": "-fit:raw", "relaxed": "-fit"}
LADDER = [0.1, 1, 5, 20]
DOMAINS = [405, 805, 1205]
DOMAIN_DP = 0.01


class Failed(Exception):
    """A program stopped with an error; its last lines say why."""


def run_timed(command, folder):
    """Runs a program to its end. Times in seconds, memory in bytes.

    The kernel carries the peak memory of a process over exec, so nothing smaller than this
    script's own memory at its start can be seen (about 12 MB).
    """
    with tempfile.TemporaryFile() as output:
        start = time.monotonic()
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode("utf-8", "replace")
    if process.returncode != 0:
        tail = "\n".join(text.strip().splitlines()[-5:])
        raise Failed(f"{' '.join(command)}: exit code {process.returncode}\n{tail}")
    return {"wall_s": wall, "cpu_s": usage.ru_utime + usage.ru_stime, "user_s": usage.ru_utime,
            "sys_s": usage.ru_stime, "peak_rss": usage.ru_maxrss * 1024, "text": text}


def stage_times(text):
    """Seconds a stage, and a file: lines [Name-End  time:0.123s] and NAME  (time:0.123s)."""
    times = {}
    for name, seconds in re.findall(r"^\[(\w+)-End\s+time:([\d.]+)s?\]", text, re.MULTILINE):
        times[name] = float(seconds)
    for path, seconds in re.findall(r"^(\S.*?)(?:<\w+>)?\s+\(time:([\d.]+)s\)", text,
                                    re.MULTILINE):
        name = os.path.basename(path)
        times["write " + name.split("_", 1)[1] if "_" in name else "write " + name] = \
            float(seconds)
    return times


def particle_count(text):
    found = re.search(r"Total particles:\s*([\d,]+)", text)
    return int(found.group(1).replace(",", "")) if found else None


def files_of(folder):
    return sorted(os.path.join(folder, name) for name in os.listdir(folder))


class Variant:
    """One way to run a rung: a program with its arguments."""

    def __init__(self, name, program, threads, arguments):
        self.name, self.program, self.threads = name, program, threads
        self.arguments = arguments
        self.samples = []

    def sample(self, rung, work):
        """Runs the program, then copies what it wrote."""
        out = os.path.join(work, "out")
        copy = os.path.join(work, "copy")
        for folder in (out, copy):
            shutil.rmtree(folder, ignore_errors=True)
            os.mkdir(folder)
        definition = os.path.splitext(os.path.basename(rung["definition"]))[0]
        command = [self.program, definition, os.path.join(out, "Case"), *self.arguments]
        if rung["dp"] is not None:
            command.append(f"-dp:{rung['dp']:.9g}")
        result = run_timed(command, os.path.dirname(rung["definition"]))
        files = files_of(out)
        result["bytes"] = sum(os.path.getsize(f) for f in files)
        result["cp_s"] = run_timed(["cp", *files, copy], work)["wall_s"]
        text = result.pop("text")
        result["particles"] = particle_count(text)
        result["stages_s"] = stage_times(text)
        for folder in (out, copy):
            shutil.rmtree(folder)
        self.samples.append(result)

    def summary(self):
        def median(key):
            return statistics.median(s[key] for s in self.samples)

        stages = {}
        for name in self.samples[0]["stages_s"]:
            stages[name] = statistics.median(s["stages_s"].get(name, 0) for s in self.samples)
        particles = self.samples[0]["particles"]
        wall = median("wall_s")
        return {"threads": self.threads, "particles": particles,
                **{key: median(key) for key in ("wall_s", "cpu_s", "user_s", "sys_s", "peak_rss",
                                                "bytes", "cp_s")},
                "wall_min_s": min(s["wall_s"] for s in self.samples),
                "wall_max_s": max(s["wall_s"] for s in self.samples),
                "particles_per_s": particles / wall if particles else None,
                "ratio_to_cp": statistics.median(s["wall_s"] / s["cp_s"] for s in self.samples),
                "stages_s": stages, "samples": self.samples}


def median_ratio(ours, theirs, key):
    return statistics.median(a[key] / b[key] for a, b in zip(ours.samples, theirs.samples))


def unwritten(sample):
    """Seconds of the stages but for those that write."""
    return max(1e-3, sum(t for name, t in sample["stages_s"].items()
                         if not name.startswith(("write", "Save"))))


def power_law(points):
    """Least squares of log y over log x: (exponent, y at x = 1e6), of two points or more."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    spread = sum((x - mean_x) ** 2 for x, _ in logs)
    exponent = sum((x - mean_x) * (y - mean_y) for x, y in logs) / spread
    return exponent, math.exp(mean_y + exponent * (math.log(1e6) - mean_x))


def growth_table(results):
    """How time and memory grow from the rung of a million particles on (below it, starting up and
    reading meshes count), and with the nodes of the domain."""
    lines = ["| case | variant | time grows as | at a million, s | memory grows as | at a million, MB |",
             "| --- | --- | --- | --- | --- | --- |"]
    cases = list(dict.fromkeys(rung["case"].split(" ")[0] for rung in results))
    for case in cases:
        rungs = [r for r in results if r["case"].split(" ")[0] == case]
        names = list(dict.fromkeys(name for r in rungs for name in r["variants"]))
        for name in names:
            found = [(r, r["variants"][name]) for r in rungs
                     if "failed" not in r["variants"].get(name, {"failed": ""})]
            if case == "domain":
                points = [(int(r["case"].split(" ")[1].split("^")[0]) ** 3, v) for r, v in found]
            else:
                points = [(v["particles"], v) for _, v in found if v["particles"] >= 0.9e6]
            if len(points) < 2:
                continue
            time_law = power_law([(x, v["wall_s"]) for x, v in points])
            memory_law = power_law([(x, v["peak_rss"]) for x, v in points])
            unit = "nodes" if case == "domain" else "n"
            lines.append(f"| {case} | {name} | {unit}^{time_law[0]:.2f} | {time_law[1]:.3f} | "
                         f"{unit}^{memory_law[0]:.2f} | {memory_law[1] / 1e6:.0f} |")
    return "\n".join(lines) if len(lines) > 2 else ""


def count_at(fppg, definition, dp, work):
    command = [fppg, os.path.splitext(os.path.basename(definition))[0],
               os.path.join(work, "count"), "-save:-all"]
    if dp is not None:
        command.append(f"-dp:{dp:.9g}")
    text = run_timed(command, os.path.dirname(definition))["text"]
    spacing = float(re.search(r"Distance between points \(Dp\): ([-+\d.eE]+)", text).group(1))
    return particle_count(text), spacing


def dp_for(fppg, definition, wanted, work):
    """The particle distance that gives about `wanted` particles (within 5 %)."""
    count, dp = count_at(fppg, definition, None, work)
    exponent = 3.0
    for _ in range(5):
        if abs(count / wanted - 1) < 0.05:
            break
        new_dp = float(f"{dp * (count / wanted) ** (1 / exponent):.6g}")
        new_count, _ = count_at(fppg, definition, new_dp, work)
        if new_dp != dp and new_count != count:
            # Walls grow with dp^-2, water with dp^-3.
            exponent = min(3.5, max(1.5, math.log(new_count / count) / math.log(dp / new_dp)))
        count, dp = new_count, new_dp
    return dp


def make_rungs(options, work):
    rungs = []
    if options.case:
        for definition in options.case:
            for dp in options.dp or [None]:
                name = os.path.basename(definition).replace("_Def.xml", "")
                rungs.append({"case": name, "definition": os.path.abspath(definition), "dp": dp})
        return rungs
    if options.folder:
        own = {name.replace("_Def.xml", ""): os.path.abspath(os.path.join(options.folder, name))
               for name in sorted(os.listdir(options.folder)) if name.endswith("_Def.xml")}
    else:
        # A process of its own: what this one needs at most is the least that run_timed sees.
        own = json.loads(subprocess.run(
            [sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                          "ladder_cases.py"), work],
            check=True, capture_output=True, text=True).stdout)
    for case in options.only or [*own, "domain"]:
        if case == "domain":
            rungs += [{"case": f"domain {n}^3", "definition": write_domain_case(work, n, DOMAIN_DP), "dp": None}
                      for n in options.domains]
            continue
        if case not in own:
            raise Failed(f"{case}: no such case; there are {', '.join(own)} and domain")
        definition = own[case]
        for million in options.millions:
            print(f"looking for the dp of {case} at {million:g} million particles",
                  file=sys.stderr)
            rungs.append({"case": case, "definition": definition,
                          "million": million,
                          "dp": dp_for(options.fppg, definition, million * 1e6, work)})
    return rungs


def measure(rung, options, work):
    save = [f"-save:{options.save}"] if options.save else []
    variants = []
    for threads in options.threads:
        suffix = f"{threads} thread" + ("s" if threads > 1 else "")
        for mode in options.modes:
            if mode == "relaxed" and rung.get("million", 0) > options.relax_up_to:
                continue
            if mode != "lattice" and rung["case"].startswith("domain"):
                continue
            variants.append(Variant(f"{mode}, {suffix}", options.fppg, threads,
                                    [*save, MODES[mode], f"-threads:{threads}"]))
    if options.gencase:
        threads = max(options.threads)
        variants.append(Variant(f"GenCase, {threads} threads", options.gencase, threads,
                                [*save, f"{options.gencase_threads}:{threads}"]))
    failed = {}
    for repetition in range(options.repeat):
        # Another one starts each time, so that none always follows the same neighbour.
        turn = repetition % len(variants)
        for variant in variants[turn:] + variants[:turn]:
            if variant.name in failed:
                continue
            try:
                variant.sample(rung, work)
            except Failed as error:
                if variant.program == options.fppg:
                    raise
                failed[variant.name] = str(error)
    result = {"case": rung["case"], "dp": rung["dp"], "variants": {}}
    for variant in variants:
        if variant.name in failed:
            result["variants"][variant.name] = {"threads": variant.threads,
                                                "failed": failed[variant.name]}
        else:
            result["variants"][variant.name] = variant.summary()
    if options.gencase:
        theirs = variants[-1]
        for ours in variants[:-1]:
            if theirs.name in failed:
                continue
            summary = result["variants"][ours.name]
            summary["wall_to_gencase"] = median_ratio(ours, theirs, "wall_s")
            summary["rss_to_gencase"] = median_ratio(ours, theirs, "peak_rss")
    if min(options.threads) == 1 and max(options.threads) > 1:
        for mode in options.modes:
            several = next((v for v in variants
                            if v.name.startswith(mode) and v.threads == max(options.threads)), None)
            one = next((v for v in variants if v.name == f"{mode}, 1 thread"), None)
            if one and several:
                result["variants"][several.name]["speed_up"] = median_ratio(one, several, "wall_s")
                result["variants"][several.name]["speed_up_unwritten"] = statistics.median(
                    unwritten(a) / unwritten(b) for a, b in zip(one.samples, several.samples))
    return result


def table(results):
    lines = ["| case | dp | variant | particles | wall s | min to max s | user+sys s | "
             "peak RSS MB | million particles/s | written MB | wall / cp | wall / GenCase | "
             "RSS / GenCase | speed-up | without writing |",
             "| --- " * 15 + "|"]
    for rung in results:
        for name, v in rung["variants"].items():
            dp = f"{rung['dp']:g}" if rung["dp"] is not None else ""
            if "failed" in v:
                lines.append(f"| {rung['case']} | {dp} | {name} | failed | | | | | | | | | | | |")
                continue
            speed = f"{v['particles_per_s'] / 1e6:.2f}" if v["particles_per_s"] else ""
            pair = [f"{v[key]:.3f}" if key in v else ""
                    for key in ("wall_to_gencase", "rss_to_gencase")]
            pair += [f"{v[key]:.2f}" if key in v else ""
                     for key in ("speed_up", "speed_up_unwritten")]
            lines.append(
                f"| {rung['case']} | {dp} | {name} | {v['particles'] or ''} | {v['wall_s']:.3f} | "
                f"{v['wall_min_s']:.3f} to {v['wall_max_s']:.3f} | {v['cpu_s']:.3f} | "
                f"{v['peak_rss'] / 1e6:.0f} | {speed} | {v['bytes'] / 1e6:.1f} | "
                f"{v['ratio_to_cp']:.2f} | {' | '.join(pair)} |")
    return "\n".join(lines)


def stage_table(results):
    rows = [(rung, name, v["stages_s"]) for rung in results
            for name, v in rung["variants"].items() if "stages_s" in v
            and not name.startswith("GenCase")]
    stages = []
    for _, _, times in rows:
        stages += [s for s in times if s not in stages]
    lines = ["| case | dp | variant | " + " | ".join(stages) + " |",
             "| --- " * (3 + len(stages)) + "|"]
    for rung, name, times in rows:
        dp = f"{rung['dp']:g}" if rung["dp"] is not None else ""
        cells = [f"{times[s]:.3f}" if s in times else "" for s in stages]
        lines.append(f"| {rung['case']} | {dp} | {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def numbers(text):
    return [float(word) for word in text.split(",")]


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fppg", required=True, help="the program")
    parser.add_argument("--gencase", help="a GenCase program, run in pairs with fppg")
    parser.add_argument("--gencase-threads", default="-threads",
                        help="its option for threads (default %(default)s)")
    parser.add_argument("--case", action="append", metavar="DEF.xml",
                        help="this case instead of the repository's own; may be repeated")
    parser.add_argument("--dp", type=numbers, metavar="LIST", help="particle distances for --case")
    parser.add_argument("--folder", help="a folder of definitions to climb the ladder with, instead "
                        "of the repository's own")
    parser.add_argument("--only", action="append", metavar="CASE",
                        help=f"only this case ({', '.join(OWN_CASES)}, domain); may be repeated")
    parser.add_argument("--modes", type=lambda t: t.split(","), default=["lattice", "body-fitted"],
                        metavar="LIST", help="of lattice, body-fitted (without relaxation) and "
                        "relaxed (default lattice,body-fitted)")
    parser.add_argument("--relax-up-to", type=float, default=1, metavar="MILLIONS",
                        help="largest rung that is relaxed (default 1)")
    parser.add_argument("--millions", type=numbers, default=LADDER, metavar="LIST",
                        help="million particles of the rungs (default 0.1,1,5,20)")
    parser.add_argument("--larger", action="store_true",
                        help="rungs of 50 and 100 million particles too")
    parser.add_argument("--threads", type=lambda t: [int(n) for n in t.split(",")],
                        default=[1, 2], metavar="LIST", help="threads (default 1,2)")
    parser.add_argument("--repeat", type=int, default=5, metavar="N",
                        help="repetitions (default 5)")
    parser.add_argument("--save", metavar="LIST", help="files to write, as in the program's "
                        "-save (default: the program's own, bi4 and cells)")
    parser.add_argument("--quick", action="store_true",
                        help="three repetitions of 0.1 and 1 million particles, two domains")
    parser.add_argument("--work", metavar="FOLDER", help="where outputs go for the time of a run "
                        "(default: a temporary folder)")
    parser.add_argument("--out", default="bench", metavar="NAME",
                        help="NAME.json, NAME.md and NAME.svg are written (default %(default)s)")
    options = parser.parse_args()
    if options.repeat < 1 or min(options.threads) < 1 or min(options.millions) <= 0:
        parser.error("repetitions, threads and sizes must be above zero")
    if options.dp and not options.case:
        parser.error("--dp goes with --case")
    if not set(options.modes) <= set(MODES):
        parser.error(f"modes are {', '.join(MODES)}")
    options.domains = DOMAINS
    if options.quick:
        options.repeat, options.millions, options.domains = 3, [0.1, 1], [405, 1205]
    if options.larger:
        options.millions = options.millions + [50, 100]
    options.fppg = os.path.abspath(options.fppg)
    if options.gencase:
        options.gencase = os.path.abspath(options.gencase)
    return options


def processor():
    """The model of the processor, as the kernel names it."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else platform.machine()


def main():
    options = parse_options()
    with tempfile.TemporaryDirectory(prefix="fppg-bench-", dir=options.work) as work:
        results = []
        for rung in make_rungs(options, work):
            print(f"measuring {rung['case']}, dp {rung['dp']}", file=sys.stderr)
            results.append(measure(rung, options, work))
    machine = {"system": platform.platform(), "cpus": len(os.sched_getaffinity(0)),
               "processor": processor(), "load": os.getloadavg(), "date": time.strftime("%Y-%m-%d %H:%M:%S"),
               "repetitions": options.repeat}
    with open(options.out + ".json", "w", encoding="utf-8") as file:
        json.dump({"machine": machine, "results": results}, file, indent=1)
        file.write("\n")
    caption = (f"{machine['date']}, {machine['processor']}, {machine['cpus']} CPUs, "
               f"medians of {options.repeat} repetitions")
    text = (f"{caption}; {machine['system']}\n\n{table(results)}\n\nGrowth:\n\n"
            f"{growth_table(results)}\n\nSeconds a stage:\n\n{stage_table(results)}\n")
    write_plot(options.out + ".svg", results, caption)
    with open(options.out + ".md", "w", encoding="utf-8") as file:
        file.write(text)
    print(text)


if __name__ == "__main__":
    try:
        main()
    except Failed as error:
        sys.exit(str(error))
