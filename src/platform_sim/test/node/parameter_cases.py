# SPDX-License-Identifier: BSD-3-Clause
"""Parameters that the simulator node refuses."""
import os
import re
import tempfile
import unittest

import rospy
from fake_framework import Simulator, config


class ParameterTest(unittest.TestCase):
    CATALOGUE = [
        ("scenario", "boat"), ("motion", "wild"), ("motion", 3), ("motion", "absent.csv"),
        ("body_motion", "absent.csv"), ("body_motion", 0), ("gait", "gallop"), ("seed", -1),
        ("seed", 1.5), ("variation", 1.5), ("arm_latency", 0.5),
        ("arm_mode", "floppy"), ("robot", "r2d2"), ("robot", "/nowhere"), ("robot", 7),
        ("lockstep", "yes"), ("paused", 1), ("response_timeout", 0.0),
        ("response_timeout", float("inf")), ("real_time_factor", -1.0), ("time_limit", 0.0),
        ("time_limit", float("nan")), ("end_delay", -1.0), ("no_such_parameter", 1),
        ("time_limit", 1e308), ("time_limit", 5e-324), ("real_time_factor", 5e-324),
        ("real_time_factor", 1e308), ("end_delay", 1e308), ("response_timeout", 5e-324),
        ("arm_latency", float("nan")), ("variation", 1e308),
    ]
    CAMERA_CATALOGUE = [
        ("noise", -4.0), ("latency", 0.6), ("exposure", 0.1), ("light_change", 1.0),
        ("light_period", 0.0), ("clutter", 1000), ("clutter", 0.5), ("distortion", [0.0] * 4),
        ("distortion", [-3.0, 0.0, 0.0, 0.0, 0.0]), ("distortion", [0.0, 0.0, float("nan"), 0.0, 0.0]),
        ("no_such_parameter", 1), ("noise", 1e308), ("light_period", 5e-324), ("distortion", [1e308] * 5),
    ]

    # Fault 28, 52: parameters garbage, NaN or beyond physical bounds -> refused by name, code 2
    def test_refuses_bad_values_by_name(self):
        for name, value in self.CATALOGUE:
            code, output = Simulator(**{name: value}).wait()
            self.assertEqual(code, 2, f"{name} = {value}: {output}")
            self.assertIn(name, output)
            self.assertEqual(output.count("FATAL"), 1, output)

    def test_refuses_a_motion_beyond_the_platforms_bounds(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "storm.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write("sway: {sines: [{amplitude: 0.5, rate: 12.6, phase: 0.0}]}")
            code, output = Simulator(motion=path).wait()
        self.assertEqual(code, 2, output)
        self.assertIn("sway amplitude = 0.5, must be at most 0.1 m", output)
        self.assertIn("motion is", output)

    def test_refuses_bad_values_of_the_camera_by_name(self):
        for name, value in self.CAMERA_CATALOGUE:
            code, output = Simulator(camera={**config()["camera"], name: value}).wait()
            self.assertEqual(code, 2, f"{name} = {value}: {output}")
            self.assertIn(name, output)
            self.assertEqual(output.count("FATAL"), 1, output)

    def test_requires_every_parameter(self):
        for name in config():
            code, output = Simulator(**{name: None}).wait()
            self.assertEqual(code, 2, f"{name}: {output}")
            self.assertIn(name, output)

    def test_requires_a_robot(self):
        urdf = rospy.get_param("robot_description")
        try:
            weightless = re.sub("<inertial>.*?</inertial>", "", urdf, flags=re.DOTALL)
            for bad in ("", "<robot", "<robot name='none'/>", weightless):
                rospy.set_param("robot_description", bad)
                code, output = Simulator().wait()
                self.assertEqual(code, 2, output)
                self.assertIn("robot_description", output)
            rospy.delete_param("robot_description")
            code, output = Simulator().wait()
            self.assertEqual(code, 2, output)
            self.assertIn("robot_description", output)
        finally:
            rospy.set_param("robot_description", urdf)
