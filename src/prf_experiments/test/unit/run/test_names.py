# SPDX-License-Identifier: BSD-3-Clause
import os
import unittest

import rospkg
from prf_experiments.run import names, trial_arguments

import elte_planner


class Names(unittest.TestCase):
    def test_planners_read_from_the_sources_are_those_that_elte_planner_makes(self):
        self.assertEqual(names.planner_names(), elte_planner.planner_names())

    def test_there_is_a_predictor_for_each_file_of_parameters(self):
        folder = os.path.join(rospkg.RosPack().get_path("prf_predictor"), "config", "predictors")
        self.assertEqual([name + ".yaml" for name in names.predictor_names()],
                         sorted(os.listdir(folder)))

    def test_defaults_are_among_them(self):
        defaults = {name: argument.default for name, argument in trial_arguments.NAMED.items()}
        self.assertIn(defaults["planner"], names.planner_names())
        self.assertIn(defaults["motion"], names.motion_names())
        self.assertIn(defaults["gait"], names.of_worlds("gaits"))
        self.assertIn(trial_arguments.LAUNCHED["scenario"].default, names.of_worlds("scenarios"))
        self.assertIn(trial_arguments.LAUNCHED["predictor"].default, names.predictor_names())


if __name__ == "__main__":
    unittest.main()
