# SPDX-License-Identifier: BSD-3-Clause
"""A trial launched by hand, on a busy machine."""
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import runs
from prf_experiments.run import processes


class ByHand(unittest.TestCase):
    # Fault 46, 53: trial.launch by hand on a busy machine -> starts when connected, ends without "has died"
    def test_starts_when_everything_is_connected_and_ends_in_peace(self):
        busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
        try:
            with tempfile.TemporaryDirectory() as folder, processes.reserved_port() as port:
                run = subprocess.run(
                    ["roslaunch", "-p", str(port), "prf_experiments", "trial.launch",
                     "motion:=none", "time_limit:=1.0"],
                    env={**os.environ, **processes.master_environment(port, folder)},
                    capture_output=True, text=True, timeout=150, check=False)
                self.assertEqual(runs.processes_of(folder), [])
        finally:
            for process in busy:
                process.kill()
                process.wait()
        told = run.stdout + run.stderr
        self.assertEqual(run.returncode, 0, told)
        self.assertIn("1.00 s simulated", told)
        self.assertNotIn("has died", told)
        self.assertNotIn("not connected", told)


if __name__ == "__main__":
    unittest.main()
