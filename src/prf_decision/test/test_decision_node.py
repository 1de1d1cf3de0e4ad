#!/usr/bin/python3
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
MISSING = "missing.csv"  # a demonstration that the planner refuses


def stamp(ms):
    return rospy.Time(ms // 1000, ms % 1000 * 1000000)


def milliseconds(time):
    return time.secs * 1000 + time.nsecs // 1000000


def pose(x):
    message = Pose()
    message.position.x, message.position.z = x, 0.5
    message.orientation.w = 1
    return message


def joint_state(ms, speeds=None):
    message = JointState(name=list(speeds or ()), velocity=list((speeds or {}).values()))
    message.header.stamp = stamp(ms)
    return message


def forecast(ms, unseen=0):
    """A target that stands 0.4 m ahead of the skill's last pose; not seen for so many ms."""
    status = TargetForecast.COASTING if unseen else TargetForecast.TRACKING
    message = TargetForecast(status=status, measured=not unseen)
    message.since_measurement = rospy.Duration(0.001 * unseen)
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
    message.handover = progress.handover
    if progress.demonstration == MISSING:
        message.status, message.message = SkillTrajectory.REFUSED, f"{MISSING}: cannot be read"
        return message
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
        self.begin(0)
        rospy.Subscriber("execution/progress", ExecutionProgress, self.on_progress)
        rospy.Subscriber("execution/setpoint", MultiDOFJointTrajectory, self.on_setpoint)
        publishers = (self.joint_states, self.forecasts, self.trajectories)
        while any(p.get_num_connections() == 0 for p in publishers):
            rospy.sleep(0.05)

    def begin(self, start):
        rospy.rostime.wallsleep(0.5)  # what is under way of the run before
        self.start, self.ticks = start, 0
        self.planner_alive, self.planner_delay = True, None
        self.joint_speeds, self.target_hides = {}, float("inf")  # rad/s; ms of the run
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

    def wait_for(self, ticks, seconds=30):
        def complete():
            return len(self.progress) >= ticks and len(self.setpoints) >= ticks

        with self.changed:
            return self.changed.wait_for(complete, seconds)

    def play(self, first, last, skew=lambda: 0):
        """Ticks in [first, last) ms of the run; an image arrives 40 ms after its exposure, and
        `skew` ms more. Returns when every tick is answered."""
        ticks = [(ms, 0, ms) for ms in range(self.start + first, self.start + last, 10)]
        images = []
        due = 0
        for ms in (k * 100 // 3 for k in range(last * 3 // 100 + 1)):
            if first <= ms + 40 < last:
                due = max(due, ms + 40 + skew())  # in the order of the images whatever the skew
                images.append((self.start + due, 1, self.start + ms))
        for _, is_image, ms in sorted(ticks + images):
            if is_image:
                unseen = max(0, ms - self.start - self.target_hides)
                self.forecasts.publish(forecast(ms, unseen))
                continue
            self.joint_states.publish(joint_state(ms, self.joint_speeds))
            self.ticks += 1
            # As a robot that waits for its commands; without a planner it is given up after 30.
            ahead = 20 if self.planner_alive else 40
            self.wait_for(self.ticks - ahead)
        return self.wait_for(self.ticks - (0 if self.planner_alive else 40))


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
            world.planner_delay = lambda: draw.uniform(0, 0.004)
            self.assertTrue(world.play(0, 2000, skew=lambda: draw.randrange(-40, 150)), seed)
            runs.append([serialized(p) + serialized(s)
                         for p, s in zip(world.progress, world.setpoints)])
            self.assertEqual(len(runs[-1]), 200)
            self.assertEqual(world.progress[-1].state, ExecutionProgress.TRACKING)
        self.assertEqual(runs[0], runs[1])
        self.assertEqual(runs[0], runs[2])

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

    def check_no_jump(self, setpoints):
        path = [s.points[0].transforms[0].translation.x for s in setpoints if s.points]
        # The skill runs at 0.3 m/s and a gap closes at 0.2 m/s on top of it.
        self.assertLess(max(abs(b - a) for a, b in zip(path, path[1:])), 0.005 + 1e-9)

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
            world.joint_states.publish(joint_state(ms))
        self.assertTrue(world.wait_for(12), len(world.progress))
        for progress in world.progress:
            self.assertEqual(progress.forecast_stamp, rospy.Time())
            self.assertEqual(progress.state, ExecutionProgress.WAITING)
            self.assertEqual(progress.reason, "target not seen yet")


if __name__ == "__main__":
    rospy.init_node("test_decision_node")
    rostest.rosrun("prf_decision", "decision_node", DecisionNode)
