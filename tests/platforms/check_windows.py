#!/usr/bin/python3
"""What is Windows' own in fppg.exe, tried with wine: names of files, arguments, consoles, batches, results that stay.

    check_windows.py PROGRAM EXE WINE

PROGRAM  the program of this system, for the bytes that are expected
Exits with 77 where EXE or WINE is not there.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, EXE, WINE = sys.argv[1:4]
CASE = """<case><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" />
<hswl value="0" auto="true" /><gamma value="7" /><coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" />
</constantsdef><mkconfig boundcount="240" fluidcount="9" /><geometry><definition dp="{dp}">
<pointmin x="-0.5" y="-0.5" z="-0.5" /><pointmax x="1.5" y="1.5" z="1.5" /></definition><commands><mainlist>
<setshapemode>dp | bound</setshapemode><setdrawmode mode="full" /><setmkbound mk="0" />
<drawbox><boxfill>bottom | left</boxfill><point x="0" y="0" z="0" /><size x="1" y="1" z="1" /></drawbox>
{draws}</mainlist></commands></geometry></casedef>
<execution><parameters><parameter key="TimeMax" value="1" /></parameters></execution></case>
"""


class Windows(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="fppg-windows-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def write_case(self, name="Case_Def.xml", dp=0.1, draws=""):
        self.write(name, CASE.format(dp=dp, draws=draws))

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def run_exe(self, *arguments, code=0, exe=EXE, folder="."):
        done = subprocess.run([WINE, exe, *arguments], cwd=self.path(folder), stdin=subprocess.DEVNULL, timeout=300,
                              env=dict(os.environ, WINEDEBUG="-all", SOURCE_DATE_EPOCH="0"), stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, check=False)
        text = done.stdout.decode("utf-8", "replace")
        self.assertEqual(done.returncode, code, text[-2000:])
        return text

    def expected(self, definition="Case_Def"):
        subprocess.run([PROGRAM, definition, self.path("expected/Case")], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL)
        return self.read("expected/Case.bi4")

    def test_gencase_may_be_its_name(self):
        """Scripts of GenCase call GenCase_win64.exe, with slashes and with backslashes."""
        self.write_case()
        shutil.copy(EXE, self.path("GenCase_win64.exe"))
        text = self.run_exe("Case_Def", r"out\Case", "-save:all", exe=self.path("GenCase_win64.exe"))
        self.assertIn("Finished execution (code=0).", text)
        self.assertEqual(self.read("out/Case.bi4"), self.expected())
        self.assertTrue(os.path.exists(self.path("out/Case_All.vtk")))

    def test_lines_end_as_those_of_gencase_for_windows(self):
        self.write_case()
        self.run_exe("Case_Def", "out/Case")
        for name in ("out/Case.xml", "out/Case.out"):
            text = self.read(name)
            self.assertEqual(text.count(b"\r\n"), text.count(b"\n"))
            self.assertGreater(text.count(b"\n"), 9)

    def test_a_batch_file_of_windows_runs_it(self):
        self.write_case()
        shutil.copy(EXE, self.path("GenCase_win64.exe"))
        self.write("run.bat", "@echo off\r\nset name=Case\r\nset dirout=%name%_out\r\nset gencase=\"GenCase_win64.exe\"\r\n"
                   "%gencase% %name%_Def %dirout%/%name% -save:all\r\nif not \"%ERRORLEVEL%\" == \"0\" goto fail\r\n"
                   "echo All done\r\ngoto end\r\n:fail\r\necho Execution aborted.\r\n:end\r\n")
        text = self.run_exe("/c", "run.bat", exe="cmd")
        self.assertIn("All done", text)
        self.assertEqual(self.read("Case_out/Case.bi4"), self.expected())

    def test_names_have_blanks_and_letters_of_all_languages(self):
        name = "Fälle 測試 🌊/Damm bruch"
        self.write_case(name + "_Def.xml")
        self.run_exe(name + "_Def", "Ergebnis ü 水/Case")
        self.assertEqual(self.read("Ergebnis ü 水/Case.bi4"), self.expected(name + "_Def"))
        text = self.run_exe(name + "_fehlt_Def", "x/Fall", code=4)
        self.assertIn("Fälle 測試 🌊", text)

    def test_paths_are_longer_than_260_characters(self):
        long = "/".join(["a_folder_with_a_name_of_forty_characters"] * 9)
        self.write_case(long + "/Case_Def.xml")
        self.run_exe(long + "/Case_Def", long + "/out/Case", "-save:all")
        self.assertEqual(self.read(long + "/out/Case.bi4"), self.expected(long + "/Case_Def"))

    def test_an_error_leaves_the_old_result(self):
        self.write_case()
        self.run_exe("Case_Def", "out/Case")
        old = self.read("out/Case.bi4")
        self.write_case(draws="<drawfilestl file=\"missing.stl\" />")
        self.assertIn("missing.stl", self.run_exe("Case_Def", "out/Case", code=4))
        self.assertEqual(self.read("out/Case.bi4"), old)
        self.assertEqual(self.run_exe("Case_Def", "-nonsense", code=2).count("Error"), 1)
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["Case.bi4", "Case.out", "Case.xml"] + self.pictures())

    def pictures(self):
        return sorted(name for name in os.listdir(self.path("out")) if name.endswith(".vtk"))

    def test_a_file_of_the_result_stays_in_its_folder(self):
        self.write_case(draws="<shapeout file=\"..\\evil\" />")
        self.assertIn("leads out of the folder", self.run_exe("Case_Def", "out/Case", code=3))

    def test_two_runs_do_not_write_one_output(self):
        self.write_case(dp=0.02)
        environment = dict(os.environ, WINEDEBUG="-all")
        runs = [subprocess.Popen([WINE, EXE, "Case_Def", "out/Case"], cwd=self.folder, env=environment,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(3)]
        self.assertEqual([run.wait(300) for run in runs], [0, 0, 0])
        self.assertFalse([name for name in os.listdir(self.path("out")) if name.startswith(".")])

    def test_a_killed_run_leaves_the_old_result_and_the_next_one_cleans_up(self):
        self.write_case()
        self.run_exe("Case_Def", "out/Case")
        old = self.read("out/Case.bi4")
        self.write("out/.Case.bi4.part-999999", "half")
        self.run_exe("Case_Def", "out/Case")
        self.assertEqual(self.read("out/Case.bi4"), old)
        self.assertFalse([name for name in os.listdir(self.path("out")) if name.startswith(".")])

    def test_a_batch_runs_several_at_a_time_and_reports(self):
        for i in range(3):
            self.write_case(f"cases/Case{i}_Def.xml", dp=0.1 + 0.01 * i)
        self.run_exe("batch", "cases", "--out", "results", "--jobs", "2")
        found = [name for _, _, names in os.walk(self.path("results")) for name in names]
        self.assertEqual(len([name for name in found if name.endswith(".bi4")]), 3)
        self.assertTrue(any(name.endswith(".html") for name in found))
        text = self.run_exe("batch", "cases", "--out", "results", "--slurm", code=2)
        self.assertIn("Windows", text)

    def test_subcommands_read_results(self):
        self.write_case()
        self.run_exe("Case_Def", "out/Case", "-save:all")
        self.run_exe("compare", "out/Case", "out/Case")
        self.run_exe("report", "out/Case", "-o", "page.html")
        self.run_exe("render", "out/Case", "-o", "picture.png")
        self.assertEqual(self.read("picture.png")[:8], b"\x89PNG\r\n\x1a\n")
        self.assertIn(b"</html>", self.read("page.html"))
        self.run_exe("convert", "out/Case", "-o", "case.vtu")
        self.assertIn("libfppg_hdf5", self.run_exe("convert", "out/Case", "-o", "case.hdf5", code=4))
        json.loads(self.run_exe("estimate", "Case_Def", "--json"))


def main():
    for needed in (EXE, WINE):
        if not shutil.which(needed) and not os.path.exists(needed):
            print(f"skipped: there is no {needed}")
            return 77
    return 0 if unittest.main(argv=[sys.argv[0], *sys.argv[4:]], exit=False, verbosity=1).result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
