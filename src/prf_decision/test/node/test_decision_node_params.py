#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Parameters the decision node must refuse, with exit code 2 and their name."""

import os
import subprocess
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from itertools import count

import rospkg
import rospy
import rostest
import yaml

PACKAGE = rospkg.RosPack().get_path("prf_decision")
CONFIG = os.path.join(PACKAGE, "config", "decision.yaml")
HMM = os.path.join(PACKAGE, "config", "hmm_paper.yaml")
NAMES = (f"refused_decision_{number}" for number in count())
AT_ONCE = 4


def start_with(name, parameters):
    """Exit code and output of the node with these private parameters."""
    rospy.set_param("/" + name, parameters)
    command = ["rosrun", "prf_decision", "decision_node", "__name:=" + name]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60,
                            check=False)
    return result.returncode, result.stdout.decode()


class DecisionNodeParams(unittest.TestCase):
    def setUp(self):
        with open(CONFIG, encoding="utf-8") as file:
            self.valid = yaml.safe_load(file)
        self.valid.update(framework=True, autostart=True, hmm_file=HMM)

    def assert_refused(self, catalogue):
        """Each of (parameters, what the refusal must say)."""
        with ThreadPoolExecutor(AT_ONCE) as pool:
            starts = [pool.submit(start_with, next(NAMES), each) for each, _ in catalogue]
        for start, (_, culprit) in zip(starts, catalogue):
            code, output = start.result()
            self.assertEqual(code, 2, (culprit, output))
            fatal = [line for line in output.splitlines() if "FATAL" in line]
            self.assertEqual(len(fatal), 1, output)
            self.assertIn(culprit, fatal[0])

    # Fault 28: parameters missing, garbage, NaN or absurd -> the node refuses to start and names them
    def test_every_missing_key_is_named(self):
        self.assert_refused([({k: v for k, v in self.valid.items() if k != key}, key)
                             for key in self.valid])

    def test_every_bad_value_is_named_with_its_bound(self):
        nan, infinity = float("nan"), float("inf")
        catalogue = [
            ("pipeline_delay", 0.0, "pipeline_delay = 0, must be within [0.001, 1] s"),
            ("pipeline_delay", nan, "pipeline_delay = nan, must be finite"),
            ("camera_period", 0.004, "camera_period = 0.004, must be within [0.006, 1] s"),
            ("max_wait", -1, "max_wait = -1, must be within [0.05, 10] s"),
            ("max_wait", "soon", 'max_wait = "soon", must be a number'),
            ("lead", -0.01, "lead = -0.01, must be within [0, 1] s"),
            ("hold_time", -1.0, "hold_time = -1, must be within [0, 3600] s"),
            ("tracking_tolerance", 0, "tracking_tolerance = 0, must be within [0.0001, 0.5] m"),
            ("dwell_time", nan, "dwell_time = nan"),
            ("time_limit", infinity, "time_limit = inf"),
            ("catch_up_speed", [0.2], "catch_up_speed"),
            ("catch_up_time", 0.0, "catch_up_time = 0, must be within [0.01, 5] s"),
            ("catch_up_speed", [0.2, 0.0], "catch_up_speed angular = 0, must be within [0.01, 4]"),
            ("coast_limits", [0.3, 0.2, 5.0], "coast_limits[1] = 0.2, must be > coast"),
            ("workspace_radius", -2.0, "workspace_radius = -2, must be within [0.1, 20] m"),
            ("max_target_speed", infinity, "max_target_speed = inf, must be within [0.01, 10] m/s"),
            ("control_delay", 0.0, "control_delay = 0, must be within [0.01, 1] s"),
            ("following_tolerance", [1e308, 0.3], "following_tolerance[0] = 1e+308, must be within"),
            ("goal_tolerance", [0.05, 4.0], "goal_tolerance[1] = 4, must be within [0.001, 3.14"),
            ("following_limits", [0.1, 0.1, 5.0], "following_limits[1] = 0.1, must be greater"),
            ("robot", "my_arm", 'robot = "my_arm", must be gen3_v60, jaco_v60'),
            ("robot", "/no/such/folder", "/no/such/folder/robot.yaml"),
            ("framework", "yes", 'framework = "yes", must be true or false'),
            ("autostart", 1, "autostart = 1, must be true or false"),
            ("hmm_file", "no/such/file.yaml", "no/such/file.yaml: there is no such file"),
            ("speed", 1.0, "speed = 1, must be absent"),
        ]
        self.assert_refused([(dict(self.valid, **{key: value}), culprit)
                             for key, value, culprit in catalogue])

    def test_a_faulty_hmm_file_is_named_with_its_key(self):
        with open(HMM, encoding="utf-8") as file:
            text = file.read()
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write(text.replace("forward: 0.80", "forward: 0.90"))
            file.flush()
            self.assert_refused([(dict(self.valid, hmm_file=file.name),
                                  f"HMM file '{file.name}': initial sums to 1.1, must be 1")])


if __name__ == "__main__":
    rospy.init_node("test_decision_node_params")
    rostest.rosrun("prf_decision", "decision_node_params", DecisionNodeParams)
