# SPDX-License-Identifier: BSD-3-Clause
import contextlib
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import genpy
import numpy as np
import rosbag
import rospy
import std_msgs.msg
import visualization_msgs.msg

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.export import command

HERE = os.path.dirname(os.path.abspath(__file__))
PACKAGE = os.path.join(HERE, "..", "..", "..")

VENV = os.path.join(PACKAGE, "..", "..", ".venv", "bin", "python3")
URDF = '<robot name="made_up"><link name="base_link"/></robot>'
LEVELS = {1: 10, 2: 20, 4: 30, 8: 40, 16: 50}


def export(*words):
    """(exit code, what the command says on stderr)."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = command.export_main(list(words))
    return code, err.getvalue()


def decoded(path):
    """[(topic, schema, receipt time ns, message as dict)] as read by a Python without ROS."""
    out = subprocess.run([VENV, "-I", os.path.join(HERE, "decode.py"), path], check=True,
                         capture_output=True, text=True).stdout
    return [tuple(json.loads(line)) for line in out.splitlines()]


def plain(value):
    """A ROS 1 message as ROS 2 has it, as dict."""
    if isinstance(value, bytes):
        return list(value)
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, (genpy.Time, genpy.Duration)):
        return {"sec": value.secs, "nanosec": value.nsecs}
    if not isinstance(value, genpy.Message):
        return value
    fields = {name: plain(getattr(value, name)) for name in value.__slots__}
    if value._type == "std_msgs/Header":
        del fields["seq"]
    if value._type == "sensor_msgs/CameraInfo":
        fields = {name.lower() if name in "DKRP" else name: item for name, item in fields.items()}
    if value._type == "rosgraph_msgs/Log":
        fields["stamp"] = fields.pop("header")["stamp"]
        fields["level"] = LEVELS[fields["level"]]
        del fields["topics"]
    return fields


class Export(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bag, self.out, self.urdf = (os.path.join(folder.name, name)
                                         for name in ("trial.bag", "trial.mcap", "robot.urdf"))
        with open(self.urdf, "w", encoding="utf-8") as stream:
            stream.write(URDF)

    def exported(self):
        self.assertEqual(export(self.bag, self.out, "--robot", self.urdf), (0, ""))
        return decoded(self.out)

    def assert_refused(self, words, *arguments, code=1):
        ended, told = export(*(arguments or (self.bag, self.out)))
        self.assertEqual((ended, len(told.splitlines())), (code, 1), told)
        self.assertIn(words, told)
        self.assertFalse(os.path.exists(self.out))
        self.assertEqual([name for name in os.listdir(os.path.dirname(self.out)) if "part" in name], [])

    def write_trial(self):
        made = synthetic.make_recording(0.5)
        made.contacts = [synthetic.recording.Contact(int(made.ticks[5]), ("box_back", "hand"), 2.5)]
        made.detections[2] = np.nan
        made.warnings = [synthetic.recording.LoggedWarning(int(made.ticks[9]), "decision", "no plan")]
        made.diagnostics = {"skill_planner": {"late solves": ["0", "2"]}}
        synthetic.write_bag(self.bag, made)

    def test_every_message_of_a_trial_is_read_without_ros_and_is_equal(self):
        self.write_trial()
        theirs: dict[str, list] = {}
        for topic, _, time, message in self.exported():
            theirs.setdefault(topic, []).append([time, message])
        ours: dict[str, list] = {}
        with rosbag.Bag(self.bag) as bag:
            for topic, message, time in bag.read_messages():
                ours.setdefault(topic, []).append([time.to_nsec(), plain(message)])
        self.assertEqual(len(ours), 22)
        for topic, messages in ours.items():
            with self.subTest(topic):
                self.assertEqual(json.loads(json.dumps(messages)), theirs[topic])

    def test_standard_messages_stand_beside_ours(self):
        self.write_trial()
        last = {topic: (schema, message) for topic, schema, _, message in self.exported()}
        self.assertEqual(last["/robot_description"], ("std_msgs/msg/String", {"data": URDF}))
        forecast, (schema, path) = last["/target/forecast"][1], last["/target/forecast/path"]
        self.assertEqual(schema, "nav_msgs/msg/Path")
        self.assertEqual([item["pose"] for item in path["poses"]],
                         [item["pose"] for item in forecast["predictions"]])
        stamp = forecast["header"]["stamp"]
        self.assertEqual([item["header"]["stamp"]["nanosec"] - stamp["nanosec"]
                          for item in path["poses"]], [0, 500_000_000])
        self.assertEqual(len(last["/target/forecast/ellipsoids"][1]["markers"]), 3)  # one deletes
        self.assertEqual(len(last["/skill/trajectory/path"][1]["poses"]), 10)
        self.assertEqual(last["/execution/progress/posterior/pause"][1], {"data": 0.15})
        self.assertEqual(last["/execution/progress/text"][1], {"data": "DONE"})
        true_base, = last["/ground_truth/base/tf"][1]["transforms"]
        self.assertEqual(true_base["transform"]["translation"], dict(zip("xyz", synthetic.BASE[:3])))

    def test_layouts_name_what_an_exported_trial_has(self):
        self.write_trial()
        with rosbag.Bag(self.bag, "a") as bag:
            post = visualization_msgs.msg.Marker(type=visualization_msgs.msg.Marker.CUBE)
            post.header.frame_id = "tag_0"
            bag.write("/obstacles", visualization_msgs.msg.MarkerArray([post]), rospy.Time(1))
        found = {topic: message for topic, _, _, message in self.exported()}
        curves = [(curve.get("topic"), curve.get("field")) for curve in ElementTree.parse(
            os.path.join(PACKAGE, "viewers", "plotjuggler.xml")).iter("curve")]
        with open(os.path.join(PACKAGE, "viewers", "foxglove.json"), encoding="utf-8") as stream:
            text = stream.read()
        curves += [tuple(path.rsplit(".", 1)) for path in re.findall(r'"value": "([^"]+)"', text)]
        self.assertGreater(len(curves), 20)
        for topic, field in curves:
            self.assertIn(field, found[topic])
        named = re.findall(r'"(?:topic|imageTopic|calibrationTopic|topicToRender)": "([^"]+)"', text)
        named += re.findall(r'"(/[a-z_/]+)": \{', text)
        self.assertLessEqual(set(named), set(found))

    def test_the_same_bag_gives_the_same_file(self):
        self.write_trial()
        contents = []
        for _ in range(2):
            export(self.bag, self.out)
            with open(self.out, "rb") as stream:
                contents.append(stream.read())
        self.assertEqual(*contents)

    def test_publishers_need_not_be_named(self):
        with rosbag.Bag(self.bag, "w") as bag:
            bag.write("/words", std_msgs.msg.String("a"), genpy.Time(3))
        self.assertEqual(self.exported()[-1],
                         ("/words", "std_msgs/msg/String", 3_000_000_000, {"data": "a"}))

    def test_messages_of_another_version_stand_alone(self):
        kind = type("Status", (std_msgs.msg.Header,), {
            "_type": "prf_msgs/ControlStatus", "_md5sum": "0" * 32,
            "_full_text": "uint32 seq\ntime stamp\nstring frame_id\n"})
        with rosbag.Bag(self.bag, "w") as bag:
            bag.write("/control/status", kind(1, genpy.Time(2), "old"), genpy.Time(3))
        (topic, _, _, message), = self.exported()[1:]
        self.assertEqual((topic, message["frame_id"]), ("/control/status", "old"))

    # Fault 54: a bag to export that is not there, no bag, unindexed or empty -> one line, no file
    def test_refuses_what_is_no_closed_bag_in_one_line(self):
        self.assert_refused("there is no such bag")
        self.assert_refused("is no file", os.path.dirname(self.bag), self.out)
        open(self.bag, "w").close()
        self.assert_refused("empty file")
        with open(self.bag, "wb") as stream:
            stream.write(bytes(range(256)) * 64)
        self.assert_refused("not appear to be a bag file")
        rosbag.Bag(self.bag, "w").close()
        self.assert_refused("no message")
        self.write_trial()
        self.assert_refused("/nowhere/a.mcap: No such file", self.bag, "/nowhere/a.mcap")
        os.truncate(self.bag, os.path.getsize(self.bag) // 2)
        self.assert_refused("trial.bag: ")
        self.assert_refused("must end with .mcap", self.bag, self.bag, code=2)


if __name__ == "__main__":
    unittest.main()
