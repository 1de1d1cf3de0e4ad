# SPDX-License-Identifier: BSD-3-Clause
import os
import re
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import made_up
from prf_experiments.sweep import ablate, cart, compare, experiment, obstacles, study, table

PAGES = os.path.join(os.path.dirname(os.path.realpath(__file__)), *[".."] * 5, "docs", "results")


def command(*words):
    return study.reproducing(*experiment.parse(words))


class ResultsPage(unittest.TestCase):
    def test_its_command_has_what_the_numbers_depend_on_and_nothing_else(self):
        self.assertEqual(
            command("table", "--seeds", "3", "motion:=none,light", "results:=/elsewhere", "--jobs",
                    "2", "--json", "a.json", "--results-page", "a.md", "--name", "mine"),
            "./run_experiment table --seeds 3 motion:=none,light")
        self.assertEqual(command("cart"), "./run_experiment cart")

    def test_holds_command_and_table_as_printed(self):
        page = study.results_page(table.STUDY, "./run_experiment table", "a  b\n1  2\n")
        self.assertTrue(page.startswith("# Trials\n\nS success"), page)
        self.assertTrue(page.endswith("```\n./run_experiment table\n```\n\n"
                                      "```text\na  b\n1  2\n```\n"), page)

    def test_those_in_docs_are_what_the_commands_write(self):
        for name, described in (("table", table), ("compare", compare), ("ablate", ablate),
                                ("cart", cart)):
            with open(os.path.join(PAGES, name + ".md"), encoding="utf-8") as stream:
                page = stream.read()
            given, text = re.findall(r"```(?:text)?\n(.*?)```\n", page, flags=re.S)
            self.assertEqual(page, study.results_page(described.STUDY, given.strip(), text))
            self.assertEqual(command(*given.split()[1:]), given.strip())

class TrialsOnThePage(unittest.TestCase):
    def test_are_named_by_what_tells_them_apart(self):
        results = [made_up.result(seed=seed, gait="step", disturb="") for seed in (1, 2)]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "index.html")
            study.write_page(path, obstacles.STUDY, "a command", {}, results, obstacles.summarise([]))
            with open(path, encoding="utf-8") as stream:
                page = stream.read()
        self.assertIn("<td>seed 2</td>", page)
        self.assertIn("<tr><td>disturb</td><td>none</td></tr>", page)
        self.assertIn("<tr><td>gait</td><td>step</td></tr>", page)


if __name__ == "__main__":
    unittest.main()
