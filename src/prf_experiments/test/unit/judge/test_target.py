# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import target

from prf_experiments import geometry


class Target(unittest.TestCase):
    def setUp(self):
        self.data = synthetic.make_recording(4.0)
        arm = geometry.compose(synthetic.BASE, synthetic.ARM_BASE_IN_BODY)
        self.at = geometry.compose(geometry.inverse(arm), synthetic.TAG)[:3]
        count = len(self.data.detection_stamps)
        self.data.forecasts.horizons = [np.array([0.0, 0.1, 0.5])] * count
        self.data.forecasts.positions = [np.tile(self.at, (3, 1)) for _ in range(count)]

    def test_truth_is_seen_from_the_arms_base(self):
        stamps, positions = target.true(self.data)
        np.testing.assert_array_equal(stamps, self.data.ticks)
        np.testing.assert_allclose(positions, np.tile(self.at, (len(stamps), 1)), atol=1e-12)

    def test_forecast_is_stamped_with_the_moment_it_is_for(self):
        stamps, positions, horizon = target.forecast(self.data, 0.12)
        self.assertEqual(horizon, 0.1)
        np.testing.assert_array_equal(stamps, self.data.detection_stamps + 100_000_000)
        self.assertEqual(positions.shape, (len(stamps), 3))

    def test_error_is_measured_where_the_truth_is_known(self):
        horizon, error = target.forecast_error(self.data)
        self.assertEqual(horizon, 0.5)
        self.assertAlmostEqual(error or 0.0, 0.0, 9)
        self.assertIsNotNone(error)
        for positions in self.data.forecasts.positions:
            positions[2] += [0.003, 0.0, -0.004]
        self.assertAlmostEqual(target.forecast_error(self.data)[1] or 0.0, 5.0, 9)
        stamps, positions, _ = target.forecast(self.data)
        self.assertLess(len(target.errors(stamps, positions, target.true(self.data))), len(stamps))

    def test_truth_between_two_ticks_is_interpolated(self):
        truth = np.array([0, 10]), np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 4.0]])
        np.testing.assert_allclose(target.errors(np.array([5]), np.array([[0.5, 1.0, 2.5]]), truth),
                                   [[0.0, 0.0, 0.5]])

    def test_no_forecast_is_no_number(self):
        self.data.forecasts.horizons = [np.array([])] * len(self.data.detection_stamps)
        self.assertIsNone(target.forecast_error(self.data)[1])


if __name__ == "__main__":
    unittest.main()
