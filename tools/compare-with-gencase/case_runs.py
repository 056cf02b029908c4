"""Runs a case through a program and compares what two programs made of it."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from case_xml import read_xml  # noqa: E402 (found by the path above)
from particle_files import read_bi4, read_blocks  # noqa: E402

NAME = "Case"
# What in Case.bi4 says who wrote it, not what.
UNCOMPARED = {"AppName", "Date", "CaseName", "RunCode"}

# Of GenCase, that it has no answer; it crashes on some cases without a message.
NO_ANSWER = ("hangs", "crashes")


@dataclass
class Run:
    """How a run of a program ended. status: accepts, refuses, crashes or hangs; code: None where it hangs."""
    status: str
    message: str = ""
    code: int = None
    seconds: float = 0


@dataclass
class Outcome:
    """What a program made of a case. status: as of a Run; fields: Vel, Rhop and BoundNor by id, where they are."""
    status: str
    message: str = ""
    types: list = field(default_factory=list)
    mks: np.ndarray = None
    positions: np.ndarray = None
    values: dict = field(default_factory=dict)
    constants: dict = field(default_factory=dict)
    fields: dict = field(default_factory=dict)


@dataclass
class Difference:
    """kind says of what sort it is, and stays while a case is made smaller; lines say more."""
    kind: str
    lines: list


def write_case(case, folder):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, NAME + "_Def.xml"), "w", encoding="utf-8") as file:
        file.write('<?xml version="1.0" encoding="UTF-8" ?>\n' + case.text())
    text = case.text()
    # Files that are read through others (those of a .vtm) have their names in these.
    wanted = {n for n in case.files if f'"{n}"' in text}
    wanted |= {m for n in wanted if n.endswith(".vtm") for m in case.files if f'"{m}"'.encode() in case.files[n]}
    for name in wanted:
        with open(os.path.join(folder, name), "wb") as file:
            file.write(case.files[name])


def program_path(name):
    path = os.path.abspath(name) if os.sep in name else shutil.which(name)
    if not path or not os.access(path, os.X_OK):
        script = ", or a script that starts it through Wine" if name.lower().endswith(".exe") else ""
        sys.exit(f"{name}: expected a program that can be run{script}")
    return path


def default_fppg():
    built = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "build", "release", "fppg")
    return built if os.path.exists(built) else "fppg"


def message_of(text):
    """The line that says why a program refused: `*** Error:` of fppg, `Text:` of GenCase. Empty without one."""
    for line in text.splitlines():
        if line.startswith("Text:") or line.startswith("*** Error"):
            return line.strip()
    return ""


def start_program(program, folder, words, target, timeout):
    """Runs `program` with `words` in `folder`; what it says goes to the file said.txt in `target`, which is emptied."""
    shutil.rmtree(target, ignore_errors=True)
    os.makedirs(target)
    begin = time.monotonic()
    # Into a file: what a program leaves behind (Wine's server, a debugger after a crash) would hold a pipe open.
    with open(os.path.join(target, "said.txt"), "w+b") as said:
        try:
            run = subprocess.Popen([program, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=said,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        except OSError as error:
            sys.exit(f"{program}: {error.strerror}")
        try:
            run.wait(timeout)
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            run.wait()
            return Run("hangs", f"no end within {timeout:g} s", None, time.monotonic() - begin)
        seconds = time.monotonic() - begin
        said.seek(0)
        text = said.read().decode("utf-8", "replace")
    if run.returncode == 0:
        return Run("accepts", "", 0, seconds)
    # GenCase refuses with 1, fppg with 2 to 4; anything else is no message of theirs.
    message = message_of(text)
    status = "refuses" if run.returncode in (1, 2, 3, 4) and message else "crashes"
    return Run(status, message or f"exit code {run.returncode}", run.returncode, seconds)


def run_program(program, folder, out, timeout):
    """Runs `program` on the case in `folder`, which is its working folder; results go to `folder`/`out`."""
    target = os.path.join(folder, out)
    run = start_program(program, folder, [NAME + "_Def", f"{out}/{NAME}", "-save:bi"], target, timeout)
    if run.status != "accepts":
        return Outcome(run.status, run.message)
    base = os.path.join(target, NAME)
    if not os.path.exists(base + ".bi4"):
        return Outcome("crashes", "exit code 0 and no particle file")
    return read_outcome(base)


def read_outcome(base):
    values, arrays = read_bi4(base + ".bi4")
    positions = arrays["Posd"] if "Posd" in arrays else arrays["Pos"].astype(float)
    order = np.argsort(arrays["Idp"], kind="stable")
    types, mks = [], []
    for block in read_blocks(base + ".xml"):
        types += [block["type"]] * block["count"]
        mks += [block["mk"]] * block["count"]
    constants = {}
    for row in read_xml(base + ".xml").find("case/execution/constants"):
        constants.update({f"{row.tag}.{k}": float(v) for k, v in row.attrib.items()
                          if re.fullmatch(r"[-+0-9.eE]+", v)})
    kept = {k: v for k, v in values.items() if k not in UNCOMPARED and not isinstance(v, str)}
    # Boundary particles alone have normals; their ids come first.
    fields = {k: arrays[k][order[order < len(arrays[k])] if k == "BoundNor" else order]
              for k in ("Vel", "Rhop", "BoundNor") if k in arrays}
    return Outcome("accepts", "", types, np.array(mks), positions[order], kept, constants, fields)


def places(outcome, dp):
    """Type, mk and place of every particle, the place in steps that rounding does not change."""
    cells = np.rint(outcome.positions / dp * 1e4).astype(int).tolist()
    return [(t, m, *c) for t, m, c in zip(outcome.types, outcome.mks.tolist(), cells)]


def is_near(a, b, relative):
    """Numbers, or lists of numbers, which are measured by their largest entry."""
    if a is None or b is None:
        return a is b
    a, b = np.asarray(a, float), np.asarray(b, float)
    return a.shape == b.shape and bool(
        np.all(np.abs(a - b) <= 1e-12 + relative * (np.abs(b).max() if b.size else 0)))


def compare(ours, theirs, dp):
    """The difference of two outcomes, or None. A refusal of both is none, nor is a GenCase that crashes or does not
    end."""
    if theirs.status in NO_ANSWER:
        return None
    if ours.status != "accepts" or theirs.status != "accepts":
        if ours.status == "refuses" and theirs.status == "refuses":
            return None
        words = ours.message if ours.status != "accepts" else theirs.message
        key = " ".join(re.findall("[a-z]{3,}", re.sub(r"^.*xml:[0-9]+:|^Text:", "", words).lower()))[:60]
        return Difference(f"fppg {ours.status}, GenCase {theirs.status}: {key}",
                          [f"fppg {ours.status} {ours.message}", f"GenCase {theirs.status} {theirs.message}"])
    return compare_particles(ours, theirs, dp) or compare_constants(ours, theirs)


def compare_particles(ours, theirs, dp):
    """The difference of the particles of two results: type, mk, place and order of ids; or None."""
    if len(ours.mks) == len(theirs.mks) and ours.types == theirs.types and np.array_equal(ours.mks, theirs.mks):
        far = np.abs(ours.positions - theirs.positions).max(axis=1, initial=0) > 1e-6 * dp
        if not far.any():
            return None
    found, wanted = places(ours, dp), places(theirs, dp)
    extra, missing = sorted(set(found) - set(wanted)), sorted(set(wanted) - set(found))
    if not extra and not missing and len(found) == len(wanted):
        at = next((i for i, (a, b) in enumerate(zip(found, wanted)) if a != b), None)
        return Difference("order of ids", [f"the same particles in another order, first id {at}"])
    free = {p[2:] for p in extra} == {p[2:] for p in missing}
    kind = "mk of particles" if free else "particles"

    def told(rows):
        return ", ".join(f"{t} mk {m} at ({', '.join(f'{c * dp / 1e4:.5g}' for c in place)})"
                         for t, m, *place in rows[:4])

    return Difference(kind, [f"fppg {len(found)} particles, GenCase {len(wanted)}",
                             f"only fppg: {len(extra)}: {told(extra)}", f"only GenCase: {len(missing)}: {told(missing)}"])


def compare_constants(ours, theirs):
    lines = [f"Case.bi4 {k}: fppg {ours.values.get(k)}, GenCase {theirs.values.get(k)}"
             for k in sorted(ours.values.keys() | theirs.values.keys())
             if not is_near(ours.values.get(k), theirs.values.get(k), 1e-9)]
    lines += [f"Case.xml {k}: fppg {ours.constants.get(k)}, GenCase {theirs.constants.get(k)}"
              for k in sorted(ours.constants.keys() | theirs.constants.keys())
              if not is_near(ours.constants.get(k), theirs.constants.get(k), 1.5e-5)]
    return Difference("constants", lines) if lines else None


def summary(outcome):
    """Lines that say what a program made of a case."""
    if outcome.status != "accepts":
        return [f"{outcome.status}: {outcome.message}"]
    counts = {}
    for kind, mk in zip(outcome.types, outcome.mks.tolist()):
        counts[kind, mk] = counts.get((kind, mk), 0) + 1
    lines = [f"{len(outcome.mks)} particles"] + [f"  {kind} mk {mk}: {n}" for (kind, mk), n in counts.items()]
    if len(outcome.mks):
        lo, hi = outcome.positions.min(axis=0), outcome.positions.max(axis=0)
        lines.append(f"  from ({', '.join(f'{v:.6g}' for v in lo)}) to ({', '.join(f'{v:.6g}' for v in hi)})")
    return lines
