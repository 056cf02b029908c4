"""The ladder of tools/bench runs and writes what it says."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.environ.get("FPPG_PROGRAM")


@unittest.skipUnless(PROGRAM, "FPPG_PROGRAM names no program")
class RunBench(unittest.TestCase):
    def run_ladder(self, folder, *arguments):
        return subprocess.run(
            [sys.executable, "-B", os.path.join(REPOSITORY, "tools", "bench", "run_bench.py"),
             "--fppg", PROGRAM, "--repeat", "1", "--out", os.path.join(folder, "bench"),
             *arguments], capture_output=True, text=True, check=False)

    def test_a_ladder_gives_samples_tables_and_a_plot(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_ladder(folder, "--only", "gear", "--millions", "0.005,0.02",
                                   "--gencase", PROGRAM)
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(os.path.join(folder, "bench.json"), encoding="utf-8") as file:
                results = json.load(file)["results"]
            self.assertEqual(len(results), 2)
            for rung, million in zip(results, (0.005, 0.02)):
                self.assertEqual(set(rung["variants"]),
                                 {"lattice, 1 thread", "lattice, 2 threads",
                                  "body-fitted, 1 thread", "body-fitted, 2 threads",
                                  "GenCase, 2 threads"})
                lattice = rung["variants"]["lattice, 1 thread"]
                self.assertLess(abs(lattice["particles"] / (million * 1e6) - 1), 0.06)
                self.assertGreater(lattice["wall_to_gencase"], 0)
                # A file of particles has 44 bytes a particle and more.
                self.assertGreater(lattice["bytes"], 44 * lattice["particles"])
            with open(os.path.join(folder, "bench.md"), encoding="utf-8") as file:
                self.assertIn("Seconds a stage:", file.read())
            picture = ET.parse(os.path.join(folder, "bench.svg")).getroot()
            lines = [e for e in picture.iter() if e.tag.endswith("polyline")]
            # Time and memory of five variants, and the time of copying.
            self.assertEqual(len(lines), 11)

    def test_a_case_that_is_not_there_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_ladder(folder, "--only", "teapot")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("teapot", done.stderr)


if __name__ == "__main__":
    unittest.main()
