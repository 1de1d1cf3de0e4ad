#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The decision node against scripted joint_states, forecasts and plans."""

import io
import os
import random
import sys
import unittest

import rospkg
import rospy
import rostest

from prf_msgs.msg import ExecutionProgress

sys.path.insert(0, os.path.join(rospkg.RosPack().get_path("prf_decision"), "test", "node"))
from scripted_world import FRAME, NODES, PIPELINE_DELAY, World, forecast, joint_state, milliseconds


def serialized(message):
    message.header.seq = 0
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


class DecisionNode(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = World()
        cls.epoch = 1000000  # ms; each run begins before the one before it

    def begin_run(self):
        type(self).epoch -= 20000
        self.world.begin(self.epoch)
        return self.epoch, self.world

    def test_answers_every_tick_with_equal_stamps_and_completes_the_skill(self):
        start, world = self.begin_run()
        self.assertTrue(world.play(0, 6000), len(world.progress))
        ticks = [start + 10 * i for i in range(600)]
        self.assertEqual([milliseconds(p.header.stamp) for p in world.progress], ticks)
        self.assertEqual([milliseconds(s.header.stamp) for s in world.setpoints], ticks)

        states = [p.state for p in world.progress]
        changes = [s for i, s in enumerate(states) if i == 0 or s != states[i - 1]]
        self.assertEqual(changes, [ExecutionProgress.WAITING, ExecutionProgress.FORWARD,
                                   ExecutionProgress.TRACKING, ExecutionProgress.DONE])
        named = [p for p in world.progress if p.forecast_stamp.to_nsec()]
        self.assertEqual(len(named), 600 - PIPELINE_DELAY // 10)  # from the first image's tick on
        for progress, setpoint in zip(world.progress, world.setpoints):
            moving = progress.state != ExecutionProgress.WAITING
            self.assertEqual(len(setpoint.points), 1 if moving else 0)
            self.assertEqual(setpoint.joint_names, ["j2s7s300_end_effector"])
            self.assertEqual(setpoint.header.frame_id, FRAME)
            self.assertAlmostEqual(sum(progress.posterior), 1, 12)
            if progress.forecast_stamp.to_nsec():
                age = (progress.header.stamp - progress.forecast_stamp).to_nsec()
                self.assertGreaterEqual(age, PIPELINE_DELAY * 1000000)
        last = world.setpoints[-1].points[0].transforms[0].translation
        self.assertAlmostEqual(last.x, 0.6, 9)
        self.assertAlmostEqual(last.z, 0.5, 9)
        self.assertEqual(world.progress[-1].frozen, NODES)

    def test_gives_the_same_outputs_whatever_the_interleaving(self):
        runs = []
        start, world = self.begin_run()
        for seed in (1, 2, 3):
            draw = random.Random(seed)
            world.begin(start)
            world.planner_delay = lambda draw=draw: draw.uniform(0, 0.004)
            self.assertTrue(world.play(0, 2000, skew=lambda draw=draw: draw.randrange(-40, 150)), seed)
            runs.append([serialized(p) + serialized(s)
                         for p, s in zip(world.progress, world.setpoints)])
            self.assertEqual(len(runs[-1]), 200)
            self.assertEqual(world.progress[-1].state, ExecutionProgress.TRACKING)
        self.assertEqual(runs[0], runs[1])
        self.assertEqual(runs[0], runs[2])

    # Fault 26: planner killed and respawned -> pause within max_wait, then on without a jump
    def test_pauses_after_max_wait_when_the_planner_is_silent_and_resumes_with_it(self):
        _, world = self.begin_run()
        self.assertTrue(world.play(0, 600))
        before = world.progress[-1]
        self.assertEqual(before.state, ExecutionProgress.FORWARD)
        world.planner_alive = False
        self.assertTrue(world.play(600, 1400))
        held = world.progress[-1]
        self.assertEqual(held.state, ExecutionProgress.PAUSE)
        self.assertEqual(held.reason, "planner silent")
        self.assertLessEqual(held.cursor, before.cursor + 1)
        world.planner_alive = True
        self.assertTrue(world.play(1400, 3400))
        self.assertEqual(world.progress[-1].state, ExecutionProgress.TRACKING)
        self.check_no_jump(world.setpoints)

    # Fault 17: target covered for long -> the camera looks around from the start, and goes on when it sees it
    def test_searches_a_target_that_is_out_of_sight_and_goes_on_when_it_is_seen(self):
        _, world = self.begin_run()
        world.target_hides = 500
        self.assertTrue(world.play(0, 6000))
        searching = [i for i, p in enumerate(world.progress) if p.state == ExecutionProgress.SEARCH]
        self.assertGreater(len(searching), 300)
        self.assertIn("looks 0.40 rad around its last place", world.progress[searching[-1]].reason)
        hands = [world.setpoints[i].points[0].transforms[0] for i in searching[30:]]
        self.assertLess(max(abs(hand.translation.x - 0.3) for hand in hands), 1e-3)
        self.assertGreater(max(abs(hand.rotation.y) + abs(hand.rotation.z) for hand in hands), 0.15)
        world.target_hides = float("inf")
        self.assertTrue(world.play(6000, 8000))
        later = [p.state for p in world.progress[600:]]
        self.assertIn(ExecutionProgress.REVERSE, later)
        self.assertEqual(later[-1], ExecutionProgress.TRACKING)

    def check_no_jump(self, setpoints):
        path = [s.points[0].transforms[0].translation.x for s in setpoints if s.points]
        # The skill runs at 0.3 m/s and a gap closes at 0.2 m/s on top of it.
        self.assertLess(max(abs(b - a) for a, b in zip(path, path[1:])), 0.005 + 1e-9)

    # Fault 11: clock goes back -> a new run from the initial state, once three ticks agree
    def test_begins_anew_when_the_clock_goes_back(self):
        _, world = self.begin_run()
        self.assertTrue(world.play(0, 500))
        self.assertNotEqual(world.progress[-1].state, ExecutionProgress.WAITING)
        start, world = self.begin_run()
        self.assertTrue(world.play(0, 10))
        first = world.progress[0]
        self.assertEqual(milliseconds(first.header.stamp), start)
        self.assertEqual(first.state, ExecutionProgress.WAITING)
        self.assertEqual(first.forecast_stamp, rospy.Time())
        self.assertEqual(first.cursor, 0)

    # Fault 40: ticks, forecasts, plans late, early, doubled, without the arm -> dropped, the run goes on
    def test_goes_on_whatever_single_messages_come_late_early_doubled_or_without_the_arm(self):
        start, world = self.begin_run()
        self.assertTrue(world.play(0, 600))
        before = world.progress[-1]
        self.assertEqual(before.state, ExecutionProgress.FORWARD)
        for ms in (-5000, -1500, -10, 590, 3600000):  # from the start of the run
            world.joint_states.publish(joint_state(start + ms))
            world.forecasts.publish(forecast(start + ms))
            rospy.rostime.wallsleep(0.02)
        legs = joint_state(start + 605)
        legs.name = [f"leg_{i}" for i in range(len(legs.name))]
        world.joint_states.publish(legs)
        rospy.rostime.wallsleep(0.1)
        self.assertTrue(world.play(600, 1000))
        self.assertEqual(len(world.progress), 100)
        self.assertEqual(world.progress[-1].state, ExecutionProgress.FORWARD)
        self.assertGreater(world.progress[-1].cursor, before.cursor + 3)

    def test_does_not_act_on_messages_that_are_not_finite_or_in_another_frame(self):
        start, world = self.begin_run()
        for k in range(3):
            bad = forecast(start + k * 100 // 3)
            if k == 0:
                bad.predictions[0].pose.position.x = float("nan")
            elif k == 1:
                bad.predictions[1].pose.orientation.w = 0
            else:
                bad.header.frame_id = "elsewhere"
            world.forecasts.publish(bad)
        for ms in range(start, start + 120, 10):
            world.tick(ms)
        self.assertTrue(world.wait_for(12), len(world.progress))
        for progress in world.progress:
            self.assertEqual(progress.forecast_stamp, rospy.Time())
            self.assertEqual(progress.state, ExecutionProgress.WAITING)
            self.assertEqual(progress.reason, "target not seen yet")


if __name__ == "__main__":
    rospy.init_node("test_decision_node")
    rostest.rosrun("prf_decision", "decision_node", DecisionNode)
