# SPDX-License-Identifier: BSD-3-Clause
import unittest
from dataclasses import replace
from typing import Any

import numpy as np
from prf_experiments.rivals.pose_servo import PoseServo, ServoParams
from scipy.spatial.transform import Rotation

from prf_experiments import geometry

PARAMS = ServoParams((1.5, 0.0, 0.0), (0.5, 0.0, 0.0), 0.05, (0.4, 0.8), 0.3, 0.04, (0.03, 0.2), 3.0, 60.0)
HAND = np.array([0.3, 0.1, 0.5, 0.0, 0.0, 0.0, 1.0])
TICK = 0.01


def settled(params, hand, target, goal, ticks, velocity=(0.0, 0.0, 0.0)):
    """The hand of an arm that does what it is told, after so many ticks, and the target then."""
    servo, target = PoseServo(params), np.array(target, float)
    for tick in range(ticks):
        move = servo.move(tick * TICK, hand, target, goal)
        turn = Rotation.from_rotvec(TICK * move.twist[3:])
        hand = geometry.make(hand[:3] + TICK * move.twist[:3], turn * geometry.rotation(hand))
        target[:3] += TICK * np.array(velocity)
    return hand, target


class Servo(unittest.TestCase):
    def test_the_twist_is_the_gain_times_the_error_and_no_faster_than_it_may_be(self):
        turned = geometry.make(HAND[:3] + [0.1, 0.0, 0.0], Rotation.from_rotvec([0.0, 0.4, 0.0]))
        move = PoseServo(PARAMS).move(0.0, HAND, turned, geometry.IDENTITY)
        np.testing.assert_allclose(move.twist, [0.15, 0, 0, 0, 0.2, 0], atol=1e-12)
        np.testing.assert_allclose(move.error, [0.1, 0.4])
        np.testing.assert_allclose(move.pose[:3], HAND[:3] + [0.04 * 0.15, 0, 0])
        far = PoseServo(PARAMS).move(0.0, HAND, HAND + [3.0, 4.0, 0, 0, 0, 0, 0], geometry.IDENTITY)
        np.testing.assert_allclose(far.twist, [0.24, 0.32, 0, 0, 0, 0])

    def test_comes_to_a_standing_goal_and_lags_behind_a_moving_one_by_its_speed_over_the_gain(self):
        goal = geometry.make([-0.2, 0.0, 0.05], Rotation.from_rotvec([0.0, 0.0, 0.3]))
        hand, target = settled(PARAMS, HAND, [0.8, 0.0, 0.6, 0, 0, 0, 1], goal, 1500)
        np.testing.assert_allclose(hand, geometry.compose(target, goal), atol=1e-2)
        hand, target = settled(PARAMS, HAND, [0.8, 0, 0.6, 0, 0, 0, 1], goal, 1000, (0.0, 0.06, 0.0))
        lag = geometry.compose(target, goal)[:3] - hand[:3]
        np.testing.assert_allclose(lag, [0.0, 0.04, 0.0], atol=2e-3)

    def test_the_integral_ends_the_lag_and_is_bounded(self):
        integral = replace(PARAMS, linear_gains=(1.5, 1.0, 0.0), windup_limit=1.0)
        moving = (0.0, 0.06, 0.0)
        hand, target = settled(integral, HAND, HAND, geometry.IDENTITY, 2000, moving)
        np.testing.assert_allclose(target[:3] - hand[:3], 0, atol=2e-3)
        bounded = replace(integral, windup_limit=0.03)
        hand, target = settled(bounded, HAND, HAND, geometry.IDENTITY, 2000, moving)
        np.testing.assert_allclose(target[:3] - hand[:3], [0, 0.02, 0], atol=2e-3)

    def test_what_is_no_gain_is_refused_by_name(self):
        PARAMS.validate()
        wrong: dict[str, Any]
        for name, value in (("linear_gains", (1.0, 2.0)), ("fastest", (np.nan, 1.0)), ("hold_time", -1.0)):
            wrong = {name: value}
            with self.assertRaisesRegex(ValueError, name):
                replace(PARAMS, **wrong).validate()


if __name__ == "__main__":
    unittest.main()
