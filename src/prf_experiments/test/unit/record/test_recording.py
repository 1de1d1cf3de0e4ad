# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import tempfile
import unittest

import genpy.dynamic
import numpy as np
import rosbag

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import judge
from prf_experiments.record import frames, recording

from prf_msgs.msg import ExecutionProgress


class Recording(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.bag = os.path.join(self._folder.name, "trial.bag")

    def assert_refused(self, words):
        with self.assertRaises(recording.RecordingError) as caught:
            recording.read(self.bag)
        self.assertIn(words, str(caught.exception))

    def test_bag_gives_the_arrays_that_were_written(self):
        made = synthetic.make_recording(3.0, lateral=np.linspace(0.1, 0.0, 301))
        made.contacts = [recording.Contact(int(made.ticks[50]), ("box_back", "camera_link"), 2.5)]
        made.detections[4] = np.nan
        made.control.codes[7], made.control.reasons[7] = 2, "joint_2 asked too much"
        made.warnings = [recording.LoggedWarning(int(made.ticks[9]), "decision", "no plan")]
        made.diagnostics = {"skill_planner": {"late solves": ["0", "2"]}}
        synthetic.write_bag(self.bag, made)
        read = recording.read(self.bag)
        np.testing.assert_array_equal(read.ticks, made.ticks)
        np.testing.assert_allclose(read.camera.values, made.camera.values)
        np.testing.assert_allclose(read.detections, made.detections)
        np.testing.assert_allclose(read.arm_base_in_body, synthetic.ARM_BASE_IN_BODY)
        self.assertEqual(read.contacts, made.contacts)
        self.assertEqual((read.control.codes[7], read.control.reasons[7]),
                         (2, "joint_2 asked too much"))
        self.assertEqual(read.warnings, made.warnings)
        self.assertEqual(read.diagnostics, made.diagnostics)
        self.assertEqual(read.description, {"command": "made up"})
        self.assertEqual(judge.judge(read), judge.judge(made))

    def test_names_a_topic_without_messages(self):
        synthetic.write_bag(self.bag, synthetic.make_recording(1.0), {"ground_truth/contacts"})
        self.assert_refused("ground_truth/contacts")

    def test_refuses_a_bag_that_does_not_place_the_arm(self):
        synthetic.write_bag(self.bag, synthetic.make_recording(1.0), {"tf_static"})
        self.assert_refused("tf_static does not place j2s7s300_link_base")

    def test_refuses_a_bag_without_messages(self):
        rosbag.Bag(self.bag, "w").close()
        self.assert_refused("no message of")

    def test_refuses_an_empty_file(self):
        open(self.bag, "w").close()
        self.assert_refused(self.bag)

    def test_refuses_a_file_that_is_no_bag(self):
        with open(self.bag, "wb") as stream:
            stream.write(bytes(range(256)) * 64)
        self.assert_refused(self.bag)

    def test_refuses_a_bag_cut_anywhere(self):
        synthetic.write_bag(self.bag, synthetic.make_recording(1.0))
        size = os.path.getsize(self.bag)
        for part in (0.9, 0.5, 0.1):
            os.truncate(self.bag, int(size * part))
            self.assert_refused(self.bag)

    def test_refuses_a_missing_bag(self):
        self.assert_refused("no such bag")

    def test_refuses_a_bag_with_damaged_data(self):
        synthetic.write_bag(self.bag, synthetic.make_recording(1.0))
        with open(self.bag, "r+b") as stream:
            stream.seek(6000)
            stream.write(b"\xff" * 3000)
        self.assert_refused(self.bag)

    # Fault 54: a bag of the version before two fields were added -> read without them
    def test_reads_a_bag_of_an_earlier_version(self):
        synthetic.write_bag(self.bag, synthetic.make_recording(1.0))
        kind = "prf_msgs/ExecutionProgress"
        older = genpy.dynamic.generate_dynamic(kind, "\n".join(
            line for line in ExecutionProgress._full_text.split("\n")
            if not line.startswith(("float64 following_error", "float64 following_rotation"))))[kind]
        with rosbag.Bag(self.bag) as whole:
            messages = list(whole.read_messages())
        with rosbag.Bag(self.bag, "w") as bag:
            for topic, message, stamp in messages:
                if topic == "/execution/progress":
                    message = older(**{name: getattr(message, name) for name in older.__slots__})
                bag.write(topic, message, stamp)
        read = recording.read(self.bag)
        self.assertTrue(np.all(np.isnan(read.progress.following)))
        self.assertGreater(len(read.progress.stamps), 50)

    def test_tf_answers_between_stamps_and_is_nan_outside(self):
        synthetic.write_bag(self.bag, synthetic.make_recording(1.0))
        buffer = frames.load(self.bag)
        asked = [synthetic.START + 5_000_000, synthetic.START - 10**8]
        poses = frames.lookup(buffer, "j2s7s300_link_base", "camera_optical_frame", asked)
        np.testing.assert_allclose(poses[0, :3], [0.496, 0.0, 0.655], atol=1e-9)
        self.assertTrue(np.all(np.isnan(poses[1])))


if __name__ == "__main__":
    unittest.main()
