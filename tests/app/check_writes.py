#!/usr/bin/python3
"""Whatever names a case, a batch or a folder has: nothing is written outside the folder of the output, nothing is run.

    check_writes.py PROGRAM [unittest arguments]

SECURITY.md says what is promised.
"""

import html.parser
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

from sanitized import is_sanitized, times_slower

PROGRAM = sys.argv[1]
CASE = """<case><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /><rhop0 value="1000" />
<hswl value="0" auto="true" /><gamma value="7" /><coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" />
</constantsdef><mkconfig boundcount="240" fluidcount="9" /><geometry><definition dp="0.1">
<pointmin x="-0.5" y="-0.5" z="-0.5" /><pointmax x="1.5" y="1.5" z="1.5" /></definition><commands><mainlist>
<setshapemode>dp | bound</setshapemode><setdrawmode mode="full" /><setmkbound mk="0" {name}/>
<drawbox {objname}><boxfill>bottom | left</boxfill><point x="0" y="0" z="0" /><size x="1" y="1" z="1" /></drawbox>
{draws}</mainlist></commands></geometry>{more}</casedef>
<execution><parameters><parameter key="TimeMax" value="1" /></parameters></execution></case>
"""
STL = """solid a
facet normal 0 0 1
outer loop
vertex 0 0 0.5
vertex 1 0 0.5
vertex 0 1 0.5
endloop
endfacet
endsolid a
"""
# What a name must not do to a shell, a page or a folder.
EVIL = ["x; touch y", "$(touch y)", "`touch y`", "a'b\"c", "<script>alert(1)", "a&b", "-rf",
        "a b", "*", "ü", "~"]


class Writes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="fppg-writes-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        os.makedirs(self.path("case/out"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def write_case(self, file="case/Case_Def.xml", **parts):
        self.write(file, CASE.format(**{**{"name": "", "objname": "", "draws": "", "more": ""}, **parts}))

    def run_it(self, *arguments, cwd="case", **options):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.path(cwd), check=False, timeout=120 * times_slower(PROGRAM), text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
        self.assertIn(done.returncode, (0, 1, 2, 3, 4), done.stdout)
        return done.returncode, done.stdout

    def outside(self):
        """All files and folders but those in a folder for output."""
        found = {}
        for folder, folders, files in os.walk(self.folder):
            folders[:] = [f for f in folders if os.path.join(folder, f) != self.path("case/out")]
            for name in files + folders:
                path = os.path.join(folder, name)
                found[path] = os.lstat(path).st_mtime_ns if name in files else 0
        return found

    def expect_inside(self, *calls, code=None, cwd="case"):
        before = self.outside()
        out = ""
        for call in calls:
            got, out = self.run_it(*call, cwd=cwd)
            if code is not None:
                self.assertEqual(got, code, out)
        self.assertEqual(self.outside(), before, out)
        return out


class OfACase(Writes):
    def test_names_of_shapes_and_nodes_do_not_lead_out(self):
        # The folder that the path begins in comes into being with the copy of a mesh.
        for command in ("shapeout", "cellsout", "pointsmkout"):
            for name in ("x/../../../evil", "../../evil", "x/..", "$x/../../../evil", "..", "../evil"):
                self.write("case/Case_x/a.stl", STL)
                self.write_case(draws=f'<drawfilestl file="Case_x/a.stl" /><{command} file="{name}" />')
                out = self.expect_inside(("Case_Def", "out/Case", "-save:all"), code=3)
                self.assertIn(f'<{command}>: file="{name.lstrip("$")}" leads out of the folder of the result', out)

    def test_names_of_shapes_may_have_dots(self):
        self.write_case(draws='<cellsout file="..a..b" /><pointsmkout file="..." />')
        self.expect_inside(("Case_Def", "out/Case"), code=0)
        self.assertIn("Case_..a..b_MkCells.vtk", os.listdir(self.path("case/out")))

    def test_files_of_all_templates_lie_elsewhere(self):
        """Every file that a template reads is read from outside, and none is copied there or from there."""
        self.assertEqual(self.run_it("templates", ".")[0], 0)
        os.rename(self.path("case/data"), self.path("data"))
        names = sorted(n for n in os.listdir(self.path("case")) if n.endswith("_Def.xml"))
        read = 0
        for name in names:
            with open(self.path("case/" + name), encoding="utf-8") as file:
                text = file.read()
            if '"data/' not in text:
                continue
            for place in ("../data/", self.path("data/"), "./x/../../data/"):
                os.makedirs(self.path("case/x"), exist_ok=True)
                self.write("case/" + name, text.replace('"data/', f'"{place}'))
                self.expect_inside((name[:-4], "out/Case", "-save:all"))
                read += 1
            self.assertFalse(os.path.exists(self.path("case/out/data")), name)
        self.assertGreater(read, 30)

    def test_names_of_bodies_do_not_lead_out(self):
        formats = "vtu,xdmf,csv,pysph,trixi,sphinxsys,sphinxsys-bodies,bgeo,lammps-peri,peridigm,ls-dyna,radioss"
        for given in ('"../../evil"', '"/tmp/fppg-evil"', '"a&#10;b"'):
            for attribute in ({"name": f"name={given} "}, {"objname": f"objname={given} "}):
                self.write_case(**attribute)
                self.expect_inside(("Case_Def", "out/Case", "-to:" + formats), code=0)
                self.assertFalse(os.path.exists("/tmp/fppg-evil.vtu"))

    def test_links_in_the_folder_of_the_output_are_replaced_not_followed(self):
        self.write_case()
        self.write("keys", "secret")
        for name in ("Case.xml", "Case.bi4", "Case.out", "Case_All.vtk", "Case_All_r00.vtk", "Case_MkCells_r02.vtk"):
            os.symlink("../../keys", self.path("case/out/" + name))
        self.expect_inside(("Case_Def", "out/Case", "-save:all", "-save3vtk:1"), code=0)
        with open(self.path("keys"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "secret")

    def test_entities_do_not_grow(self):
        entities = "".join(f'<!ENTITY l{i} "' + f"&l{i - 1};" * 10 + '">' for i in range(1, 12))
        definition = f'<!DOCTYPE case [<!ENTITY l0 "lol"><!ENTITY f SYSTEM "file:///etc/passwd">{entities}]>'
        limit = {} if is_sanitized(PROGRAM) else {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_AS, (500_000_000, 500_000_000))}
        for text in ("&l11;", "&f;"):
            self.write_case(name=f'name="{text}" ', more=f"<properties><property name='a' b='{text}'/></properties>")
            with open(self.path("case/Case_Def.xml"), encoding="utf-8") as file:
                case = file.read()
            for head in (definition, '<?xml version="1.0"?>' + definition):
                self.write("case/Case_Def.xml", head + case)
                begin = time.monotonic()
                code, out = self.run_it("Case_Def", "out/Case", "-threads:1", **limit)
                self.assertIn(code, (0, 3), out)
                self.assertLess(time.monotonic() - begin, 5 * times_slower(PROGRAM))
                if code == 0:
                    with open(self.path("case/out/Case.xml"), encoding="utf-8") as file:
                        made = file.read()
                    self.assertLess(len(made), 20000)
                    self.assertNotIn("root:", made)


class OfABatch(Writes):
    def test_names_of_cases_do_not_lead_out(self):
        for name in ("..", "."):
            self.write_case(f"case/cases/{name}_Def.xml")
            self.write("case/list.txt", f"cases/{name}_Def.xml\n")
            for source in ("cases", "list.txt", f"cases/{name}_Def.xml"):
                out = self.expect_inside(("batch", source, "--out", "out", "--no-pictures"), code=3)
                self.assertIn(f"a case cannot be called '{name}'", out)
            os.remove(self.path(f"case/cases/{name}_Def.xml"))

    def test_lists_name_cases_anywhere_and_results_stay(self):
        self.write_case("elsewhere/Case_Def.xml")
        self.write("case/list.txt", "../elsewhere/Case_Def\n" + self.path("elsewhere/Case_Def.xml\n"))
        self.expect_inside(("batch", "list.txt", "--out", "out"), code=0)
        self.assertEqual(sorted(n for n in os.listdir(self.path("case/out")) if n.startswith("Case")),
                         ["Case", "Case_2"])

    def test_values_do_not_lead_out(self):
        self.write_case("case/cases/Case_Def.xml")
        self.expect_inside(("batch", "cases", "--out", "out", "--set", "A=../../x,/tmp/x,..", "--no-pictures"))


class Page(html.parser.HTMLParser):
    """Names of all elements of a page, and what an attribute makes a browser do."""

    def __init__(self, text):
        super().__init__()
        self.scripts = 0
        self.handlers = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.scripts += tag == "script"
        self.handlers += [name for name, _ in attributes if name.startswith("on")]


class Quoting(Writes):
    def names(self):
        return EVIL + ["x\ttab", 'q"><img src=x onerror=alert(1)>']

    def test_of_names_in_runs_and_reports(self):
        for name in self.names():
            if name == "*":
                continue  # as an output it stands for the name of the definition
            self.write_case(f"case/{name}_Def.xml", name='name="&lt;/script>&lt;img onerror=x>" ',
                            draws='<setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0.3" y="0.3" '
                                  'z="0.3" /><size x="0.4" y="0.4" z="0.4" /></drawbox>')
            definition = f"./{name}_Def"
            before = self.outside()
            self.assertEqual(self.run_it(definition, f"out/{name}", "-save:all")[0], 0, name)
            for page in (("report", f"out/{name}", "-o", "out/page.html"),
                         ("compare", f"out/{name}", f"out/{name}", "--html", "out/page.html")):
                code, out = self.run_it(*page)
                self.assertEqual(code, 0, out)
                with open(self.path("case/out/page.html"), encoding="utf-8") as file:
                    read = Page(file.read())
                self.assertEqual(read.handlers, [], name)
                self.assertLessEqual(read.scripts, 2, name)
            self.assertEqual(self.outside(), before, name)

    def write_odd_batch(self, folder):
        for name in self.names():
            self.write_case(f"case/{folder}/{name}_Def.xml")

    def expect_all_done(self, out):
        self.assertEqual(sorted(os.listdir(out)), sorted(set(os.listdir(out)) - {"y"}))
        for name in self.names():
            name = name.replace("*", "_")
            self.assertTrue(os.path.isfile(os.path.join(out, name, name + ".bi4")), name)
        with open(os.path.join(out, "report.html"), encoding="utf-8") as file:
            read = Page(file.read())
        self.assertEqual(read.handlers, [])
        self.assertLessEqual(read.scripts, 2)

    def test_of_names_in_lines_for_gnu_parallel(self):
        odd = "it's; touch y $(touch y)"
        self.write_odd_batch(odd)
        before = self.outside()
        done = subprocess.run([PROGRAM, "batch", odd, "--out", "out/" + odd, "--plan", "parallel", "--quiet"],
                              cwd=self.path("case"), check=True, stdout=subprocess.PIPE, text=True)
        self.assertEqual(len(done.stdout.splitlines()), len(self.names()))
        for line in done.stdout.splitlines():
            ended = subprocess.run(["/bin/sh", "-c", line], cwd=self.path("case"), check=False,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.assertEqual(ended.returncode, 0, ended.stdout)
        self.assertEqual(self.run_it("batch", "--summary", "out/" + odd)[0], 0)
        self.expect_all_done(self.path("case/out/" + odd))
        self.assertEqual(self.outside(), before)

    def test_of_names_in_scripts_for_slurm(self):
        odd = "it's; touch y $(touch y) 100%j"
        self.write_odd_batch(odd)
        self.write("bin/sbatch", '#!/bin/sh\nfor script; do :; done\n'
                   "tasks=$(sed -n 's/^#SBATCH --array=1-\\([0-9]*\\).*/\\1/p' \"$script\")\n"
                   'for i in $(seq ${tasks:-1}); do SLURM_ARRAY_TASK_ID=$i sh "$script" >&2; done\necho 17\n')
        os.chmod(self.path("bin/sbatch"), 0o755)
        before = self.outside()
        code, out = self.run_it("batch", odd, "--out", "out/" + odd, "--slurm", "--submit",
                                env={**os.environ, "PATH": self.path("bin") + ":" + os.environ["PATH"]})
        self.assertEqual(code, 0, out)
        self.expect_all_done(self.path("case/out/" + odd))
        self.assertEqual(self.outside(), before)
        with open(self.path(f"case/out/{odd}/batch.sbatch"), encoding="utf-8") as file:
            log = re.search(r"\n#SBATCH --output=(.*)\n", file.read()).group(1)
        self.assertTrue(log.endswith("100%%j/slurm/task_%a.log'"), log)

    def test_of_line_breaks_is_not_possible_in_scripts(self):
        self.write_case("case/cases/Case_Def.xml")
        for how in (("--slurm",), ("--plan", "parallel")):
            code, out = self.run_it("batch", "cases", "--out", "out/a\ntouch y", *how)
            self.assertEqual(code, 2, out)
            self.assertIn("has a line break in its name", out)
            self.assertNotIn("batch.sbatch", os.listdir(self.path("case/out/a\ntouch y")))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
