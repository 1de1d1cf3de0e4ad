# SPDX-License-Identifier: BSD-3-Clause
"""A scripted world around the decision node, and goals of its action."""

import threading
import unittest

import actionlib
import rospy
from geometry_msgs.msg import Pose
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import MultiDOFJointTrajectory

from prf_msgs.msg import (
    ControlStatus,
    ExecuteSkillAction,
    ExecutionProgress,
    SkillTrajectory,
    TargetForecast,
    TargetPrediction,
)

FRAME = "j2s7s300_link_base"
PIPELINE_DELAY = 50  # ms, as in decision.yaml
NODES = 11
PATIENCE = 30  # s of real time, for whatever takes no time
# The arm stands with its hand where the skill begins, 0.12 rad from upright. The tests' launch files give
# the tolerances of the following error that let it pass for an arm that follows.
ARM = {f"j2s7s300_joint_{i}": position for i, position in enumerate(
    (-0.754658290189, 1.24027238563, 1.64407448581, 5.46440628634, 1.39147026382, 1.73678809093,
     -3.04952610174), start=1)}
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
    speeds = speeds or {}
    names = list(ARM) + [name for name in speeds if name not in ARM]
    message = JointState(name=names, position=[ARM.get(name, 0) for name in names],
                         velocity=[speeds.get(name, 0) for name in names])
    message.header.stamp = stamp(ms)
    return message


def forecast(ms, age=0):
    """A target that stands 0.4 m ahead of the skill's last pose; last measured so many ms before."""
    status = TargetForecast.COASTING if age else TargetForecast.TRACKING
    message = TargetForecast(status=status, measured=not age)
    message.since_measurement = rospy.Duration(0.001 * age)
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
    message.demonstration_switch = progress.demonstration_switch
    if progress.demonstration == MISSING:
        message.status, message.message = SkillTrajectory.REFUSED, f"{MISSING}: there is no such file"
        return message
    message.poses = [pose(0.3 + 0.03 * i) for i in range(NODES)]
    message.time_from_start = [rospy.Duration(0.1 * i) for i in range(NODES)]
    message.goal_in_target = pose(-0.4)
    message.goal_in_target.position.z = 0
    return message


class World:
    """Plays a run to the node and collects what it publishes."""

    def __init__(self):
        self.joint_states = rospy.Publisher("joint_states", JointState, queue_size=1000)
        self.forecasts = rospy.Publisher("target/forecast", TargetForecast, queue_size=1000)
        self.trajectories = rospy.Publisher("skill/trajectory", SkillTrajectory, queue_size=1000)
        self.reports = rospy.Publisher("control/status", ControlStatus, queue_size=1000)
        self.changed = threading.Condition()
        self.begin(0)
        rospy.Subscriber("execution/progress", ExecutionProgress, self.on_progress)
        rospy.Subscriber("execution/setpoint", MultiDOFJointTrajectory, self.on_setpoint)
        publishers = (self.joint_states, self.forecasts, self.trajectories, self.reports)
        while any(p.get_num_connections() == 0 for p in publishers):
            rospy.sleep(0.05)

    def begin(self, start):
        rospy.rostime.wallsleep(0.3)  # what is under way of the run before
        self.last_forecast = rospy.Time()
        for ms in (30, 20, 10) if start else ():  # so many prove that the clock went back
            self.joint_states.publish(joint_state(start - ms, {}))
        rospy.rostime.wallsleep(0.3)
        self.start, self.ticks = start, 0
        self.planner_alive, self.planner_delay = True, None
        self.controller_alive = True
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

    def tick(self, ms):
        """joint_states, and the report of the controller, which comes later but may arrive before."""
        self.joint_states.publish(joint_state(ms, self.joint_speeds))
        if self.controller_alive:
            report = ControlStatus(code=ControlStatus.FOLLOWING)
            report.header.stamp = stamp(ms)
            self.reports.publish(report)

    def play(self, first, last, skew=lambda: 0):
        """Ticks in [first, last) ms of the run; an image arrives 40 ms after its exposure, and
        `skew` ms more. Returns when every tick has its progress."""
        ticks = [(ms, 0, ms) for ms in range(self.start + first, self.start + last, 10)]
        images = []
        due = 0
        for ms in (k * 100 // 3 for k in range(last * 3 // 100 + 1)):
            if first <= ms + 40 < last:
                due = max(due, ms + 40 + skew())  # in the order of the images whatever the skew
                images.append((self.start + due, 1, self.start + ms))
        for _, is_image, ms in sorted(ticks + images):
            if is_image:
                age = max(0, ms - self.start - self.target_hides)
                self.forecasts.publish(forecast(ms, age))
                continue
            self.tick(ms)
            self.ticks += 1
            # As a robot that waits for its commands; what is silent is given up after 30.
            alive = self.planner_alive and self.controller_alive
            self.wait_for(self.ticks - (20 if alive else 40))
        return self.wait_for(self.ticks - (0 if alive else 40))


class GoalTest(unittest.TestCase):
    """Goals in the class's `world`; each test is a run of its own."""

    @classmethod
    def connect(cls):
        cls.client = actionlib.ActionClient("execute_skill", ExecuteSkillAction)
        assert cls.client.wait_for_server(rospy.Duration(PATIENCE))
        cls.epoch = 3000000  # ms; each run begins before the one before it

    def setUp(self):
        self.begin_run()

    def begin_run(self):
        type(self).epoch -= 100000
        self.world.begin(self.epoch)
        self.now = 0
        self.play(0.1)  # a goal before the first tick would be one of the run before

    def play(self, seconds):
        until = self.now + int(1000 * seconds)
        self.assertTrue(self.world.play(self.now, until), len(self.world.progress))
        self.now = until
        return self.world.progress[-1]

    def wait(self, condition):
        for _ in range(100 * PATIENCE):
            if condition():
                return
            rospy.rostime.wallsleep(0.01)
        self.fail("timed out")

    def wait_until_seen(self, handle):
        self.wait(lambda: handle.get_comm_state() != actionlib.CommState.WAITING_FOR_GOAL_ACK)

    def result(self, handle):
        self.wait(lambda: handle.get_comm_state() == actionlib.CommState.DONE)
        return handle.get_terminal_state(), handle.get_result()
