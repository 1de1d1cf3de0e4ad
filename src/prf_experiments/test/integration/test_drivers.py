# SPDX-License-Identifier: BSD-3-Clause
"""An arm behind a driver: a trial ends S, twice the same; its bag is replayed as any robot's would be."""
import json
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import runs
from prf_experiments.record import digest

SECONDS = 12.0  # enough for the target to be reached


class Drivers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.results = cls._folder.name
        cls.bag = cls.trial()

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    @classmethod
    def trial(cls):
        """At 125 Hz, through joiner, adapter and guards."""
        run = runs.run("run_trial", "motion:=light", "driver:=position_group", f"time_limit:={SECONDS}",
                       "report:=false", f"results:={cls.results}")
        if run.code != 0 or "verdict S" not in run.out:
            raise AssertionError(run.out + run.error)
        return os.path.join(run.folder, "trial.bag")

    def test_a_second_run_gives_the_same_messages(self):
        ours, theirs = digest.digests(self.bag), digest.digests(self.trial())
        self.assertEqual(digest.differences(ours, theirs), [])
        self.assertIn(("/speed_scale", "/driver_adapter"), ours)

    def test_a_stand_in_for_the_arm_does_in_a_replay_what_the_arm_did(self):
        folder = os.path.join(self.results, "replayed")
        run = runs.run("replay", self.bag, "--folder", folder, "--map", "joint_states:=/joint_states")
        self.assertEqual(run.code, 0, run.out + run.error)
        with open(os.path.join(folder, "verdict.json"), encoding="utf-8") as stream:
            content = json.load(stream)
        self.assertEqual(content["verdict"], "S", run.out)
        self.assertIn("no ground truth", content["reason"])
        self.assertLess(content["figures"]["reached_s"], SECONDS)
        self.assertTrue(os.path.exists(os.path.join(folder, "report.html")))
        self.assertRegex(run.out, r"apart +\d+ mm")


if __name__ == "__main__":
    unittest.main()
