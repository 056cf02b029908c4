import contextlib
import filecmp
import io
import math
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tools"))
import make_meshes  # noqa: E402 (found by the path above)


class MakeMeshes(unittest.TestCase):
    def test_every_shape_is_closed_and_outward(self):
        for name, shape in make_meshes.SHAPES.items():
            with self.subTest(name):
                shape().check(name)

    def test_a_missing_facet_is_refused(self):
        mesh = make_meshes.box()
        mesh.facets.pop()
        with self.assertRaisesRegex(ValueError, "not shared by exactly two facets"):
            mesh.check("box")

    def test_a_body_inside_out_is_refused(self):
        mesh = make_meshes.Mesh()
        mesh.add(make_meshes.box(), flip=True)
        with self.assertRaisesRegex(ValueError, "normals point inwards"):
            mesh.check("box")

    def test_volumes_are_those_of_the_formulas(self):
        self.assertAlmostEqual(make_meshes.box(2, 3, 4).volume(), 24)
        self.assertAlmostEqual(make_meshes.l_shape(1, 0.4, 0.5).volume(), (1 - 0.6 * 0.6) * 0.5)
        fine = make_meshes.torus(0.5, 0.2, 400, 200).volume()
        self.assertAlmostEqual(fine, 2 * math.pi**2 * 0.5 * 0.2**2, delta=1e-3 * fine)

    def test_a_closed_housing_is_its_walls_only(self):
        inside = make_meshes.extrude(make_meshes.stadium(0.6, 0.45, 0.9, 32), 0, 0.5).volume()
        outside = make_meshes.extrude(make_meshes.stadium(0.66, 0.51, 0.9, 32), 0, 0.62).volume()
        self.assertAlmostEqual(make_meshes.housing().volume(), outside - inside, places=5)

    def test_a_gear_may_have_no_bore_and_few_or_many_teeth(self):
        for teeth in (8, 17, 60):
            for bore in (0, 0.2):
                make_meshes.gear(teeth=teeth, bore=bore).check("gear")

    def test_a_gearbox_case_is_its_walls_less_the_bores(self):
        narrow, wide = (make_meshes.gearbox_case(bore_a=d, sides=60).volume() for d in (22, 30))
        self.assertAlmostEqual(narrow - wide, 2 * 6 * math.pi * (15**2 - 11**2), delta=5)

    def test_backlash_takes_half_of_itself_off_a_tooth(self):
        def thickness(backlash):
            outline = make_meshes.gear_outline(3, 20, 20, backlash)
            return math.dist(outline[3], outline[10])  # next to the pitch circle

        self.assertAlmostEqual(thickness(0) - thickness(0.4), 0.2, delta=0.01)

    def test_the_meshes_of_the_cases_are_the_ones_it_makes(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            make_meshes.main(["--cases", folder])
            for file, _, _ in make_meshes.CASE_MESHES:
                kept = os.path.join(ROOT, "cases", file)
                self.assertTrue(filecmp.cmp(os.path.join(folder, file), kept, shallow=False), file)
                self.assertLess(os.path.getsize(kept), 400000)

    def test_the_meshes_of_the_templates_are_the_ones_it_makes(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            make_meshes.main(["--templates", folder])
            for file, _, _ in make_meshes.TEMPLATE_MESHES:
                kept = os.path.join(ROOT, "xml-templates", "data", file)
                self.assertTrue(filecmp.cmp(os.path.join(folder, file), kept, shallow=False), file)
                self.assertLess(os.path.getsize(kept), 20000)

    def test_an_unknown_parameter_is_named(self):
        script = os.path.join(ROOT, "tools", "make_meshes.py")
        run = subprocess.run([sys.executable, script, "gear", "gear.stl", "tooth=3"],
                             capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 1)
        self.assertIn("tooth=3: expected name=value with one of module, teeth", run.stderr)


if __name__ == "__main__":
    unittest.main()
