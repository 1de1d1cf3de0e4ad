# SPDX-License-Identifier: BSD-3-Clause
import os
import stat
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

from prf_experiments.run import isolation, processes

INSIDE = """
import socket
from prf_experiments.run import isolation
isolation.raise_loopback()
server = socket.create_server(("127.0.0.1", 0))
socket.create_connection(server.getsockname(), timeout=5.0)
print([name for _, name in socket.if_nameindex()])
"""


class Isolation(unittest.TestCase):
    def test_inside_there_is_a_loopback_that_works_and_nothing_else(self):
        try:
            prefix = isolation.prefix()
        except isolation.IsolationError as error:
            self.skipTest(str(error))
        run = subprocess.run([*prefix, sys.executable, "-c", INSIDE], capture_output=True,
                             text=True, timeout=30, check=False)
        self.assertEqual(run.stdout.strip(), "['lo']", run.stderr)

    def test_where_it_may_not_be_it_is_refused_with_the_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "unshare")
            with open(program, "w", encoding="utf-8") as stream:
                stream.write("#!/bin/sh\necho 'unshare failed: Operation not permitted' >&2; exit 1\n")
            os.chmod(program, stat.S_IRWXU)
            with mock.patch.dict(os.environ, {"PATH": folder + ":/bin"}):
                with self.assertRaisesRegex(isolation.IsolationError, "not permitted"):
                    isolation.prefix()
            with mock.patch.dict(os.environ, {"PATH": "/nowhere"}):
                with self.assertRaisesRegex(isolation.IsolationError, "needs the program unshare"):
                    isolation.prefix()

    def test_everything_of_a_trial_is_announced_on_loopback(self):
        with mock.patch.dict(os.environ, clear=True):
            values = processes.master_environment(11511, "/log")
            self.assertEqual(values["ROS_MASTER_URI"], "http://127.0.0.1:11511")
            self.assertEqual(values["ROS_IP"], "127.0.0.1")
        with mock.patch.dict(os.environ, {"ROS_IP": "10.0.0.7"}):
            self.assertNotIn("ROS_IP", processes.master_environment(11511, "/log"))


if __name__ == "__main__":
    unittest.main()
