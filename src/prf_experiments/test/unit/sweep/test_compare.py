# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
from made_up import result
from prf_experiments.report import page
from prf_experiments.sweep import compare, statistics


def trials(shift, seeds=12, motions=("light", "heavy")):
    """ELTE's and DMP's trials; DMP's distances are larger by `shift` and some noise."""
    random = np.random.default_rng(3)
    found = []
    for motion in motions:
        for planner in ("elte", "dmp"):
            for seed in range(1, seeds + 1):
                base = 10.0 + seed + (shift if planner == "dmp" else 0.0) + random.normal(0.0, 0.3)
                found.append(result(motion=motion, planner=planner, seed=seed, gait="step",
                                    figures={name: base + row
                                             for row, name in enumerate(compare.MEASURES)}))
    return found


class Compare(unittest.TestCase):
    def test_pairs_by_seed_whatever_the_order_of_the_trials(self):
        results = trials(2.0)
        summary = compare.summarise(results)
        first = [item["figures"]["tracking_lateral_mean_mm"] for item in results[:12]]
        second = [item["figures"]["tracking_lateral_mean_mm"] for item in results[12:24]]
        expected = statistics.paired(first, second)
        found = next(pair for pair in summary["pairs"] if pair["motion"] == "light"
                     and pair["measure"] == "tracking_lateral_mean_mm")
        self.assertEqual((found["first"], found["second"], found["pairs"]), ("elte", "dmp", 12))
        self.assertAlmostEqual(found["difference_mean_mm"], expected.difference.mean, 9)
        self.assertAlmostEqual(found["t_test_p"], expected.t_p, 12)
        swapped = results[:12][::-1] + results[12:]
        self.assertEqual(compare.summarise(swapped)["pairs"], summary["pairs"])

    def test_finds_a_difference_that_is_there_and_none_that_is_not(self):
        for shift, significant in ((2.0, True), (0.0, False)):
            for pair in compare.summarise(trials(shift))["pairs"]:
                self.assertEqual(pair["wilcoxon_p"] < 0.01, significant)
                self.assertEqual(pair["t_test_p"] < 0.01, significant)

    def test_the_conclusion_names_differences_beyond_chance_only(self):
        told = compare.conclusion(compare.summarise(trials(2.0)))
        self.assertRegex(told, r"^S: elte 24 of 24, dmp 24 of 24; on the way the tag is off the axis with elte by "
                         r"\d\.\d mm less than with dmp \(light\), \d\.\d mm less .* p < 0\.025\)\.$")
        self.assertIn("no more or less with elte", compare.conclusion(compare.summarise(trials(0.0))))
        self.assertEqual(compare.conclusion(compare.summarise(trials(2.0)[:12])), "S: elte 12 of 12.")

    def test_leaves_out_seeds_of_which_a_planner_has_no_number(self):
        results = trials(2.0, motions=["heavy"])
        results[3]["figures"] = {}
        summary = compare.summarise(results)
        self.assertEqual({pair["pairs"] for pair in summary["pairs"]}, {11})
        self.assertEqual(summary["cells"][0]["tracking_lateral_mean_mm"]["count"], 11)

    def test_text_and_page_show_every_motion_and_planner(self):
        results = trials(2.0)
        summary = compare.summarise(results)
        text = compare.text(summary)
        self.assertRegex(text, r"heavy +dmp +SSSSSSSSSS SS")
        self.assertRegex(text, r"light +elte − dmp +tracking, sd +12 +-\d\.\d ± 0\.\d +< 0\.001")
        body = page.render("sections.html", sections=compare.sections(summary, results, ""))
        self.assertEqual(body.count("data-plot="), len(compare.MEASURES))
        self.assertEqual(body.count('class="test S"'), len(results))

    def test_one_planner_alone_is_compared_with_nothing(self):
        summary = compare.summarise(trials(2.0)[:12])
        self.assertEqual(summary["pairs"], [])
        text = compare.text(summary)
        self.assertIn("elte", text)
        self.assertNotIn("difference", text)


if __name__ == "__main__":
    unittest.main()
