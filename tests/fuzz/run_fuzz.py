#!/usr/bin/python3
"""Runs the targets of fppg_fuzz, each for some seconds, and prints what they did. A finding ends its target and is kept.

    run_fuzz.py PROGRAM [--seconds 60] [--targets stl,ply] [--findings FOLDER] [--seeds FOLDER] [--jobs 2]
    run_fuzz.py PROGRAM --processor-seconds 1800 --input-seconds 600    # on a machine that has other work too
    run_fuzz.py PROGRAM --merge KILOBYTES --seeds FOLDER    # makes the corpus of the repository anew

Inputs are those of tests/fuzz/corpus, and of FOLDER/TARGET of --seeds, where the new ones are kept. Exit code 1: something was found.
"""

import argparse
import concurrent.futures
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
MOST_INPUTS = 40
# Of one input, under sanitizers that make the program about five times slower and larger.
LIMITS = ["-rss_limit_mb=2048", "-malloc_limit_mb=1024"]


class Done:
    """Exit code, messages and processor time of a run."""
    def __init__(self, code, words, seconds):
        self.code, self.words, self.seconds = code, words, seconds


def call(program, target, arguments):
    with tempfile.TemporaryDirectory(prefix="fppg-fuzz-") as folder, tempfile.TemporaryFile() as words:
        environment = dict(os.environ, FPPG_FUZZ_TARGET=target, TMPDIR=folder, OMP_NUM_THREADS="1",
                           UBSAN_OPTIONS="print_stacktrace=1")
        process = subprocess.Popen([program, *arguments], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=words)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        words.seek(0)
        return Done(process.returncode, words.read().decode(errors="replace"), usage.ru_utime + usage.ru_stime)


def all_targets(program):
    return re.search(r"there are:(.*)", call(program, "", []).words).group(1).split()


def corpus_of(target):
    return os.path.join(HERE, "corpus", target)


def fuzz(options, target):
    new = os.path.join(options.seeds, target)
    os.makedirs(new, exist_ok=True)
    os.makedirs(options.findings, exist_ok=True)
    seeds = [new] + [f for f in (corpus_of(target),) if os.path.isdir(f)]
    log_name = os.path.join(options.findings, target + ".log")
    runs, used, left, done = 0, 0.0, options.seconds, None
    # A round ends by the clock; on a busy machine it takes several until the target had its processor time.
    while left > 0 and (done is None or done.code == 0):
        done = call(options.program, target, [f"-max_total_time={left}", "-print_final_stats=1", "-max_len=8192", f"-seed={options.seed}",
                                              f"-artifact_prefix={options.findings}/{target}-", f"-timeout={options.input_seconds}", *LIMITS, *seeds])
        with open(log_name, "a" if used else "w", encoding="utf-8") as log:
            log.write(done.words)
        runs += int((re.findall(r"stat::number_of_executed_units: *(\d+)", done.words) or ["0"])[-1])
        used += done.seconds
        left = math.ceil(options.processor_seconds - used)
    edges = re.findall(r"cov: (\d+) ft: (\d+) corp: (\d+)", done.words)
    memory = re.findall(r"stat::peak_rss_mb: *(\d+)", done.words)
    found = re.findall(r"(?:SUMMARY: |runtime error: |ERROR: )(.*)", done.words)
    return [target, f"{used:.0f}", runs, *(edges[-1] if edges else "???"), memory[-1] if memory else "?",
            "none" if done.code == 0 else found[-1] if found else f"exit code {done.code}"]


def size_of(folder):
    return sum(os.path.getsize(os.path.join(folder, f)) for f in os.listdir(folder))


def merge(options, target, most):
    """Of the least inputs that reach all that the seeds reach MOST_INPUTS of all sizes, small ones first up to `most` bytes."""
    corpus = corpus_of(target)
    with tempfile.TemporaryDirectory(prefix="fppg-merge-") as out:
        old = [f for f in (os.path.join(options.seeds, target), corpus) if os.path.isdir(f)]
        if not old:
            return
        call(options.program, target, ["-merge=1", "-max_len=8192", f"-timeout={options.input_seconds}", *LIMITS, out, *old])
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
    parser.add_argument("--seconds", type=int, default=60, help="by the clock, of each target")
    parser.add_argument("--processor-seconds", type=int, default=0, help="go on until each target had so many")
    parser.add_argument("--input-seconds", type=int, default=60, help="by the clock, that one input may take")
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
    options.seconds = options.processor_seconds or options.seconds
    targets = options.targets.split(",") if options.targets else all_targets(options.program)
    if options.merge:
        for target in targets:
            merge(options, target, options.merge * 1000 // len(targets))
        return 0
    row = "{:<12} {:>9} {:>10} {:>7} {:>9} {:>7} {:>7}  {}"
    print(row.format("target", "processor", "runs", "edges", "features", "inputs", "MiB", "found"), flush=True)
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
