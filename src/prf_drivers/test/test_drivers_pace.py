#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A driver that queues and tells its joints slowly: the ticks and its messages keep the period all the same."""
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

PERIOD = 0.02  # s, of the driver
SECONDS = 2.0


class DriversPace(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ticks, cls.sent, cls.speed = [], [], 0.2
        cls.arm = rospy.Publisher('/arm/joint_states', JointState, queue_size=100)
        cls.command = rospy.Publisher('joint_command', JointTrajectory, queue_size=100)
        cls.subscribers = [
            rospy.Subscriber('joint_states', JointState, cls.answer),
            rospy.Subscriber('/group/command', Float64MultiArray,
                             lambda message: cls.sent.append((time.monotonic(), message.data[0])))]
        end = time.monotonic() + 20.0
        while time.monotonic() < end and not all(
                one.get_num_connections() for one in (cls.arm, cls.command, *cls.subscribers)):
            time.sleep(0.05)
        cls.moves = threading.Event()
        cls.moves.set()
        cls.thread = threading.Thread(target=cls.tell, daemon=True)
        cls.thread.start()
        time.sleep(0.5)

    @classmethod
    def tell(cls):
        """The arm's own joint states, at a fifth of the driver's rate, of a joint that turns."""
        while cls.moves.is_set() and not rospy.is_shutdown():
            now = rospy.Time.now()
            state = JointState(name=['joint_a'], position=[cls.speed * (now.to_sec() % 100.0)], velocity=[cls.speed])
            state.header.stamp = now
            cls.arm.publish(state)
            time.sleep(5 * PERIOD)

    @classmethod
    def answer(cls, tick):
        """A command for each tick, as the controller gives it."""
        cls.ticks.append(tick)
        command = JointTrajectory(joint_names=['joint_a'])
        command.header.stamp = tick.header.stamp
        command.points = [JointTrajectoryPoint(positions=list(tick.position), velocities=[cls.speed])]
        cls.command.publish(command)

    def test_1_ticks_are_filled_in_and_messages_keep_the_pace(self):
        begin, first = len(self.ticks), len(self.sent)
        time.sleep(SECONDS)
        ticks, sent = self.ticks[begin:], self.sent[first:]
        wanted = SECONDS / PERIOD
        self.assertGreater(len(ticks), 0.7 * wanted)
        self.assertLess(len(ticks), 1.3 * wanted)
        self.assertGreater(len(sent), 0.7 * wanted)
        self.assertLess(len(sent), 1.3 * wanted)  # a driver that queues must not get more
        stamps = np.array([tick.header.stamp.to_sec() for tick in ticks])
        self.assertTrue(np.all(np.diff(stamps) > 0.0))
        off = [abs(tick.position[0] - self.speed * (stamp % 100.0)) for tick, stamp in zip(ticks, stamps)]
        self.assertLess(np.median(off), 1e-3)  # along its velocity, not where it was told last

    # Fault 50: the arm's driver falls silent -> no tick is made up beyond max_age, the arm is held
    def test_2_nothing_is_filled_in_for_a_driver_that_is_silent(self):
        self.moves.clear()
        self.thread.join(2.0)
        time.sleep(1.5)  # max_age and command_timeout
        count = len(self.ticks)
        time.sleep(0.5)
        self.assertEqual(len(self.ticks), count)
        self.assertEqual(self.sent[-1][1], 0.0)
        self.assertGreater(self.sent[-1][0], time.monotonic() - 0.5)  # and goes on to say so


if __name__ == '__main__':
    rospy.init_node('test_drivers_pace')
    rostest.rosrun('prf_drivers', 'drivers_pace', DriversPace)
