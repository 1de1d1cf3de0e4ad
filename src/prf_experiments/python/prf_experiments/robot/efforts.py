# SPDX-License-Identifier: BSD-3-Clause
"""Bounds of the joints' efforts, learnt in free motion: beyond them the arm pushes against something."""
import numpy as np

MARGIN = 0.25  # of what was measured, on either side
LEAST = 0.5  # N m, on either side
LEAST_ROWS = 1000


class EffortError(Exception):
    """The efforts teach nothing; the message says why in one line."""


def bounds(efforts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(lower, upper), N m, of efforts (n, joints)."""
    if len(efforts) < LEAST_ROWS:
        raise EffortError(f"{len(efforts)} joint_states tell efforts, must be at least {LEAST_ROWS}")
    if not np.all(np.isfinite(efforts)):
        raise EffortError("efforts are not finite, must be: does the driver tell them?")
    low, high = np.min(efforts, axis=0), np.max(efforts, axis=0)
    if np.any(high - low <= 0.0):
        joint = int(np.argmin(high - low)) + 1
        raise EffortError(f"the effort of joint {joint} is always {low[joint - 1]:g} N m: does the driver tell them?")
    margin = np.maximum(LEAST, MARGIN * (high - low))
    return low - margin, high + margin
