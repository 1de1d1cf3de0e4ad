# SPDX-License-Identifier: BSD-3-Clause
import os
import tempfile
import unittest

import cv2
import numpy as np
import rosbag
import rospy
from prf_experiments.record import recording
from prf_experiments.run import arguments as args
from prf_experiments.run import foreign, replay
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, JointState
from std_msgs.msg import String

from prf_msgs import bags

NAMES = {"camera/image_raw": "/usb_cam/image_raw/compressed", "camera/camera_info": "/usb_cam/camera_info",
         "joint_states": "/arm/out/joint_state"}
SOURCE = foreign.Source(NAMES)
PIXELS = np.full((40, 60), 90, np.uint8)


def time(seconds):
    return rospy.Time.from_sec(100.0 + seconds)


class Foreign(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bag = os.path.join(folder.name, "robot.bag")
        self.out = os.path.join(folder.name, "played.bag")

    def write(self, image=None, info=True, seconds=2.0, compression="none", joints=None, rate=50.0, gap=(9.0, 9.0)):
        """A robot's bag: 50 Hz joints of its own name, 10 Hz JPEG, one camera_info a second."""
        with rosbag.Bag(self.bag, "w", compression=compression) as bag:
            for at in np.arange(0.0, seconds, 1.0 / rate):
                if gap[0] <= at < gap[1]:
                    continue
                names = recording.ARM_JOINTS if joints is None else joints
                states = JointState(name=[*names, "finger"], position=[3.0 + 0.1 * at] * 7 + [0.0])
                states.header.stamp = time(at)
                bag.write(NAMES["joint_states"], states, time(at + 0.002))
            for number, at in enumerate(np.arange(0.0, seconds, 0.1)):
                message = image or CompressedImage(format="mono8; jpeg compressed",
                                                   data=cv2.imencode(".jpg", PIXELS)[1].tobytes())
                message.header.stamp = time(at)
                bag.write(NAMES["camera/image_raw"], message, time(at + 0.03))
                if info and number % 10 == 0:
                    told = CameraInfo(width=60, height=40, K=[50, 0, 30, 0, 50, 20, 0, 0, 1])
                    told.header.stamp = time(at + 0.004)
                    bag.write(NAMES["camera/camera_info"], told, time(at))

    def read(self, topic):
        with rosbag.Bag(self.out) as bag:
            return [(message, at) for _, message, at in bag.read_messages(topics=[topic])]

    def test_names_rates_and_encodings_become_ours(self):
        for compression in ("none", "bz2", "lz4"):
            self.write(compression=compression)
            self.assertEqual(foreign.convert(self.bag, self.out, SOURCE), 20)
        image, at = self.read("/camera/image_raw")[3]
        self.assertEqual((image.encoding, image.width, image.height, image.header.frame_id),
                         ("mono8", 60, 40, "camera_optical_frame"))
        self.assertAlmostEqual(at.to_sec(), 100.33, places=6)
        infos = self.read("/camera/camera_info")
        self.assertEqual([info.header.stamp for info, _ in infos],
                         [image.header.stamp for image, _ in self.read("/camera/image_raw")])
        ticks = [message for message, _ in self.read("/joint_states")]
        self.assertEqual(len(ticks), 199)
        self.assertEqual({round((b.header.stamp - a.header.stamp).to_nsec()) for a, b in zip(ticks, ticks[1:])},
                         {recording.TICK})
        self.assertAlmostEqual(ticks[57].position[2], 3.0 + 0.1 * 0.57, places=9)
        self.assertAlmostEqual(ticks[57].velocity[2], 0.1, places=6)
        self.assertEqual(len(self.read("/clock")), 199)

    # Fault 54: a robot's bag without a topic, with another type, or nothing usable -> one line that names it
    def test_refuses_what_cannot_be_played(self):
        def refusal(source=SOURCE):
            with self.assertRaises(bags.BagError) as caught:
                foreign.convert(self.bag, self.out, source)
            self.assertNotIn("\n", str(caught.exception))
            return str(caught.exception)
        self.write()
        for ours, theirs, words in (
                ("camera/image_raw", "/camera", "--map camera/image_raw:=/usb_cam/image_raw/compressed takes one"),
                ("joint_states", "/usb_cam/camera_info",
                 "holds sensor_msgs/CameraInfo, must hold sensor_msgs/JointState")):
            self.assertIn(words, refusal(foreign.Source({**NAMES, ours: theirs})))
        self.write(info=False)
        self.assertIn("it has no sensor_msgs/CameraInfo at all", refusal())
        self.write(image=CompressedImage(format="jpeg", data=b"no picture"))
        self.assertIn("cannot be decompressed", refusal())
        self.write(image=CompressedImage(format="16UC1; compressedDepth", data=b""))
        self.assertIn("is of depth", refusal())
        self.write(image=Image(encoding="32FC1", width=60, height=40))
        self.assertIn("encoding '32FC1'", refusal())
        self.write(image=Image(encoding="mono8", width=61, height=40, step=61, data=bytes(61 * 40)))
        self.assertIn("61 x 40 pixels, camera_info is for 60 x 40", refusal())
        self.write(joints=[f"ur_{number}" for number in range(7)])
        self.assertIn("no two messages with j2s7s300_joint_1", refusal())
        with rosbag.Bag(self.bag, "w") as bag:
            bag.write("/chatter", String("hello"))
        self.assertIn("no message of", refusal())

    # Fault 54: a bag that was not closed -> one line, with the command that mends it
    def test_says_how_an_unindexed_bag_is_mended(self):
        self.write()
        with open(self.bag, "r+b") as stream:
            stream.seek(0)
            head = stream.read(4096)
            at = head.index(b"index_pos=") + len(b"index_pos=")
            stream.seek(at)
            stream.write(bytes(8))
        with self.assertRaisesRegex(bags.BagError, "rosbag reindex"):
            foreign.convert(self.bag, self.out, SOURCE)

    def test_a_long_gap_of_the_joints_stays_one(self):
        self.write(gap=(0.5, 1.3))
        foreign.convert(self.bag, self.out, SOURCE)
        stamps = np.array([message.header.stamp.to_nsec() for message, _ in self.read("/joint_states")])
        self.assertEqual(np.sum(np.diff(stamps) > recording.TICK), 1)

    def test_takes_the_camera_from_a_file(self):
        self.write(info=False)
        file = self.bag + ".yaml"
        with open(file, "w", encoding="utf-8") as stream:
            stream.write("image_width: 60\nimage_height: 40\ndistortion_model: plumb_bob\n"
                         "distortion_coefficients: {data: [0, 0, 0, 0, 0]}\n"
                         "camera_matrix: {data: [50, 0, 30, 0, 50, 20, 0, 0, 1]}\n")
        source = foreign.Source(NAMES, foreign.read_camera_info(file))
        self.assertEqual(foreign.convert(self.bag, self.out, source), 20)
        with open(file, "w", encoding="utf-8") as stream:
            stream.write("image_width: 60\n")
        with self.assertRaisesRegex(bags.BagError, "no file of camera_calibration"):
            foreign.read_camera_info(file)

    def test_the_map_is_read_strictly(self):
        self.assertEqual(foreign.parse_map(["/joint_states:=arm/joints"])["joint_states"], "/arm/joints")
        for word, why in (("joint_states", "not of the form"), ("joint_state:=/x", "did you mean joint_states"),
                          ("camera/image_raw:=", "not of the form")):
            with self.assertRaisesRegex(args.ArgumentError, why):
                foreign.parse_map([word])
        self.assertEqual(replay.main([self.bag, "--map", "image:=/x"]), 2)


if __name__ == "__main__":
    unittest.main()
