#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tag_detector_node from outside: every image is answered once, bad parameters are refused."""
import copy
import os
import subprocess
import sys
import unittest

import numpy as np
import roslib.packages
import rospkg
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import CameraInfo, Image, RegionOfInterest
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from prf_msgs.msg import TagDetectionArray

PACKAGE = "prf_perception"
WIDTH, HEIGHT, FOCAL = 640, 480, 600.0
MODULE_PX = 20  # a 100 mm tag of eight modules at 0.375 m
TAGS = {
    0: """1111111111 1000000001 1011010101 1001110101 1001100001
          1010100001 1001011001 1000010001 1000000001 1111111111""",
    7: """1111111111 1000000001 1000010001 1000011001 1001010001
          1010111001 1000011101 1001010001 1000000001 1111111111""",
}


def frame(tag_id=None, columns=(WIDTH // 2,)):
    """A grey image with tags head on, their centres in the middle row."""
    pixels = np.full((HEIGHT, WIDTH), 110, np.uint8)
    for column in columns if tag_id is not None else ():
        bits = np.array([[int(c) for c in row] for row in TAGS[tag_id].split()], np.uint8)
        tag = np.kron(bits, np.ones((MODULE_PX, MODULE_PX), np.uint8)) * 255
        top, left = (HEIGHT - len(tag)) // 2, column - len(tag) // 2
        pixels[top:top + len(tag), left:left + len(tag)] = tag
    return pixels


def tilted():
    """The tag from afar, foreshortened: it is turned to the left or to the right."""
    bits = np.array([[int(c) for c in row] for row in TAGS[0].split()], np.uint8)
    tag = np.kron(bits, np.ones((6, 6), np.uint8)) * 255
    tag = tag[:, np.arange(tag.shape[1]) % 8 != 7]
    pixels = frame()
    pixels[200:200 + tag.shape[0], 300:300 + tag.shape[1]] = tag
    return pixels


class TagDetectorNode(unittest.TestCase):
    stamp = 1000.0

    @classmethod
    def setUpClass(cls):
        rospy.init_node("tag_detector_test")
        cls.answers, cls.transforms = [], []
        cls.images = rospy.Publisher("camera/image_raw", Image, queue_size=10)
        cls.infos = rospy.Publisher("camera/camera_info", CameraInfo, queue_size=10)
        cls.keep = [
            rospy.Subscriber("tag_detections", TagDetectionArray, cls.answers.append),
            rospy.Subscriber("/tf", TFMessage, lambda m: cls.transforms.extend(m.transforms)),
        ]
        cls.wait(lambda: cls.images.get_num_connections() and cls.infos.get_num_connections()
                 and all(s.get_num_connections() for s in cls.keep))

    @staticmethod
    def wait(condition, seconds=20.0):
        for _ in range(int(seconds / 0.01)):
            if condition():
                return
            rospy.rostime.wallsleep(0.01)
        raise AssertionError("waited in vain")

    def setUp(self):
        rospy.rostime.wallsleep(0.3)  # for answers to the test before
        self.answers.clear()
        self.transforms.clear()

    def send(self, pixels, encoding="mono8", info=True, width=WIDTH, frame_id="camera",
             lens=("", []), stamp=None, change=None):
        """`change` is called with image and camera_info before they are published."""
        if stamp is None:
            TagDetectorNode.stamp += 1 / 30
            stamp = self.stamp
        stamp = rospy.Time.from_sec(stamp)
        image = Image(encoding=encoding, height=HEIGHT, width=pixels.shape[1],
                      step=pixels.strides[0], data=pixels.tobytes())
        image.header.stamp, image.header.frame_id = stamp, frame_id
        message = CameraInfo(width=width, height=HEIGHT, distortion_model=lens[0], D=lens[1])
        message.header = copy.deepcopy(image.header)
        message.K = [FOCAL, 0, (WIDTH - 1) / 2, 0, FOCAL, (HEIGHT - 1) / 2, 0, 0, 1]
        if change is not None:
            change(image, message)
        self.images.publish(image)
        if info:
            self.infos.publish(message)
        return stamp

    def answer(self, count=1):
        self.wait(lambda: len(self.answers) >= count)
        rospy.rostime.wallsleep(0.1)
        self.assertEqual(len(self.answers), count, "exactly one answer for every image")
        return self.answers[-1]

    def test_image_gives_detection_and_tag_frame(self):
        stamp = self.send(frame(0))
        array = self.answer()
        self.assertEqual(array.header.stamp, stamp)
        self.assertEqual(array.header.frame_id, "camera")
        self.assertEqual([(d.family, d.id) for d in array.detections], [("tag36h11", 0)])
        pose = array.detections[0].pose.pose
        self.assertAlmostEqual(pose.position.x, 0.0, delta=5e-4)
        self.assertAlmostEqual(pose.position.y, 0.0, delta=5e-4)
        self.assertAlmostEqual(pose.position.z, 0.1 * FOCAL / (8 * MODULE_PX), delta=2e-3)
        self.assertGreater(abs(pose.orientation.x), 0.999)
        covariance = np.reshape(array.detections[0].pose.covariance, (6, 6))
        self.assertGreater(np.linalg.eigvalsh(covariance).min(), 0.0)
        self.wait(lambda: self.transforms)
        sent = self.transforms[0]
        self.assertEqual((sent.header.stamp, sent.header.frame_id, sent.child_frame_id),
                         (stamp, "camera", "tag_0"))
        self.assertEqual(sent.transform.translation.z, pose.position.z)

    def test_blank_image_gives_empty_array(self):
        stamp = self.send(frame())
        array = self.answer()
        self.assertEqual(array.header.stamp, stamp)
        self.assertEqual(array.detections, [])

    def test_colour_images_are_read(self):
        colour = np.ascontiguousarray(np.repeat(frame(0)[:, :, None], 3, axis=2))
        self.send(colour, encoding="bgr8")
        self.send(colour, encoding="rgb8")
        self.answer(2)
        self.assertEqual([len(a.detections) for a in self.answers], [1, 1])

    # Fault 16: false tag of another id -> published under its id, gives no frame
    def test_tag_of_another_id_is_published_but_no_frame(self):
        self.send(frame(7))
        self.assertEqual([d.id for d in self.answer().detections], [7])
        self.assertEqual(self.transforms, [])

    def test_two_tags_of_one_id_are_reported_and_one_gives_the_frame(self):
        reports: list[DiagnosticArray] = []
        subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, reports.append)
        self.wait(subscriber.get_num_connections)
        self.send(frame(0, columns=(160, 480)))
        self.assertEqual([d.id for d in self.answer().detections], [0, 0])
        self.wait(lambda: self.transforms)
        self.assertEqual(len(self.transforms), 1)

        def duplicates():
            self.send(frame())
            return any(int(entry.value) > 0 for report in reports for status in report.status
                       for entry in status.values if entry.key == "tags with a duplicate id")
        self.wait(duplicates)
        subscriber.unregister()

    def test_lens_distortion_is_taken_off(self):
        self.send(frame(0), lens=("plumb_bob", [0.0] * 5))
        self.send(frame(0), lens=("plumb_bob", [0.2, 0.0, 0.0, 0.0, 0.0]))
        self.answer(2)
        straight, bent = (a.detections[0].pose.pose.position.z for a in self.answers)
        # The mean of r^2 along an edge, a^2 + a^2 / 3 with a = 80 / 600, moves its straight fit out.
        self.assertAlmostEqual(bent / straight, 1.0 + 0.2 * 4 / 3 * (80 / FOCAL) ** 2, delta=5e-4)

    def test_lenses_of_other_models_are_refused(self):
        self.send(frame(0), lens=("equidistant", [0.1, 0.0, 0.0, 0.0]))
        self.send(frame(0), lens=("plumb_bob", [0.1] * 8))
        self.answer(2)
        self.assertEqual([a.detections for a in self.answers], [[], []])

    def test_images_that_cannot_be_read_give_empty_arrays(self):
        self.send(frame(0), encoding="32FC1")
        self.assertEqual(self.answer().detections, [])
        self.send(frame(0), width=320)
        self.assertEqual(self.answer(2).detections, [])
        self.send(frame(0), frame_id="")
        self.assertEqual(self.answer(3).detections, [])
        self.send(frame(0), info=False)
        self.send(frame(0))
        self.send(frame(0))
        self.answer(6)
        self.assertEqual([len(a.detections) for a in self.answers[3:]], [0, 1, 1])

    # Fault 43, 44: image and camera_info absurd or not of one another -> empty array, node goes on
    def test_absurd_images_and_cameras_give_empty_arrays(self):
        def assign(message, fields):
            for name, value in fields.items():
                setattr(message, name, value)

        def image(**fields):
            return lambda image, _: assign(image, fields)

        def camera(**fields):
            return lambda _, info: assign(info, fields)

        def intrinsics(index, value):
            def change(_, info):
                info.K = [value if i == index else old for i, old in enumerate(info.K)]
            return change

        def distortion(index, value):
            return camera(distortion_model="plumb_bob", D=[value if i == index else 0.0 for i in range(5)])

        numbers = (float("nan"), float("inf"), 1e300, -1e9, 1e9)
        changes = [
            image(width=15790321, height=272, step=15790321, data=bytes(16)),
            image(height=HEIGHT + 1), image(step=2 ** 32 - 1), image(step=WIDTH - 1), image(data=b""),
            image(encoding="x" * 10000), image(width=0, height=0, step=0, data=b""),
            camera(height=1), camera(binning_x=2, binning_y=2), camera(K=[0.0] * 9), intrinsics(0, 1e-6),
            camera(roi=RegionOfInterest(x_offset=8, width=100, height=100)), intrinsics(1, 0.5), intrinsics(8, 0.0),
            camera(header=Header(stamp=rospy.Time(), frame_id="another_camera")),
            camera(distortion_model="x" * 10000, D=[0.1] * 100000),
            *(intrinsics(index, value) for index in (0, 2, 4, 5) for value in numbers),
            *(distortion(index, value) for index in range(5) for value in numbers)]
        for count, change in enumerate(changes):
            def absurd(image, info, change=change):
                change(image, info)
                info.header.stamp = image.header.stamp
            self.send(frame(0), change=absurd)
            self.wait(lambda count=count: len(self.answers) > count)
        self.assertEqual([a.detections for a in self.answer(len(changes)) and self.answers], [[]] * len(changes))
        self.send(frame(0))
        self.assertEqual(len(self.answer(len(changes) + 1).detections), 1)

    # Fault 40, 42: one image or camera_info old, early, doubled -> dropped; the next is answered
    def test_wrong_stamps_cost_one_message(self):
        self.send(frame(0))
        self.answer()
        for wrong in (self.stamp - 0.5, self.stamp - 60.0, 0.0, self.stamp, self.stamp + 100.0,
                      4294967295.0):
            self.answers.clear()
            self.send(frame(0), stamp=wrong)
            right = self.send(frame(0))
            self.assertEqual(self.answer().header.stamp, right, f"after {wrong}")
            self.assertEqual(len(self.answers[0].detections), 1)

    # Fault 11: image stamps go back for good -> the third image begins the new run
    def test_image_stamps_that_go_back_begin_a_new_run(self):
        self.send(frame(0))
        self.answer()
        self.answers.clear()
        TagDetectorNode.stamp -= 50.0
        stamps = [self.send(frame(0)) for _ in range(4)]
        self.answer(2)
        self.assertEqual([a.header.stamp for a in self.answers], stamps[2:])

    # Fault 18: pose ambiguity -> the detection carries the second pose, and how alike the two are
    def test_the_second_pose_is_published(self):
        self.send(tilted())
        tag = self.answer().detections[0]
        self.assertGreater(tag.ambiguity, 0.0)
        self.assertLess(tag.ambiguity, 1.0)
        other = tag.alternative_pose
        self.assertAlmostEqual(other.position.z, tag.pose.pose.position.z, delta=0.05)
        norm = sum(getattr(other.orientation, axis) ** 2 for axis in "xyzw")
        self.assertAlmostEqual(norm, 1.0, places=9)


class TagDetectorParameters(unittest.TestCase):
    CATALOGUE = [
        ("tag_family", "tag99"), ("tag_family", 3), ("tag_size", 0.0), ("tag_size", -0.1),
        ("tag_size", float("nan")), ("tag_size", "big"), ("tag_ids", [-1]), ("tag_ids", 0),
        ("max_hamming", 3), ("max_hamming", 0.5), ("min_decision_margin", -1.0),
        ("quad_decimate", 0.0), ("min_white_black_diff", 0), ("corner_sigma", 0.0),
        ("position_floor", float("inf")), ("orientation_floor", -1.0), ("info_wait", -1.0),
        ("tag_size", 5e-324), ("tag_size", 1e308), ("tag_ids", [70000]), ("corner_sigma", 5e-324),
        ("corner_sigma", 1e308), ("min_decision_margin", 1e308), ("quad_decimate", 1e308),
        ("position_floor", 5e-324), ("orientation_floor", 1e308), ("info_wait", 1e308),
        ("tag_sise", 0.1), ("quad_decimate", None),
    ]

    # Fault 28, 52: parameters garbage, NaN or beyond physical bounds -> refused by name, code 2
    def test_bad_values_end_the_node_with_code_2_and_their_name(self):
        path = os.path.join(rospkg.RosPack().get_path(PACKAGE), "config", "tag_detector.yaml")
        with open(path, encoding="utf-8") as file:
            good = yaml.safe_load(file)
        executable = roslib.packages.find_node(PACKAGE, "tag_detector_node")[0]
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
    rostest.rosrun(PACKAGE, "tag_detector_node", "__main__", sys.argv)
