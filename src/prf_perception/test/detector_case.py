# SPDX-License-Identifier: BSD-3-Clause
"""Images for tag_detector_node, and its answers."""
import copy
import unittest

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image
from tf2_msgs.msg import TFMessage

from prf_msgs.msg import TagDetectionArray

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


class DetectorCase(unittest.TestCase):
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
            DetectorCase.stamp += 1 / 30
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
