# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
from made_up import result
from prf_experiments.sweep import cart, reactive


def trials(framework, *errors):
    return [result(framework=framework, seed=seed, figures={
        "final_lateral_mm": error, "final_along_error_mm": -1.0, "forecast_horizon_s": 0.5,
        "forecast_error_rms_mm": 20.0 + error}) for seed, error in enumerate(errors, 1)]


class OneFigureStudies(unittest.TestCase):
    def test_cart_compares_the_error_at_the_end_with_and_without_the_framework(self):
        text = cart.text(cart.summarise(trials(False, 150.0) + trials(True, 1.0, 3.0)))
        self.assertRegex(text, r"off +S +\+150\.0 +-1\.0 +–")
        self.assertRegex(text, r"on +S S +\+2\.0 ± 1\.4 +-1\.0 ± 0\.0 +–")

    def test_reactive_tells_the_forecasts_error(self):
        summary = reactive.summarise(trials(True, 1.0, 3.0))
        self.assertEqual(summary["forecast_error_rms_mm"]["mean"], 22.0)
        self.assertIn("0.5 s ahead", reactive.text(summary))

    def test_pages_say_so_when_a_bag_was_not_kept(self):
        results = trials(True, 1.0)
        for study in (cart, reactive):
            self.assertIn("--keep-bags all", study.sections({}, results, "/absent")[0].text)


if __name__ == "__main__":
    unittest.main()
