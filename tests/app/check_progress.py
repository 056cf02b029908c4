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
