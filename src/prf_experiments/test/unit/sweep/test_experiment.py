# SPDX-License-Identifier: BSD-3-Clause
import contextlib
import importlib
import io
import subprocess
import sys
import unittest

from prf_experiments.run import arguments as args
from prf_experiments.sweep import experiment, study, table


class Arguments(unittest.TestCase):
    def refused(self, *words):
        error = io.StringIO()
        with contextlib.redirect_stderr(error):
            code: object = None
            try:
                code = experiment.main(["--check", *words])
            except SystemExit as exit_:
                code = exit_.code
        self.assertEqual(code, 2, words)
        return error.getvalue()

    def test_bad_ones_are_refused_with_a_reason(self):
        for words, why in ((["tabel"], "did you mean table?"), (["table", "--seeds", "0"], "at least 1"),
                           (["table", "motion:=wild"], "valid: none|"),
                           (["table", "--seeds", "2", "seed:=3"], "say the same"),
                           (["compare", "--name", "a/b"], "plain name"),
                           (["table", "results:=a,b"], "one folder"),
                           (["table", "--scheduler", "host"], "must be an address"),
                           (["table", "--keep-bags", "some"], "must be one of failed, all, none"),
                           (["table", "keep_bag:=true"], "unknown argument"),
                           (["seed:=1,2"], "invalid seed"), (["--seeds", "2"], "unknown option"),
                           (["table", "--seed", "3"], "did you mean seed:=3 or --seeds 3?"),
                           (["--seed", "3"], "did you mean seed:=3?"), (["motion=light"], "motion:=light?"),
                           (["cart", "sed=3"], "did you mean seed:=3?"), (["gait"], "did you mean gait:="),
                           (["table", "--job", "3"], "did you mean --jobs 3?"),
                           (["motion:=absent.csv"], "absent.csv: there is no such file"),
                           (["motoin:=light"], "did you mean motion?"), (["gait:=stpe"], "mean step?")):
            told = self.refused(*words)
            self.assertIn(why, told)
            self.assertEqual(len(told.splitlines()), 1, told)

    def test_good_ones_pass_wherever_the_results_folder_stands(self):
        for words in ([], ["results:=/r", "table", "--seeds", "2", "motion:=light,heavy"],
                      ["trial", "seed:=3"], ["motion:=none"]):
            self.assertEqual(experiment.main(["--check", *words]), 0)

    def test_are_checked_without_ros(self):
        code = ("import sys; from prf_experiments.sweep import experiment; "
                "code = experiment.main(['--check', 'table', '--seeds', '2']); "
                "sys.exit(code or any(name in sys.modules for name in ('rospy', 'rospkg', 'numpy')))")
        self.assertEqual(subprocess.run([sys.executable, "-c", code], check=False).returncode, 0)


class Trials(unittest.TestCase):
    def trials(self, *words):
        return study.trials(table.STUDY, experiment.parse(["table", *words])[0])

    def test_three_seeds_give_the_papers_36_trials(self):
        trials = self.trials()
        self.assertEqual(len(trials), 36)
        self.assertEqual({trial["seed"] for trial in trials}, {1, 2, 3})

    def test_arguments_restrict_axes_add_new_ones_and_fix_the_others(self):
        trials = self.trials("--seeds", "2", "motion:=heavy", "planner:=elte,dmp", "gait:=step",
                             "decision:=forward")
        self.assertEqual(len(trials), 1 * 1 * 2 * 2 * 2)
        self.assertEqual({trial["motion"] for trial in trials}, {"heavy"})
        self.assertEqual({trial["planner"] for trial in trials}, {"elte", "dmp"})
        self.assertEqual({trial["decision"] for trial in trials}, {"forward"})
        self.assertEqual(set(trials[0]), set(args.parse([], experiment.trial_arguments.LAUNCHED)))

    def test_of_every_study_have_valid_arguments(self):
        for name in experiment.STUDIES:
            described = importlib.import_module("prf_experiments.sweep." + name).STUDY
            for trial in study.trials(described, experiment.parse([name, "--seeds", "1"])[0]):
                for word in experiment.trial_arguments.words(trial):
                    key, _, text = word.partition(":=")
                    self.assertEqual(args.value(key, text, experiment.SWEEP_ARGUMENTS), trial[key])


if __name__ == "__main__":
    unittest.main()
