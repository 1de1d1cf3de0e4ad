#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The decision node against scripted joint_states, forecasts and plans."""

import io
import random
import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import Pose
from prf_msgs.msg import ExecutionProgress, SkillTrajectory, TargetForecast, TargetPrediction
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import MultiDOFJointTrajectory

FRAME = "j2s7s300_link_base"
PIPELINE_DELAY = 60  # ms
NODES = 11


def stamp(ms):
    return rospy.Time(ms // 1000, ms % 1000 * 1000000)


def milliseconds(time):
    return time.secs * 1000 + time.nsecs // 1000000


def pose(x):
    message = Pose()
    message.position.x, message.position.z = x, 0.5
    message.orientation.w = 1
    return message


def joint_state(ms):
    message = JointState()
    message.header.stamp = stamp(ms)
    return message


def forecast(ms):
    """A target that stands 0.4 m ahead of the skill's last pose."""
    message = TargetForecast(status=TargetForecast.TRACKING, measured=True)
    message.header.stamp = stamp(ms)
    message.header.frame_id = FRAME
    for horizon in (0.0, 0.5):
        prediction = TargetPrediction(horizon=rospy.Duration(horizon), pose=pose(1.0))
        message.predictions.append(prediction)
    return message


def trajectory(progress):
    """0.3 m in 1 s, the last pose 0.4 m before the target."""
    message = SkillTrajectory(status=SkillTrajectory.SOLVED, planner="test")
    message.header = progress.header
    message.forecast_stamp = progress.forecast_stamp
    message.poses = [pose(0.3 + 0.03 * i) for i in range(NODES)]
    message.time_from_start = [rospy.Duration(0.1 * i) for i in range(NODES)]
    message.goal_in_target = pose(-0.4)
    message.goal_in_target.position.z = 0
    return message


def serialized(message):
    message.header.seq = 0
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


class World:
    """Plays a run to the node and collects what it answers."""

    def __init__(self):
        self.joint_states = rospy.Publisher("joint_states", JointState, queue_size=1000)
        self.forecasts = rospy.Publisher("target/forecast", TargetForecast, queue_size=1000)
        self.trajectories = rospy.Publisher("skill/trajectory", SkillTrajectory, queue_size=1000)
        self.changed = threading.Condition()
        self.planner_alive = True
        self.planner_delay = None
        self.clear()
        rospy.Subscriber("execution/progress", ExecutionProgress, self.on_progress)
        rospy.Subscriber("execution/setpoint", MultiDOFJointTrajectory, self.on_setpoint)
        publishers = (self.joint_states, self.forecasts, self.trajectories)
        while any(p.get_num_connections() == 0 for p in publishers):
            rospy.sleep(0.05)

    def clear(self):
        rospy.rostime.wallsleep(0.3)  # what is under way of the run before
        self.progress, self.setpoints, self.last_forecast = [], [], rospy.Time()

    def on_progress(self, message):
        with self.changed:
            new = message.forecast_stamp != self.last_forecast
            self.last_forecast = message.forecast_stamp
            self.progress.append(message)
            self.changed.notify_all()
        if new and self.planner_alive:
            if self.planner_delay:
                rospy.rostime.wallsleep(self.planner_delay())
            self.trajectories.publish(trajectory(message))

    def on_setpoint(self, message):
        with self.changed:
            self.setpoints.append(message)
            self.changed.notify_all()

    def wait_for(self, ticks, seconds=10):
        def complete():
            return len(self.progress) >= ticks and len(self.setpoints) >= ticks

        with self.changed:
            return self.changed.wait_for(complete, seconds)

    def play(self, first, last, skew=lambda: 0):
        """Ticks in [first, last) ms and the images up to then; `skew` delays forecasts, ms."""
        events = [(ms, 0, ms) for ms in range(first, last, 10)]
        due = first
        for k in range((last - first) * 30 // 1000):
            ms = first + k * 100 // 3
            due = max(due, ms + 40 + skew())  # in the order of the images whatever the skew
            events.append((due, 1, ms))
        sent = 0
        for _, is_forecast, ms in sorted(events):
            if is_forecast:
                self.forecasts.publish(forecast(ms))
                continue
            self.joint_states.publish(joint_state(ms))
            sent += 1
            # Never more than 20 ticks ahead of the answers, as a robot that waits for commands.
            self.wait_for(len(self.progress) if sent < 20 else sent - 20, 1)


class DecisionNode(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = World()
        cls.epoch = 1000000  # ms; each run begins before the one before it

    def begin_run(self):
        type(self).epoch -= 20000
        self.world.clear()
        self.world.planner_alive, self.world.planner_delay = True, None
        return self.epoch

    def test_answers_every_tick_with_equal_stamps_and_completes_the_skill(self):
        start, world = self.begin_run(), self.world
        world.play(start, start + 6000)
        # The images after 5.967 s never come, so the last ticks up to the give-up stay open.
        self.assertTrue(world.wait_for(595), len(world.progress))
        ticks = [start + 10 * i for i in range(595)]
        self.assertEqual([milliseconds(p.header.stamp) for p in world.progress[:595]], ticks)
        self.assertEqual([milliseconds(s.header.stamp) for s in world.setpoints[:595]], ticks)

        states = [p.state for p in world.progress]
        changes = [s for i, s in enumerate(states) if i == 0 or s != states[i - 1]]
        self.assertEqual(changes, [ExecutionProgress.WAITING, ExecutionProgress.FORWARD,
                                   ExecutionProgress.TRACKING, ExecutionProgress.DONE])
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
        seeds = (1, 2, 3)
        start = self.begin_run()
        for seed in seeds:
            draw = random.Random(seed)
            self.world.clear()
            self.world.planner_delay = lambda: draw.uniform(0, 0.004)
            self.world.play(start, start + 2000, skew=lambda: draw.randrange(-40, 150))
            self.assertTrue(self.world.wait_for(195), (seed, len(self.world.progress)))
            runs.append([serialized(p) + serialized(s)
                         for p, s in zip(self.world.progress[:195], self.world.setpoints[:195])])
            self.assertEqual(self.world.progress[194].state, ExecutionProgress.TRACKING)
        self.assertEqual(runs[0], runs[1])
        self.assertEqual(runs[0], runs[2])

    def test_pauses_after_max_wait_when_the_planner_is_silent_and_resumes_with_it(self):
        start, world = self.begin_run(), self.world
        world.play(start, start + 600)
        world.wait_for(55)
        before = world.progress[-1]
        self.assertEqual(before.state, ExecutionProgress.FORWARD)
        world.planner_alive = False
        self.continue_run(start + 600, 800)
        held = world.progress[-1]
        self.assertEqual(held.state, ExecutionProgress.PAUSE)
        self.assertEqual(held.reason, "planner silent")
        self.assertLessEqual(held.cursor, before.cursor + 1)
        world.planner_alive = True
        self.continue_run(start + 1400, 2000)
        self.assertEqual(world.progress[-1].state, ExecutionProgress.TRACKING)
        self.check_no_jump(world.setpoints)

    def continue_run(self, first, duration):
        """As play, but the images before are already known and the answers may be missing."""
        images = [ms for ms in (self.epoch + k * 100 // 3 for k in range(3000))
                  if first - 40 <= ms < first + duration - 40]
        for ms in range(first, first + duration, 10):
            while images and images[0] + 40 <= ms:
                self.world.forecasts.publish(forecast(images.pop(0)))
            self.world.joint_states.publish(joint_state(ms))
            rospy.rostime.wallsleep(0.003)
        rospy.rostime.wallsleep(0.3)

    def check_no_jump(self, setpoints):
        path = [s.points[0].transforms[0].translation.x for s in setpoints if s.points]
        # The skill runs at 0.3 m/s and a gap closes at 0.2 m/s on top of it.
        self.assertLess(max(abs(b - a) for a, b in zip(path, path[1:])), 0.005 + 1e-9)

    def test_begins_anew_when_the_clock_goes_back(self):
        start, world = self.begin_run(), self.world
        world.play(start, start + 500)
        self.assertTrue(world.wait_for(45))
        self.assertNotEqual(world.progress[-1].state, ExecutionProgress.WAITING)
        start = self.begin_run()
        world.joint_states.publish(joint_state(start))
        self.assertTrue(world.wait_for(1))
        first = [p for p in world.progress if milliseconds(p.header.stamp) == start][0]
        self.assertEqual(first.state, ExecutionProgress.WAITING)
        self.assertEqual(first.forecast_stamp, rospy.Time())
        self.assertEqual(first.cursor, 0)

    def test_does_not_act_on_messages_that_are_not_finite_or_in_another_frame(self):
        start, world = self.begin_run(), self.world
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
            world.joint_states.publish(joint_state(ms))
        self.assertTrue(world.wait_for(12), len(world.progress))
        for progress in world.progress:
            self.assertEqual(progress.forecast_stamp, rospy.Time())
            self.assertEqual(progress.state, ExecutionProgress.WAITING)
            self.assertEqual(progress.reason, "target not seen yet")


if __name__ == "__main__":
    rospy.init_node("test_decision_node")
    rostest.rosrun("prf_decision", "decision_node", DecisionNode)
