# SPDX-License-Identifier: BSD-3-Clause
"""One seed, one result; and the framework publishes for a bag what it did for the simulator."""
import json
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(__file__))
import runs
from prf_experiments.record import digest, topics

# Of every kind something, and little enough for the target to be reached.
DISTURB = "disturb:=push_hand:20@4.5,push_body:40@5.5,stumble:1.2@5,occlude:0.2@3.5,dark:0.2@4"
SECONDS = 12.0  # enough for every node to work and for the target to be reached


class Repeatability(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.results = cls._folder.name
        cls.bag = cls.trial(1)

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    @classmethod
    def trial(cls, seed):
        run = runs.run("run_trial", "motion:=light", DISTURB, f"seed:={seed}", f"time_limit:={SECONDS}",
                       "report:=false", f"results:={cls.results}")
        if run.code != 0 or "verdict S" not in run.out:
            raise AssertionError(run.out + run.error)
        return os.path.join(run.folder, "trial.bag")

    def test_a_second_run_with_the_seed_gives_the_same_messages(self):
        ours, theirs = digest.digests(self.bag), digest.digests(self.trial(1))
        self.assertEqual(digest.differences(ours, theirs), [])
        for topic in topics.SENSORS + topics.OUTPUTS:
            self.assertTrue(any(name == "/" + topic for name, _ in ours), topic)

    def test_another_seed_gives_other_images(self):
        ours, theirs = (digest.digests(bag, ["/camera/image_raw"])
                        for bag in (self.bag, self.trial(2)))
        (key, image), = ours.items()
        self.assertEqual([(key, image.messages)],
                         [(other, found.messages) for other, found in theirs.items()])
        self.assertNotEqual(image.sha256, theirs[key].sha256)

    def test_replay_gives_the_same_outputs(self):
        result = os.path.join(self.results, "replay.json")
        run = runs.run("replay", self.bag, "--json", result)
        self.assertEqual(run.code, 0, run.out + run.error)
        with open(result, encoding="utf-8") as stream:
            content = json.load(stream)
        self.assertTrue(content["identical"])
        self.assertGreater(content["compared_messages"], 4 * 100 * SECONDS)


if __name__ == "__main__":
    unittest.main()
