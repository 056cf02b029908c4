#!/usr/bin/python3
"""Runs clang-tidy 14 (.clang-tidy) over sources of src and says what it found.

    check_tidy.py BUILD              those that differ from the merge base with main, or from the commit before on main itself
    check_tidy.py BUILD --all        all; each stage is read as one file, as FPPG_UNITY compiles it: a fifth of the time

BUILD is a folder that is configured (its version.h is included). Exit code 77: there is no clang-tidy 14, or no git.
"""

import argparse
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# A change of more files is looked at by --all.
MOST = 10


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], check=False, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          text=True).stdout.split()


def changed_sources():
    base = (git("merge-base", "HEAD", "main") or git("merge-base", "HEAD", "origin/main"))[:1]
    if not base or base == git("rev-parse", "HEAD"):
        base = git("rev-parse", "HEAD~")
    if not base:
        return None
    names = git("diff", "--name-only", "--diff-filter=d", *base, "--", "src/*.cpp")
    names += git("ls-files", "--others", "--exclude-standard", "--", "src/*.cpp")
    return [os.path.join(ROOT, n) for n in sorted(set(names))]


def stages(folder):
    """A file a stage that includes its sources."""
    for stage in sorted(os.listdir(os.path.join(ROOT, "src"))):
        sources = sorted(n for n in os.listdir(os.path.join(ROOT, "src", stage)) if n.endswith(".cpp")) \
            if os.path.isdir(os.path.join(ROOT, "src", stage)) else []
        if not sources or stage == "step":
            continue
        with open(os.path.join(folder, stage + ".cpp"), "w", encoding="utf-8") as file:
            file.writelines(f'#include "{ROOT}/src/{stage}/{name}"\n' for name in sources)
        yield os.path.join(folder, stage + ".cpp")


def tidy(program, source, build):
    done = subprocess.run([program, "--quiet", "--checks=-bugprone-suspicious-include", f"--config-file={ROOT}/.clang-tidy", source, "--", "-std=c++20", "-fopenmp", "-DFMT_SHARED",
                           f"-I{ROOT}/include", f"-I{ROOT}/src", f"-I{build}/include", f"-I{build}", "-isystem", "/usr/include/hdf5/serial"],
                          check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    found = re.findall(r"^\S+:\d+:\d+: (?:error|warning): .*\[[a-z].*\]$", done.stdout, flags=re.M)
    if done.returncode != 0 and not found:
        found = [done.stdout]
    return source, found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--stages", default="", help="of --all only these")
    options = parser.parse_args()
    program = shutil.which("clang-tidy-14")
    if program is None or shutil.which("git") is None:
        print("skipped: clang-tidy-14 or git is missing")
        return 77
    with tempfile.TemporaryDirectory(prefix="fppg-tidy-") as folder:
        sources = list(stages(folder)) if options.all else changed_sources()
        if sources is None:
            print("skipped: there is no commit to compare with")
            return 77
        if options.stages:
            sources = [s for s in sources if os.path.basename(s)[:-4] in options.stages.split(",")]
        if not options.all and len(sources) > MOST:
            print(f"{len(sources)} sources differ, {MOST} of them are looked at; --all looks at all")
            sources = sources[::-(-len(sources) // MOST)][:MOST]
        is_clean = True
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for source, found in pool.map(lambda s: tidy(program, s, os.path.abspath(options.build)), sources):
                is_clean &= not found
                print(os.path.relpath(source, ROOT) if not options.all else os.path.basename(source)[:-4],
                      "is clean" if not found else "\n" + "\n".join(sorted(set(found))), flush=True)
    return 0 if is_clean else 1


if __name__ == "__main__":
    sys.exit(main())
