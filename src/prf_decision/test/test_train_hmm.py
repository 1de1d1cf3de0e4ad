# SPDX-License-Identifier: BSD-3-Clause
"""The commands simulate and train_hmm, together, on bags."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

import prf_decision
import yaml

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts")
HMM = os.path.join(SCRIPTS, "..", "config", "hmm_default.yaml")


def run(name, *arguments):
    return subprocess.run([sys.executable, os.path.join(SCRIPTS, name), *map(str, arguments)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)


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
                   "--json", figures)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("accuracy", done.stdout)
        model = prf_decision.load_hmm(out)
        with open(figures, encoding="utf-8") as file:
            written = json.load(file)
        self.assertEqual(model.transition.tolist(), written["transition"])
        matrix = written["held_out_confusion"]
        self.assertEqual(sum(map(sum, matrix)), 1800)
        self.assertGreater(sum(matrix[i][i] for i in range(3)), 0.9 * 1800)

    def test_learns_without_labels_nearly_the_same(self):
        out = self.path("unlabelled.yaml")
        done = run("train_hmm", *self.bags, "--unlabelled", "--restarts", 2, "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(out, encoding="utf-8") as file, open(HMM, encoding="utf-8") as truth:
            learnt, given = yaml.safe_load(file), yaml.safe_load(truth)
        for state in prf_decision.STATES:
            share = learnt["covariance"][state][0][0] / given["covariance"][state][0][0]
            self.assertTrue(0.7 < share < 1.4, (state, share))

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
                ("train_hmm", [self.bags[0], "--restarts", "0"], "restarts is 0"),
                ("simulate", ["--out", "x.bag", "--seed", "1", "--duration", "-1"], "--duration"),
                ("simulate", ["--out", self.path("x.bag"), "--seed", "1", "--duration", "1",
                              "--hmm", self.path("no.yaml")], "cannot be read")):
            done = run(name, *arguments)
            self.assertEqual(done.returncode, 2, (arguments, done.stderr))
            self.assertIn(culprit, done.stderr.splitlines()[-1])


if __name__ == "__main__":
    unittest.main()
