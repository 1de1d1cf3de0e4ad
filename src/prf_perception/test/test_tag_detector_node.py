#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tag_detector_node from outside: every image is answered once, bad parameters are refused."""
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
from camera_cases import CameraCases  # noqa: F401  its tests run, too
from detector_case import FOCAL, HEIGHT, MODULE_PX, WIDTH, DetectorCase, frame, tilted
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import CameraInfo, Image, RegionOfInterest
from std_msgs.msg import Header

from prf_msgs.msg import TagDetectionArray

PACKAGE = "prf_perception"


class TagDetectorNode(DetectorCase):
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
        DetectorCase.stamp -= 50.0
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

    # Fault 54: a camera that stamps its images late -> what is published has the time of the exposure
    def test_the_stamps_of_a_late_camera_are_shifted(self):
        answers: list[TagDetectionArray] = []
        pairs = [(rospy.Publisher("late/camera/" + name, kind, queue_size=10), kind)
                 for name, kind in (("image_raw", Image), ("camera_info", CameraInfo))]
        subscriber = rospy.Subscriber("late/tag_detections", TagDetectionArray, answers.append)
        self.wait(lambda: all(one.get_num_connections() for one in (*[pair[0] for pair in pairs], subscriber)))
        kept = []
        stamp = self.send(frame(0), change=lambda *messages: kept.extend(messages))
        for publisher, kind in pairs:
            publisher.publish(next(message for message in kept if isinstance(message, kind)))
        self.wait(lambda: answers)
        self.assertEqual(answers[0].header.stamp, stamp - rospy.Duration.from_sec(0.04))
        self.assertEqual(len(answers[0].detections), 1)


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
        ("stamp_offset", 0.6), ("stamp_offset", float("nan")), ("stamp_offset", None),
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
