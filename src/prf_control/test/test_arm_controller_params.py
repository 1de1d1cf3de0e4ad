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
# The greatest value of each, and how the message writes it. All must be above 0.
GREATEST = {'velocity_scale': (1.0, '1'), 'acceleration': (100.0, '100'),
            'max_joint_step': (math.pi, '3.14'), 'far_position': (1.0, '1'),
            'far_orientation': (math.pi, '3.14'), 'damping': (1.0, '1'),
            'orientation_weight': (10.0, '10'), 'branch_patience': (1e6, '1e+06'),
            'max_tracking_error': (math.pi, '3.14'), 'max_wait': (10.0, '10')}
NAMES = ('joint_prefix', 'planning_frame', 'hand_frame')
# Parameter, bad value, how the message writes the value, and the bound.
CATALOGUE = (
    [(name, value, '%g' % value, '> 0') for name in GREATEST for value in (0.0, -1.0, NAN, INF)] +
    [(name, 1.1 * most, '%g' % (1.1 * most), '<= ' + text) for name, (most, text) in GREATEST.items()] +
    [(name, 'much', 'much', 'a number') for name in GREATEST] +
    [(name, '', "''", 'must be not empty') for name in NAMES] +
    [(name, 7, '7', 'a string') for name in NAMES] +
    [('accelaration', 4.0, '', '')])


class ArmControllerParams(unittest.TestCase):
    def setUp(self):
        config = rospy.get_param('~config')
        self.good = rosparam.load_file(config, default_namespace='/')[0][0]
        self.node = roslib.packages.find_node('prf_control', 'arm_controller_node')[0]
        self.addCleanup(rospy.delete_param, '/refused')

    def start(self, name, patience):
        return subprocess.run([self.node, '__ns:=/refused', '__name:=' + name], capture_output=True,
                              text=True, timeout=patience)

    def check_refused(self, cases):
        """Cases: the node's parameters, and what its one fatal line must say."""
        names = ['case_%d' % i for i in range(len(cases))]
        rospy.set_param('/refused', {name: case[0] for name, case in zip(names, cases)})
        with concurrent.futures.ThreadPoolExecutor(6) as pool:
            results = list(pool.map(lambda name: self.start(name, 60), names))
        for (_, said), result in zip(cases, results):
            output = result.stdout + result.stderr
            self.assertEqual(result.returncode, 2, '%s: %s' % (said, output))
            fatal = [line for line in output.splitlines() if 'FATAL' in line]
            self.assertEqual(len(fatal), 1, output)
            for words in said:
                self.assertIn(words, fatal[0])

    def test_every_bad_value_is_refused_with_name_value_and_bound(self):
        self.check_refused([(dict(self.good, **{name: value}), (name, said, bound))
                            for name, value, said, bound in CATALOGUE])

    def test_every_missing_parameter_is_named(self):
        self.check_refused([({k: v for k, v in self.good.items() if k != name}, (name, 'missing'))
                            for name in self.good])

    def test_the_configuration_of_the_package_is_accepted(self):
        rospy.set_param('/refused/good', self.good)
        with self.assertRaises(subprocess.TimeoutExpired):
            self.start('good', 2)


if __name__ == '__main__':
    rospy.init_node('test_arm_controller_params')
    rostest.rosrun('prf_control', 'arm_controller_params', ArmControllerParams)
