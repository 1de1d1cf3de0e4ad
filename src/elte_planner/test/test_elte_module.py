# SPDX-License-Identifier: BSD-3-Clause
"""The Python module, its type hints and its example."""
import ast
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import elte_planner
from elte_planner import _core

HERE = os.path.dirname(os.path.abspath(__file__))
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
            with self.assertRaisesRegex(ValueError, "none.csv: there is no such file"):
                elte_planner.load_demonstration(os.path.join(folder, "none.csv"))
        self.assertEqual(loaded.notes, {"by": "hand"})
        np.testing.assert_allclose(loaded.poses, demonstration.poses, atol=2e-9)
        np.testing.assert_array_equal(
            demonstration.poses, np.hstack([demonstration.positions, demonstration.quaternions]))
        target, goal = demonstration.target, demonstration.goal_in_target
        axis, w = target[3:6], target[6]  # rotated: v + 2 w (u x v) + 2 u x (u x v)
        across = 2.0 * np.cross(axis, goal[:3])
        turned = goal[:3] + w * across + np.cross(axis, across)
        np.testing.assert_allclose(turned + target[:3], demonstration.poses[-1, :3], atol=1e-12)

    def test_planner_names_are_those_that_plan_knows(self):
        names = elte_planner.planner_names()
        self.assertIn("elte", names)
        for name in names:
            result = elte_planner.SkillPlanner(name, arc()).plan(arc(), 2, arc()[-1])
            self.assertEqual(result.positions.shape, arc().shape)
        with self.assertRaisesRegex(ValueError, f"planner = none, must be one of: {', '.join(names)}"):
            elte_planner.SkillPlanner("none", arc())

    def test_planner_names_are_those_that_the_documents_list(self):
        for name in ("launch/skill_planner.launch", "config/skill_planner.yaml", "README.md"):
            with open(os.path.join(HERE, "..", name), encoding="utf-8") as file:
                text = file.read()
            for planner in elte_planner.planner_names():
                self.assertRegex(text, rf"\b{planner}\b", name)

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
    def test_name_everything_in_the_compiled_part_with_its_arguments(self):
        path = os.path.join(os.path.dirname(elte_planner.__file__), "_core.pyi")
        with open(path, encoding="utf-8") as file:
            tree = ast.parse(file.read())
        hinted = {node.name: node for node in tree.body
                  if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(hinted), {name for name in vars(_core) if not name.startswith("_")})
        for name, node in hinted.items():
            value = getattr(_core, name)
            if isinstance(node, ast.ClassDef):
                members = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
                self.assertEqual(members - {"__init__"},
                                 {n for n in dir(value) if not n.startswith("_")}, name)
            else:
                hint = [a.arg for a in node.args.args + node.args.kwonlyargs]
                signature = value.__doc__.splitlines()[0]
                for argument in hint:
                    self.assertIn(argument + ":", signature)
                self.assertEqual(len(hint), signature.split(" -> ")[0].count(": "), signature)

    def test_what_the_package_offers_is_documented(self):
        for name in elte_planner.__all__:
            self.assertTrue(getattr(elte_planner, name).__doc__, name)


class Example(unittest.TestCase):
    def test_cells_run(self):
        run = subprocess.run(
            [sys.executable, os.path.join(HERE, "..", "examples", "notebook.py")], text=True,
            timeout=60, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        self.assertEqual(run.returncode, 0, run.stdout)


if __name__ == "__main__":
    unittest.main()
