# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import tempfile
import unittest

import numpy as np
import rosbag
from scipy.spatial.transform import Rotation

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.teach import demonstration, teaching

from prf_experiments import geometry

UPRIGHT = [0.5, 0.5, 0.5, 0.5]


def led_hand(times, start, end):
    """Hand that rests, goes 0.3 m along x at even pace between two times, and rests."""
    x = 0.3 * np.clip((times - start) / (end - start), 0.0, 1.0)
    return np.hstack([np.column_stack([0.3 + x, 0.0 * x, 0.5 + 0.0 * x]),
                      np.tile(UPRIGHT, (len(times), 1))])


class Teaching(unittest.TestCase):
    def convert(self, data, hand, change=None):
        """`change` gives each (topic, message, connection header) its place in a rewritten bag."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "teach.bag")
            synthetic.write_bag(path, data, hand=hand)
            if change is not None:
                with rosbag.Bag(path) as bag:
                    kept = list(bag.read_messages(return_connection_header=True))
                with rosbag.Bag(path, "w") as bag:
                    for topic, message, stamp, header in kept:
                        bag.write(topic, message, stamp, connection_header=change(topic, message, header))
            return teaching.convert(path, "test")

    # Fault 54: a bag without publishers' names, or from another publisher of tf -> the same skill
    def test_the_publisher_of_tf_may_have_any_name_or_none(self):
        data = synthetic.make_recording(5.0)
        hand = led_hand(data.seconds(data.ticks), 1.0, 3.5)
        plain = self.convert(data, hand)

        def nameless(_, __, header):
            return {key: value for key, value in header.items() if key != "callerid"}

        def renamed(_, __, header):
            return {**header, "callerid": b"/arm/state_publisher"}
        for change in (nameless, renamed):
            np.testing.assert_array_equal(self.convert(data, hand, change).poses, plain.poses)

    # Fault 4: detections in a frame that tf does not know -> refused by its name, not taken for another's
    def test_detections_are_taken_in_the_frame_that_they_name(self):
        data = synthetic.make_recording(5.0)
        hand = led_hand(data.seconds(data.ticks), 1.0, 3.5)

        def in_frame(frame):
            def change(topic, message, header):
                if topic == "/tag_detections":
                    message.header.frame_id = frame
                return header
            return change
        with self.assertRaisesRegex(demonstration.DemonstrationError, "in frame 'front_camera'.*not exist"):
            self.convert(data, hand, in_frame("front_camera"))
        target = self.convert(data, hand, in_frame("j2s7s300_end_effector")).target
        expected = geometry.compose(hand[-1], data.detections[-1])
        np.testing.assert_allclose(target[:3], expected[:3], atol=1e-9)

    # Fault 48: a teaching whose tf is in mm -> refused with distance and the question
    def test_millimetres_in_a_bag_are_refused(self):
        data = synthetic.make_recording(5.0)
        hand = led_hand(data.seconds(data.ticks), 1.0, 3.5)
        hand[:, :3] *= 1000.0
        with self.assertRaisesRegex(demonstration.DemonstrationError, "is it in mm?"):
            self.convert(data, hand)

    def test_keeps_the_moving_part_at_twenty_hertz(self):
        data = synthetic.make_recording(10.0)
        hand = led_hand(data.seconds(data.ticks), 2.0, 8.0)
        result = self.convert(data, hand)
        self.assertEqual(result.times[0], 0.0)
        self.assertAlmostEqual(result.times[-1], 6.0, delta=0.05)
        np.testing.assert_allclose(np.diff(result.times), 0.05, atol=0.001)
        np.testing.assert_allclose(result.poses[0, :3], hand[0, :3], atol=1e-3)
        np.testing.assert_allclose(result.poses[-1, :3], hand[-1, :3], atol=1e-3)

    def test_places_the_target_by_detections_and_tf(self):
        data = synthetic.make_recording(5.0)
        hand = led_hand(data.seconds(data.ticks), 1.0, 3.5)
        target = self.convert(data, hand).target
        camera = geometry.compose(hand[-1], [0.0, 0.07, -0.12, 0.0, 0.0, 1.0, 0.0])
        expected = geometry.compose(camera, data.detections[-1])
        np.testing.assert_allclose(target[:3], expected[:3], atol=1e-9)
        turned = geometry.rotation(target) * geometry.rotation(expected).inv()
        self.assertLess(turned.magnitude(), 1e-9)

    def test_refuses_a_hand_that_never_moves(self):
        data = synthetic.make_recording(2.0)
        hand = led_hand(data.seconds(data.ticks), 5.0, 6.0)
        with self.assertRaisesRegex(demonstration.DemonstrationError, "never moves"):
            self.convert(data, hand)

    def test_refuses_a_tag_not_seen_at_the_end(self):
        data = synthetic.make_recording(3.0)
        data.detections[20:] = np.nan
        with self.assertRaisesRegex(demonstration.DemonstrationError, "not seen"):
            self.convert(data, led_hand(data.seconds(data.ticks), 1.0, 2.0))

    def test_resampled_quaternions_do_not_change_sign(self):
        times = np.linspace(0.0, 1.0, 11)
        poses = geometry.make(np.zeros((11, 3)), Rotation.from_euler("z", 0.1 * np.arange(11)))
        poses[5:, 3:] *= -1.0
        at, resampled = teaching.resample(times, poses, 50.0)
        quaternions = resampled[:, 3:]
        self.assertEqual(len(at), 51)
        self.assertTrue(np.all(np.sum(quaternions[1:] * quaternions[:-1], axis=1) > 0.9))
        np.testing.assert_allclose(geometry.rotation(resampled).as_rotvec(),
                                   np.outer(at, [0.0, 0.0, 1.0]), atol=1e-9)


if __name__ == "__main__":
    unittest.main()
