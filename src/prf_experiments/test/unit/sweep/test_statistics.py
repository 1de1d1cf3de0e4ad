# SPDX-License-Identifier: BSD-3-Clause
import unittest

import numpy as np
import scipy.stats
from prf_experiments.sweep import statistics


class Wilson(unittest.TestCase):
    def test_gives_published_intervals(self):
        # R. G. Newcombe, Statistics in Medicine 17 (1998), table I, method 3.
        for successes, trials, low, high in ((81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605),
                                             (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)):
            found = statistics.wilson(successes, trials)
            np.testing.assert_allclose(found, (low, high), atol=5e-5)

    def test_ends_solve_the_score_equation(self):
        for successes, trials in ((3, 30), (15, 30), (29, 30)):
            rate = successes / trials
            for end in statistics.wilson(successes, trials):
                self.assertAlmostEqual(abs(rate - end), scipy.stats.norm.ppf(0.975)
                                       * np.sqrt(end * (1 - end) / trials), 12)

    def test_mirrors_and_covers_the_rate(self):
        for successes in range(31):
            low, high = statistics.wilson(successes, 30)
            self.assertTrue(0.0 <= low <= successes / 30 <= high <= 1.0)
            np.testing.assert_allclose(statistics.wilson(30 - successes, 30), (1 - high, 1 - low),
                                       atol=1e-12)

    def test_knows_nothing_without_trials_and_refuses_more_successes_than_trials(self):
        self.assertEqual(statistics.wilson(0, 0), (0.0, 1.0))
        with self.assertRaisesRegex(ValueError, r"successes = 4, must be in 0\.\.3"):
            statistics.wilson(4, 3)


class PairedTests(unittest.TestCase):
    def test_agree_with_scipy_and_with_the_formula(self):
        random = np.random.default_rng(5)
        first = random.normal(10.0, 2.0, 30)
        second = first + random.normal(0.8, 1.0, 30)
        found = statistics.paired(list(first), list(second))
        difference = first - second
        t = difference.mean() / (difference.std(ddof=1) / np.sqrt(30))
        self.assertAlmostEqual(found.t_p, 2 * scipy.stats.t.sf(abs(t), 29), 12)
        self.assertAlmostEqual(found.wilcoxon_p, scipy.stats.wilcoxon(first, second).pvalue, 12)
        self.assertAlmostEqual(found.difference.mean, difference.mean(), 12)
        self.assertEqual(found.count, 30)

    def test_smallest_sample_of_wilcoxon_is_exact(self):
        # All five differences of one sign: two of the 2^5 sign patterns are as extreme.
        found = statistics.paired([1, 2, 3, 4, 5], [0, 0, 0, 0, 0])
        self.assertEqual(found.wilcoxon_p, 2 / 32)

    def test_leave_out_pairs_with_a_missing_number(self):
        found = statistics.paired([1.0, None, 3.0, 4.0], [0.5, 1.0, None, 2.0])
        self.assertEqual(found.count, 2)
        self.assertEqual(found.difference.mean, 1.25)

    def test_have_no_p_value_below_two_pairs_and_one_for_equal_series(self):
        self.assertIsNone(statistics.paired([1.0], [2.0]).t_p)
        self.assertIsNone(statistics.paired([], []).wilcoxon_p)
        same = statistics.paired([1.0, 2.0, 3.0], [1.0, 2.0, 3.0])
        self.assertEqual((same.t_p, same.wilcoxon_p), (1.0, 1.0))
        self.assertEqual(statistics.paired([1.0, 2.0], [0.0, 1.0]).t_p, 0.0)

    def test_refuse_series_that_are_no_pairs(self):
        with self.assertRaisesRegex(ValueError, "3 and 2"):
            statistics.paired([1, 2, 3], [1, 2])


class Spreads(unittest.TestCase):
    def test_know_what_is_not_defined(self):
        self.assertEqual(statistics.spread([None, None]), statistics.Spread(0))
        self.assertEqual(statistics.spread([2.0, None]), statistics.Spread(1, 2.0, None))
        found = statistics.spread([1.0, 3.0])
        self.assertEqual((found.count, found.mean), (2, 2.0))
        self.assertAlmostEqual(found.deviation, np.sqrt(2.0), 12)


if __name__ == "__main__":
    unittest.main()
