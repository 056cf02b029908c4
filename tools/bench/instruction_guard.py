#!/usr/bin/python3
"""Counts the instructions of a few small fixed runs and compares them with the record.

    instruction_guard.py --fppg build/release/fppg              compares; exit code 1 if one grew
    instruction_guard.py --fppg build/release/fppg --renew      writes the record anew

Seconds depend on who else uses the machine, instructions hardly do: one thread, one machine code,
counted by valgrind. The record, instructions.json, holds for one compiler and one kind of
processor; with others the exit code is 77 and a line says why.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
REPOSITORY = os.path.dirname(os.path.dirname(HERE))
RECORD = os.path.join(HERE, "instructions.json")
MOST_GROWTH = 0.05

# name -> definition and arguments; each takes a few seconds under valgrind.
RUNS = {
    "lattice, boxes and fills": ("dambreak/CaseDambreak", ["-dp:0.012"]),
    "lattice, meshes": ("ford/CaseFord", ["-dp:0.04"]),
    "lattice, all files": ("tank/CaseTank", ["-dp:0.01", "-save:all"]),
    "body-fitted, meshes": ("gear/CaseGear", ["-dp:0.006", "-fit:raw"]),
    "body-fitted, parts united": ("gearbox/CaseGearbox", ["-dp:0.003", "-fit:raw"]),
    "body-fitted, relaxed": ("gear/CaseGear", ["-dp:0.02", "-fit"]),
}

SKIPPED = 77


def count_instructions(fppg, definition, arguments, out):
    folder, case = os.path.split(os.path.join(REPOSITORY, "cases", definition))
    command = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null",
               fppg, case + "_Def", os.path.join(out, "Case"), "-threads:1", *arguments]
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, check=False)
    found = re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)
    if done.returncode != 0 or not found:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout[-2000:]}"
                 f"{done.stderr[-2000:]}")
    return int(found.group(1).replace(",", ""))


def kind_of_processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return "with AVX2" if re.search(r"^flags.*\bavx2\b", file.read(), re.MULTILINE) else \
            "without AVX2"


def skip(why):
    print(f"instructions not compared: {why}")
    sys.exit(SKIPPED)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fppg", required=True, help="the program, built by the preset release or test")
    parser.add_argument("--compiler", default="", help="its compiler and version, for the record")
    parser.add_argument("--renew", action="store_true", help="write the record")
    options = parser.parse_args()
    if not shutil.which("valgrind"):
        skip("valgrind is not installed")
    machine = {"compiler": options.compiler, "processor": kind_of_processor()}
    record = {}
    if not options.renew:
        with open(RECORD, encoding="utf-8") as file:
            record = json.load(file)
        for key, value in machine.items():
            if value != record["machine"][key]:
                skip(f"the record is of {key} {record['machine'][key]}, this is {value}")
    counts = {}
    with tempfile.TemporaryDirectory(prefix="fppg-guard-") as out:
        for name, (definition, arguments) in RUNS.items():
            counts[name] = count_instructions(os.path.abspath(options.fppg), definition, arguments,
                                              out)
            line = f"{name}: {counts[name]:,} instructions"
            if name in record.get("instructions", {}):
                line += f", {100 * (counts[name] / record['instructions'][name] - 1):+.2f} %"
            print(line, flush=True)
    if options.renew:
        with open(RECORD, "w", encoding="utf-8") as file:
            json.dump({"machine": machine, "instructions": counts}, file, indent=1)
            file.write("\n")
        return 0
    if set(counts) != set(record["instructions"]):
        print("the record has other runs; renew it")
        return 1
    grown = [name for name, count in counts.items()
             if count > (1 + MOST_GROWTH) * record["instructions"][name]]
    for name in grown:
        print(f"{name}: grew by more than {100 * MOST_GROWTH:g} %. If that is meant, renew the "
              "record: tools/bench/instruction_guard.py --renew")
    return 1 if grown else 0


if __name__ == "__main__":
    sys.exit(main())
