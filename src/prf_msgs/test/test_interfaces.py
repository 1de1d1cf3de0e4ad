# SPDX-License-Identifier: BSD-3-Clause
"""The table of topics, what follows from it, and that nothing made from it is out of date."""
import os
import re
import subprocess
import tempfile
import unittest

import genpy.message

from prf_msgs import enums, interfaces
from prf_msgs.msg import ControlStatus, ExecuteSkillResult, ExecutionProgress, SkillTrajectory, TargetForecast

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")
TRUTH = ["ground_truth/platform", "ground_truth/base", "ground_truth/tag", "ground_truth/camera",
         "ground_truth/end_effector", "ground_truth/contacts"]
SENSORS = ["joint_states", "camera/image_raw", "camera/camera_info"]
OUTPUTS = ["tag_detections", "target/forecast", "skill/trajectory", "execution/progress",
           "execution/setpoint", "joint_command", "control/status"]


class Table(unittest.TestCase):
    table = interfaces.load()

    def test_a_bag_holds_these_topics_in_this_order(self):
        self.assertEqual(self.table.recorded, ["clock", *SENSORS, "obstacles", "speed_scale",
                                               *TRUTH, *OUTPUTS, "tf",
                                               "tf_static", "diagnostics", "rosout",
                                               "trial/description", "fault/events"])

    def test_kinds_are_listed_in_the_order_of_the_table(self):
        self.assertEqual(self.table.of_kind("sensor"), SENSORS)
        self.assertEqual(self.table.of_kind("ground_truth"), TRUTH)
        self.assertEqual(self.table.of_kind("output"), OUTPUTS)
        self.assertEqual(self.table.of_kind("teaching"), [])
        self.assertEqual(self.table.of_kind("teaching", recorded=False), ["guide/wrench"])

    def test_the_data_flow_is_that_of_the_framework(self):
        self.assertEqual(self.table.framework_flow, {
            "/tf": ("robot_state_publisher", ["target_predictor"]),
            "/tag_detections": ("tag_detector", ["target_predictor"]),
            "/target/forecast": ("target_predictor", ["decision", "skill_planner"]),
            "/execution/progress": ("decision", ["skill_planner"]),
            "/skill/trajectory": ("skill_planner", ["decision"]),
            "/execution/setpoint": ("decision", ["arm_controller"]),
            "/joint_command": ("arm_controller", []),
            "/control/status": ("arm_controller", ["decision"])})
        self.assertEqual(self.table.sensor_readers, {
            "/joint_states": ["robot_state_publisher", "decision", "arm_controller"],
            "/camera/image_raw": ["tag_detector"],
            "/camera/camera_info": ["tag_detector"]})
        self.assertEqual(set(self.table.simulator_inputs),
                         {"/joint_command", "/execution/progress"})
        self.assertEqual(self.table.framework_nodes,
                         ["robot_state_publisher", "tag_detector", "target_predictor", "decision",
                          "skill_planner", "arm_controller"])

    def test_every_type_exists(self):
        for topic in self.table.topics:
            if topic.type != "visualization_msgs/MarkerArray":  # rviz brings it, no node needs it
                self.assertIsNotNone(genpy.message.get_message_class(topic.type), topic.type)

    def test_every_sender_and_reader_is_a_node_of_the_table(self):
        nodes = {node.name for node in self.table.nodes}
        others = {"every node", "session_observer", "teach_guide", "scene_markers",
                  "fault_injector", "driver_adapter"}
        for topic in self.table.topics:
            self.assertLessEqual(set(topic.senders), nodes | others, topic.name)
            self.assertLessEqual(set(topic.readers), nodes, topic.name)

    def test_no_node_of_the_framework_reads_ground_truth(self):
        for topic in self.table.topics:
            if topic.kind == "ground_truth":
                self.assertEqual(topic.readers, (), topic.name)
                self.assertEqual(topic.simulator, "", topic.name)


class BrokenTable(unittest.TestCase):
    ROW = {"name": "a", "type": "std_msgs/String", "kind": "sensor", "senders": ["world"],
           "readers": [], "unit": "m", "frame": "world", "meaning": "one", "recorded": True,
           "latched": False}

    def assert_refused(self, words, *rows):
        with self.assertRaisesRegex(interfaces.InterfaceError, words):
            interfaces.Interfaces({"topics": rows, "nodes": [], "actions": [], "services": []})

    def test_is_refused_by_row_and_column(self):
        self.assert_refused("kind = tensor", {**self.ROW, "kind": "tensor"})
        self.assert_refused("simulator = no", {**self.ROW, "simulator": "no"})
        self.assert_refused("a: must have a sender", {**self.ROW, "senders": []})
        self.assert_refused("type = String", {**self.ROW, "type": "String"})
        self.assert_refused("must have a meaning", {**self.ROW, "meaning": ""})
        self.assert_refused("colour", {**self.ROW, "colour": "red"})
        self.assert_refused("latched", {key: self.ROW[key] for key in self.ROW if key != "latched"})
        self.assert_refused("has twice: a", self.ROW, {**self.ROW, "name": "/a"})


class WhatIsMadeFromTheTable(unittest.TestCase):
    def test_tables_in_the_readme_files_are_up_to_date(self):
        result = subprocess.run([os.path.join(ROOT, "scripts", "make_interface_table"), "--check"],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_headers_hold_every_name_once(self):
        header = os.path.join(ROOT, "src", "prf_msgs", "scripts", "make_topics_header")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([header, os.path.join(ROOT, "src", "prf_msgs", "interfaces.yaml"),
                            folder], check=True)
            text = "".join(open(os.path.join(folder, name), encoding="utf-8").read()
                           for name in ("topics.h", "ground_truth_topics.h"))
            framework = open(os.path.join(folder, "topics.h"), encoding="utf-8").read()
        constants = re.findall(r'char (k\w+)\[\] = "(.*)"', text)
        self.assertCountEqual([name for _, name in constants],
                              [topic.name for topic in interfaces.load().topics])
        self.assertEqual(len(dict(constants)), len(constants))
        self.assertIn('kTargetForecast[] = "target/forecast"', framework)
        self.assertNotIn("ground_truth", framework)

    def test_example_of_the_readme_runs(self):
        path = os.path.join(ROOT, "src", "prf_msgs", "README.md")
        [example] = re.findall(r"```python\n(.*?)```", open(path, encoding="utf-8").read(), re.DOTALL)
        for line in example.splitlines():
            code, _, comment = line.partition("# ")
            if comment:
                self.assertEqual(repr(eval(code, self.scope)), comment)
            else:
                exec(code, self.scope)

    scope: dict = {}


class Enums(unittest.TestCase):
    def test_names_follow_the_values(self):
        self.assertEqual(enums.names(ExecutionProgress),
                         ["WAITING", "FORWARD", "PAUSE", "REVERSE", "TRACKING", "RETRACT", "DONE",
                          "STOPPED", "SEARCH"])
        self.assertEqual(enums.names(TargetForecast),
                         ["NO_TARGET", "TRACKING", "COASTING", "LOST"])
        for message in (ControlStatus, SkillTrajectory, ExecuteSkillResult):
            for value, name in enumerate(enums.names(message)):
                self.assertEqual(getattr(message, name), value)

    def test_a_gap_in_the_values_is_refused(self):
        with self.assertRaisesRegex(ValueError, "must be 0, 1, 2"):
            enums.names(type("Message", (), {"ONE": 0, "THREE": 2}))


if __name__ == "__main__":
    unittest.main()
