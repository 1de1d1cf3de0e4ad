# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import judge, smoothness
from prf_experiments.record import recording

from prf_experiments import geometry


def sways(amplitude, frequency, seconds=10.0):
    """Commands of seven joints that stand for 1 s and then sway."""
    stamps = synthetic.START + recording.TICK * np.arange(int(100 * seconds))
    times = np.maximum(0.0, 0.01 * np.arange(len(stamps)) - 1.0)
    positions = np.tile(amplitude * np.cos(frequency * times)[:, None], (1, 7))
    return recording.Joints(stamps, positions, np.zeros_like(positions))


def with_approach(shake):
    """A trial whose hand goes 0.3 m to the target in 5 s, shaking sideways at 4 Hz, m."""
    data = synthetic.make_recording()
    ticks = data.ticks
    times = 0.01 * np.arange(len(ticks))
    places = np.zeros((len(ticks), 7))
    places[:, 6] = 1.0
    places[:, 2] = 0.3 * np.clip(1.0 - times / 5.0, 0.0, 1.0)
    places[:, 0] = shake * np.sin(8.0 * np.pi * times)
    data.end_effector = recording.Poses(ticks, geometry.compose(data.tag.values, places))
    return data


def numbers(found: dict) -> dict[str, float]:
    return {name: float("nan") if value is None else value for name, value in found.items()}


class Smoothness(unittest.TestCase):

    def test_joints_are_measured_from_their_first_motion(self):
        found = smoothness.joints(sways(0.1, 5.0))
        self.assertAlmostEqual(found["joint_acceleration_rms_rad_s2"], 2.5 / np.sqrt(2.0), delta=0.1)
        self.assertAlmostEqual(found["joint_jerk_rms_rad_s3"], 12.5 / np.sqrt(2.0), delta=3.0)

    def test_an_arm_that_stands_has_no_figures(self):
        self.assertIsNone(smoothness.joints(sways(0.0, 1.0))["joint_jerk_rms_rad_s3"])
        self.assertIsNone(smoothness.joints(None)["joint_jerk_rms_rad_s3"])
        unknown = sways(0.1, 1.0)
        unknown.positions[:] = np.nan
        self.assertIsNone(smoothness.joints(unknown)["joint_jerk_rms_rad_s3"])

    def test_a_straight_approach_has_the_ratio_one_and_no_shake(self):
        found = numbers(smoothness.approach(with_approach(0.0)))
        self.assertAlmostEqual(found["approach_path_ratio"], 1.0, delta=1e-6)
        self.assertLess(found["approach_shake_rms_mm"], 0.5)

    def test_a_shake_is_measured_in_millimetres(self):
        found = numbers(smoothness.approach(with_approach(0.004)))
        self.assertAlmostEqual(found["approach_shake_rms_mm"], 4.0 / np.sqrt(2.0), delta=0.2)
        self.assertGreater(found["approach_path_ratio"], 1.5)

    def test_a_trial_that_never_tracks_has_no_approach(self):
        data = with_approach(0.0)
        data.progress.states[:] = judge.STATES.index("FORWARD")
        self.assertIsNone(smoothness.approach(data)["approach_path_ratio"])


if __name__ == "__main__":
    unittest.main()
