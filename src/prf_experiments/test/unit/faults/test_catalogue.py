# SPDX-License-Identifier: BSD-3-Clause
import math
import os
import unittest
import xml.etree.ElementTree
from typing import Any

from prf_experiments.faults import catalogue, wiring
from prf_experiments.record import topics
from prf_experiments.run import arguments as args
from prf_experiments.run import connections, session, trial_arguments


class Catalogue(unittest.TestCase):
    def test_a_word_says_what_how_much_and_when(self):
        first, second = catalogue.parse("drop/tag_detections:0.3@4-6,respawn/decision@8")
        self.assertEqual((first.name, first.topic, first.amount, first.begin, first.end),
                         ("drop", "tag_detections", 0.3, 4.0, 6.0))
        self.assertEqual((second.node, second.amount, second.begin), ("decision", 1.0, 8.0))
        self.assertEqual(catalogue.parse("false_tag")[0].end, math.inf)
        self.assertEqual(catalogue.parse("false_tag+disk")[1].name, "disk")
        self.assertEqual(catalogue.parse(""), [])

    def test_what_is_no_fault_is_refused_with_what_is_valid(self):
        for text, told in (("explode", "drop|delay"), ("drop", "joint_states|camera"),
                           ("drop/decision", "no target"), ("kill/tag_detections", "decision"),
                           ("drop/tf:1.5", "0 .. 1"), ("drop/tf:nan", "is no fault"),
                           ("delay/tf:0", "0.001 .. 60"), ("kill/decision@5-6", "no end"),
                           ("drop/tf@5-4", "5 .. 86400"), ("false_tag,false_tag", "twice"),
                           ("clock,false_tag", "does not go"), ("false_tag/tf", "none")):
            with self.assertRaises(catalogue.FaultError, msg=text) as caught:
                catalogue.parse(text)
            self.assertIn(told, str(caught.exception))

    def test_every_fault_can_be_asked_for_and_is_listed(self):
        for name, kind in catalogue.KINDS.items():
            word = name + (f"/{kind.target[0]}" if kind.target else "")
            self.assertEqual(catalogue.parse(word)[0].amount, kind.amount)
            self.assertIn("  " + name, trial_arguments.usage())

    def test_is_part_of_a_trials_name_and_command(self):
        word = "fault:=drop/tag_detections:0.3@4,kill/decision@5"
        values = args.parse([word], trial_arguments.TRIAL)
        self.assertIn(word, trial_arguments.words(values))
        name = trial_arguments.name(values)
        self.assertIn("fault-drop-tag_detections-0.3@4-kill-decision@5", name)
        self.assertNotIn("/", name)
        long = {**values, "fault": ",".join(f"drop/tf:0.{row}" for row in range(40))}
        self.assertLess(len(trial_arguments.name(long)), 255)
        self.assertNotEqual(trial_arguments.name(long), trial_arguments.name(
            {**long, "fault": long["fault"] + ",disk"}))


class Wiring(unittest.TestCase):
    def test_topics_and_readers_are_those_of_the_table_of_interfaces(self):
        for topic in catalogue.TOPICS:
            self.assertIn(topic, [entry.bare_name for entry in topics.TABLE.topics])

    def test_the_launch_file_turns_every_reader_of_a_faulty_topic(self):
        file: Any = xml.etree.ElementTree.parse(session.packaged("launch", "framework.launch"))
        turned = {remap.get("from").lstrip("/") for group in file.iter("group")
                  for remap in group.iter("remap")}
        self.assertEqual(turned | {"joint_command"}, set(catalogue.TOPICS))
        for group in file.iter("group"):
            node = os.path.basename(group.find("include").get("file")).partition(".")[0]
            node = {"description": "robot_state_publisher"}.get(node, node)
            heard = {remap.get("from").lstrip("/") for remap in group.iter("remap")}
            wanted = {entry.bare_name for entry in topics.TABLE.topics if node in entry.readers}
            self.assertEqual(wanted - {"tf_static"} - heard, set(), node)

    def test_readers_hear_the_injector_and_the_recorder_hears_both(self):
        links = connections.trial_links("platform_sim") | session.recorder_links(
            ["joint_states"], "platform_sim")
        found = wiring.rewired(links, catalogue.parse("drop/joint_states,drop/joint_command"))
        for link in (("/joint_states", "/platform_sim", "/fault_injector"),
                     ("/joint_states", "/platform_sim", "/recorder"),
                     ("/faulty/joint_states", "/fault_injector", "/decision"),
                     ("/faulty/joint_command", "/fault_injector", "/platform_sim"),
                     ("/faulty/joint_command", "/fault_injector", "/recorder"),
                     ("/execution/progress", "/decision", "/platform_sim")):
            self.assertIn(link, found)
        self.assertNotIn(("/joint_states", "/platform_sim", "/decision"), found)

    def test_a_second_publisher_and_the_ticks_are_waited_for(self):
        found = wiring.rewired(connections.trial_links("platform_sim"),
                               catalogue.parse("second/target/forecast"))
        for link in (("/joint_states", "/platform_sim", "/fault_injector"),
                     ("/target/forecast", "/target_predictor", "/second_publisher"),
                     ("/faulty/target/forecast", "/second_publisher", "/decision")):
            self.assertIn(link, found)


if __name__ == "__main__":
    unittest.main()
