#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The framework's nodes hear what the data flow says, and never the ground truth."""
import subprocess
import time
import unittest

import rosgraph
import rostest
from prf_experiments.record import topics
from prf_experiments.run import connections

NODES = ["/" + name for name in topics.TABLE.framework_nodes]


class FrameworkGraph(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = rosgraph.Master(connections.CALLER)
        required = {link for link in connections.trial_links("nobody", simulated=False)
                    if link[1] != "/nobody"}
        end = time.monotonic() + 30.0
        while connections.missing(cls.master, required) and time.monotonic() < end:
            time.sleep(0.2)
        cls.missing = connections.missing(cls.master, required)
        cls.heard = connections.subscriptions(cls.master)

    def test_every_link_of_the_data_flow_is_there(self):
        self.assertEqual(self.missing, set())

    def test_every_node_is_there(self):
        for node in NODES:
            self.assertIn(node, self.heard)

    def test_runs_without_the_simulator_on_the_clock_of_the_robot(self):
        self.assertIs(self.master.getParam("/use_sim_time"), False)
        self.assertNotIn("/platform_sim", self.heard)

    def test_planner_and_decision_take_the_same_part_of_the_skill_for_the_approach(self):
        self.assertEqual(self.master.getParam("/decision/approach_length"),
                         self.master.getParam("/skill_planner/approach_length"))

    def test_no_node_hears_the_ground_truth(self):
        truth = {"/" + topic for topic in topics.GROUND_TRUTH}
        for node in NODES:
            self.assertEqual(self.heard[node] & truth, set(), node)
            self.assertFalse([topic for topic in self.heard[node] if "ground_truth" in topic])

    def test_sensor_topics_are_heard_by_their_names(self):
        for topic, nodes in topics.TABLE.sensor_readers.items():
            for node in nodes:
                self.assertIn(topic, self.heard["/" + node])

    # Fault 46: no sensor says anything -> ERROR in diagnostics names topic, type and rate; the client repeats it
    def test_silence_is_an_error_that_names_the_topic(self):
        client = subprocess.Popen(
            ["rosrun", "prf_decision", "execute_skill", "--patience", "12"], text=True,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            told = client.communicate(timeout=60.0)[1]
        finally:
            client.kill()
        self.assertNotEqual(client.returncode, 0)
        self.assertRegex(told, r"execute_skill: arm_controller.*no message on \S*joint_states.*100 Hz")


if __name__ == "__main__":
    rostest.rosrun("prf_experiments", "framework_graph", FrameworkGraph)
