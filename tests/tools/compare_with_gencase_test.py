import contextlib
import io
import os
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tools", "compare-with-gencase"))
import case_grammar  # noqa: E402 (found by the path above)
import case_reducer  # noqa: E402
import case_runs  # noqa: E402
import compare_with_gencase  # noqa: E402
import numpy as np  # noqa: E402
import rounding_ties  # noqa: E402

PROGRAM = os.environ.get("FPPG_PROGRAM")
needs_program = unittest.skipUnless(PROGRAM, "FPPG_PROGRAM names no program")

# A program that loses the spheres of a case, else our own.
FAKE = f"""#!{sys.executable}
import re, subprocess, sys
text = open(sys.argv[1] + ".xml").read()
open("Fake_Def.xml", "w").write(re.sub("<drawsphere.*?</drawsphere>", "", text, flags=re.S))
sys.exit(subprocess.run([{PROGRAM!r}, "Fake_Def", *sys.argv[2:]], stdout=subprocess.DEVNULL).returncode)
"""


def commands_of(case):
    return [e.tag for e in case.root.find(".//mainlist")]


class CompareWithGenCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def test_the_same_number_gives_the_same_case(self):
        for index in range(5):
            first, again = (case_grammar.random_case(3, index) for _ in range(2))
            self.assertEqual((first.text(), first.files), (again.text(), again.files))
        self.assertNotEqual(first.text(), case_grammar.random_case(4, index).text())

    def test_all_commands_come_up(self):
        used = set()
        for index in range(400):
            used |= case_grammar.used_commands(case_grammar.random_case(1, index).root)
        self.assertEqual(set(case_grammar.COMMANDS) - used, set())

    def test_only_some_commands_leave_out_other_draws(self):
        for index in range(20):
            case = case_grammar.random_case(1, index, ("drawsphere", "rotate"))
            used = case_grammar.used_commands(case.root)
            self.assertEqual(used & set(case_grammar.DRAWS), {"drawsphere"})
            self.assertEqual(used & set(case_grammar.CLIPS + case_grammar.FILLS), set())

    @unittest.skipUnless(shutil.which("xmllint"), "no xmllint (package libxml2-utils)")
    def test_cases_are_valid(self):
        paths = []
        for index in range(60):
            folder = os.path.join(self.folder, str(index))
            case_runs.write_case(case_grammar.random_case(1, index), folder)
            paths.append(os.path.join(folder, "Case_Def.xml"))
        run = subprocess.run(["xmllint", "--noout", "--schema", os.path.join(ROOT, "xml-templates", "fppg.xsd"), *paths],
                             check=False, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr[:2000])

    @needs_program
    def test_the_program_takes_the_cases(self):
        for index in range(30):
            folder = os.path.join(self.folder, str(index))
            case = case_grammar.random_case(1, index)
            # What the program says it does not support does not count.
            if "<angles" in case.text():
                continue
            case_runs.write_case(case, folder)
            outcome = case_runs.run_program(PROGRAM, folder, "out", 60)
            self.assertEqual((index, outcome.status, outcome.message), (index, "accepts", ""))

    def test_the_reducer_finds_the_command_that_matters(self):
        case = next(c for c in (case_grammar.random_case(1, i) for i in range(100))
                    if commands_of(c).count("drawsphere") == 1)
        small, runs = case_reducer.reduce_case(case, lambda c: "drawsphere" in commands_of(c))
        self.assertEqual(commands_of(small), ["drawsphere"])
        self.assertEqual(small.root.find(".//drawsphere").attrib, {})
        self.assertLess(runs, 150)

    def test_the_reducer_keeps_to_its_number_of_runs(self):
        case = case_grammar.random_case(1, 0)
        self.assertEqual(case_reducer.reduce_case(case, lambda c: False, 7)[1], 7)

    @needs_program
    def test_a_program_that_loses_spheres_is_found_out(self):
        fake, kept = os.path.join(self.folder, "fake"), os.path.join(self.folder, "kept")
        with open(fake, "w", encoding="utf-8") as file:
            file.write(FAKE)
        os.chmod(fake, os.stat(fake).st_mode | stat.S_IXUSR)
        with contextlib.redirect_stdout(io.StringIO()) as said:
            code = compare_with_gencase.main([fake, "--fppg", PROGRAM, "--cases", "4", "--keep", kept,
                                              "--only", "drawsphere,drawcylinder"])
        self.assertEqual(code, 1)
        self.assertIn("particles: drawsphere", said.getvalue())
        self.assertNotIn("particles: drawcylinder", said.getvalue())
        name = sorted(os.listdir(kept))[0]
        with open(os.path.join(kept, name, "Case_Def.xml"), encoding="utf-8") as file:
            text = file.read()
        self.assertEqual((text.count("<drawsphere"), text.count("<drawcylinder")), (1, 0))
        with open(os.path.join(kept, name, "summary.txt"), encoding="utf-8") as file:
            self.assertIn("only GenCase: 0", file.read())

    def point_case(self, x):
        """A case of one point, and what a program that puts it on its nearest node, upwards at a half, makes of it."""
        case = case_grammar.random_case(1, 0, ("drawpoint",))
        definition = case.root.find(".//definition")
        definition.set("dp", "0.1")
        for axis in "xyz":
            definition.find("pointmin").set(axis, "0")
            definition.find("pointmax").set(axis, "1")

        def run(moved):
            definition = moved.root.find(".//definition")
            dp, low = float(definition.get("dp")), float(definition.find("pointmin").get("x"))
            return self.outcome(low + dp * np.floor((x - low) / dp + 0.5))

        return case, run

    @staticmethod
    def outcome(*places):
        return case_runs.Outcome("accepts", "", ["fluid"] * len(places), np.ones(len(places)),
                                 np.array([[x, 0, 0] for x in places], float).reshape(-1, 3))

    def test_a_point_at_half_a_step_is_a_rounding_tie(self):
        case, run = self.point_case(0.35)
        other = self.outcome(0.7 - run(case).positions[0, 0])
        self.assertTrue(rounding_ties.is_rounding_tie(case, other, run(case), run))
        self.assertFalse(rounding_ties.is_rounding_tie(case, self.outcome(0.5), run(case), run))

    def test_a_point_off_half_a_step_is_no_rounding_tie(self):
        for x in (0.36, 0.3501, 0.4):
            case, run = self.point_case(x)
            self.assertFalse(rounding_ties.is_rounding_tie(case, self.outcome(0.3), run(case), run))

    def test_one_real_difference_beside_a_tie_counts(self):
        case, point = self.point_case(0.35)

        def run(moved):
            return self.outcome(point(moved).positions[0, 0], 0.8)

        tied = 0.7 - run(case).positions[0, 0]
        self.assertTrue(rounding_ties.is_rounding_tie(case, self.outcome(tied, 0.8), run(case), run))
        self.assertFalse(rounding_ties.is_rounding_tie(case, self.outcome(tied, 0.9), run(case), run))
        self.assertFalse(rounding_ties.is_rounding_tie(case, self.outcome(tied), run(case), run))

    def test_another_order_is_a_tie_where_it_turns(self):
        case, point = self.point_case(0.35)

        def run(moved):
            places = (0.8, 0.2)
            return self.outcome(*(places if point(moved).positions[0, 0] > 0.37 else reversed(places)))

        def never(_):
            return self.outcome(0.8, 0.2)

        ours = self.outcome(*run(case).positions[::-1, 0])
        self.assertTrue(rounding_ties.is_rounding_tie(case, ours, run(case), run))
        self.assertFalse(rounding_ties.is_rounding_tie(case, self.outcome(0.2, 0.8), never(case), never))

    @needs_program
    def test_two_equal_programs_agree(self):
        with contextlib.redirect_stdout(io.StringIO()) as said:
            code = compare_with_gencase.main([PROGRAM, "--fppg", PROGRAM, "--cases", "6"])
        self.assertEqual((code, "differs:" in said.getvalue()), (0, False))


if __name__ == "__main__":
    unittest.main()
