# SPDX-License-Identifier: BSD-3-Clause
"""Poses and joints over time."""
from dataclasses import dataclass

import numpy as np


@dataclass
class Poses:
    stamps: np.ndarray  # (n,) ns
    values: np.ndarray  # (n, 7)


@dataclass
class Joints:
    """Of the j joints of the arm, from base to hand."""
    stamps: np.ndarray  # (n,) ns
    positions: np.ndarray  # (n, j) rad
    velocities: np.ndarray  # (n, j) rad/s
