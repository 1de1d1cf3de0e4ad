# SPDX-License-Identifier: BSD-3-Clause
"""The Python package prf_predictor, run by scripts/test_wheels."""
import ast
import os
import unittest

import numpy as np

import prf_predictor
from prf_predictor import Predictor, _core

TIMES = np.arange(0.0, 25.0, 1.0 / 15.0)
SIGMA = 0.002


def sway(seed=1):
    """Measured and true positions of a target that sways at 2 rad/s."""
    truth = np.column_stack([0.05 * np.sin(2.0 * TIMES), 0.02 * np.cos(2.0 * TIMES), 0.5 + 0.0 * TIMES])
    return truth + np.random.default_rng(seed).normal(0.0, SIGMA, truth.shape), truth


class Predictors(unittest.TestCase):
    def test_all_forecast_with_a_covariance(self):
        measured, _ = sway()
        for name in prf_predictor.predictor_names():
            predictor = Predictor(name)
            for time, position in zip(TIMES[:60], measured):
                predictor.update(time, position, SIGMA)
            forecast = predictor.forecast([0.0, 0.5])
            self.assertEqual(forecast.time, TIMES[59])
            self.assertEqual(forecast.covariances.shape, (2, 6, 6))
            self.assertGreater(np.linalg.eigvalsh(forecast.covariances[1])[0], -1e-12, name)
            self.assertLess(np.linalg.norm(forecast.positions[0] - measured[59]), 0.05, name)
            self.assertEqual(forecast.position_sigmas.shape, (2, 3))

    def test_periodic_beats_standstill_and_is_honest(self):
        measured, truth = sway()
        results = {name: prf_predictor.evaluate(Predictor(name), TIMES, measured, [0.5], noise=SIGMA, truth=truth,
                                                settle=10.0) for name in ("periodic", "hold", "paper")}
        self.assertLess(results["periodic"].rms[0], 0.3 * results["hold"].rms[0])
        self.assertLess(results["periodic"].rms[0], 0.5 * results["paper"].rms[0])
        self.assertLess(np.nanmean(results["periodic"].nees), 6.0)
        self.assertTrue(np.isnan(results["periodic"].nis[0]))
        self.assertTrue(np.all(np.isfinite(results["periodic"].nis[1:])))

    def test_nis_of_a_matching_model_lies_within_its_bounds(self):
        random = np.random.default_rng(2)
        step, density = 1.0 / 15.0, 0.04
        position, velocity = np.zeros(3), np.zeros(3)
        root = np.linalg.cholesky(density * np.array([[step**3 / 3, step**2 / 2], [step**2 / 2, step]]))
        predictor, nis = Predictor("constant_velocity", acceleration_density=density), []
        for k in range(600):
            nis.append(predictor.update(k * step, position + random.normal(0.0, SIGMA, 3), SIGMA))
            kick = root @ random.normal(size=(2, 3))
            position, velocity = position + step * velocity + kick[0], velocity + kick[1]
        low, high = prf_predictor.mean_bounds(550, probability=0.999)
        self.assertTrue(low < np.mean(nis[50:]) < high, f"{low} < {np.mean(nis[50:])} < {high}")

    def test_knows_the_frequency(self):
        measured, _ = sway()
        predictor = Predictor("periodic")
        for time, position in zip(TIMES, measured):
            predictor.update(float(time), position, SIGMA)
        periodicity = predictor.periodicity()
        assert periodicity is not None
        self.assertGreater(periodicity.probability, 0.5)
        self.assertAlmostEqual(periodicity.frequencies[0], 2.0, delta=0.25)
        still = Predictor("hold")
        still.update(0.0, [0, 0, 1])
        self.assertIsNone(still.periodicity())

    def test_refuses_what_is_wrong_and_stays_as_it_was(self):
        with self.assertRaisesRegex(ValueError, "predictor = x, must be one of: periodic"):
            Predictor("x")
        with self.assertRaisesRegex(ValueError, "density"):
            Predictor("ukf", density=1.0)
        predictor = Predictor("ukf")
        with self.assertRaisesRegex(ValueError, "begun by a measurement"):
            predictor.forecast([0.1])
        predictor.update(1.0, [0, 0, 1])
        before = predictor.forecast([0.5])
        for refusal, arguments in (
                ("time = 0.5", (0.5, [0, 0, 1])), ("time = nan", (np.nan, [0, 0, 1])),
                ("position", (1.1, [np.nan, 0, 1])), ("covariance", (1.1, [0, 0, 1], 0.0)),
                ("noise has shape", (1.1, [0, 0, 1], [1, 2])), ("dt", (1e9, [0, 0, 1]))):
            with self.assertRaisesRegex(ValueError, refusal):
                predictor.update(*arguments)
        with self.assertRaisesRegex(ValueError, "horizon = -1"):
            predictor.forecast([-1.0])
        np.testing.assert_array_equal(predictor.forecast([0.5]).covariances, before.covariances)
        with self.assertRaisesRegex(ValueError, r"must be \(N,\)"):
            prf_predictor.evaluate(Predictor("ukf"), [0, 1], np.zeros((3, 3)), [0.1])


class Consistency(unittest.TestCase):
    def test_bounds_and_squares(self):
        low, high = prf_predictor.mean_bounds(1)
        self.assertAlmostEqual(prf_predictor.chi_square_cdf(3, high) - prf_predictor.chi_square_cdf(3, low), 0.95, 9)
        squares = prf_predictor.normalised_squares([[3.0, 4.0], [1.0, 0.0]], [np.eye(2), 0.25 * np.eye(2)])
        np.testing.assert_allclose(squares, [25.0, 4.0])


class Hints(unittest.TestCase):
    def test_name_everything_in_the_compiled_part(self):
        with open(os.path.join(os.path.dirname(prf_predictor.__file__), "_core.pyi"), encoding="utf-8") as file:
            nodes = [node for node in ast.parse(file.read()).body if isinstance(node, (ast.ClassDef, ast.FunctionDef))]
        self.assertEqual({node.name for node in nodes}, {name for name in vars(_core) if not name.startswith("_")})
        for node in nodes:
            if isinstance(node, ast.ClassDef):
                members = {n.name for n in node.body if isinstance(n, ast.FunctionDef)} - {"__init__"}
                self.assertEqual(members, {n for n in dir(getattr(_core, node.name)) if not n.startswith("_")})


if __name__ == "__main__":
    unittest.main()
