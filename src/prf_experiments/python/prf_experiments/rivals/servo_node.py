# SPDX-License-Identifier: BSD-3-Clause
"""Node pose_servo: takes the decision's place with planner:=servo (pose_servo.py).

The planner runs beside it, for the goal of the hand alone. A forecast counts for where the target was measured at its
stamp, and is used from the first tick that is `pipeline_delay` later, as the decision does.
"""
from dataclasses import fields
from typing import Any

import geometry_msgs.msg
import numpy as np
import rospy
import sensor_msgs.msg
import trajectory_msgs.msg

import prf_msgs.msg
from prf_experiments import robots
from prf_experiments.record.recording import pose_values
from prf_experiments.rivals.pose_servo import Move, PoseServo, ServoParams
from prf_experiments.robot.arm import Chain

QUEUE = 1000
State = prf_msgs.msg.ExecutionProgress


def read_parameters() -> tuple[ServoParams, float, robots.Robot]:
    """ServoParams, pipeline_delay, s, and the robot, from the private namespace; ValueError names what is wrong."""
    given = {name: value for name, value in rospy.get_param("~", {}).items() if not name.startswith("__")}
    known = {entry.name for entry in fields(ServoParams)} | {"pipeline_delay", "robot"}
    if set(given) != known:
        raise ValueError(f"{', '.join(sorted(set(given) ^ known))}: missing or unknown, start the node by its launch")
    delay, robot = float(given.pop("pipeline_delay")), robots.load(given.pop("robot"))
    values: dict[str, Any] = {name: tuple(value) if isinstance(value, list) else value
                              for name, value in given.items()}
    params = ServoParams(**values)
    params.validate()
    return params, delay, robot


class Execution:
    """States and times of one run; its stamps are those of the ticks."""

    def __init__(self, params: ServoParams):
        self._params, self._servo = params, PoseServo(params)
        self._began: float | None = None
        self._tracked: float | None = None
        self.state, self.reason, self._limit_passed = State.WAITING, "target not seen yet", False

    def tick(self, now: float, hand: np.ndarray, seen: tuple[float, np.ndarray] | None,
             goal: np.ndarray | None) -> Move | None:
        """seen: stamp and pose of the last measurement. None: hold."""
        self._began = now if self._began is None else self._began
        if self.state in (State.DONE, State.STOPPED):
            return self._follow(now, hand, seen, goal) if self.state == State.DONE else None
        if now - self._began > self._params.time_limit:
            self.state, self.reason = State.STOPPED, f"not done within {self._params.time_limit:g} s"
            return None
        move = self._follow(now, hand, seen, goal)
        if move is None:
            return None
        near = all(error <= most for error, most in zip(move.error, self._params.tolerance))
        self._tracked = (now if self._tracked is None else self._tracked) if near else None
        self.state, self.reason = (State.TRACKING if near else State.FORWARD), ""
        if self._tracked is not None and now - self._tracked >= self._params.hold_time:
            self.state, self.reason = State.DONE, f"tracked for {self._params.hold_time:g} s"
        return move

    def _follow(self, now, hand, seen, goal):
        if seen is not None and goal is not None and now - seen[0] <= self._params.target_timeout:
            return self._servo.move(now, hand, seen[1], goal)
        self._servo.stop()
        self._tracked = None
        if self.state not in (State.WAITING, State.DONE):
            self.state, self.reason = State.PAUSE, "no measurement of the target"
        return None


class ServoNode:
    def __init__(self, params: ServoParams, pipeline_delay: float, robot: robots.Robot):
        self._execution, self._delay, self._robot = Execution(params), pipeline_delay, robot
        self._arm = Chain(rospy.get_param("robot_description"), robot.base_link, robot.tip_link)
        self._forecasts: list = []  # not yet in force
        self._goal: np.ndarray | None = None
        self._seen: tuple[float, np.ndarray] | None = None
        self._forecast_stamp = rospy.Time()
        self._setpoints = rospy.Publisher("execution/setpoint", trajectory_msgs.msg.MultiDOFJointTrajectory,
                                          queue_size=QUEUE, tcp_nodelay=True)
        self._progress = rospy.Publisher("execution/progress", State, queue_size=QUEUE, tcp_nodelay=True)
        for topic, kind, take in (("target/forecast", prf_msgs.msg.TargetForecast, self._forecasts.append),
                                  ("skill/trajectory", prf_msgs.msg.SkillTrajectory, self._take_plan),
                                  ("control/status", prf_msgs.msg.ControlStatus, lambda _: None),
                                  ("joint_states", sensor_msgs.msg.JointState, self._take_tick)):
            rospy.Subscriber(topic, kind, take, queue_size=QUEUE, tcp_nodelay=True)

    def _take_plan(self, message):
        if message.poses:
            self._goal = np.array(pose_values(message.goal_in_target))

    def _take_tick(self, message):
        positions = dict(zip(message.name, message.position))
        if any(joint not in positions for joint in self._arm.joints):
            return
        now = message.header.stamp.to_sec()
        while self._forecasts and self._forecasts[0].header.stamp.to_sec() + self._delay <= now + 1e-9:
            forecast = self._forecasts.pop(0)
            self._forecast_stamp = forecast.header.stamp
            if forecast.measured and forecast.predictions:
                self._seen = forecast.header.stamp.to_sec(), np.array(pose_values(forecast.predictions[0].pose))
        hand = self._arm.poses(np.array([[positions[joint] for joint in self._arm.joints]]))[0]
        self._publish(message.header.stamp, self._execution.tick(now, hand, self._seen, self._goal))

    def _publish(self, stamp, move):
        setpoint = trajectory_msgs.msg.MultiDOFJointTrajectory(joint_names=[self._robot.tip_link])
        progress = State(state=self._execution.state, reason=self._execution.reason, posterior=[1.0, 0.0, 0.0],
                         forecast_stamp=self._forecast_stamp, following_error=-1, following_rotation=-1, holdable=-1)
        for message in (setpoint, progress):
            message.header.stamp, message.header.frame_id = stamp, self._robot.base_link
        if move is not None:
            pose, twist, kind = move.pose, move.twist, geometry_msgs.msg
            setpoint.points = [trajectory_msgs.msg.MultiDOFJointTrajectoryPoint(
                transforms=[kind.Transform(kind.Vector3(*pose[:3]), kind.Quaternion(*pose[3:]))],
                velocities=[kind.Twist(kind.Vector3(*twist[:3]), kind.Vector3(*twist[3:]))])]
        self._progress.publish(progress)
        self._setpoints.publish(setpoint)


def main() -> int:
    rospy.init_node("pose_servo")
    try:
        node = ServoNode(*read_parameters())
    except (ValueError, TypeError, KeyError) as error:
        rospy.logfatal("pose_servo: %s", error)
        return 2
    rospy.spin()
    del node
    return 0
