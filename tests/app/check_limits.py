#!/usr/bin/python3
"""What is too large, endless or in other units is refused at once, with what would do; what only looks so is made.

    check_limits.py PROGRAM [unittest arguments]
"""

import os
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from sanitized import is_sanitized, times_slower

PROGRAM = sys.argv[1]
SLOWER = times_slower(PROGRAM)
# It takes some hundredths of a second; other tests run at the same time.
AT_ONCE = 5
CASE = """<case><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" />
<hswl value="0" auto="true" /><gamma value="7" /><coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" />
</constantsdef><mkconfig boundcount="240" fluidcount="9" /><geometry><definition dp="{dp}">
<pointmin x="-0.5" y="{ymin}" z="-0.5" /><pointmax x="1.5" y="{ymax}" z="1.5" /></definition><commands>{lists}<mainlist>
<setdrawmode mode="full" />{draws}</mainlist></commands></geometry>{fit}</casedef>
<execution><parameters><parameter key="TimeMax" value="1" /></parameters></execution></case>
"""
BOX = '<drawbox><boxfill>{}</boxfill><point x="0" y="0" z="0" /><size x="1" y="1" z="{}" /></drawbox>'
SOLID = '<setmkfluid mk="0" />' + BOX.format("solid", 1)
WALLS = '<setmkbound mk="0" />' + BOX.format("bottom | left | right | front | back", 1)
SPHERE = '<setmkbound mk="0" /><drawsphere radius="0.4"><point x="0.5" y="0.5" z="0.5" /></drawsphere>'
FORMAT = "the file format holds at most 4,294,967,294"


def box_stl(size, low):
    """A closed cube as binary STL."""
    corners = [[low + size * (c >> axis & 1) for axis in range(3)] for c in range(8)]
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2),
             (2, 4, 6), (1, 3, 5), (3, 7, 5)]
    out = bytes(80) + struct.pack("<I", len(faces))
    for face in faces:
        out += struct.pack("<12f", 0, 0, 0, *(x for c in face for x in corners[c])) + bytes(2)
    return out


class Limits(unittest.TestCase):
    """Without a .bi4 the disk of the tests is no limit."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="fppg-limits-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write_case(self, draws, dp="0.1", lists="", fit="", ymin="-0.5", ymax="1.5"):
        with open(self.path("Case_Def.xml"), "w", encoding="utf-8") as file:
            file.write(CASE.format(draws=draws, dp=dp, lists=lists, fit=fit, ymin=ymin, ymax=ymax))

    def run_it(self, *arguments, limit=AT_ONCE, memory=resource.RLIM_INFINITY):
        begin = time.monotonic()
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, check=False, timeout=120 * SLOWER, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (memory, memory)))
        self.assertLess(time.monotonic() - begin, limit * SLOWER, arguments)
        return done.returncode, done.stdout

    def expect_refused(self, code, *texts, calls=None):
        for call in calls or (("Case_Def", "out/Case", "-save:-bi"), ("Case_Def", "out/Case", "-fit", "-save:-bi"),
                              ("estimate", "Case_Def")):
            got, out = self.run_it(*call)
            self.assertEqual(got, code, out)
            for text in texts:
                self.assertIn(text, out)
        if os.path.exists(self.path("out")):
            self.assertEqual([n for n in os.listdir(self.path("out")) if n != "Case.out"], [])


class TooMany(Limits):
    def expect_dp(self, draws, dp, **more):
        """The dp that the message names has to fit, and not by much."""
        self.write_case(draws, dp, **more)
        _, out = self.run_it("Case_Def", "out/Case", "-save:-bi")
        named = re.search(r"; dp=(\S+) and larger ones fit", out).group(1)
        _, out = self.run_it("estimate", "Case_Def", "-dp:" + named, limit=60)
        count = int(re.search(r"Particles +([\d,]+)", out).group(1).replace(",", ""))
        self.assertTrue(2e9 < count < 4294967295, count)

    def test_in_a_box_of_ten_to_the_twelfth(self):
        self.write_case(SOLID, "1e-4")
        self.expect_refused(3, "about 1e+12 particles with dp=0.0001", FORMAT, "; dp=0.00063 and larger ones fit")

    def test_in_a_box_of_eight_thousand_million(self):
        self.write_case(SOLID, "5e-4")
        self.expect_refused(3, "about 8e+09 particles", FORMAT)
        self.expect_dp(SOLID, "5e-4")

    def test_in_a_sphere_of_fine_dp(self):
        self.write_case(SPHERE, "1e-5")
        self.expect_refused(3, "e+14 particles with dp=1e-05", FORMAT)
        self.expect_dp(SPHERE, "2e-4")

    def test_on_walls(self):
        self.write_case(WALLS, "2e-5")
        self.expect_refused(3, FORMAT, calls=[("Case_Def", "out/Case", "-save:-bi"), ("estimate", "Case_Def")])

    def test_in_a_plane(self):
        self.write_case(SOLID, "1e-5", ymin="0", ymax="0")
        self.expect_refused(3, "about 1e+10 particles", FORMAT,
                            calls=[("Case_Def", "out/Case", "-save:-bi"), ("estimate", "Case_Def")])

    def test_nodes_of_a_grid_of_heights(self):
        with open(self.path("ground.xyz"), "w", encoding="utf-8") as file:
            file.writelines(f"{x} {y} 0.3\n" for x in (0, 0.5, 1) for y in (0, 0.5, 1))
        draw = ('<setmkbound mk="0" /><drawbathymetry><zpoints file="ground.xyz" /><grid dp="0.1"><initdomain>'
                '<point x="0" y="0" /><size x="0.8" y="{}" /></initdomain></grid></drawbathymetry>')
        self.write_case(draw.format(65536))
        call = ("Case_Def", "out/Case", "-save:-bi", "-threads:1")
        if not is_sanitized(PROGRAM):
            code, out = self.run_it(*call, memory=2_000_000_000)
            self.assertEqual(code, 3, out)
            self.assertIn("e+06 nodes and needs about 2.62 GB of memory, 1.", out)
        self.write_case(draw.format(1e7))
        code, out = self.run_it(*call)
        self.assertEqual(code, 3, out)
        self.assertIn("has more than 1e+08 nodes", out)

    def test_nodes_along_an_axis(self):
        for dp in ("1e-9", "1e-12"):
            self.write_case(SOLID, dp)
            self.expect_refused(3, "the domain has ", " and larger ones fit")

    def test_nodes_with_few_particles_are_no_reason(self):
        small = '<setmkbound mk="0" /><drawsphere radius="0.01"><point x="0.5" y="0.5" z="0.5" /></drawsphere>'
        voided = SOLID + "<setmkvoid />" + BOX.format("solid", 0.9)
        for draws, dp, expected in ((WALLS, "1e-3", 5002001), (small, "4e-4", None), (voided, "8e-4", None)):
            self.write_case(draws, dp)
            code, out = self.run_it("Case_Def", "out/Case", "-save:-bi", limit=60)
            self.assertEqual(code, 0, out)
            if expected:
                self.assertIn(f"Total particles: {expected:,} ", out)


class Memory(Limits):
    """-memory ends a run that would take more, and changes no particle of one that fits."""

    SPHERE = ('<setdrawmode mode="face" /><setmkbound mk="0" /><drawsphere radius="0.5"><point x="0.5" y="0.5" z="0.5" />'
              "</drawsphere>")

    def make(self, *options):
        code, out = self.run_it("Case_Def", "out/Case", "-fit", "-save:-vtkcells", *options, limit=60)
        with open(self.path("out/Case.bi4"), "rb") as file:
            return code, out, file.read()

    @unittest.skipIf(is_sanitized(PROGRAM), "sanitizers reserve memory of their own")
    def test_of_a_run_is_held(self):
        self.write_case(self.SPHERE, "0.008")
        code, out, before = self.make()
        self.assertEqual(code, 0, out)
        for threads in ("1", "2"):
            code, out, after = self.make("-memory:0.2", "-threads:" + threads)
            self.assertEqual(code, 0, out)
            self.assertTrue(after == before)
        self.write_case(self.SPHERE, "0.002")
        for threads in ("1", "2"):
            code, out, after = self.make("-memory:0.2", "-threads:" + threads)
            self.assertEqual(code, 4, out)
            self.assertIn("this case needs more than the 0.2 GB that -memory allows", out)
            self.assertTrue(after == before)

    @unittest.skipIf(is_sanitized(PROGRAM), "sanitizers reserve memory of their own")
    def test_is_looked_at_before_the_work(self):
        self.write_case(self.SPHERE, "0.0005")
        code, out = self.run_it("Case_Def", "out/Case", "-fit", "-save:-bi", "-memory:0.2")
        self.assertEqual(code, 3, out)
        self.assertRegex(out, r"need 1\.3e\+07 particles with dp=0\.0005; this machine has 0\.\d+ GB of memory free")

    def test_has_to_be_a_number(self):
        for value in ("0", "-1", "nan", "2GB"):
            code, out = self.run_it("Case_Def", "out/Case", "-memory:" + value)
            self.assertEqual(code, 2, out)
            self.assertIn("-memory: ", out)


class SmallDisk(Limits):
    SIZE = 1 << 21

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("mount"), "only root can mount a small disk")
    def test_is_told_before_the_case_is_drawn_and_names_the_dp_that_fits(self):
        disk = self.path("disk")
        os.mkdir(disk)
        if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={self.SIZE}", "tmpfs", disk], check=False).returncode:
            self.skipTest("this system mounts no tmpfs")
        try:
            for dp, begin in (("0.001", "the case would have about 1e+09 particles"), ("0.02", "the case has 132651 ")):
                self.write_case(SOLID, dp)
                code, out = self.run_it("Case_Def", "disk/Case")
                self.assertEqual(code, 4, out)
                self.assertIn(begin, out)
                self.assertRegex(out, r"the disk of disk has room for about 4\.\de\+04 \(0\.0020\d GB\)")
                self.assertEqual(os.path.exists(self.path("disk/Case.bi4")), False)
                named = re.search(r"; dp=([0-9.]+)", out).group(1)
                code, out = self.run_it("Case_Def", "disk/Case", "-dp:" + named)
                self.assertEqual(code, 0, out)
                self.assertGreater(os.path.getsize(self.path("disk/Case.bi4")), self.SIZE / 5)
                os.remove(self.path("disk/Case.bi4"))
            code, out = self.run_it("Case_Def", "disk/Case", "-dp:0.02", "-save:-bi")
            self.assertEqual(code, 0, out)
        finally:
            subprocess.run(["umount", disk], check=True)


class Endless(Limits):
    def test_lists_are_counted_before_they_run(self):
        lists = "".join(f'<list name="l{i}">' + f'<runlist name="l{i + 1}" />' * 10 + "</list>" for i in range(11))
        lists += '<list name="l11"><drawpoint x="0" y="0" z="0" /></list>'
        self.write_case('<setmkbound mk="0" /><runlist name="l0" />', lists=lists)
        self.expect_refused(3, "<runlist>: ", "commands or more would be run, expected at most 10000000")

    def test_lists_that_repeat_one_another(self):
        lists = "".join(f'<list name="l{i}"><runlist name="l{i + 1}" times="10000" /></list>' for i in range(3))
        lists += '<list name="l3"><drawpoint x="0" y="0" z="0" /></list>'
        self.write_case('<setmkbound mk="0" /><runlist name="l0" />', lists=lists)
        self.expect_refused(3, "e+12 commands or more would be run")

    def test_lists_that_run_under_a_condition_are_run(self):
        lists = '<list name="a"><runlist name="b" if="#1==2" times="1000000000" /></list>'
        lists += '<list name="b"><drawpoint x="0" y="0" z="0" /></list>'
        self.write_case('<setmkbound mk="0" /><runlist name="a" />' + WALLS, lists=lists)
        code, out = self.run_it("Case_Def", "out/Case")
        self.assertEqual(code, 0, out)

    def test_devices_and_pipes_as_definition(self):
        os.mkfifo(self.path("Case_Def.xml"))
        text = "Case_Def.xml: is a pipe, expected a regular file"
        self.expect_refused(4, text)
        self.expect_refused(4, text, calls=[("upgrade", "Case_Def.xml"), ("Case_Def", "out/Case", "-clean")])

    def test_devices_and_pipes_as_meshes(self):
        os.mkfifo(self.path("mesh.stl"))
        os.symlink("/dev/zero", self.path("zero.stl"))
        for name, what in (("mesh.stl", "a pipe"), ("zero.stl", "a device"), ("/dev/zero", "a device")):
            self.write_case(f'<setmkbound mk="0" /><drawfilestl file="{name}" />')
            self.expect_refused(4, f"{name}: is {what}, expected a regular file")
            code, out = self.run_it("inspect", name)
            self.assertEqual(code, 4, out)
            self.assertIn(f"is {what}", out)

    def test_devices_and_pipes_as_data(self):
        """Every file that a template of the language reads."""
        self.assertEqual(self.run_it("templates", ".")[0], 0)
        read = 0
        for name in sorted(n for n in os.listdir(self.folder) if n.endswith("_Def.xml")):
            with open(self.path(name), encoding="utf-8") as file:
                used = set(re.findall(r'"(data/[^"]+)"', file.read()))
            for data in sorted(used):
                if not os.path.isfile(self.path(data)):
                    continue
                os.rename(self.path(data), self.path("kept"))
                os.mkfifo(self.path(data))
                code, out = self.run_it(name[:-4], "out/Case", limit=30)
                os.rename(self.path("kept"), self.path(data))
                if code != 0:
                    self.assertIn("is a pipe, expected a regular file", out, (name, data))
                    read += 1
        self.assertGreater(read, 10)

    def test_devices_and_pipes_as_results(self):
        self.write_case(WALLS)
        self.assertEqual(self.run_it("Case_Def", "out/Case")[0], 0)
        for ending in (".xml", ".bi4"):
            os.mkfifo(self.path("Other" + ending))
        for call in (("compare", "Other.bi4", "out/Case"), ("render", "Other.bi4", "-o", "p.png"),
                     ("report", "Other.bi4", "-o", "p.html")):
            self.assertNotIn(self.run_it(*call)[0], (0, 1))

    def test_devices_stay_what_they_are_when_they_are_named_as_output(self):
        self.write_case(WALLS)
        self.assertEqual(self.run_it("Case_Def", "out/Case")[0], 0)
        os.mkfifo(self.path("pipe.png"))
        os.symlink("/dev/null", self.path("null.png"))
        for name in ("pipe.png", "null.png"):
            code, out = self.run_it("render", "out/Case", "-o", name, limit=60)
            self.assertEqual(code, 4, out)
            self.assertIn(", expected a regular file", out)
            self.assertFalse(os.path.isfile(self.path(name)))


class Units(Limits):
    def setUp(self):
        super().setUp()
        for name, size, low in (("mm.stl", 300, -20), ("m.stl", 0.6, 0.2)):
            with open(self.path(name), "wb") as file:
                file.write(box_stl(size, low))

    FILE = '<setmkbound mk="0" /><drawfilestl file="{}" {}/>'
    HINT = '; if the file is in other units (mm), <drawscale x="0.001" y="0.001" z="0.001" /> turns them into metres'
    LAID_WHOLE = '<fppg><bodyfitted mkbound="0" place="inside" /></fppg>'
    FILL = '<fppg><fill mkfluid="0" seed="0.5,0.5,0.5" level="0.5" /></fppg>'

    def test_of_a_fitted_mesh_are_judged_before_it_is_laid(self):
        self.write_case(self.FILE.format("mm.stl", 'autofill="true" '), "0.01")
        self.expect_refused(3, "mm.stl is 300 m wide in a domain of 2 m", self.HINT,
                            calls=[("Case_Def", "out/Case", "-fit"), ("Case_Def", "out/Case", "-fit:raw"),
                                   ("estimate", "Case_Def", "-fit")])
        code, out = self.run_it("Case_Def", "out/Case")
        self.assertEqual(code, 0, out)
        self.assertIn("*** WARNING", out)
        self.assertIn(self.HINT, out)

    def test_are_named_where_a_fill_would_fail(self):
        self.write_case(self.FILE.format("mm.stl", ""), "0.05", fit=self.FILL)
        self.expect_refused(3, "mm.stl is 300 m wide", self.HINT)

    def test_are_named_where_a_fill_fails(self):
        """Less than 100 times as large as the domain, so it may be meant."""
        draw = '<setmkbound mk="0" /><drawfilestl file="mm.stl"><drawscale x="0.5" y="0.5" z="0.5" /></drawfilestl>'
        self.write_case(draw + SOLID, "0.05", fit=self.FILL)
        self.expect_refused(3, "is not on an empty node", "mm.stl is 150 m wide", self.HINT,
                            calls=[("Case_Def", "out/Case"), ("estimate", "Case_Def")])

    def test_of_metres_are_made(self):
        self.write_case(self.FILE.format("m.stl", ""), "0.05", fit=self.FILL)
        for fit in ("-fit:off", "-fit"):
            code, out = self.run_it("Case_Def", "out/Case", fit, limit=60)
            self.assertEqual(code, 0, out)

    def test_a_surface_of_too_many_particles_names_the_dp_that_fits(self):
        self.write_case('<setmkbound mk="0" /><drawfilestl file="mm.stl"><drawscale x="0.6" y="0.6" z="0.6" />'
                        "</drawfilestl>", "0.005", fit=self.LAID_WHOLE)
        self.expect_refused(3, "mm.stl has a surface of ", FORMAT, " and larger ones fit",
                            calls=[("Case_Def", "out/Case", "-fit")])

    def test_surfaces_of_shapes_are_judged_too(self):
        place = '<point x="-500" y="-500" z="-500" />'
        for draw in ('<drawbox><boxfill>all</boxfill>' + place + '<size x="1000" y="1000" z="1000" /></drawbox>',
                     '<drawtriangle>' + place + '<point x="500" y="-500" z="0" /><point x="0" y="500" z="9" />'
                     '</drawtriangle>'):
            self.write_case('<setmkbound mk="0" />' + draw, "0.005", fit=self.LAID_WHOLE)
            self.expect_refused(3, "it has a surface of ", FORMAT, " and larger ones fit",
                                calls=[("Case_Def", "out/Case", "-fit")])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
