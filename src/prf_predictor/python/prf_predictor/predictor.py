# SPDX-License-Identifier: BSD-3-Clause
"""Every predictor behind one class with times instead of steps."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources

import numpy as np
import yaml
from numpy.typing import ArrayLike, NDArray

from prf_predictor._core import Periodicity, TargetPredictor, predictor_names

Array = NDArray[np.float64]


def default_parameters(name: str) -> dict[str, float]:
    """Values of one of predictor_names(); unit and meaning are in the comments of its file in `predictors`."""
    if name not in predictor_names():
        raise ValueError(f"predictor = {name}, must be one of: {', '.join(predictor_names())}")
    text = resources.files("prf_predictor").joinpath("predictors", f"{name}.yaml").read_text(encoding="utf-8")
    return {key: float(value) for key, value in yaml.safe_load(text).items() if key != "predictor"}


@dataclass(frozen=True)
class Forecast:
    """Where the target will be, at H horizons from one time."""

    time: float
    """Of the latest measurement, s."""
    horizons: Array
    """(H,), s from `time`."""
    positions: Array
    """(H, 3), m."""
    velocities: Array
    """(H, 3), m/s."""
    covariances: Array
    """(H, 6, 6) of position and velocity, m^2, m^2/s, m^2/s^2."""

    @property
    def position_sigmas(self) -> Array:
        """(H, 3), standard deviation of each coordinate, m."""
        return np.sqrt(np.diagonal(self.covariances, axis1=1, axis2=2)[:, :3])


def covariance_from(noise: ArrayLike) -> Array:
    """(3, 3), m^2, from a covariance or a standard deviation of all coordinates or of each, m."""
    values = np.asarray(noise, dtype=float)
    if values.shape == (3, 3):
        return values
    if values.shape not in ((), (3,)):
        raise ValueError(f"noise has shape {values.shape}, must be a number, (3,) or (3, 3)")
    return np.diag(np.broadcast_to(values, 3) ** 2)


class Predictor:
    """A predictor of a moving point by its name, one of predictor_names(), with parameters that differ from
    default_parameters(name)."""

    def __init__(self, name: str = "periodic", **parameters: float) -> None:
        self.name = name
        self._core = TargetPredictor(name, default_parameters(name) | parameters)
        self.time: float | None = None
        """Of the latest measurement, s; None before the first."""

    def update(self, time: float, position: ArrayLike, noise: ArrayLike = 0.002) -> float:
        """Take a measurement; times must not fall. Returns its NIS, NaN for the first one.

        position: (3,), m. noise: standard deviation, m, of all coordinates or of each (3,), or covariance (3, 3), m^2.
        NIS: normalised innovation squared, chi-square of 3 degrees of freedom when the predictor's covariance is right.
        """
        measured, covariance = np.asarray(position, dtype=float), covariance_from(noise)
        if not np.isfinite(time):
            raise ValueError(f"time = {time}, must be finite")
        if self.time is None:
            self._core.begin(measured, covariance)
            self.time = float(time)
            return float("nan")
        if time < self.time:
            raise ValueError(f"time = {time}, must be >= {self.time} s, that of the measurement before")
        after = self._core.clone()  # a refused measurement leaves this one as it was
        after.advance(float(time) - self.time)
        expected = after.forecast(0.0)
        after.correct(measured, covariance)
        self._core, self.time = after, float(time)
        innovation = measured - expected.position
        return float(innovation @ np.linalg.solve(expected.covariance[:3, :3] + covariance, innovation))

    def forecast(self, horizons: Sequence[float] | ArrayLike) -> Forecast:
        """horizons: (H,), s from the latest measurement, each >= 0."""
        wanted = np.atleast_1d(np.asarray(horizons, dtype=float))
        points = [self._core.forecast(horizon) for horizon in wanted]
        return Forecast(
            float("nan") if self.time is None else self.time, wanted,
            np.array([point.position for point in points]).reshape(-1, 3),
            np.array([point.velocity for point in points]).reshape(-1, 3),
            np.array([point.covariance for point in points]).reshape(-1, 6, 6))

    def periodicity(self, horizon: float = 0.5) -> Periodicity | None:
        """What is known of a periodic motion, as far as it matters at this horizon, s; None: it is not asked."""
        return self._core.periodicity(horizon)
