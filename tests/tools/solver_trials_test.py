"""The trials of tools/solver-trials are cases that fppg can make, and are judged right."""

import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(REPOSITORY, "tools"), os.path.join(REPOSITORY, "tools", "solver-trials")]
import run_trials  # noqa: E402 (found by the path above)
import trial_cases  # noqa: E402
import trial_definition  # noqa: E402
import trial_measures  # noqa: E402
from particle_files import read_bi4, read_particles  # noqa: E402
from period_cut import cut_period  # noqa: E402

PROGRAM = os.environ.get("FPPG_PROGRAM")
SMALL = {"rest": {"dp": 0.02}, "tank": {"dp": 0.02}, "wedge": {"dp": 0.01}, "cup": {"dp": 0.01}, "pipe": {"across": 8},
         "tilted": {"across": 8}, "gear": {"dp": 0.02}, "vessel": {"dp": 0.02}}


class Judging(unittest.TestCase):
    def test_flow_in_a_pipe_becomes_the_parabola(self):
        r, speeds = trial_measures.pipe_flow(0.05, 1e-3, 0.08, [0.0, 0.1, 50.0])
        self.assertEqual(np.abs(speeds[0]).max(), 0)
        # At first the middle is free of the wall and falls.
        self.assertAlmostEqual(speeds[1][0], 0.08 * 0.1, places=5)
        np.testing.assert_allclose(speeds[2], 0.08 * (0.05**2 - r**2) / (4 * 1e-3), atol=1e-6)

    def test_depth_is_zero_on_the_wet_surface_and_negative_in_the_fluid(self):
        for name, given in SMALL.items():
            with self.subTest(name):
                trial = trial_cases.CASES[name](**given)
                self.assertLess(trial.depth(np.array([trial.seed], float), np.zeros(3))[0], -trial.dp)
                mesh = next(iter(trial.meshes.values()))
                self.assertGreater(len(trial_cases.wet_part(trial, mesh).facets), 9)

    def test_words_make_cases_and_variants(self):
        trials = [make(trial_definition.variant_of("layers")) for _, make in run_trials.trials_of("vessel:dp=0.02,0.01:speed=1,4")]
        found = [(t.dp, t.facts["speed"]) for t in trials]
        self.assertEqual(found, [(0.02, 1), (0.02, 4), (0.01, 1), (0.01, 4)])
        # A boat lies in the water that the rows of its variant are.
        for name, level in (("lattice-dbc", 8.5), ("layers", 9)):
            (_, make), = run_trials.trials_of("boat:dp=0.0125")
            boat = make(trial_definition.variant_of(name))
            self.assertAlmostEqual(boat.facts["water_depth"] / boat.dp, level)
        variant = trial_definition.variant_of("layers:SlipMode=3:side=both")
        self.assertEqual((variant.parameters["SlipMode"], variant.attributes["side"]), ("3", "both"))
        self.assertNotIn("side", trial_definition.VARIANTS["layers"].attributes)


@unittest.skipUnless(PROGRAM, "FPPG_PROGRAM names no program")
class Making(unittest.TestCase):
    def made(self, folder, name, variant):
        """The Trial and the path of its case, without extension."""
        trial = trial_cases.CASES[name](**SMALL[name])
        variant = trial_definition.variant_of(variant)
        trial_definition.write_trial(trial, variant, folder)
        case = os.path.join(folder, "Case")
        off = [] if variant.is_fitted else ["-fit:off"]
        done = subprocess.run([PROGRAM, case + "_Def", case, *off], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout[-500:])
        return trial, case

    def test_fluid_lies_within_the_walls(self):
        for name in SMALL:
            for variant in ("lattice-dbc", "lattice-mdbc", "surface-mdbc2"):
                with self.subTest(f"{name} {variant}"), tempfile.TemporaryDirectory() as folder:
                    trial, case = self.made(folder, name, variant)
                    pos, mk = read_particles(case)
                    fluid = pos[mk == 1]
                    self.assertGreater(len(fluid), 10)
                    self.assertLess(trial.depth(fluid, np.zeros(3)).max(), 1e-9 + trial.dp / 2)

    def test_a_period_follows_on_the_one_before(self):
        for name in ("pipe", "tilted"):
            for variant in ("lattice-mdbc", "surface-mdbc2"):
                with self.subTest(f"{name} {variant}"), tempfile.TemporaryDirectory() as folder:
                    trial, case = self.made(folder, name, variant)
                    step = np.array((trial.facts["period"], 0, trial.facts["rise"]))
                    gone = cut_period(case, trial.dp, step[0], step)
                    values, arrays = read_bi4(case + ".bi4")
                    pos = arrays["Posd"]
                    self.assertEqual(len(pos), values["CaseNfixed"] + values["CaseNfluid"])
                    self.assertEqual(len(arrays["BoundNor"]), values["CaseNfixed"])
                    self.assertAlmostEqual(values["CasePosMax"][0] - values["CasePosMin"][0] + trial.dp, step[0])
                    if variant.startswith("lattice"):
                        self.assertEqual(gone, 0)
                    low = pos[pos[:, 0] < trial.dp] + step
                    gap = min(np.linalg.norm(pos - p, axis=1).min() for p in low)
                    self.assertGreater(gap, 0.45 * trial.dp)


if __name__ == "__main__":
    unittest.main()
