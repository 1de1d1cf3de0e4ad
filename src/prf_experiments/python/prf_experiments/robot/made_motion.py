# SPDX-License-Identifier: BSD-3-Clause
"""A minute of calibration motion whose truth is known: what `calibrate --seeds` is measured with.

The noise of detections is that of a rendered tag of 100 mm (prf_studies), which grows with the distance.
"""
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from prf_experiments import geometry
from prf_experiments.robot.arm import Chain

POSTURE = np.array([1.600, 1.372, 0.516, 0.967, -1.637, 2.307, -0.298])  # rad, the hand before the box
SWING = np.array([0.06, 0.06, 0.08, 0.12, 0.25, 0.25, 0.35])  # rad
SECONDS, TICKS, FRAMES = 60.0, 100.0, 30.0
JOINT_NOISE = 1e-4  # rad
HALF_VIEW = np.radians(24.0)


@dataclass(frozen=True)
class Motion:
    stamps: np.ndarray  # (n,) s, of joints and commands
    measured: np.ndarray  # (n, 7) rad
    commands: np.ndarray  # (n, 7) rad
    image_stamps: np.ndarray  # (m,) s
    detections: np.ndarray  # (m, 7), not finite where the tag is not seen
    camera_in_hand: np.ndarray  # the truth
    offset: float  # s
    delay: float  # s


def make(chain: Chain, nominal: np.ndarray, seed: int, shift: float = 0.02, turn: float = np.radians(3.0),
         late: float = 0.03) -> Motion:
    """`nominal` camera in hand is off by `shift` m and `turn` rad; stamps and arm are `late` s late."""
    rng = np.random.default_rng(seed)

    def direction():
        vector = rng.normal(size=3)
        return vector / np.linalg.norm(vector)
    camera = geometry.compose(nominal, geometry.make(shift * direction(), Rotation.from_rotvec(turn * direction())))
    phases, rates = rng.uniform(0.0, 2.0 * np.pi, 7), rng.uniform(0.6, 1.5, 7)

    def joints(times):
        return POSTURE + SWING * np.sin(np.outer(times, rates) + phases)
    stamps = np.arange(0.0, SECONDS, 1.0 / TICKS)
    measured = joints(stamps) + JOINT_NOISE * rng.normal(size=(len(stamps), 7))
    instants = np.arange(0.0, SECONDS, 1.0 / FRAMES)
    middle = geometry.compose(chain.poses(POSTURE[None]), camera[None])[0]
    ahead = geometry.make([0.0, 0.0, 0.5], Rotation.from_euler("xyz", [np.pi + 0.25, 0.2, 0.0]))
    tag = geometry.compose(middle, ahead)
    hand = chain.poses(joints(instants))
    seen = geometry.compose(geometry.inverse(geometry.compose(hand, np.broadcast_to(camera, hand.shape))),
                            np.broadcast_to(tag, hand.shape))
    return Motion(stamps, measured, joints(stamps + late), instants + late, _noisy(seen, rng), camera, late, late)


def _noisy(seen, rng):
    distance = seen[:, 2:3] / 0.6
    noise = distance**2 * rng.normal(size=(len(seen), 3)) * [2e-5, 2e-5, 2e-4]
    turned = geometry.rotation(seen) * Rotation.from_rotvec(
        distance * np.radians(0.13) * rng.normal(size=(len(seen), 3)))
    noisy = geometry.make(seen[:, :3] + noise, turned)
    angle = np.arctan2(np.hypot(seen[:, 0], seen[:, 1]), seen[:, 2])
    return np.where((angle < HALF_VIEW)[:, None], noisy, np.nan)
