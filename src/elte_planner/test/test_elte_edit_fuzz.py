# SPDX-License-Identifier: BSD-3-Clause
"""The JSON form on damaged problems: solutions in strict JSON or one line of refusal.

ELTE_PLANNER_FUZZ_INPUTS says how many (default 20000).
"""
import json
import os
import random
import unittest

from elte_planner import problem_json

PROBLEM = json.dumps({
    "name": "p", "zeta": [[0, 0], [1, 0.5], [2, 0], [3, 1]], "wE": 0.001, "wR": 0.001,
    "laplacian": "authors", "n_fixed": 1, "y_fixed": [[0, 0]], "max_step": 9,
    "constraints": [{"j": 3, "p": [3, 1], "r": 0.1}, {"j": 2, "p": [2, 0], "half_widths": [1, 1]},
                    {"j": 1, "p": [1, 2], "normal": [0, 1]}]})
AROUND = PROBLEM[:-1] + ', "obstacles": [{"centre": [1.5, -0.5], "radius": 0.1}, ' \
    '{"centre": [1, 3], "half_widths": [0.1, 0.1]}], "clearance": 0.05}'
PIECES = ["null", "true", "NaN", "-Infinity", "1e999", "[", "]", "{", "}", ",", '"', ":", "-1",
          "1e-300", "9" * 30, "[[]]", '{"problems": ', "\\u0000", "\x00", "\ud800"]


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
    def test_is_solved_or_refused_in_one_line(self):
        inputs = int(os.environ.get("ELTE_PLANNER_FUZZ_INPUTS", "20000"))
        source = random.Random(1)
        solved = 0
        for i in range(inputs):
            text = damaged(PROBLEM if i % 2 else AROUND, source)
            try:
                solutions = problem_json.solve_text(text)
            except (ValueError, TypeError, RecursionError) as refusal:
                self.assertTrue(str(refusal), text)
            except BaseException:
                print(f"on input {i}: {text}")
                raise
            else:
                json.loads(solutions, parse_constant=self.fail)
                solved += 1
        self.assertGreater(solved, inputs // 50)
        self.assertLess(solved, inputs // 2)


if __name__ == "__main__":
    unittest.main()
