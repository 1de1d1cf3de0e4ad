# SPDX-License-Identifier: BSD-3-Clause
"""Whole trials: the task is done, and what is left behind is what was promised."""
import json
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import runs  # noqa: E402


class WholeTrial(unittest.TestCase):
    def succeeds(self, motion):
        with tempfile.TemporaryDirectory() as results:
            run = runs.run("run_trial", f"motion:={motion}", "seed:=1", f"results:={results}")
            self.assertEqual(run.code, 0, run.out + run.error)
            self.assertEqual(os.path.dirname(run.folder), results)
            for name in ("trial.bag", "verdict.json", "report.html", "parameters.yaml", "log"):
                self.assertTrue(os.path.exists(os.path.join(run.folder, name)), name)
            with open(os.path.join(run.folder, "verdict.json"), encoding="utf-8") as stream:
                verdict = json.load(stream)
            self.assertEqual(verdict["verdict"], "S", verdict["reason"])
            self.assertTrue(verdict["inspected"], verdict["reason"])
            self.assertIn(f"motion:={motion}", verdict["command"])
            self.assertEqual(runs.processes_of(results), [])

    def test_succeeds_on_a_still_platform(self):
        self.succeeds("none")

    def test_succeeds_on_a_lightly_moving_platform(self):
        self.succeeds("light")


if __name__ == "__main__":
    unittest.main()
