# SPDX-License-Identifier: BSD-3-Clause
"""What a bag without ground truth says of hand, camera and target: by joints, tf_static and detections.

Everything is in the arm's base, which is taken to stand still with the body upright above a deck. The
target is where the last detection saw it from the camera of the real arm. The hand is the one that
the framework moved: in a rehearsal the stand-in's. Contacts are not known.
"""
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from prf_experiments import geometry, robots
from prf_experiments.record.poses import Joints, Poses
from prf_experiments.robot import arm, description
from prf_msgs import bags

ROBOT = robots.load()
ARM_BASE, HAND, OPTICAL = ROBOT.base_link, ROBOT.tip_link, ROBOT.camera_frame
STANDING = 0.53  # m, body above the deck
STAND_IN = "rehearsal/joint_states"


@dataclass(frozen=True)
class World:
    """What a simulator tells, and sensors let guess."""
    tag: Poses
    camera: Poses
    hand: Poses
    base: Poses
    platform: Poses


def _between(stamps, poses, at):
    """Poses at other stamps: positions between the neighbours, orientation of the one before."""
    positions = np.column_stack([np.interp(at, stamps, column) for column in poses[:, :3].T])
    before = np.clip(np.searchsorted(stamps, at, side="right") - 1, 0, len(stamps) - 1)
    return np.column_stack([positions, poses[before, 3:]])


def world(path: str, moved: Joints, real: Joints, detected: Poses,
          fixed_pose: Callable[[str, str], np.ndarray | None], arm_base_in_body: np.ndarray) -> World:
    """Of the arm that the framework moved, the one that carries the camera, and what that saw (NaN: nothing).

    `fixed_pose` gives a child in a parent by tf_static. Raises BagError where a tag or a joint is not known.
    """
    camera_in_hand = fixed_pose(OPTICAL, HAND)
    if camera_in_hand is None:
        raise bags.BagError(f"{path}: has no ground truth, and tf_static does not place {OPTICAL} in {HAND}")
    known = [np.all(np.isfinite(values), axis=1) for values in (moved.positions, real.positions, detected.values)]
    for rows, what in zip(known, ("joint_states of the arm", "joint_states of the arm", "tag in view")):
        if not np.any(rows):
            raise bags.BagError(f"{path}: has no ground truth and no {what}: nothing tells where the hand came")
    chain = arm.Chain(description.text(), ARM_BASE, HAND)
    ticks, seen = moved.stamps[known[0]], detected.stamps[known[2]]

    def camera_of(hand):
        return geometry.compose(hand, np.broadcast_to(camera_in_hand, hand.shape))
    hand = chain.poses(moved.positions[known[0]])
    eye = _between(real.stamps[known[1]], camera_of(chain.poses(real.positions[known[1]])), seen)
    tag = _between(seen, geometry.compose(eye, detected.values[known[2]]), ticks)
    body = np.broadcast_to(geometry.inverse(arm_base_in_body), hand.shape)
    deck = geometry.compose(body, np.broadcast_to([0.0, 0.0, -STANDING, 0.0, 0.0, 0.0, 1.0], hand.shape))
    return World(*(Poses(ticks, values) for values in (tag, camera_of(hand), hand, body, deck)))
