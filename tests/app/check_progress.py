#!/usr/bin/python3
"""What a run shows while it works: a bar on a terminal, lines in a log, nothing when quiet, JSON on request.

    check_progress.py PROGRAM CASES WORK_FOLDER
"""

import json
import os
import pty
import re
import select
import shutil
import subprocess
import sys


def run(program, work, *arguments):
    done = subprocess.run([program, *arguments], cwd=work, check=False, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True)
    return done.returncode, done.stdout, done.stderr


def run_on_a_terminal(program, work, *arguments):
    """Standard output, and what standard error showed on a terminal."""
    ours, theirs = pty.openpty()
    with subprocess.Popen([program, *arguments], cwd=work, stdout=subprocess.PIPE, stderr=theirs, text=True) as process:
        os.close(theirs)
        shown = b""
        out = ""
        streams = [ours, process.stdout]
        while streams:
            for stream in select.select(streams, [], [])[0]:
                if stream == ours:
                    try:
                        data = os.read(ours, 65536)
                    except OSError:
                        data = b""
                    shown += data
                    if not data:
                        streams.remove(ours)
                else:
                    data = os.read(process.stdout.fileno(), 65536).decode()
                    out += data
                    if not data:
                        streams.remove(process.stdout)
        process.wait()
    os.close(ours)
    return process.returncode, out, shown.decode()


def check_facts(work, events):
    """The numbers of a run are fields, not lines of text."""
    by_name = {event["event"]: event for event in events}
    particles = by_name["particles"]
    assert sum(block["count"] for block in particles["blocks"]) == particles["particles"], particles
    for block in particles["blocks"]:
        assert block["type"] in ("fixed", "moving", "floating", "fluid") and "first_id" in block, block
        assert ("mkfluid" if block["type"] == "fluid" else "mkbound") in block, block
    assert particles["speed_sound"] > particles["speed_system"] > 0 and particles["depth"] > 0, particles
    domain = by_name["domain"]
    assert domain["dp"] > 0 and len(domain["nodes"]) == len(domain["min"]) == len(domain["max"]) == 3, domain
    limits = by_name["limits"]
    assert all(low <= high for low, high in zip(limits["min"], limits["max"])), limits
    files = [event["path"] for event in events if event["event"] == "file"]
    assert {"json/Case.bi4", "json/Case.xml"} <= set(files), files
    assert all(os.path.isfile(os.path.join(work, path)) for path in files), files
    text = "\n".join(event["text"] for event in events if event["event"] == "log")
    for word in ("Total particles", "Case.bi4", "Particle limits", "Case domain"):
        assert word not in text, text


def main(program, cases, work):
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    case = os.path.join(cases, "dambreak2d/CaseDambreak2D_Def")

    code, out, err = run(program, work, case, "out/Case")
    assert code == 0 and not err, err
    for line in ("[LoadXMLInit]", "[Draw-End  time:", "Finished execution (code=0)."):
        assert line in out, line

    code, out, err = run(program, work, case, "quiet/Case", "-quiet")
    assert (code, out, err) == (0, "", ""), out + err
    with open(os.path.join(work, "quiet/Case.out"), encoding="utf-8") as file:
        assert "[Draw]" in file.read(), "Case.out holds all"

    code, out, err = run(program, work, case, "json/Case", "-log-json")
    events = [json.loads(line) for line in out.splitlines()]
    assert code == 0 and not err
    stages = [event["name"] for event in events if event["event"] == "stage"]
    assert stages == [event["name"] for event in events if event["event"] == "stage_end"]
    assert {"LoadXMLInit", "Draw", "PreparePoints", "SaveCase3D"} <= set(stages), stages
    last = events[-1]
    assert last["event"] == "finished" and last["code"] == 0, last
    assert last["particles"] == last["fixed"] + last["moving"] + last["floating"] + last["fluid"] > 0, last

    check_facts(work, events)
    assert run(program, work, "templates", "templates")[0] == 0
    code, out, _ = run(program, os.path.join(work, "templates"), "FillCavity_Def", "out/Case", "-log-json")
    fills = [event for event in map(json.loads, out.splitlines()) if event["event"] == "fill"]
    assert code == 0 and fills, out
    for fill in fills:
        assert 0 < fill["litres"] <= fill["cavity_litres"] * (1 + 1e-9) and fill["line"] > 0, fill
        assert fill["litres"] / fill["nodes"] - fill["cavity_litres"] / fill["cavity_nodes"] < 1e-9, fill
        assert isinstance(fill["level"], float) and "open_at" in fill, fill

    code, out, _ = run(program, work, "missing_Def", "none/Case", "--log-json")
    events = [json.loads(line) for line in out.splitlines()]
    assert code == 4 and events[-1]["event"] == "error" and events[-1]["code"] == 4, out
    assert "missing_Def.xml" in events[-1]["text"]
    code, out, _ = run(program, work, "missing_Def", "none/Case", "-quiet")
    assert code == 4 and "missing_Def.xml" in out, "errors are told to those who want quiet, too"

    # Relaxing the walls of a gear as fine as this takes some seconds.
    gear = os.path.join(cases, "gear/CaseGear_Def")
    code, out, shown = run_on_a_terminal(program, work, gear, "gear/Case", "-threads:1", "-dp:0.003")
    assert code == 0, out
    assert re.search(r"\r\[[#.]{24}\] Relax \d+ s", shown), repr(shown[-500:])
    assert shown.endswith("\r\x1b[K"), "the bar is taken off the terminal"
    assert "\r" not in out
    code, out, shown = run_on_a_terminal(program, work, gear, "gear/Case", "-threads:1", "-dp:0.003", "-quiet")
    assert code == 0 and shown == "", repr(shown)


if __name__ == "__main__":
    main(*(os.path.abspath(argument) for argument in sys.argv[1:4]))
