#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The node alone: one tick and one set-point in, one command and one status out."""
import math
import random
import threading
import unittest

import rospy
import rostest
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import Transform, Twist
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, MultiDOFJointTrajectory, MultiDOFJointTrajectoryPoint

from prf_msgs.msg import ControlStatus

ARM = ['j2s7s300_joint_%d' % i for i in range(1, 8)]
LEGS = ['fl_hip', 'fl_knee']
HOME = [0.0, 3.6, 0.0, 1.6, 0.0, 2.0, 0.0]
TICK = 0.01
PATIENCE = 10.0  # s, wall clock
VELOCITY = [math.radians(36)] * 4 + [math.radians(48)] * 3  # limits, rad/s
FULL = {'velocity_scale': 0.95, 'acceleration': 4.0}  # of the package's configuration


def joint_state(stamp, positions, shuffled=False):
    names = ARM + LEGS
    values = list(positions) + [0.1, 0.2]
    if shuffled:
        names, values = names[::-1], values[::-1]
    message = JointState(name=names, position=values)
    message.header.stamp = stamp
    return message


def setpoint(stamp, position=(0.4, 0.0, 0.5), rotation=(0.5, 0.5, 0.5, 0.5),
             frame='j2s7s300_link_base', hand='j2s7s300_end_effector'):
    message = MultiDOFJointTrajectory(joint_names=[hand])
    message.header.stamp = stamp
    message.header.frame_id = frame
    transform = Transform()
    transform.translation.x, transform.translation.y, transform.translation.z = position
    (transform.rotation.x, transform.rotation.y, transform.rotation.z,
     transform.rotation.w) = rotation
    message.points = [MultiDOFJointTrajectoryPoint(transforms=[transform], velocities=[Twist()])]
    return message


def hold(stamp):
    message = setpoint(stamp)
    message.points = []
    return message


class ArmControllerNode(unittest.TestCase):
    """Each test is a run of its own: its stamps begin before those of the last one."""
    run_begin = 100000

    @classmethod
    def setUpClass(cls):
        cls.received = threading.Condition()
        cls.commands, cls.statuses = [], []
        cls.joints = rospy.Publisher('joint_states', JointState, queue_size=1000)
        cls.setpoints = rospy.Publisher('execution/setpoint', MultiDOFJointTrajectory, queue_size=1000)
        cls.subscribers = [
            rospy.Subscriber('joint_command', JointTrajectory, cls.store, cls.commands),
            rospy.Subscriber('control/status', ControlStatus, cls.store, cls.statuses)]
        deadline = rospy.get_time() + PATIENCE
        while (min(cls.joints.get_num_connections(), cls.setpoints.get_num_connections(),
                   *(s.get_num_connections() for s in cls.subscribers)) == 0
               and rospy.get_time() < deadline):
            rospy.sleep(0.02)

    @classmethod
    def store(cls, message, messages):
        with cls.received:
            messages.append(message)
            cls.received.notify_all()

    def setUp(self):
        ArmControllerNode.run_begin -= 1000
        for tick in (-3, -2, -1):  # several in a row show that the clock went back
            self.joints.publish(joint_state(self.stamp(tick), HOME))
            self.setpoints.publish(hold(self.stamp(tick)))
        with self.received:
            self.assertTrue(self.received.wait_for(
                lambda: all(one and one[-1].header.stamp == self.stamp(-1)
                            for one in (self.commands, self.statuses)), PATIENCE))
        del self.commands[:], self.statuses[:]

    def stamp(self, tick):
        return rospy.Time.from_sec(self.run_begin) + rospy.Duration.from_sec(TICK * tick)

    def answers(self, count):
        with self.received:
            done = self.received.wait_for(
                lambda: len(self.commands) >= count and len(self.statuses) >= count, PATIENCE)
        self.assertTrue(done, '%d commands and %d statuses of %d' %
                        (len(self.commands), len(self.statuses), count))
        return list(zip(self.commands, self.statuses))

    def ask(self, tick, message, positions=HOME, shuffled=False):
        self.joints.publish(joint_state(self.stamp(tick), positions, shuffled))
        self.setpoints.publish(message)
        command, status = self.answers(tick + 1)[tick]
        for header in (command.header, status.header):
            self.assertEqual(header.stamp, self.stamp(tick))
        self.assertEqual(command.joint_names, ARM)
        self.assertEqual(len(command.points), 1)
        self.assertEqual(command.points[0].time_from_start, rospy.Duration(0, 10000000))
        for value in command.points[0].positions + command.points[0].velocities:
            self.assertTrue(math.isfinite(value))
        return command, status

    def test_one_tick_in_gives_one_command_and_one_status_of_the_same_stamp(self):
        command, status = self.ask(0, hold(self.stamp(0)))
        self.assertEqual(list(command.points[0].positions), HOME)
        self.assertEqual(status.code, ControlStatus.HOLDING)
        command, status = self.ask(1, setpoint(self.stamp(1)))
        self.assertEqual(status.code, ControlStatus.FOLLOWING, status.reason)
        self.assertNotEqual(list(command.points[0].positions), HOME)
        rospy.sleep(0.2)
        self.assertEqual((len(self.commands), len(self.statuses)), (2, 2))

    # Fault 27: joint_states in another order, with other joints -> matched by name
    def test_joints_are_matched_by_name(self):
        command, _ = self.ask(0, hold(self.stamp(0)), shuffled=True)
        self.assertEqual(list(command.points[0].positions), HOME)

    # Fault 40: a joint_states of the legs alone, whatever its stamp -> no tick, nothing is reset
    def test_joint_states_without_the_arm_are_no_tick(self):
        other = JointState(name=LEGS, position=[0.1, 0.2])
        other.header.stamp = self.stamp(50)
        self.joints.publish(other)
        command, _ = self.ask(0, hold(self.stamp(0)))
        self.assertEqual(list(command.points[0].positions), HOME)

    # Fault 46: joints of other names, or a few of the arm's -> dropped; the log names expected and received ones
    def test_other_joint_names_are_told(self):
        lines, seen = [], threading.Condition()

        def note(message):
            with seen:
                lines.append(message.msg)
                seen.notify_all()
        log = rospy.Subscriber('/rosout', Log, note)
        self.addCleanup(log.unregister)
        while log.get_num_connections() < 2:  # this node and the controller
            rospy.sleep(0.02)
        few = JointState(name=ARM[:5], position=HOME[:5])
        few.header.stamp = self.stamp(1)
        self.joints.publish(few)
        for tick in range(110):
            other = JointState(name=['panda_joint%d' % i for i in range(1, 8)], position=HOME)
            other.header.stamp = self.stamp(tick)
            self.joints.publish(other)
        for words in (('j2s7s300_joint_6, j2s7s300_joint_7', 'has', 'j2s7s300_joint_5'),
                      ('expected', 'j2s7s300_joint_1', 'received', 'panda_joint7')):
            def told(words=words):
                return any(all(word in line for word in words) for line in lines)
            with seen:
                self.assertTrue(seen.wait_for(told, PATIENCE), '%s not in %s' % (words, lines))
        self.assertEqual(len(self.commands), 0)

    # Fault 1: a measured joint that is not finite -> FAILING, the arm holds
    def test_joints_that_are_not_finite_make_it_hold(self):
        self.ask(0, hold(self.stamp(0)))
        command, status = self.ask(1, setpoint(self.stamp(1)), HOME[:6] + [float('nan')])
        self.assertEqual(status.code, ControlStatus.FAILING)
        self.assertIn('j2s7s300_joint_7', status.reason)
        self.assertEqual(list(command.points[0].positions), HOME)

    # Fault 1, 2, 43: a set-point that is not finite, absurd, of a zero quaternion or another frame ->
    # the arm holds, the reason is told
    def test_bad_setpoints_are_refused_with_the_reason(self):
        nan = float('nan')
        two = setpoint(self.stamp(7))
        two.points = two.points * 2
        catalogue = [
            (setpoint(self.stamp(1), position=(0.4, nan, 0.5)), 'position'),
            (setpoint(self.stamp(2), position=(1e9, 0.0, 0.5)), 'position'),
            (setpoint(self.stamp(3), rotation=(0.0, 0.0, 0.0, 0.0)), 'quaternion'),
            (setpoint(self.stamp(4), rotation=(nan, 0.0, 0.0, 1.0)), 'quaternion'),
            (setpoint(self.stamp(5), frame='world'), 'frame_id'),
            (setpoint(self.stamp(6), hand='elbow'), 'joint_names'),
            (two, 'one point')]
        self.ask(0, hold(self.stamp(0)))
        for tick, (message, reason) in enumerate(catalogue, start=1):
            command, status = self.ask(tick, message)
            self.assertEqual(status.code, ControlStatus.INVALID_SETPOINT, reason)
            self.assertIn(reason, status.reason)
            self.assertEqual(list(command.points[0].positions), HOME)

    # Fault 27, 38: no set-points for max_wait -> the arm holds, STALE_SETPOINT
    def test_silent_setpoints_make_it_hold_by_data_time(self):
        self.ask(0, hold(self.stamp(0)))
        for tick in range(1, 32):
            self.joints.publish(joint_state(self.stamp(tick), HOME))
        rospy.sleep(0.5)
        self.assertEqual(len(self.commands), 1)
        self.joints.publish(joint_state(self.stamp(32), HOME))
        for command, status in self.answers(33)[1:]:
            self.assertEqual(status.code, ControlStatus.STALE_SETPOINT)
            self.assertEqual(list(command.points[0].positions), HOME)

    def tune(self, **numbers):
        change = rospy.ServiceProxy('arm_controller/set_parameters', Reconfigure)
        config = Config(doubles=[DoubleParameter(*number) for number in numbers.items()])
        return {each.name: each.value for each in change(config).config.doubles}

    def move(self, first, last, share, acceleration):
        """Ticks on the way to a far set-point, the arm following at once: the greatest share of a
        velocity limit. None may be above `share` from the moment that braking can have brought it
        there, no speeding up above `acceleration`, no braking above the configured one."""
        fastest = 0.0
        for tick in range(first, last):
            before = self.commands[tick - 1].points[0]
            message = setpoint(self.stamp(tick), position=(-0.3, 0.3, 0.6))
            command = self.ask(tick, message, before.positions)[0].points[0]
            for old, new in zip(before.velocities, command.velocities):
                most = acceleration if abs(new) > abs(old) else max(acceleration, FULL['acceleration'])
                self.assertLessEqual(abs(new - old), most * TICK + 1e-9)
            now = max(abs(v) / most for v, most in zip(command.velocities, VELOCITY))
            fastest = max(fastest, now)
            if tick > first + 60:
                self.assertLessEqual(now, share + 1e-9)
        return fastest

    # Fault 29: parameters changed in motion -> applied as a whole between two ticks
    def test_tuning_is_applied_whole_while_the_arm_moves(self):
        self.assertEqual(self.tune(), FULL)
        self.addCleanup(self.tune, **FULL)
        self.ask(0, hold(self.stamp(0)))
        self.assertGreater(self.move(1, 60, 0.95, 4.0), 0.9)
        wanted = {'velocity_scale': 0.3, 'acceleration': 2.0}
        self.assertEqual(self.tune(**wanted), wanted)
        self.move(60, 140, 0.3, 2.0)
        self.assertEqual(rospy.get_param('arm_controller/acceleration'), 2.0)

    # Fault 29, 52: a change with one bad value -> refused as a whole with name and bound
    def test_tuning_is_refused_whole_with_name_and_bound(self):
        self.addCleanup(self.tune, **FULL)
        for numbers, reason in (
                ({'acceleration': 1.0, 'velocity_scale': 1.5},
                 'velocity_scale = 1.5, must be within [0.01, 1]'),
                ({'velocity_scale': 0.3, 'acceleration': -1.0},
                 'acceleration = -1, must be within [0.1, 20] rad/s^2'),
                ({'acceleration': 0.001}, 'acceleration = 0.001, must be within'),
                ({'velocity_scale': 0.3, 'acceleration': float('nan')}, 'acceleration = nan, must be finite'),
                ({'velocity_scale': 0.3, 'damping': 0.2}, 'damping cannot be changed')):
            with self.assertRaises(rospy.ServiceException) as refusal:
                self.tune(**numbers)
            self.assertIn(reason, str(refusal.exception))
        # Before any other change, which would apply the old values again.
        self.ask(0, hold(self.stamp(0)))
        self.assertGreater(self.move(1, 60, 0.95, 4.0), 0.9)
        self.assertEqual(self.tune(), FULL)

    def test_interleavings_give_identical_outputs(self):
        def outputs(seed):
            self.setUp()
            order = random.Random(seed)
            joints, points = 0, 0
            while joints < 60 or points < 60:
                if points == 60 or (joints < 60 and joints - points < 20 and order.random() < 0.5):
                    self.joints.publish(joint_state(self.stamp(joints), HOME))
                    joints += 1
                else:
                    y = 0.02 * math.sin(0.1 * points)
                    self.setpoints.publish(setpoint(self.stamp(points), position=(0.4, y, 0.5)))
                    points += 1
                rospy.sleep(0.001)
            return [(c.points[0].positions, c.points[0].velocities, s.code, s.reason, s.deviation,
                     s.position_error) for c, s in self.answers(60)]
        first = outputs(1)
        self.assertEqual(len(first), 60)
        for seed in (2, 3, 4):
            self.assertEqual(outputs(seed), first)


if __name__ == '__main__':
    rospy.init_node('test_arm_controller_node')
    rostest.rosrun('prf_control', 'arm_controller_node', ArmControllerNode)
