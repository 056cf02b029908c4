"""The Python module fppg, against the program (FPPG_PROGRAM)."""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
import fppg  # noqa: E402
from particle_files import read_bi4  # noqa: E402

DEFINITION = """<?xml version="1.0" encoding="UTF-8" ?>
<case><casedef><constantsdef>
<gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" /><hswl value="0" auto="true" /><gamma value="7" />
<coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" /></constantsdef>
<mkconfig boundcount="240" fluidcount="9" />
<geometry><predefinition><newvarcte size="0.5" /></predefinition>
<definition dp="0.05"><pointmin x="-0.5" y="-0.5" z="-0.5" /><pointmax x="1.5" y="1.5" z="1.5" /></definition>
<commands><mainlist><setdrawmode mode="full" />
<setmkbound mk="0" /><drawbox objname="block"><boxfill>solid</boxfill><point x="0" y="0" z="0" />
<size x="#size" y="0.5" z="0.33" /></drawbox>
<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0.6" /><size x="0.4" y="0.4" z="0.4" /></drawbox>
</mainlist></commands></geometry></casedef>
<execution><parameters><parameter key="TimeMax" value="1" /></parameters></execution></case>
"""


def cube():
    """Vertices and outward triangles of the cube from 0 to 1."""
    vertices = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return vertices, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


class Module(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.definition = self.path("Case_Def.xml")
        with open(self.definition, "w", encoding="utf-8") as file:
            file.write(DEFINITION)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_program(self, *options):
        subprocess.run([os.environ["FPPG_PROGRAM"], "Case_Def", "run/Case", "-save:-all,bi", *options],
                       cwd=self.folder.name, check=True, stdout=subprocess.DEVNULL)
        return read_bi4(self.path("run/Case.bi4"))[1]

    def test_arrays_and_files_are_those_of_the_program(self):
        for fit, option in ((True, "-fit"), (None, "-fit:off"), ("raw", "-fit:raw")):
            wanted = self.run_program(option)
            result = fppg.generate(self.definition, fit=fit)
            self.assertEqual(len(result), len(wanted["Idp"]))
            np.testing.assert_array_equal(result.positions, wanted["Posd"])
            np.testing.assert_array_equal(result.densities, wanted["Rhop"])
            np.testing.assert_array_equal(result.velocities, wanted["Vel"])
            np.testing.assert_array_equal(result.ids, wanted["Idp"])
            files = result.save(self.path("saved/Case"), to=["vtu"])
            self.assertIn(self.path("saved/Case.vtu"), files)
            with open(self.path("saved/Case.bi4"), "rb") as saved, open(self.path("run/Case.bi4"), "rb") as run:
                self.assertEqual(saved.read(), run.read())
            self.assertTrue(os.path.isfile(self.path("saved/Case.xml")))

    def test_values_in_place_of_the_definition_count(self):
        case = fppg.read(self.definition, dp=0.1, vars={"size": 0.7})
        self.assertEqual((case.dp, case.is_2d), (0.1, False))
        result = fppg.generate(case)
        block = result.positions[result.mk == 10]
        self.assertAlmostEqual(block[:, 0].max(), 0.7)
        self.assertEqual(result.bodies, [fppg.Body("block", 10, "fixed"), fppg.Body("fluid0", 1, "fluid")])
        self.assertAlmostEqual(result.masses.sum(), len(result) * 1000 * 0.1 ** 3)

    def test_fitted_walls_have_kinds_normals_and_volumes(self):
        result = fppg.generate(self.definition, fit=True)
        block = result.mk == 10
        self.assertAlmostEqual(result.volumes[block].sum(), 0.5 * 0.5 * 0.33, places=6)
        self.assertEqual((result.kinds[block] == fppg.KINDS.index("corner")).sum(), 8)
        on_surface = block & (result.kinds != fppg.KINDS.index("volume"))
        np.testing.assert_allclose(np.linalg.norm(result.normals[on_surface], axis=1), 1, atol=1e-6)

    def test_arrays_are_read_only_views_made_once_that_outlive_the_result(self):
        result = fppg.generate(self.definition)
        positions = result.positions
        self.assertFalse(positions.flags.owndata)
        self.assertFalse(positions.flags.writeable)
        self.assertIs(positions, result.positions)
        copy = positions.copy()
        del result
        np.testing.assert_array_equal(positions, copy)

    def test_a_loaded_result_is_the_saved_one(self):
        made = fppg.generate(self.definition, fit=True)
        made.save(self.path("Case"))
        loaded = fppg.load(self.path("Case.bi4"))
        np.testing.assert_array_equal(loaded.positions, made.positions)
        np.testing.assert_array_equal(loaded.mk, made.mk)
        np.testing.assert_array_equal(loaded.types, made.types)
        self.assertIsNone(loaded.kinds)
        self.assertIsNone(loaded.normals)
        self.assertEqual(fppg.compare(self.path("Case"), self.path("Case"))["findings"], [])
        made.convert(self.path("made.csv"))
        files, losses = loaded.convert(self.path("p.csv"))
        self.assertEqual(files, [self.path("p.csv")])
        # Nothing of the other result gets into the file of this one.
        with open(self.path("made.csv"), encoding="utf-8") as of_made, open(files[0], encoding="utf-8") as of_loaded:
            last = [file.read().splitlines()[1].split(",") for file in (of_made, of_loaded)]
        self.assertEqual([line[-1] for line in last], ["corner", ""])
        self.assertEqual(last[1][9:12], ["", "", ""])
        self.assertTrue(any("no volumes" in loss for loss in losses))

    def test_a_mesh_without_a_case_is_fitted(self):
        dp = 0.05
        vertices, triangles = cube()
        fitted = fppg.fit(vertices, triangles, dp)
        self.assertEqual(np.bincount(fitted.kinds)[0], 8)
        self.assertAlmostEqual(fitted.area, 6)
        self.assertAlmostEqual(fitted.volume, 1)
        self.assertAlmostEqual(len(fitted.positions) * dp ** 2 / 6, 1, delta=0.06)
        off = np.minimum(np.abs(fitted.positions), np.abs(fitted.positions - 1)).min(axis=1)
        self.assertLess(off.max(), 1e-12)
        faces = fitted.kinds == fppg.KINDS.index("surface")
        outwards = ((fitted.positions - 0.5) * fitted.normals).sum(axis=1)
        np.testing.assert_allclose(outwards[faces], 0.5, atol=1e-6)

    def test_a_mesh_file_is_inspected(self):
        vertices, triangles = cube()
        with open(self.path("cube.obj"), "w", encoding="utf-8") as file:
            for v in vertices:
                file.write("v {} {} {}\n".format(*v))
            for t in triangles:
                file.write("f {} {} {}\n".format(*(i + 1 for i in t)))
        self.assertEqual(fppg.inspect(self.path("cube.obj"), dp=0.1)["facets"], 12)

    def test_errors_are_exceptions_with_file_and_line(self):
        with open(self.definition, "w", encoding="utf-8") as file:
            file.write(DEFINITION.replace('dp="0.05"', 'dp="abc"'))
        with self.assertRaises(fppg.CaseError) as raised:
            fppg.generate(self.definition)
        self.assertEqual(raised.exception.file, self.definition)
        self.assertEqual(raised.exception.line, 7)
        with self.assertRaises(fppg.IoError):
            fppg.load(self.path("Nothing"))
        with self.assertRaises(fppg.UsageError):
            fppg.generate(self.path("Case_Def.xml"), fit="maybe")
        vertices, triangles = cube()
        with self.assertRaisesRegex(fppg.UsageError, "triangle 0 names the vertex 8, expected 0 to 7"):
            fppg.fit(vertices, [[0, 1, 8]], 0.1)
        with self.assertRaises(fppg.GeometryError):
            fppg.fit(vertices, triangles, -1)

    def test_progress_is_told_and_may_end_the_work(self):
        stages = []
        fppg.generate(self.definition, fit=True, progress=lambda stage, share: stages.append((stage, share)))
        names = [stage for stage, _ in stages]
        self.assertEqual(sorted(set(names), key=names.index)[:3], ["LoadXMLInit", "Draw", "Relax"])
        self.assertTrue(all(0 <= share <= 1 for _, share in stages))

        def stop(stage, share):
            if stage == "Relax" and share > 0:
                raise LookupError("enough")
        with self.assertRaisesRegex(LookupError, "enough"):
            fppg.generate(self.definition, fit=True, progress=stop)

    def test_other_threads_run_and_ctrl_c_ends_the_work(self):
        counted = []
        timer = threading.Timer(0.5, lambda: (counted.append(1), os.kill(os.getpid(), signal.SIGINT)))
        begin = time.monotonic()
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while time.monotonic() - begin < 60:
                fppg.generate(fppg.read(self.definition, dp=0.012), fit=True)
        self.assertEqual(counted, [1])


if __name__ == "__main__":
    unittest.main()
