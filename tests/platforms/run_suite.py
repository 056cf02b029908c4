#!/usr/bin/python3
"""Runs a suite of tests that call the program, with the program of another system in its place.

    run_suite.py SUITE PROGRAM OTHER LEFT_OUT SYSTEM RUNNER...

SUITE     a test program of GoogleTest that calls PROGRAM
OTHER     the same program for another system, which `RUNNER... OTHER` runs, e.g. wine or qemu-aarch64
LEFT_OUT  a table of tests that are left out: system, test, why; on Arm64 those with a reason that names
          binfmt_misc run where the kernel starts programs of arm64 by qemu
Prints how many tests passed, failed and were left out, and why. Exits with 77 where OTHER or its runner is not there.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

SUITE, PROGRAM, OTHER, LEFT_OUT, SYSTEM, *RUNNER = sys.argv[1:]


def left_out(names):
    """Tests of these names that are left out on SYSTEM, with the reason."""
    with open(LEFT_OUT, encoding="utf-8") as file:
        rows = [line.rstrip("\n").split("\t") for line in file if line.strip() and not line.startswith("#")]
    starts_by_itself = os.path.exists("/proc/sys/fs/binfmt_misc/qemu-aarch64")
    return {test: why for system, test, why in rows if system == SYSTEM and test in names
            and not (starts_by_itself and "binfmt_misc" in why)}


def names_of_tests():
    listed = subprocess.run([SUITE, "--gtest_list_tests"], stdout=subprocess.PIPE, text=True, check=True).stdout
    names, group = [], ""
    for line in listed.splitlines():
        if line.startswith("  "):
            names.append(group + line.split("#")[0].strip())
        elif line.endswith("."):
            group = line.strip()
    return names


def write_starter(folder):
    """A program that runs OTHER, whatever folder it is called from."""
    path = os.path.join(folder, "fppg")
    with open(path, "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\nexport WINEDEBUG=-all\nexec " + " ".join(shlex.quote(word) for word in [*RUNNER, OTHER]) + ' "$@"\n')
    os.chmod(path, 0o755)
    return path


def run_tests(starter):
    names = names_of_tests()
    skipped = left_out(names)
    for test, why in skipped.items():
        print(f"left out: {test}: {why}")
    environment = dict(os.environ, FPPG_PROGRAM_OF_THIS_ONE=PROGRAM, FPPG_PROGRAM_OF_OTHER_SYSTEM=starter)
    if "-L" in RUNNER:  # for programs that the kernel starts by qemu: their libraries
        environment["QEMU_LD_PREFIX"] = RUNNER[RUNNER.index("-L") + 1]
    done = subprocess.run([SUITE, "--gtest_filter=-" + ":".join(skipped)], env=environment, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)
    text = done.stdout.decode(errors="replace")
    passed = len(re.findall(r"^\[       OK \]", text, re.M))
    failed = len(re.findall(r"^\[  FAILED  \] .* ms\)", text, re.M))
    skips = len(re.findall(r"^\[  SKIPPED \] .* ms\)", text, re.M))
    if done.returncode != 0:
        print(text[-20000:])
    print(f"{SYSTEM} {os.path.basename(SUITE)}: {passed} passed, {failed} failed, {skips} skipped, {len(skipped)} left out")
    return done.returncode


def main():
    if not os.path.exists(OTHER):
        print(f"skipped: there is no {OTHER}; tools/package makes it")
        return 77
    if not shutil.which(RUNNER[0]):
        print(f"skipped: there is no {RUNNER[0]}")
        return 77
    with tempfile.TemporaryDirectory(prefix="fppg-systems-") as folder:
        return run_tests(write_starter(folder))


if __name__ == "__main__":
    sys.exit(main())
