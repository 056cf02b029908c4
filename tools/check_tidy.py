#!/usr/bin/python3
"""Runs clang-tidy 14 (.clang-tidy) over sources and says what it found.

    check_tidy.py BUILD              those that differ from the merge base with main, or from the commit before on main itself
    check_tidy.py BUILD --since REV  those that differ from this commit
    check_tidy.py BUILD --all        all; each stage is read as one file, as FPPG_UNITY compiles it: a fifth of the time

BUILD is a folder that is configured: its version.h is included, and tests, plugins and benchmarks are read as its
compile_commands.json says. Those that it does not build are named and left out. Exit code 77: there is no clang-tidy 14, or no git.
"""

import argparse
import concurrent.futures
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# As in src/*/CMakeLists.txt; their values do not matter here.
DEFINITIONS = ["-DFMT_SHARED", '-DFPPG_LIBRARIES="lib"', '-DFPPG_PLUGIN_FOLDER="lib"']
# A change of more files is looked at by --all.
MOST = 10


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], check=False, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          text=True).stdout.split()


def changed_sources(since):
    base = [since] if since else (git("merge-base", "HEAD", "main") or git("merge-base", "HEAD", "origin/main"))[:1]
    if not base or base == git("rev-parse", "HEAD"):
        base = git("rev-parse", "HEAD~")
    if not base:
        return None
    names = git("diff", "--name-only", "--diff-filter=d", *base, "--", "*.cpp")
    names += git("ls-files", "--others", "--exclude-standard", "--", "*.cpp")
    return [os.path.join(ROOT, n) for n in sorted(set(names))]


def is_of_a_stage(source):
    """A stage is a folder of src; the plugin for STEP files is none."""
    parts = os.path.relpath(source, ROOT).split(os.sep)
    return len(parts) == 3 and parts[0] == "src" and parts[1] != "step"


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


def all_others():
    names = [os.path.join(ROOT, n) for n in git("ls-files", "--", "*.cpp")]
    return [n for n in names if not is_of_a_stage(n)]


def flags_by_source(build):
    """Definitions and folders of headers of each source that the build compiles by itself."""
    try:
        with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
            commands = json.load(file)
    except OSError:
        return {}
    flags = {}
    for command in commands:
        words = shlex.split(command["command"])
        kept = [w for w in words if re.match(r"-[DI].|-std=|-fopenmp|-pthread", w)]
        kept += [w for i, w in enumerate(words) if "-isystem" in (w, words[i - 1])]
        flags[os.path.realpath(command["file"])] = kept
    return flags


def flags_of(source, build, known):
    """None where the build does not compile it."""
    if source in known:
        return known[source]
    if source.startswith(ROOT + os.sep) and not is_of_a_stage(source):
        return None
    return ["-std=c++20", "-fopenmp", *DEFINITIONS, f"-I{ROOT}/include", f"-I{ROOT}/src", f"-I{build}/include", f"-I{build}",
            "-isystem", "/usr/include/hdf5/serial"]


def tidy(program, source, flags):
    if flags is None:
        return source, None
    done = subprocess.run([program, "--quiet", "--checks=-bugprone-suspicious-include", f"--config-file={ROOT}/.clang-tidy", source, "--", *flags],
                          check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    found = re.findall(r"^\S+:\d+:\d+: (?:error|warning): .*\[[a-z].*\]$", done.stdout, flags=re.M)
    if done.returncode != 0 and not found:
        found = [done.stdout]
    return source, found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--since", default="", metavar="REV")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--stages", default="", help="of --all only these; \"others\" are all sources that belong to none")
    options = parser.parse_args()
    if options.since and not git("rev-parse", "--verify", "--quiet", options.since + "^{commit}"):
        parser.error(f"--since {options.since}: expected a commit of this repository")
    program = shutil.which("clang-tidy-14")
    if program is None or shutil.which("git") is None:
        print("skipped: clang-tidy-14 or git is missing")
        return 77
    with tempfile.TemporaryDirectory(prefix="fppg-tidy-") as folder:
        sources = list(stages(folder)) + all_others() if options.all else changed_sources(options.since)
        if sources is None:
            print("skipped: there is no commit to compare with")
            return 77
        if options.stages:
            wanted = options.stages.split(",")
            sources = [s for s in sources if ("others" if s.startswith(ROOT + os.sep) else os.path.basename(s)[:-4]) in wanted]
        if not options.all and not options.since and len(sources) > MOST:
            print(f"{len(sources)} sources differ, {MOST} of them are looked at; --all looks at all")
            sources = sources[::-(-len(sources) // MOST)][:MOST]
        build = os.path.abspath(options.build)
        known = flags_by_source(build)
        is_clean = True
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for source, found in pool.map(lambda s: tidy(program, s, flags_of(s, build, known)), sources):
                is_clean &= not found
                print(os.path.relpath(source, ROOT) if source.startswith(ROOT + os.sep) else os.path.basename(source)[:-4],
                      "is not built here" if found is None else "is clean" if not found else "\n" + "\n".join(sorted(set(found))), flush=True)
    return 0 if is_clean else 1


if __name__ == "__main__":
    sys.exit(main())
