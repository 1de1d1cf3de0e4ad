#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""target_predictor_node from outside: every image gives one forecast, in order, the same
whatever the order in which detections and tf arrive."""
import io
import math
import subprocess
import sys
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from prf_msgs.msg import TagDetection, TagDetectionArray, TargetForecast

PACKAGE = "prf_predictor"
BASE, ARM, CAMERA = "j2s7s300_link_base", "moving_arm", "camera_optical_frame"
TF_PERIOD, FRAMES = 0.01, 12
INTRUDER = """
import rospy
from prf_msgs.msg import TagDetectionArray
rospy.init_node("intruder")
images = rospy.Publisher("tag_detections", TagDetectionArray, queue_size=10)
array = TagDetectionArray()
array.header.stamp = rospy.Time.from_sec(100.0)
while True:
    images.publish(array)
    rospy.rostime.wallsleep(0.1)
"""


def transform(parent, child, stamp, xyz, yaw=0.0):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = parent, rospy.Time.from_sec(stamp)
    message.transform.translation.x, message.transform.translation.y, \
        message.transform.translation.z = xyz
    message.transform.rotation.z = math.sin(yaw / 2)
    message.transform.rotation.w = math.cos(yaw / 2)
    return message


def arm_tf(stamp):
    """The camera's carrier sways and turns."""
    stamp = round(stamp, 3)
    phase = 2.0 * (stamp % 1000)
    return TFMessage([transform(BASE, ARM, stamp, (0.1 * math.sin(phase), 0.0, 0.5),
                                yaw=0.2 * math.cos(phase))])


def detections(stamp, xyz=(0.0, 0.0, 0.5), tag_id=0, frame=CAMERA, count=1):
    array = TagDetectionArray()
    array.header.stamp, array.header.frame_id = rospy.Time.from_sec(stamp), frame
    for _ in range(count):
        detection = TagDetection(family="tag36h11", id=tag_id)
        pose = detection.pose.pose
        pose.position.x, pose.position.y, pose.position.z = xyz
        pose.orientation.x = 1.0
        detection.pose.covariance = list((1e-6 * np.eye(6)).flatten())
        array.detections.append(detection)
    return array


def image_stamps(start):
    return [start + round(k * 1000 / 30) / 1000 for k in range(FRAMES)]


def content(message):
    message.header.seq = 0
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


class TargetPredictorNode(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("target_predictor_test")
        cls.forecasts = []
        cls.images = rospy.Publisher("tag_detections", TagDetectionArray, queue_size=100)
        cls.tf = rospy.Publisher("/tf", TFMessage, queue_size=1000)
        cls.tf_static = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        cls.subscriber = rospy.Subscriber("target/forecast", TargetForecast, cls.forecasts.append)
        cls.tf_static.publish(TFMessage([transform(ARM, CAMERA, 1.0, (0.0, 0.07, -0.12))]))
        cls.wait(lambda: all(p.get_num_connections()
                             for p in (cls.images, cls.tf, cls.tf_static, cls.subscriber)))

    @staticmethod
    def wait(condition, seconds=20.0):
        for _ in range(int(seconds / 0.01)):
            if condition():
                return
            rospy.rostime.wallsleep(0.01)
        raise AssertionError("waited in vain")

    def expect(self, count):
        self.wait(lambda: len(self.forecasts) >= count)
        rospy.rostime.wallsleep(0.1)
        self.assertEqual(len(self.forecasts), count, "exactly one forecast for every image")
        return self.forecasts[-1]

    def setUp(self):
        """Every test gets a run of its own, by stamps that go back far."""
        self.begin_run()

    def begin_run(self):
        for stamp in (5000.0, 5000.03, 5000.06):  # so many prove a jump
            self.tf.publish(arm_tf(stamp))
            self.images.publish(detections(stamp, count=0))
        rospy.rostime.wallsleep(0.1)
        for stamp in (99.9, 99.93, 99.96):
            self.images.publish(detections(stamp, count=0))
        rospy.rostime.wallsleep(0.3)
        self.forecasts.clear()

    def send_tf(self, first, last):
        for k in range(round((last - first) / TF_PERIOD) + 1):
            self.tf.publish(arm_tf(first + k * TF_PERIOD))

    def test_one_image_gives_one_forecast(self):
        self.send_tf(100.0, 100.1)
        self.images.publish(detections(100.033))
        forecast = self.expect(1)
        self.assertEqual(forecast.header.stamp, rospy.Time.from_sec(100.033))
        self.assertEqual(forecast.header.frame_id, BASE)
        self.assertEqual(forecast.status, TargetForecast.TRACKING)
        self.assertTrue(forecast.measured)
        self.assertEqual([p.horizon.to_sec() for p in forecast.predictions],
                         [0.0, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0])
        arm = [arm_tf(100.03).transforms[0], arm_tf(100.04).transforms[0]]
        weight = (100.033 - 100.03) / TF_PERIOD
        yaw = sum(w * 2 * math.atan2(t.transform.rotation.z, t.transform.rotation.w)
                  for w, t in zip((1 - weight, weight), arm))
        shift = sum(w * t.transform.translation.x for w, t in zip((1 - weight, weight), arm))
        position = forecast.predictions[0].pose.position
        self.assertAlmostEqual(position.x, shift - 0.07 * math.sin(yaw), delta=1e-5)
        self.assertAlmostEqual(position.y, 0.07 * math.cos(yaw), delta=1e-5)
        self.assertAlmostEqual(position.z, 0.5 - 0.12 + 0.5, delta=1e-9)
        for prediction in forecast.predictions:
            covariance = np.reshape(prediction.covariance, (6, 6))
            self.assertGreater(np.linalg.eigvalsh(covariance).min(), 0.0)

    # Fault 6: no tf at the start -> an empty image gives a forecast of no target
    def test_empty_image_needs_no_tf_and_gives_no_target(self):
        self.images.publish(detections(100.0, count=0))
        forecast = self.expect(1)
        self.assertEqual(forecast.status, TargetForecast.NO_TARGET)
        self.assertEqual(forecast.predictions, [])

    # Fault 5: tf comes late -> the image waits for it
    def test_waits_for_tf_after_the_stamp_even_when_it_is_a_sample(self):
        for count, (stamp, after) in enumerate([(100.033, 100.04), (100.05, 100.06)], start=1):
            self.send_tf(after - 0.02, after - TF_PERIOD)
            self.images.publish(detections(stamp))
            rospy.rostime.wallsleep(0.3)
            self.assertEqual(len(self.forecasts), count - 1)
            self.tf.publish(arm_tf(after))
            self.assertTrue(self.expect(count).measured)

    def test_order_of_arrival_does_not_change_a_bit(self):
        stamps = image_stamps(100.0)
        end = stamps[-1] + 0.02

        def tf_first():
            self.send_tf(99.99, end)
            rospy.rostime.wallsleep(0.3)
            for stamp in stamps:
                self.images.publish(detections(stamp))

        def tf_last():
            for stamp in stamps:
                self.images.publish(detections(stamp))
            rospy.rostime.wallsleep(0.3)
            self.send_tf(99.99, end)

        def in_step(pause):
            self.tf.publish(arm_tf(99.99))
            ticks = [100.0 + k * TF_PERIOD for k in range(round((end - 100.0) / TF_PERIOD) + 1)]
            pending = list(stamps)
            for tick in ticks:
                while pending and pending[0] <= tick:
                    self.images.publish(detections(pending.pop(0)))
                rospy.rostime.wallsleep(pause)
                self.tf.publish(arm_tf(tick))

        reference = None
        for order in (tf_first, tf_last, lambda: in_step(0.0), lambda: in_step(0.01)):
            self.begin_run()
            order()
            self.expect(len(stamps))
            found = [content(forecast) for forecast in self.forecasts]
            self.assertTrue(all(forecast.measured for forecast in self.forecasts))
            reference = reference or found
            self.assertTrue(found == reference, "some forecast differs")

    # Fault 1, 4, 16: NaN, another id, an unknown frame, an outlier -> a forecast without measurement
    def test_unusable_detections_give_a_forecast_without_measurement(self):
        self.send_tf(100.0, 101.0)
        rospy.rostime.wallsleep(0.3)
        self.images.publish(detections(100.05))
        self.assertTrue(self.expect(1).measured)
        cases = [detections(100.1, xyz=(math.nan, 0.0, 0.5)), detections(100.15, tag_id=3),
                 detections(100.2, frame="nowhere"), detections(100.25, frame=""),
                 detections(100.3, xyz=(0.0, 0.5, 0.5))]
        for count, case in enumerate(cases, start=2):
            self.images.publish(case)
            forecast = self.expect(count)
            self.assertFalse(forecast.measured)
            self.assertTrue(all(math.isfinite(v) for p in forecast.predictions
                                for v in p.covariance))
        self.images.publish(detections(100.35))
        self.assertTrue(self.expect(len(cases) + 2).measured)

    def test_image_before_all_tf_is_processed_at_once(self):
        self.send_tf(100.0, 100.1)
        self.images.publish(detections(99.9))
        self.assertFalse(self.expect(1).measured)

    # Fault 5: tf never comes -> the image is given up by the stamps of later ones
    def test_gives_up_on_silent_tf_by_the_stamps_of_images(self):
        self.images.publish(detections(100.0))
        self.images.publish(detections(100.4))
        rospy.rostime.wallsleep(0.3)
        self.assertEqual(self.forecasts, [])
        self.images.publish(detections(100.6))
        self.assertEqual(self.expect(1).status, TargetForecast.NO_TARGET)

    # Fault 10, 40: a lone stamp far ahead -> dropped
    def test_lone_stamp_far_in_the_future_is_dropped(self):
        self.send_tf(100.0, 100.4)
        rospy.rostime.wallsleep(0.3)
        for stamp in (100.05, 900.0, 100.1, 3000.0, 800.0, 100.15):
            self.images.publish(detections(stamp))
        self.expect(3)
        self.assertEqual([round(f.header.stamp.to_sec(), 3) for f in self.forecasts],
                         [100.05, 100.1, 100.15])
        self.assertTrue(all(f.measured and f.status == TargetForecast.TRACKING
                            for f in self.forecasts))

    # Fault 13: the clock leaps forward -> followed once several stamps agree, the target is lost
    def test_time_that_goes_on_after_a_leap_is_followed(self):
        self.send_tf(100.0, 100.1)
        self.images.publish(detections(100.05))
        self.expect(1)
        self.send_tf(900.0, 900.2)
        for stamp in (900.05, 900.08):
            self.images.publish(detections(stamp))
        rospy.rostime.wallsleep(0.2)
        self.assertEqual(len(self.forecasts), 1)
        for stamp in (900.1, 900.15):
            self.images.publish(detections(stamp))
        self.expect(3)
        self.assertEqual([round(f.header.stamp.to_sec(), 3) for f in self.forecasts],
                         [100.05, 900.1, 900.15])
        self.assertTrue(all(f.status == TargetForecast.LOST for f in self.forecasts[1:]))

    # Fault 41, 42: tf of unrelated frames, stamps at the end of ROS time -> ignored, dropped
    def test_foreign_tf_and_stamps_at_the_end_of_time_cost_nothing(self):
        self.send_tf(100.0, 100.2)
        for k, stamp in enumerate((100.05, 100.1, 100.15), start=1):
            for wrong in (0.0, stamp - 1.5, stamp + 2.0, 4294967295.0):
                self.tf.publish(TFMessage([transform("map", "odom", wrong, (1.0, 0.0, 0.0)),
                                           transform(ARM, "lamp", wrong, (math.nan, 0.0, 0.0))]))
            self.tf.publish(TFMessage([transform(BASE, ARM, 4294967295.0, (1.0, 0.0, 0.0))]))
            self.images.publish(detections(4294967295.0))
            self.images.publish(detections(stamp))
            self.assertTrue(self.expect(k).measured)

    # Fault 19, 40: a second publisher of tag_detections -> named in the diagnostics
    def test_second_publisher_is_reported(self):
        texts: list[str] = []
        subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: texts.extend(
            status.message for status in message.status))

        def is_named():
            return any("two publishers" in text and "/intruder" in text for text in texts)

        intruder = subprocess.Popen([sys.executable, "-c", INTRUDER])
        try:
            for k in range(400):
                self.images.publish(detections(100.0 + 0.03 * k, count=0))
                rospy.rostime.wallsleep(0.03)
                if is_named():
                    break
            self.assertTrue(is_named(), texts[-3:])
        finally:
            intruder.kill()
            intruder.wait()
            subscriber.unregister()


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "target_predictor_node", "__main__", sys.argv)
