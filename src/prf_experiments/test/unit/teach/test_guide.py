# SPDX-License-Identifier: BSD-3-Clause
import unittest

import numpy as np
from prf_experiments.teach import guide
from scipy.spatial.transform import Rotation

from prf_experiments import geometry

PARAMETERS = {"stand_off": 0.3, "run_in": 0.25, "detour_right": 0.0, "detour_forward": 0.0,
                  "settle_time": 1.0, "guide_time": 10.0, "stiffness": 400.0,
                  "damping": 40.0, "angular_stiffness": 30.0, "angular_damping": 3.0}
CAMERA_IN_HAND = np.array([0.0, 0.07, -0.12, 0.0, 0.0, 1.0, 0.0])
# Seen from the front along +x: tag x to the right (-y), y up (+z), z toward the viewer (-x).
TAG = np.array([0.8, 0.0, 0.65, 0.5, -0.5, -0.5, 0.5])
HAND = np.array([0.4, -0.22, 0.40, 0.5, 0.5, 0.5, 0.5])


def make(**changes):
    return guide.Guide(guide.GuideParams(**{**PARAMETERS, **changes}), 5.0, HAND,
                       geometry.compose(HAND, CAMERA_IN_HAND), TAG)


class Guide(unittest.TestCase):
    def test_tag_axes_are_those_of_the_test(self):
        axes = geometry.rotation(TAG).apply(np.eye(3))
        np.testing.assert_allclose(axes, [[0, -1, 0], [0, 0, 1], [-1, 0, 0]], atol=1e-12)

    def test_ends_with_the_camera_at_the_stand_off_looking_at_the_tag(self):
        end = make().pose(5.0 + 1.0 + 10.0)
        tag_in_camera = geometry.compose(
            geometry.inverse(geometry.compose(end, CAMERA_IN_HAND)), TAG)
        np.testing.assert_allclose(tag_in_camera[:3], [0.0, 0.0, 0.3], atol=1e-12)

    def test_starts_at_the_hand_and_rests_there(self):
        for stamp in (5.0, 6.0):
            np.testing.assert_allclose(make().pose(stamp), HAND, atol=1e-12)

    def test_a_detour_bends_the_path_out_to_the_right_and_toward_the_tag(self):
        def in_tag(leader):
            path = np.array([leader.pose(stamp) for stamp in np.linspace(6.0, 16.0, 50)])
            return geometry.compose(geometry.inverse(TAG), path)[:, :3]
        out = in_tag(make(detour_right=0.2, detour_forward=0.1)) - in_tag(make())
        np.testing.assert_allclose(out[[0, -1]], 0.0, atol=1e-12)
        np.testing.assert_allclose(out[:, 2], -0.5 * out[:, 0], atol=1e-12)
        self.assertAlmostEqual(np.max(out[:, 0]), 0.2 * 4 / 9, delta=1e-3)

    def test_starts_and_stops_gently(self):
        leader, step = make(), 1e-3
        for stamp in (6.0, 16.0):
            before, at, after = (leader.pose(stamp + d)[:3] for d in (-step, 0.0, step))
            self.assertLess(np.linalg.norm(after - before) / (2 * step), 1e-6)
            self.assertLess(np.linalg.norm(after - 2 * at + before) / step**2, 1e-2)

    def test_comes_in_along_the_normal_of_the_tag(self):
        leader = make()
        path = np.array([leader.pose(stamp) for stamp in np.linspace(6.0, 16.0, 200)])
        to_go = geometry.compose(geometry.inverse(TAG), path)[:, :3]
        to_go -= geometry.compose(geometry.inverse(TAG), leader.goal)[:3]
        last = to_go[to_go[:, 2] < 0.05]
        self.assertGreater(len(last), 40)
        self.assertLess(np.max(np.linalg.norm(last[:, :2], axis=1)), 0.003)
        self.assertTrue(np.all(np.diff(last[:, 2]) <= 0.0))

    def test_pulls_toward_the_guide(self):
        leader, aside = make(), HAND + [0.01, 0.0, -0.02, 0.0, 0.0, 0.0, 0.0]
        force, torque = leader.wrench(5.0, aside)
        np.testing.assert_allclose(force, [-4.0, 0.0, 8.0], atol=1e-9)
        np.testing.assert_allclose(torque, np.zeros(3), atol=1e-9)

    def test_turns_toward_the_guide(self):
        turned = geometry.make(HAND[:3], Rotation.from_rotvec([0.0, 0.0, 0.1])
                               * geometry.rotation(HAND))
        np.testing.assert_allclose(make().wrench(5.0, turned)[1], [0.0, 0.0, -3.0], atol=1e-9)

    def test_brakes_a_moving_hand(self):
        leader = make()
        leader.wrench(5.0, HAND - [0.001, 0, 0, 0, 0, 0, 0])
        np.testing.assert_allclose(leader.wrench(5.01, HAND)[0], [-4.0, 0.0, 0.0], atol=1e-9)

    def test_refuses_bad_parameters(self):
        for name, value in (("stiffness", 0.0), ("guide_time", 0.0), ("damping", -1.0),
                            ("run_in", float("nan")), ("stand_off", "near"),
                            ("settle_time", True)):
            with self.assertRaisesRegex(ValueError, name):
                make(**{name: value})


if __name__ == "__main__":
    unittest.main()
