# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.faults import disturbances
from prf_experiments.judge import cause, judge, timeline, world
from prf_experiments.record import recording
from prf_experiments.run import arguments as args
from prf_experiments.run import trial_arguments


def values(*words):
    return trial_arguments.complete(args.parse(words, trial_arguments.TRIAL), words)


class Disturbances(unittest.TestCase):
    def test_a_trial_names_them_and_they_are_parted_by_who_acts_on_them(self):
        trial = values("disturb:=push:60,occlude:1.5@6,stumble:2@4", "fault:=flip@3-4")
        self.assertIn("_disturb-push-60-occlude-1.5@6-stumble-2@4", trial_arguments.name(trial))
        self.assertEqual(args.parse(trial_arguments.words(trial), trial_arguments.TRIAL), trial)
        launched = disturbances.launched(trial)
        self.assertEqual(launched["disturb"], "push:60,stumble:2@4")
        self.assertEqual(launched["fault"], "flip@3-4,occlusion:0.95@6-7.5")

    def test_the_camera_is_disturbed_by_the_fault_injector_at_a_time_of_the_seed(self):
        first = disturbances.as_faults("occlude:1,dark:2", 1)
        self.assertEqual(first, disturbances.as_faults("occlude:1,dark:2", 1))
        self.assertNotEqual(first, disturbances.as_faults("occlude:1,dark:2", 2))
        covered, dark = disturbances.all_faults(values("disturb:=occlude:1+dark:2"))
        self.assertEqual((covered.name, dark.name), ("occlusion", "exposure"))
        self.assertAlmostEqual(dark.end - dark.begin, 2.0)
        self.assertTrue(3.0 <= covered.begin <= 9.0)
        self.assertEqual(disturbances.as_faults("dark:0", 1), "")

    def test_a_trial_waits_for_every_response_where_none_is_taken_away(self):
        self.assertEqual(disturbances.launched(values("disturb:=dark:1"))["patience"], 0.0)
        self.assertNotIn("patience", disturbances.launched(values("disturb:=dark:1", "fault:=drop/tf")))

    def test_what_is_none_is_refused_with_what_is_valid(self):
        for word, told in (("kick:3", "push|"), ("push", "NAME:LEVEL"), ("push:201", "0 .. 200"),
                           ("occlude:4", "0 .. 3"), ("push:nan", "no disturbance"), ("push:-1", "0 .. 200"),
                           ("push:2@", "no disturbance"), ("stumbel:1", "did you mean stumble")):
            with self.assertRaises(args.ArgumentError, msg=word) as caught:
                values(f"disturb:={word}")
            self.assertIn(told, str(caught.exception))
        with self.assertRaises(args.ArgumentError):
            values("disturb:=cart:0.2")
        self.assertEqual(values("disturb:=cart:0.2", "scenario:=cart")["motion"], "none")

    def test_every_one_has_a_meaning_and_is_listed(self):
        for name in disturbances.KINDS:
            self.assertIn(f"  {name} ", trial_arguments.usage())


class Told(unittest.TestCase):
    def test_a_push_is_an_event_of_the_world_and_no_fault(self):
        data = synthetic.make_recording(61.0, lateral=0.3, state="WAITING")
        word = "push_hand:60@3"
        data.fault_events = [recording.FaultEvent(int(stamp), word, "60 N on the hand" if row == 0 else "")
                             for row, stamp in enumerate(data.ticks[300:330])]
        event, = world.events(data)
        self.assertFalse(event.injected)
        self.assertEqual(event.text, "the robot was pushed with 60 N on the hand")
        verdict = judge.judge(data)
        self.assertIn("he robot was pushed with 60 N on the hand from 3.0 to 3.3 s",
                      cause.sentence(data, verdict))
        self.assertNotIn("FAULT", timeline.text(data, verdict))

    def test_a_platform_that_moves_before_a_quay_pushes_no_box(self):
        data = synthetic.make_recording(10.0)
        data.platform.values[:, 1] += [0.01 * row for row in range(len(data.ticks))]
        self.assertTrue(world.events(data))
        data.description = {"arguments": {"scenario": "quay"}}
        self.assertEqual(world.events(data), [])


if __name__ == "__main__":
    unittest.main()
