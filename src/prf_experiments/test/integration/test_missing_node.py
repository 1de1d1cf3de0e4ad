# SPDX-License-Identifier: BSD-3-Clause
"""A node that is absent or dies: the simulator names the silent topic, the trial is no evidence.

The trials run no faster than real time, so that none is over before its node is taken away.
"""
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from typing import Any

import rosgraph

sys.path.insert(0, os.path.dirname(__file__))
import runs
from prf_experiments.run import connections, processes

LAUNCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "incomplete.launch")


def node_pid(name):
    """Process of a node, found as ROS finds it."""
    import xmlrpc.client
    uri = rosgraph.Master(connections.CALLER).lookupNode("/" + name)
    pid: Any = xmlrpc.client.ServerProxy(uri).getPid(connections.CALLER)
    return pid[2]


class MissingNode(unittest.TestCase):
    @contextlib.contextmanager
    def launched(self, *words, launch_file=LAUNCH):
        with tempfile.TemporaryDirectory() as folder, processes.reserved_port() as port:
            before = dict(os.environ)
            os.environ.update(processes.master_environment(port, folder))
            launch = processes.Launch(port, launch_file, list(words), folder)
            try:
                launch.wait_until_started()
                yield launch
            finally:
                launch.stop()
                os.environ.clear()
                os.environ.update(before)
            self.assertEqual(runs.processes_of(folder), [])

    def start_when_connected(self):
        """A busy machine connects slowly, and what is sent before is lost."""
        master = rosgraph.Master(connections.CALLER)
        end = time.monotonic() + 60.0
        while connections.missing(master, connections.trial_links("platform_sim")):
            self.assertLess(time.monotonic(), end, "the nodes did not connect")
            time.sleep(0.2)
        subprocess.run(["rosservice", "call", "/platform_sim/start"], check=True, timeout=30,
                       stdout=subprocess.DEVNULL)

    def end_of_simulator(self, launch):
        end = time.monotonic() + 60.0
        while not launch.has_ended("platform_sim") and time.monotonic() < end:
            time.sleep(0.1)
        self.assertTrue(launch.has_ended("platform_sim"), "the simulator waits for ever")
        self.assertNotEqual(launch.exit_code("platform_sim"), 0)
        return launch.describe_end("platform_sim")

    def test_a_program_that_is_not_built_is_named_at_once(self):
        with tempfile.NamedTemporaryFile("w", suffix=".launch") as file:
            file.write('<launch><node pkg="roscpp" type="no_such_program" name="n"/></launch>')
            file.flush()
            with self.assertRaises(processes.ProcessError) as caught:
                with self.launched(launch_file=file.name):
                    pass
        self.assertIn("cannot start roscpp/no_such_program", str(caught.exception))

    # Fault 34: a node of the lockstep is absent -> the simulator ends with a message naming the topic, code not 0
    def test_absent_controller_is_named_by_its_topic(self):
        with self.launched("without:=arm_controller") as launch:
            self.assertIn("joint_command", self.end_of_simulator(launch))

    def test_absent_planner_is_named_by_its_topic(self):
        with self.launched("without:=skill_planner") as launch:
            self.assertIn("skill/trajectory", self.end_of_simulator(launch))

    # Fault 34: a node of the lockstep falls silent -> the simulator ends with a message naming the topic, code not 0
    def test_silent_predictor_is_named_by_its_topic(self):
        with self.launched("without:=none", "paused:=true") as launch:
            self.start_when_connected()
            time.sleep(3.0)
            pid = node_pid("target_predictor")
            os.kill(pid, signal.SIGSTOP)
            try:
                self.assertIn("target/forecast is silent", self.end_of_simulator(launch))
            finally:
                os.kill(pid, signal.SIGCONT)

    # Fault 26, 34: a node dies and nobody asked for it -> the trial is INVALID and says which node
    def test_a_node_that_dies_makes_the_trial_invalid(self):
        with tempfile.TemporaryDirectory() as results:
            trial = runs.start("run_trial", f"results:={results}", "real_time_factor:=1.0")
            victims: list[str] = []
            end = time.monotonic() + 60.0
            while not victims and time.monotonic() < end:
                time.sleep(0.5)
                victims = [pid for pid in filter(str.isdigit, os.listdir("/proc"))
                           if self.is_decision_of(pid, results)]
            time.sleep(4.0)
            os.kill(int(victims[0]), signal.SIGKILL)
            run = runs.finish(trial)
            self.assertEqual(run.code, 3, run.out + run.error)
            self.assertIn("verdict INVALID: decision ended with exit code -9", run.out)
            with open(os.path.join(run.folder, "verdict.json"), encoding="utf-8") as stream:
                self.assertEqual(json.load(stream)["verdict"], "INVALID")
            self.assertEqual(runs.processes_of(results), [])

    @staticmethod
    def is_decision_of(pid, results):
        try:
            with open(f"/proc/{pid}/environ", "rb") as environment, \
                    open(f"/proc/{pid}/cmdline", "rb") as command:
                return results.encode() in environment.read() and b"decision_node" in command.read()
        except OSError:
            return False


if __name__ == "__main__":
    unittest.main()
