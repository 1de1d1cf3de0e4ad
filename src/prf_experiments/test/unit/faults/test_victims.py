# SPDX-License-Identifier: BSD-3-Clause
import os
import subprocess
import sys
import time
import unittest
from unittest import mock

from prf_experiments.faults import catalogue, victims

SLEEPER = [sys.executable, "-c", "import time; time.sleep(60)", "__name:=decision"]


def state_of(pid):
    with open(f"/proc/{pid}/stat", encoding="ascii") as stream:
        return stream.read().rpartition(")")[2].split()[0]


class Victims(unittest.TestCase):
    def setUp(self):
        self.process = subprocess.Popen(SLEEPER, env={**os.environ, "MARK": "42"})
        self.addCleanup(self.process.wait)
        self.addCleanup(self.process.kill)
        patch = mock.patch.object(victims, "process_of", lambda node: self.process.pid)
        patch.start()
        self.addCleanup(patch.stop)
        self.told: list = []

    def victims(self, text):
        return victims.Victims(catalogue.parse(text),
                               lambda fault, stamp, what: self.told.append((stamp, what)))

    def wait_for(self, condition):
        end = time.monotonic() + 10.0
        while not condition():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def test_a_stopped_node_goes_on_at_its_time_of_the_data(self):
        stopped = self.victims("stop/decision:0.5@2")
        stopped.tick(1, 1.99)
        self.assertEqual(self.told, [])
        stopped.tick(2, 2.0)
        self.wait_for(lambda: state_of(self.process.pid) == "T")
        stopped.tick(3, 2.49)
        self.assertEqual(state_of(self.process.pid), "T")
        stopped.tick(4, 2.5)
        self.wait_for(lambda: state_of(self.process.pid) != "T")
        self.assertEqual(self.told, [(2, "decision is stopped"), (4, "decision goes on")])

    def test_a_node_is_started_again_as_it_was_and_ends_with_the_injector(self):
        killed = self.victims("respawn/decision:1@2")
        killed.tick(1, 2.0)
        self.assertEqual(self.process.wait(10.0), -9)
        killed.tick(2, 2.99)
        self.assertEqual(killed._children, [])
        killed.tick(3, 3.0)
        child = killed._children[0]
        self.wait_for(lambda: victims.command_of(child.pid)[0] == SLEEPER)
        self.assertEqual(victims.command_of(child.pid)[1]["MARK"], "42")
        killed.close()
        self.assertIsNotNone(child.returncode)

    def test_what_is_still_stopped_at_the_end_goes_on(self):
        stopped = self.victims("stop/decision:50@2")
        stopped.tick(1, 2.0)
        stopped.close()
        self.wait_for(lambda: state_of(self.process.pid) != "T")

    def test_a_node_that_is_not_there_is_told_and_nothing_else(self):
        with mock.patch.object(victims, "process_of", side_effect=OSError("gone")):
            self.victims("kill/decision@2").tick(7, 2.0)
        self.assertEqual(self.told, [(7, "cannot be done: gone")])


if __name__ == "__main__":
    unittest.main()
