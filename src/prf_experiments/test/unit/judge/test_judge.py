# SPDX-License-Identifier: BSD-3-Clause
import os
import sys
import unittest

import numpy as np
from scipy.spatial.transform import Rotation

sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import synthetic
from prf_experiments.judge import judge
from prf_experiments.record import recording
from prf_experiments.record.recording import Contact

from prf_experiments import geometry

MILLIMETRE, MICROMETRE = 1e-3, 1e-6
BOX, PALM = "box_left", "j2s7s300_link_7"


def at_stand_off_for(ticks, seconds=10.0):
    """Trial that is at the stand-off for so many ticks and elsewhere before and after."""
    lateral = np.full(int(seconds * 100) + 1, 0.2)
    lateral[200:200 + ticks] = 0.0
    return synthetic.make_recording(seconds, lateral=lateral)


def with_contact(force, links=(BOX, PALM)):
    data = synthetic.make_recording()
    data.contacts = [Contact(int(data.ticks[300]), tuple(sorted(links)), force)]
    return data


class OnTheObstacle(unittest.TestCase):
    def test_contact_with_the_obstacle_is_a_figure_of_its_own_beside_the_verdict(self):
        for obstacle, links, expected in (("post", (judge.OBSTACLE, PALM), 5.0), ("post", (BOX, PALM), 0.0),
                                          ("post", (judge.OBSTACLE, "body"), 0.0), ("none", (BOX, PALM), None)):
            data = with_contact(5.0, links)
            data.description["arguments"] = {**data.description.get("arguments", {}), "obstacle": obstacle}
            self.assertEqual(judge.judge(data).figures["largest_obstacle_contact_n"], expected)

    def test_it_is_judged_as_any_contact(self):
        self.assertEqual(judge.judge(with_contact(5.0, (judge.OBSTACLE, PALM))).verdict, "P")


class Reached(unittest.TestCase):
    def test_holding_the_stand_off_is_a_success_and_inspected(self):
        verdict = judge.judge(synthetic.make_recording())
        self.assertEqual(verdict.verdict, "S")
        self.assertTrue(verdict.inspected)
        self.assertAlmostEqual(verdict.figures["reached_s"], 1.0)
        self.assertAlmostEqual(verdict.figures["inspected_s"], 2.0)

    def test_exactly_one_second_is_long_enough(self):
        self.assertEqual(judge.judge(at_stand_off_for(101)).verdict, "S")

    def test_one_tick_less_than_a_second_is_not(self):
        verdict = judge.judge(at_stand_off_for(100))
        self.assertEqual(verdict.verdict, "F")
        self.assertIn("not reached", verdict.reason)

    def test_a_break_starts_the_second_anew(self):
        data = at_stand_off_for(150)
        data.camera.values[275] = synthetic.camera_pose(0.2, judge.STAND_OFF)
        self.assertEqual(judge.judge(data).verdict, "F")

    def test_what_was_not_reached_is_told_by_the_best_instant(self):
        along = np.full(1001, 0.5)
        along[300] = 0.15
        verdict = judge.judge(synthetic.make_recording(lateral=0.12, along=along))
        self.assertIn("at best 120 mm beside the axis and -150 mm along it", verdict.reason)

    def test_the_distance_is_averaged_over_execution_and_over_tracking(self):
        lateral = np.linspace(0.03, 0.01, 1001) ** 2
        figures = judge.judge(synthetic.make_recording(lateral=lateral)).figures
        forward, tracking = 1e3 * lateral[:500], 1e3 * lateral[500:1000]  # the last tick is DONE
        for phase, wanted in (("execution", forward), ("tracking", tracking)):
            self.assertAlmostEqual(figures[phase + "_lateral_mean_mm"], np.mean(wanted), 6)
            self.assertAlmostEqual(figures[phase + "_lateral_deviation_mm"], np.std(wanted), 6)

    def test_bounds_across_and_along_the_axis(self):
        for lateral, along, verdict in (
                (0.1 - MICROMETRE, 0.3, "S"), (0.1 + MICROMETRE, 0.3, "F"),
                (0.0, 0.4 - MICROMETRE, "S"), (0.0, 0.4 + MICROMETRE, "F"),
                (0.0, 0.2 + MICROMETRE, "S"), (0.0, 0.2 - MICROMETRE, "F")):
            data = synthetic.make_recording(lateral=lateral, along=along)
            self.assertEqual(judge.judge(data).verdict, verdict, (lateral, along))

    def test_inspected_needs_forty_millimetres_for_two_seconds(self):
        for lateral, along, inspected in (
                (0.04 - MICROMETRE, 0.3, True), (0.04 + MICROMETRE, 0.3, False),
                (0.0, 0.34 - MICROMETRE, True), (0.0, 0.34 + MICROMETRE, False),
                (0.0, 0.26 + MICROMETRE, True), (0.0, 0.26 - MICROMETRE, False)):
            data = synthetic.make_recording(lateral=lateral, along=along)
            self.assertEqual(judge.judge(data).inspected, inspected, (lateral, along))
        self.assertTrue(judge.judge(at_stand_off_for(201)).inspected)
        self.assertFalse(judge.judge(at_stand_off_for(200)).inspected)

    def test_must_be_complete_within_sixty_seconds(self):
        lateral = np.full(6201, 0.2)
        lateral[5900:] = 0.0  # from 59.0 s: the second is over at 60.0 s
        self.assertEqual(judge.judge(synthetic.make_recording(62.0, lateral)).verdict, "S")
        lateral[5900] = 0.2
        self.assertEqual(judge.judge(synthetic.make_recording(62.0, lateral)).verdict, "F")

    def test_does_not_depend_on_where_the_world_has_its_origin(self):
        data = synthetic.make_recording(lateral=0.09, along=0.35)
        shift = np.array([3.0, -2.0, 1.0, 0.5, 0.5, 0.5, 0.5])
        for name in ("tag", "camera", "base", "platform"):
            poses = getattr(data, name)
            poses.values = geometry.compose(shift, poses.values)
        figures = judge.judge(data).figures
        self.assertAlmostEqual(figures["final_lateral_mm"], 90.0, places=6)
        self.assertAlmostEqual(figures["final_along_error_mm"], 50.0, places=6)
        self.assertAlmostEqual(figures["lowest_body_height_mm"], 530.0, places=6)


class Contacts(unittest.TestCase):
    def test_up_to_one_newton_is_no_issue(self):
        self.assertEqual(judge.judge(with_contact(1.0)).verdict, "S")

    def test_above_one_newton_is_an_issue(self):
        verdict = judge.judge(with_contact(1.0 + 1e-9))
        self.assertEqual(verdict.verdict, "P")
        self.assertIn(BOX, verdict.reason)
        self.assertIn("reached", verdict.reason)

    def test_fifty_newtons_are_an_issue_and_more_fails(self):
        self.assertEqual(judge.judge(with_contact(50.0)).verdict, "P")
        self.assertEqual(judge.judge(with_contact(50.0 + 1e-9)).verdict, "F")

    def test_counts_for_every_link_of_arm_hand_and_camera(self):
        for link in ("j2s7s300_link_2", "j2s7s300_link_finger_tip_1", "camera_link"):
            for other in ("box_back", "post", "panel", "platform", "body", "fl_upper"):
                data = with_contact(5.0, (link, other))
                self.assertEqual(judge.judge(data).verdict, "P", (link, other))

    def test_feet_on_the_deck_do_not_count(self):
        verdict = judge.judge(with_contact(400.0, ("fl_toe", "platform")))
        self.assertEqual(verdict.verdict, "S")
        self.assertEqual(verdict.figures["largest_contact_n"], 0.0)

    def test_bolt_of_the_arm_and_links_of_one_arm_do_not_count(self):
        for pair in (("body", "j2s7s300_link_base"), ("j2s7s300_link_1", "j2s7s300_link_4"),
                     ("camera_link", PALM)):
            self.assertEqual(judge.judge(with_contact(9.0, pair)).verdict, "S", pair)

    def test_largest_force_of_each_pair_is_reported(self):
        data = with_contact(3.0)
        data.contacts += with_contact(7.0).contacts + with_contact(2.0, (PALM, "post")).contacts
        pairs = judge.judge(data).figures["largest_contact_by_pair_n"]
        self.assertEqual(pairs, {f"{BOX} | {PALM}": 7.0, f"{PALM} | post": 2.0})


class View(unittest.TestCase):
    def hidden(self, first, count):
        data = synthetic.make_recording()
        data.detections[first:first + count] = np.nan
        return data

    def test_blind_for_one_second_is_no_issue(self):
        # 33 images 30 ms apart are missing: 34 * 30 ms = 1.02 s between detections; 32: 0.99 s.
        self.assertEqual(judge.judge(self.hidden(100, 32)).verdict, "S")

    def test_blind_for_longer_is_an_issue(self):
        verdict = judge.judge(self.hidden(100, 33))
        self.assertEqual(verdict.verdict, "P")
        self.assertIn("out of view for 1.02 s", verdict.reason)

    def test_time_before_the_first_detection_does_not_count(self):
        self.assertEqual(judge.judge(self.hidden(0, 200)).verdict, "S")

    def test_losing_the_tag_at_the_end_counts(self):
        self.assertEqual(judge.judge(self.hidden(299, 100)).verdict, "P")

    def test_exactly_one_second_between_detections_is_allowed(self):
        stamps = np.array([0, 1, 2]) * judge.SECOND
        seen = np.array([True, True, True])
        self.assertEqual(judge.longest_out_of_view(stamps, seen), judge.OUT_OF_VIEW_LIMIT)

    def test_never_seen_is_no_time_out_of_view(self):
        self.assertEqual(judge.longest_out_of_view(np.arange(9), np.zeros(9, bool)), 0)


class Failures(unittest.TestCase):
    def base_at(self, height, tilt):
        data = synthetic.make_recording()
        turned = Rotation.from_rotvec([tilt, 0.0, 0.0]).as_quat()
        data.base.values[500] = np.concatenate([[-0.156, 0.0, height], turned])
        return data

    # Fault 36: the robot falls -> F with the time and the reason
    def test_low_body_has_fallen(self):
        self.assertEqual(judge.judge(self.base_at(0.35 + MICROMETRE, 0.0)).verdict, "S")
        verdict = judge.judge(self.base_at(0.35 - MICROMETRE, 0.0))
        self.assertEqual(verdict.verdict, "F")
        self.assertIn("the robot fell at 5.00 s", verdict.reason)

    def test_tilted_body_has_fallen(self):
        self.assertEqual(judge.judge(self.base_at(0.53, np.radians(29.999))).verdict, "S")
        self.assertEqual(judge.judge(self.base_at(0.53, np.radians(30.001))).verdict, "F")

    def test_posture_counts_against_the_deck_not_the_world(self):
        data = synthetic.make_recording()
        tilted = geometry.make(np.zeros(3), Rotation.from_rotvec([0.0, np.radians(40.0), 0.0]))
        data.platform.values[:] = tilted
        data.base.values[:] = geometry.compose(tilted, synthetic.BASE)
        self.assertEqual(judge.judge(data).verdict, "S")

    def test_body_on_the_deck_has_fallen(self):
        data = with_contact(2.0, ("body", "platform"))
        self.assertIn("fell at 3.00 s", judge.judge(data).reason)

    def test_a_fall_ends_the_trial_early_and_is_evidence(self):
        data = self.base_at(0.2, 0.0)
        data.progress.states[:] = judge.STATES.index("FORWARD")
        self.assertEqual(judge.judge(data).verdict, "F")

    def test_stopping_for_an_error_fails_though_reached(self):
        data = synthetic.make_recording(state="STOPPED")
        data.progress.reasons[-1] = "set-point out of reach"
        verdict = judge.judge(data)
        self.assertEqual(verdict.verdict, "F")
        self.assertIn("set-point out of reach", verdict.reason)

    def test_names_every_failure(self):
        data = self.base_at(0.2, 0.0)
        data.contacts = with_contact(60.0).contacts
        reason = judge.judge(data).reason
        self.assertIn("fell", reason)
        self.assertIn("50 N", reason)


class Evidence(unittest.TestCase):
    def reason(self, data):
        verdict = judge.judge(data)
        self.assertEqual(verdict.verdict, "INVALID")
        self.assertFalse(verdict.inspected)
        return verdict.reason

    def test_a_lost_tick_invalidates(self):
        data = synthetic.make_recording()
        keep = np.arange(len(data.ticks)) != 400
        data.tag = recording.Poses(data.tag.stamps[keep], data.tag.values[keep])
        self.assertIn("ground_truth/tag", self.reason(data))

    def test_a_series_that_ends_early_invalidates(self):
        data = synthetic.make_recording()
        data.contact_stamps = data.contact_stamps[:-1]
        self.assertEqual(judge.judge(data).verdict, "S")
        data.contact_stamps = data.contact_stamps[:-1]
        self.assertIn("ground_truth/contacts", self.reason(data))

    def test_images_without_detections_message_invalidate(self):
        data = synthetic.make_recording()
        data.images += judge.MAX_IMAGES_IN_FLIGHT
        self.assertEqual(judge.judge(data).verdict, "S")
        data.images += 1
        self.assertIn("tag_detections", self.reason(data))

    def test_ending_early_invalidates_even_when_reached(self):
        self.assertIn("before its time", self.reason(synthetic.make_recording(state="TRACKING")))

    # Fault 54: a run that reaches its own, shorter time limit -> F "not reached", not INVALID
    def test_the_trials_own_time_limit_is_a_whole_trial(self):
        data = synthetic.make_recording(20.0, lateral=0.2, state="FORWARD")
        self.assertIn("before its time", self.reason(data))
        data.description = {"arguments": {"time_limit": 20.0}}
        verdict = judge.judge(data)
        self.assertEqual(verdict.verdict, "F")
        self.assertIn("not reached", verdict.reason)

    # Fault 40: gaps in what the framework says while faults are injected -> judged by the truth; the truth has none
    def test_gaps_of_the_framework_are_part_of_a_trial_with_faults(self):
        for fault, verdict in (("", "INVALID"), ("kill/tag_detector", "S")):
            data = synthetic.make_recording()
            data.description = {"arguments": {"fault": fault}}
            progress = data.progress
            keep = np.delete(np.arange(len(progress.stamps)), slice(300, 350))
            data.progress = recording.Progress(
                progress.stamps[keep], progress.states[keep], progress.posteriors[keep],
                progress.cursors[keep], [""] * len(keep))
            data.images += 100
            self.assertEqual(judge.judge(data).verdict, verdict)
            data.camera = recording.Poses(np.delete(data.camera.stamps, 500),
                                          np.delete(data.camera.values, 500, axis=0))
            self.assertEqual(judge.judge(data).verdict, "INVALID")

    def test_sixty_seconds_are_a_whole_trial_in_any_state(self):
        data = synthetic.make_recording(60.0, lateral=0.3, state="PAUSE")
        self.assertEqual(judge.judge(data).verdict, "F")

    def test_truth_that_is_not_finite_invalidates(self):
        data = synthetic.make_recording()
        data.camera.values[7, 2] = np.nan
        self.assertIn("ground_truth/camera", self.reason(data))


if __name__ == "__main__":
    unittest.main()
