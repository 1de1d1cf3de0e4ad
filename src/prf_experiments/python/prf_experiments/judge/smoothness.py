# SPDX-License-Identifier: BSD-3-Clause
"""How smoothly the arm moved. These figures do not change the verdict.

Joints: second and third differences of the commanded positions, root mean square over all
joints, from the first motion on. Approach: the hand in the tag's frame from where it comes within
APPROACH of where it tracks until tracking begins. Shake: what its positions hold above SHAKE.
"""
import numpy as np
import scipy.signal

from prf_experiments.judge import target
from prf_experiments.record import recording
from prf_msgs.msg import ExecutionProgress

STILL = 1e-4  # rad from the first command: the arm has begun to move
APPROACH = 0.2  # m
SHAKE = 1.5  # Hz; the demonstrated approach holds nothing above it
LEAST = 30  # ticks that an approach must have to be measured

Figures = dict[str, float | None]


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def joints(commands: recording.Joints | None, tick: float = 0.01) -> Figures:
    """Acceleration, rad/s^2, and jerk, rad/s^3, of joints commanded every `tick`, s."""
    acceleration = jerk = None
    positions = np.empty((0, 7)) if commands is None else commands.positions
    positions = positions[np.all(np.isfinite(positions), axis=1)]
    moved = np.any(np.abs(positions - positions[:1]) > STILL, axis=1)
    if moved.any():
        positions = np.unwrap(positions, axis=0)[max(0, int(np.argmax(moved)) - 3):]
        if len(positions) > 3:
            acceleration = _rms(np.diff(positions, 2, axis=0)) / tick**2
            jerk = _rms(np.diff(positions, 3, axis=0)) / tick**3
    return {"joint_acceleration_rms_rad_s2": acceleration, "joint_jerk_rms_rad_s3": jerk}


def approach_rows(positions: np.ndarray, tracking: np.ndarray) -> slice | None:
    """The ticks of the approach; `positions` (n, 3) m in the tag's frame, `tracking` (n,) bool."""
    if not tracking.any():
        return None
    end = int(np.argmax(tracking))
    goal = np.mean(positions[tracking], axis=0)
    outside = np.flatnonzero(np.linalg.norm(positions[:end] - goal, axis=1) > APPROACH)
    first = int(outside[-1]) + 1 if outside.size else 0
    return slice(first, end + 1) if end + 1 - first >= LEAST else None


def approach(data: recording.Recording) -> Figures:
    """Path over net way, and shake, mm rms, of the hand on its approach in the tag's frame."""
    stamps, tag, hand = target.matched(data.tag, data.end_effector)
    positions = target.relative_to(tag, hand)
    tracked = data.progress.stamps[data.progress.states == ExecutionProgress.TRACKING]
    rows = approach_rows(positions, np.isin(stamps, tracked))
    ratio = shake = None
    if rows is not None:
        way = positions[rows]
        net = float(np.linalg.norm(way[-1] - way[0]))
        if net > 0.0:
            ratio = float(np.sum(np.linalg.norm(np.diff(way, axis=0), axis=1))) / net
        fast = scipy.signal.butter(2, SHAKE, "highpass", fs=1e9 / data.tick, output="sos")
        shaken = scipy.signal.sosfiltfilt(fast, positions, axis=0)[rows]
        shake = 1e3 * float(np.sqrt(np.mean(np.sum(shaken**2, axis=1))))
    return {"approach_path_ratio": ratio, "approach_shake_rms_mm": shake}


def figures(data: recording.Recording) -> Figures:
    return {**joints(data.commands, 1e-9 * data.tick), **approach(data)}
