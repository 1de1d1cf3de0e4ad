# SPDX-License-Identifier: BSD-3-Clause
"""Position-based visual servoing as moveit_servo's PoseTracking does it: a PID on the pose error.

The twist of the hand is v = PID(e) of each axis of the position error e, and w = PID(a) u of the angle a and axis
u of the rotation that is left. No forecast: the target is where it was measured last, and has no velocity. No skill:
the hand goes to its goal straight from where it is. Metres, radians, seconds, in the planning frame.
"""
from dataclasses import dataclass, fields

import numpy as np
from scipy.spatial.transform import Rotation

from prf_experiments import geometry

LONGEST_TICK = 0.1  # s; after a longer gap the PIDs begin anew


@dataclass(frozen=True)
class ServoParams:
    linear_gains: tuple[float, float, float]  # P 1/s, I 1/s^2, D
    angular_gains: tuple[float, float, float]
    windup_limit: float  # of the integrals' share of the twist, m/s and rad/s
    fastest: tuple[float, float]  # m/s, rad/s
    target_timeout: float  # s without a measurement of the target, after which the hand stops
    advance: float  # s that the set-point is ahead of the measured hand: latency and lag of the arm
    tolerance: tuple[float, float]  # m, rad, of the hand from its goal, within which it tracks
    hold_time: float  # s of tracking until done
    time_limit: float  # s from the first tick

    def validate(self) -> None:
        """ValueError with the first parameter that is not one or three or two numbers >= 0."""
        for name, count in ((entry.name, {"linear_gains": 3, "angular_gains": 3, "fastest": 2, "tolerance": 2}
                             .get(entry.name, 1)) for entry in fields(self)):
            value = np.atleast_1d(np.asarray(getattr(self, name), float))
            if value.shape != (count,) or not (np.isfinite(value).all() and (value >= 0).all()):
                raise ValueError(f"{name} = {getattr(self, name)}, must be {count} finite and >= 0")


class Pid:
    """Of an error vector, each component by itself."""

    def __init__(self, gains: tuple[float, float, float], windup_limit: float):
        self._gains, self._limit = gains, windup_limit
        self.reset()

    def reset(self) -> None:
        self._integral: np.ndarray | float = 0.0
        self._before: np.ndarray | None = None

    def output(self, error: np.ndarray, dt: float) -> np.ndarray:
        proportional, integral, derivative = self._gains
        if integral > 0:
            most = self._limit / integral
            self._integral = np.clip(self._integral + error * dt, -most, most)
        slope = 0.0 if self._before is None or dt <= 0 else (error - self._before) / dt
        self._before = error
        return proportional * error + integral * self._integral + derivative * slope


def shortened(vector: np.ndarray, most: float) -> np.ndarray:
    length = float(np.linalg.norm(vector))
    return vector if length <= most else vector * (most / length)


@dataclass(frozen=True)
class Move:
    """What the hand shall do at a tick."""
    pose: np.ndarray  # (7,)
    twist: np.ndarray  # (6,), linear then angular
    error: tuple[float, float]  # m, rad, of the measured hand from its goal


class PoseServo:
    def __init__(self, params: ServoParams):
        self._params = params
        self._linear = Pid(params.linear_gains, params.windup_limit)
        self._angular = Pid(params.angular_gains, params.windup_limit)
        self._tick: float | None = None

    def move(self, tick: float, hand: np.ndarray, target: np.ndarray, goal_in_target: np.ndarray) -> Move:
        """Poses (7,) of the measured hand and target; the goal is the hand's pose in the target's frame."""
        dt = 0.0 if self._tick is None else tick - self._tick
        if not 0 < dt <= LONGEST_TICK:
            self.stop()
            dt = 0.0
        self._tick = tick
        goal = geometry.compose(target, goal_in_target)
        offset = goal[:3] - hand[:3]
        turn = (geometry.rotation(goal) * geometry.rotation(hand).inv()).as_rotvec()
        angle = float(np.linalg.norm(turn))
        axis = turn / angle if angle > 0 else np.zeros(3)
        linear = shortened(self._linear.output(offset, dt), self._params.fastest[0])
        angular = shortened(self._angular.output(np.array([angle]), dt)[0] * axis, self._params.fastest[1])
        ahead = self._params.advance
        turned = Rotation.from_rotvec(ahead * angular) * geometry.rotation(hand)
        return Move(geometry.make(hand[:3] + ahead * linear, turned), np.concatenate([linear, angular]),
                    (float(np.linalg.norm(offset)), angle))

    def stop(self) -> None:
        """The hand holds: what the PIDs remember is of a motion that has ended."""
        self._linear.reset()
        self._angular.reset()
        self._tick = None
