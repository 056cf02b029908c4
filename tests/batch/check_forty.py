#!/usr/bin/python3
"""Kills a batch of forty cases and a broken one in the middle, resumes it, and counts what was done.

    check_forty.py PROGRAM CASES WORK_FOLDER

The cases are those of cases/, each with four distances of particles. Nothing may be done twice, nothing may be lost,
and a second batch into the same folder is refused while the first one works.
"""

import csv
import glob
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time

CASES = ("dambreak", "dambreak2d", "ford", "gear", "gearbox", "pipe", "stirred", "tank", "tyre", "wading")
COARSER = (3.0, 3.5, 4.0, 5.0)
# With coarser particles the seeds of its fills meet walls.
COARSER_GEARBOX = (1.0, 1.05, 1.1, 1.2)


def write_cases(cases, folder):
    names = []
    for name in CASES:
        shutil.copytree(os.path.join(cases, name), os.path.join(folder, name))
        definition, = glob.glob(os.path.join(folder, name, "*_Def.xml"))
        with open(definition, encoding="utf-8") as file:
            text = file.read()
        os.remove(definition)
        dp = float(re.search(r'<definition dp="([^"]+)"', text).group(1))
        for factor in COARSER_GEARBOX if name == "gearbox" else COARSER:
            path = definition.replace("_Def.xml", f"_x{factor:g}_Def.xml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(re.sub(r'<definition dp="[^"]+"', f'<definition dp="{factor * dp:g}"', text))
            names.append(os.path.join(name, os.path.basename(path)[:-len("_Def.xml")]))
    with open(os.path.join(folder, "Broken_Def.xml"), "w", encoding="utf-8") as file:
        file.write("<case><casedef><geometry>")
    return names


def events_of(path):
    """(event, run) of every whole line."""
    with open(path, encoding="utf-8") as file:
        lines = [json.loads(line) for line in file.read().split("\n")[:-1] if line.startswith("{")]
    return [(line["event"], line.get("run")) for line in lines]


def runs_with(events, event):
    return [run for which, run in events if which == event]


def command(program, *more):
    return [program, "batch", "cases", "--out", "out", "--jobs", "2", "--threads", "1", "--log-json", *more,
            "--", "-fit:raw"]


def kill_in_the_middle(program, work):
    log = os.path.join(work, "first.jsonl")
    with open(log, "w", encoding="utf-8") as file:
        batch = subprocess.Popen(command(program), cwd=work, stdout=file, stderr=subprocess.STDOUT)
        while batch.poll() is None and len(runs_with(events_of(log), "finished")) < 15:
            time.sleep(0.02)
        assert batch.poll() is None, "the batch ended before it could be killed"
        second = subprocess.run(command(program), cwd=work, check=False, stdout=subprocess.PIPE, text=True)
        assert second.returncode == 4, second.stdout
        assert "another batch is at work in this folder" in second.stdout, second.stdout
        assert f"process {batch.pid} on" in second.stdout, second.stdout
        batch.send_signal(signal.SIGKILL)
        batch.wait()
    return events_of(log)


def times_of_results(work):
    return {path: os.stat(path).st_mtime_ns for path in glob.glob(os.path.join(work, "out/*/*/*.bi4"))}


def check_summary(work, names, failed):
    with open(os.path.join(work, "out/summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    assert (summary["done"], summary["failed"], summary["open"]) == (len(names), len(failed), 0), summary
    states = {run["run"]: run["state"] for run in summary["runs"]}
    assert states == {**{name: "done" for name in names}, **{name: "failed" for name in failed}}, states
    with open(os.path.join(work, "out/summary.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["run"]: row["state"] for row in rows} == states
    for run in summary["runs"]:
        if run["state"] != "done":
            continue
        done = re.search(r'<particles np="(\d+)"', open(run["output"] + ".xml", encoding="utf-8").read())
        assert int(done.group(1)) == run["particles"] > 0, run["run"]


def main(program, cases, work):
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(os.path.join(work, "cases"))
    names = write_cases(cases, os.path.join(work, "cases"))
    assert len(names) == 40

    first = kill_in_the_middle(program, work)
    finished = set(runs_with(first, "finished")) - {"Broken"}
    under_way = set(runs_with(first, "started")) - set(runs_with(first, "finished"))
    before = times_of_results(work)

    log = os.path.join(work, "second.jsonl")
    with open(log, "w", encoding="utf-8") as file:
        code = subprocess.run(command(program, "--resume"), cwd=work, check=False, stdout=file).returncode
    assert code == 1, "one run fails"
    second = events_of(log)
    started = runs_with(second, "started")
    assert len(started) == len(set(started)), "a run was started twice"
    assert not finished & set(started), f"done twice: {finished & set(started)}"
    again = set(runs_with(first, "started")) & set(started) - {"Broken"}
    assert again <= under_way and len(again) <= 2, f"more was done again than was under way: {again}"
    assert set(runs_with(first, "started")) | set(started) == {*names, "Broken"}, "a run was lost"
    after = times_of_results(work)
    kept = [path for path in before if os.path.relpath(os.path.dirname(path), os.path.join(work, "out")) in finished]
    assert len(kept) == len(finished) and all(after[path] == before[path] for path in kept)
    check_summary(work, names, ["Broken"])
    assert not glob.glob(os.path.join(work, "out/*/*/.*.part-*")), "leftovers of the killed runs"

    third = subprocess.run(command(program, "--resume"), cwd=work, check=False, stdout=subprocess.PIPE, text=True)
    assert third.returncode == 1 and times_of_results(work) == after
    check_summary(work, names, ["Broken"])


if __name__ == "__main__":
    main(*(os.path.abspath(argument) for argument in sys.argv[1:4]))
