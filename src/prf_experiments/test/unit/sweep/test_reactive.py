# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import made_up
from prf_experiments.sweep import reactive


class Reactive(unittest.TestCase):
    def told(self, **figures):
        return reactive.conclusion(reactive.summarise([made_up.result(
            figures={"forecast_horizon_s": 0.33, **figures})]))

    def test_the_conclusion_is_of_what_was_measured(self):
        self.assertEqual(self.told(forecast_error_rms_mm=8.2, reached_s=12.34, tracking_lateral_mean_mm=4.06),
                         "Forecasts 0.33 s ahead are 8.2 mm off, rms; the target is reached after 12.3 s; while "
                         "tracking the tag is 4.1 mm off the axis, on average.")
        self.assertEqual(self.told(), "The target is not reached.")


if __name__ == "__main__":
    unittest.main()
