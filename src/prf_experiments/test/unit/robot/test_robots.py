# SPDX-License-Identifier: BSD-3-Clause
"""Robots as folders, and what a trial makes of them."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import judge
from prf_experiments.run import arguments, trial_arguments

from prf_experiments import robots

YAML = """base: deck
base_link: arm_base
tip_link: tool
camera_frame: camera
joints: [one, two]
"""
URDF = """<robot name="r"><link name="foot"/><link name="arm_base"/><link name="upper"/><link name="tool"/>
<joint name="mount" type="fixed"><parent link="foot"/><child link="arm_base"/></joint>
<joint name="one" type="revolute"><parent link="arm_base"/><child link="upper"/></joint>
<joint name="two" type="revolute"><parent link="upper"/><child link="tool"/></joint></robot>"""


class Robots(unittest.TestCase):
    def folder(self, text=YAML):
        found = tempfile.TemporaryDirectory()
        self.addCleanup(found.cleanup)
        for name, content in (("robot.yaml", text), ("robot.urdf", URDF)):
            with open(os.path.join(found.name, name), "w", encoding="utf-8") as stream:
                stream.write(content)
        return found.name

    def test_those_of_the_package_are_there(self):
        self.assertLessEqual({"jaco_v60", "ur5e_deck", "panda_deck", "gen3_v60"}, set(robots.names()))
        for name in robots.names():
            self.assertEqual(robots.load(name).on_legs, name.endswith("v60"), name)

    def test_the_arm_moves_its_links_and_not_its_base(self):
        robot = robots.load(self.folder())
        self.assertEqual(robot.root_link, "foot")
        self.assertEqual([robot.moves(link) for link in ("foot", "arm_base", "upper", "tool", "box")],
                         [False, False, True, True, False])

    # Fault 45: a robot that is not there, or whose robot.yaml cannot be used -> refused with file, key and bound
    def test_what_cannot_be_used_is_refused(self):
        cases = [("my_arm", "must be gen3_v60, jaco_v60"), ("/no/such/folder", "/no/such/folder/robot.yaml"),
                 (self.folder(YAML.replace("deck", "sea")), "base = sea, must be legs or deck"),
                 (self.folder(YAML.replace("tip_link: tool\n", "")), "'tip_link' is missing"),
                 (self.folder("[1, 2"), "robot.yaml"), (self.folder(YAML.replace("[one, two]", "7")), "names")]
        for name, words in cases:
            with self.assertRaises(robots.RobotError) as refused:
                robots.load(name)
            self.assertIn(words, str(refused.exception))
            self.assertNotIn("\n", str(refused.exception))


class Verdict(unittest.TestCase):
    def test_a_robot_bolted_to_the_deck_does_not_fall(self):
        data = synthetic.make_recording()
        data.base.values[:, 2] = 0.0
        self.assertEqual(judge.judge(data).verdict, "F")
        data.robot = robots.load("ur5e_deck")
        self.assertEqual(judge.judge(data).verdict, "S")


class Arguments(unittest.TestCase):
    def complete(self, *words):
        return trial_arguments.complete(arguments.parse(list(words), trial_arguments.TRIAL), words)

    def test_the_box_of_a_robot_without_legs_stands_ashore(self):
        self.assertEqual(self.complete()["scenario"], "treadmill")
        self.assertEqual(self.complete("robot:=ur5e_deck")["scenario"], "quay")
        self.assertEqual(self.complete("robot:=ur5e_deck", "scenario:=treadmill")["scenario"], "treadmill")

    def test_what_a_robot_cannot_do_is_refused(self):
        for words, said in ((["robot:=ur5e_deck", "gait:=step"], "no legs"), (["robot:=my_arm"], "must be gen3_v60"),
                            (["robot:=gen3_v60", "driver:=kinova"], "valid: robot:=jaco_v60")):
            with self.assertRaises(arguments.ArgumentError) as refused:
                self.complete(*words)
            self.assertIn(said, str(refused.exception))
