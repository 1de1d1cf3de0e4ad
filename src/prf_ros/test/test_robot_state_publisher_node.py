#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Frames of good joint_states only; what is wrong with the input is said in the log and in the
diagnostics. The first test waits until the node has missed its input for 5 s."""
import math
import subprocess
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage


def joints(stamp, position=0.5, name="elbow", **changes):
    message = JointState(name=[name], position=[position], **changes)
    message.header.stamp = rospy.Time.from_sec(stamp)
    return message


class RobotStatePublisher(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("driver")
        cls.lines, cls.reports, cls.stamps = [], [], []
        rospy.Subscriber("/rosout", Log, lambda log: cls.lines.append(log.msg))
        rospy.Subscriber("/diagnostics", DiagnosticArray, lambda array: cls.reports.extend(array.status))
        rospy.Subscriber("/tf", TFMessage, lambda tf: cls.stamps.append(
            round(tf.transforms[0].header.stamp.to_sec(), 3)))
        cls.publisher = None

    def wait_for(self, condition, what, seconds=15.0):
        end = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: {self.lines[-5:]} {self.reports[-1:]}")
            time.sleep(0.02)

    def says(self, *parts):
        self.wait_for(lambda: any(all(part in line for part in parts) for line in self.lines), parts)

    def reports_at(self, level, *parts):
        self.wait_for(lambda: any(report.level == level and all(p in report.message for p in parts)
                                  for report in self.reports), parts)

    def connect(self):
        if self.publisher is None:
            type(self).publisher = rospy.Publisher("joint_states", JointState, queue_size=100)
        self.wait_for(lambda: self.publisher.get_num_connections() > 0, "no subscriber")
        del self.lines[:], self.reports[:], self.stamps[:]

    # Fault 46: joint_states never come -> after 5 s a line and ERROR say what is expected, and of whom
    def test_1_tells_that_joint_states_do_not_come(self):
        self.says("no message on joint_states for", "sensor_msgs/JointState", "elbow", "at 100 Hz",
                  "publishers: none")
        self.reports_at(DiagnosticStatus.ERROR, "no message on joint_states", "elbow")

    # Fault 1, 27, 40, 42, 43: NaN, absurd, late, early, doubled, endless, legs only -> dropped; the rest passes
    def test_2_drops_what_gives_no_frames_and_goes_on(self):
        self.connect()
        wrong = [joints(100.0, math.nan), joints(100.0, 1e300), joints(100.0, name="leg"),
                 joints(4294967290.0), joints(900.0), joints(99.99), joints(3.0)]
        wrong.append(joints(100.0))
        wrong[-1].position = []
        expected = []
        for i in range(40):
            stamp = 100.0 + 0.01 * i
            self.publisher.publish(joints(stamp))
            self.publisher.publish(wrong[i % len(wrong)] if i % 5 else joints(stamp))
            expected.append(round(stamp, 3))
        self.wait_for(lambda: len(self.stamps) >= 40, "not all frames")
        time.sleep(0.2)
        self.assertEqual(self.stamps, expected)
        for reason in ("the position of elbow is no joint position", "it has no joint of the robot",
                       "elbow has no position", "near the end of ROS time", "is far ahead",
                       "is older than one that came before", "came before"):
            self.says("joint_states dropped", reason)
        self.reports_at(DiagnosticStatus.WARN, "joint_states dropped")
        values = {value.key: value.value for value in self.reports[-1].values}
        self.assertGreater(int(values["joint_states dropped: it has no joint of the robot"]), 0)

    # Fault 11: the clock goes back -> frames again from the third message on
    def test_3_follows_a_clock_that_goes_back(self):
        self.connect()
        for stamp in (50.0, 50.01, 50.02, 50.03):
            self.publisher.publish(joints(stamp))
        self.wait_for(lambda: len(self.stamps) >= 2, "no frames of the new run")
        self.assertEqual(self.stamps, [50.02, 50.03])

    # Fault 46: joint_states at a tenth of their rate -> WARN with both rates
    def test_4_tells_a_rate_that_is_too_low(self):
        self.connect()
        for i in range(25):
            self.publisher.publish(joints(51.0 + 0.1 * i))
        self.says("joint_states comes at 10 Hz", "at 100 Hz")
        self.reports_at(DiagnosticStatus.WARN, "joint_states comes at 10 Hz", "at 100 Hz")

    # Fault 40: a second publisher of joint_states -> named in a line
    def test_5_names_a_second_publisher(self):
        self.connect()
        other = subprocess.Popen(
            ["rostopic", "pub", "-r", "20", "joint_states", "sensor_msgs/JointState", "{name: [elbow]}",
             "__name:=copy"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(other.wait)
        self.addCleanup(other.kill)
        stamp = 60.0
        while not any("two publishers" in line for line in self.lines):
            self.publisher.publish(joints(stamp))
            stamp += 0.01
            self.assertLess(stamp, 80.0, "no second publisher was reported")
            time.sleep(0.01)
        self.says("joint_states has two publishers", rospy.get_name(), "/copy")


if __name__ == "__main__":
    rostest.rosrun("prf_ros", "robot_state_publisher", RobotStatePublisher)
