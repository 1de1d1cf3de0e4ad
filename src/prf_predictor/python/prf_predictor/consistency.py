# SPDX-License-Identifier: BSD-3-Clause
"""Errors of forecasts, and whether their covariances are honest (NIS, NEES)."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from prf_predictor._core import chi_square_quantile
from prf_predictor.predictor import Array, Predictor

FREEDOM = 3  # coordinates of a position


def normalised_squares(errors: ArrayLike, covariances: ArrayLike) -> Array:
    """e' P^-1 e for errors (..., d) and covariances (..., d, d)."""
    e, p = np.asarray(errors, dtype=float), np.asarray(covariances, dtype=float)
    return np.einsum("...i,...i->...", e, np.linalg.solve(p, e[..., None])[..., 0])


def mean_bounds(count: int, probability: float = 0.95, freedom: int = FREEDOM) -> tuple[float, float]:
    """Bounds that hold the mean of `count` independent NIS or NEES with this probability, if covariances are honest."""
    tail, degrees = 0.5 * (1.0 - probability), count * freedom
    return chi_square_quantile(degrees, tail) / count, chi_square_quantile(degrees, 1.0 - tail) / count


@dataclass(frozen=True)
class Evaluation:
    """Of one predictor on one recorded motion of N measurements, at H horizons."""

    horizons: Array
    """(H,), s."""
    nis: Array
    """(N,), NaN where there was no innovation yet; 3 on average when honest."""
    errors: Array
    """(N, H, 3), forecast less truth, m; NaN where the truth is not known."""
    nees: Array
    """(N, H), normalised estimation error squared of the position; 3 on average when honest."""

    @property
    def rms(self) -> Array:
        """(H,), root mean square of the error's length, m; NaN where nothing came due."""
        squares = np.sum(self.errors**2, axis=2)
        due = np.isfinite(squares)
        return np.sqrt(np.where(due, squares, 0.0).sum(axis=0) / np.where(due.any(axis=0), due.sum(axis=0), np.nan))


def evaluate(predictor: Predictor, times: ArrayLike, measured: ArrayLike, horizons: ArrayLike, *,
             noise: ArrayLike = 0.002, truth: ArrayLike | None = None, settle: float = 0.0) -> Evaluation:
    """Run a new predictor over a recorded motion and compare its forecasts with what came.

    times: (N,), s, rising. measured: (N, 3), m. horizons: (H,), s. noise: as Predictor.update(). truth: (N, 3), m, at
    the same times; None: the measured positions, whose noise then counts as error. settle: s from the first
    measurement whose forecasts do not count. Truth between the times is interpolated linearly.
    """
    instants, positions = np.asarray(times, dtype=float), np.asarray(measured, dtype=float)
    wanted = np.atleast_1d(np.asarray(horizons, dtype=float))
    known = positions if truth is None else np.asarray(truth, dtype=float)
    if positions.shape != (len(instants), 3) or known.shape != positions.shape:
        raise ValueError(f"times are {instants.shape}, measured {positions.shape} and truth {known.shape}, "
                         "must be (N,), (N, 3) and (N, 3)")
    nis = np.empty(len(instants))
    errors = np.full((len(instants), len(wanted), 3), np.nan)
    nees = np.full((len(instants), len(wanted)), np.nan)
    for k, (time, position) in enumerate(zip(instants, positions)):
        nis[k] = predictor.update(time, position, noise)
        if time - instants[0] < settle:
            continue
        forecast = predictor.forecast(wanted)
        due = time + wanted
        there = np.column_stack([np.interp(due, instants, column) for column in known.T])
        there[due > instants[-1]] = np.nan
        errors[k] = forecast.positions - there
        nees[k] = normalised_squares(errors[k], forecast.covariances[:, :3, :3])
    return Evaluation(wanted, nis, errors, nees)
