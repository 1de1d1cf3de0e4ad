# SPDX-License-Identifier: BSD-3-Clause
import io
import json
import os
import tempfile
import threading
import time
import unittest

from prf_experiments.run import arguments as args
from prf_experiments.run import session, trial_arguments
from prf_experiments.sweep import sweep, trial_runner

DEFAULTS = args.parse([], trial_arguments.LAUNCHED)
VERSION = {"commit": "abc"}


def trials(*seeds):
    return sweep.product(DEFAULTS, {"motion": ["none", "heavy"], "seed": list(seeds)})


def verdict(values, what="S"):
    return {"verdict": what, "inspected": True, "reason": "made up", "figures": {},
            "arguments": {name: values[name] for name in trial_arguments.LAUNCHED},
            "files": trial_arguments.contents(values)}


class Attempts:
    """Stands in for run_trial: leaves a bag and notes what it was asked."""

    def __init__(self, what=lambda values, count: "S"):
        self.asked, self._what, self._lock = [], what, threading.Lock()

    def __call__(self, values, folder):
        name = trial_arguments.name(values)
        with self._lock:
            self.asked.append(name)
            count = self.asked.count(name)
        os.makedirs(folder)
        with open(os.path.join(folder, "trial.bag"), "wb") as stream:
            stream.write(b"x" * 1000)
        return verdict(values, self._what(values, count))


class Sweep(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.path.join(folder.name, "table")

    def run_sweep(self, attempt, seeds=(1, 2), versions=VERSION, **options):
        self.out = io.StringIO()
        return sweep.run(trials(*seeds), self.folder, sweep.SweepParams(**{"jobs": 3, **options}),
                         versions, attempt,
                         lambda total, kept: sweep.Board(total, kept, self.out))

    def folders(self):
        return sorted(os.listdir(os.path.join(self.folder, "trials")))

    # Fault 46: a Dask scheduler that no worker has joined -> said, and said again every half minute
    def test_says_what_it_waits_for(self):
        now, out = [0.0], io.StringIO()
        board = sweep.Board(2, 0, out, lambda: now[0])
        for at, lacking in ((1, "no worker"), (2, "no worker"), (35, "no worker"), (36, ""), (37, "no worker")):
            now[0] = at
            board.wait_for(lacking)
        self.assertEqual(out.getvalue().splitlines()[1:], ["no worker"] * 3)

    def test_runs_every_combination_once_and_answers_in_their_order(self):
        attempt = Attempts()
        results = self.run_sweep(attempt)
        self.assertEqual([result["arguments"] for result in results], trials(1, 2))
        self.assertEqual(sorted(attempt.asked), self.folders())
        self.assertEqual(len(self.folders()), 4)

    def test_draws_one_trial_of_each_cell_whatever_its_verdict(self):
        drawn = {}

        def attempt(values, folder):
            drawn[values["motion"], values["seed"]] = values["report"]
            return Attempts()(values, folder)
        self.run_sweep(attempt, seeds=(3, 1, 2))
        self.assertEqual(drawn, {(motion, seed): "true" if seed == 3 else "brief"
                                 for motion in ("none", "heavy") for seed in (1, 2, 3)})

    def test_goes_on_where_it_was_interrupted(self):
        self.run_sweep(Attempts(), seeds=(1,))
        half = sweep.trial_folder(self.folder, trials(2)[0]) + ".part"
        os.makedirs(half)
        open(os.path.join(half, "rubbish"), "w").close()
        attempt = Attempts()
        self.assertEqual(len(self.run_sweep(attempt)), 4)
        self.assertEqual(len(attempt.asked), 2)
        self.assertTrue(all("seed-2" in name for name in attempt.asked))
        self.assertFalse(any(name.endswith(".part") for name in self.folders()))
        self.assertFalse(os.path.exists(os.path.join(self.folder, "trials", attempt.asked[0],
                                                     "rubbish")))
        self.assertIn("2 of them finished before", self.out.getvalue())

    def test_repeats_a_trial_whose_verdict_is_damaged_or_of_other_arguments(self):
        self.run_sweep(Attempts())
        first, second = (os.path.join(sweep.trial_folder(self.folder, values), "verdict.json")
                         for values in trials(1))
        os.truncate(first, 20)
        with open(second, encoding="utf-8") as stream:
            content = json.load(stream)
        content["arguments"]["time_limit"] = 5.0
        with open(second, "w", encoding="utf-8") as stream:
            json.dump(content, stream)
        attempt = Attempts()
        self.run_sweep(attempt)
        self.assertEqual(sorted(attempt.asked),
                         sorted(trial_arguments.name(values) for values in trials(1)))

    def test_tries_a_failed_trial_once_more_and_then_reports_it_invalid(self):
        def what(values, count):
            if values["motion"] == "none":
                return "INVALID" if count == 1 else "P"
            return "INVALID"
        attempt = Attempts(what)
        results = self.run_sweep(attempt, seeds=(1,))
        self.assertEqual([result["verdict"] for result in results], ["P", "INVALID"])
        self.assertEqual([result["failed_attempts"] for result in results],
                         [["made up"], ["made up"]])
        self.assertEqual(len(attempt.asked), 4)
        again = Attempts()
        self.run_sweep(again, seeds=(1,))
        self.assertEqual(len(again.asked), 1, "INVALID is no evidence, P is")

    def test_keeps_the_bags_that_were_asked_for(self):
        for keep, kept in (("all", {"S", "F"}), ("failed", {"F"}), ("none", set())):
            self.folder += keep
            results = self.run_sweep(Attempts(lambda v, _: "S" if v["seed"] == 1 else "F"),
                                     keep_bags=keep)
            for values, result in zip(trials(1, 2), results):
                bag = os.path.join(sweep.trial_folder(self.folder, values), "trial.bag")
                self.assertEqual(os.path.exists(bag), result["verdict"] in kept, keep)
                self.assertEqual(result["disk_bytes"] >= 1000, result["verdict"] in kept)

    def test_files_of_one_name_are_trials_of_their_own_and_one_file_twice_is_refused(self):
        files = []
        for place, content in (("a", "1"), ("b", "2"), ("c", "1")):
            os.makedirs(os.path.join(self.folder, place))
            files.append(os.path.join(self.folder, place, "sea.csv"))
            with open(files[-1], "w", encoding="utf-8") as stream:
                stream.write(content)
        both = [{**DEFAULTS, "motion": file} for file in files]
        attempt = Attempts()

        def run(trials):
            return sweep.run(trials, self.folder, sweep.SweepParams(jobs=2), VERSION, attempt,
                             lambda total, kept: sweep.Board(total, kept, io.StringIO()))
        run(both[:2])
        self.assertEqual(len(set(attempt.asked)), 2)
        again = run([both[2]])  # the same content elsewhere: finished before, under its new place
        self.assertEqual(len(attempt.asked), 2)
        self.assertEqual(again[0]["arguments"]["motion"], files[2])
        with self.assertRaisesRegex(session.SessionError, "the same"):
            run([both[0], both[2]])

    def test_refuses_to_mix_versions_unless_it_may(self):
        self.run_sweep(Attempts(), seeds=(1,))
        with self.assertRaisesRegex(session.SessionError, "version abc, this is def"):
            self.run_sweep(Attempts(), versions={"commit": "def"})
        attempt = Attempts()
        self.run_sweep(attempt, versions={"commit": "def"}, any_version=True)
        self.assertEqual(len(attempt.asked), 2)

    def test_refuses_a_folder_in_which_another_sweep_is_at_work(self):
        with sweep.locked(self.folder):
            with self.assertRaisesRegex(session.SessionError, "another sweep"):
                self.run_sweep(Attempts())

    def test_runs_as_many_at_once_as_it_may(self):
        both = threading.Barrier(3, timeout=20.0)

        def what(values, count):
            both.wait()  # breaks unless three are here together
            return "S"
        self.run_sweep(Attempts(what), seeds=(1, 2, 3))

    def test_an_error_ends_the_sweep_and_leaves_what_is_finished(self):
        def what(values, count):
            if values["seed"] == 2:
                time.sleep(0.2)
                raise OSError("no space left")
            return "S"
        with self.assertRaises(OSError):
            self.run_sweep(Attempts(what))
        trial_runner._stopping.clear()
        self.assertEqual(sum("seed-1" in name and "." not in name for name in self.folders()), 2)


class Board(unittest.TestCase):
    def test_estimates_the_time_left_from_the_trials_of_this_run(self):
        now, out = [100.0], io.StringIO()
        board = sweep.Board(12, 2, out, lambda: now[0])
        self.assertIsNone(board.left())
        content = {**verdict(DEFAULTS), "failed_attempts": [], "disk_bytes": 12_345_678}
        for _ in range(4):
            now[0] += 60.0
            board.tell(DEFAULTS, content)
        self.assertEqual(board.left(), 6 * 60.0)
        self.assertIn("6/12", board.bar())
        self.assertIn("about 6 min left", board.bar())
        self.assertIn("(12 MB)", out.getvalue())

    def test_draws_its_bar_on_a_terminal_only(self):
        class Terminal(io.StringIO):
            def isatty(self):
                return True
        for out, expected in ((io.StringIO(), False), (Terminal(), True)):
            sweep.Board(4, 3, out).refresh()
            self.assertEqual("[##################......] 3/4" in out.getvalue(), expected)


if __name__ == "__main__":
    unittest.main()
