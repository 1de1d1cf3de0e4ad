# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import tempfile
import unittest

import rosbag
import rospy
import std_msgs.msg

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.record import digest

from prf_msgs import bags


class Digest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self._folder = folder.name

    def trial(self, name, **changes):
        path = os.path.join(self._folder, name)
        synthetic.write_bag(path, synthetic.make_recording(1.0), **changes)
        return digest.digests(path)

    def strings(self, name, rows):
        """Bag of (topic, publisher, text, receipt time s) rows."""
        path = os.path.join(self._folder, name)
        with rosbag.Bag(path, "w") as bag:
            for topic, publisher, text, time in rows:
                kind = std_msgs.msg.String
                bag._topic_connections.pop(topic, None)  # else one publisher a topic is kept
                bag.write(topic, kind(text), rospy.Time(time), connection_header={
                    "topic": topic, "type": kind._type, "md5sum": kind._md5sum,
                    "message_definition": kind._full_text, "callerid": publisher})
        return digest.digests(path)

    def test_is_the_same_for_the_same_messages(self):
        self.assertEqual(digest.differences(self.trial("a.bag"), self.trial("b.bag")), [])

    def test_names_the_topic_whose_messages_differ(self):
        lines = digest.differences(self.trial("a.bag"), self.trial("b.bag", seed=7))
        self.assertEqual(lines, ["/camera/image_raw [/platform_sim]: 34 messages that differ"])

    def test_names_a_missing_topic(self):
        lines = digest.differences(self.trial("a.bag"), self.trial("b.bag", skipped={"tf"}))
        self.assertEqual(lines, ["/tf [/robot_state_publisher]: only in the first bag"])

    def test_counts_messages(self):
        ours = self.strings("a.bag", [("/a", "/n", "x", 1), ("/a", "/n", "x", 2)])
        theirs = self.strings("b.bag", [("/a", "/n", "x", 1)])
        self.assertEqual(digest.differences(ours, theirs), ["/a [/n]: 2 and 1 messages"])

    def test_sees_the_order_of_messages(self):
        ours = self.strings("a.bag", [("/a", "/n", "x", 1), ("/a", "/n", "y", 2)])
        theirs = self.strings("b.bag", [("/a", "/n", "y", 1), ("/a", "/n", "x", 2)])
        self.assertEqual(len(digest.differences(ours, theirs)), 1)

    def test_ignores_receipt_times_and_the_order_between_publishers(self):
        ours = self.strings("a.bag", [("/a", "/m", "x", 1), ("/a", "/n", "y", 2)])
        theirs = self.strings("b.bag", [("/a", "/n", "y", 5), ("/a", "/m", "x", 6)])
        self.assertEqual(digest.differences(ours, theirs), [])

    def test_exempts_diagnostics_and_rosout(self):
        ours = self.strings("a.bag", [("/diagnostics", "/n", "x", 1), ("/a", "/n", "x", 1)])
        theirs = self.strings("b.bag", [("/rosout", "/n", "x", 1), ("/a", "/n", "x", 1)])
        self.assertEqual(digest.differences(ours, theirs), [])

    # Fault 54: bags with nothing to compare -> refused, not called identical
    def test_nothing_is_not_the_same_as_nothing(self):
        for rows in ([], [("/rosout", "/n", "x", 1)]):
            with self.assertRaisesRegex(bags.BagError, "a.bag: no message that could be compared"):
                self.strings("a.bag", rows)
        path = os.path.join(self._folder, "b.bag")
        self.strings("b.bag", [("/a", "/n", "x", 1)])
        with self.assertRaisesRegex(bags.BagError, "no message of /c"):
            digest.digests(path, ["/c"])

    # Fault 54: a bag without the publishers' names -> digests under no name
    def test_publishers_names_are_optional(self):
        path = os.path.join(self._folder, "a.bag")
        with rosbag.Bag(path, "w") as bag:
            bag.write("/a", std_msgs.msg.String("x"), rospy.Time(1))
        self.assertEqual(list(digest.digests(path)), [("/a", "")])


if __name__ == "__main__":
    unittest.main()
