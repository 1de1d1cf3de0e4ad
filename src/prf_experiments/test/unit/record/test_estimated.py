# SPDX-License-Identifier: BSD-3-Clause
"""A robot's bag has no ground truth: hand and target by joints and detections."""
import unittest

import numpy as np
from prf_experiments.judge import judge
from prf_experiments.record import estimated
from prf_experiments.record.poses import Joints, Poses
from prf_experiments.robot import arm, description, shadow

from prf_experiments import geometry
from prf_msgs import bags

ARM_BASE = np.array([0.25, 0.0, 0.115, 0.0, 0.0, 0.0, 1.0])  # in the body
HOME = np.array([1.6, 1.372, 0.516, 0.967, -1.637, 2.307, -0.298])
TICKS = np.arange(0, 5_000_000_000, 10_000_000, dtype=np.int64)
URDF = description.text()
CHAIN = arm.Chain(URDF, estimated.ARM_BASE, estimated.HAND)
CAMERA = arm.Chain(URDF, estimated.HAND, estimated.OPTICAL).poses(np.zeros((1, 0)))[0]


def moving(amplitude):
    positions = HOME + amplitude * np.sin(1e-9 * TICKS)[:, None] * [1, 0.5, 0, -0.5, 0, 0.3, 0]
    return Joints(TICKS, positions, np.zeros_like(positions))


def world_of(moved, real, tag):
    """What is estimated of a tag that stands still in the arm's base, seen by the real arm's camera."""
    images = TICKS[5::3]
    hands = CHAIN.poses(real.positions[5::3])
    cameras = geometry.compose(hands, np.broadcast_to(CAMERA, hands.shape))
    seen = geometry.compose(geometry.inverse(cameras), np.broadcast_to(tag, hands.shape))
    seen[4:9] = np.nan
    return estimated.world("made.bag", moved, real, Poses(images, seen), lambda child, parent: CAMERA, ARM_BASE)


class Estimated(unittest.TestCase):
    def setUp(self):
        camera = geometry.compose(CHAIN.poses([HOME])[0], CAMERA)
        self.tag = geometry.compose(camera, [0.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0])

    def test_finds_a_tag_that_stands_still_however_the_arm_moves(self):
        world = world_of(moving(0.2), moving(0.2), self.tag)
        np.testing.assert_allclose(world.tag.values[:, :3], np.tile(self.tag[:3], (len(TICKS), 1)), atol=1e-9)
        np.testing.assert_array_equal(world.hand.stamps, TICKS)

    def test_the_hand_is_that_of_the_stand_in_and_the_camera_that_of_the_arm(self):
        world = world_of(moving(0.0), moving(0.2), self.tag)
        np.testing.assert_allclose(world.tag.values[:, :3], np.tile(self.tag[:3], (len(TICKS), 1)), atol=1e-9)
        lateral, along = judge.tag_in_camera(world.camera.values, world.tag.values)
        self.assertLess(np.max(lateral), 1e-9)
        np.testing.assert_allclose(along, 0.3, atol=1e-9)
        still, other = shadow.way_of(world, 0), shadow.way_of(world_of(moving(0.2), moving(0.2), self.tag), 0)
        self.assertAlmostEqual(still.reached or 0.0, 1.0, delta=0.02)
        self.assertEqual(still.path, 0.0)
        self.assertGreater(other.path, 0.1)
        self.assertGreater(other.fastest, 0.05)

    def test_the_body_counts_as_standing(self):
        world = world_of(moving(0.1), moving(0.1), self.tag)
        height, tilt = judge.posture(world.platform.values, world.base.values)
        np.testing.assert_allclose(height, estimated.STANDING, atol=1e-9)
        np.testing.assert_allclose(tilt, 0.0, atol=1e-6)

    # Fault 54: a bag without ground truth in which no tag, no arm or no camera is known -> one line
    def test_refuses_a_bag_that_tells_nothing(self):
        arms, seen = moving(0.1), Poses(TICKS[:2], np.tile(self.tag, (2, 1)))
        unknown = Joints(TICKS, np.full((len(TICKS), 7), np.nan), arms.velocities)
        nothing = Poses(TICKS[:2], np.full((2, 7), np.nan))
        for moved, real, detected, place, words in (
                (arms, arms, nothing, CAMERA, "no tag in view"), (unknown, arms, seen, CAMERA, "no joint_states"),
                (arms, unknown, seen, CAMERA, "no joint_states"), (arms, arms, seen, None, "tf_static does not")):
            with self.assertRaisesRegex(bags.BagError, words):
                estimated.world("made.bag", moved, real, detected, lambda *_, found=place: found, ARM_BASE)


if __name__ == "__main__":
    unittest.main()
