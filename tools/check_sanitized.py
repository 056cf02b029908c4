#!/usr/bin/python3
"""Builds and runs, with the preset asan, the unit tests of the stages that a change touches.

    check_sanitized.py BUILD [--most 300] [--jobs 2]

BUILD is a folder of that preset. Tests in tests/STAGE are those of src/STAGE. After --most seconds no further stage is begun, and
those left out are named; the whole suite is `cmake --workflow --preset check`.
"""

import argparse
import os
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
from check_tidy import git  # noqa: E402 (lies beside this file)


def changed_stages():
    base = (git("merge-base", "HEAD", "main") or git("merge-base", "HEAD", "origin/main"))[:1]
    if not base or base == git("rev-parse", "HEAD"):
        base = git("rev-parse", "HEAD~")
    if not base:
        return []
    names = git("diff", "--name-only", *base, "--", "src", "tests") + git("ls-files", "--others", "--exclude-standard", "--", "src", "tests")
    parts = [name.split("/") for name in names if name.endswith((".cpp", ".h"))]
    stages = {p[1] for p in parts if len(p) > 2}
    return sorted(s for s in stages if os.path.exists(os.path.join(ROOT, "tests", s, "CMakeLists.txt")))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--most", type=float, default=300, help="seconds until no further stage is begun")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    end = time.monotonic() + options.most
    stages = changed_stages()
    if not stages:
        print("no stage differs")
    # As the preset sets it for the whole suite.
    environment = dict(os.environ, LSAN_OPTIONS=f"suppressions={ROOT}/tools/lsan.supp:print_suppressions=0")
    for i, stage in enumerate(stages):
        if time.monotonic() > end:
            print("left out, as the time is over:", *stages[i:])
            break
        jobs = str(options.jobs)
        subprocess.run(["cmake", "--build", options.build, "-j", jobs, "--target", f"tests/{stage}/all"], check=True)
        done = subprocess.run(["ctest", "--test-dir", os.path.join(options.build, "tests", stage), "-L", "unit", "-j", jobs,
                               "--output-on-failure"], check=False, env=environment)
        if done.returncode != 0:
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
