# SPDX-License-Identifier: BSD-3-Clause
"""Poses as arrays (..., 7): x y z in metres, then the quaternion qx qy qz qw.

`b_in_a` names the pose of frame b expressed in frame a, so compose(b_in_a, c_in_b) = c_in_a.
Rotations are scipy's; a pose that is not finite (a tag that was not detected) stays so.
"""
import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

IDENTITY = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


def rotation(pose: ArrayLike) -> Rotation:
    """Orientation of a pose (7,) or of poses (n, 7), n > 0; identity where one is not finite."""
    pose = np.asarray(pose, float)
    known = np.all(np.isfinite(pose), axis=-1, keepdims=True)
    return Rotation.from_quat(np.where(known, pose[..., 3:], IDENTITY[3:]))


def make(position: ArrayLike, turned: Rotation) -> np.ndarray:
    """Pose (..., 7) of a position (..., 3) m and an orientation."""
    position = np.asarray(position, float)
    finite = np.all(np.isfinite(position), axis=-1, keepdims=True)
    return np.concatenate([position, np.where(finite, turned.as_quat(), np.nan)], axis=-1)


def compose(b_in_a: ArrayLike, c_in_b: ArrayLike) -> np.ndarray:
    """Pose of c in a, (..., 7)."""
    b_in_a, c_in_b = np.asarray(b_in_a, float), np.asarray(c_in_b, float)
    turned = rotation(b_in_a)
    return make(b_in_a[..., :3] + turned.apply(c_in_b[..., :3]), turned * rotation(c_in_b))


def inverse(b_in_a: ArrayLike) -> np.ndarray:
    """Pose of a in b, (..., 7)."""
    b_in_a = np.asarray(b_in_a, float)
    back = rotation(b_in_a).inv()
    return make(-back.apply(b_in_a[..., :3]), back)
