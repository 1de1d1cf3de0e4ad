#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""target_predictor_node ends with code 2 and names the parameter when one is bad."""
import os
import subprocess
import sys
import unittest

import roslib.packages
import rospkg
import rospy
import rostest
import yaml

PACKAGE = "prf_predictor"


class TargetPredictorParams(unittest.TestCase):
    CATALOGUE = [
        ("planning_frame", ""), ("tag_frame_prefix", ""), ("planning_frame", 1), ("tag_id", -1),
        ("tag_id", 0.5),
        ("horizons", []), ("horizons", [0.1, 0.2]), ("horizons", [0.0, 0.2, 0.2]),
        ("horizons", [0.0, float("nan")]), ("horizons", "soon"), ("tf_wait", -1.0),
        ("predictor", "magic"), ("predictor", 1), ("acceleration_density", 0.0),
        ("acceleration_density", float("nan")), ("orientation_gate_sigma", -1.0),
        ("velocity_time_constant", 0.0),
        ("jerk_density", 1.0), ("position_sigma", 0.0), ("orientation_sigma", -0.1),
        ("gate_probability", 1.0), ("gate_probability", 0.1), ("gate_speed", -0.001),
        ("measurement_scale", 0.0), ("reacquire_hits", 1),
        ("measurement_scale", 1e308), ("gate_speed", 1e308), ("position_sigma", 5e-324),
        ("orientation_gate_speed", -1.0), ("coast_after", 0.0), ("lost_after", 0.1), ("lost_after", None),
        ("lost_afer", 2.0),
    ]

    # Fault 28, 52: parameters that are missing, NaN, unknown or out of bounds -> code 2 and the name
    def test_bad_values_end_the_node_with_code_2_and_their_name(self):
        folder = os.path.join(rospkg.RosPack().get_path(PACKAGE), "config")
        good = {}
        for name in ("target_predictor.yaml", os.path.join("predictors", "ukf.yaml")):
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                good.update(yaml.safe_load(file))
        executable = roslib.packages.find_node(PACKAGE, "target_predictor_node")[0]
        for name, value in self.CATALOGUE:
            with self.subTest(name=name, value=value):
                values = {k: v for k, v in {**good, name: value}.items() if v is not None}
                if rospy.has_param("/refused"):
                    rospy.delete_param("/refused")
                rospy.set_param("/refused", values)
                done = subprocess.run([executable, "__name:=refused"], timeout=20, check=False,
                                      capture_output=True, text=True)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                fatal = [line for line in done.stderr.splitlines() if "FATAL" in line]
                self.assertEqual(len(fatal), 1, done.stderr)
                self.assertIn(name, fatal[0])


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "target_predictor_params", "__main__", sys.argv)
