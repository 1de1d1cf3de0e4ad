# SPDX-License-Identifier: BSD-3-Clause
import os
import subprocess
import sys
import tempfile
import unittest

from prf_experiments.run import arguments as args
from prf_experiments.run import trial_arguments


class TrialArguments(unittest.TestCase):
    def values(self, *words):
        return args.parse(words, trial_arguments.TRIAL)

    def complete(self, *words):
        return trial_arguments.complete(self.values(*words), words)

    def test_a_name_says_what_makes_a_trial_and_nothing_else(self):
        self.assertEqual(
            trial_arguments.name(self.values("motion:=heavy", "seed:=7", "results:=/elsewhere")),
            "motion-heavy_gait-stand_planner-elte_framework-true_seed-7")

    def test_what_is_not_the_default_is_in_the_name_and_in_the_command(self):
        values = self.values("decision:=forward", "demonstration:=/skills/wipe.csv")
        self.assertTrue(trial_arguments.name(values).endswith(
            "_seed-1_decision-forward_demonstration-wipe.csv"))
        self.assertEqual(args.parse(trial_arguments.words(values), trial_arguments.TRIAL),
                         self.values("decision:=forward", "demonstration:=/skills/wipe.csv"))

    def test_a_motion_is_a_preset_or_a_file_that_exists(self):
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            values = self.values(f"motion:={file.name}", f"body_motion:={file.name}")
            self.assertEqual(values["motion"], file.name)
            self.assertNotIn("/", trial_arguments.name(values))
        for word in ("motion:=wild", "motion:=absent.yaml", "body_motion:=absent.csv"):
            with self.assertRaises(args.ArgumentError):
                self.values(word)

    def test_a_motion_of_a_family_has_a_level(self):
        for word, value in (("heavy:2", "heavy:2"), ("sea:0.50", "sea:0.5"), ("stop:0", "stop:0")):
            values = self.values(f"motion:={word}")
            self.assertEqual(values["motion"], value)
            self.assertEqual(trial_arguments.name(values).split("_")[0],
                             "motion-" + value.replace(":", "-"))
        for word in ("heavy:", "heavy:x", "sea:-1", "bursts:3", "stop:nan", "light:1", "storm:1", "sea"):
            with self.assertRaises(args.ArgumentError):
                self.values(f"motion:={word}")

    def test_trials_of_files_with_one_name_are_told_apart_by_their_content(self):
        with tempfile.TemporaryDirectory() as folder:
            found = []
            for place, content in (("a", "1"), ("b", "2"), ("c", "1")):
                os.mkdir(os.path.join(folder, place))
                file = os.path.join(folder, place, "sea.csv")
                with open(file, "w", encoding="utf-8") as stream:
                    stream.write(content)
                found.append(self.values(f"motion:={file}"))
            first, other, copy = found
            names = [trial_arguments.name(values) for values in found]
            self.assertNotEqual(names[0], names[1])
            self.assertEqual(names[0], names[2])
            self.assertRegex(names[0], "motion-sea.csv-[0-9a-f]{8}_")
            verdict = {"arguments": first, "files": trial_arguments.contents(first)}
            self.assertTrue(trial_arguments.same(copy, verdict))
            self.assertFalse(trial_arguments.same(other, verdict))
            with open(first["motion"], "w", encoding="utf-8") as stream:
                stream.write("changed")
            self.assertFalse(trial_arguments.same(first, verdict))

    def test_the_floor_under_the_cart_does_not_move(self):
        self.assertEqual(self.complete("scenario:=cart")["motion"], "none")
        self.assertEqual(self.complete("scenario:=cart", "motion:=none")["motion"], "none")
        self.assertEqual(self.complete()["motion"], "light")
        with self.assertRaises(args.ArgumentError):
            self.complete("scenario:=cart", "motion:=light")

    def test_method_paper_sets_every_part_that_is_not_given(self):
        paper = self.complete("method:=paper", "motion:=heavy")
        self.assertEqual((paper["predictor"], paper["approach"]), ("paper", False))
        self.assertTrue({"method:=paper", "predictor:=paper", "approach:=false"}
                        <= set(trial_arguments.words(paper)))
        again = trial_arguments.words(paper)
        self.assertEqual(self.complete(*again), paper)
        self.assertEqual(self.complete("method:=paper", "predictor:=ukf")["predictor"], "ukf")
        self.assertEqual(self.complete()["predictor"], "periodic")

    def test_lists_are_parsed_value_by_value(self):
        self.assertEqual(args.parse_lists(["seed:=3,5", "framework:=false"], trial_arguments.TRIAL),
                         {"seed": [3, 5], "framework": [False]})
        self.assertEqual(args.parse_lists(["framework:=off,on"], trial_arguments.TRIAL),
                         {"framework": [False, True]})
        for word, why in (("seed:=3,x", "invalid seed:=x"), ("seed:=3,3", "twice"),
                          ("framework:=on,true", "twice"),
                          ("seed:=", "invalid seed:="), ("speed:=1", "unknown"),
                          ("seed", "name:=value")):
            with self.assertRaises(args.ArgumentError) as caught:
                args.parse_lists([word], trial_arguments.TRIAL)
            self.assertIn(why, str(caught.exception))

    def test_needs_no_ros(self):
        code = ("import sys; import prf_experiments.run.trial_arguments; "
                "sys.exit(any(name in sys.modules for name in ('rospy', 'rospkg', 'numpy')))")
        self.assertEqual(subprocess.run([sys.executable, "-c", code], check=False).returncode, 0)


if __name__ == "__main__":
    unittest.main()
