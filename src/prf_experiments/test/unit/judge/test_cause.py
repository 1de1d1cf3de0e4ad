# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

import numpy as np

from prf_msgs.msg import ExecutionProgress, SkillTrajectory

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import cause, judge, timeline, world
from prf_experiments.record import recording


def pushed(seconds=10.0, begin=300, end=500, way=0.14):
    """A recording whose cart goes `way` m to the side between two ticks."""
    data = synthetic.make_recording(seconds)
    data.description = {"arguments": {"scenario": "cart", "framework": False}}
    share = np.clip((np.arange(len(data.ticks)) - begin) / (end - begin), 0.0, 1.0)
    data.tag.values[:, 1] += way * share
    return data


def told(data):
    return cause.sentence(data, judge.judge(data))


class World(unittest.TestCase):
    def test_a_push_of_the_cart_is_an_event_with_its_way_and_times(self):
        event, = world.events(pushed())
        self.assertEqual((event.text, event.short), ("the cart was pushed 0.14 m", "cart pushed"))
        data = pushed()
        self.assertLess(abs(data.seconds(event.begin) - 3.0), 0.15)
        self.assertLess(abs(data.seconds(event.end) - 5.0), 0.15)
        self.assertIn("WORLD: the cart was pushed 0.14 m, until 5.0",
                      timeline.text(data, judge.judge(data)))

    def test_a_box_on_a_swaying_platform_is_not_pushed(self):
        data = synthetic.make_recording(5.0)
        sway = 0.2 * np.sin(0.02 * np.arange(len(data.ticks)))
        for poses in (data.platform, data.tag):
            poses.values[:, 0] += sway
        self.assertEqual(world.events(data), [])

    def test_a_node_killed_and_started_again_is_one_event(self):
        data = synthetic.make_recording(5.0)
        word = "respawn/decision:1@2"
        data.fault_events = [recording.FaultEvent(int(data.ticks[row]), word, "") for row in (200, 300)]
        event, = world.events(data)
        self.assertEqual((data.seconds(event.begin), data.seconds(event.end)), (2.0, 3.0))
        self.assertTrue(event.injected)

    def test_a_disturbance_of_the_camera_is_the_worlds_and_no_injected_fault(self):
        data = synthetic.make_recording(8.0)
        data.description = {"arguments": {"disturb": "occlude:1@4", "seed": 1}}
        data.fault_events = [recording.FaultEvent(int(data.ticks[row]), "occlusion:0.95@4-5", "")
                             for row in range(400, 500, 3)]
        event, = world.events(data)
        self.assertEqual((event.text, event.injected), ("something passed before the camera", False))
        self.assertNotIn("FAULT", timeline.text(data, judge.judge(data)))

    def test_a_fault_that_this_version_does_not_know_is_an_event_all_the_same(self):
        data = synthetic.make_recording(5.0)
        data.fault_events = [recording.FaultEvent(int(data.ticks[100]), "earthquake@1", "")]
        self.assertEqual([event.short for event in world.events(data)], ["earthquake@1"])


class Cause(unittest.TestCase):
    def test_names_the_push_the_gap_in_view_and_the_blind_plan(self):
        data = pushed(way=0.3)
        data.detections[121:150] = np.nan  # an image is every 0.03 s
        data.progress.states[-1] = ExecutionProgress.TRACKING
        data.description["arguments"]["time_limit"] = 10.0
        data.camera.values[:, 1] -= 0.2
        data.plans = [recording.Plan(int(data.ticks[3]), SkillTrajectory.SOLVED, "", 0.0,
                                     np.zeros((3, 3)), int(data.detection_stamps[0]))]
        text = told(data)
        self.assertIn("The cart was pushed 0.30 m from 3.0 to 5.0 s, while the tag was out of view "
                      "from 3.6 to 4.5 s", text)
        self.assertIn("the skill was adapted once, at 0.0 s, and executed blindly", text)
        self.assertIn("lost in the forecast", text)

    def test_a_target_that_was_never_seen_is_said_to_be_so(self):
        data = synthetic.make_recording(61.0, lateral=0.3, state="WAITING")
        data.detections[:] = np.nan
        self.assertIn("never seen", told(data))

    def test_a_contact_is_told_with_the_state_and_what_was_believed(self):
        data = synthetic.make_recording(5.0)
        data.contacts = [recording.Contact(int(data.ticks[150]), ("box", "camera_link"), 2.5)]
        self.assertIn("Contact of box and camera_link at 1.5 s in FORWARD, with the target believed", told(data))

    def test_long_waits_are_told_with_their_most_frequent_reason(self):
        data = synthetic.make_recording(10.0)
        data.progress.states[100:400] = ExecutionProgress.PAUSE
        data.progress.reasons[100:400] = ["tag lost"] * 300
        self.assertIn("the skill stood still for 3.0 s (tag lost)", told(data))

    def test_an_arm_that_does_not_follow_gets_the_blame(self):
        data = synthetic.make_recording(10.0, lateral=0.2)
        data.progress.states[-1] = ExecutionProgress.TRACKING
        data.description = {"arguments": {"time_limit": 10.0}}
        data.progress.following = np.tile([0.19, 0.0], (len(data.ticks), 1))
        data.plans = [recording.Plan(int(data.ticks[3]), SkillTrajectory.SOLVED, "", 0.0,
                                     np.zeros((3, 3)), int(data.detection_stamps[0]))]
        true = synthetic.TAG[:3] - synthetic.BASE[:3] - synthetic.ARM_BASE_IN_BODY[:3]
        data.forecasts.positions = [np.tile(true, (2, 1))] * len(data.detection_stamps)
        self.assertIn("lost in the arm", told(data))

    def test_a_trial_that_is_no_evidence_has_no_cause(self):
        data = synthetic.make_recording(1.0)
        self.assertEqual(cause.sentence(data, judge.invalid("cut")), "")


if __name__ == "__main__":
    unittest.main()
