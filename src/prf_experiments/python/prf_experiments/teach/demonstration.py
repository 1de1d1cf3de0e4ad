# SPDX-License-Identifier: BSD-3-Clause
"""Demonstrations by elte_planner's reader, so that a trial takes exactly what the planner takes.

Its header demonstration.hpp has the format. Poses (n, 7) and the target (7,) are x y z in m and
qx qy qz qw; the hand and the target are in the planning frame.
"""
import functools
import os

import numpy as np
import rospkg
import yaml

import elte_planner
from elte_planner import Demonstration
from prf_experiments.robots import Robot

MIN_ROWS = 10  # of what is recorded; shorter is a mistake


class DemonstrationError(ValueError):
    """This cannot serve as a demonstration; the message says where and why."""


@functools.cache
def reach() -> float:
    """How far the hand may be from the arm's base, m: what the planner takes."""
    path = os.path.join(rospkg.RosPack().get_path("elte_planner"), "config", "skill_planner.yaml")
    with open(path, encoding="utf-8") as stream:
        return float(yaml.safe_load(stream)["reach"])


def read(path: str) -> Demonstration:
    """Raises DemonstrationError."""
    try:
        return elte_planner.load_demonstration(path)
    except ValueError as error:
        raise DemonstrationError(str(error)) from None


def read_executable(path: str) -> Demonstration:
    """read() of what the planner takes: an arm can follow it. Raises DemonstrationError."""
    found = read(path)
    try:
        elte_planner.require_executable(found, reach())
    except ValueError as error:
        raise DemonstrationError(f"{path}: {error}") from None
    return found


def make(times: np.ndarray, poses: np.ndarray, target: np.ndarray, command: str,
         robot: Robot) -> Demonstration:
    """What was recorded of the robot's hand, with the command that did. Raises DemonstrationError."""
    if len(times) < MIN_ROWS:
        raise DemonstrationError(f"{len(times)} rows, must be at least {MIN_ROWS}")
    try:
        made = Demonstration(times, poses[:, :3], poses[:, 3:], robot.base_link, robot.tip_link, target,
                             notes={"made by": command})
        elte_planner.require_executable(made, reach())
        return made
    except ValueError as error:
        raise DemonstrationError(str(error)) from None


def write(path: str, demonstration: Demonstration) -> None:
    """Raises DemonstrationError."""
    try:
        elte_planner.save_demonstration(demonstration, path)
    except ValueError as error:
        raise DemonstrationError(str(error)) from None
