# SPDX-License-Identifier: BSD-3-Clause
"""elte_edit on damaged problem files: an answer that is strict JSON or one line of refusal.

ELTE_PLANNER_FUZZ_INPUTS says how many (default 3000).
"""
import contextlib
import importlib.machinery
import importlib.util
import io
import json
import os
import random
import sys
import tempfile
import unittest
from unittest import mock

HERE = os.path.dirname(os.path.abspath(__file__))
PROBLEM = json.dumps({
    "name": "p", "zeta": [[0, 0], [1, 0.5], [2, 0], [3, 1]], "wE": 0.001, "wR": 0.001,
    "laplacian": "authors", "n_fixed": 1, "y_fixed": [[0, 0]], "max_step": 9,
    "constraints": [{"j": 3, "p": [3, 1], "r": 0.1}, {"j": 2, "p": [2, 0], "half_widths": [1, 1]}]})
PIECES = ["null", "true", "NaN", "-Infinity", "1e999", "[", "]", "{", "}", ",", '"', ":", "-1",
          "1e-300", "9" * 30, "[[]]", '{"problems": ', "\\u0000", "\x00", "\ud800"]


def load_command():
    path = os.path.join(HERE, "..", "scripts", "elte_edit")
    loader = importlib.machinery.SourceFileLoader("elte_edit", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("elte_edit", loader))
    loader.exec_module(module)
    return module


def damaged(text, source):
    for _ in range(source.randint(1, 3)):
        at = source.randrange(len(text) + 1)
        kind = source.randrange(4)
        if kind == 0:
            text = text[:at] + text[at + source.randint(1, 12):]
        elif kind == 1:
            text = text[:at] + source.choice(PIECES) + text[at:]
        elif kind == 2:
            text = text[:at] + source.choice("0123456789.-[]{},") + text[at + 1:]
        else:
            other = source.randrange(len(text) + 1)
            text = text[:at] + text[other:other + 40] + text[at:]
    return text


class DamagedProblem(unittest.TestCase):
    def test_is_answered_or_refused_in_one_line(self):
        command = load_command()
        inputs = int(os.environ.get("ELTE_PLANNER_FUZZ_INPUTS", "3000"))
        source = random.Random(1)
        answered = 0
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "problem.json")
            for _ in range(inputs):
                text = damaged(PROBLEM, source)
                with open(path, "w", encoding="utf-8", errors="surrogatepass") as file:
                    file.write(text)
                out, refusal = io.StringIO(), io.StringIO()
                with mock.patch.object(sys, "argv", ["elte_edit", "--problem", path]), \
                        contextlib.redirect_stdout(out), contextlib.redirect_stderr(refusal):
                    code = command.main()
                if code == 0:
                    json.loads(out.getvalue(), parse_constant=self.fail)
                    answered += 1
                else:
                    self.assertEqual(code, 2, text)
                    self.assertEqual(len(refusal.getvalue().splitlines()), 1, text)
        self.assertGreater(answered, inputs // 50)
        self.assertLess(answered, inputs // 2)


if __name__ == "__main__":
    unittest.main()
