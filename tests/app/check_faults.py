#!/usr/bin/python3
"""A disk that is full, a run that is killed, a folder that is read-only, inputs that change: the old result or the new one.

    check_faults.py PROGRAM [unittest arguments]

FPPG_FAULTS=N makes N times as many steps and moments. FPPG_RUNNER starts a PROGRAM of another system, e.g. wine;
exits with 77 where one of the two is missing.
"""

import os
import random
import re
import resource
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from check_limits import box_stl
from sanitized import is_sanitized, times_slower

RUNNER = shlex.split(os.environ.get("FPPG_RUNNER", ""))
PROGRAM = [*RUNNER, sys.argv[1]]
SLOWER = times_slower(PROGRAM[-1])
TIMES = int(os.environ.get("FPPG_FAULTS", "1"))
os.environ["SOURCE_DATE_EPOCH"] = "86400"
CASE = """<case><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" />
<hswl value="0" auto="true" /><gamma value="7" /><coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" />
</constantsdef><mkconfig boundcount="240" fluidcount="9" /><geometry><definition dp="{dp}">
<pointmin x="-0.5" y="-0.5" z="-0.5" /><pointmax x="1.5" y="1.5" z="1.5" /></definition><commands><mainlist>
<setdrawmode mode="full" /><setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0.2" y="0.2" z="0.2" />
<size x="0.6" y="0.6" z="0.6" /></drawbox><setmkbound mk="0" /><drawfilestl file="data/box.stl" autofill="false" />
</mainlist></commands></geometry></casedef><execution><parameters><parameter key="TimeMax" value="1" /></parameters>
</execution></case>
"""


class Faults(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="fppg-faults-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        os.mkdir(self.path("data"))
        self.write("data/box.stl", box_stl(1, 0))
        self.write_case("0.05")
        os.mkdir(self.path("out"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data if isinstance(data, bytes) else data.encode())

    def write_case(self, dp):
        self.write("Case_Def.xml", CASE.format(dp=dp))

    def start(self, *arguments, **options):
        return subprocess.Popen([*PROGRAM, *arguments], cwd=self.folder, text=True, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)

    def run_it(self, *arguments, **options):
        process = self.start(*arguments, **options)
        out, _ = process.communicate(timeout=120 * SLOWER)
        return process.returncode, out

    def make(self, *arguments):
        code, out = self.run_it("Case_Def", "out/Case", *arguments)
        self.assertEqual(code, 0, out)
        return self.contents()

    def contents(self, folder="out"):
        found = {}
        for at, _, names in os.walk(self.path(folder)):
            for name in names:
                path = os.path.join(at, name)
                with open(path, "rb") as file:
                    found[os.path.relpath(path, self.path(folder))] = file.read()
        return found

    def results(self, folder="out"):
        """All but the log, which has times in it."""
        return {name: data for name, data in self.contents(folder).items() if not name.endswith(".out")}


class FullDisk(Faults):
    """Both old and new results are known byte for byte."""

    def expect_old_or_new(self, code, out, folder, old, new):
        now = self.contents(folder)
        if code == 0:
            self.assertEqual(self.results(folder), new)
            return
        self.assertEqual(code, 4, out)
        self.assertIn("*** Error: ", out)
        self.assertEqual(now, old, out)

    def test_at_any_byte_of_the_output(self):
        """A limit of the size of files stops every file at some place; no root is needed."""
        new = {n: d for n, d in self.make("-save:all", "-dp:0.04").items() if not n.endswith(".out")}
        old = self.make("-save:all")
        most = max(len(data) for data in new.values())
        codes = []
        for step in range(20 * TIMES + 1):
            limit = most * step // (20 * TIMES)

            def hold(limit=limit):
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

            code, out = self.run_it("Case_Def", "out/Case", "-save:all", "-dp:0.04", preexec_fn=hold)
            self.expect_old_or_new(code, out, "out", old, new)
            codes.append(code)
        self.assertEqual(codes[-1], 0)
        self.assertGreater(codes.count(4), 10 * TIMES)

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("mount"), "only root can mount a small disk")
    def test_of_any_size(self):
        new = {n: d for n, d in self.make("-save:all", "-dp:0.04").items() if not n.endswith(".out")}
        old = self.make("-save:all")
        need = sum((len(data) + 4095) // 4096 for data in list(old.values()) + list(new.values())) + 4
        least = sum((len(data) + 4095) // 4096 for data in old.values())
        disk = self.path("disk")
        os.mkdir(disk)
        steps = 20 * TIMES
        codes = []
        for step in range(steps + 1):
            pages = least + (need - least) * step // steps
            mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={pages * 4096}", "tmpfs", disk], check=False)
            if mounted.returncode != 0:
                self.skipTest("this system mounts no tmpfs")
            try:
                shutil.copytree(self.path("out"), disk, dirs_exist_ok=True)
                code, out = self.run_it("Case_Def", "disk/Case", "-save:all", "-dp:0.04")
                self.expect_old_or_new(code, out, "disk", old, new)
                codes.append(code)
            finally:
                subprocess.run(["umount", disk], check=True)
        self.assertGreater(codes.count(4), 10 * TIMES)


class Killed(Faults):
    def test_at_any_moment(self):
        """The next run finds the old result whole, the new one, or no Case.xml; and it puts all right."""
        new = {n: d for n, d in self.make("-save:all", "-dp:0.02").items() if not n.endswith(".out")}
        begin = time.monotonic()
        self.make("-save:all", "-dp:0.02")
        takes = time.monotonic() - begin
        shutil.rmtree(self.path("out"))
        old = {n: d for n, d in self.make("-save:all").items() if not n.endswith(".out")}
        shutil.copytree(self.path("out"), self.path("kept"))
        moments = random.Random(27)
        seen = {"old": 0, "new": 0, "between": 0}
        for _ in range(30 * TIMES):
            process = self.start("Case_Def", "out/Case", "-save:all", "-dp:0.02")
            time.sleep(moments.uniform(0, 1.1 * takes))
            process.kill()
            process.communicate(timeout=60 * SLOWER)
            files = {name: data for name, data in self.results().items() if ".part-" not in name and ".lock" not in name}
            pair = [(files.get("Case.xml"), files.get("Case.bi4"))]
            if pair[0][0] is None:
                seen["between"] += 1
                code, out = self.run_it("report", "out/Case", "-o", "page.html")
                self.assertEqual(code, 4, out)
            else:
                self.assertIn(pair[0], [(r["Case.xml"], r["Case.bi4"]) for r in (old, new)])
                seen["old" if pair[0][0] == old["Case.xml"] else "new"] += 1
            self.make("-save:all")
            self.assertEqual(self.results(), old)
        self.assertGreater(seen["old"], 0, seen)


class Folders(Faults):
    def test_that_cannot_be_written(self):
        old = self.make()
        os.chmod(self.folder, 0o755)
        os.chmod(self.path("out"), 0o555)
        self.addCleanup(os.chmod, self.path("out"), 0o755)
        nobody = {"user": 65534} if os.geteuid() == 0 else {}
        code, out = self.run_it("Case_Def", "out/Case", **nobody)
        self.assertEqual(code, 4, out)
        self.assertRegex(out, r"\*\*\* Error: .*out/.*: Permission denied")
        self.assertEqual(self.contents(), old)

    def test_of_odd_names(self):
        for name in ("a b", "ünïcödé", "水", "a'b", "x" * 250, "-x"):
            os.makedirs(self.path(name))
            shutil.copytree(self.path("data"), self.path(name + "/data"))
            definition = f"./{name}/{name[:240]}_Def"
            shutil.copy(self.path("Case_Def.xml"), self.path(definition + ".xml"))
            code, out = self.run_it(definition, f"./{name}/{name[:240]}", "-save:all")
            self.assertEqual(code, 0, out)
            self.assertIn(f"{name[:240]}.bi4", os.listdir(self.path(name)))
            self.assertEqual([n for n in os.listdir(self.path(name)) if n.startswith(".")], [])

    def test_of_four_thousand_characters(self):
        deep = "/".join(["d" * 199] * 19)
        os.makedirs(self.path("w"))
        at = self.path("w")
        os.chdir(at)
        try:
            for part in deep.split("/"):
                os.mkdir(part)
                os.chdir(part)
        finally:
            os.chdir("/")
        for length in (3800, 4050, 4090, 4096, 5000):
            output = ("w/" + deep + "/" + "C" * 255)[:length]
            output = output if length < 4096 else output + "C" * (length - len(output))
            code, out = self.run_it("Case_Def", output)
            self.assertIn(code, (0, 4), out)
            if code == 4:
                self.assertIn("File name too long", out)
        shutil.rmtree(at, ignore_errors=True)

    def test_longer_than_the_system_takes(self):
        long = "C" * 300
        for command in (["upgrade", long], ["upgrade", "Case_Def", "-o", long], ["templates", long], ["batch", long]):
            code, out = self.run_it(*command)
            self.assertEqual(code, 4, out)
            self.assertRegex(out, "C{300}.*: File name too long")

    def test_that_lead_elsewhere_by_a_link(self):
        os.mkdir(self.path("real"))
        os.symlink("real", self.path("link"))
        self.assertEqual(self.run_it("Case_Def", "link/Case")[0], 0)
        self.assertLess({"Case.bi4", "Case.out", "Case.xml", "data"}, set(os.listdir(self.path("real"))))

    def test_in_place_of_files(self):
        for name in ("Case.bi4", "Case.xml"):
            os.mkdir(self.path("out/" + name))
            code, out = self.run_it("Case_Def", "out/Case")
            self.assertEqual(code, 4, out)
            self.assertIn("Is a directory", out)
            os.rmdir(self.path("out/" + name))
        code, out = self.run_it("Case_Def", "Case_Def.xml/Case")
        self.assertEqual(code, 4, out)


class Inputs(Faults):
    def test_that_change_while_they_are_read(self):
        """A mesh and a definition that others write at the same time: a result that belongs together, or an error."""
        stop = threading.Event()
        small, large = box_stl(0.5, 0.2), box_stl(1, 0)

        def disturb():
            turn = 0
            while not stop.is_set():
                turn += 1
                self.write("data/box.stl", (small, large, large[:300])[turn % 3])
                self.write_case(("0.05", "0.04")[turn % 2])
                if turn % 5 == 0:
                    os.remove(self.path("data/box.stl"))

        thread = threading.Thread(target=disturb)
        thread.start()
        codes = []
        try:
            for _ in range(40 * TIMES):
                code, out = self.run_it("Case_Def", "out/Case")
                self.assertIn(code, (0, 3, 4), out)
                codes.append(code)
                if code == 0:
                    with open(self.path("out/Case.xml"), encoding="utf-8") as file:
                        np = int(re.search(r'<particles np="(\d+)"', file.read()).group(1))
                    with open(self.path("out/Case.out"), encoding="utf-8") as file:
                        total = re.search(r"Total particles: ([\d,]+)", file.read()).group(1)
                    self.assertEqual(np, int(total.replace(",", "")))
        finally:
            stop.set()
            thread.join()
        self.assertGreater(codes.count(0), 0)

    def test_that_shrink_under_the_reader(self):
        """A large mesh that is cut while it is read must not end the program by SIGBUS."""
        facets = box_stl(1, 0)
        big = facets[:80] + struct.pack("<I", 12 * 40000) + facets[84:] * 40000
        for wait in [0.01 * i for i in range(20 * TIMES)]:
            self.write("data/box.stl", big)
            process = self.start("Case_Def", "out/Case")
            time.sleep(wait)
            os.truncate(self.path("data/box.stl"), 4096)
            out, _ = process.communicate(timeout=120 * SLOWER)
            self.assertIn(process.returncode, (0, 3, 4), out)

    def test_of_the_future(self):
        """A clock that went backwards: files that are newer than now are replaced as any other."""
        self.make()
        ahead = time.time() + 1e7
        for name in os.listdir(self.path("out")):
            os.utime(self.path("out/" + name), (ahead, ahead))
        self.make("-dp:0.04")
        for name in ("Case.xml", "Case.bi4", "Case.out"):
            self.assertLess(os.stat(self.path("out/" + name)).st_mtime, ahead)


@unittest.skipIf(is_sanitized(PROGRAM[-1]), "the sanitizer needs memory without limits")
class Memory(Faults):
    def run_with(self, size, *arguments):
        return self.run_it("Case_Def", "out/Case", *arguments,
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)))

    def test_that_runs_out_anywhere(self):
        """20 limits a case or more, from what the program alone needs up to what the case needs. Embree lacks
        threads, and once went on waiting for them, in some 20 of 400 MB only."""
        for arguments, steps in ((("-dp:0.02", "-fit:raw", "-threads:2"), 20), (("-dp:0.05", "-fit", "-threads:4"), 100),
                                 (("-dp:0.01", "-threads:8", "-save:all"), 20)):
            old = self.make()
            enough = 64 << 20
            while self.run_with(enough, *arguments)[0] != 0:
                enough += enough // 4
                self.assertLess(enough, 1 << 33)
            least = enough // 4
            while self.run_it("-h", preexec_fn=lambda size=least: resource.setrlimit(
                    resource.RLIMIT_AS, (size, size)))[0] != 0:
                least += 1 << 20
            codes = []
            for step in range(steps):
                self.make()
                before = self.contents()
                code, out = self.run_with(least + (enough - least) * step // steps, *arguments)
                self.assertIn(code, (0, 3, 4), out)
                codes.append(code)
                if code != 0:
                    self.assertRegex(out, r"\*\*\* Error: .*(memory|threads)")
                    self.assertEqual(self.contents(), before)
            self.assertTrue(old)
            self.assertGreater(len(codes) - codes.count(0), 2, codes)


if __name__ == "__main__":
    for needed in (*RUNNER[:1], PROGRAM[-1]):
        if not shutil.which(needed):
            print(f"skipped: there is no {needed}")
            sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
