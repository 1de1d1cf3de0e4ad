# SPDX-License-Identifier: BSD-3-Clause
"""Predictors of a moving target: measured positions in, forecasts with covariance out. Metres, seconds, radians.

`Predictor` is what most need; `consistency` tells whether covariances are honest (NIS, NEES).
"""
from prf_predictor._core import Periodicity, chi_square_cdf, chi_square_quantile, predictor_names
from prf_predictor.consistency import Evaluation, evaluate, mean_bounds, normalised_squares
from prf_predictor.predictor import Forecast, Predictor, default_parameters

__all__ = [
    "Evaluation", "Forecast", "Periodicity", "Predictor", "chi_square_cdf", "chi_square_quantile",
    "default_parameters", "evaluate", "mean_bounds", "normalised_squares", "predictor_names",
]
