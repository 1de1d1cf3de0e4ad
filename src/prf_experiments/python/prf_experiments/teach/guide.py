# SPDX-License-Identifier: BSD-3-Clause
"""The hand of a person who shows the robot where to go: a spring from a guide point to the hand.

The guide goes from where the hand is to the stand-off before the tag on a cubic Bezier curve that
ends along the tag's normal, and which a detour may bend out, with the time law
s(u) = 10 u^3 - 15 u^4 + 6 u^5, which starts and stops without a jerk. Force and torque on the hand:
    f = k (x_guide - x) - d v        t = k_r log(q_guide q^-1) - d_r w
"""
import math
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Slerp

from prf_experiments import geometry

# An optical frame that looks straight at a tag: its x along the tag's x, y and z against the tag's.
FACING = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass
class GuideParams:
    stand_off: float  # m
    run_in: float  # m
    detour_right: float  # m, of the first bend, as seen by a viewer in front of the tag
    detour_forward: float  # m, of the first bend, toward the tag
    settle_time: float  # s
    guide_time: float  # s
    stiffness: float  # N/m
    damping: float  # N s/m
    angular_stiffness: float  # Nm/rad
    angular_damping: float  # Nm s/rad

    def validate(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise ValueError(f"{entry.name} is {value!r}, not a number")
            if not math.isfinite(value) or value < 0.0:
                raise ValueError(f"{entry.name} is {value}, must be finite and at least 0")
        if self.guide_time <= 0.0 or self.stiffness <= 0.0:
            raise ValueError("guide_time and stiffness must be above 0")


def minimum_jerk(fraction: float) -> float:
    u = min(max(fraction, 0.0), 1.0)
    return u**3 * (10.0 + u * (6.0 * u - 15.0))


def stand_off_pose(tag: np.ndarray, camera_in_hand: np.ndarray, distance: float) -> np.ndarray:
    """Pose of the hand that has the camera at `distance` before the tag, looking at its centre."""
    camera_in_tag = np.concatenate([[0.0, 0.0, distance], FACING])
    return geometry.compose(geometry.compose(tag, camera_in_tag),
                            geometry.inverse(camera_in_hand))


class Guide:
    """Wrench of the guiding hand; everything in one inertial frame."""

    def __init__(self, parameters: GuideParams, stamp: float, hand: ArrayLike, camera: ArrayLike,
                 tag: ArrayLike):
        """Begins at `stamp` (s) with the hand's, the camera's and the tag's pose (7,)."""
        parameters.validate()
        self._parameters = parameters
        self._stamp = stamp
        self._start = np.asarray(hand, float)
        tag = np.asarray(tag, float)
        camera_in_hand = geometry.compose(geometry.inverse(hand), camera)
        self._goal = stand_off_pose(tag, camera_in_hand, parameters.stand_off)
        normal = geometry.rotation(tag).apply([0.0, 0.0, 1.0])
        bend = self._goal[:3] + parameters.run_in * normal
        right = geometry.rotation(tag).apply([1.0, 0.0, 0.0])
        first_bend = (0.5 * (self._start[:3] + bend) + parameters.detour_right * right
                      - parameters.detour_forward * normal)
        self._control_points = np.array([self._start[:3], first_bend, bend, self._goal[:3]])
        self._turn = Slerp([0.0, 1.0], geometry.rotation(np.array([self._start, self._goal])))
        self._last: tuple[float, np.ndarray] | None = None  # stamp and pose of the hand

    @property
    def goal(self) -> np.ndarray:
        return self._goal

    def pose(self, stamp: float) -> np.ndarray:
        """Where the guide is at a time, (7,)."""
        elapsed = stamp - self._stamp - self._parameters.settle_time
        s = minimum_jerk(elapsed / self._parameters.guide_time)
        weights = np.array([(1 - s)**3, 3 * s * (1 - s)**2, 3 * s**2 * (1 - s), s**3])
        return geometry.make(weights @ self._control_points, self._turn(s))

    def wrench(self, stamp: float, hand: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Force (3,) and torque (3,) on the hand, whose pose is `hand` at `stamp`."""
        hand = np.asarray(hand, float)
        velocity, rotation = np.zeros(3), np.zeros(3)
        if self._last is not None and stamp > self._last[0]:
            interval = stamp - self._last[0]
            velocity = (hand[:3] - self._last[1][:3]) / interval
            turned = geometry.rotation(hand) * geometry.rotation(self._last[1]).inv()
            rotation = turned.as_rotvec() / interval
        self._last = (stamp, hand)
        guide, p = self.pose(stamp), self._parameters
        deviation = (geometry.rotation(guide) * geometry.rotation(hand).inv()).as_rotvec()
        return (p.stiffness * (guide[:3] - hand[:3]) - p.damping * velocity,
                p.angular_stiffness * deviation - p.angular_damping * rotation)
