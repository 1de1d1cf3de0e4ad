# SPDX-License-Identifier: BSD-3-Clause
"""Faults injected into running trials: several in each, since a trial takes its time."""
import json
import os
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
import runs
from prf_experiments.judge import judge
from prf_experiments.record import recording

ONE_MESSAGE = ("old/joint_states:1@5,old/tag_detections:1@5.5,old/target/forecast:1@6,"
               "old/camera/image_raw:1@6.5,ahead/joint_states:100@7,ahead/execution/progress:100@7.5,"
               "ahead/joint_command:100@8,ahead/tag_detections:4294967295@8.5,"
               "ahead/joint_states:4294967295@9,foreign_tf:-1.5@2")
RESTARTS = "respawn/decision:0.5@4,respawn/target_predictor:0.5@6,respawn/skill_planner:0.5@8"


class FaultyTrials(unittest.TestCase):
    def trial(self, fault, *words, code=0):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        run = runs.run("run_trial", f"fault:={fault}", f"results:={folder.name}", "report:=false",
                       "time_limit:=13", *words)
        self.assertEqual(run.code, code, run.out + run.error)
        self.assertNotIn("Traceback", run.out + run.error)
        self.assertEqual(runs.processes_of(folder.name), [])
        with open(os.path.join(run.folder, "verdict.json"), encoding="utf-8") as stream:
            self.verdict = json.load(stream)
        self.assertEqual(self.verdict["invariants"]["violations"], [])
        return run.folder

    def states(self, folder):
        """Names of the states in their order, each once for every time it is entered."""
        data = recording.read(os.path.join(folder, "trial.bag"))
        states = data.progress.states
        self.assertEqual({event.fault for event in data.fault_events},
                         set(self.verdict["arguments"]["fault"].split(",")))
        return [judge.STATES[state] for state in states[np.flatnonzero(np.diff(states, prepend=-1))]]

    # Fault 40, 41, 42, 51: one old, early or end-of-time message of each kind, unrelated tf -> goes on
    def test_one_wrong_message_of_any_kind_does_not_begin_a_new_run(self):
        states = self.states(self.trial(ONE_MESSAGE))
        self.assertEqual(states.count("WAITING"), 1, states)
        self.assertEqual(states.count("STOPPED"), 0, states)

    # Fault 38: the controller is killed while the skill is executed -> pause, given up, never DONE
    def test_without_the_controller_nothing_is_done(self):
        folder = self.trial("kill/arm_controller@5", "time_limit:=16")
        states = self.states(folder)
        self.assertEqual(self.verdict["verdict"], "F")
        self.assertNotIn("DONE", states)
        self.assertNotEqual(states[-1], "FORWARD")

    # Fault 26: decision, predictor and planner are killed and started again -> holds, resumes without a jump
    def test_nodes_that_come_back_resume_without_a_jump(self):
        states = self.states(self.trial(RESTARTS))
        self.assertIn("FORWARD", states[2:])
        self.assertLess(self.verdict["invariants"]["largest_joint_step_rad"], 0.0085)

    # Fault 35, 49: the disk is full during a trial -> INVALID with the reason, nothing half written
    def test_a_full_disk_makes_the_trial_invalid(self):
        folder = self.trial("disk@2", code=3)
        self.assertEqual(self.verdict["verdict"], "INVALID")
        self.assertIn("cannot be written", self.verdict["reason"])
        self.assertNotIn("trial.bag", os.listdir(folder))


if __name__ == "__main__":
    unittest.main()
