# SPDX-License-Identifier: BSD-3-Clause
"""Demonstrations read from bags, by the module and by elte_edit."""
import os
import subprocess
import tempfile
import unittest

import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import Pose, PoseStamped

import elte_planner
from prf_msgs.msg import SkillTrajectory

COMMAND = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python", "commands", "elte_edit")
TURN = [0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)]  # a quarter about z


def pose(x, y, z, turn=(0.0, 0.0, 0.0, 1.0)):
    result = Pose()
    result.position.x, result.position.y, result.position.z = x, y, z
    (result.orientation.x, result.orientation.y, result.orientation.z,
     result.orientation.w) = turn
    return result


def stamped(time, content, frame="arm"):
    message = PoseStamped(pose=content)
    message.header.stamp, message.header.frame_id = rospy.Time.from_sec(time), frame
    return message


def plan(y, shift):
    message = SkillTrajectory(goal_in_target=pose(-0.3, 0.0, 0.1))
    message.header.frame_id = "arm"
    message.poses = [pose(0.1 * k, y + shift, 0.3, TURN) for k in range(6)]
    message.time_from_start = [rospy.Duration.from_sec(0.5 * k) for k in range(6)]
    return message


class Bag(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "demo.bag")
        with rosbag.Bag(self.path, "w") as bag:
            for k in range(20):
                time = 10.0 + 0.1 * k
                bag.write("/hand", stamped(time, pose(0.02 * k, 0.001 * k * k, 0.3)),
                          rospy.Time.from_sec(time))
                bag.write("/tag", stamped(time, pose(1.0, 0.01 * k, 0.5)),
                          rospy.Time.from_sec(time))
                bag.write("/elsewhere", stamped(time, pose(1.0, 0.0, 0.5), "map"),
                          rospy.Time.from_sec(time))
            for k, message in enumerate((plan(0.0, 0.0), plan(0.0, 0.2), SkillTrajectory())):
                bag.write("/skill/trajectory", message, rospy.Time.from_sec(12.0 + k))

    def test_poses_become_a_demonstration_with_its_target(self):
        demonstration = elte_planner.load_bag(self.path, "hand", "tag")
        self.assertEqual(demonstration.frame, "arm")
        np.testing.assert_allclose(demonstration.times, 0.1 * np.arange(20), atol=1e-9)
        np.testing.assert_array_equal(demonstration.positions[7], [0.02 * 7, 0.049, 0.3])
        np.testing.assert_array_equal(demonstration.target, [1.0, 0.19, 0.5, 0, 0, 0, 1])
        alone = elte_planner.load_bag(self.path, "/hand")
        np.testing.assert_array_equal(alone.target[:3], alone.positions[-1])

    def test_the_last_plan_is_taken_with_the_target_that_it_was_made_for(self):
        demonstration = elte_planner.load_bag(self.path, "skill/trajectory")
        np.testing.assert_allclose(demonstration.times, 0.5 * np.arange(6))
        np.testing.assert_allclose(demonstration.positions[-1], [0.5, 0.2, 0.3])
        # The hand, turned by a quarter, ends at (-0.3, 0, 0.1) of the target.
        np.testing.assert_allclose(demonstration.target, [0.5, 0.5, 0.2, *TURN], atol=1e-15)

    def test_what_cannot_be_one_is_refused_with_the_reason(self):
        for arguments, reason in ((("none",), "nothing on topic 'none'"),
                                  (("hand", "none"), "nothing on topic 'none'"),
                                  (("hand", "elsewhere"), "frame 'map', must be in 'arm'"),
                                  (("hand", "skill/trajectory"), "must be a geometry_msgs")):
            with self.assertRaisesRegex(ValueError, reason):
                elte_planner.load_bag(self.path, *arguments)
        with open(self.path, "r+b") as file:
            file.truncate(3000)
        with self.assertRaisesRegex(ValueError, "demo.bag"):
            elte_planner.load_bag(self.path, "hand")

    def test_is_edited_from_the_shell(self):
        run = subprocess.run(
            ["/usr/bin/python3", COMMAND, self.path, "--topic", "hand", "--end", "0.4", "0.3", "0.3"],
            text=True, timeout=60, capture_output=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("solved: 50 nodes, end 0 m", run.stdout)


if __name__ == "__main__":
    unittest.main()
