# SPDX-License-Identifier: BSD-3-Clause
"""Commands that draw trials."""
import os
import subprocess
import tempfile
import unittest


def run(*words):
    return subprocess.run(["rosrun", *words], check=False, capture_output=True, text=True,
                          timeout=100)


class Pictures(unittest.TestCase):
    def test_refuse_what_is_no_trial(self):
        with tempfile.TemporaryDirectory() as folder:
            for words, why in ((["absent.bag", folder + "/a.webp"], "absent.bag"),
                               (["absent.bag", folder + "/a.avi"], "must end with"),
                               (["absent.bag", folder + "/a.gif", "--rate", "99"], "--rate")):
                done = run("scene_drawing", "scene_animation", *words)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(why, done.stderr)
                self.assertEqual(os.listdir(folder), [])


if __name__ == "__main__":
    unittest.main()
