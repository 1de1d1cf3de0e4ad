# SPDX-License-Identifier: BSD-3-Clause
import math
import unittest

import geometry_msgs.msg
import numpy as np
import rospy
import sensor_msgs.msg
import tf2_msgs.msg
import visualization_msgs.msg
from prf_experiments.faults import catalogue, effects
from scipy.spatial.transform import Rotation

import prf_msgs.msg

SECOND = effects.SECOND


def joint_states(stamp):
    message = sensor_msgs.msg.JointState(name=["a", "b"], position=[1.0, 2.0], velocity=[0.1, 0.2])
    message.header.stamp = rospy.Time(0, 0) + rospy.Duration(stamp // SECOND, stamp % SECOND)
    return message


class Stamps(unittest.TestCase):
    def test_messages_without_a_header_have_the_stamps_of_their_parts(self):
        for message, field, kind in (
                (tf2_msgs.msg.TFMessage(), "transforms", geometry_msgs.msg.TransformStamped),
                (visualization_msgs.msg.MarkerArray(), "markers", visualization_msgs.msg.Marker)):
            self.assertEqual(effects.stamp_of(message), 0)
            setattr(message, field, [kind(), kind()])
            later = effects.shifted(message, 3 * SECOND)
            self.assertEqual(effects.stamp_of(later), 3 * SECOND)
            self.assertEqual([part.header.stamp.secs for part in getattr(later, field)], [3, 3])
            self.assertEqual(effects.stamp_of(message), 0)


class Channel(unittest.TestCase):
    def run_through(self, text, count=400, seed=1):
        """[(stamp in, [stamps out])] of messages 10 ms apart."""
        told: list = []
        channel = effects.Channel(catalogue.parse(text), seed,
                                  lambda fault, stamp: told.append(stamp))
        out = []
        for tick in range(1, count + 1):
            stamp = tick * SECOND // 100
            out.append((stamp, channel.take(joint_states(stamp), SECOND // 100)))
        self.told = told
        return out

    def stamps(self, out):
        return [effects.stamp_of(message) for _, some in out for message in some]

    def test_drops_the_share_within_its_time_and_the_same_again(self):
        out = self.run_through("drop/joint_states:0.5@1-2")
        lost = [stamp for stamp, some in out if not some]
        self.assertTrue(all(1.01 <= stamp / SECOND < 2.01 for stamp in lost))
        self.assertGreater(len(lost), 30)
        self.assertLess(len(lost), 70)
        self.assertEqual(self.told, lost)
        self.assertEqual([s for s, some in self.run_through("drop/joint_states:0.5@1-2") if not some],
                         lost)
        other = self.run_through("drop/joint_states:0.5@1-2", seed=2)
        self.assertNotEqual([stamp for stamp, some in other if not some], lost)

    def test_delays_by_the_time_of_the_data_and_keeps_the_order(self):
        out = self.run_through("delay/joint_states:0.05@1-2")
        self.assertEqual(sorted(self.stamps(out)), [stamp for stamp, _ in out])
        for stamp, some in out:
            for message in some:
                late = stamp - effects.stamp_of(message)
                self.assertIn(late, (0, SECOND // 20))

    def test_doubles_and_reorders_without_loss(self):
        doubled = self.stamps(self.run_through("duplicate/joint_states@1-2"))
        self.assertEqual(len(doubled), 500)
        turned = self.stamps(self.run_through("reorder/joint_states:0.3", count=401))
        self.assertGreaterEqual(len(turned), 400)
        self.assertGreater(np.sum(np.diff(turned) < 0), 50)

    def test_one_old_or_early_copy_and_no_more(self):
        old = self.stamps(self.run_through("old/joint_states:2@3"))
        self.assertEqual(len(old), 401)
        self.assertEqual(np.sum(np.diff(old) < 0), 1)
        ahead = self.stamps(self.run_through("ahead/joint_states:4294967295@3"))
        self.assertEqual(max(ahead), effects.LAST)

    def test_corrupts_one_number_and_leaves_the_original_alone(self):
        for text, broken in (("nan/joint_states", lambda values: np.isnan(values).sum() == 1),
                             ("huge/joint_states", lambda values: (values == 1e300).sum() == 1),
                             ("bits/joint_states", lambda values: True)):
            for _, some in self.run_through(text, count=50):
                values = np.array([*some[0].position, *some[0].velocity])
                self.assertTrue(broken(values), text)
                self.assertEqual(np.sum(values != [1.0, 2.0, 0.1, 0.2]), 1, text)

    def test_one_flipped_bit_is_one(self):
        for bit in range(64):
            flipped = effects.flipped_bit(1.5, "float64", bit)
            self.assertNotEqual(flipped, 1.5)
            self.assertEqual(effects.flipped_bit(flipped, "float64", bit) == 1.5
                             or math.isnan(flipped), True)


class Detections(unittest.TestCase):
    def detection(self):
        message = prf_msgs.msg.TagDetectionArray(detections=[prf_msgs.msg.TagDetection(id=0)])
        message.detections[0].pose.pose = geometry_msgs.msg.Pose(
            geometry_msgs.msg.Point(0.1, 0.0, 0.5), geometry_msgs.msg.Quaternion(1.0, 0.0, 0.0, 0.0))
        return message

    def through(self, word, message):
        return effects.effect_of(catalogue.parse_one(word))(message, effects.random.Random(1))[0][1]

    def test_a_move_aside_is_beside_the_tag(self):
        before = self.detection()
        after = self.through("false_tag:0.5", before)
        self.assertAlmostEqual(after.detections[0].pose.pose.position.x, 0.6)
        self.assertAlmostEqual(before.detections[0].pose.pose.position.x, 0.1)

    def test_a_flipped_pose_has_its_normal_on_the_other_side_of_the_line_of_sight(self):
        position, turn = np.array([0.1, 0.05, 0.5]), Rotation.from_rotvec([2.8, 0.2, 0.1])
        other = Rotation.from_quat(effects.mirrored(turn.as_quat(), position))
        sight = -position / np.linalg.norm(position)
        normals = [r.apply([0.0, 0.0, 1.0]) for r in (turn, other)]
        self.assertAlmostEqual(normals[0] @ sight, normals[1] @ sight)
        middle = normals[0] + normals[1]
        np.testing.assert_allclose(np.cross(middle, sight), 0.0, atol=1e-9)
        self.assertGreater((turn.inv() * other).magnitude(), 0.1)

    def test_pictures_get_a_dark_patch_or_turn_white(self):
        image = sensor_msgs.msg.Image(height=10, width=20, step=20, encoding="mono8",
                                      data=bytes([100] * 200))
        dark = np.frombuffer(self.through("occlusion:0.5", image).data, np.uint8)
        self.assertEqual(np.sum(dark != 100), 50)
        self.assertTrue(all(value == 255 for value in self.through("exposure:10", image).data))
        self.assertEqual(image.data, bytes([100] * 200))


if __name__ == "__main__":
    unittest.main()
