#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The node from outside: one plan for each named forecast, refusal of bad parameters."""
import os
import subprocess
import sys
import tempfile
import unittest

import rospkg
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from visualization_msgs.msg import Marker, MarkerArray

from prf_msgs.msg import ExecutionProgress, SkillTrajectory, TargetForecast, TargetPrediction

FRAME = "j2s7s300_link_base"


def forecast(stamp, y=0.0, status=TargetForecast.TRACKING, frame=FRAME):
    message = TargetForecast(status=status)
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.header.frame_id = frame
    for horizon in (0.0, 1.0, 2.0):
        prediction = TargetPrediction(horizon=rospy.Duration.from_sec(horizon))
        prediction.pose.position.x = 0.85
        prediction.pose.position.y = y
        prediction.pose.position.z = 0.5
        prediction.pose.orientation.w = 1.0
        prediction.covariance = [1e-6 if i % 7 == 0 else 0.0 for i in range(36)]
        message.predictions.append(prediction)
    return message


def progress(stamp, forecast_stamp, frozen=2, demonstration="", demonstration_switch=0):
    message = ExecutionProgress(frozen=frozen, time_to_go=rospy.Duration.from_sec(1.0),
                                demonstration=demonstration, demonstration_switch=demonstration_switch)
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.header.frame_id = FRAME
    message.forecast_stamp = rospy.Time.from_sec(forecast_stamp)
    return message


def obstacle(stamp, frame, action=Marker.ADD):
    """A ball over everything that the skill may reach."""
    marker = Marker(type=Marker.SPHERE, action=action)
    marker.header.stamp = rospy.Time.from_sec(stamp)
    marker.header.frame_id = frame
    marker.pose.orientation.w = 1.0
    marker.scale.x = marker.scale.y = marker.scale.z = 4.0
    return MarkerArray([marker])


class SkillPlannerNode(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("skill_planner_node_test")
        cls.plans = []
        rospy.Subscriber("skill/trajectory", SkillTrajectory, cls.plans.append, queue_size=100)
        cls.forecasts = rospy.Publisher("target/forecast", TargetForecast, queue_size=100)
        cls.progress = rospy.Publisher("execution/progress", ExecutionProgress, queue_size=100)
        cls.obstacles = rospy.Publisher("obstacles", MarkerArray, queue_size=100)
        while (cls.forecasts.get_num_connections() == 0 or cls.progress.get_num_connections() == 0):
            rospy.rostime.wallsleep(0.02)
        rospy.rostime.wallsleep(0.5)

    def plans_after(self, *messages):
        """Publish in this order with time between, return the plans that came."""
        del self.plans[:]
        for message in messages:
            if isinstance(message, MarkerArray):
                self.obstacles.publish(message)
            elif isinstance(message, TargetForecast):
                self.forecasts.publish(message)
            else:
                # The clock of the tests leaps: so many messages that name no new forecast prove it.
                now = message.header.stamp.to_sec()
                for earlier in (0.03, 0.02, 0.01):
                    self.progress.publish(progress(now - earlier, 0.0))
                self.progress.publish(message)
            rospy.rostime.wallsleep(0.1)
        rospy.rostime.wallsleep(0.3)
        return list(self.plans)

    def test_1_has_no_plan_before_there_is_a_target(self):
        (plan,) = self.plans_after(
            forecast(1.0, status=TargetForecast.NO_TARGET), progress(1.06, 1.0))
        self.assertEqual(plan.status, SkillTrajectory.NO_PLAN)
        self.assertEqual(plan.poses, [])

    def test_2_plans_once_for_each_forecast_with_the_stamp_of_the_progress(self):
        (plan,) = self.plans_after(forecast(2.0), progress(2.06, 2.0), progress(2.07, 2.0))
        self.assertEqual(plan.status, SkillTrajectory.SOLVED, plan.message)
        self.assertEqual(plan.header.stamp, rospy.Time.from_sec(2.06))
        self.assertEqual(plan.header.frame_id, FRAME)
        self.assertEqual(plan.forecast_stamp, rospy.Time.from_sec(2.0))
        self.assertEqual(plan.planner, "elte")
        self.assertEqual(len(plan.poses), 50)
        self.assertEqual(len(plan.time_from_start), 50)
        self.assertEqual(plan.frozen, 2)
        self.assertLess(plan.kkt_residual, 1e-14)
        end = plan.poses[-1].position
        miss = abs(end.x - 0.55) + abs(end.y) + abs(end.z - 0.5)
        self.assertLessEqual(miss, plan.radius + 1e-9)

    def test_3_waits_for_a_forecast_that_comes_after_its_progress(self):
        (early,) = self.plans_after(forecast(3.0, y=0.1), progress(3.06, 3.0))
        (late,) = self.plans_after(progress(4.06, 4.0), forecast(4.0, y=0.1))
        self.assertEqual(early.poses, late.poses)
        self.assertEqual(late.header.stamp, rospy.Time.from_sec(4.06))

    def test_4_keeps_frozen_nodes_and_the_plan_of_a_lost_target(self):
        (before,) = self.plans_after(forecast(5.0), progress(5.06, 5.0))
        (moved,) = self.plans_after(forecast(6.0, y=0.2), progress(6.06, 6.0, frozen=20))
        self.assertEqual(moved.poses[:20], before.poses[:20])
        self.assertNotEqual(moved.poses[20:], before.poses[20:])
        (kept,) = self.plans_after(
            forecast(7.0, status=TargetForecast.LOST), progress(7.06, 7.0, frozen=20))
        self.assertEqual(kept.status, SkillTrajectory.KEPT)
        self.assertEqual(kept.poses, moved.poses)
        self.assertIn("lost", kept.message)

    def test_4_takes_a_forecast_that_is_refused_as_lost(self):
        (before,) = self.plans_after(forecast(7.2), progress(7.26, 7.2))
        for stamp, spoil in ((7.3, lambda f: setattr(f.predictions[1].pose.orientation, "w", 1.01)),
                             (7.4, lambda f: setattr(f.predictions[1], "horizon", rospy.Duration(2))),
                             (7.5, lambda f: f.predictions.pop(0)),
                             (7.6, lambda f: setattr(f, "status", 9))):
            bad = forecast(stamp, y=0.2)
            spoil(bad)
            (kept,) = self.plans_after(bad, progress(stamp + 0.06, stamp))
            self.assertEqual((kept.status, kept.poses), (SkillTrajectory.KEPT, before.poses))

    def test_5_drops_messages_of_another_frame(self):
        self.assertEqual(
            self.plans_after(forecast(8.0, frame="world"), progress(8.06, 8.0)), [])

    # Fault 42, 43, 51: one progress or forecast with absurd numbers -> dropped or taken as lost; the next is planned
    def test_5_survives_absurd_messages(self):
        before = self.plans_after(forecast(8.5), progress(8.56, 8.5, frozen=2))[-1]
        end, most = rospy.Time(2**32 - 1, 999999999), 2**32 - 1
        for spoil in (lambda p: setattr(p, "forecast_stamp", end), lambda p: setattr(p.header, "stamp", end),
                      lambda p: setattr(p, "frozen", most), lambda p: setattr(p.header, "stamp", rospy.Time()),
                      lambda p: setattr(p, "time_to_go", rospy.Duration(2**31 - 1)),
                      lambda p: setattr(p, "demonstration_switch", most),
                      lambda p: setattr(p, "demonstration", "/etc/passwd"),
                      lambda p: setattr(p, "demonstration", "a" * 100000)):
            bad = progress(8.57, 8.51)
            spoil(bad)
            self.progress.publish(bad)
        for spoil in (lambda f: setattr(f.header, "stamp", end), lambda f: setattr(f.header, "stamp", rospy.Time()),
                      lambda f: setattr(f.predictions[1].pose.position, "x", 1e300),
                      lambda f: setattr(f.predictions[1].twist.linear, "x", float("nan"))):
            bad = forecast(8.52)
            spoil(bad)
            self.forecasts.publish(bad)
        after = self.plans_after(forecast(8.6), progress(8.66, 8.6, frozen=20))[-1]
        self.assertEqual(after.status, SkillTrajectory.SOLVED, after.message)
        self.assertEqual(after.poses[:20], before.poses[:20])

    def test_6_starts_anew_when_stamps_go_back(self):
        (plan,) = self.plans_after(
            forecast(1.0, status=TargetForecast.NO_TARGET), progress(1.06, 1.0))
        self.assertEqual(plan.status, SkillTrajectory.NO_PLAN)

    # Fault 55: a progress names a demonstration outside the configured folders -> REFUSED, it is not opened
    def test_7_opens_no_file_elsewhere(self):
        (plan,) = self.plans_after(forecast(10.0), progress(10.06, 10.0, 2, "/etc/passwd", 9))
        self.assertEqual((plan.status, plan.poses), (SkillTrajectory.REFUSED, []))
        self.assertIn("'/etc/passwd' is outside demonstration_folders: ", plan.message)

    def test_7_plans_with_the_demonstration_requested_or_says_why_not(self):
        first = rospy.get_param("~demonstration")
        with open(first, encoding="utf-8") as file:
            text = file.read()
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as other:
            other.write(text.replace("target_pose: 0.8", "target_pose: 0.9"))
            other.flush()
            before, moved, missing, kept, back = self.plans_after(
                *(message for i, requested in enumerate(
                    [("", 0), (other.name, 1), ("missing.csv", 2), (other.name, 1), ("", 0)])
                  for message in (forecast(11.0 + i), progress(11.06 + i, 11.0 + i, 2, *requested))))
        self.assertEqual([plan.demonstration_switch for plan in (before, moved, missing, kept, back)],
                         [0, 1, 2, 1, 0])
        self.assertEqual([plan.demonstration for plan in (before, moved, missing, kept, back)],
                         [first, other.name, other.name, other.name, first])
        self.assertAlmostEqual(before.poses[-1].position.x - moved.poses[-1].position.x, 0.1, 2)
        self.assertEqual((missing.status, missing.poses), (SkillTrajectory.REFUSED, []))
        self.assertEqual(missing.message,
                         os.path.join(os.path.dirname(first), "missing.csv: there is no such file"))
        self.assertEqual((kept.status, kept.poses), (moved.status, moved.poses))
        self.assertEqual(back.poses, before.poses)

    # Fault 22: an obstacle over the goal, no way past it -> no plan is sent, the execution pauses
    # Fault 28: obstacles in a foreign frame -> dropped, the ones before stay
    def test_7_sends_no_plan_while_obstacles_block_the_way(self):
        for stamp, message, status in (
                (90.0, obstacle(80.0, FRAME), SkillTrajectory.NO_PLAN),
                (91.0, obstacle(90.5, "map"), SkillTrajectory.NO_PLAN),
                (92.0, obstacle(91.5, FRAME, Marker.DELETEALL), SkillTrajectory.SOLVED),
                (93.0, obstacle(93.5, FRAME), SkillTrajectory.SOLVED),  # not yet
                (94.0, obstacle(93.6, "tag_0"), SkillTrajectory.NO_PLAN),
                (95.0, obstacle(94.5, "tag_0", Marker.DELETEALL), SkillTrajectory.SOLVED)):
            (plan,) = self.plans_after(message, forecast(stamp), progress(stamp + 0.06, stamp))
            self.assertEqual(plan.status, status, (stamp, plan.message))
            self.assertEqual(bool(plan.poses), status == SkillTrajectory.SOLVED)

    # Fault 50: a solve is late -> its plan is sent all the same, counted and told in diagnostics
    def test_8_tells_late_solves_and_sends_their_plans(self):
        plans: list[SkillTrajectory] = []
        reports: dict[str, int] = {}

        def remember(message):
            for status in message.status:
                values = {value.key: value.value for value in status.values}
                reports[status.name.split(":")[0].strip("/")] = int(values["late solves"])

        rospy.Subscriber("hurried/skill/trajectory", SkillTrajectory, plans.append)
        rospy.Subscriber("/diagnostics", DiagnosticArray, remember)
        forecasts = rospy.Publisher("hurried/target/forecast", TargetForecast, queue_size=9)
        requests = rospy.Publisher("hurried/execution/progress", ExecutionProgress, queue_size=9)
        for i in range(1, 60):
            stamp = 0.1 * i
            for publisher, messages in ((forecasts, forecast(stamp)),
                                        (requests, progress(stamp + 0.06, stamp))):
                publisher.publish(messages)
                rospy.rostime.wallsleep(0.05)
            if reports.get("hurried/skill_planner", 0) > 0 and plans:
                break
        self.assertGreater(reports.get("hurried/skill_planner", 0), 0, reports)
        self.assertEqual(plans[-1].status, SkillTrajectory.SOLVED)


class SkillPlannerParameters(unittest.TestCase):
    def refusal(self, **changes):
        """Exit code and output of a node started with changed parameters; None removes a key."""
        share = rospkg.RosPack().get_path("elte_planner")
        with open(share + "/config/skill_planner.yaml") as file:
            values = yaml.safe_load(file)
        values["demonstration"] = rospy.get_param("~demonstration")
        values.update(changes)
        values = {key: value for key, value in values.items() if value is not None}
        if rospy.has_param("/bad_planner"):
            rospy.delete_param("/bad_planner")
        rospy.set_param("/bad_planner", values)
        run = subprocess.run(
            ["rosrun", "elte_planner", "skill_planner_node", "__name:=bad_planner"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=20, check=False)
        return run.returncode, run.stdout

    def check(self, expected, **changes):
        code, output = self.refusal(**changes)
        self.assertEqual(code, 2, output)
        fatal = [line for line in output.splitlines() if "FATAL" in line]
        self.assertEqual(len(fatal), 1, output)
        self.assertIn(expected, fatal[0])

    # Fault 28, 52: garbage in the planner's parameters -> exit code 2 and one line naming the parameter
    def test_bad_values_are_refused_by_name(self):
        self.check("nodes = 2", nodes=2)
        self.check("nodes = 50.5", nodes=50.5)
        self.check("w_elastic = -", w_elastic=-0.001)
        self.check("w_bending = nan", w_bending=float("nan"))
        self.check("planner = bezier", planner="bezier")
        self.check('framework = "yes"', framework="yes")
        self.check("horizon_max = -1", horizon_max=-1)
        self.check("max_step = -1", max_step=-1)
        self.check("confidence = 1", confidence=1.0)
        self.check("confidence = 4.94066e-324", confidence=5e-324)
        self.check("max_step = 1e-300", max_step=1e-300)
        self.check("reach = 1e+308", reach=1e308)
        self.check("demonstration_folders: '/nonexistent' is no folder", demonstration_folders="/nonexistent")
        self.check("radius_min = -", radius_min=-0.01)
        self.check("radius_max = 5", radius_max=5.0)
        self.check("late_after = 0", late_after=0.0)
        self.check("obstacles = ", obstacles="sphere 1 2")
        self.check("via_points = ", via_points="0.5 1 2")
        self.check("frame is 'world'", frame="world")
        self.check("/nonexistent.csv: there is no such file", demonstration="/nonexistent.csv")

    def test_missing_and_unknown_keys_are_refused_by_name(self):
        self.check("nodes is missing", nodes=None)
        self.check("nodez = 50", nodez=50)


class Suite(unittest.TestSuite):
    def __init__(self):
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        super().__init__([load(SkillPlannerNode), load(SkillPlannerParameters)])


if __name__ == "__main__":
    rostest.rosrun("elte_planner", "skill_planner_node", "__main__.Suite", sys.argv)
