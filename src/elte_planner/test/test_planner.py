# SPDX-License-Identifier: BSD-3-Clause
"""Planner, Session and what they are fitted to."""
import os
import unittest

import numpy as np

import elte_planner
from elte_planner import Planner, Via, measures

HERE = os.path.dirname(os.path.abspath(__file__))
DEMONSTRATION = os.path.join(HERE, "reach.csv")


def wave(nodes=60, dimensions=2):
    s = np.linspace(0.0, 1.0, nodes)
    return np.column_stack([s, 0.2 * np.sin(2.0 * np.pi * s), *[0.1 * s**k for k in range(2, dimensions)]])


class Fit(unittest.TestCase):
    def test_takes_arrays_demonstrations_and_files(self):
        demonstration = elte_planner.load_demonstration(DEMONSTRATION)
        sources: list = [DEMONSTRATION, demonstration, [DEMONSTRATION, demonstration]]
        for given in sources:
            skill = Planner().fit(given, nodes=30).skill
            assert skill.quaternions is not None
            np.testing.assert_allclose(skill.positions, demonstration.resampled_by_arc_length(30).positions, atol=1e-9)
            self.assertEqual(skill.quaternions.shape, (30, 4))
        for dimensions in (2, 3, 7):
            skill = Planner().fit(wave(dimensions=dimensions), nodes=20).skill
            self.assertEqual(skill.positions.shape, (20, dimensions))
            steps = np.linalg.norm(np.diff(skill.positions, axis=0), axis=1)
            np.testing.assert_allclose(steps, steps.mean(), rtol=0.03)
            self.assertIsNone(skill.quaternions)

    def test_averages_several_and_thins(self):
        above, below = wave() + [0.0, 0.01], wave(80) - [0.0, 0.01]
        mean = Planner().fit([above, below], nodes=40).skill
        np.testing.assert_allclose(mean.positions, Planner().fit(wave(), nodes=40).skill.positions, atol=1e-3)
        warped = Planner().fit([above, below], nodes=40, alignment="dynamic_time_warping").skill
        self.assertEqual(len(warped.positions), 40)
        thin = Planner().fit(wave(), thin=0.01).skill
        self.assertLess(len(thin.positions), 20)
        np.testing.assert_array_equal(Planner().fit(wave(), nodes=None).skill.positions, wave())
        times = np.linspace(0.0, 3.0, 60)
        self.assertEqual(Planner().fit(wave(), times=times).skill.times[-1], 3.0)

    def test_refuses_what_contradicts_itself(self):
        for refusal, given, options in (
                ("shape", [1.0, 2.0, 3.0], {}), ("of one kind", [wave(), DEMONSTRATION], {}),
                ("must have as many", [wave(), wave(dimensions=3)], {}), ("nodes is 2", wave(), {"nodes": 2}),
                ("at most 3 dimensions", wave(dimensions=7), {"thin": 0.1}),
                ("belong to one demonstration", [wave(), wave()], {"times": np.arange(60)}),
                ("none.csv: there is no such file", "none.csv", {}), ("time", wave(), {"times": np.zeros(60)}),
                ("alignment is 'x'", [wave(), wave()], {"alignment": "x"})):
            with self.assertRaisesRegex(ValueError, refusal):
                Planner().fit(given, **options)
        with self.assertRaisesRegex(ValueError, "planner = pid, must be one of: elte"):
            Planner("pid")
        with self.assertRaisesRegex(ValueError, "call fit"):
            Planner().plan([0.0, 0.0])


class Plans(unittest.TestCase):
    def test_every_planner_ends_near_the_goal_and_keeps_what_is_frozen(self):
        goal = np.array([1.1, 0.1])
        for kind in elte_planner.planner_names():
            planner = Planner(kind).fit(wave())
            plan = planner.plan(goal, frozen=20)
            np.testing.assert_array_equal(plan.positions[:20], planner.skill.positions[:20])
            self.assertLess(plan.end_error, 0.05 if kind == "dmp" else 1e-12, kind)
            moved = planner.plan(goal, start=[0.1, 0.1])
            np.testing.assert_allclose(moved.positions[0], [0.1, 0.1], atol=1e-15)
            again = planner.plan(goal, frozen=plan.positions[:20])
            np.testing.assert_array_equal(again.positions, plan.positions)

    def test_keep_via_points_and_clearance(self):
        obstacle = elte_planner.disc_obstacle(np.array([0.75, -0.2]), 0.05)
        for kind in ("elte", "lte"):
            planner = Planner(kind).fit(wave())
            plan = planner.plan([1.0, 0.1], via=[[0.25, 0.3], Via([0.5, 0.0], node=25, radius=0.02)])
            self.assertEqual(plan.status, "solved")
            np.testing.assert_allclose(plan.positions[plan.via[0].node], [0.25, 0.3], atol=1e-12)
            self.assertLessEqual(np.abs(plan.positions[25] - [0.5, 0.0]).sum(), 0.02 + 1e-12)
            without = planner.plan([1.0, 0.1]).positions
            self.assertEqual(plan.via[0].node, np.argmin(np.linalg.norm(without - [0.25, 0.3], axis=1)))
            around = planner.plan([1.0, 0.1], obstacles=[obstacle], clearance=0.03, via=[[0.25, 0.3]])
            self.assertEqual(around.status, "solved", around.message)
            self.assertGreaterEqual(
                elte_planner.polyline_clearance(around.positions[1:], [obstacle]), 0.03 - 1e-12)
            np.testing.assert_allclose(around.positions[around.via[0].node], [0.25, 0.3], atol=1e-12)
            far = planner.plan([1.0, 0.1], obstacles=[elte_planner.disc_obstacle(np.array([9.0, 9.0]), 0.1)],
                               clearance=0.03)
            np.testing.assert_allclose(far.positions, without, atol=1e-9)
        blocked = planner.plan([0.75, -0.2], obstacles=[obstacle], clearance=0.03)
        self.assertFalse(blocked.found)
        self.assertTrue(blocked.message)
        self.assertEqual(blocked.positions.shape, (0, 2))

    def test_stop_at_the_radius_and_at_the_bound_on_steps(self):
        radius = elte_planner.confidence_radius(np.diag([1e-4, 4e-4]), 0.9)
        plan = Planner().fit(wave()).plan([1.2, 0.3], radius=radius)
        self.assertGreater(plan.end_error, 0.5 * radius)
        self.assertLessEqual(plan.end_error, radius + 1e-12)
        relaxed = Planner(max_step=0.04).fit(wave()).plan([3.0, 0.0], frozen=30)
        self.assertEqual(relaxed.status, "relaxed")
        self.assertGreater(relaxed.slack, 0.5)

    def test_turn_toward_the_goal(self):
        planner = Planner().fit(DEMONSTRATION, nodes=30)
        goal = np.array([0.6, 0.1, 0.4, 0.0, 0.0, np.sin(0.4), np.cos(0.4)])
        plan = planner.plan(goal, frozen=10)
        assert plan.quaternions is not None and planner.skill.quaternions is not None
        np.testing.assert_allclose(plan.quaternions[:10], planner.skill.quaternions[:10], atol=1e-12)
        self.assertAlmostEqual(abs(plan.quaternions[-1] @ goal[3:]), 1.0, 12)
        turns = np.abs(np.sum(plan.quaternions[1:] * plan.quaternions[:-1], axis=1))
        self.assertGreater(turns.min(), 0.99)
        poses = np.hstack([plan.positions, plan.quaternions])
        again = planner.plan(goal, frozen=poses[:15])
        assert again.quaternions is not None
        np.testing.assert_allclose(again.quaternions, plan.quaternions, atol=1e-9)
        with self.assertRaisesRegex(ValueError, "unit length"):
            planner.plan([*goal[:3], 0.0, 0.0, 0.0, 2.0])

    def test_refuse_what_contradicts_itself(self):
        planner = Planner().fit(wave())
        obstacle = elte_planner.disc_obstacle(np.array([0.75, -0.2]), 0.05)
        for refusal, options in (
                ("start and frozen", {"start": [0, 0], "frozen": 3}), ("belong together", {"obstacles": [obstacle]}),
                ("belong together", {"clearance": 0.1}), ("frozen is 1", {"frozen": 1}),
                ("goal has shape", {"goal": [1, 2, 3]}), ("via has shape", {"via": [[1, 2, 3]]}),
                ("columns, must have 2", {"frozen": np.zeros((3, 3))}), ("at most 50", {"frozen": wave()}),
                ("no node is free", {"frozen": 50, "via": [[0, 0]]}), ("radius", {"radius": np.nan}),
                ("goal", {"goal": [np.nan, 0]})):
            with self.assertRaisesRegex(ValueError, refusal):
                planner.plan(**options)
        with self.assertRaisesRegex(ValueError, "need the planner elte or lte, not dmp"):
            Planner("dmp").fit(wave()).plan(via=[[0.5, 0.0]])


class Sessions(unittest.TestCase):
    def test_keep_what_is_executed_and_follow_the_goal(self):
        session = Planner().fit(wave()).session()
        executed: np.ndarray = np.empty((0, 2))
        for k in range(2, 51):
            goal = np.array([1.0 + 0.002 * k, 0.05 * np.sin(0.2 * k)])
            plan = session.plan(goal, executed=k)
            np.testing.assert_array_equal(plan.positions[:len(executed)], executed)
            executed = plan.positions[:k].copy()
        self.assertLess(np.abs(executed[-2] - plan.positions[-1]).sum(), 0.1)

    def test_go_on_with_the_last_plan_when_there_is_no_new_one(self):
        session = Planner().fit(wave()).session()
        first = session.plan([1.1, 0.0])
        wall = elte_planner.disc_obstacle(np.array([1.1, 0.0]), 0.05)
        failed = session.plan([1.1, 0.0], executed=10, obstacles=[wall], clearance=0.01)
        self.assertFalse(failed.found)
        self.assertIs(session.current, first)


class Measures(unittest.TestCase):
    def test_tell_how_alike_trajectories_are(self):
        path = wave()
        self.assertEqual(measures.frechet_distance(path, path), 0.0)
        self.assertAlmostEqual(measures.frechet_distance(path, path + [0.0, 0.3]), 0.3)
        # The second walker must wait at its first node while the first one goes there and back.
        there_and_back = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]])
        self.assertAlmostEqual(measures.frechet_distance(there_and_back, np.zeros((2, 2))), 1.0)
        self.assertAlmostEqual(measures.angular_similarity(path, 2.0 * path), 1.0, 7)
        self.assertAlmostEqual(measures.angular_similarity(path, -path), 0.0, 7)
        self.assertAlmostEqual(measures.angular_similarity(path, path @ [[0.0, 1.0], [-1.0, 0.0]]), 0.5, 7)
        with self.assertRaisesRegex(ValueError, "must have as many"):
            measures.angular_similarity(path, path[:-1])
        self.assertEqual(measures.end_error(path, path[-1] + [0.3, 0.4]), 0.5)


if __name__ == "__main__":
    unittest.main()
