import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tools"))
import check_type_names  # noqa: E402 (found by the path above)

SPAN = "namespace fppg\n{\n\nstruct Span\n{\n    struct Inner\n    {\n    };\n};\n\n} // namespace fppg\n"
UNNAMED = "namespace fppg\n{\nnamespace\n{\n\nstruct Span\n{\n};\n\n} // namespace\n} // namespace fppg\n"


def run(**texts):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in texts.items():
            pathlib.Path(folder, name.replace("_", ".")).write_text(text, encoding="utf-8")
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            code = check_type_names.main([folder])
        return code, said.getvalue()


class CheckTypeNames(unittest.TestCase):
    def test_one_definition_is_right_beside_declarations_and_unnamed_namespaces(self):
        self.assertEqual(run(a_h=SPAN, b_h="struct Span;\nenum class Way : int;\n", c_cpp=UNNAMED)[0], 0)

    def test_two_definitions_are_named_with_their_places(self):
        code, said = run(a_h=SPAN, b_cpp=SPAN.replace("struct Span", "class Span final : public Inner"))
        self.assertEqual(code, 1)
        self.assertRegex(said, r"Span is defined in .*a\.h:4 and .*b\.cpp:4")

    def test_a_folder_without_source_is_a_fault(self):
        self.assertEqual(run()[0], 1)


if __name__ == "__main__":
    unittest.main()
