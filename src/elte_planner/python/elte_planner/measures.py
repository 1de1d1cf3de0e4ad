# SPDX-License-Identifier: BSD-3-Clause
"""How alike two trajectories are. Each is (N, d), rows in order."""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from elte_planner.skill import rows_of


def frechet_distance(first: ArrayLike, second: ArrayLike) -> float:
    """Discrete Fréchet distance (Eiter and Mannila 1994), in the unit of the positions; 0: the same nodes.

    The least leash with which two walkers can go along the nodes of both, never back.
    """
    p, q = rows_of(first, "first"), rows_of(second, "second")
    distance = np.linalg.norm(p[:, None, :] - q[None, :, :], axis=2)
    leash = np.empty_like(distance)
    leash[0] = np.maximum.accumulate(distance[0])
    for i in range(1, len(p)):
        above = np.concatenate([leash[i - 1, :1], np.minimum(leash[i - 1, 1:], leash[i - 1, :-1])])
        last = np.inf
        for j, (reached, here) in enumerate(zip(above, distance[i])):
            last = leash[i, j] = max(min(reached, last), here)
    return float(leash[-1, -1])


def angular_similarity(first: ArrayLike, second: ArrayLike) -> float:
    """1 - mean angle / pi between corresponding steps of two trajectories of as many nodes; 1: same directions.

    Steps without length have no direction and are left out; NaN when none is left.
    """
    u, v = np.diff(rows_of(first, "first"), axis=0), np.diff(rows_of(second, "second"), axis=0)
    if u.shape != v.shape:
        raise ValueError(f"first has {u.shape[0] + 1} nodes of {u.shape[1]} dimensions and second {v.shape[0] + 1} of "
                         f"{v.shape[1]}, must have as many")
    lengths = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1)
    there = lengths > 0.0
    if not there.any():
        return float("nan")
    cosine = np.clip(np.sum(u * v, axis=1)[there] / lengths[there], -1.0, 1.0)
    return float(1.0 - np.mean(np.arccos(cosine)) / np.pi)


def end_error(trajectory: ArrayLike, goal: ArrayLike) -> float:
    """Euclidean distance of the last node from goal (d,)."""
    return float(np.linalg.norm(rows_of(trajectory, "trajectory")[-1] - np.asarray(goal, dtype=float)))
