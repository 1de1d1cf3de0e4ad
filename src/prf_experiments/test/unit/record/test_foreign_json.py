# SPDX-License-Identifier: BSD-3-Clause
"""What is read as JSON, damaged at random: read in full or refused in words, never anything else.

PRF_JSON_INPUTS says how many of each (default 400).
"""
import contextlib
import json
import os
import random
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import made_up
import synthetic
from prf_experiments.judge import judge
from prf_experiments.record import recording
from prf_experiments.sweep import sweep, trial_runner

from prf_experiments import commands

INPUTS = int(os.environ.get("PRF_JSON_INPUTS", "400"))
DESCRIPTION = {"command": "run_trial motion:=light", "versions": {"commit": "abc", "numpy": "1.24"},
               "arguments": {"motion": "light", "seed": 1, "fault": "", "framework": True,
                             "demonstration": None, "scenario": "treadmill"}}
EVENT = {"stamp": 12345678901, "fault": "drop:tag_detections@3", "what": ""}
VALUES: list = [None, True, -1, 1e308, float("nan"), float("inf"), 10**40, "", "x" * 300, "\x00\ud800", [], [[]],
          {}, {"a": {}}]
PIECES = ["null", "NaN", "1e999", "[" * 2000, "]", "{", "}", ",", '"', ":", "\\u0000", "\x00", "\ufeff"]


def with_another_value(content, source):
    """The content with one value anywhere in it dropped, replaced, or put into a list."""
    if not isinstance(content, dict) or not content or source.random() < 0.1:
        return source.choice([*VALUES, [content]])
    name = source.choice(list(content))
    rest = {key: value for key, value in content.items() if key != name}
    if source.random() < 0.2:
        return rest
    return {**rest, name: with_another_value(content[name], source)}


def damaged(content, source):
    """The content as JSON with another value or with another piece of text."""
    if source.random() < 0.7:
        return json.dumps(with_another_value(content, source))
    text = json.dumps(content)
    at = source.randrange(len(text) + 1)
    return text[:at] + source.choice(["", source.choice(PIECES)]) + text[at + source.randint(0, 5):]


class ForeignJson(unittest.TestCase):
    def check(self, content, read, refusals):
        """Runs read(text) on damaged texts; returns how many were taken."""
        source, taken = random.Random(1), 0
        for number in range(INPUTS):
            text = damaged(content, source)
            with self.subTest(number=number, text=text[:300]):
                try:
                    read(text)
                    taken += 1
                except refusals as refusal:
                    self.assertTrue(str(refusal))
        self.assertTrue(INPUTS // 50 < taken < INPUTS, f"{taken} of {INPUTS} are taken")

    # Fault 54: a bag whose description of itself is damaged -> refused, or judged like any other
    def test_description(self):
        data = synthetic.make_recording(1.0)

        def read(text):
            data.description = recording.read_description(text)
            judge.judge(data)
        self.check(DESCRIPTION, read, (ValueError, RecursionError))

    def test_event_of_a_fault(self):
        def read(text):
            event = recording.read_event(text)
            self.assertTrue(isinstance(event.stamp, int) and isinstance(event.fault + event.what, str))
        self.check(EVENT, read, (ValueError, RecursionError))

    def test_verdict_of_a_sweep_is_whole_or_none(self):
        with tempfile.TemporaryDirectory() as folder:
            values = {"seed": 1}

            def read(text):
                with open(os.path.join(folder, "verdict.json"), "w", encoding="utf-8",
                          errors="surrogatepass") as stream:
                    stream.write(text)
                found = trial_runner.read(folder)
                if found is None:
                    raise ValueError("none")
                self.assertEqual({type(found[name]) for name in trial_runner.PARTS}, {str, bool, dict})
            self.check(made_up.result(**values), read, ValueError)

    def test_notes_of_a_sweep_that_are_damaged_are_written_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            for text in ("[]", "{}", "[" * 100000, '{"versions": []}', '"versions"', "\x00"):
                with open(os.path.join(folder, "sweep.json"), "w", encoding="utf-8") as stream:
                    stream.write(text)
                sweep.begin(folder, {"commit": "abc"}, any_version=False)
                with open(os.path.join(folder, "sweep.json"), encoding="utf-8") as stream:
                    self.assertEqual(json.load(stream), {"versions": {"commit": "abc"}})

    def test_bag_does_not_give_its_own_verdict(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(None):
            bag, page = os.path.join(folder, "a.bag"), os.path.join(folder, "a.html")
            synthetic.write_bag(bag, synthetic.make_recording(1.0), description={"verdict": "S", "reason": "forged"})
            commands.report_main([bag, page])
            with open(page, encoding="utf-8") as stream:
                self.assertNotIn("forged", stream.read())


if __name__ == "__main__":
    unittest.main()
