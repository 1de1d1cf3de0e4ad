# SPDX-License-Identifier: BSD-3-Clause
import math
import unittest

from prf_experiments.robot import findings
from prf_experiments.robot.findings import Expected, Heard

ARM = ("a", "b")
EXPECTED = Expected("/joint_states", "sensor_msgs/JointState", 100.0, 0.05, joints=ARM)
IMAGES = Expected("/camera/image_raw", "sensor_msgs/Image", 30.0, 0.15, frame="optical")


def heard(rate=100.0, age=0.002, jitter=0.0, count=200, joints=ARM):
    stamps = [50.0 + i / rate + (jitter if i % 2 else -jitter) for i in range(count)]
    return Heard("sensor_msgs/JointState", ["/driver"], [stamp + age for stamp in stamps], stamps, {""}, set(joints))


def red(expected, what):
    return [one for one in findings.of_topic(expected, what, 2.0) if not one.green]


class OfATopic(unittest.TestCase):
    def test_is_green_where_all_is_as_it_must_be(self):
        found = findings.of_topic(EXPECTED, heard(), 2.0)
        self.assertTrue(all(one.green for one in found), found)
        self.assertEqual(len(found), 4)

    # Fault 46: a topic silent, of another type, slow, with other names or two publishers -> red, with what to do
    def test_is_red_with_advice(self):
        for what, word in ((Heard(), "nobody"), (Heard("std_msgs/String", ["/x"]), "must be"),
                           (heard(count=2), "2 messages"), (heard(rate=10.0), "10.0 Hz"),
                           (heard(joints=("a",)), "lacks b")):
            found = red(EXPECTED, what)
            self.assertIn(word, found[0].text)
            self.assertTrue(found[0].advice)
        two = heard()
        two.publishers.append("/other")
        self.assertIn("2 publishers", red(EXPECTED, two)[0].text)

    # Fault 40, 42: stamps that stand, jitter, are late or ahead -> red
    def test_tells_stamps_that_cannot_be_used(self):
        standing = heard()
        standing.stamps = [50.0] * len(standing.stamps)
        self.assertIn("do not rise", red(EXPECTED, standing)[0].text)
        self.assertIn("jitter", red(EXPECTED, heard(jitter=0.003))[0].about)
        self.assertIn("age", red(EXPECTED, heard(age=0.2))[0].about)
        ahead = red(EXPECTED, heard(age=-0.05))
        self.assertIn("chrony", ahead[0].line())
        unknown = heard()
        unknown.stamps[3] = math.nan
        self.assertTrue(red(EXPECTED, unknown))

    def test_tells_another_frame(self):
        other = heard(rate=30.0)
        other.kind, other.frames = "sensor_msgs/Image", {"usb_cam"}
        self.assertIn("usb_cam", red(IMAGES, other)[0].text)


class OfACamera(unittest.TestCase):
    def found(self, fx=615.0, cx=320.0, distortion=(0.0,) * 5, image=(640, 480)):
        return findings.of_camera([fx, 0, cx, 0, 615.0, 240.0, 0, 0, 1], distortion, (640, 480), image)

    def test_is_green_when_calibrated(self):
        self.assertTrue(self.found().green)

    # Fault 44: intrinsics not finite, of an uncalibrated camera or of another size -> red
    def test_is_red_when_not(self):
        for wrong in (self.found(fx=0.0), self.found(fx=1.0), self.found(fx=math.nan), self.found(cx=700.0),
                      self.found(distortion=(math.inf,)), self.found(image=(1280, 720))):
            self.assertFalse(wrong.green)
            self.assertTrue(wrong.advice)


if __name__ == "__main__":
    unittest.main()
