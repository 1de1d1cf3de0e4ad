# SPDX-License-Identifier: BSD-3-Clause
import os
import tempfile
import unittest

import numpy as np
from prf_experiments.teach import demonstration
from scipy.spatial.transform import Rotation

from prf_experiments import geometry, robots

HEADER = """# frame: base
# child_frame: hand
# target_pose: 0.8 0 0.6 0 0 0 1
time,x,y,z,qx,qy,qz,qw
"""
ROWS = [f"{0.1 * row:.1f},{0.01 * row},0,0,0,0,0,1" for row in range(12)]


class Demonstration(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "skill.csv")

    def read(self, text):
        with open(self.path, "w", encoding="utf-8") as stream:
            stream.write(text)
        return demonstration.read(self.path)

    def assert_refused(self, words, text):
        with self.assertRaises(demonstration.DemonstrationError) as caught:
            self.read(text)
        self.assertIn(words, str(caught.exception))
        self.assertIn(self.path, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def with_row(self, row, text):
        return HEADER + "\n".join(ROWS[:row] + [text] + ROWS[row + 1:])

    def test_reads_what_the_format_says(self):
        read = self.read(HEADER + "\n".join(ROWS))
        self.assertEqual((read.frame, read.child_frame), ("base", "hand"))
        np.testing.assert_allclose(read.times[-1], 1.1)
        np.testing.assert_allclose(read.goal_in_target[:3], [0.11 - 0.8, 0.0, -0.6])

    def test_survives_writing_and_reading(self):
        turned = Rotation.from_euler("y", 0.1 * np.arange(20))
        poses = geometry.make(0.5 + 0.01 * np.random.default_rng(1).normal(size=(20, 3)), turned)
        made = demonstration.make(0.05 * np.arange(20), poses, geometry.IDENTITY, "a: test", robots.load())
        demonstration.write(self.path, made)
        read = demonstration.read(self.path)
        np.testing.assert_allclose(read.poses, poses, atol=1e-9)
        np.testing.assert_allclose(read.times, made.times, atol=1e-9)
        self.assertEqual(read.notes, made.notes)

    def test_refuses_what_cannot_be_read(self):
        with self.assertRaises(demonstration.DemonstrationError):
            demonstration.read(self.path + ".absent")
        with self.assertRaises(demonstration.DemonstrationError):
            demonstration.read(os.path.dirname(self.path))

    def test_refuses_bytes_that_are_no_text(self):
        with open(self.path, "wb") as stream:
            stream.write(b"\xff\xfe\x00\x80")
        with self.assertRaises(demonstration.DemonstrationError):
            demonstration.read(self.path)

    def test_refuses_an_empty_file(self):
        self.assert_refused("no header line", "")

    def test_refuses_a_missing_header_line(self):
        for key in ("frame", "child_frame", "target_pose"):
            lines = [line for line in HEADER.splitlines() if not line.startswith(f"# {key}:")]
            self.assert_refused(f"# {key}:", "\n".join(lines + ROWS))

    def test_refuses_too_few_rows(self):
        self.assert_refused("at least 3", HEADER + "\n".join(ROWS[:2]))
        poses = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (9, 1))
        poses[:, 0] = 0.1 * np.arange(9)
        with self.assertRaisesRegex(demonstration.DemonstrationError, "9 rows, must be at least 10"):
            demonstration.make(0.1 * np.arange(9), poses, geometry.IDENTITY, "test", robots.load())

    def test_refuses_values_that_are_not_finite(self):
        self.assert_refused(":10: column 'x' is 'nan'", self.with_row(5, "0.5,nan,0,0,0,0,0,1"))
        self.assert_refused(":10: column 'y' is 'inf'", self.with_row(5, "0.5,0,inf,0,0,0,0,1"))
        self.assert_refused(":3: column 'x' is 'nan'", HEADER.replace("0.8", "nan") + "\n".join(ROWS))

    def test_refuses_time_that_does_not_rise(self):
        self.assert_refused(":10: column 'time' is 0.400000, must be above", self.with_row(5, "0.4,0,0,0,0,0,0,1"))
        self.assert_refused("start at 0", self.with_row(0, "0.01,0,0,0,0,0,0,1"))

    def test_refuses_a_quaternion_that_is_not_unit(self):
        self.assert_refused(":10: columns 'qx' to 'qw'", self.with_row(5, "0.5,0,0,0,0,0,0,0"))
        self.assert_refused(":3: columns 'qx' to 'qw'", HEADER.replace("0 0 0 1", "0 0 0 2") + "\n".join(ROWS))

    def test_refuses_words_and_missing_columns(self):
        self.assert_refused(":10: column 'x' is 'a'", self.with_row(5, "0.5,a,0,0,0,0,0,1"))
        self.assert_refused(self.path, self.with_row(5, "0.5,0,0"))
        self.assert_refused(":4: header is 't,x", HEADER.replace("time,", "t,") + "\n".join(ROWS))


class PackagedDemonstration(unittest.TestCase):
    def test_ends_at_the_stand_off_before_the_tag(self):
        path = os.path.join(os.path.dirname(__file__), "..", "..", "..", "demonstrations",
                            "inspect_box.csv")
        skill = demonstration.read(path)
        camera_in_hand = [0.0, 0.07, -0.12, 0.0, 0.0, 1.0, 0.0]
        camera = geometry.compose(skill.goal_in_target, camera_in_hand)
        np.testing.assert_allclose(camera[:3], [0.0, 0.0, 0.30], atol=0.010)
        straight = geometry.rotation(camera) * Rotation.from_quat([1.0, 0.0, 0.0, 0.0]).inv()
        self.assertLess(straight.magnitude(), np.radians(2.0))


if __name__ == "__main__":
    unittest.main()
