# SPDX-License-Identifier: BSD-3-Clause
import os
import unittest

from prf_experiments.run import arguments as args

VALID = {
    "motion": args.Argument("light", **args.choice("none", "light"), meaning="m"),
    "framework": args.Argument(True, **args.boolean(), meaning="f"),
    "seed": args.Argument(1, **args.integer(0, 9), meaning="s"),
    "limit": args.Argument(60.0, **args.number(1.0, 90.0), meaning="l"),
    "results": args.Argument("/here", **args.path(), meaning="r"),
}


class Arguments(unittest.TestCase):
    def test_defaults_hold_where_nothing_is_said(self):
        self.assertEqual(args.parse([], VALID), {"motion": "light", "framework": True, "seed": 1,
                                                 "limit": 60.0, "results": "/here"})

    def test_values_are_parsed(self):
        values = args.parse(["motion:=none", "framework:=False", "seed:=7", "limit:=2.5",
                             "results:=there"], VALID)
        self.assertEqual(values, {"motion": "none", "framework": False, "seed": 7, "limit": 2.5,
                                  "results": os.path.abspath("there")})

    def test_on_and_off_are_true_and_false(self):
        for word, value in (("on", True), ("off", False), ("OFF", False), ("true", True)):
            self.assertIs(args.parse([f"framework:={word}"], VALID)["framework"], value)

    def test_refuses_what_is_not_valid_and_names_it(self):
        for word, words in (("motion:=wild", "none|"), ("framework:=maybe", "true|false"),
                            ("seed:=-1", "0..9"), ("seed:=1.5", "seed"), ("limit:=nan", "limit"),
                            ("limit:=91", "1..90"), ("results:=", "results"),
                            ("speed:=1", "unknown argument 'speed'"),
                            ("motion=none", "name:=value"), ("motion", "name:=value"),
                            ("", "name:=value")):
            with self.assertRaises(args.ArgumentError) as caught:
                args.parse([word], VALID)
            self.assertIn(words, str(caught.exception), word)

    def test_the_last_word_counts(self):
        self.assertEqual(args.parse(["seed:=2", "seed:=3"], VALID)["seed"], 3)

    def test_usage_lists_every_argument_with_its_default(self):
        text = args.usage(VALID)
        for name in VALID:
            self.assertIn(name + ":=", text)
        self.assertIn("[true]", text)


if __name__ == "__main__":
    unittest.main()
