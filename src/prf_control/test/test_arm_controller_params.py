#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A catalogue of bad parameters: the node must end with code 2 and name parameter, value and bound."""
import concurrent.futures
import math
import subprocess
import unittest

import roslib.packages
import rosparam
import rospy
import rostest

NAN, INF = float('nan'), float('inf')
# The least and the greatest value of each.
BOUNDS = {'velocity_scale': (0.01, 1.0), 'acceleration': (0.1, 20.0), 'max_joint_step': (0.01, 1.0),
          'far_position': (0.001, 1.0), 'far_orientation': (0.001, math.pi), 'damping': (0.001, 1.0),
          'orientation_weight': (0.01, 10.0), 'branch_patience': (0.01, 60.0),
          'tick_period': (0.001, 0.1), 'max_tracking_error': (0.01, 1.0), 'max_wait': (0.02, 5.0)}
NAMES = ('robot',)
# Parameter, bad value, how the message writes the value, and the bound.
CATALOGUE = (
    [(name, value, '%g' % value, 'within [%g, %g]' % BOUNDS[name])
     for name in BOUNDS for value in (0.0, -1.0, NAN, INF, 5e-324, 1e308)] +
    [(name, value, '%g' % value, 'within [')
     for name, (least, most) in BOUNDS.items() for value in (0.9 * least, 1.1 * most)] +
    [(name, 'much', 'much', 'a number') for name in BOUNDS] +
    [('robot', 'my_arm', '"my_arm"', 'must be gen3_v60, jaco_v60'),
     ('robot', '/no/such/folder', '/no/such/folder/robot.yaml', '')] +
    [(name, 7, '7', 'a string') for name in NAMES] +
    [('accelaration', 4.0, '', '')])


class ArmControllerParams(unittest.TestCase):
    def setUp(self):
        config = rospy.get_param('~config')
        self.good = rosparam.load_file(config, default_namespace='/')[0][0]
        self.node = roslib.packages.find_node('prf_control', 'arm_controller_node')[0]
        self.urdf = roslib.packages.find_resource('jaco_v60_description', 'jaco_v60.urdf')[0]
        self.addCleanup(rospy.delete_param, '/refused')

    def start(self, name, patience):
        return subprocess.run([self.node, '__ns:=/refused', '__name:=' + name], capture_output=True,
                              text=True, timeout=patience)

    def check_refused(self, cases, keep=False):
        """Cases: the node's parameters, and what its one fatal line must say."""
        names = ['case_%d' % i for i in range(len(cases))]
        if not keep and rospy.has_param('/refused'):
            rospy.delete_param('/refused')
        for name, case in zip(names, cases):
            rospy.set_param('/refused/' + name, case[0])
        with concurrent.futures.ThreadPoolExecutor(6) as pool:
            results = list(pool.map(lambda name: self.start(name, 60), names))
        for (_, said), result in zip(cases, results):
            output = result.stdout + result.stderr
            self.assertEqual(result.returncode, 2, '%s: %s' % (said, output))
            fatal = [line for line in output.splitlines() if 'FATAL' in line]
            self.assertEqual(len(fatal), 1, output)
            for words in said:
                self.assertIn(words, fatal[0])

    # Fault 28, 43, 52: a parameter that is not finite, absurd or beyond physics ->
    # exit code 2 with name, value and bound
    def test_every_bad_value_is_refused_with_name_value_and_bound(self):
        self.check_refused([(dict(self.good, **{name: value}), (name, said, bound))
                            for name, value, said, bound in CATALOGUE])

    def test_every_missing_parameter_is_named(self):
        self.check_refused([({k: v for k, v in self.good.items() if k != name}, (name, 'missing'))
                            for name in self.good])

    # Fault 45: no robot_description, or of another arm -> exit code 2 and what is missing or differs
    def test_an_arm_that_is_not_the_robots_is_refused(self):
        self.check_refused([(self.good, ('robot_description missing after 5 s', 'URDF of the robot'))])
        with open(self.urdf) as file:
            rospy.set_param('/refused/robot_description', file.read())
        self.check_refused([
            (dict(self.good, robot='panda_deck'), ('robot_description does not fit', 'no link', 'panda_link0'))],
            keep=True)

    def test_the_configuration_of_the_package_is_accepted(self):
        with open(self.urdf) as file:
            rospy.set_param('/refused/robot_description', file.read())
        rospy.set_param('/refused/good', self.good)
        with self.assertRaises(subprocess.TimeoutExpired):
            self.start('good', 2)


if __name__ == '__main__':
    rospy.init_node('test_arm_controller_params')
    rostest.rosrun('prf_control', 'arm_controller_params', ArmControllerParams)
