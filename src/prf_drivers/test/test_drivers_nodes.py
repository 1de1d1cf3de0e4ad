#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Joiner and adapter together: joint states and commands in, what a driver takes out."""
import threading
import time
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64, Float64MultiArray, Int8
from std_srvs.srv import SetBool, Trigger, TriggerResponse
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from prf_msgs.msg import SpeedScale

PATIENCE = 10.0  # s, wall clock
PERIOD = 0.01


class DriversNodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.received = threading.Condition()
        cls.ticks, cls.sent, cls.codes, cls.stops, cls.scales = [], [], [], [], []
        cls.effort = 0.0  # N m, of both joints
        cls.arm = rospy.Publisher('/arm/joint_states', JointState, queue_size=100)
        cls.command = rospy.Publisher('joint_command', JointTrajectory, queue_size=100)
        cls.enable = rospy.Publisher('driver_adapter/enable', Bool, queue_size=10)
        cls.speed = rospy.Publisher('driver_adapter/speed', Float64, queue_size=10)
        cls.subscribers = [rospy.Subscriber('joint_states', JointState, cls.store, cls.ticks),
                           rospy.Subscriber('/group/command', Float64MultiArray, cls.store, cls.sent),
                           rospy.Subscriber('speed_scale', SpeedScale, cls.store, cls.scales),
                           rospy.Subscriber('driver_adapter/status', Int8, cls.store, cls.codes)]
        cls.service = rospy.Service('/driver/stop', Trigger, cls.stopped)
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end and not all(
                one.get_num_connections() for one in (cls.arm, cls.command, cls.enable, cls.speed, *cls.subscribers)):
            time.sleep(0.05)
        cls.stamp = rospy.Time(1000)

    @classmethod
    def store(cls, message, into):
        with cls.received:
            into.append(message)
            cls.received.notify_all()

    @classmethod
    def stopped(cls, _):
        cls.stops.append(True)
        return TriggerResponse(success=True)

    def wait(self, condition, what):
        with self.received:
            self.assertTrue(self.received.wait_for(condition, PATIENCE), what)

    def tick(self, velocity=0.1, positions=(0.2, 0.1)):
        """One tick through both nodes; returns what the driver was sent."""
        type(self).stamp += rospy.Duration(PERIOD)
        count, ticks = len(self.sent), len(self.ticks)
        state = JointState(name=['joint_a', 'joint_b'], position=[0.1, 0.2], effort=[self.effort] * 2)
        state.header.stamp = self.stamp
        self.arm.publish(state)
        self.wait(lambda: len(self.ticks) > ticks, 'no tick')
        command = JointTrajectory(joint_names=['joint_b', 'joint_a'])
        command.header.stamp = self.stamp
        command.points = [JointTrajectoryPoint(positions=list(positions), velocities=[velocity, 0.0])]
        self.command.publish(command)
        self.wait(lambda: len(self.sent) > count, 'nothing for the driver')
        return self.sent[-1].data

    def moves(self):
        """Whether the arm is moved; between two ticks the adapter holds by its own clock."""
        return any(self.tick()[0] > 0.0 for _ in range(10))

    def press(self, pressed=True):
        self.enable.publish(pressed)
        time.sleep(0.1)

    def test_1_follows_in_the_drivers_order_while_the_switch_is_pressed(self):
        self.press()
        self.assertTrue(self.moves())
        self.assertTrue(any(abs(one.data[0] - 0.1) < 1e-6 and abs(one.data[1]) < 1e-6 for one in self.sent))
        self.assertEqual(self.ticks[-1].header.stamp, self.stamp)

    # Fault 46: the dead-man's switch is no longer heard -> velocities go to 0 and stay there
    def test_2_holds_when_the_switch_is_released_or_silent(self):
        self.press(False)
        for _ in range(5):
            data = self.tick()
        self.assertEqual(tuple(data), (0.0, 0.0))
        self.press()
        self.assertTrue(self.moves())
        time.sleep(0.7)
        for _ in range(5):
            data = self.tick()
        self.assertEqual(tuple(data), (0.0, 0.0))

    # Fault 1, 46: a command that is not finite, without a joint -> held, told in the status
    def test_3_holds_on_a_command_that_cannot_be_used(self):
        self.press()
        self.moves()
        for bad in (float('nan'), 1e300):
            self.press()
            self.tick(positions=(bad, 0.1))
            for _ in range(4):
                data = self.tick(positions=(bad, 0.1))
            self.assertEqual(tuple(data), (0.0, 0.0))
        self.wait(lambda: self.codes and self.codes[-1].data == 10, 'status')

    def test_4_stops_with_the_drivers_own_stop_until_reset(self):
        stop = rospy.ServiceProxy('driver_adapter/stop', Trigger)
        reset = rospy.ServiceProxy('driver_adapter/reset', Trigger)
        self.assertIn('/driver/stop called', stop().message)
        self.assertEqual(len(self.stops), 1)
        self.press()
        for _ in range(5):
            data = self.tick()
        self.assertEqual(tuple(data), (0.0, 0.0))
        self.assertTrue(reset().success)
        self.press()
        self.assertTrue(self.moves())

    def test_5_holds_and_goes_on(self):
        hold = rospy.ServiceProxy('driver_adapter/hold', SetBool)
        hold(True)
        self.press()
        for _ in range(5):
            data = self.tick()
        self.assertEqual(tuple(data), (0.0, 0.0))
        hold(False)
        self.press()
        self.assertTrue(self.moves())

    # Fault 56: an effort beyond its learnt bounds -> protective stop, told in the status, until reset
    def test_7_stops_at_an_effort_beyond_its_bounds(self):
        self.press()
        self.assertTrue(self.moves())
        self.effort = 9.0
        self.press()
        for _ in range(5):
            data = self.tick()
        self.effort = 0.0
        self.assertEqual(tuple(data), (0.0, 0.0))
        self.wait(lambda: self.codes[-1].data == 11, 'status')
        self.press()
        self.assertFalse(self.moves())
        rospy.ServiceProxy('driver_adapter/reset', Trigger)()
        self.press()
        self.assertTrue(self.moves())

    def test_8_goes_at_the_speed_that_the_operator_allows_and_announces_it(self):
        self.press()
        self.speed.publish(0.1)
        time.sleep(0.1)
        self.press()
        self.tick()
        self.wait(lambda: self.scales and self.scales[-1].scale == 0.1, 'speed_scale')
        self.assertTrue(any(0.0 < self.tick(velocity=0.4)[0] <= 0.0500001 for _ in range(10)))
        for bad in (float('nan'), 1.5, -0.1):
            self.speed.publish(bad)
        time.sleep(0.1)
        self.press()
        self.tick()
        self.assertEqual(self.scales[-1].scale, 0.1)
        self.speed.publish(0.0)
        time.sleep(0.1)
        self.press()
        for _ in range(3):  # it brakes
            self.tick()
        self.assertFalse(self.moves())
        self.speed.publish(1.0)
        self.press()
        self.assertTrue(self.moves())

    # Fault 50: ticks and commands stop coming -> the arm is held by the adapter's own clock
    def test_9_holds_when_nothing_comes_any_more(self):
        self.press()
        self.assertTrue(self.moves())
        self.wait(lambda: tuple(self.sent[-1].data) == (0.0, 0.0), 'it goes on')


if __name__ == '__main__':
    rospy.init_node('test_drivers_nodes')
    rostest.rosrun('prf_drivers', 'drivers_nodes', DriversNodes)
