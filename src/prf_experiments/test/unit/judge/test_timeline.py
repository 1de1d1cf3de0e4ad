# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

import numpy as np

from prf_msgs.msg import ControlStatus, SkillTrajectory

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import judge, timeline
from prf_experiments.record import recording


def told(data):
    return [(round(time, 2), what) for time, _, _, _, what in
            timeline.event_lines(data, judge.judge(data).figures)]


class Timeline(unittest.TestCase):
    def test_tells_phases_with_reasons_first_detection_and_milestones_in_the_order_of_time(self):
        data = synthetic.make_recording(4.0)
        data.progress.reasons[-1] = "tracked for 2.00 s"
        events = told(data)
        self.assertEqual([what for _, what in events], [
            "FORWARD", "the tag is seen for the first time", "forecast: tracking",
            "reached, for 1.0 s by now", "TRACKING", "inspected, for 2.0 s by now",
            "DONE: tracked for 2.00 s"])
        self.assertEqual([time for time, _ in events], [0, 0, 0, 1.0, 2.0, 2.0, 4.0])

    def test_distances_are_those_of_the_moment(self):
        data = synthetic.make_recording(3.0, lateral=np.linspace(0.09, 0.03, 301), along=0.35)
        _, lateral, to_stand_off, following, what = timeline.event_lines(data, {})[-1]
        self.assertEqual(what, "DONE")
        self.assertAlmostEqual(lateral, 30.0, 6)
        self.assertAlmostEqual(to_stand_off, 50.0, 6)
        self.assertEqual(following, 0.0)

    def test_the_following_error_is_the_decisions_where_it_tells_one(self):
        data = synthetic.make_recording(3.0)
        self.assertEqual(timeline.following_at(data, data.ticks[[10]])[0], 0.0)
        data.progress.following = np.tile([0.004, 0.1], (len(data.ticks), 1))
        data.progress.following[20] = np.nan
        self.assertAlmostEqual(timeline.following_at(data, data.ticks[[10]])[0], 4.0)
        self.assertTrue(np.isnan(timeline.following_at(data, data.ticks[[20]])[0]))

    def test_contacts_near_in_time_are_one_event_for_each_pair_of_links(self):
        data = synthetic.make_recording(4.0)
        pair, other = ("box", "camera_link"), ("body", "j2s7s300_link_5")
        data.contacts = [recording.Contact(int(data.ticks[row]), links, force)
                         for row, links, force in ((10, pair, 2.0), (30, pair, 7.0),
                                                   (31, other, 1.5), (200, pair, 3.0))]
        contacts = [what for _, what in told(data) if what.startswith("contact")]
        self.assertEqual(contacts, [
            "contact: box with camera_link, at most 7.0 N within 0.21 s",
            "contact: body with j2s7s300_link_5, at most 1.5 N within 0.01 s",
            "contact: box with camera_link, at most 3.0 N within 0.01 s"])

    def test_gaps_between_detections_are_told_with_their_length(self):
        data = synthetic.make_recording(4.0)
        data.detections[20:40] = np.nan
        self.assertIn((0.57, "the tag is out of view for 0.63 s"), told(data))
        data.detections[:] = np.nan
        self.assertIn((0.0, "the tag is never seen"), told(data))

    def test_what_the_arm_could_not_do_is_told_once(self):
        data = synthetic.make_recording(4.0)
        for row in (50, 51, 52):
            data.control.codes[row] = ControlStatus.LIMITED
            data.control.reasons[row] = "joint_2 asked too much"
        data.warnings = [recording.LoggedWarning(int(data.ticks[50]), "arm_controller",
                                               "joint_2 asked too much"),
                           recording.LoggedWarning(int(data.ticks[60]), "decision", "no plan")]
        events = told(data)
        self.assertIn((0.5, "arm: limited, 3 ticks within 0.03 s: joint_2 asked too much"), events)
        self.assertIn((0.6, "log of decision: no plan"), events)
        self.assertEqual(sum("asked too much" in what for _, what in events), 1)

    def test_plans_are_told_when_their_status_changes(self):
        data = synthetic.make_recording(4.0)
        data.plans = [recording.Plan(int(data.ticks[row]), status, message, 0.0, np.empty((0, 3)))
                      for row, status, message in (
                          (3, SkillTrajectory.SOLVED, ""), (6, SkillTrajectory.SOLVED, ""),
                          (9, SkillTrajectory.KEPT, "no solution"),
                          (12, SkillTrajectory.REFUSED, "unreadable"))]
        self.assertEqual([event for event in told(data) if event[1].startswith("plan")],
                         [(0.03, "plan: solved"),
                          (0.09, "plan: kept, no solution"),
                          (0.12, "plan: refused, unreadable")])

    def test_many_events_of_a_kind_are_counted(self):
        data = synthetic.make_recording(10.0)
        data.warnings = [recording.LoggedWarning(int(stamp), "decision", f"trouble {row}")
                           for row, stamp in enumerate(data.ticks[::10])]
        logged = [what for _, what in told(data) if "trouble" in what]
        self.assertEqual(len(logged), timeline.MOST_OF_A_KIND + 1)
        self.assertIn(f"{len(data.warnings) - timeline.MOST_OF_A_KIND} more events", logged[-1])
        self.assertIn("the last at 10.00 s: log of decision: trouble 100", logged[-1])

    def test_text_has_phases_solve_times_and_losses(self):
        data = synthetic.make_recording(4.0, lateral=0.010)
        data.diagnostics = {
            "skill_planner": {"median solve time, us": ["90.0", "100.0"],
                              "99th percentile of solve times, us": ["91.0", "105.0"],
                              "longest solve time, us": ["92.0", "110.0"],
                              "plans sent": ["7", "9"]},
            "target_predictor": {"dropped: outside the gate": ["0", "3"]}}
        text = timeline.text(data, judge.judge(data))
        self.assertTrue(text.startswith("S (inspected): reached at 1.00 s"), text)
        self.assertRegex(text, r"FORWARD +2\.00 +10\.0 +0\.0 +10\.0")
        self.assertIn("median 100 µs, 99 % 105 µs, most 110 µs", text)
        self.assertIn("target_predictor: dropped: outside the gate: 3", text)
        self.assertNotIn("plans sent", text)
        self.assertRegex(text, r"forecasts 0\.50 s ahead: \d+\.\d mm rms")

    def test_episodes_part_where_the_gap_is_too_long(self):
        self.assertEqual(timeline.episodes([1, 2, 9, 10, 30], gap=5),
                         [slice(0, 2), slice(2, 4), slice(4, 5)])
        self.assertEqual(timeline.episodes([]), [])


if __name__ == "__main__":
    unittest.main()
