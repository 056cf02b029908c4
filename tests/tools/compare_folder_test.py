import contextlib
import io
import json
import os
import shutil
import stat
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tools", "compare-with-gencase"))
import compare_folder  # noqa: E402 (found by the path above)

PROGRAM = os.environ.get("FPPG_PROGRAM")
needs_program = unittest.skipUnless(PROGRAM, "FPPG_PROGRAM names no program")

# In the place of GenCase: our own program, which moves spheres by a dp and refuses cylinders.
FAKE = f"""#!{sys.executable}
import subprocess, sys
text = open(sys.argv[1] + ".xml").read()
if "<drawcylinder" in text:
    print("Text: There are no cylinders here.")
    sys.exit(1)
open("Fake_Def.xml", "w").write(text.replace('<point x="0.5"', '<point x="0.6"'))
sys.exit(subprocess.run([{PROGRAM!r}, "Fake_Def", *sys.argv[2:]], stdout=subprocess.DEVNULL).returncode)
"""

CASE = """<case><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" />
<hswl value="0" auto="true" /><gamma value="7" /><speedsystem value="0" auto="true" /><coefsound value="20" />
<speedsound value="0" auto="true" /><coefh value="1.2" /><cflnumber value="0.2" /></constantsdef>
<mkconfig boundcount="240" fluidcount="9" /><geometry><definition dp="0.1"><pointmin x="0" y="0" z="0" />
<pointmax x="1" y="1" z="1" /></definition><commands><mainlist><setdrawmode mode="full" /><setmkbound mk="0" />{}
</mainlist></commands></geometry></casedef><execution><parameters /></execution></case>"""
BOX = '<drawbox><boxfill>solid</boxfill><point x="0.2" y="0.2" z="0.2" /><size x="0.3" y="0.3" z="0.3" /></drawbox>'
SPHERE = '<drawsphere radius="0.2"><point x="0.5" y="0.5" z="0.5" /></drawsphere>'
CYLINDER = '<drawcylinder radius="0.2"><point x="0.5" y="0.5" z="0.3" /><point x="0.5" y="0.5" z="0.6" /></drawcylinder>'


class CompareFolder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.fake = self.write("gencase", FAKE)
        os.chmod(self.fake, os.stat(self.fake).st_mode | stat.S_IXUSR)

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def run_tool(self, *words):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
            code = compare_folder.main([self.fake, *words, "--fppg", PROGRAM])
        return code, out.getvalue()

    @needs_program
    def test_the_table_says_what_is_the_same_what_differs_and_who_refuses(self):
        for name, draw in (("box", BOX), ("deep/sphere", SPHERE), ("tube", CYLINDER)):
            self.write(f"cases/{name}_Def.xml", CASE.format(draw))
        code, table = self.run_tool(os.path.join(self.folder, "cases"))
        self.assertEqual(code, 1)
        lines = table.splitlines()
        self.assertRegex(lines[1], r"^box_Def.xml +0 +0 +fixed 64 +same +same +same +- +same +")
        self.assertRegex(lines[2], r"^deep/sphere_Def.xml +0 +0 +fixed [0-9]+ +[a-z]")
        self.assertRegex(lines[3], r"^tube_Def.xml +1 +0 +- +- +- +- +- +- +")
        self.assertIn("tube_Def.xml: GenCase: Text: There are no cylinders here.", table)
        self.assertIn("3 definitions: GenCase runs 2, of these fppg runs 2; same particles 1", lines[-1])
        self.assertTrue(lines[-1].endswith("; 1 run in fppg only"), table)

    @needs_program
    def test_a_case_without_particles_is_compared_too(self):
        self.write("nothing_Def.xml", CASE.format(""))
        code, table = self.run_tool(self.folder)
        self.assertEqual(code, 0, table)
        self.assertRegex(table.splitlines()[1], r"^nothing_Def.xml +0 +0 +0 +same +same +same +- +same +")

    @needs_program
    def test_a_list_gives_options_and_json_all_numbers(self):
        self.write("box_Def.xml", CASE.format(BOX))
        listed = self.write("list.txt", "# mine\nbox_Def.xml\t-dp:0.05\n")
        code, text = self.run_tool(listed, "--json")
        row = json.loads(text)[0]
        self.assertEqual((code, row["differs"], row["options"]), (0, False, "-dp:0.05"))
        self.assertEqual(row["fppg"]["particles"], {"fixed": 343})

    @needs_program
    def test_a_list_that_names_no_file_says_which(self):
        listed = self.write("list.txt", "nothere_Def.xml\n")
        with self.assertRaisesRegex(SystemExit, "nothere_Def.xml is no file, expected a definition a line"):
            self.run_tool(listed)

    def test_a_windows_program_asks_for_a_script(self):
        self.fake = self.write("GenCase_win64.exe", "")
        self.write("box_Def.xml", CASE.format(BOX))
        with self.assertRaisesRegex(SystemExit, "can be run, or a script that starts it through Wine"):
            compare_folder.main([self.fake, self.folder, "--fppg", sys.executable])


if __name__ == "__main__":
    unittest.main()
