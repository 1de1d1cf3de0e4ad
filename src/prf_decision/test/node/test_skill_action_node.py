#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The action execute_skill, and its command, against a scripted world."""

import os
import signal
import subprocess
import sys
import threading

import rospkg
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure

from prf_msgs.msg import ExecuteSkillGoal, ExecuteSkillResult, ExecutionProgress

sys.path.insert(0, os.path.join(rospkg.RosPack().get_path("prf_decision"), "test", "node"))
from scripted_world import MISSING, PATIENCE, GoalTest, World


class SkillActionNode(GoalTest):
    feedback: list

    @classmethod
    def setUpClass(cls):
        cls.world = World()
        cls.connect()

    def begin(self, **goal):
        """A goal that the server has accepted or rejected, with its feedback."""
        changed = threading.Event()
        handle = self.client.send_goal(ExecuteSkillGoal(**goal), lambda _: changed.set(),
                                       lambda _, feedback: self.feedback.append(feedback))
        self.feedback = []
        self.wait_until_seen(handle)
        self.wait(lambda: handle.get_goal_status() != GoalStatus.PENDING)
        return handle

    def test_executes_once_for_each_goal_and_tells_how_it_goes(self):
        progress = self.play(0.5)
        self.assertEqual((progress.state, progress.reason),
                         (ExecutionProgress.WAITING, "no goal yet"))
        handle = self.begin(hold_time=rospy.Duration(0.5))
        self.assertEqual(self.play(3).state, ExecutionProgress.DONE)
        state, result = self.result(handle)
        self.assertEqual((state, result.code), (GoalStatus.SUCCEEDED, ExecuteSkillResult.DONE))
        self.assertEqual(result.text, "tracked for 0.50 s")
        fractions = [each.cursor for each in self.feedback]
        self.assertEqual(fractions, sorted(fractions))
        self.assertAlmostEqual(fractions[-1], 1)
        # Of the measured hand, which stands at the start of the skill.
        self.assertAlmostEqual(self.feedback[-1].goal_distance, 0.3, 6)
        self.assertAlmostEqual(self.feedback[-1].axis_distance, 0.3, 6)
        # Three states, the first two for about 1.0 and 0.5 s: at once, then every 0.1 s.
        self.assertTrue(15 <= len(self.feedback) <= 19, len(self.feedback))

        handle = self.begin()  # back to the start, and again
        self.assertEqual(self.play(0.5).state, ExecutionProgress.REVERSE)
        self.play(6)
        self.assertEqual(self.result(handle)[1].code, ExecuteSkillResult.DONE)
        reached = [progress.cursor for progress in self.world.progress]
        self.assertIn(0.0, reached[100:])
        handle = self.begin(resume=True)
        self.play(4)
        self.assertEqual(self.result(handle)[1].code, ExecuteSkillResult.DONE)
        path = [s.points[0].transforms[0].translation.x for s in self.world.setpoints if s.points]
        self.assertLess(max(abs(b - a) for a, b in zip(path, path[1:])), 0.005 + 1e-9)

    def test_stops_when_preempted_and_resumes_on_demand(self):
        handle = self.begin()
        progress = self.play(0.7)
        self.assertEqual(progress.state, ExecutionProgress.FORWARD)
        handle.cancel()
        self.wait(lambda: handle.get_goal_status() == GoalStatus.PREEMPTING)
        self.assertEqual(self.play(0.1).state, ExecutionProgress.STOPPED)
        self.assertFalse(self.world.setpoints[-1].points)  # hold
        state, result = self.result(handle)
        self.assertEqual((state, result.code),
                         (GoalStatus.PREEMPTED, ExecuteSkillResult.PREEMPTED))
        handle = self.begin(resume=True)
        before = len(self.world.progress)
        self.play(5)
        self.assertEqual(self.result(handle)[1].code, ExecuteSkillResult.DONE)
        self.assertGreaterEqual(min(p.cursor for p in self.world.progress[before:]),
                                progress.cursor)

    def test_ends_a_preempted_goal_when_the_arm_stands_or_after_a_second(self):
        arm, finger = "j2s7s300_joint_1", "j2s7s300_joint_finger_1"
        for joint, speed, waits in ((arm, 0.03, True), (arm, float("nan"), True),
                                    (arm, -0.01, False), (finger, 0.5, False)):
            with self.subTest(joint=joint, speed=speed):
                self.begin_run()
                handle = self.begin()
                self.play(0.5)
                handle.cancel()
                self.wait(lambda handle=handle: handle.get_goal_status() == GoalStatus.PREEMPTING)
                self.world.joint_speeds = {joint: speed}
                self.play(0.9)
                if waits:
                    rospy.rostime.wallsleep(0.3)  # a result too early would be here by now
                    self.assertEqual(handle.get_goal_status(), GoalStatus.PREEMPTING)
                    self.play(0.2)
                self.assertEqual(self.result(handle)[1].code, ExecuteSkillResult.PREEMPTED)

    def test_gives_up_when_the_target_is_lost(self):
        handle = self.begin()
        self.play(0.5)
        self.world.target_hides = self.now
        self.play(6)
        state, result = self.result(handle)
        self.assertEqual((state, result.code),
                         (GoalStatus.ABORTED, ExecuteSkillResult.TARGET_LOST))
        self.assertIn("target not found within 2.00 s", result.text)

    # Fault 38: arm_controller killed in FORWARD, never restarted -> paused, given up, never SUCCEEDED
    def test_gives_up_when_the_controller_dies(self):
        handle = self.begin()
        self.assertEqual(self.play(0.5).state, ExecutionProgress.FORWARD)
        self.world.controller_alive = False
        self.play(8)
        state, result = self.result(handle)
        self.assertEqual((state, result.code), (GoalStatus.ABORTED, ExecuteSkillResult.ARM_FAILED))
        self.assertIn("control/status silent", result.text)
        self.assertNotIn(ExecutionProgress.TRACKING, {p.state for p in self.world.progress})

    # Fault 29: reconfigured while running -> whole or not at all
    def test_takes_changed_parameters_whole_or_refuses_them_with_the_reason(self):
        change = rospy.ServiceProxy("decision/set_parameters", Reconfigure)

        def ask(**numbers):
            config = Config(doubles=[DoubleParameter(*number) for number in numbers.items()])
            return {each.name: each.value for each in change(config).config.doubles}

        before = ask()
        for numbers, reason in ((dict(dwell_time=0.5, lead=-1.0), "lead = -1, must be"),
                                (dict(dwell_time=0.5, lead=float("nan")), "lead = nan"),
                                (dict(dwell_time=0.5, max_wait=1.0), "max_wait cannot be changed")):
            with self.assertRaises(rospy.ServiceException) as refusal:
                ask(**numbers)
            self.assertIn(reason, str(refusal.exception))
            self.assertEqual(ask(), before)
        after = ask(hold_time=0.25, dwell_time=0.5)
        self.assertEqual(after, dict(before, hold_time=0.25, dwell_time=0.5))
        self.assertEqual(rospy.get_param("decision/hold_time"), 0.25)
        handle = self.begin()
        self.play(2)
        self.assertEqual(self.result(handle)[1].text, "tracked for 0.25 s")
        self.assertEqual(ask(**before), before)

    def test_gives_up_at_the_time_limit_of_the_data(self):
        handle = self.begin(time_limit=rospy.Duration(0.5))
        self.play(1)
        state, result = self.result(handle)
        self.assertEqual((state, result.code), (GoalStatus.ABORTED, ExecuteSkillResult.TIME_UP))
        self.assertEqual(result.text, "not done within 0.50 s")

    def test_rejects_what_it_cannot_do(self):
        first = self.begin()
        state, result = self.result(self.begin())
        self.assertEqual((state, result.code), (GoalStatus.REJECTED, ExecuteSkillResult.REFUSED))
        self.assertIn("an execution is under way", result.text)
        self.play(0.5)
        self.begin_run()  # the goal of the run before is over
        self.assertEqual(self.result(first)[1].code, ExecuteSkillResult.RUN_ENDED)
        state, result = self.result(self.begin(time_limit=rospy.Duration(-1)))
        self.assertIn("time_limit = -1, must be within [0, 3600] s", result.text)
        state, result = self.result(self.begin(resume=True, demonstration="side.csv"))
        self.assertIn("demonstration = side.csv, must be empty with resume", result.text)

    def ask(self, **goal):
        """A goal that the server has seen but the planner has not answered yet."""
        handle = self.client.send_goal(ExecuteSkillGoal(**goal))
        self.wait_until_seen(handle)
        self.assertEqual(handle.get_goal_status(), GoalStatus.PENDING)
        return handle

    def test_asks_the_planner_for_the_demonstration_that_a_goal_names(self):
        handle = self.ask(demonstration="side.csv", hold_time=rospy.Duration(0.5))
        progress = self.play(0.1)
        self.assertEqual((progress.demonstration, progress.demonstration_switch), ("side.csv", 1))
        self.wait(lambda: handle.get_goal_status() == GoalStatus.ACTIVE)
        self.play(3)
        self.assertEqual(self.result(handle)[1].code, ExecuteSkillResult.DONE)

        handle = self.ask(demonstration=MISSING)
        self.play(0.1)
        state, result = self.result(handle)
        self.assertEqual((state, result.code), (GoalStatus.REJECTED, ExecuteSkillResult.REFUSED))
        self.assertEqual(result.text, "missing.csv: there is no such file")
        progress = self.play(0.1)
        self.assertEqual((progress.demonstration, progress.demonstration_switch), ("side.csv", 1))
        self.assertEqual(progress.state, ExecutionProgress.DONE)

    def test_recalls_a_goal_that_the_planner_has_not_answered_and_ends_it_with_the_run(self):
        handle = self.ask(demonstration="side.csv")
        handle.cancel()
        self.wait(lambda: handle.get_goal_status() == GoalStatus.RECALLING)
        self.play(0.01)
        state, result = self.result(handle)
        self.assertEqual((state, result.code),
                         (GoalStatus.RECALLED, ExecuteSkillResult.PREEMPTED))
        handle = self.ask(demonstration="side.csv")
        self.begin_run()
        state, result = self.result(handle)
        self.assertEqual((state, result.code), (GoalStatus.REJECTED, ExecuteSkillResult.RUN_ENDED))

    def command(self, *arguments):
        self.wait(lambda: self.client.pub_goal.get_num_connections() == 1)
        return subprocess.Popen(["rosrun", "prf_decision", "execute_skill", *arguments],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                start_new_session=True)

    def played_until_executing(self):
        for _ in range(600):
            if self.play(0.05).state != ExecutionProgress.WAITING:
                return
            rospy.rostime.wallsleep(0.05)
        self.fail("no goal came")

    def test_command_exits_by_result(self):
        with self.command("--hold-time", "0.5") as done:
            self.played_until_executing()
            self.play(3)
            out, error = done.communicate(timeout=PATIENCE)
            self.assertEqual(done.returncode, 0, error)
            self.assertIn("DONE: tracked for 0.50 s", out)

    def test_command_preempts_when_interrupted(self):
        with self.command() as stopped:
            self.played_until_executing()
            os.killpg(stopped.pid, signal.SIGINT)
            for _ in range(600):
                self.play(0.05)
                if stopped.poll() is not None:
                    break
                rospy.rostime.wallsleep(0.05)
            out, error = stopped.communicate(timeout=PATIENCE)
            self.assertEqual(stopped.returncode, 4, error)
            self.assertIn("PREEMPTED", out)

    def test_command_exits_with_2_when_refused(self):
        with self.command("--demonstration", MISSING) as refused:
            for _ in range(600):
                self.play(0.05)
                if refused.poll() is not None:
                    break
                rospy.rostime.wallsleep(0.05)
            out, error = refused.communicate(timeout=PATIENCE)
            self.assertEqual(refused.returncode, 2, error)
            self.assertIn("REFUSED: missing.csv: there is no such file", out)


if __name__ == "__main__":
    rospy.init_node("test_skill_action_node")
    rostest.rosrun("prf_decision", "skill_action_node", SkillActionNode)
