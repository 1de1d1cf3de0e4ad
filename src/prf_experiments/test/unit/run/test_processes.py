# SPDX-License-Identifier: BSD-3-Clause
import os
import tempfile
import unittest

from prf_experiments.run import connections, processes

LOG = """\x1b[31m[FATAL] [/skill_planner] demonstration is '', must be a file\x1b[0m
[ERROR] [/skill_planner] later
[ERROR] [/decision] first
[ERROR] [/decision] joint_states are silent
[ WARN] [/decision] no error
"""


class LastError(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.log = os.path.join(folder.name, "launch.log")
        with open(self.log, "w", encoding="utf-8") as stream:
            stream.write(LOG)

    def test_prefers_the_fatal_line_of_the_node(self):
        self.assertEqual(processes.last_error(self.log, "skill_planner"),
                         "demonstration is '', must be a file")

    def test_falls_back_to_the_last_error(self):
        self.assertEqual(processes.last_error(self.log, "decision"), "joint_states are silent")

    def test_is_empty_when_the_node_said_nothing(self):
        self.assertEqual(processes.last_error(self.log, "platform_sim"), "")
        self.assertEqual(processes.last_error(self.log + ".absent", "decision"), "")


class Ports(unittest.TestCase):
    def test_trials_side_by_side_have_different_ports(self):
        with processes.reserved_port() as first, processes.reserved_port() as second:
            self.assertNotEqual(first, second)


class FakeMaster:
    def __init__(self, publishers, subscribers):
        self._state = [publishers, subscribers, []]

    def getSystemState(self):
        return self._state


class Links(unittest.TestCase):
    def test_pairs_every_subscriber_with_every_publisher_but_itself(self):
        master = FakeMaster([["/tf", ["/a", "/b"]]], [["/tf", ["/b", "/c"]], ["/none", ["/c"]]])
        self.assertEqual(connections.registered(master),
                         {("/tf", "/a", "/b"), ("/tf", "/a", "/c"), ("/tf", "/b", "/c")})

    def test_trial_cannot_do_without_the_loop(self):
        links = connections.trial_links("platform_sim")
        self.assertIn(("/joint_command", "/arm_controller", "/platform_sim"), links)
        self.assertIn(("/camera/image_raw", "/platform_sim", "/tag_detector"), links)
        self.assertFalse(any(topic.startswith("/ground_truth") for topic, _, _ in links))

    def test_replay_has_no_simulator(self):
        links = connections.trial_links("player", simulated=False)
        self.assertFalse(any("/platform_sim" in link for link in links))
        self.assertIn(("/joint_states", "/player", "/decision"), links)


if __name__ == "__main__":
    unittest.main()
