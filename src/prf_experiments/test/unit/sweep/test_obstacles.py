# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
from made_up import result
from prf_experiments.run import trial
from prf_experiments.sweep import obstacles


def trials(avoid, *forces):
    return [result(gait="stand", avoid=avoid, seed=seed, figures={
        "largest_obstacle_contact_n": force,
        "largest_contact_by_pair_n": {"box | j2s7s300_link_7": 0.4, "j2s7s300_link_7 | obstacle": force}})
            for seed, force in enumerate(forces, 1)]


class PostInTheWay(unittest.TestCase):
    def test_the_table_has_the_contact_with_and_without_avoidance(self):
        text = obstacles.text(obstacles.summarise(trials(False, 12.0, 40.0) + trials(True, 0.0, 0.3)))
        self.assertRegex(text, r"stand +no +S S +2 of 2 +12\.0 +40\.0 +0\.4")
        self.assertRegex(text, r"stand +yes +S S +0 of 2 +0\.0 +0\.3 +0\.4")

    def test_the_conclusion_counts_touches_with_and_without_avoidance(self):
        self.assertEqual(
            obstacles.conclusion(obstacles.summarise(trials(False, 12.0, 40.0) + trials(True, 0.0, 0.3))),
            "Heeded by the planner, the post is touched in 0 of 2 trials, with up to 0.3 N; not heeded, the post is "
            "touched in 2 of 2 trials, with up to 40.0 N.")

    def test_the_obstacle_brings_its_skill_along(self):
        for values, expected in (({"demonstration": None}, "inspect_box.csv"),
                                 ({"demonstration": None, "obstacle": "post"},
                                  "inspect_box_from_the_right.csv"),
                                 ({"demonstration": "/a.csv", "obstacle": "post"}, "a.csv")):
            self.assertEqual(os.path.basename(trial.skill(values)), expected)
        self.assertEqual(trial.skill_arguments({"demonstration": None, "obstacle": "none"}), [])


if __name__ == "__main__":
    unittest.main()
