#!/usr/bin/python3
"""Runs small cases with known answers in the DualSPHysics v5.4 solver, their walls made in several ways, and judges them.

    run_trials.py run   --fppg FPPG --solver SOLVER --work DIR --case CASE ... --variant VARIANT ...
    run_trials.py table --work DIR          results as markdown tables
    run_trials.py list                      cases, their arguments, and variants

CASE is a name with arguments, several values separated by commas: vessel:dp=0.01,0.005:speed=1,2,4,8. VARIANT is a name,
with parameters of the solver and attributes of <bodyfitted> behind it: layers:SlipMode=3:side=both. A result that is
there already is kept, unless --again. Each run is one thread at low priority.
"""

import argparse
import glob
import functools
import inspect
import itertools
import json
import os
import shutil
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..")]
import trial_cases  # noqa: E402 (found by the path above)
import trial_definition  # noqa: E402
import trial_measures  # noqa: E402
from period_cut import cut_period  # noqa: E402


def trials_of(text):
    """(label, maker) of NAME[:key=value[,value...]...], one for each combination of values; maker(variant) is the Trial."""
    name, *words = text.split(":")
    if name not in trial_cases.CASES:
        sys.exit(f"{name}: expected one of {', '.join(trial_cases.CASES)}")
    make = trial_cases.CASES[name]
    known = inspect.signature(make).parameters
    keys, lists = [], []
    for word in words:
        key, mark, values = word.partition("=")
        if not mark or key not in known:
            sys.exit(f"{text}: {word}: expected {', '.join(k + '=' for k in known)}")
        keys.append(key)
        lists.append([type(known[key].default)(v) for v in values.split(",")])
    for chosen in itertools.product(*lists):
        given = dict(zip(keys, chosen))
        shown = {k: given.get(k, p.default) for k, p in known.items() if k != "offset"}
        yield ":".join([name, *(f"{k}={v:g}" for k, v in shown.items())]), functools.partial(make_trial, make, given)


def make_trial(make, given, variant):
    """The Trial of a case; one that asks for the offset of the lattice has that of the variant."""
    asks = "offset" in inspect.signature(make).parameters
    return make(**({"offset": variant.offset} if asks else {}) | given)


def run_program(words, log, environment=None, limit=None):
    """Runs a program at low priority, its output to a file: exit code and seconds of processor time."""
    with open(log, "wb") as file:
        process = subprocess.Popen(["nice", "-n", "10", *words], stdout=file, stderr=subprocess.STDOUT, env=environment)
        begin = time.monotonic()
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime
            if limit and time.monotonic() - begin > limit:
                process.kill()
                limit = None
            time.sleep(0.05)


def last_lines(path, count=6):
    with open(path, encoding="utf-8", errors="replace") as file:
        return [line.rstrip() for line in file.readlines() if line.strip()][-count:]


def warnings_in(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return [line.strip()[:300] for line in file if "WARNING" in line or "normal data" in line]


def run_trial(arguments, label, maker, variant_text):
    """Makes, runs and judges one trial; the result as a dict."""
    variant = trial_definition.variant_of(variant_text)
    trial = maker(variant)
    result = {"case": label, "variant": variant_text, "dp": trial.dp, "facts": trial.facts}
    folder = os.path.join(arguments.work, "runs", file_name(label, variant_text))
    shutil.rmtree(folder, ignore_errors=True)
    trial_definition.write_trial(trial, variant, folder)
    case = os.path.join(folder, "Case")
    words = [arguments.fppg, case + "_Def", case, "-threads:1"] + ([] if variant.is_fitted else ["-fit:off"])
    code, seconds = run_program(words, os.path.join(folder, "fppg.log"))
    result.update(fppg_seconds=seconds, warnings=warnings_in(os.path.join(folder, "fppg.log")))
    if code:
        return {**result, "failed": f"fppg: {code}", "log": last_lines(os.path.join(folder, "fppg.log"))}
    if trial.measure == "poiseuille":
        facts = trial.facts
        result["cut_pairs"] = cut_period(case, trial.dp, facts["period"], (facts["period"], 0.0, facts["rise"]))
    environment = {**os.environ, "OMP_WAIT_POLICY": "passive"}
    if arguments.library_path:
        environment["LD_LIBRARY_PATH"] = arguments.library_path
    log = os.path.join(folder, "solver.log")
    code, seconds = run_program([arguments.solver, case, os.path.join(folder, "sim"), "-cpu", "-ompthreads:1"], log, environment,
                                arguments.limit)
    run = trial_measures.Run(trial, folder, arguments.fppg)
    result.update(solver_seconds=seconds, solver_code=code, fluid=run.fluid_at_start, walls=run.walls)
    result["solver_warnings"] = warnings_in(log)
    if code and len(run.parts) < 3:
        return {**result, "failed": f"solver: {code}", "log": last_lines(log)}
    if code:
        result["stopped"] = last_lines(log, 3)
    measures, series = getattr(trial_measures, trial.measure)(run)
    result.update(measures=measures, series=series, excluded=run.excluded() if not code else {})
    if not arguments.keep:
        shutil.rmtree(os.path.join(folder, "sim"))
    return result


def file_name(label, variant):
    return f"{label}--{variant}".replace(":", "_").replace("/", "_")


def run_all(arguments):
    results = os.path.join(arguments.work, "results")
    os.makedirs(results, exist_ok=True)
    for case in arguments.case:
        for label, maker in trials_of(case):
            for variant in arguments.variant:
                path = os.path.join(results, file_name(label, variant) + ".json")
                if os.path.exists(path) and not arguments.again:
                    continue
                result = run_trial(arguments, label, maker, variant)
                with open(path + ".new", "w", encoding="utf-8") as file:
                    json.dump(result, file, indent=1)
                os.replace(path + ".new", path)
                print(one_line(result), flush=True)


def short(value):
    if isinstance(value, float):
        return f"{value:.3g}"
    return "" if isinstance(value, (dict, list)) else str(value)


def one_line(result):
    told = result.get("measures") or {"failed": result.get("failed")}
    return f"{result['case']} {result['variant']}: " + " ".join(f"{k} {short(v)}" for k, v in told.items() if short(v))


def load_results(work):
    """Results by the name of the case, in the order of cases and variants."""
    groups, order = {}, list(trial_definition.VARIANTS)
    for path in sorted(glob.glob(os.path.join(work, "results", "*.json"))):
        with open(path, encoding="utf-8") as file:
            result = json.load(file)
        groups.setdefault(result["case"].split(":")[0], []).append(result)
    for results in groups.values():
        results.sort(key=lambda r: (r["case"], order.index(r["variant"].split(":")[0]), r["variant"]))
    return {name: groups[name] for name in trial_cases.CASES if name in groups}


def table(arguments):
    for name, results in load_results(arguments.work).items():
        columns = list(dict.fromkeys(k for r in results for k, v in r.get("measures", {}).items() if short(v)))
        print(f"\n### {name}\n| case | variant | fluid, walls | " + " | ".join(columns) + " | solver s |")
        print("| --- " * (len(columns) + 4) + "|")
        for r in results:
            told = [short(r.get("measures", {}).get(k, "")) for k in columns]
            remark = r.get("failed", "stopped early" if "stopped" in r else "")
            cells = [r["case"].partition(":")[2], r["variant"], f"{r.get('fluid', '')}, {r.get('walls', '')}", *told,
                     f"{r.get('solver_seconds', 0):.0f} {remark}".strip()]
            print("| " + " | ".join(cells) + " |")


def show_list(_):
    for name, make in trial_cases.CASES.items():
        print(f"{name}: {inspect.getdoc(make)} {', '.join(str(p) for p in inspect.signature(make).parameters.values())}")
    print("\nvariants:", ", ".join(trial_definition.VARIANTS))


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    run = commands.add_parser("run")
    run.set_defaults(function=run_all)
    run.add_argument("--fppg", required=True)
    run.add_argument("--solver", required=True)
    run.add_argument("--library-path", help="LD_LIBRARY_PATH of the solver")
    run.add_argument("--work", required=True, help="folder for runs and results")
    run.add_argument("--case", action="append", required=True)
    run.add_argument("--variant", action="append", required=True)
    run.add_argument("--limit", type=float, default=1800, help="seconds after which a run of the solver is ended")
    run.add_argument("--again", action="store_true", help="runs what has a result")
    run.add_argument("--keep", action="store_true", help="keeps the solver's output")
    tables = commands.add_parser("table")
    tables.set_defaults(function=table)
    tables.add_argument("--work", required=True)
    commands.add_parser("list").set_defaults(function=show_list)
    arguments = parser.parse_args(words)
    arguments.function(arguments)


if __name__ == "__main__":
    main(sys.argv[1:])
