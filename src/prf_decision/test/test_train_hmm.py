# SPDX-License-Identifier: BSD-3-Clause
"""The commands simulate and train_hmm, together, on bags; and what train_hmm reads."""
import importlib.machinery
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import rosbag
import rospy
import yaml

import prf_decision
from prf_msgs.msg import ExecutionProgress, TargetForecast, TargetPrediction

COMMANDS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python")
HMM = os.path.join(COMMANDS, "..", "config", "hmm_paper.yaml")


train_hmm = importlib.machinery.SourceFileLoader(
    "train_hmm", os.path.join(COMMANDS, "train_hmm")).load_module()


def write_bag(path, stamps, statuses, progress):
    """Forecasts with velocity (k, 0, 0); progress as pairs of forecast and state."""
    with rosbag.Bag(path, "w") as bag:
        for k, (stamp, status) in enumerate(zip(stamps, statuses)):
            message = TargetForecast(status=status, predictions=[TargetPrediction()])
            message.header.stamp = rospy.Time.from_sec(stamp)
            message.predictions[0].twist.linear.x = k
            bag.write("target/forecast", message, rospy.Time.from_sec(1 + k))
        for n, (forecast, state) in enumerate(progress):
            message = ExecutionProgress(state=state)
            message.forecast_stamp = rospy.Time.from_sec(stamps[forecast])
            bag.write("execution/progress", message, rospy.Time.from_sec(1.5 + n))


def run(name, *arguments):
    return subprocess.run([sys.executable, os.path.join(COMMANDS, name), *map(str, arguments)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)


class WhatTrainHmmReads(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.bag = os.path.join(holder.name, "run.bag")
        self.table = os.path.join(holder.name, "run.csv")

    def test_velocities_where_the_target_is_tracked_and_the_state_that_first_used_them(self):
        states = [ExecutionProgress.FORWARD, ExecutionProgress.PAUSE, ExecutionProgress.REVERSE,
                  ExecutionProgress.TRACKING, ExecutionProgress.RETRACT, ExecutionProgress.DONE,
                  ExecutionProgress.WAITING, ExecutionProgress.STOPPED]
        progress = list(enumerate(states)) + [(0, ExecutionProgress.STOPPED),
                                              (1, ExecutionProgress.REVERSE)]
        statuses = [TargetForecast.TRACKING] * 7 + [TargetForecast.COASTING]
        write_bag(self.bag, range(10, 18), statuses, progress)
        velocities, labels = train_hmm.read_bag(self.bag, "progress")
        self.assertEqual(velocities[:7].tolist(), [[k, 0, 0] for k in range(7)])
        self.assertTrue(all(map(math.isnan, velocities[7])))
        forward, pause, reverse, unknown = 0, 1, 2, -1
        self.assertEqual(labels, [forward, pause, reverse, forward, reverse, forward, unknown,
                                  unknown])

    def test_a_row_of_the_table_holds_from_its_time_to_the_next(self):
        write_bag(self.bag, [10, 11, 12, 13, 14], [TargetForecast.TRACKING] * 5, [])
        with open(self.table, "w", encoding="utf-8") as file:
            file.write("time_s,label\n1,pause\n2.5,reverse\n4,none\n")
        self.assertEqual(train_hmm.read_bag(self.bag, "csv")[1], [-1, 1, 1, 2, -1])

    def test_a_table_of_what_is_observed_with_blanks_for_what_is_not_known(self):
        with open(self.table, "w", encoding="utf-8") as file:
            file.write("time_s,velocity_x,velocity_y,velocity_z,spread,deviation,label\n"
                       "0,0.1,0.2,0.3,0.05,0.01,forward\n0.03,,,,,,none\n0.07,1,2,3,0,,reverse\n")
        motions, labels = train_hmm.read_table(self.table)
        self.assertEqual(motions[0].tolist(), [0.1, 0.2, 0.3, 0.05, 0.01])
        self.assertTrue(all(map(math.isnan, motions[1])))
        self.assertEqual(motions[2, :4].tolist(), [1, 2, 3, 0])
        self.assertTrue(math.isnan(motions[2, 4]))
        self.assertEqual(labels, [0, -1, 2])

    def test_the_reaction_counts_from_a_label_that_leaves_forward_after_a_second_of_it(self):
        model = prf_decision.load_hmm(HMM)
        speeds = [0.0] * 40 + [0.02] * 3 + [3.0] * 20 + [0.0] * 40 + [0.02] * 10 + [0.0] * 40
        labels = [0] * 40 + [2] * 23 + [0] * 40 + [1] * 10 + [0] * 40
        velocities = [[speed, 0, 0] for speed in speeds]
        found, missed = train_hmm.reactions(model, [(np.array(velocities), labels)])
        self.assertEqual((found, missed), ([3], 1))

    def test_refuses_forecasts_whose_stamps_do_not_rise(self):
        write_bag(self.bag, [10, 12, 11], [TargetForecast.TRACKING] * 3, [])
        with self.assertRaisesRegex(ValueError, "stamps of target/forecast do not rise"):
            train_hmm.read_bag(self.bag, "progress")

    def test_confusion_counts_labels_in_rows_and_of_equally_probable_states_the_more_cautious(self):
        model = prf_decision.load_hmm(HMM)
        calm = [[0.0, 0.0, 0.0]] * 20
        self.assertEqual(train_hmm.confusion(model, [(calm, [1] * 19 + [-1])]).tolist(),
                         [[0, 0, 0], [19, 0, 0], [0, 0, 0]])
        with open(HMM, encoding="utf-8") as file:
            alike = yaml.safe_load(file)
        alike["initial"] = dict(zip(prf_decision.STATES, [0.25, 0.25, 0.5]))
        alike["transition"] = {state: [0.375, 0.375, 0.25] for state in prf_decision.STATES}
        with open(self.table, "w", encoding="utf-8") as file:
            yaml.safe_dump(alike, file)
        missing = [[math.nan] * 3] * 2  # probabilities 1/4, 1/4, 1/2, then 3/8, 3/8, 1/4
        matrix = train_hmm.confusion(prf_decision.load_hmm(self.table), [(missing, [0, 0])])
        self.assertEqual(matrix.tolist(), [[0, 1, 1], [0, 0, 0], [0, 0, 0]])


class TrainHmm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = cls.holder.name
        cls.bags = [os.path.join(cls.folder, f"run{seed}.bag") for seed in (1, 2)]
        for seed, bag in enumerate(cls.bags, 1):
            done = run("simulate", "--hmm", HMM, "--out", bag, "--seed", seed, "--duration", 60)
            assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    def path(self, name):
        return os.path.join(self.folder, name)

    def test_learns_from_labels_and_writes_a_file_that_the_node_loads(self):
        out, figures = self.path("labelled.yaml"), self.path("labelled.json")
        done = run("train_hmm", self.bags[0], "--held-out", self.bags[1], "--out", out,
                   "--json", figures, "--beside", HMM, "--made-by", "a command")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("accuracy", done.stdout)
        model = prf_decision.load_hmm(out)
        with open(figures, encoding="utf-8") as file:
            written = json.load(file)
        self.assertEqual(model.transition.tolist(), written["transition"])
        matrix = written["held_out"]["learnt"]["confusion"]
        self.assertEqual(sum(map(sum, matrix)), 1800)
        right = sum(matrix[i][i] for i in range(3))
        self.assertGreater(right, 0.9 * 1800)
        self.assertAlmostEqual(written["held_out"]["learnt"]["accuracy"], right / 1800)
        self.assertGreater(written["held_out"][HMM]["mean_recall"], 0.85)
        with open(out, encoding="utf-8") as file:
            self.assertIn("by\n#   a command\n", file.read())

    def test_learns_without_labels_nearly_the_same(self):
        out = self.path("unlabelled.yaml")
        done = run("train_hmm", *self.bags, "--unlabelled", "--restarts", 2, "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(out, encoding="utf-8") as file, open(HMM, encoding="utf-8") as truth:
            learnt, given = yaml.safe_load(file), yaml.safe_load(truth)
        for state in prf_decision.STATES:
            ratio = learnt["covariance"][state][0][0] / given["covariance"][state][0][0]
            self.assertTrue(0.85 < ratio < 1.15, (state, ratio))  # 3600 forecasts: 5 %

    def test_takes_labels_from_a_table_beside_the_bag(self):
        table = os.path.splitext(self.bags[1])[0] + ".csv"
        with open(table, "w", encoding="utf-8") as file:
            file.write("time_s,label\n0,forward\n10,none\n20,upset\n")
        done = run("train_hmm", self.bags[1], "--labels", "csv")
        self.assertEqual(done.returncode, 2)
        self.assertIn("run2.csv", done.stderr)
        with open(table, "w", encoding="utf-8") as file:
            file.write("time_s,label\n0,forward\n10,none\n")
        done = run("train_hmm", self.bags[0], "--held-out", self.bags[1], "--labels", "csv")
        self.assertIn("run1.csv", done.stderr)
        done = run("train_hmm", self.bags[1], "--unlabelled", "--labels", "csv", "--restarts", 1)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1800    1800      300       0        0", done.stdout)

    def test_refuses_in_one_line_with_exit_code_2(self):
        nonsense = self.path("nonsense.bag")
        with open(nonsense, "w", encoding="utf-8") as file:
            file.write("not a bag")
        for name, arguments, culprit in (
                ("train_hmm", [self.path("none.bag")], "none.bag"),
                ("train_hmm", [nonsense], "train_hmm:"),
                ("train_hmm", [self.bags[0], "--restarts", "0"], "restarts = 0"),
                ("train_hmm", [self.bags[0], "--restart", "3"], "--restart"),
                ("simulate", ["--out", "x.bag", "--seed", "1", "--duration", "-1"], "--duration"),
                ("simulate", ["--out", self.path("x.bag"), "--seed", "1", "--duration", "1",
                              "--hmm", self.path("no.yaml")], "no.yaml: there is no such file")):
            done = run(name, *arguments)
            self.assertEqual(done.returncode, 2, (arguments, done.stderr))
            self.assertIn(culprit, done.stderr.splitlines()[-1])


if __name__ == "__main__":
    unittest.main()
