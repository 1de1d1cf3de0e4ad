# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
from made_up import result
from prf_experiments.run import arguments as args
from prf_experiments.run import trial_arguments
from prf_experiments.sweep import experiment, limits, study


def options(*words):
    return experiment.parse(["limits", *words])[0]


def trial(level, made, verdict, cause="", seed=1, **figures):
    return {**result(verdict, figures={"largest_contact_n": 0.0, **figures}, seed=seed, gait="stand",
                     **limits.world("heavy", level), **made), "cause": cause}


class Limits(unittest.TestCase):
    def test_every_world_is_one_that_trials_know(self):
        for values in study.trials(limits.STUDY, options("--seeds", "1", "--family", ",".join(limits.LEVELS))):
            words = trial_arguments.words(values)
            self.assertEqual(trial_arguments.complete(args.parse(words, trial_arguments.TRIAL), words)["motion"],
                             values["motion"])

    def test_families_and_levels_are_chosen_and_predictors_are_an_axis(self):
        trials = study.trials(limits.STUDY, options("--family", "sea,push", "--levels", "1,2", "--seeds", "3",
                                                    "predictor:=paper,periodic"))
        self.assertEqual(len(trials), 2 * 2 * len(limits.variants()) * 3 * 2)
        self.assertEqual({limits.place(values) for values in trials},
                         {("sea", 1.0), ("sea", 2.0), ("push", 1.0), ("push", 2.0)})
        self.assertEqual({limits.variant(values) for values in trials}, set(limits.variants()))
        for words in (("--family", "storm"), ("--levels", "x"), ("--levels", "-1")):
            with self.assertRaises(SystemExit):
                options(*words)

    def test_counts_successes_contacts_and_causes_and_finds_the_breaking_level(self):
        off, forward = limits.variants()["off"], limits.variants()["forward"]
        results = [trial(1.0, off, "S"), trial(1.0, off, "F", "...; lost in the forecast: ...", seed=2),
                   trial(2.0, off, "F", "the tag was never seen"), trial(2.0, off, "F", fallen_s=8.0, seed=2),
                   trial(1.0, forward, "S"), trial(2.0, forward, "P", reached_s=9.0, largest_contact_n=60.0)]
        summary = limits.summarise(results)
        first, second, _, last = summary["cells"]
        self.assertEqual((first["tests"], first["success"]["fraction"], first["lost_in"]),
                         ("SF", 0.5, {"forecast": 1}))
        self.assertEqual(second["lost_in"], {"fall": 1, "view": 1})
        self.assertEqual((last["contact"]["fraction"], last["hard_contact"]["fraction"], last["lost_in"]),
                         (1.0, 1.0, {"contact": 1}))
        self.assertEqual([row["breaks_at"] for row in summary["breaking_levels"]], [2.0, 2.0])
        self.assertIn("heavy   2      forward", limits.text(summary))
        self.assertEqual([section.title for section in limits.sections(summary, results, ".")],
                         ["heavy", "Each test"])

    def test_breaks_at_the_lowest_level_with_less_than_half_of_the_valid_trials(self):
        made = limits.variants()["forward"]

        def breaks_at(verdicts):
            results = [trial(level, made, verdict, seed=seed) for level, letters in verdicts
                       for seed, verdict in enumerate(letters)]
            [row] = limits.summarise(results)["breaking_levels"]
            return row["breaks_at"]
        self.assertIsNone(breaks_at([(1.0, "SF"), (2.0, "SSFF")]))
        self.assertEqual(breaks_at([(1.0, "SF"), (2.0, "SFF")]), 2.0)
        self.assertEqual(breaks_at([(3.0, "F"), (2.0, "SFF"), (1.0, "S")]), 2.0)
        self.assertEqual(breaks_at([(1.0, ["INVALID"]), (2.0, "F")]), 2.0)

    def test_servo_is_a_variant_of_its_own(self):
        for name, made in limits.variants().items():
            self.assertEqual(limits.variant({**limits.world("heavy", 1.0), "planner": "elte", "decision": "hmm",
                                             "hmm": "trained", **made}), name)


if __name__ == "__main__":
    unittest.main()
