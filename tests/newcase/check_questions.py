#!/usr/bin/python3
"""Answers the questions of `fppg new` at a terminal, and sees that it asks none in a script.

    check_questions.py PROGRAM WORK_FOLDER
"""

import os
import pty
import select
import shutil
import subprocess
import sys
import time


def write_block(path, size):
    """A box in metres, standing on z = 0."""
    x, y, z = size
    corners = [(a * x, b * y, c * z) for c in (0, 1) for b in (0, 1) for a in (0, 1)]
    faces = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    with open(path, "w", encoding="ascii") as file:
        file.write("solid block\n")
        for a, b, c, d in faces:
            for facet in ((a, b, c), (a, c, d)):
                file.write("facet normal 0 0 0\nouter loop\n")
                for corner in facet:
                    file.write("vertex %g %g %g\n" % corners[corner])
                file.write("endloop\nendfacet\n")
        file.write("endsolid block\n")


def at_terminal(words, work, answers):
    """The output; each answer is given when its question is there. A question without an answer fails."""
    master, slave = pty.openpty()
    process = subprocess.Popen(words, cwd=work, stdin=slave, stdout=slave, stderr=slave, close_fds=True)
    os.close(slave)
    text, asked = "", []
    end = time.monotonic() + 120
    while time.monotonic() < end:
        if not select.select([master], [], [], 0.2)[0]:
            if process.poll() is not None:
                break
            continue
        try:
            got = os.read(master, 4096)
        except OSError:  # the other end is closed
            break
        if not got:
            break
        text += got.decode(errors="replace")
        for question, answer in answers:
            if question in text and question not in asked:
                asked.append(question)
                os.write(master, (answer + "\n").encode())
    process.wait(60)
    os.close(master)
    return process.returncode, text, asked


def main(program, work):
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    write_block(os.path.join(work, "block.stl"), (0.6, 0.3, 0.4))
    words = [program, "new", "block.stl", "-o", "Case_Def.xml", "--particles", "20k", "--no-picture"]
    answers = (("What kind of case is it?", "obstacle"), ("How fast is the stream", "1.5"), ("How high is the water", "0.3"))
    code, text, asked = at_terminal(words, work, answers)
    assert code == 0, text
    assert len(asked) == 3, text
    with open(os.path.join(work, "Case_Def.xml"), encoding="utf-8") as file:
        xml = file.read()
    assert 'Speed="1.5"' in xml, xml
    # In a script, and where questions are not wanted, what is missing is an error that names the option.
    script = subprocess.run(words, cwd=work, check=False, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, timeout=120)
    assert script.returncode != 0 and "--kind is missing" in script.stdout, script.stdout
    code, text, asked = at_terminal([*words, "--no-questions"], work, answers)
    assert code != 0 and not asked and "--kind is missing" in text, text
    for given, missing in ((["--kind", "obstacle"], "--speed is missing"),
                           (["--kind", "obstacle", "--speed", "1"], "--water Z is missing"),
                           (["--kind", "gearbox"], "--rotate PART=3000deg/s is missing"),
                           (["--kind", "tank"], "--fill is missing")):
        done = subprocess.run([*words, *given], cwd=work, check=False, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=120)
        assert done.returncode != 0 and missing in done.stdout, (given, done.stdout)
    return 0


if __name__ == "__main__":
    sys.exit(main(*(os.path.abspath(a) for a in sys.argv[1:3])))
