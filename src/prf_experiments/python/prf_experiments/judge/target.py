# SPDX-License-Identifier: BSD-3-Clause
"""Where the target was in the arm's base frame, and where it was predicted to be."""
import numpy as np

from prf_experiments import geometry
from prf_experiments.record import recording

SHOWN_HORIZON = 0.5  # s, of the forecasts that are compared with the truth


def matched(first: recording.Poses,
            second: recording.Poses) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stamps that two pose series share, and the values of both there."""
    stamps, at_first, at_second = np.intersect1d(first.stamps, second.stamps, return_indices=True)
    return stamps, first.values[at_first], second.values[at_second]


def relative_to(frame: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """Positions (n, 3) of poses in a frame's poses, both (n, 7) in one parent."""
    return geometry.compose(geometry.inverse(frame), poses)[:, :3]


def arm_base(data: recording.Recording) -> recording.Poses:
    """Poses of the arm's base in the world."""
    return recording.Poses(data.base.stamps,
                           geometry.compose(data.base.values, data.arm_base_in_body))


def true(data: recording.Recording) -> tuple[np.ndarray, np.ndarray]:
    """(stamps ns, positions (n, 3) m)."""
    stamps, base, tag = matched(arm_base(data), data.tag)
    return stamps, relative_to(base, tag)


def forecast(data: recording.Recording,
             horizon: float = SHOWN_HORIZON) -> tuple[np.ndarray, np.ndarray, float]:
    """(stamps ns it was predicted for, positions (n, 3) m, the nearest horizon there is, s)."""
    forecasts = data.forecasts
    usable = [row for row, horizons in enumerate(forecasts.horizons) if len(horizons)]
    if not usable:
        return np.array([], dtype=np.int64), np.empty((0, 3)), horizon
    column = int(np.argmin(np.abs(forecasts.horizons[usable[0]] - horizon)))
    usable = [row for row in usable if len(forecasts.horizons[row]) > column]
    stamps = [forecasts.stamps[row] + int(1e9 * forecasts.horizons[row][column]) for row in usable]
    return (np.array(stamps, dtype=np.int64),
            np.array([forecasts.positions[row][column] for row in usable]),
            float(forecasts.horizons[usable[0]][column]))


def errors(stamps: np.ndarray, positions: np.ndarray,
           truth: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Differences (n, 3) m from the truth at those stamps that it covers."""
    inside = (stamps >= truth[0][0]) & (stamps <= truth[0][-1])
    at = np.column_stack([np.interp(stamps[inside], truth[0], column) for column in truth[1].T])
    difference = positions[inside] - at
    return difference[np.all(np.isfinite(difference), axis=1)]


def forecast_error(data: recording.Recording) -> tuple[float, float | None]:
    """(horizon s, root mean square of the forecast's distance from the truth mm or None)."""
    stamps, positions, horizon = forecast(data)
    difference = errors(stamps, positions, true(data))
    if not len(difference):
        return horizon, None
    return horizon, 1e3 * float(np.sqrt(np.mean(np.sum(difference**2, axis=1))))
