#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A catalogue of bad parameters: the node must end with code 2 and name the parameter."""
import subprocess
import unittest

import roslib.packages
import rosparam
import rospy
import rostest

NAN, INF = float('nan'), float('inf')
POSITIVE = ['velocity_scale', 'acceleration', 'max_joint_step', 'far_position', 'far_orientation',
            'damping', 'orientation_weight', 'branch_patience', 'max_tracking_error',
            'max_wait']
CATALOGUE = (
    [(name, value) for name in POSITIVE for value in (0.0, -1.0, NAN, INF, 'much')] +
    [('velocity_scale', 1.1), ('max_wait', 11.0), ('max_tracking_error', 4.0)] +
    [(name, '') for name in ('joint_prefix', 'planning_frame', 'hand_frame')] +
    [('joint_prefix', 7), ('planning_frame', 1.5), ('hand_frame', [1.0]), ('accelaration', 4.0)])


class ArmControllerParams(unittest.TestCase):
    def setUp(self):
        config = rospy.get_param('~config')
        self.good = rosparam.load_file(config, default_namespace='/')[0][0]
        self.node = roslib.packages.find_node('prf_control', 'arm_controller_node')[0]

    def start(self, parameters):
        rospy.set_param('/refused', parameters)
        try:
            return subprocess.run([self.node, '__name:=refused'], capture_output=True, text=True,
                                  timeout=20)
        finally:
            rospy.delete_param('/refused')

    def check_refused(self, parameters, name):
        result = self.start(parameters)
        output = result.stdout + result.stderr
        self.assertEqual(result.returncode, 2, '%s: %s' % (name, output))
        fatal = [line for line in output.splitlines() if 'FATAL' in line]
        self.assertEqual(len(fatal), 1, output)
        self.assertIn(name, fatal[0])

    def test_every_bad_value_is_refused_by_name(self):
        for name, value in CATALOGUE:
            self.check_refused(dict(self.good, **{name: value}), name)

    def test_every_missing_parameter_is_named(self):
        for name in self.good:
            self.check_refused({k: v for k, v in self.good.items() if k != name}, name)

    def test_the_configuration_of_the_package_is_accepted(self):
        with self.assertRaises(subprocess.TimeoutExpired):
            rospy.set_param('/refused', self.good)
            subprocess.run([self.node, '__name:=refused'], timeout=2, capture_output=True)
        rospy.delete_param('/refused')


if __name__ == '__main__':
    rospy.init_node('test_arm_controller_params')
    rostest.rosrun('prf_control', 'arm_controller_params', ArmControllerParams)
