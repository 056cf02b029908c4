#!/usr/bin/python3
"""Draws random cases and compares what fppg and GenCase make of them.

    compare_with_gencase.py GENCASE [--fppg PROGRAM] [--seed N] [--cases N] [--first N] [--only COMMAND,..]
                            [--keep FOLDER] [--jobs N] [--timeout SECONDS] [--runs N]
    compare_with_gencase.py --list

GENCASE is a program, or a script that starts one; it is run in a folder of its own with relative paths.
README.md in this folder says what is compared. Needs python3-numpy. Exits with 1 where a case differs.
"""

import argparse
import concurrent.futures
import os
import shutil
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass, field

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
from case_grammar import COMMANDS, random_case, used_commands  # noqa: E402 (found by the path above)
from case_reducer import reduce_case  # noqa: E402
from case_runs import (  # noqa: E402
    NO_ANSWER, compare, default_fppg, program_path, run_program, summary, write_case)
from rounding_ties import is_rounding_tie  # noqa: E402


@dataclass
class Result:
    """Of one case: the kind of difference, or the message of GenCase; `culprits` are the commands left in the reduced
    case, `lines` say what differs."""
    index: int
    commands: set
    status: str
    kind: str = ""
    culprits: tuple = ()
    lines: list = field(default_factory=list)


class Comparison:
    """Two programs, and where their files go."""

    def __init__(self, fppg, gencase, work, timeout):
        self.programs, self.work, self.timeout = (fppg, gencase), work, timeout

    def run(self, case, name):
        """Outcomes of both programs and their difference."""
        folder = os.path.join(self.work, name)
        write_case(case, folder)
        ours, theirs = (run_program(program, folder, out, self.timeout)
                        for program, out in zip(self.programs, ("fppg", "gencase")))
        dp = float(case.root.find(".//definition").get("dp"))
        return ours, theirs, compare(ours, theirs, dp)

    def run_gencase(self, case, name):
        folder = os.path.join(self.work, name)
        write_case(case, folder)
        return run_program(self.programs[1], folder, "gencase", self.timeout)

    def reduced(self, case, name, kind, most_runs):
        """The smallest case that differs in the same kind of way; with its outcomes and difference."""
        def still_differs(smaller):
            difference = self.run(smaller, name)[2]
            return difference is not None and difference.kind == kind

        small, runs = reduce_case(case, still_differs, most_runs)
        return small, runs, self.run(small, name)


def keep(folder, label, case, small, runs, outcomes, difference):
    """Writes a reduced case, the one it comes from, and what both programs made of it."""
    target = os.path.join(folder, label)
    shutil.rmtree(target, ignore_errors=True)
    write_case(small, target)
    write_case(case, os.path.join(target, "drawn"))
    lines = [difference.kind, *difference.lines, "", "fppg:", *summary(outcomes[0]), "", "GenCase:",
             *summary(outcomes[1]), "", f"Reduced in {runs} runs. The case as it was drawn is in drawn/."]
    with open(os.path.join(target, "summary.txt"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def check_case(comparison, seed, index, only, folder, most_runs):
    case = random_case(seed, index, only)
    commands = used_commands(case.root)
    name = f"case_{seed}_{index}"
    ours, theirs, difference = comparison.run(case, name)
    if difference is None:
        status = "no answer" if theirs.status in NO_ANSWER else "equal" if ours.status == "accepts" else "both refuse"
        shutil.rmtree(os.path.join(comparison.work, name))
        return Result(index, commands, status, kind=theirs.message)
    if is_rounding_tie(case, ours, theirs, lambda moved: comparison.run_gencase(moved, name)):
        shutil.rmtree(os.path.join(comparison.work, name))
        if folder:
            keep(os.path.join(folder, "rounding_ties"), name, case, case, 0, (ours, theirs), difference)
        return Result(index, commands, "rounding tie", difference.kind, lines=difference.lines)
    small, runs, (ours, theirs, left) = comparison.reduced(case, name, difference.kind, most_runs)
    left = left or difference
    shutil.rmtree(os.path.join(comparison.work, name))
    if folder:
        keep(folder, name, case, small, runs, (ours, theirs), left)
    culprits = used_commands(small.root) - (set() if left.kind == "constants" else {"constants"})
    return Result(index, commands, "differs", left.kind, tuple(sorted(culprits)))


def print_tables(results, only):
    statuses = ("equal", "both refuse", "no answer", "rounding tie", "differs")
    heads = "".join(f"{status:>14}" for status in statuses)

    def row(name, rows, more=""):
        counts = Counter(r.status for r in rows)
        print(f"{name:19}{len(rows):6}" + "".join(f"{counts[status]:14}" for status in statuses) + more)

    print(f"\n{'command':19} cases{heads}  left in the reduced case")
    for name in COMMANDS:
        of_name = [r for r in results if name in r.commands]
        if of_name:
            row(name, of_name, f"{sum(name in r.culprits for r in of_name):6}")
    row("all", results)
    unseen = [n for n in COMMANDS if not any(n in r.commands for r in results)]
    if unseen and not only:
        print(f"In no case: {', '.join(unseen)}")
    ties = [r for r in results if r.status == "rounding tie"]
    if ties:
        print("\nRounding ties: GenCase's own answer turns when the case is moved by a millionth of dp or less:")
    for r in ties:
        print(f"case {r.index}: {'; '.join(r.lines)}")
    groups = {}
    for r in results:
        if r.status == "differs":
            groups.setdefault((r.kind, r.culprits), []).append(r.index)
    if groups:
        print("\nDifferences by what is left of the case:")
    for (kind, culprits), indices in sorted(groups.items(), key=lambda g: (-len(g[1]), g[0])):
        print(f"{len(indices):4}  {kind}: {', '.join(culprits)}: case {', '.join(map(str, indices[:8]))}")


def arguments(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gencase", nargs="?", help="the GenCase program, or a script that starts it")
    parser.add_argument("--fppg", default=default_fppg(), help="our program; that of build/release, else that on PATH")
    parser.add_argument("--seed", type=int, default=1, help="another number, other cases")
    parser.add_argument("--cases", type=int, default=100, help="how many cases")
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--only", default="", help="commands, joined by commas; --list names them")
    parser.add_argument("--keep", help="folder for the reduced cases")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="cases side by side")
    parser.add_argument("--timeout", type=float, default=30, help="seconds that a program may take")
    parser.add_argument("--runs", type=int, default=250, help="runs that the reduction of a case may take")
    parser.add_argument("--list", action="store_true", help="name the commands and end")
    given = parser.parse_args(words)
    given.only = tuple(w for w in given.only.split(",") if w)
    for name in given.only:
        if name not in COMMANDS:
            parser.error(f"--only {name}: expected names of --list")
    if not given.gencase and not given.list:
        parser.error("expected the path of GenCase")
    return given


def main(words):
    given = arguments(words)
    if given.list:
        print("\n".join(COMMANDS))
        return 0
    fppg, gencase = program_path(given.fppg), program_path(given.gencase)
    results = []
    with tempfile.TemporaryDirectory() as work, concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        comparison = Comparison(fppg, gencase, work, given.timeout)
        runs = [pool.submit(check_case, comparison, given.seed, index, given.only, given.keep, given.runs)
                for index in range(given.first, given.first + given.cases)]
        for run in runs:
            results.append(run.result())
            r = results[-1]
            if r.status != "equal":
                left = f": {', '.join(r.culprits)}" if r.culprits else ""
                print(f"case {r.index}: {r.status}: {r.kind}{left}", flush=True)
    print_tables(results, given.only)
    return 1 if any(r.status == "differs" for r in results) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
