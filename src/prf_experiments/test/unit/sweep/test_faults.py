# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import made_up
from prf_experiments.faults import catalogue
from prf_experiments.sweep import faults


class Faults(unittest.TestCase):
    def test_every_kind_of_fault_every_topic_and_every_node_is_tried(self):
        tried = [fault for word in faults.WORDS for fault in catalogue.parse(word)]
        self.assertEqual({fault.name for fault in tried}, set(catalogue.KINDS))
        self.assertEqual({fault.topic for fault in tried if fault.topic}, set(catalogue.TOPICS))
        self.assertEqual({fault.node for fault in tried if fault.node}, set(faults.FRAMEWORK))
        self.assertEqual(len(set(faults.WORDS)), len(faults.WORDS))

    def results(self):
        first = made_up.result("S", fault="kill/decision@5", gait="stand",
                               figures={"final_state": "DONE", "largest_contact_n": 0.0})
        first.update(reaction={"time_to_hold_s": 0.31, "time_to_recover_s": None},
                     invariants={"violations": ["step beyond"], "largest_joint_step_rad": 0.006})
        return [first, made_up.result("INVALID", fault="disk@5", gait="stand")]

    def test_the_table_shows_what_happened_and_what_is_broken(self):
        text = faults.text(faults.summarise(self.results()))
        self.assertRegex(text, r"kill/decision@5 +stand +S +done +0\.31 +– +0\.0060 +0\.00 +1 BROKEN")
        self.assertIn("INVARIANT BROKEN: kill/decision@5, stand: step beyond", text)
        self.assertRegex(text, r"disk@5 +stand +× +– +– +– +– +– +hold")

    def test_the_conclusion_names_what_is_broken(self):
        self.assertEqual(faults.conclusion(faults.summarise(self.results())),
                         "2 trials with a fault: 1 S, 1 ×; where the execution was held, it was so after at most 0.31 "
                         "s; INVARIANTS BROKEN with kill/decision@5, stand.")
        self.assertTrue(faults.conclusion(faults.summarise(self.results()[1:])).endswith("hold in all trials."))

    def test_invalid_is_right_where_nothing_can_be_recorded(self):
        self.assertTrue(faults.may_be_invalid({"fault": "drop/tf,disk@5"}))
        self.assertFalse(faults.may_be_invalid({"fault": "kill/decision@5"}))


if __name__ == "__main__":
    unittest.main()
