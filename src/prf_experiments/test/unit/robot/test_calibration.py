# SPDX-License-Identifier: BSD-3-Clause
import os
import tempfile
import unittest

import numpy as np
import rosbag
import rospy
import sensor_msgs.msg
import trajectory_msgs.msg
import yaml
from prf_experiments.record import recording
from prf_experiments.robot import arm, calibrate, calibration, description, efforts, made_motion
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

import prf_msgs.msg
from prf_experiments import geometry
from prf_msgs import bags
from prf_msgs.msg import TagDetection, TagDetectionArray

URDF = description.text()
CHAIN = arm.Chain(URDF, "j2s7s300_link_base", calibrate.HAND)
NOMINAL = arm.Chain(URDF, calibrate.HAND, calibrate.OPTICAL).poses(np.zeros((1, 0)))[0]


class Calibration(unittest.TestCase):
    def of(self, motion, rows=slice(None)):
        return calibration.calibrate(calibration.hand_of(CHAIN, motion.stamps, motion.measured),
                                     (motion.stamps[0], motion.stamps[-1]), motion.image_stamps[rows],
                                     motion.detections[rows])

    def test_finds_camera_and_delays_that_are_far_from_the_description(self):
        motion = made_motion.make(CHAIN, NOMINAL, 1)
        found = self.of(motion, slice(None, None, 6))
        off = geometry.compose(geometry.inverse(motion.camera_in_hand), found.camera_in_hand)
        self.assertLess(np.linalg.norm(off[:3]), 1e-3)
        self.assertLess(geometry.rotation(off).magnitude(), np.radians(0.2))
        self.assertAlmostEqual(found.offset, motion.offset, delta=2e-3)
        self.assertEqual(found.complaint, "")
        delay = calibration.arm_delay(motion.stamps, motion.commands, motion.stamps, motion.measured)
        self.assertAlmostEqual(delay, motion.delay, delta=1e-3)

    # Fault 54: a bag without motion, or with few detections -> refused with the reason, no file
    def test_refuses_what_does_not_determine_it(self):
        motion = made_motion.make(CHAIN, NOMINAL, 1)
        with self.assertRaisesRegex(calibration.CalibrationError, "detections"):
            self.of(motion, slice(0, 50))
        still = np.tile(made_motion.POSTURE, (len(motion.stamps), 1))
        with self.assertRaisesRegex(calibration.CalibrationError, "hardly moves"):
            calibration.arm_delay(motion.stamps, still, motion.stamps, still + 1e-5 * np.sin(motion.stamps)[:, None])

    def test_the_description_gets_the_camera(self):
        place = geometry.compose(NOMINAL, [0.01, -0.02, 0.005, 0.0, 0.0, np.sin(0.02), np.cos(0.02)])
        text = calibrate.with_camera(URDF, place)
        found = arm.Chain(text, calibrate.HAND, calibrate.OPTICAL).poses(np.zeros((1, 0)))[0]
        off = geometry.compose(geometry.inverse(place), found)
        self.assertLess(np.linalg.norm(off[:3]), 1e-8)
        self.assertLess(geometry.rotation(off).magnitude(), 1e-7)

    # Fault 54: joint names or positions in the bag that are not the arm's -> refused with what was found, no file
    def test_reads_no_joints_that_are_not_the_arms(self):
        names = calibrate.ROBOT.joints
        for lacking in ([names[0]], [*names[:-1], "other"]):
            with self.subTest(lacking):
                states = sensor_msgs.msg.JointState(name=lacking, position=[0.1] * len(lacking))
                commands = trajectory_msgs.msg.JointTrajectory(
                    joint_names=lacking, points=[trajectory_msgs.msg.JointTrajectoryPoint(positions=[0.1])])
                with tempfile.TemporaryDirectory() as folder:
                    path = os.path.join(folder, "a.bag")
                    with rosbag.Bag(path, "w") as bag:
                        for topic, message in (("joint_states", states), ("joint_command", commands),
                                               ("tag_detections", prf_msgs.msg.TagDetectionArray())):
                            bag.write("/" + topic, message, rospy.Time(1))
                    with self.assertRaisesRegex(bags.BagError, "0 joint_states with the joints j2s7s300_joint_1"):
                        calibrate.read(path, 0)

    # Fault 54: a calibration file that calibrate did not write -> one line, exit code 1
    def test_refuses_a_file_that_it_did_not_write(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "calibration.yaml")
            for text in ("", "calibration: {camera_in_hand: [1, 2]}",
                         "calibration: {camera_in_hand: [.nan, 0, 0, 0, 0, 0, 1]}"):
                with open(file, "w", encoding="utf-8") as stream:
                    stream.write(text)
                self.assertEqual(calibrate.main(["--description", file]), 1)

    def made_bag(self, path, motion, effort=2.0):
        """A recording of the motion, every sixth detection, with efforts that go with the position."""
        with rosbag.Bag(path, "w") as bag:
            for stamp, joints, command in zip(motion.stamps, motion.measured, motion.commands):
                at = rospy.Time.from_sec(100.0 + stamp)
                states = JointState(name=recording.ARM_JOINTS, position=list(joints), effort=list(effort * joints))
                states.header.stamp = at
                bag.write("/joint_states", states, at)
                order = JointTrajectory(joint_names=recording.ARM_JOINTS,
                                        points=[JointTrajectoryPoint(positions=list(command))])
                order.header.stamp = at
                bag.write("/joint_command", order, at)
            for stamp, seen in zip(motion.image_stamps[::6], motion.detections[::6]):
                found = TagDetection(id=0)
                place = found.pose.pose
                place.position.x, place.position.y, place.position.z = seen[:3]
                turn = place.orientation
                turn.x, turn.y, turn.z, turn.w = seen[3:]
                message = TagDetectionArray(detections=[found])
                message.header.stamp = rospy.Time.from_sec(100.0 + stamp)
                bag.write("/tag_detections", message, message.header.stamp)

    def test_writes_the_file_that_the_nodes_read(self):
        motion = made_motion.make(CHAIN, NOMINAL, 2)
        with tempfile.TemporaryDirectory() as folder:
            bag, out = os.path.join(folder, "one.bag"), os.path.join(folder, "calibration.yaml")
            self.made_bag(bag, motion)
            self.assertEqual(calibrate.main([bag, "--out", out, "--efforts"]), 0)
            with open(out, encoding="utf-8") as stream:
                first = yaml.safe_load(stream)
            self.assertAlmostEqual(first["tag_detector"]["stamp_offset"], motion.offset, delta=2e-3)
            self.assertAlmostEqual(first["driver_adapter"]["delay"], motion.delay, delta=2e-3)
            self.assertAlmostEqual(first["decision"]["lead"], motion.delay, delta=2e-3)
            lower, upper = np.array([first["guards"]["effort_" + name] for name in ("lower", "upper")])
            self.assertTrue(np.all(lower < np.min(2.0 * motion.measured, axis=0)))
            self.assertTrue(np.all(upper > np.max(2.0 * motion.measured, axis=0)))
            # With that file loaded the detector would have shifted the stamps already.
            self.assertEqual(calibrate.main([bag, "--out", out, "--loaded", out]), 0)
            with open(out, encoding="utf-8") as stream:
                second = yaml.safe_load(stream)
            self.assertAlmostEqual(second["tag_detector"]["stamp_offset"],
                                   2.0 * first["tag_detector"]["stamp_offset"], delta=1e-5)

    # Fault 54: a driver that tells no efforts -> no bounds are learnt, in one line
    def test_learns_no_bounds_from_efforts_that_are_none(self):
        for bad in (np.ones((2000, 7)), np.full((2000, 7), np.nan), np.random.default_rng(1).normal(size=(10, 7))):
            with self.assertRaises(efforts.EffortError):
                efforts.bounds(bad)


if __name__ == "__main__":
    unittest.main()
