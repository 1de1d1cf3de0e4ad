# SPDX-License-Identifier: BSD-3-Clause
import os
import tempfile
import unittest

from prf_experiments.run import processes

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


if __name__ == "__main__":
    unittest.main()
