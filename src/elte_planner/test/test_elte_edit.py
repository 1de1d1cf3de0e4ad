# SPDX-License-Identifier: BSD-3-Clause
"""The Python module, its example and the commands elte_edit and paper_figures."""
import ast
import inspect
import json
import os
import subprocess
import tempfile
import unittest

import elte_planner
import numpy as np
from scipy.spatial.transform import Rotation

HERE = os.path.dirname(os.path.abspath(__file__))
COMMAND = os.path.join(HERE, "..", "python", "commands", "elte_edit")
DEMONSTRATION = os.path.join(HERE, "reach.csv")


def arc(nodes=40):
    s = np.linspace(0.0, np.pi, nodes)
    return np.column_stack([np.cos(s), np.sin(s)])


class Module(unittest.TestCase):
    def test_solve_keeps_fixed_rows_and_meets_constraints(self):
        zeta = arc()
        constraints = [
            elte_planner.equality(39, np.array([-1.1, 0.2])),
            elte_planner.ball(20, np.array([0.0, 1.3]), 0.1),
            elte_planner.box(30, np.array([-0.5, 0.5]), np.array([np.inf, 0.01])),
        ]
        solution = elte_planner.solve(zeta, constraints, zeta[:5])
        self.assertEqual(solution.status, "solved")
        np.testing.assert_array_equal(solution.y[:5], zeta[:5])
        np.testing.assert_array_equal(solution.y[39], [-1.1, 0.2])
        self.assertLessEqual(np.abs(solution.y[20] - [0.0, 1.3]).sum(), 0.1 + 1e-12)
        self.assertLessEqual(abs(solution.y[30, 1] - 0.5), 0.01 + 1e-12)
        self.assertLess(solution.kkt_residual, 1e-13)
        self.assertEqual(solution.forces.shape, (3, 2))

    def test_infeasible_is_a_status_and_invalid_a_value_error(self):
        points = [elte_planner.equality(39, np.array([x, 0.0])) for x in (0.0, 1.0)]
        solution = elte_planner.solve(arc(), points, arc()[:2])
        self.assertEqual(solution.status, "infeasible")
        self.assertIn("constraint 1", solution.message)
        with self.assertRaisesRegex(ValueError, "node 40"):
            elte_planner.solve(arc(), [elte_planner.ball(40, np.zeros(2), 0.1)])

    def test_demonstrations_are_thinned_and_combined(self):
        demonstration = elte_planner.load_demonstration(DEMONSTRATION)
        few = demonstration.resampled_by_douglas_peucker(6)
        self.assertTrue(set(few.times) <= set(demonstration.times))
        for alignment in ("arc_length", "dynamic_time_warping"):
            mean = elte_planner.combine([demonstration, demonstration], 30, alignment=alignment)
            np.testing.assert_allclose(
                mean.positions, demonstration.resampled_by_arc_length(30).positions, atol=1e-12)
        thinned = demonstration.thinned_by_douglas_peucker(1e-3)
        self.assertLess(len(thinned.times), len(demonstration.times))
        with self.assertRaisesRegex(ValueError, "alignment is 'x'"):
            elte_planner.combine([demonstration], 30, alignment="x")

    def test_demonstrations_are_saved_and_loaded(self):
        demonstration = elte_planner.load_demonstration(DEMONSTRATION)
        noted = elte_planner.Demonstration(
            demonstration.times, demonstration.positions, demonstration.quaternions, "arm", "hand",
            demonstration.target, {"by": "hand"})
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "saved.csv")
            elte_planner.save_demonstration(noted, path)
            loaded = elte_planner.load_demonstration(path)
            with self.assertRaisesRegex(ValueError, "none.csv: cannot be read"):
                elte_planner.load_demonstration(os.path.join(folder, "none.csv"))
        self.assertEqual(loaded.notes, {"by": "hand"})
        np.testing.assert_allclose(loaded.poses, demonstration.poses, atol=2e-9)
        np.testing.assert_array_equal(
            demonstration.poses, np.hstack([demonstration.positions, demonstration.quaternions]))
        target, goal = demonstration.target, demonstration.goal_in_target
        turn = Rotation.from_quat(target[3:])
        np.testing.assert_allclose(turn.apply(goal[:3]) + target[:3], demonstration.poses[-1, :3],
                                   atol=1e-12)

    def test_planner_names_are_those_that_plan_knows(self):
        names = elte_planner.planner_names()
        self.assertIn("elte", names)
        for name in names:
            plan = elte_planner.plan(name, arc(), arc(), 2, arc()[-1])[0]
            self.assertEqual(plan.shape, arc().shape)
        with self.assertRaisesRegex(ValueError, f"planner = none, must be one of: {', '.join(names)}"):
            elte_planner.plan("none", arc(), arc(), 2, arc()[-1])

    def test_avoid_keeps_the_clearance_and_says_when_it_cannot(self):
        zeta = arc()
        goal = [elte_planner.equality(39, np.array([-1.1, 0.0]))]
        obstacles = [elte_planner.disc_obstacle(np.array([0.0, 1.0]), 0.1),
                     elte_planner.box_obstacle(np.array([-0.8, 0.7]), np.array([0.05, 0.1]))]
        solution = elte_planner.avoid(zeta, obstacles, 0.05, goal, zeta[:5])
        self.assertEqual(solution.status, "solved", solution.message)
        self.assertGreaterEqual(solution.clearance, 0.05 - 1e-12)
        self.assertGreaterEqual(
            elte_planner.polyline_clearance(solution.y[4:], obstacles), 0.05 - 1e-12)
        obstacles.append(elte_planner.disc_obstacle(np.array([-1.1, 0.0]), 0.01))
        blocked = elte_planner.avoid(zeta, obstacles, 0.05, goal, zeta[:5])
        self.assertEqual(blocked.status, "not_found")
        self.assertEqual(blocked.y.size, 0)
        with self.assertRaisesRegex(ValueError, "clearance = 0"):
            elte_planner.avoid(zeta, obstacles, 0.0)

    def test_endpoint_solver_agrees_with_the_general_one(self):
        zeta = arc()
        goal = np.array([-1.2, 0.1])
        closed = elte_planner.EndpointSolver(zeta).solve(zeta, 10, goal, 0.05)
        general = elte_planner.solve(zeta, [elte_planner.ball(39, goal, 0.05)], zeta[:10]).y
        np.testing.assert_allclose(closed, general, atol=1e-13)


class Hints(unittest.TestCase):
    def test_name_everything_in_the_module_with_its_arguments(self):
        path = os.path.join(HERE, "..", "python", "elte_planner", "__init__.pyi")
        with open(path, encoding="utf-8") as file:
            tree = ast.parse(file.read())
        hinted = {node.name: node for node in tree.body
                  if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(hinted), {n for n, value in vars(elte_planner).items()
                                       if not (n.startswith("_") or inspect.ismodule(value))})
        for name, node in hinted.items():
            value = getattr(elte_planner, name)
            if isinstance(node, ast.ClassDef):
                members = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
                self.assertEqual(members - {"__init__"},
                                 {n for n in dir(value) if not n.startswith("_")}, name)
            else:
                hint = [a.arg for a in node.args.args + node.args.kwonlyargs]
                if inspect.isfunction(value):
                    self.assertEqual(hint, list(inspect.signature(value).parameters))
                    continue
                signature = value.__doc__.splitlines()[0]
                for argument in hint:
                    self.assertIn(argument + ":", signature)
                self.assertEqual(len(hint), signature.count(": "), signature)


class Example(unittest.TestCase):
    def test_notebook_runs(self):
        run = subprocess.run(
            ["/usr/bin/python3", os.path.join(HERE, "..", "examples", "notebook.py")], text=True,
            timeout=60, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        self.assertEqual(run.returncode, 0, run.stdout)


class Figures(unittest.TestCase):
    def run_command(self, *arguments):
        return subprocess.run(
            ["/usr/bin/python3", os.path.join(HERE, "..", "bench", "paper_figures"), *arguments], text=True,
            timeout=120, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)

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
        return subprocess.run(["/usr/bin/python3", COMMAND, *arguments], text=True, timeout=60,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)

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
        self.refuse("cannot be read", self.path("none.csv"))
        self.refuse("executed", DEMONSTRATION, "--executed", "x")
        self.refuse("frozen is 51", DEMONSTRATION, "--executed", "51")
        self.refuse("radius is -1", DEMONSTRATION, "--radius", "-1")
        self.refuse("goal", DEMONSTRATION, "--end", "nan", "0", "0")
        self.refuse("nodes is 2", DEMONSTRATION, "--nodes", "2")
        self.refuse("planner = x", DEMONSTRATION, "--planner", "x")
        self.refuse("either")
        self.refuse("--clearance belongs", DEMONSTRATION, "--clearance", "0.1")
        self.refuse("clearance = 0", DEMONSTRATION, "--sphere", *"1111", "--clearance", "0")
        self.refuse("executed is 1", DEMONSTRATION, "--sphere", *"1111", "--clearance", "1",
                    "--executed", "1")
        self.refuse("tolerance is -1", DEMONSTRATION, "--thin", "-1")
        self.refuse("within [3, 41]", DEMONSTRATION, "--thin-to", "42")
        self.refuse("max_step is 0", DEMONSTRATION, "--max-step", "0")
        self.refuse("needs --topic", self.path("none.bag"))
        self.refuse("none.bag", self.path("none.bag"), "--topic", "hand")
        bad = [
            ("null", "a problem must be an object"), ("{", "Expecting"), ("[1]", "must be an object"),
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
