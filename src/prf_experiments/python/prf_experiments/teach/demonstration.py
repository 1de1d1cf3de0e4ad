# SPDX-License-Identifier: BSD-3-Clause
"""Demonstration files: a hand path in the planning frame and where the target was meanwhile.

    # frame: j2s7s300_link_base
    # child_frame: j2s7s300_end_effector
    # target_pose: x y z qx qy qz qw
    time,x,y,z,qx,qy,qz,qw
    0,...
"""
import csv
from dataclasses import dataclass, field

import numpy as np

from prf_experiments import geometry

COLUMNS = ["time", "x", "y", "z", "qx", "qy", "qz", "qw"]
MIN_ROWS = 10
UNIT_TOLERANCE = 1e-3


class DemonstrationError(ValueError):
    """The file cannot serve as a demonstration; the message says where and why."""


@dataclass
class Demonstration:
    frame: str
    child_frame: str
    target_pose: np.ndarray  # (7,) target in frame
    times: np.ndarray  # (n,) s, from 0, rising
    poses: np.ndarray  # (n, 7) child_frame in frame
    notes: dict = field(default_factory=dict)  # further `# key: value` lines

    def goal_in_target(self):
        return geometry.compose(geometry.inverse(self.target_pose), self.poses[-1])


def check(demonstration, source):
    """Raises DemonstrationError unless every rule of the format holds."""
    times, poses, target = demonstration.times, demonstration.poses, demonstration.target_pose
    if len(times) < MIN_ROWS:
        raise DemonstrationError(f"{source}: {len(times)} rows, at least {MIN_ROWS} are needed")
    if not (np.all(np.isfinite(times)) and np.all(np.isfinite(poses))):
        row = int(np.argmin(np.isfinite(times) & np.all(np.isfinite(poses), axis=1)))
        raise DemonstrationError(f"{source}: row {row + 1} is not finite")
    if not np.all(np.isfinite(target)):
        raise DemonstrationError(f"{source}: target_pose is not finite")
    if times[0] != 0.0:
        raise DemonstrationError(f"{source}: time starts at {times[0]:g} s, it must start at 0")
    if np.any(np.diff(times) <= 0.0):
        row = int(np.argmax(np.diff(times) <= 0.0)) + 2
        raise DemonstrationError(f"{source}: time does not rise at row {row}")
    norms = np.append(np.linalg.norm(poses[:, 3:], axis=1), np.linalg.norm(target[3:]))
    if np.any(np.abs(norms - 1.0) > UNIT_TOLERANCE):
        worst = int(np.argmax(np.abs(norms - 1.0)))
        where = "target_pose" if worst == len(poses) else f"row {worst + 1}"
        raise DemonstrationError(
            f"{source}: quaternion of {where} has norm {norms[worst]:.4g}, not 1")


def read(path):
    try:
        with open(path, encoding="utf-8", newline="") as stream:
            lines = stream.read().splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise DemonstrationError(f"{path}: cannot be read: {error}") from None

    notes, table = {}, []
    for line in lines:
        if line.startswith("#"):
            key, colon, value = line[1:].partition(":")
            if colon:
                notes[key.strip()] = value.strip()
        elif line.strip():
            table.append(line)
    for key in ("frame", "child_frame", "target_pose"):
        if key not in notes:
            raise DemonstrationError(f"{path}: the line `# {key}: ...` is missing")

    rows = list(csv.reader(table))
    if not rows or [name.strip() for name in rows[0]] != COLUMNS:
        raise DemonstrationError(f"{path}: the columns must be {','.join(COLUMNS)}")
    try:
        target = np.array([float(word) for word in notes.pop("target_pose").split()])
        values = np.array([[float(word) for word in row] for row in rows[1:]])
    except ValueError as error:
        raise DemonstrationError(f"{path}: {error}") from None
    if target.shape != (7,):
        raise DemonstrationError(f"{path}: target_pose has {target.size} numbers, not 7")
    values = values.reshape(-1, len(COLUMNS)) if values.size == 0 else values
    if values.ndim != 2 or values.shape[1] != len(COLUMNS):
        raise DemonstrationError(f"{path}: every row must have {len(COLUMNS)} numbers")

    result = Demonstration(notes.pop("frame"), notes.pop("child_frame"), target,
                           values[:, 0], values[:, 1:], notes)
    check(result, path)
    return result


def write(path, demonstration):
    check(demonstration, path)
    with open(path, "w", encoding="utf-8") as stream:
        for key, value in demonstration.notes.items():
            stream.write(f"# {key}: {value}\n")
        stream.write(f"# frame: {demonstration.frame}\n")
        stream.write(f"# child_frame: {demonstration.child_frame}\n")
        target = " ".join(f"{value:.9f}" for value in demonstration.target_pose)
        stream.write(f"# target_pose: {target}\n")
        stream.write(",".join(COLUMNS) + "\n")
        for time, pose in zip(demonstration.times, demonstration.poses):
            stream.write(f"{time:.3f}," + ",".join(f"{value:.9f}" for value in pose) + "\n")
