# SPDX-License-Identifier: BSD-3-Clause
"""Poses as arrays (..., 7): x y z in metres, then the unit quaternion qx qy qz qw.

`b_in_a` names the pose of frame b expressed in frame a, so compose(b_in_a, c_in_b) = c_in_a.
"""
import numpy as np

IDENTITY = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


def multiply(p, q):
    """Hamilton product of quaternions (..., 4) in x y z w order."""
    p, q = np.asarray(p, float), np.asarray(q, float)
    pv, pw, qv, qw = p[..., :3], p[..., 3:], q[..., :3], q[..., 3:]
    vector = pw * qv + qw * pv + np.cross(pv, qv)
    scalar = pw * qw - np.sum(pv * qv, axis=-1, keepdims=True)
    return np.concatenate([vector, scalar], axis=-1)


def conjugate(q):
    return np.asarray(q, float) * np.array([-1.0, -1.0, -1.0, 1.0])


def rotate(q, v):
    """Vectors (..., 3) rotated by unit quaternions (..., 4)."""
    q, v = np.asarray(q, float), np.asarray(v, float)
    t = 2.0 * np.cross(q[..., :3], v)
    return v + q[..., 3:] * t + np.cross(q[..., :3], t)


def compose(b_in_a, c_in_b):
    b_in_a, c_in_b = np.asarray(b_in_a, float), np.asarray(c_in_b, float)
    position = b_in_a[..., :3] + rotate(b_in_a[..., 3:], c_in_b[..., :3])
    return np.concatenate([position, multiply(b_in_a[..., 3:], c_in_b[..., 3:])], axis=-1)


def inverse(b_in_a):
    """Pose of a in b."""
    b_in_a = np.asarray(b_in_a, float)
    back = conjugate(b_in_a[..., 3:])
    return np.concatenate([-rotate(back, b_in_a[..., :3]), back], axis=-1)


def log(q):
    """Rotation vectors (..., 3), at most pi long, of unit quaternions (..., 4)."""
    q = np.asarray(q, float)
    q = np.where(q[..., 3:] < 0.0, -q, q)
    norm = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(norm, q[..., 3:])
    return np.where(norm > 1e-12, angle / np.maximum(norm, 1e-12), 2.0) * q[..., :3]


def exp(v):
    """Unit quaternion (4,) of a rotation vector (3,)."""
    v = np.asarray(v, float)
    angle = np.linalg.norm(v)
    scale = 0.5 if angle < 1e-12 else np.sin(0.5 * angle) / angle
    return np.append(scale * v, np.cos(0.5 * angle))


def slerp(p, q, fraction):
    """From p (fraction 0) to q (fraction 1) on the shorter arc."""
    return multiply(exp(fraction * log(multiply(q, conjugate(p)))), p)


def mean_quaternion(quaternions):
    """Unit quaternion nearest to all rows: largest eigenvector of the sum of q q^T."""
    quaternions = np.asarray(quaternions, float)
    mean = np.linalg.eigh(quaternions.T @ quaternions)[1][:, -1]
    return mean if mean[3] >= 0.0 else -mean
