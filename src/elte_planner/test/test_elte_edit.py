# SPDX-License-Identifier: BSD-3-Clause
"""The commands elte_edit and paper_figures."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import elte_planner

HERE = os.path.dirname(os.path.abspath(__file__))
COMMAND = os.path.join(HERE, "..", "python", "commands", "elte_edit")
DEMONSTRATION = os.path.join(HERE, "reach.csv")


def arc(nodes=40):
    s = np.linspace(0.0, np.pi, nodes)
    return np.column_stack([np.cos(s), np.sin(s)])


class Figures(unittest.TestCase):
    def run_command(self, *arguments):
        return subprocess.run(
            [sys.executable, os.path.join(HERE, "..", "bench", "paper_figures"), *arguments], text=True,
            timeout=120, capture_output=True, check=False)

    def test_are_drawn_and_their_numbers_say_what_the_paper_claims(self):
        with tempfile.TemporaryDirectory() as folder:
            numbers = os.path.join(folder, "numbers.json")
            run = self.run_command("--out", folder, "--json", numbers)
            self.assertEqual(run.returncode, 0, run.stderr)
            for name in ("continuations.png", "moving_end.png", "corners.png"):
                self.assertGreater(os.path.getsize(os.path.join(folder, name)), 10000)
            with open(numbers, encoding="utf-8") as file:
                content = json.load(file)
        self.assertEqual(len(content["continuations"]), 5)
        for continuation in content["continuations"]:
            self.assertGreaterEqual(continuation["clearance"], 0.15 - 1e-12)
            self.assertEqual(continuation["end_point_error"], 0.0)
        self.assertLess(content["moving_end"]["end_point_error"], 1e-14)
        for case in ("unperturbed", "perturbed"):
            elte, dmp = (content["corners"][f"{planner}, {case}"] for planner in ("elte", "dmp"))
            for figure in elte:
                self.assertLess(elte[figure], dmp[figure])

    def test_a_folder_that_cannot_be_made_is_one_line_and_exit_code_2(self):
        run = self.run_command("--out", DEMONSTRATION)
        self.assertEqual(run.returncode, 2)
        self.assertEqual(len(run.stderr.splitlines()), 1)


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_command(self, *arguments):
        return subprocess.run([sys.executable, COMMAND, *arguments], text=True, timeout=60,
                              capture_output=True, check=False)

    def test_writes_plan_and_plot(self):
        run = self.run_command(DEMONSTRATION, "--end", "0.5", "0.1", "0.5", "--radius", "0.02",
                               "--executed", "20", "--out", self.path("plan.csv"),
                               "--plot", self.path("plan.png"))
        self.assertEqual(run.returncode, 0, run.stderr)
        plan = np.loadtxt(self.path("plan.csv"), delimiter=",", skiprows=1)
        self.assertEqual(plan.shape, (50, 4))
        self.assertLessEqual(np.abs(plan[-1, 1:] - [0.5, 0.1, 0.5]).sum(), 0.02 + 1e-12)
        self.assertGreater(os.path.getsize(self.path("plan.png")), 5000)

    def test_solves_one_or_many_problems(self):
        problem = {"name": "arc", "zeta": arc().tolist(), "wE": 0.001, "wR": 0.001,
                   "laplacian": "row_normalised", "n_fixed": 2, "y_fixed": arc()[:2].tolist(),
                   "constraints": [{"j": 39, "p": [-1.1, 0.0], "r": 0.0}]}
        for content, many in ((problem, False), ([problem, problem], True)):
            with open(self.path("problem.json"), "w", encoding="utf-8") as file:
                json.dump(content, file)
            run = self.run_command("--problem", self.path("problem.json"),
                                   "--out", self.path("solution.json"))
            self.assertEqual(run.returncode, 0, run.stderr)
            with open(self.path("solution.json"), encoding="utf-8") as file:
                content = json.load(file)
            solution = content["problems"][1] if many else content
            self.assertEqual(solution["status"], "solved")
            self.assertEqual(solution["y"][39], [-1.1, 0.0])

    def test_solves_problems_with_half_spaces_and_obstacles(self):
        problem = {"zeta": arc().tolist(), "wE": 0.001, "wR": 0.001, "n_fixed": 5,
                   "y_fixed": arc()[:5].tolist(),
                   "constraints": [{"j": 39, "p": [-1.1, 0.0], "r": 0.0},
                                   {"j": 30, "p": [-0.7, 0.0], "normal": [1.0, 0.0]}]}
        around = dict(problem, clearance=0.05, obstacles=[
            {"centre": [0.0, 1.0], "radius": 0.1},
            {"centre": [-1.0, 0.4], "half_widths": [0.05, 0.1]}])
        with open(self.path("problem.json"), "w", encoding="utf-8") as file:
            json.dump([problem, around], file)
        run = self.run_command("--problem", self.path("problem.json"))
        self.assertEqual(run.returncode, 0, run.stderr)
        for solution in json.loads(run.stdout)["problems"]:
            self.assertEqual(solution["status"], "solved", solution["message"])
            self.assertLessEqual(solution["y"][30][0], -0.7 + 1e-12)
        self.assertGreaterEqual(solution["clearance"], 0.05 - 1e-12)
        self.assertLess(solution["kkt_residual"], 1e-12)

    def test_combines_and_thins_demonstrations_and_avoids_obstacles(self):
        plan = self.path("plan.csv")
        for nodes, count in ((("--nodes", "30"), 30), (("--thin-to", "12"), 12)):
            run = self.run_command(DEMONSTRATION, DEMONSTRATION, *nodes, "--out", plan)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual(len(np.loadtxt(plan, delimiter=",", skiprows=1)), count)
        run = self.run_command(DEMONSTRATION, "--thin", "0.002", "--out", plan)
        self.assertLess(len(np.loadtxt(plan, delimiter=",", skiprows=1)), 40, run.stderr)
        sphere = ("--sphere", "0.45", "0.03", "0.42", "0.02", "--box", "0.45", "-0.1", "0.42",
                  "0.02", "0.02", "0.02", "--clearance", "0.03")
        run = self.run_command(DEMONSTRATION, *sphere, "--out", plan)
        self.assertEqual(run.returncode, 0, run.stderr)
        obstacle = elte_planner.disc_obstacle(np.array([0.45, 0.03, 0.42]), 0.02)
        y = np.loadtxt(plan, delimiter=",", skiprows=1)[:, 1:]
        self.assertGreaterEqual(elte_planner.polyline_clearance(y, [obstacle]), 0.03 - 1e-12)
        run = self.run_command(DEMONSTRATION, "--sphere", "0.5", "0", "0.5", "0.1",
                               "--clearance", "0.01")
        self.assertEqual(run.returncode, 1)
        self.assertIn("not_found: no way found around obstacle 0", run.stderr)

    def refuse(self, expected, *arguments):
        run = self.run_command(*arguments)
        self.assertEqual(run.returncode, 2, run.stdout)
        self.assertIn(expected, run.stderr.splitlines()[-1])

    def test_refuses_bad_input_with_one_line_and_exit_code_2(self):
        self.refuse("there is no such file", self.path("none.csv"))
        self.refuse("executed", DEMONSTRATION, "--executed", "x")
        self.refuse("frozen is 51", DEMONSTRATION, "--executed", "51")
        self.refuse("radius is -1", DEMONSTRATION, "--radius", "-1")
        self.refuse("goal", DEMONSTRATION, "--end", "nan", "0", "0")
        self.refuse("nodes is 2", DEMONSTRATION, "--nodes", "2")
        self.refuse("planner = x", DEMONSTRATION, "--planner", "x")
        self.refuse("either")
        self.refuse("--clearance belongs", DEMONSTRATION, "--clearance", "0.1")
        self.refuse("clearance = 0", DEMONSTRATION, "--sphere", *"1111", "--clearance", "0")
        self.refuse("frozen is 1", DEMONSTRATION, "--sphere", *"1111", "--clearance", "1",
                    "--executed", "1")
        self.refuse("tolerance is -1", DEMONSTRATION, "--thin", "-1")
        self.refuse("within [3, 41]", DEMONSTRATION, "--thin-to", "42")
        self.refuse("max_step is 0", DEMONSTRATION, "--max-step", "0")
        self.refuse("needs --topic", self.path("none.bag"))
        self.refuse("none.bag", self.path("none.bag"), "--topic", "hand")
        bad = [
            ("null", "a problem is None, must be an object"), ("{", "Expecting"), ("[1]", "must be an object"),
            ('{"zeta": [[0]]}', "lacks 'wE'"),
            ('{"zeta": [[0],[1]], "wE": 0, "wR": 0}', "at least 3"),
            ('{"zeta": [[0],[1,2],[3]], "wE": 0, "wR": 0}', "sequence"),
            ('{"zeta": [[0],[1],[NaN]], "wE": 0, "wR": 0}', "not finite"),
            ('{"zeta": [[0],[1],[2]], "wE": -1, "wR": 0}', "w_elastic"),
            ('{"zeta": [[0],[1],[2]], "wE": 0, "wR": 0, "n_fixed": 1}', "n_fixed is 1"),
            ('{"zeta": [[0],[1],[2]], "wE": 0, "wR": 0, "laplacian": "x"}', "laplacian is 'x'"),
            ('{"zeta": [[0],[1],[2]], "wE": 0, "wR": 0, "constraints": [{"j": 1}]}', "lacks 'p'"),
            ('{"zeta": [[0],[1],[2]], "wE": 0, "wR": 0, "constraints": [{"j": 9, "p": [0], "r": 0}]}',
             "node 9"),
            ('{"zeta": [[0],[1],[2]], "wE": 0, "wR": 0, "obstacles": [{"centre": [9], "radius": 1}]}',
             "lacks 'clearance'"),
            ('{"zeta": [[0],[1],[2]], "wE": 0, "wR": 0, "clearance": 1, "obstacles": [{"radius": 1}]}',
             "obstacle 0 lacks 'centre'"),
        ]
        for text, expected in bad:
            with open(self.path("bad.json"), "w", encoding="utf-8") as file:
                file.write(text)
            self.refuse(expected, "--problem", self.path("bad.json"))


if __name__ == "__main__":
    unittest.main()
