import os
import pathlib
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tools"))
import check_sizes  # noqa: E402 (found by the path above)

SMALL = """// { a brace in a comment
struct Pair
{
    explicit Pair(int a, int b) : first{a}, second{b}
    {
        if (a > b) first = b;
    }
    int first = 0;
    int second = 0;
};
"""


def faults_of(text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "a.cpp"
        path.write_text(text)
        return check_sizes.faults_in([pathlib.Path(folder)])


def function(head, lines=1, deep=0, comment=""):
    loops = "".join("for (;;)\n{\n" for _ in range(deep))
    return f"{head}\n{{\n{comment}{loops}{'call();' * (lines > 0)}\n" + "call();\n" * (lines - 1) + "}\n" * deep + "}\n"


class CheckSizes(unittest.TestCase):
    def test_small_code_has_no_faults(self):
        self.assertEqual(faults_of(SMALL + function("int f(int a, std::map<int, int> b)")), [])

    def test_names_long_functions_and_files(self):
        self.assertEqual(faults_of(function("void g()", 77)), [])
        self.assertIn("g: 81 lines, expected at most 80", faults_of(function("void g()", 78))[0])
        self.assertIn("601 lines of a file", faults_of("//\n" * 601)[0])

    def test_names_functions_with_many_parameters(self):
        self.assertEqual(faults_of(function("void h(int a, int b, int c, int d, int e, int f)")), [])
        self.assertIn("h: 7 parameters", faults_of(function("void h(int a, int b, int c, int d, int e, int f, int g)"))[0])

    def test_names_deep_functions_that_do_not_say_why(self):
        self.assertEqual(faults_of(function("void d()", deep=4)), [])
        self.assertIn("d: 5 nested blocks", faults_of(function("void d()", deep=5))[0])
        self.assertEqual(faults_of(function("void d()", deep=5, comment="// Nested because of axes.\n")), [])


if __name__ == "__main__":
    unittest.main()
