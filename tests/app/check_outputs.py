#!/usr/bin/python3
"""What a run leaves when others write the same output, when it is stopped or killed, and when it cannot print.

    check_outputs.py PROGRAM SHIM [unittest arguments]

SHIM is a library that kills the program as it renames a file and lets its calls fail, or "" where none was built.
"""

import errno
import fcntl
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from sanitized import times_slower

PROGRAM, SHIM = sys.argv[1:3]
SLOWER = times_slower(PROGRAM)
os.environ["SOURCE_DATE_EPOCH"] = "86400"
HEAD = """<case><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" />
<hswl value="0" auto="true" /><gamma value="7" /><coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" />
</constantsdef><mkconfig boundcount="240" fluidcount="9" /><geometry><definition dp="0.05">
<pointmin x="-0.5" y="-0.5" z="-0.5" /><pointmax x="1.5" y="1.5" z="1.5" /></definition><commands><mainlist>
<setdrawmode mode="full" /><setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" />
<size x="1" y="1" z="0.6" /></drawbox><setmkbound mk="0" /><drawbox><boxfill>bottom | left | right | front | back
</boxfill><point x="0" y="0" z="0" /><size x="1" y="1" z="1" /></drawbox><setmkbound mk="1" />
<drawsphere radius="0.23"><point x="0.5" y="0.5" z="0.3" /></drawsphere></mainlist></commands></geometry>"""
TAIL = '</casedef><execution><parameters><parameter key="TimeMax" value="1" /></parameters></execution></case>\n'
RELAXING = '<fppg><bodyfitted mkbound="1"><relax iterations="1000000" tolerance="1e-12" /></bodyfitted></fppg>'
STOPS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE, signal.SIGXCPU, signal.SIGQUIT,
         signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM]


def number_in(path, pattern):
    with open(path, encoding="utf-8") as file:
        return int(re.search(pattern, file.read()).group(1).replace(",", ""))


def np_of_bi4(path):
    with open(path, "rb") as file:
        data = file.read(4096)
    at = data.index(b"CaseNp") + len(b"CaseNp") + 4
    return int.from_bytes(data[at:at + 8], "little")


class Outputs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="fppg-outputs-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.write("Case_Def.xml", HEAD + TAIL)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def start(self, *arguments, **options):
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        return subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, **{**pipes, **options})

    def run_it(self, *arguments, **options):
        process = self.start(*arguments, **options)
        out, err = process.communicate(timeout=120 * SLOWER)
        return process.returncode, out, err

    def contents(self):
        out = {}
        for name in os.listdir(self.path("out")):
            with open(self.path("out/" + name), "rb") as file:
                out[name] = file.read()
        return out

    def make_old_result(self):
        self.assertEqual(self.run_it("Case_Def", "out/Case", "-save:all")[0], 0)
        return self.contents()

    def wait_until(self, is_time, process):
        end = time.monotonic() + 60 * SLOWER
        while not is_time() and process.poll() is None and time.monotonic() < end:
            time.sleep(0.0005)

    def leftovers(self):
        return [name for name in os.listdir(self.path("out")) if name.startswith(".")]

    def expect_pair(self):
        np = number_in(self.path("out/Case.xml"), r'<particles np="(\d+)"')
        self.assertEqual(np_of_bi4(self.path("out/Case.bi4")), np)
        self.assertEqual(number_in(self.path("out/Case.out"), r"Total particles: ([\d,]+)"), np)


class TwoRuns(Outputs):
    def test_into_one_output_leave_the_files_of_one(self):
        for _ in range(20):
            two = [self.start("Case_Def", "out/Case", dp) for dp in ("-dp:0.02", "-dp:0.025")]
            for process in two:
                out, _ = process.communicate(timeout=120 * SLOWER)
                self.assertEqual(process.returncode, 0, out)
            self.expect_pair()
            self.assertEqual(self.leftovers(), [])

    def test_are_refused_where_the_first_takes_long(self):
        before = self.make_old_result()
        with open(self.path("out/.Case.lock"), "w", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            file.write("process 4711 on elsewhere\n")
            file.flush()
            code, out, err = self.run_it("Case_Def", "out/Case")
            self.assertEqual(code, 4, out)
            for text in (out, err):
                self.assertIn("out/Case: another run writes this output (process 4711 on elsewhere)", text)
            self.assertEqual({n: b for n, b in self.contents().items() if n != ".Case.lock"}, before)
            self.assertEqual(self.run_it("Case_Def", "out/Other")[0], 0)
        # Nobody holds it any more.
        self.assertEqual(self.run_it("Case_Def", "out/Case")[0], 0)
        self.assertEqual(self.leftovers(), [])


class Mixed(Outputs):
    def expect_refused(self, text, definition=True):
        calls = [("compare", "out/Case", "out/Case"), ("report", "out/Case", "-o", "page.html"),
                 ("render", "out/Case", "-o", "picture.png")]
        if definition:
            calls.append(("leak", "out/Case", "out/Case.bi4"))
        for call in calls:
            code, out, _ = self.run_it(*call)
            self.assertNotIn(code, (0, 1), out)
            self.assertIn(text, out, call)

    def test_files_are_refused_by_whoever_reads_them(self):
        self.assertEqual(self.run_it("Case_Def", "out/Case")[0], 0)
        self.assertEqual(self.run_it("Case_Def", "other/Case", "-dp:0.04")[0], 0)
        shutil.copy(self.path("other/Case.xml"), self.path("out/Case.xml"))
        self.expect_refused("'out/Case.bi4' and 'out/Case.xml' are not of one run: ")

    def test_files_of_as_many_particles_elsewhere_are_refused_too(self):
        self.assertEqual(self.run_it("Case_Def", "out/Case")[0], 0)
        self.write("Moved_Def.xml", (HEAD + TAIL).replace('<point x="0" y="0"', '<point x="0.1" y="0"')
                   .replace('<point x="0.5"', '<point x="0.6"'))
        self.assertEqual(self.run_it("Moved_Def", "other/Case")[0], 0)
        self.assertEqual(np_of_bi4(self.path("out/Case.bi4")), np_of_bi4(self.path("other/Case.bi4")))
        shutil.copy(self.path("other/Case.xml"), self.path("out/Case.xml"))
        self.expect_refused("not of one run: the least place of all particles is ")

    @unittest.skipUnless(SHIM, "the library that kills was not built")
    def test_files_are_never_left_by_a_run_that_is_killed_while_it_renames(self):
        old = self.make_old_result()
        killed_between = 0
        for at in range(1, 30):
            code, _, _ = self.run_it("Case_Def", "out/Case", "-save:all", "-dp:0.04",
                                     env={**os.environ, "LD_PRELOAD": SHIM, "KILL_AT_RENAME": str(at)})
            if code == 0:
                break
            self.assertEqual(code, -signal.SIGKILL)
            files = self.contents()
            if "Case.xml" in files:
                self.assertEqual((files["Case.xml"], files["Case.bi4"]), (old["Case.xml"], old["Case.bi4"]))
            else:
                killed_between += 1
                self.expect_refused("a run that replaced both was killed or still works: make the case again")
            # The next run puts all right.
            self.assertEqual(self.run_it("Case_Def", "out/Case", "-save:all")[0], 0)
            self.expect_pair()
            self.assertEqual(self.leftovers(), [])
        self.assertEqual(code, 0)
        self.assertEqual(killed_between, 2)
        self.expect_pair()

    def test_old_particles_beside_a_new_case_are_told(self):
        self.make_old_result()
        code, out, _ = self.run_it("Case_Def", "out/Case", "-save:-bi", "-dp:0.04")
        self.assertEqual(code, 0)
        self.assertIn("*** WARNING: out/Case.bi4 is of an earlier run", out)


@unittest.skipUnless(SHIM, "the library that lets calls fail was not built")
class Failing(Outputs):
    def test_calls_leave_the_old_files_alone(self):
        """A quota that is used up, or a disk that breaks: as room is taken, as bytes are written, as a file is closed."""
        before = self.make_old_result()
        for call in ("fallocate", "pwrite", "close"):
            for error in (errno.EDQUOT, errno.EIO):
                for at in range(1, 100):
                    environment = {**os.environ, "LD_PRELOAD": SHIM, "FAIL_CALL": call, "FAIL_AT": str(at), "FAIL_ERROR": str(error)}
                    code, out, _ = self.run_it("Case_Def", "out/Case", "-save:all", "-dp:0.04", env=environment)
                    if code == 0:
                        break
                    self.assertEqual(code, 4, out)
                    self.assertRegex(out, rf"\*\*\* Error: .*{os.strerror(error)}")
                    self.assertEqual(self.contents(), before, (call, at))
                self.assertEqual(code, 0, out)
                self.assertGreater(at, 1, call)
                before = self.make_old_result()


class Stopped(Outputs):
    def stop(self, number, is_time, definition="Case_Def", *arguments):
        process = self.start(definition, "out/Case", "-save:all", *arguments)
        self.wait_until(is_time, process)
        process.send_signal(number)
        out, err = process.communicate(timeout=60 * SLOWER)
        return process.returncode, out + err

    def is_writing(self):
        return any(".part-" in name for name in os.listdir(self.path("out")))

    def test_by_any_signal_leaves_the_old_files_alone(self):
        before = self.make_old_result()
        for number in STOPS:
            code, text = self.stop(number, self.is_writing, "Case_Def", "-dp:0.004")
            self.assertEqual(code, 128 + number, text)
            self.assertIn("no output file was changed", text)
            self.assertEqual(self.contents(), before, number)

    def test_at_any_stage_leaves_the_old_files_alone(self):
        before = self.make_old_result()
        self.write("Relax_Def.xml", HEAD + RELAXING + TAIL)
        for number in (signal.SIGINT, signal.SIGTERM):
            for wait in (0.0, 0.05, 0.1, 0.2, 0.4, 0.8):
                end = [None]

                def is_time(end=end, wait=wait):
                    end[0] = end[0] or (time.monotonic() + wait if self.leftovers() else None)
                    return end[0] is not None and time.monotonic() > end[0]

                code, text = self.stop(number, is_time, "Relax_Def", "-dp:0.02")
                self.assertEqual(code, 128 + number, text)
                self.assertNotIn("Finished execution", text)
                self.assertEqual(self.contents(), before)

    def test_by_a_crash_leaves_no_temporary_file(self):
        before = self.make_old_result()
        code, _ = self.stop(signal.SIGSEGV, self.is_writing, "Case_Def", "-dp:0.004")
        self.assertEqual(code, -signal.SIGSEGV)
        self.assertEqual(self.contents(), before)

    def test_by_nothing_where_the_caller_ignores_the_signal(self):
        process = self.start("Case_Def", "out/Case", "-dp:0.01",
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.wait_until(lambda: os.path.exists(self.path("out/.Case.lock")), process)
        process.send_signal(signal.SIGHUP)
        out, _ = process.communicate(timeout=60 * SLOWER)
        self.assertEqual(process.returncode, 0, out)

    def test_by_sigkill_leaves_files_that_the_next_run_removes(self):
        self.make_old_result()
        code, _ = self.stop(signal.SIGKILL, self.is_writing, "Case_Def", "-dp:0.004")
        self.assertEqual(code, -signal.SIGKILL)
        left = self.leftovers()
        self.assertTrue(any(".part-" in name for name in left), left)
        # Of a living process, and of another output: they stay.
        alive = f".Case.bi4.part-{os.getpid()}"
        other = ".Case2.bi4.part-999999"
        for name in (alive, other, ".Case.bi4.part-", ".Case.bi4.part-12x"):
            self.write("out/" + name, "")
        self.assertEqual(self.run_it("Case_Def", "out/Case")[0], 0)
        self.assertEqual(sorted(self.leftovers()),
                         sorted([alive, other, ".Case.bi4.part-", ".Case.bi4.part-12x"]))

    def test_while_it_prints_to_a_reader_that_went_away(self):
        before = self.make_old_result()
        command = f'"{PROGRAM}" Case_Def out/Case -dp:0.004; echo $? > code'
        subprocess.run(["/bin/bash", "-c", f"({command}) | head -1"], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60 * SLOWER
        while not os.path.exists(self.path("code")) and time.monotonic() < deadline:
            time.sleep(0.01)
        time.sleep(0.05)
        with open(self.path("code"), encoding="utf-8") as file:
            self.assertEqual(int(file.read()), 128 + signal.SIGPIPE)
        self.assertEqual(self.contents(), before)


class Printed(Outputs):
    def test_to_a_full_disk_is_an_error_and_changes_no_file(self):
        before = self.make_old_result()
        calls = [("Case_Def", "out/Case"), ("Case_Def", "out/Case", "-log-json"), ("--help",), ("-info",), ("-ver",),
                 ("compare", "out/Case", "out/Case"), ("estimate", "Case_Def"), ("render", "--help"),
                 ("Nowhere_Def", "out/Case")]
        for call in calls:
            with open("/dev/full", "w", encoding="utf-8") as full:
                code, _, err = self.run_it(*call, stdout=full)
            self.assertEqual(code, 4, call)
            self.assertIn("No such file" if call[0] == "Nowhere_Def" else "standard output cannot be written", err)
            self.assertEqual(self.contents(), before)

    def test_to_nowhere_keeps_the_log_out_of_the_files(self):
        self.make_old_result()
        before = self.contents()["Case.bi4"]
        code = subprocess.run(["/bin/sh", "-c", f'"{PROGRAM}" Case_Def out/Case >&- 2>&- <&-'], cwd=self.folder,
                              check=False).returncode
        self.assertEqual(code, 0)
        self.assertEqual(self.contents()["Case.bi4"], before)

    def test_errors_reach_both_streams_and_one_only_once(self):
        code, out, err = self.run_it("Nowhere_Def", "out/Case")
        self.assertEqual(code, 4)
        line = re.search(r"\n(\*\*\* Error: Nowhere_Def.xml: cannot open the file: .*\n)\nFinished execution \(code=4\).\n",
                         out).group(1)
        self.assertEqual(err, line)
        _, out, _ = self.run_it("Nowhere_Def", "out/Case", stderr=subprocess.STDOUT)
        self.assertEqual(out.count(line), 1)
        for call in (("inspect", "none.stl"), ("compare", "a", "b"), ("render", "a", "-o", "b.png"), ("-sav:all",)):
            _, out, err = self.run_it(*call)
            self.assertTrue(err.startswith("*** Error: "), call)
            self.assertIn(err, out)
        _, out, err = self.run_it("Nowhere_Def", "out/Case", "-log-json")
        self.assertEqual(err, line)
        self.assertIn('"event":"error"', out)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
