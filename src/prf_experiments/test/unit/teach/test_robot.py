# SPDX-License-Identifier: BSD-3-Clause
"""A real arm that was led by the hand, as its bag tells."""
import os
import sys
import tempfile
import unittest

import numpy as np
import rosbag
from sensor_msgs.msg import JointState

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.record import recording
from prf_experiments.teach import demonstration, robot, teaching

UPRIGHT = [0.5, 0.5, 0.5, 0.5]


class TaughtRobot(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bag, self.out = (os.path.join(folder.name, name) for name in ("taught.bag", "skill.csv"))

    def write(self, joint_speed=0.2):
        """A hand that goes 0.3 m from 1.0 to 3.5 s; meanwhile a joint turns at that speed, rad/s."""
        data = synthetic.make_recording(5.0)
        seconds = data.seconds(data.ticks)
        way = np.clip(seconds - 1.0, 0.0, 2.5)
        places = np.column_stack([0.3 + 0.12 * way, 0.0 * way, 0.5 + 0.0 * way])
        hand = np.hstack([places, np.tile(UPRIGHT, (len(way), 1))])
        synthetic.write_bag(self.bag, data, hand=hand)
        with rosbag.Bag(self.bag) as bag:
            kept = list(bag.read_messages(return_connection_header=True))
        turned = dict(zip(map(int, data.ticks), joint_speed * way))
        with rosbag.Bag(self.bag, "w") as bag:
            for topic, message, stamp, header in kept:
                if topic == "/joint_states":
                    at = turned[message.header.stamp.to_nsec()]
                    states = JointState(name=recording.ARM_JOINTS, position=[0.0, 3.0, at, 1.0, 0.0, 2.0, 0.0])
                    states.header.stamp = message.header.stamp
                    bag.write(topic, states, stamp)
                else:
                    bag.write(topic, message, stamp, connection_header=header)

    def test_is_trimmed_stretched_drawn_and_written(self):
        self.write()
        self.assertEqual(robot.main([self.out, "--bag", self.bag]), 0)
        whole = demonstration.read(self.out)
        self.assertAlmostEqual(whole.times[-1], 2.5, delta=0.05)
        with open(os.path.splitext(self.out)[0] + ".png", "rb") as stream:
            self.assertEqual(stream.read(8), b"\x89PNG\r\n\x1a\n")
        self.assertEqual(robot.main([self.out, "--bag", self.bag, "--cut", "0.5", "0.25", "--stretch", "2"]), 0)
        part = demonstration.read(self.out)
        self.assertAlmostEqual(part.times[-1], 2.0 * 1.75, delta=0.1)
        self.assertAlmostEqual(part.poses[0][0], 0.3 + 0.12 * 0.5, delta=0.005)

    # Fault 54: an arm that was led faster than it can go, or a cut that leaves nothing -> refused, nothing written
    def test_refuses_what_the_arm_cannot_repeat(self):
        self.write(joint_speed=0.9)
        with self.assertRaisesRegex(demonstration.DemonstrationError, "--stretch 1.6"):
            robot.make(self.bag, "test", 0, (0.0, 0.0), 1.0, "")
        self.assertEqual(robot.main([self.out, "--bag", self.bag]), 1)
        self.assertFalse(os.path.exists(self.out))
        self.assertEqual(robot.main([self.out, "--bag", self.bag, "--stretch", "1.6"]), 0)
        with self.assertRaisesRegex(demonstration.DemonstrationError, "nothing is left"):
            teaching.convert(self.bag, "test", 0, (2.0, 1.0))

    def test_refuses_numbers_beyond_their_bounds(self):
        for words in (["--stretch", "0"], ["--stretch", "nan"], ["--cut", "-1", "0"], ["--seconds", "0"]):
            with self.assertRaises(SystemExit) as caught:
                robot.main([self.out, "--bag", self.bag, *words])
            self.assertEqual(caught.exception.code, 2)

    # Fault 54: no master, so no arm can be recorded -> one line, exit code 1
    def test_says_that_nothing_runs(self):
        before = os.environ.get("ROS_MASTER_URI", "")
        os.environ["ROS_MASTER_URI"] = "http://localhost:1"
        try:
            self.assertEqual(robot.main([self.out, "--driver", "kinova"]), 1)
        finally:
            os.environ["ROS_MASTER_URI"] = before


if __name__ == "__main__":
    unittest.main()
