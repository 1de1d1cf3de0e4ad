# SPDX-License-Identifier: BSD-3-Clause
"""The commands compare_packages and lasa_measures."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from scipy.io import savemat

BENCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "bench")


def run(command, *arguments):
    return subprocess.run([sys.executable, os.path.join(BENCH, command), *arguments], text=True, timeout=120,
                          capture_output=True, check=False)


class Comparisons(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def test_drawn_shapes_are_measured_for_all_planners(self):
        s = np.linspace(0.0, 1.0, 200)
        demos = np.empty(3, dtype=object)
        for i in range(3):
            demos[i] = {"pos": np.array([-40.0 * (1 - s), (15.0 + i) * np.sin(6.0 * s) * (1 - s)]), "t": s}
        savemat(os.path.join(self.folder, "wave.mat"), {"demos": demos.reshape(1, -1)})
        result = run("lasa_measures", self.folder, "--json", os.path.join(self.folder, "out.json"))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(os.path.join(self.folder, "out.json"), encoding="utf-8") as file:
            figures = json.load(file)
        self.assertEqual(set(figures), {"elte", "lte", "elastic_map", "dmp"})
        self.assertEqual(figures["elte"]["reproductions"], 2)
        self.assertLess(figures["elte"]["end_error"], 1e-9)
        self.assertLess(figures["elte"]["frechet"], 5.0)
        self.assertGreater(figures["elte"]["angular_similarity"], 0.9)

    def test_files_that_are_no_shapes_are_refused_by_name(self):
        self.assertIn("no *.mat in", run("lasa_measures", self.folder).stderr)
        savemat(os.path.join(self.folder, "other.mat"), {"x": 1.0})
        result = run("lasa_measures", self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("other.mat: no MATLAB file with demos", result.stderr)

    def test_four_tasks_are_solved_as_asked(self):
        result = run("compare_packages", "--runs", "1", "--json", os.path.join(self.folder, "out.json"))
        self.assertIn(result.returncode, (0, 1), result.stderr)  # 1: movement_primitives is not installed
        with open(os.path.join(self.folder, "out.json"), encoding="utf-8") as file:
            figures = json.load(file)
        self.assertEqual(len(figures), 4)
        for task in figures.values():
            self.assertLess(task["elte"]["end_error_mm"], 1e-9)
        self.assertGreaterEqual(figures["via_and_obstacle"]["elte"]["clearance_mm"], 20.0 - 1e-9)
        self.assertLess(figures["via_and_obstacle"]["elte"]["via_error_mm"], 1e-9)


if __name__ == "__main__":
    unittest.main()
