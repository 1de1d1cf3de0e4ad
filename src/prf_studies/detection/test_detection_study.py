# SPDX-License-Identifier: BSD-3-Clause
"""detection_study, from rendering to figures."""
import json
import os
import subprocess
import tempfile
import unittest


def run(*words):
    return subprocess.run(["rosrun", "prf_studies", "detection_study", *words], check=False,
                          capture_output=True, text=True, timeout=100)


class DetectionStudy(unittest.TestCase):
    def test_finds_the_tag_and_says_how_well(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "study.json")
            done = run("--views", "4", "--json", path)
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(path, encoding="utf-8") as stream:
                result = json.load(stream)
        self.assertIn("| distance_m | detected_fraction |", done.stdout)
        near = result["distance"][1]
        self.assertEqual((near["distance_m"], near["detected_fraction"]), (0.3, 1.0))
        self.assertLess(near["lateral_rms_mm"], 0.2)
        self.assertLess(near["depth_rms_mm"], 0.5)
        self.assertLess(near["rotation_median_deg"], 0.5)
        self.assertLess(near["nees_mean"], 12.0)
        self.assertGreater(result["distance"][-1]["depth_rms_mm"], near["depth_rms_mm"])

    def test_refuses_bad_arguments_by_name(self):
        for words, name in ((["--views", "1"], "--views"), (["--noise", "-1"], "--noise"),
                            (["--lens", "-5", "0", "0", "0", "0"], "distortion[0]")):
            done = run(*words)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(name, done.stderr)


if __name__ == "__main__":
    unittest.main()
