#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The simulator node against a stand-in for the framework."""
import math
import os
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from std_srvs.srv import Trigger

from prf_msgs.msg import ExecutionProgress

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from fake_framework import ARM, INPUTS, NODE, FakeFramework, Simulator, ready
from parameter_cases import ParameterTest  # noqa: F401 - run as part of this module

SHORT = {"time_limit": 0.5, "response_timeout": 5.0}


class LockstepTest(unittest.TestCase):
    def test_publishes_every_topic_with_the_stamps_of_the_clock(self):
        with FakeFramework() as peer:
            code, output = peer.run(time_limit=1.0)
        self.assertEqual(code, 0, output)
        ticks = list(range(10, 1001, 10))
        for name in ("joint_states", "ground_truth/platform", "ground_truth/base",
                     "ground_truth/tag", "ground_truth/camera", "ground_truth/end_effector",
                     "ground_truth/contacts"):
            self.assertEqual(peer.stamps_ms(name), ticks, name)
        self.assertEqual([round(m.clock.to_sec() * 1000) for m in peer.messages["/clock"]], ticks)
        frames = [10 + round(k * 1000 / 30) for k in range(29)]  # up to 1 s less the latency
        self.assertEqual(peer.stamps_ms("camera/image_raw"), frames)
        self.assertEqual(peer.stamps_ms("camera/camera_info"), frames)
        for name, frame in {"ground_truth/platform": "world", "ground_truth/tag": "world",
                            "ground_truth/contacts": "world",
                            "camera/image_raw": "camera_optical_frame"}.items():
            self.assertEqual({m.header.frame_id for m in peer.messages[name]}, {frame})
        self.assertIn("real-time factor", output)

    def test_describes_image_and_joints(self):
        with FakeFramework() as peer:
            code, output = peer.run(**SHORT)
        self.assertEqual(code, 0, output)
        image, info = peer.messages["camera/image_raw"][0], peer.messages["camera/camera_info"][0]
        self.assertEqual((image.width, image.height, image.encoding), (640, 480, "mono8"))
        self.assertEqual(len(image.data), 640 * 480)
        self.assertGreater(len(set(image.data)), 50)
        self.assertEqual(info.K, (615.0, 0.0, 320.0, 0.0, 615.0, 240.0, 0.0, 0.0, 1.0))
        joints = peer.messages["joint_states"][-1]
        self.assertEqual(len(joints.name), 19)
        self.assertEqual(joints.name[12:], ARM)
        for values in (joints.position, joints.velocity, joints.effort):
            self.assertEqual(len(values), 19)
            self.assertTrue(all(math.isfinite(value) for value in values))

    def test_moves_the_arm_as_commanded(self):
        target = list(ready())
        target[6] += 0.1
        with FakeFramework(positions=target) as peer:
            code, output = peer.run(**{**SHORT, "time_limit": 1.0})
        self.assertEqual(code, 0, output)
        for index in range(7):
            self.assertAlmostEqual(peer.messages["joint_states"][-1].position[12 + index],
                                   target[index], delta=0.005)

    def test_repeats_a_run_to_the_last_bit(self):
        digests = []
        for seed in (3, 3, 4):
            with FakeFramework() as peer:
                code, output = peer.run(motion="light", seed=seed, **SHORT)
            self.assertEqual(code, 0, output)
            digests.append({name: value.hexdigest() for name, value in peer.digest.items()})
        self.assertEqual(digests[0], digests[1])
        self.assertNotEqual(digests[0]["camera/image_raw"], digests[2]["camera/image_raw"])

    def test_ends_a_while_after_the_skill_is_done(self):
        with FakeFramework(done_at=0.2) as peer:
            code, output = peer.run(end_delay=0.3)
        self.assertEqual(code, 0, output)
        self.assertEqual(peer.stamps_ms("joint_states")[-1], 500)

    def test_holds_the_arm_when_a_command_is_not_finite(self):
        with FakeFramework(positions=[float("nan")] * 7) as peer:
            code, output = peer.run(**SHORT)
        self.assertEqual(code, 0, output)
        self.assertIn("joint_command refused, the arm holds: position of joint 1 = nan", output)
        for start, position in zip(ready(),
                                   peer.messages["joint_states"][-1].position[12:]):
            self.assertAlmostEqual(position, start, delta=0.005)

    def test_holds_the_arm_when_a_command_has_a_wrong_size(self):
        with FakeFramework(positions=[0.0] * 6):
            code, output = Simulator(**SHORT).wait()
        self.assertEqual(code, 0, output)
        self.assertIn("joint_command refused", output)

    # Fault 10, 40, 43, 51: responses far ahead, old, doubled, NaN, huge, foreign -> dropped, run goes on
    def test_goes_on_after_wrong_responses(self):
        target = list(ready())
        target[6] += 0.1

        def disturb(peer, stamp):
            tick = round(stamp.to_sec() * 100)
            wrong = peer.command(stamp)
            if tick in (20, 21):  # before the right one
                wrong.header.stamp = rospy.Time(1000 if tick == 20 else 2 ** 32 - 1, 0)
                progress = ExecutionProgress(header=wrong.header, state=ExecutionProgress.DONE)
                progress.forecast_stamp = wrong.header.stamp
                peer.say("execution/progress", progress)
                for name in ("tag_detections", "target/forecast", "skill/trajectory",
                             "execution/setpoint"):
                    peer.say(name, INPUTS[name](header=wrong.header))
            elif tick in (22, 23):
                wrong.header.stamp = rospy.Time.from_sec(0.05 if tick == 22 else 0.22)
            elif tick in (30, 31, 32, 33):  # instead of the right one
                peer.say("execution/progress", ExecutionProgress(header=wrong.header))
                point = wrong.points[0]
                if tick == 30:
                    point.positions[3] = math.nan
                elif tick == 31:
                    point.positions[3] = 1e300
                elif tick == 32:
                    point.velocities[3] = -1e300
                else:
                    wrong.joint_names = [f"panda_joint{i}" for i in range(1, 8)]
            else:
                return False
            peer.say("joint_command", wrong)
            return tick >= 30
        with FakeFramework(positions=target, disturb=disturb) as peer:
            code, output = peer.run(time_limit=1.0)
        self.assertEqual(code, 0, output)
        self.assertEqual(peer.stamps_ms("joint_states")[-1], 1000, "DONE of the far future")
        self.assertAlmostEqual(peer.messages["joint_states"][-1].position[18], target[6], delta=0.005)
        for words in ("ahead of everything published", "late or has come before",
                      "joint_command refused, the arm holds: position of joint 4 = nan"):
            self.assertIn(words, output)

    # Fault 11: nodes drop the first ticks of a new run -> not insisted on, the run goes on
    def test_does_not_insist_on_the_first_ticks(self):
        with FakeFramework(deaf_ticks=2) as peer:
            code, output = peer.run(**SHORT)
        self.assertEqual(code, 0, output)
        self.assertEqual(peer.stamps_ms("joint_states"), list(range(10, 501, 10)))
        self.assertIn("goes on without execution/progress, joint_command", output)

    # Fault 19, 40: a second publisher of joint_command -> named; its copies are dropped
    def test_names_a_second_publisher(self):
        with FakeFramework() as peer:
            node = subprocess.Popen(
                ["rostopic", "pub", "-r", "20", "joint_command", "trajectory_msgs/JointTrajectory",
                 "{header: {stamp: {secs: 0, nsecs: 0}}}"])
            try:
                code, output = peer.run(real_time_factor=0.5, time_limit=3.0)
            finally:
                node.terminate()
                node.wait()
        self.assertEqual(code, 0, output)
        self.assertRegex(output, "joint_command.*/rostopic_")

    def test_lets_a_hand_guide_the_arm(self):
        with FakeFramework(guide=True) as peer:
            code, output = peer.run(arm_mode="compliant", **SHORT)
        self.assertEqual(code, 0, output)
        heights = [m.pose.position.z for m in peer.messages["ground_truth/end_effector"]]
        self.assertGreater(heights[-1], heights[0] + 0.002)

    def test_runs_in_real_time_without_anyone(self):
        begin = time.monotonic()
        code, output = Simulator(lockstep=False, time_limit=1.5).wait()
        self.assertEqual(code, 0, output)
        self.assertGreaterEqual(time.monotonic() - begin, 1.5)

    def test_keeps_below_the_cap_of_the_real_time_factor(self):
        with FakeFramework():
            begin = time.monotonic()
            code, output = Simulator(real_time_factor=0.5, **SHORT).wait()
        self.assertEqual(code, 0, output)
        self.assertGreaterEqual(time.monotonic() - begin, 1.0)


class SilenceTest(unittest.TestCase):
    # Fault 34: lockstep peer silent -> after the limit the topic is named, exit code not 0
    def test_names_the_topic_that_falls_silent(self):
        for name in ("tag_detections", "target/forecast", "execution/progress",
                     "execution/setpoint", "joint_command"):
            # What depends on the mute topic is silent as well, as in the framework.
            mute_from = 0.2
            with FakeFramework(mute=name, mute_from=mute_from) as peer:
                if name != "joint_command":
                    peer.publishers["joint_command"] = MutedFrom(
                        peer.publishers["joint_command"], mute_from + 0.08)
                code, output = peer.run(response_timeout=2.0)
            self.assertEqual(code, 5, output)
            self.assertIn(f"{name} is silent", output)

    # Fault 11, 34: silent from the first tick on -> insisted on after the first ticks
    def test_names_the_topic_that_was_never_heard(self):
        with FakeFramework(mute="joint_command") as peer:
            code, output = peer.run(response_timeout=3.0)
        self.assertEqual(code, 5, output)
        self.assertIn("joint_command is silent", output)
        self.assertEqual(peer.stamps_ms("joint_states")[-1], 110)

    def test_names_the_trajectory_that_the_decision_waits_for(self):
        with FakeFramework(forecast=True, mute="execution/progress", mute_from=0.11) as peer:
            code, output = peer.run(response_timeout=2.0)
        self.assertEqual(code, 5, output)
        self.assertIn("skill/trajectory is silent", output)
        self.assertEqual(peer.stamps_ms("joint_states")[-1], 110)

    def test_names_what_is_missing_at_the_start(self):
        with FakeFramework(absent=["skill/trajectory"]) as peer:
            code, output = Simulator(response_timeout=2.0).wait()
        self.assertEqual(code, 5, output)
        self.assertIn("without publisher: /skill/trajectory;", output)
        self.assertEqual(peer.messages["joint_states"], [])

    def test_names_everything_when_it_is_alone(self):
        code, output = Simulator(response_timeout=1.0).wait()
        self.assertEqual(code, 5, output)
        for name in ("/joint_states", "/camera/image_raw", "/joint_command", "/execution/progress"):
            self.assertIn(name, output)


class StartTest(unittest.TestCase):
    def test_stays_silent_until_it_is_started(self):
        with FakeFramework() as peer:
            simulator = Simulator(paused=True, **SHORT)
            rospy.wait_for_service(NODE + "/start", timeout=20)
            time.sleep(1.5)
            self.assertEqual([name for name, log in peer.messages.items() if log], [])
            self.assertTrue(rospy.ServiceProxy(NODE + "/start", Trigger)().success)
            code, output = simulator.wait()
        self.assertEqual(code, 0, output)
        self.assertTrue(peer.messages["joint_states"])

    def test_ends_promptly_when_interrupted(self):
        for changes, peer in (({"paused": True}, False), ({"response_timeout": 60.0}, False),
                              ({"time_limit": 1000.0}, True)):
            framework = FakeFramework() if peer else None
            simulator = Simulator(**changes)
            time.sleep(3.0)
            simulator.interrupt()
            begin = time.monotonic()
            code, output = simulator.wait(20.0)
            if framework:
                framework.close()
            self.assertEqual(code, 0, output)
            self.assertLess(time.monotonic() - begin, 3.0)


class MutedFrom:
    """A publisher that says nothing from some stamp on."""

    def __init__(self, publisher, stamp):
        self.publisher, self.stamp = publisher, stamp

    def publish(self, message):
        if message.header.stamp.to_sec() < self.stamp:
            self.publisher.publish(message)

    def unregister(self):
        self.publisher.unregister()


if __name__ == "__main__":
    rospy.init_node("test_platform_sim_node", disable_signals=True)
    rostest.rosrun("platform_sim", "platform_sim_node", __name__)
