# SPDX-License-Identifier: BSD-3-Clause
import os
import re
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
from made_up import result
from prf_experiments.sweep import statistics, study, table

RESULTS = [result(verdict, verdict == "S", {"tracking_lateral_mean_mm": float(seed),
                                            "largest_contact_n": 2.0 * seed},
                  motion="heavy", gait="step", framework=framework, seed=seed)
           for framework, verdicts in ((False, ["P", "F", "F"]), (True, ["S", "S", "INVALID"]))
           for seed, verdict in enumerate(verdicts, 1)]


class Table(unittest.TestCase):
    def test_counts_each_cell_and_leaves_invalid_trials_out_of_the_rates(self):
        off, on = table.summarise(RESULTS)["cells"]
        self.assertEqual((off["framework"], off["tests"]), (False, "PFF"))
        self.assertEqual(off["counts"], {"S": 0, "P": 1, "F": 2, "INVALID": 0})
        self.assertEqual((on["tests"], on["counts"]["INVALID"]), ("SS×", 1))
        self.assertEqual(on["success"]["fraction"], 1.0)
        self.assertEqual((on["success"]["fraction_low_95"], on["success"]["fraction_high_95"]),
                         statistics.wilson(2, 2))
        self.assertEqual(on["tracking_lateral_mm"], {"mean": 2.0, "deviation": 1.0})
        self.assertEqual(off["largest_contact_n"], 6.0)

    def test_text_has_a_line_for_each_cell(self):
        lines = table.text(table.summarise(RESULTS)).splitlines()
        self.assertRegex(lines[1], r"^off +heavy +step +P F F +0 +1 +2 +0 +0 \(0–56\)")
        self.assertRegex(lines[2], r"^on +heavy +step +S S × +2 +0 +0 +1 +100 \(34–100\)")

    def test_many_tests_are_grouped_by_ten(self):
        self.assertEqual(table.grouped("S" * 12), "SSSSSSSSSS SS")
        self.assertEqual(table.grouped("SPF"), "S P F")

    def test_a_cell_without_valid_trials_has_no_rate(self):
        summary = table.summarise([result("INVALID", False)])
        self.assertIsNone(summary["cells"][0]["success"]["fraction"])
        self.assertIn("–", table.text(summary))

    def test_page_links_every_test_to_its_report(self):
        summary = table.summarise(RESULTS)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "index.html")
            study.write_page(path, table.STUDY, "run <it>", {"commit": "abc"}, RESULTS,
                             summary)
            with open(path, encoding="utf-8") as stream:
                text = stream.read()
        links = re.findall('<a class="test ([A-Z]+)" href="([^"]*)"', text)
        self.assertEqual(len(links), 2 * len(RESULTS))
        self.assertEqual(links[0], ("P", "trials/motion-heavy_gait-step_planner-elte_"
                                    "framework-false_seed-1/report.html"))
        self.assertIn("run &lt;it&gt;", text)
        self.assertIn("made &lt;up&gt;", text)
        self.assertEqual(text.count('<div class="plots"'), 2)
        self.assertFalse("http" in text, "the page must fetch nothing")

    def test_concludes_with_and_without_the_framework_and_shows_them_side_by_side(self):
        more = [result("S", True, {}, motion="light", gait="step", framework=framework, seed=1)
                for framework in (False, True)]
        summary = table.summarise(RESULTS + more)
        self.assertEqual(table.conclusion(summary), "With the framework S in 3 of 3 trials (95 %: 44 to 100 %); "
                         "without it S in 1 of 4 trials (95 %: 5 to 70 %).")
        self.assertEqual([table.label_of(item, summary["axes"]) for item in table.side_by_side(summary)],
                         ["heavy, step, off", "heavy, step, on", "light, step, off", "light, step, on"])


if __name__ == "__main__":
    unittest.main()
