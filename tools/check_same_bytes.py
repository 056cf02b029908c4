#!/usr/bin/python3
"""Runs all cases of cases/ with 1, 2, 3, 8 and 16 threads, twice each, on the lattice, fitted and relaxed: the same bytes each time.

    check_same_bytes.py PROGRAM [--other PROGRAM] [--cases dambreak,gear] [--threads 1,16] [--coarser 2.5]
    check_same_bytes.py PROGRAM --recorded FILE [--write]    # particles on the lattice, against a record that all compilers share

With --other, of another compiler: on the lattice its files are the same; fitted, no particle is farther than 1e-12 dp from its place.
"""

import argparse
import glob
import hashlib
import os
import re
import struct
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
MODES = {"lattice": "-fit:off", "fitted": "-fit:raw", "relaxed": "-fit"}
# At a coarser dp the gearbox has no room for its oil.
COARSER = {"gearbox": 1.5, "floating": 2.0}


def run(program, definition, dp, mode, threads, folder):
    """name -> bytes of the files of a run; a refusal is a text that has to be the same."""
    environment = dict(os.environ, SOURCE_DATE_EPOCH="86400")
    done = subprocess.run([program, definition, "out/Case", f"-dp:{dp:.6g}", MODES[mode], f"-threads:{threads}", "-save:all"], cwd=folder,
                          env=environment, check=False, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    if done.returncode != 0:
        return {"error": re.sub(r".*\*\*\* Error", "Error", done.stdout, flags=re.S).encode()}
    files = {}
    for name in sorted(os.listdir(os.path.join(folder, "out"))):
        if name.startswith("Case") and not name.endswith(".out"):
            with open(os.path.join(folder, "out", name), "rb") as file:
                files[name] = file.read()
    return files


def hash_of(files):
    whole = hashlib.sha256()
    for name in sorted(files):
        whole.update(name.encode() + b"\0" + files[name])
    return whole.hexdigest()[:12]


def array_of(bi4, name):
    head = b"\nARRAY" + struct.pack("<I", len(name)) + name
    at = bi4.index(head) + len(head)
    count, size = struct.unpack_from("<II", bi4, at + 8)
    return count, bi4[at + 16:at + 16 + size]


def farthest(first, second, dp):
    """Between particles of one id, in dp; None where ids differ."""
    if ("Case.bi4" in first) != ("Case.bi4" in second):
        return None
    if "Case.bi4" not in first:
        return 0.0 if first == second else None
    first, second = first["Case.bi4"], second["Case.bi4"]
    if array_of(first, b"Idp") != array_of(second, b"Idp"):
        return None
    count, places = array_of(first, b"Posd")
    others = array_of(second, b"Posd")[1]
    form = f"<{3 * count}d"
    return max((abs(a - b) for a, b in zip(struct.unpack(form, places), struct.unpack(form, others))), default=0.0) / dp


def name_and_dp(options, definition):
    with open(definition, encoding="utf-8") as file:
        dp = float(re.search(r'<definition dp="([^"]+)"', file.read()).group(1))
    name = os.path.basename(os.path.dirname(definition))
    return name, dp * COARSER.get(name, options.coarser)


def check_record(options, definitions):
    """Number and hash of ids and places of all particles on the lattice: one record for every compiler."""
    lines = []
    for definition in definitions:
        name, dp = name_and_dp(options, definition)
        with tempfile.TemporaryDirectory(prefix="fppg-bytes-") as folder:
            files = run(options.program, definition[:-4], dp, "lattice", 2, folder)
        if "Case.bi4" not in files:
            print(name, files.get("error", b"").decode().strip())
            return False
        count, ids = array_of(files["Case.bi4"], b"Idp")
        lines.append(f"{name}\t{count}\t{hashlib.sha256(ids + array_of(files['Case.bi4'], b'Posd')[1]).hexdigest()[:16]}\n")
    if options.write:
        with open(options.recorded, "w", encoding="utf-8") as file:
            file.writelines(lines)
    with open(options.recorded, encoding="utf-8") as file:
        recorded = dict(line.split("\t", 1) for line in file)
    other = [line for line in lines if recorded.get(line.split("\t")[0]) != line.split("\t", 1)[1]]
    print(f"{len(lines) - len(other)} of {len(lines)} cases have the recorded particles", *other, sep="\n")
    return lines and not other


def check(options, definition, mode):
    """Prints a row; whether all is as it should be."""
    name, dp = name_and_dp(options, definition)
    hashes = set()
    last = {}
    for threads in options.threads.split(","):
        for _ in range(2):
            with tempfile.TemporaryDirectory(prefix="fppg-bytes-") as folder:
                last = run(options.program, definition[:-4], dp, mode, threads, folder)
            hashes.add(hash_of(last))
    count = array_of(last["Case.bi4"], b"Idp")[0] if "Case.bi4" in last else last.get("error", b"").decode().strip()[:60]
    words = [f"{len(hashes)} results" if len(hashes) > 1 else "same bytes"]
    is_right = len(hashes) == 1
    if options.other:
        with tempfile.TemporaryDirectory(prefix="fppg-bytes-") as folder:
            theirs = run(options.other, definition[:-4], dp, mode, 2, folder)
        far = farthest(last, theirs, dp)
        is_right &= theirs == last if mode == "lattice" else far is not None and far <= 1e-12
        words.append("other compiler: the same" if theirs == last else
                     "other compiler: other particles" if far is None else f"other compiler: within {far:.2g} dp")
    print(f"{name:<12} {mode:<8} {count!s:>10}  {'; '.join(words)}", flush=True)
    return is_right


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--other", default="")
    parser.add_argument("--cases", default="")
    parser.add_argument("--threads", default="1,2,3,8,16")
    parser.add_argument("--modes", default=",".join(MODES))
    parser.add_argument("--coarser", type=float, default=2.5, help="than the dp of the case")
    parser.add_argument("--recorded", default="")
    parser.add_argument("--write", action="store_true", help="the record anew")
    options = parser.parse_args()
    options.program = os.path.abspath(options.program)
    options.other = os.path.abspath(options.other) if options.other else ""
    definitions = sorted(glob.glob(f"{ROOT}/cases/*/*_Def.xml"))
    if options.cases:
        definitions = [d for d in definitions if os.path.basename(os.path.dirname(d)) in options.cases.split(",")]
    if options.recorded:
        return 0 if check_record(options, definitions) else 1
    right = [check(options, d, mode) for mode in options.modes.split(",") for d in definitions]
    print(f"{right.count(True)} of {len(right)} as they should be")
    return 0 if right and all(right) else 1


if __name__ == "__main__":
    sys.exit(main())
