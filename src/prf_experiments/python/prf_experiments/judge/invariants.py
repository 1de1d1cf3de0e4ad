# SPDX-License-Identifier: BSD-3-Clause
"""What must hold for every joint command of every trial, whatever goes wrong in it.

With the command q', v' of a tick, the command q, v of the tick before and the measured joints:

  finite numbers
  lower <= q' <= upper, or not farther outside than q or the measured joint
  |q' - q| <= velocity dt                   the command goes on, or
  |q' - measured| <= velocity dt, v' = 0    it begins anew from the measured joints
  |v'| <= velocity, |v' - v| <= acceleration dt where it goes on
  |q' - measured| <= max_tracking_error + velocity dt

Limits are those of the robot's description and of arm_controller's parameters.
"""
import os
import xml.etree.ElementTree
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import rospkg
import yaml

from prf_experiments.judge import judge
from prf_experiments.record.recording import Joints, Recording
from prf_experiments.robots import Robot

TOLERANCE = 1e-6  # relative, and rad or rad/s
TOLD = 3  # violations of a kind


@dataclass(frozen=True)
class Limits:
    lower: np.ndarray  # (7,) rad, -inf for a joint that turns without end
    upper: np.ndarray
    velocity: np.ndarray  # (7,) rad/s
    acceleration: float  # rad/s^2
    lag: float  # rad


@dataclass
class Findings:
    violations: list = field(default_factory=list)
    figures: dict = field(default_factory=dict)

    def as_json(self) -> dict:
        return {"violations": self.violations, **self.figures}


def limits(robot: Robot) -> Limits:
    """Of the packages as they are installed."""
    joints: Any = {joint.get("name"): joint
                   for joint in xml.etree.ElementTree.parse(robot.urdf_file).iter("joint")}
    bounds = {name: joints[name].find("limit") for name in robot.joints}
    with open(os.path.join(rospkg.RosPack().get_path("prf_control"), "config",
                           "arm_controller.yaml"), encoding="utf-8") as stream:
        parameters = yaml.safe_load(stream)

    def of(name, default):
        return np.array([float(bounds[joint].get(name, default)) for joint in robot.joints])
    return Limits(of("lower", -np.inf), of("upper", np.inf), of("velocity", np.nan),
                  float(parameters["acceleration"]), float(parameters["max_tracking_error"]))


def _apart(first, second):
    """Distance of joints, of which a whole turn is none."""
    difference = first - second
    return np.abs(difference - 2.0 * np.pi * np.round(difference / (2.0 * np.pi)))


def _at(joints: Joints, stamps: np.ndarray) -> np.ndarray:
    """Positions at those stamps, NaN where there are none."""
    found = np.full((len(stamps), joints.positions.shape[1]), np.nan)
    _, rows, columns = np.intersect1d(stamps, joints.stamps, return_indices=True)
    found[rows] = joints.positions[columns]
    return found


def _tell(findings, data, stamps, broken, values, text):
    """One sentence for each of the first ticks at which something is broken."""
    rows = np.flatnonzero(np.any(broken, axis=1))
    for row in rows[:TOLD]:
        joint = int(np.argmax(broken[row]))
        findings.violations.append(
            f"{text} of joint {joint + 1} at {data.seconds(stamps[row]):.2f} s: "
            f"{values[row, joint]:.4g}")
    if len(rows) > TOLD:
        findings.violations.append(f"{text}: at {len(rows) - TOLD} more ticks")


def check(data: Recording, bounds: Limits | None = None,
          left_over: Sequence[str] = ()) -> Findings:
    """All of it; `left_over` are processes that outlived the trial."""
    findings = Findings([f"process left over: {command[:100]}" for command in left_over])
    if data.commands is None or data.measured is None or not len(data.commands.stamps):
        findings.violations.append("no joint command")
        return findings
    bounds = limits(data.robot) if bounds is None else bounds
    stamps, q, v = data.commands.stamps, data.commands.positions, data.commands.velocities
    infinite = ~(np.isfinite(q) & np.isfinite(v))
    _tell(findings, data, stamps, infinite, q, "command that is not finite")
    if np.any(infinite):
        return findings
    gaps = np.flatnonzero(np.diff(stamps) != data.tick)
    if len(gaps) and not data.is_estimated and not data.description.get("arguments", {}).get("fault"):
        findings.violations.append(
            f"joint_command breaks off at {data.seconds(stamps[gaps[0]]):.2f} s")
    _check_motion(findings, data, bounds, stamps, q, v, _at(data.measured, stamps))
    return findings


def _check_motion(findings, data, bounds, stamps, q, v, measured):
    step, change = np.diff(q, axis=0), np.diff(v, axis=0)
    dt = data.tick / judge.SECOND  # s
    farthest = bounds.velocity * dt
    lag = _apart(q, measured)
    known = np.isfinite(lag)
    near = np.all(np.where(known, lag, 0.0) <= farthest + 0.01, axis=1)
    anew = near & np.all(v == 0.0, axis=1)  # a command may begin anew at such a tick
    goes_on = (np.diff(stamps) == data.tick) & ~anew[1:]
    allowed = np.where(np.diff(stamps)[:, None] == data.tick, farthest, np.inf)

    outside = np.maximum(bounds.lower - q, q - bounds.upper)
    before = np.vstack([np.full((1, q.shape[1]), np.inf), outside[:-1]])
    there = np.maximum(bounds.lower - measured, measured - bounds.upper)
    _tell(findings, data, stamps, (outside > TOLERANCE) & (outside > before + TOLERANCE)
          & ~(outside <= there + farthest), q, "position beyond its limit")
    _tell(findings, data, stamps[1:], goes_on[:, None]
          & (np.abs(step) > allowed * (1 + TOLERANCE) + TOLERANCE), np.abs(step),
          "step beyond one tick's motion")
    away = (lag > farthest + 0.01) & known
    fresh = np.concatenate([[True], np.diff(stamps) > data.tick])
    _tell(findings, data, stamps, fresh[:, None] & away, lag,
          "first command, or first one after a gap, away from the measured position")
    _tell(findings, data, stamps, np.abs(v) > bounds.velocity * (1 + TOLERANCE), np.abs(v),
          "velocity beyond its limit")
    _tell(findings, data, stamps[1:], goes_on[:, None]
          & (np.abs(change) > bounds.acceleration * dt * (1 + TOLERANCE) + TOLERANCE),
          np.abs(change) / dt, "acceleration beyond its limit")
    _tell(findings, data, stamps, known & (lag > bounds.lag + farthest + TOLERANCE), lag,
          "command too far from the measured position")
    findings.figures = {
        "largest_joint_step_rad": float(np.max(np.abs(step), initial=0.0)),
        "largest_velocity_share": float(np.max(np.abs(v) / bounds.velocity)),
        "largest_acceleration_share": float(
            np.max(np.abs(change[goes_on]), initial=0.0) / (bounds.acceleration * dt)),
        "largest_lag_rad": float(np.max(lag[known], initial=0.0)),
        "commands_count": len(stamps)}
