#!/usr/bin/python3
"""Runs the definitions of a folder through GenCase and fppg and says what differs.

    compare_folder.py GENCASE FOLDER [--fppg PROGRAM] [--options "WORDS"] [--tsv | --json]
                      [--keep FOLDER] [--jobs N] [--timeout SECONDS]

GENCASE is the program, or a script that starts it (through Wine, for instance). FOLDER is searched with all folders
below for NAME_Def.xml and other XML whose root is <case>; results of a run are left out. In its place may stand one
definition, or a list: a text file with a definition a line and, behind a tab, options for this one.

Each program runs in the folder of the definition and writes to a folder of its own; nothing is written beside the
definitions. Compared, of every definition that both run:
  particles   type, mk and place (within 1e-6 dp) of every particle, in the order of ids
  constants   those in the .bi4 (1e-9) and in Case.xml (six digits)
  fields      velocities and densities of particles of one id
  normals     those of boundary particles of one id, within 1e-4 dp
  Case.xml    element by element, comments too; numbers to six digits
Fields and normals are compared where the particles are the same. A cell says "-" where there was nothing to compare.

README.md in this folder says more. Needs python3-numpy. Exits with 1 where something differs, or where one of the two
refuses what the other runs.
"""

import argparse
import concurrent.futures
import json
import os
import shutil
import sys
import tempfile
from collections import Counter
from dataclasses import asdict, dataclass, field

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
from case_runs import (  # noqa: E402 (found by the path above)
    compare_constants, compare_particles, default_fppg, program_path, read_outcome, start_program)
from case_xml import compare_case_xml, read_xml  # noqa: E402

TYPES = ("fixed", "moving", "floating", "fluid")
COLUMNS = ("definition", "GenCase", "fppg", "particles", "same particles", "constants", "fields", "normals", "Case.xml",
           "s GenCase", "s fppg")


@dataclass
class Side:
    """What one program made of a definition. ended: the exit code, or "hangs"; particles: number by type."""
    ended: object
    message: str = ""
    seconds: float = 0
    particles: dict = field(default_factory=dict)


@dataclass
class Row:
    """A definition. Of what was compared, a list of lines that say what differs; None: not compared."""
    definition: str
    options: str
    gencase: Side
    fppg: Side
    particles: list = None
    constants: list = None
    fields: list = None
    normals: list = None
    case_xml: list = None

    def differs(self):
        if (self.gencase.ended == 0) != (self.fppg.ended == 0):
            return self.gencase.ended in (0, 1)  # a GenCase that crashes or hangs says nothing
        return any([self.particles, self.constants, self.fields, self.normals, self.case_xml])


def is_definition(path):
    """Whether the root is <case>, without the particles that a program adds."""
    try:
        root = read_xml(path).find("case")
    except (OSError, ValueError):
        # What is named as a definition is one; the programs say what is wrong with it.
        return path.lower().endswith("_def.xml")
    return root is not None and root.find("execution/particles") is None


def find_definitions(given):
    """(path, options) of a folder, of a definition, or of a list of definitions."""
    if os.path.isdir(given):
        found = [os.path.join(folder, name) for folder, _, names in os.walk(given) for name in names
                 if name.lower().endswith(".xml")]
        return [(path, "") for path in sorted(found) if is_definition(path)]
    if given.lower().endswith(".xml"):
        return [(given, "")]
    with open(given, encoding="utf-8") as file:
        rows = [line.rstrip("\n").split("\t") for line in file if line.strip() and not line.startswith("#")]
    listed = [(os.path.join(os.path.dirname(given), row[0]), row[1] if len(row) > 1 else "") for row in rows]
    for path, _ in listed:
        if not os.path.isfile(path):
            sys.exit(f"{given}: {path} is no file, expected a definition a line, relative to the list")
    return listed


def case_name(definition):
    name = os.path.splitext(os.path.basename(definition))[0]
    return name[:-len("_Def")] if name.lower().endswith("_def") else name


def run_definition(program, definition, options, target, timeout):
    """The end of a run and the results by name: one, or one a zone of <vres>."""
    folder = os.path.dirname(os.path.realpath(definition))
    name = os.path.splitext(os.path.basename(definition))[0]
    # A relative path, which GenCase takes under Wine too.
    out = os.path.relpath(os.path.realpath(target), folder)
    words = [name, f"{out}/{case_name(definition)}", *options]
    run = start_program(program, folder, words, target, timeout)
    side = Side(run.status if run.code is None else run.code, run.message, round(run.seconds, 2))
    results = {}
    if run.status == "accepts":
        for file in sorted(os.listdir(target)):
            if file.endswith(".bi4") and os.path.exists(os.path.join(target, file[:-4] + ".xml")):
                results[file[:-4]] = os.path.join(target, file[:-4])
    return side, results


def far_rows(ours, theirs, tolerance):
    """How many rows of two arrays differ, and by how much at most; None where they cannot be compared."""
    if ours is None or theirs is None or ours.shape != theirs.shape:
        return None
    if not len(theirs):
        return 0, 0.0
    a, b = (v.astype(float).reshape(len(v), -1) for v in (ours, theirs))
    with np.errstate(invalid="ignore"):
        error = np.where(np.isnan(a) & np.isnan(b), 0, np.abs(a - b))
        near = error <= tolerance(b)
    wrong = ~near.all(axis=1)
    return int(wrong.sum()), float(np.nanmax(error, initial=0))


def compare_fields(ours, theirs, rhop0):
    tolerances = {"Vel": ("velocities", "m/s", lambda v: 1e-5 + 1e-6 * np.abs(v)),
                  "Rhop": ("densities", "kg/m^3", lambda v: 2e-6 * rhop0 + 0 * v)}
    for name, (words, units, tolerance) in tolerances.items():
        far = far_rows(ours.fields.get(name), theirs.fields.get(name), tolerance)
        if far is None:
            yield f"{words}: in one of the two only"
        elif far[0]:
            yield f"{words}: {far[0]} of {len(theirs.mks)} differ, by up to {far[1]:.4g} {units}"


def compare_normals(ours, theirs, dp):
    a, b = ours.fields.get("BoundNor"), theirs.fields.get("BoundNor")
    if a is None and b is None:
        return None
    far = far_rows(a, b, lambda v: 1e-4 * dp + 0 * v)
    if far is None:
        return ["only fppg has normals" if b is None else "only GenCase has normals" if a is None else
                f"{len(a)} normals, GenCase has {len(b)}"]
    return [f"{far[0]} of {len(b)} differ, by up to {far[1] / dp:.4g} dp"] if far[0] else []


def compare_results(row, ours, theirs):
    """Fills in what differs between two results of one definition; `ours` and `theirs` are paths by name."""
    row.particles, row.constants, row.fields, row.case_xml = [], [], [], []
    if set(ours) != set(theirs):
        row.particles.append(f"fppg writes {', '.join(ours)}, GenCase {', '.join(theirs)}")
    for name in sorted(set(ours) & set(theirs)):
        where = f"{name}: " if len(theirs) > 1 else ""
        a, b = read_outcome(ours[name]), read_outcome(theirs[name])
        for side, outcome in ((row.fppg, a), (row.gencase, b)):
            counts = Counter(outcome.types)
            side.particles = {t: side.particles.get(t, 0) + counts[t] for t in TYPES
                              if side.particles.get(t, 0) + counts[t]}
        dp = b.values["Dp"]
        difference = compare_particles(a, b, dp)
        if difference:
            row.particles += [where + line for line in (difference.kind, *difference.lines)]
        constants = compare_constants(a, b)
        row.constants += [where + line for line in constants.lines] if constants else []
        row.case_xml += [where + x.line() for x in compare_case_xml(ours[name] + ".xml", theirs[name] + ".xml")]
        if difference:
            continue
        row.fields += [where + line for line in compare_fields(a, b, b.values["Rhop0"])]
        normals = compare_normals(a, b, dp)
        if normals is not None:
            row.normals = (row.normals or []) + [where + line for line in normals]


def check_definition(programs, definition, shown, options, target, timeout):
    """The row of a definition; `target` is a folder for the results of both programs."""
    (theirs, their_results), (ours, our_results) = (
        run_definition(program, definition, options, os.path.join(target, name), timeout)
        for name, program in programs.items())
    row = Row(shown, " ".join(options), theirs, ours)
    if ours.ended == 0 and theirs.ended == 0:
        compare_results(row, our_results, their_results)
    return row


def cells(row):
    """What the table says of a definition."""
    def counts(side):
        return ", ".join(f"{t} {n:,}" for t, n in side.particles.items()) or ("0" if side.ended == 0 else "")

    def told(lines, same="same"):
        return "-" if lines is None else f"{len(lines)} differ" if lines else same

    particles = counts(row.gencase) or "-"
    if row.fppg.particles and row.fppg.particles != row.gencase.particles:
        particles += f" (fppg: {counts(row.fppg)})"
    same = "-" if row.particles is None else row.particles[0] if row.particles else "same"
    return [f"{row.definition} {row.options}".strip(), str(row.gencase.ended), str(row.fppg.ended), particles, same,
            told(row.constants), told(row.fields), "; ".join(row.normals) if row.normals else told(row.normals),
            told(row.case_xml), f"{row.gencase.seconds:.2f}", f"{row.fppg.seconds:.2f}"]


def print_table(rows):
    lines = [list(COLUMNS)] + [cells(row) for row in rows]
    widths = [max(len(line[i]) for line in lines) for i in range(len(COLUMNS))]
    for line in lines:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())
    for row in rows:
        for name, side in (("GenCase", row.gencase), ("fppg", row.fppg)):
            if side.ended != 0:
                print(f"\n{row.definition}: {name}: {side.message}", end="")
        for name, found in (("particles", row.particles), ("constants", row.constants), ("fields", row.fields),
                            ("normals", row.normals), ("Case.xml", row.case_xml)):
            if found:
                more = [f"and {len(found) - 10} more"] if len(found) > 10 else []
                print(f"\n{row.definition}: {name}:\n  " + "\n  ".join(found[:10] + more), end="")
    both = [row for row in rows if row.gencase.ended == 0 and row.fppg.ended == 0]
    run = sum(row.gencase.ended == 0 for row in rows)
    alone = sum(row.gencase.ended != 0 and row.fppg.ended == 0 for row in rows)
    print(f"\n{len(rows)} definitions: GenCase runs {run}, of these fppg runs {len(both)}; "
          f"same particles {sum(not row.particles for row in both)}, all else the same too "
          f"{sum(not row.differs() for row in both)}" + (f"; {alone} run in fppg only" if alone else ""))


def arguments(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gencase", help="the GenCase program, or a script that starts it")
    parser.add_argument("folder", help="folder of definitions, a definition, or a list of definitions")
    parser.add_argument("--fppg", default=default_fppg(), help="our program; that of build/release, else that on PATH")
    parser.add_argument("--options", default="-save:bi", help="for both programs; default -save:bi")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--tsv", action="store_true", help="print the table with tabs")
    form.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.add_argument("--keep", help="folder for what both programs write; else it is removed")
    parser.add_argument("--jobs", type=int, default=1, help="definitions side by side; default 1, for the times")
    parser.add_argument("--timeout", type=float, default=600, help="seconds that a program may take")
    given = parser.parse_args(words)
    if not os.path.exists(given.folder):
        parser.error(f"{given.folder}: no such folder or file")
    return given


def main(words):
    given = arguments(words)
    programs = {"gencase": program_path(given.gencase), "fppg": program_path(given.fppg)}
    definitions = find_definitions(given.folder)
    if not definitions:
        sys.exit(f"{given.folder}: no definition in it, expected NAME_Def.xml or XML with the root <case>")
    root = given.folder if os.path.isdir(given.folder) else os.path.dirname(given.folder) or "."
    with tempfile.TemporaryDirectory() as work, concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:

        def check(numbered):
            number, (definition, options) = numbered
            shown = os.path.relpath(definition, root)
            target = os.path.join(given.keep or work, f"{number:03d}_{case_name(definition)}")
            row = check_definition(programs, definition, shown, [*given.options.split(), *options.split()], target,
                                   given.timeout)
            row.options = options
            if not given.keep:
                shutil.rmtree(target)
            print(f"{number + 1} of {len(definitions)}: {shown}", file=sys.stderr, flush=True)
            return row

        rows = list(pool.map(check, enumerate(definitions)))
    if given.json:
        print(json.dumps([{**asdict(row), "differs": row.differs()} for row in rows], indent=1))
    elif given.tsv:
        for line in [list(COLUMNS)] + [cells(row) for row in rows]:
            print("\t".join(line))
    else:
        print_table(rows)
    return 1 if any(row.differs() for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
