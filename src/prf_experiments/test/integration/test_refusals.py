# SPDX-License-Identifier: BSD-3-Clause
"""Bad input and interruptions: one clear line, a non-zero exit, nothing left running."""
import glob
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import runs
from prf_experiments.run import session

SKILL = session.packaged("demonstrations", "inspect_box.csv")


class Refusals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results = folder.name

    def refused(self, *words):
        run = runs.run("run_trial", f"results:={self.results}", *words)
        self.assertNotEqual(run.code, 0, run.out)
        self.assertEqual(run.out, "")
        self.assertNotIn("Traceback", run.error)
        self.assertEqual(run.error.count("\n"), 1, run.error)
        self.assertEqual(os.listdir(self.results), [])
        self.assertEqual(runs.processes_of(self.results), [])
        return run.error

    def skill(self, edit):
        with open(SKILL, encoding="utf-8") as stream:
            lines = stream.read().splitlines()
        path = os.path.join(tempfile.mkdtemp(), "skill.csv")
        self.addCleanup(shutil.rmtree, os.path.dirname(path))
        with open(path, "w", encoding="utf-8") as stream:
            stream.write("\n".join(edit(lines)) + "\n")
        return path

    def test_arguments_that_are_not_valid_are_named_with_what_is(self):
        for word, words in (("motion:=wild", "valid: none|"), ("gait:=fly", "stand"),
                            ("planner:=magic", "elte"), ("seed:=x", "integer"),
                            ("speed:=1", "unknown argument 'speed'"), ("motion", "name:=value")):
            self.assertIn(words, self.refused(word))

    def test_run_experiment_refuses_before_it_sets_up_or_builds(self):
        script = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "..", "..",
                              "run_experiment")
        build = os.path.join(self.results, "build")
        for words, code, told in ((["table", "motion:=wild"], 2, "valid: none|"),
                                  (["tabel"], 2, "did you mean table?"), (["--help"], 0, "compare")):
            run = subprocess.run([script, *words], env={**os.environ, "BUILD_DIR": build},
                                 capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(run.returncode, code, run.stdout + run.stderr)
            self.assertIn(told, run.stdout + run.stderr)
            self.assertFalse(os.path.exists(build))

    def test_absent_demonstration(self):
        self.assertIn("/absent.csv", self.refused("demonstration:=/absent.csv"))

    def test_demonstration_that_is_too_short(self):
        path = self.skill(lambda lines: lines[:7])
        self.assertIn("at least", self.refused(f"demonstration:={path}"))

    def test_demonstration_that_is_not_finite(self):
        path = self.skill(lambda lines: lines[:-1] + [lines[-1].rpartition(",")[0] + ",nan"])
        self.assertIn("a finite number", self.refused(f"demonstration:={path}"))

    # Fault 48: a skill in millimetres -> the trial is refused before a node starts
    def test_demonstration_that_no_arm_can_follow(self):
        def in_millimetres(lines):
            rows = [line.split(",") for line in lines]
            return [",".join([row[0], *(str(1e3 * float(word)) for word in row[1:4]), *row[4:]])
                    if len(row) == 8 and row[0] != "time" else ",".join(row) for row in rows]
        path = self.skill(in_millimetres)
        self.assertIn("is it in mm?", self.refused(f"demonstration:={path}"))

    def test_results_folder_that_is_a_file(self):
        run = runs.run("run_trial", f"results:={SKILL}")
        self.assertEqual(run.code, 1)
        self.assertEqual(run.error.count("\n"), 1, run.error)
        self.assertIn("cannot be written", run.error)

    def test_results_folder_in_a_place_that_takes_no_folders(self):
        run = runs.run("run_trial", "results:=/proc/results")
        self.assertEqual(run.code, 1)
        self.assertEqual(run.error.count("\n"), 1, run.error)


class Interruptions(unittest.TestCase):
    def interrupted(self, number):
        with tempfile.TemporaryDirectory() as results:
            process = runs.start("run_trial", f"results:={results}", "real_time_factor:=1.0")
            try:
                bag = os.path.join(results, "*", "trial.bag.active")
                end = time.monotonic() + 60.0
                while not glob.glob(bag) and time.monotonic() < end and process.poll() is None:
                    time.sleep(0.1)
                time.sleep(1.0)
                self.assertIsNone(process.poll(), "ended by itself")
                self.assertGreater(len(runs.processes_of(results)), 8)
                process.send_signal(number)
            finally:
                run = runs.finish(process)
            self.assertEqual(run.code, 128 + number, run.error)
            self.assertIn(f"stopped by {number.name}", run.error)
            self.assertNotIn("Traceback", run.error)
            self.assertEqual(runs.processes_of(results), [])

    def test_interrupt_leaves_no_process(self):
        self.interrupted(signal.SIGINT)

    def test_termination_leaves_no_process(self):
        self.interrupted(signal.SIGTERM)

    def test_kill_leaves_no_process(self):
        with tempfile.TemporaryDirectory() as results:
            process = runs.start("run_trial", f"results:={results}", "real_time_factor:=1.0")
            while not glob.glob(os.path.join(results, "*", "trial.bag.active")):
                self.assertIsNone(process.poll(), "ended by itself")
                time.sleep(0.1)
            process.kill()
            process.communicate()
            end = time.monotonic() + 60.0
            while runs.processes_of(results) and time.monotonic() < end:
                time.sleep(0.2)
            self.assertEqual(runs.processes_of(results), [])


if __name__ == "__main__":
    unittest.main()
