# SPDX-License-Identifier: BSD-3-Clause
import contextlib
import io
import os
import random
import sys
import tempfile
import unittest

import genpy.dynamic
import rosbag
from geometry_msgs.msg import PoseStamped

sys.path.insert(0, os.path.dirname(__file__))
import synthetic
from prf_experiments.run import arguments as args
from prf_experiments.run import trial, trial_arguments

from prf_experiments import commands
from prf_msgs.msg import ExecutionProgress

COMMANDS = {"judge": commands.judge_main, "inspect": commands.inspect_main,
            "bag_digest": commands.digest_main, "report": commands.report_main}


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.whole = os.path.join(folder.name, "whole.bag")
        synthetic.write_bag(cls.whole, synthetic.make_recording(1.0))

    def run_on(self, name, bag):
        out, error = io.StringIO(), io.StringIO()
        page = [os.path.join(self.folder, "page.html")] if name == "report" else []
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
            code = COMMANDS[name]([bag, *page])
        return code, out.getvalue(), error.getvalue()

    def refused(self, bag, told=""):
        for name in COMMANDS:
            code, out, error = self.run_on(name, bag)
            self.assertEqual(code, 3 if name == "judge" else 1, name)
            text = out if name == "judge" else error
            self.assertIn(told, text, name)
            self.assertEqual(len(text.splitlines()), 1, text)
            self.assertFalse(os.path.exists(os.path.join(self.folder, "page.html")), name)

    def file(self, content):
        path = os.path.join(self.folder, "some.bag")
        with open(path, "wb") as stream:
            stream.write(content)
        return path

    # Fault 54: bags that are absent, empty, endless or no bags -> one line and a non-zero exit, no page
    def test_what_is_no_bag_is_refused_in_one_line(self):
        self.refused(os.path.join(self.folder, "absent.bag"), "absent.bag")
        self.refused("/dev/zero", "is no file")
        self.refused(self.folder, "is no file")
        self.refused(self.file(b""), "some.bag")
        self.refused(self.file(b"#ROSBAG V2.0\n" + bytes(5000)), "some.bag")
        empty = os.path.join(self.folder, "empty.bag")
        rosbag.Bag(empty, "w").close()
        self.refused(empty, "empty.bag: no message")

    # Fault 54: a bag that was not closed -> one line that says how to get back what it holds
    def test_a_bag_that_was_not_closed_says_what_helps(self):
        with open(self.whole, "rb") as stream:
            self.refused(self.file(stream.read()[:-3000]), "rosbag reindex")

    # Fault 54: a topic of another type or of another version's definition -> refused, topic named
    def test_topics_of_other_types_are_refused_by_name(self):
        lacking = genpy.dynamic.generate_dynamic("prf_msgs/ExecutionProgress", "\n".join(
            line for line in ExecutionProgress._full_text.split("\n") if "cursor" not in line.split("#")[0]))
        older = lacking["prf_msgs/ExecutionProgress"]
        for topic, message, told in (
                ("/tag_detections", PoseStamped(), "holds geometry_msgs/PoseStamped, must be prf_msgs/TagD"),
                ("/execution/progress", older(), "holds another version's prf_msgs/ExecutionProgress without cursor")):
            path = os.path.join(self.folder, "other.bag")
            with rosbag.Bag(path, "w") as out, rosbag.Bag(self.whole) as whole:
                for name, kept, stamp in whole.read_messages():
                    out.write(name, message if name == topic else kept, stamp)
            for name in ("judge", "inspect", "report"):
                code, text, error = self.run_on(name, path)
                self.assertIn(code, (1, 3), name)
                self.assertIn(f"other.bag: topic {topic} {told}" if name != "judge" else told, text + error)
                self.assertEqual(len((text + error).splitlines()), 1)

    # Fault 54: bags with flipped bytes and cut ends -> a verdict or one line, never a traceback
    def test_damaged_bags_never_end_in_a_traceback(self):
        with open(self.whole, "rb") as stream:
            content = stream.read()
        draw = random.Random(12)
        for _ in range(12):
            damaged = bytearray(content[:draw.randrange(100, len(content))]
                                if draw.random() < 0.3 else content)
            for _ in range(20):
                damaged[draw.randrange(len(damaged))] = draw.randrange(256)
            path = self.file(bytes(damaged))
            for name in ("judge", "bag_digest"):
                code, _, error = self.run_on(name, path)
                self.assertIn(code, (0, 1, 3, 4))
                self.assertLess(len(error.splitlines()), 2)

    # Fault 54: a time limit too short for the skill -> refused before anything starts
    def test_a_time_limit_too_short_for_the_skill_is_refused(self):
        values = args.parse(["time_limit:=5"], trial_arguments.TRIAL)
        with self.assertRaisesRegex(args.ArgumentError, "takes 11.4[0-9]* s"):
            trial.check_time(values)
        trial.check_time({**values, "time_limit": 12.0})

    # Fault 54: a file name with := or $( -> refused, since ROS would read it as something else
    def test_paths_that_ros_misreads_are_refused(self):
        for word in ("results:=/tmp/a:=b", "demonstration:=/tmp/$(x).csv", "motion:=a:=b.csv"):
            with self.assertRaisesRegex(args.ArgumentError, "without := and|none|FILE"):
                args.parse([word], trial_arguments.TRIAL)


if __name__ == "__main__":
    unittest.main()
