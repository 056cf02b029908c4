#!/usr/bin/python3
"""Runs the targets of fppg_fuzz, each for some seconds, and prints what they did. A finding ends its target and is kept.

    run_fuzz.py PROGRAM [--seconds 60] [--targets stl,ply] [--findings FOLDER] [--seeds FOLDER] [--jobs 2]
    run_fuzz.py PROGRAM --merge KILOBYTES --seeds FOLDER    # makes the corpus of the repository anew

Inputs are those of tests/fuzz/corpus, and of FOLDER/TARGET of --seeds, where the new ones are kept. Exit code 1: something was found.
"""

import argparse
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
MOST_INPUTS = 40
# Of one input, under sanitizers that make the program about five times slower and larger.
LIMITS = ["-timeout=60", "-rss_limit_mb=2048", "-malloc_limit_mb=1024"]


def call(program, target, arguments):
    with tempfile.TemporaryDirectory(prefix="fppg-fuzz-") as folder:
        environment = dict(os.environ, FPPG_FUZZ_TARGET=target, TMPDIR=folder, OMP_NUM_THREADS="1",
                           UBSAN_OPTIONS="print_stacktrace=1")
        return subprocess.run([program, *arguments], env=environment, check=False, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")


def all_targets(program):
    return re.search(r"there are:(.*)", call(program, "", []).stderr).group(1).split()


def corpus_of(target):
    return os.path.join(HERE, "corpus", target)


def fuzz(options, target):
    new = os.path.join(options.seeds, target)
    os.makedirs(new, exist_ok=True)
    os.makedirs(options.findings, exist_ok=True)
    seeds = [new] + [f for f in (corpus_of(target),) if os.path.isdir(f)]
    done = call(options.program, target, [f"-max_total_time={options.seconds}", "-print_final_stats=1", "-max_len=8192", f"-seed={options.seed}",
                                          f"-artifact_prefix={options.findings}/{target}-", *LIMITS, *seeds])
    with open(os.path.join(options.findings, target + ".log"), "w", encoding="utf-8") as log:
        log.write(done.stderr)
    runs = re.findall(r"stat::number_of_executed_units: *(\d+)", done.stderr)
    edges = re.findall(r"cov: (\d+) ft: (\d+) corp: (\d+)", done.stderr)
    memory = re.findall(r"stat::peak_rss_mb: *(\d+)", done.stderr)
    found = re.findall(r"(?:SUMMARY: |runtime error: |ERROR: )(.*)", done.stderr)
    return [target, runs[-1] if runs else "?", *(edges[-1] if edges else "???"), memory[-1] if memory else "?",
            "none" if done.returncode == 0 else found[-1] if found else f"exit code {done.returncode}"]


def size_of(folder):
    return sum(os.path.getsize(os.path.join(folder, f)) for f in os.listdir(folder))


def merge(options, target, most):
    """Of the least inputs that reach all that the seeds reach MOST_INPUTS of all sizes, small ones first up to `most` bytes."""
    corpus = corpus_of(target)
    with tempfile.TemporaryDirectory(prefix="fppg-merge-") as out:
        old = [f for f in (os.path.join(options.seeds, target), corpus) if os.path.isdir(f)]
        if not old:
            return
        call(options.program, target, ["-merge=1", "-max_len=8192", *LIMITS, out, *old])
        shutil.rmtree(corpus, ignore_errors=True)
        os.makedirs(corpus)
        left = most
        names = sorted(os.listdir(out), key=lambda n: (os.path.getsize(os.path.join(out, n)), n))
        for name in names[::max(1, -(-len(names) // MOST_INPUTS))]:
            left -= os.path.getsize(os.path.join(out, name))
            if left >= 0:
                shutil.copy(os.path.join(out, name), os.path.join(corpus, name[:12]))
    print(target, len(os.listdir(corpus)), "inputs,", size_of(corpus), "bytes", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=int, default=60, help="of each target")
    parser.add_argument("--targets", default="")
    parser.add_argument("--findings", default="")
    parser.add_argument("--seeds", default="")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0, help="of the random changes; 0: another one each time")
    parser.add_argument("--merge", type=int, default=0, metavar="KILOBYTES", help="of all targets together")
    options = parser.parse_args()
    options.program = os.path.abspath(options.program)
    made = tempfile.mkdtemp(prefix="fppg-fuzz-")
    options.findings = os.path.abspath(options.findings or os.path.join(made, "findings"))
    options.seeds = os.path.abspath(options.seeds or os.path.join(made, "seeds"))
    targets = options.targets.split(",") if options.targets else all_targets(options.program)
    if options.merge:
        for target in targets:
            merge(options, target, options.merge * 1000 // len(targets))
        return 0
    row = "{:<12} {:>10} {:>7} {:>9} {:>7} {:>7}  {}"
    print(row.format("target", "runs", "edges", "features", "inputs", "MiB", "found"), flush=True)
    is_clean = True
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for result in pool.map(lambda target: fuzz(options, target), targets):
            print(row.format(*result), flush=True)
            is_clean &= result[-1] == "none"
    if is_clean:
        shutil.rmtree(made)
        return 0
    print("what was found is in", options.findings)
    return 1


if __name__ == "__main__":
    sys.exit(main())
