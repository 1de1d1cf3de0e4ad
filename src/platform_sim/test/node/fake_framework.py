# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for the framework that responds to every tick, and the simulator as a child process."""
import hashlib
import io
import os
import signal
import subprocess
import time

import roslib.packages
import rospkg
import rospy
import yaml
from geometry_msgs.msg import PoseStamped, WrenchStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint, MultiDOFJointTrajectory

from prf_msgs.msg import ContactArray, ExecutionProgress, SkillTrajectory, TagDetectionArray, TargetForecast

NODE = "/platform_sim"
ARM = [f"j2s7s300_joint_{i}" for i in range(1, 8)]
OUTPUTS = {
    "/clock": Clock,
    "joint_states": JointState,
    "camera/image_raw": Image,
    "camera/camera_info": CameraInfo,
    "ground_truth/platform": Odometry,
    "ground_truth/base": Odometry,
    "ground_truth/tag": PoseStamped,
    "ground_truth/camera": PoseStamped,
    "ground_truth/end_effector": PoseStamped,
    "ground_truth/contacts": ContactArray,
}
INPUTS = {
    "tag_detections": TagDetectionArray,
    "target/forecast": TargetForecast,
    "execution/progress": ExecutionProgress,
    "skill/trajectory": SkillTrajectory,
    "execution/setpoint": MultiDOFJointTrajectory,
    "joint_command": JointTrajectory,
    "guide/wrench": WrenchStamped,
}


def ready():
    """The committed robot's ready posture, rad, in which the arm starts."""
    folder = os.path.join(rospkg.RosPack().get_path("prf_robots"), "robots", config()["robot"])
    with open(os.path.join(folder, "robot.yaml"), encoding="utf-8") as file:
        return yaml.safe_load(file)["ready"]


def config():
    """The committed configuration of the node."""
    path = os.path.join(rospkg.RosPack().get_path("platform_sim"), "config", "platform_sim.yaml")
    with open(path, encoding="utf-8") as file:
        return yaml.safe_load(file)


class Simulator:
    """The node as a child process with the committed parameters and some changes to them."""

    def __init__(self, **changes):
        parameters = {**config(), **changes}
        if rospy.has_param(NODE):
            rospy.delete_param(NODE)
        rospy.set_param(NODE, {key: value for key, value in parameters.items() if value is not None})
        node = roslib.packages.find_node("platform_sim", "platform_sim_node")[0]
        self.process = subprocess.Popen([node, "__name:=" + NODE.strip("/")], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def wait(self, seconds=60.0):
        """Exit code and everything printed."""
        try:
            output, _ = self.process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            self.process.kill()
            output, _ = self.process.communicate()
            raise AssertionError("the simulator did not end:\n" + output) from None
        return self.process.returncode, output

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)


class FakeFramework:
    """Responses each question of the simulator at once; some topics can be mute from some time on."""

    def __init__(self, mute=None, mute_from=0.0, absent=(), done_at=None, forecast=False,
                 positions=None, guide=False, deaf_ticks=0, disturb=None):
        """Drops the first `deaf_ticks`; `disturb` is called with this and each stamp before its
        response, and returns whether it has responded itself."""
        self.deaf_ticks, self.disturb = deaf_ticks, disturb
        self.mute, self.mute_from = mute, mute_from
        self.done_at, self.forecast = done_at, forecast
        self.positions = positions or ready()
        self.messages: dict[str, list] = {name: [] for name in OUTPUTS}
        self.digest = {name: hashlib.sha256() for name in OUTPUTS}
        silent = set(absent) | (set(INPUTS) - {"guide/wrench"} if guide else {"guide/wrench"})
        self.publishers = {
            name: rospy.Publisher(name, kind, queue_size=100, tcp_nodelay=True)
            for name, kind in INPUTS.items() if name not in silent}
        self.subscribers = [
            rospy.Subscriber(name, kind, self.on_message, name, queue_size=1000,
                             buff_size=2 ** 24, tcp_nodelay=True)
            for name, kind in OUTPUTS.items()]

    def close(self):
        for connection in [*self.subscribers, *self.publishers.values()]:
            connection.unregister()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def run(self, **changes):
        """A run that begins when everything is connected; exit code and everything printed."""
        simulator = Simulator(paused=True, **changes)
        rospy.wait_for_service(NODE + "/start", timeout=30.0)
        deadline = time.monotonic() + 30.0
        while any(subscriber.get_num_connections() == 0 for subscriber in self.subscribers):
            if time.monotonic() > deadline:
                raise AssertionError("the simulator's topics are not all there")
            time.sleep(0.05)
        rospy.ServiceProxy(NODE + "/start", Trigger)()
        result = simulator.wait()
        time.sleep(0.5)  # for callbacks that still run
        return result

    def stamps_ms(self, name):
        return [round(message.header.stamp.to_sec() * 1000) for message in self.messages[name]]

    def on_message(self, message, name):
        self.messages[name].append(message)
        serialized = io.BytesIO()
        message.serialize(serialized)
        self.digest[name].update(serialized.getvalue())
        if name == "camera/image_raw":
            self.say("tag_detections", TagDetectionArray(header=message.header))
            self.say("target/forecast", TargetForecast(header=message.header))
        elif name == "joint_states":
            self.respond(message.header.stamp)

    def say(self, name, message):
        is_mute = name == self.mute and message.header.stamp.to_sec() >= self.mute_from
        if name in self.publishers and not is_mute:
            self.publishers[name].publish(message)

    def command(self, stamp):
        command = JointTrajectory(joint_names=list(ARM))
        command.header.stamp = stamp
        command.points = [JointTrajectoryPoint(positions=list(self.positions), velocities=[0.0] * 7)]
        return command

    def respond(self, stamp):
        if len(self.messages["joint_states"]) <= self.deaf_ticks:
            return
        if self.disturb is not None and self.disturb(self, stamp):
            return
        progress = ExecutionProgress()
        progress.header.stamp = stamp
        if self.forecast:
            progress.forecast_stamp = rospy.Time.from_sec(0.01)
        if self.done_at is not None and stamp.to_sec() >= self.done_at:
            progress.state = ExecutionProgress.DONE
        self.say("execution/progress", progress)
        setpoint = MultiDOFJointTrajectory()
        setpoint.header.stamp = stamp
        self.say("execution/setpoint", setpoint)
        self.say("joint_command", self.command(stamp))
        wrench = WrenchStamped()
        wrench.header.stamp, wrench.header.frame_id = stamp, "world"
        wrench.wrench.force.z = 5.0
        self.say("guide/wrench", wrench)
