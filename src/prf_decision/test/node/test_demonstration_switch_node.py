#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""One demonstration after the other: decision and planner together, the planner killed amid one."""

import math
import os
import signal
import subprocess
import sys
import tempfile

import rospkg
import rospy
import rostest
import yaml
from actionlib_msgs.msg import GoalStatus

from prf_msgs.msg import ExecuteSkillGoal, ExecuteSkillResult, ExecutionProgress, SkillTrajectory

sys.path.insert(0, os.path.join(rospkg.RosPack().get_path("prf_decision"), "test", "node"))
from scripted_world import PATIENCE, GoalTest, World

FIRST, SECOND = 0.0, 0.1  # m, where the skills end beside the target's axis
# m per tick: the skills run at 0.32 m/s, on the approach across the target, a gap closes at 0.2 m/s
STEP = 0.01 * (0.32 * 1.2 + 0.2)


def demonstration(end):
    """0.3 m ahead in 1 s, and 0.1 m to the side on the way."""
    rows = "".join(f"{0.1 * i:.1f},{0.3 + 0.03 * i:.2f},{end - 0.1 + 0.01 * i:.2f},0.5,0,0,0,1\n"
                   for i in range(11))
    return ("# frame: j2s7s300_link_base\n# child_frame: j2s7s300_end_effector\n"
            f"# target_pose: 1 0 0.5 0 0 0 1\ntime,x,y,z,qx,qy,qz,qw\n{rows}")


class PlannedWorld(World):
    """With a planner of its own instead of the scripted one."""

    def __init__(self, folder):
        package = rospkg.RosPack().get_path("elte_planner")
        with open(package + "/config/skill_planner.yaml", encoding="utf-8") as file:
            parameters = yaml.safe_load(file)
        parameters["demonstration"] = os.path.join(folder, "first.csv")
        rospy.set_param("skill_planner", parameters)
        self.plans: list[SkillTrajectory] = []
        self.heard = rospy.Subscriber("skill/trajectory", SkillTrajectory, self.plans.append)
        super().__init__()
        self.start_planner()

    def on_progress(self, message):
        with self.changed:
            self.progress.append(message)
            self.changed.notify_all()

    def start_planner(self):
        self.planner = subprocess.Popen(["rosrun", "elte_planner", "skill_planner_node"],
                                        start_new_session=True)
        self.wait_for_planner(1)

    def kill_planner(self):
        os.killpg(self.planner.pid, signal.SIGKILL)
        self.planner.wait()
        self.wait_for_planner(0)

    def wait_for_planner(self, number):
        """Decision and planner see the forecasts; this world is one publisher of plans itself."""
        for _ in range(50 * PATIENCE):
            if (self.forecasts.get_num_connections() == 1 + number
                    and self.heard.get_num_connections() == 1 + number):
                return
            rospy.rostime.wallsleep(0.02)
        raise RuntimeError("the planner did not come or go")


class DemonstrationSwitchNode(GoalTest):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        for name, text in (("first.csv", demonstration(FIRST)), ("bad.csv", "time,x\n"),
                           ("second.csv", demonstration(SECOND))):
            with open(os.path.join(cls.folder.name, name), "w", encoding="utf-8") as file:
                file.write(text)
        cls.world = PlannedWorld(cls.folder.name)
        cls.connect()

    @classmethod
    def tearDownClass(cls):
        cls.world.kill_planner()
        cls.folder.cleanup()

    def send(self, **goal):
        handle = self.client.send_goal(ExecuteSkillGoal(hold_time=rospy.Duration(0.2), **goal))
        self.wait_until_seen(handle)
        return handle

    def hand(self, setpoint):
        place = setpoint.points[0].transforms[0].translation
        return place.x, place.y, place.z

    def check_no_jump(self):
        path = [self.hand(setpoint) for setpoint in self.world.setpoints if setpoint.points]
        steps = [math.dist(a, b) for a, b in zip(path, path[1:])]
        self.assertLess(max(steps), STEP)

    def check_end(self, y):
        for place, wanted in zip(self.hand(self.world.setpoints[-1]), (0.6, y, 0.5)):
            self.assertAlmostEqual(place, wanted, 3)

    def test_follow_each_other_a_bad_one_changes_nothing_and_a_planner_anew_goes_on(self):
        first = self.send()
        self.assertEqual(self.play(3).state, ExecutionProgress.DONE)
        self.assertEqual(self.result(first)[1].code, ExecuteSkillResult.DONE)
        self.check_end(FIRST)

        for name, reason in (("missing.csv", "missing.csv: there is no such file"),
                             ("bad.csv", "bad.csv:1: header is 'time,x'")):
            refused = self.send(demonstration=name)
            self.assertEqual(self.play(0.2).state, ExecutionProgress.DONE)
            state, result = self.result(refused)
            self.assertEqual((state, result.code),
                             (GoalStatus.REJECTED, ExecuteSkillResult.REFUSED))
            self.assertIn(reason, result.text)
        self.check_end(FIRST)
        self.assertEqual(self.world.plans[-1].status, SkillTrajectory.SOLVED)

        second = self.send(demonstration=os.path.join(self.folder.name, "second.csv"))
        self.assertEqual(self.play(0.5).state, ExecutionProgress.REVERSE)  # along the first
        while self.play(0.05).state != ExecutionProgress.FORWARD:
            self.assertLess(self.now, 12000)
        begun = self.play(0.4)
        self.assertEqual(begun.state, ExecutionProgress.FORWARD)

        self.world.kill_planner()
        self.world.planner_alive = False
        paused = self.play(0.8)
        self.assertEqual((paused.state, paused.reason), (ExecutionProgress.PAUSE, "planner silent"))
        self.world.start_planner()
        self.play(0.2)
        self.world.planner_alive = True
        while self.play(0.1).state != ExecutionProgress.DONE:  # later when the planner was late
            self.assertLess(self.now, 20000)
        self.assertEqual(self.result(second)[1].code, ExecuteSkillResult.DONE)
        self.assertEqual(self.world.plans[-1].demonstration,
                         os.path.join(self.folder.name, "second.csv"))
        self.check_end(SECOND)
        self.check_no_jump()


if __name__ == "__main__":
    rospy.init_node("test_demonstration_switch_node")
    rostest.rosrun("prf_decision", "demonstration_switch_node", DemonstrationSwitchNode)
