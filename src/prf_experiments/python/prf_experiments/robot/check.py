# SPDX-License-Identifier: BSD-3-Clause
"""The bring-up check: is everything there that the framework needs of a robot?"""
import sys
import time

import genpy
import rosgraph
import rospy
import sensor_msgs.msg
import std_msgs.msg
import tf2_ros

from prf_experiments import robots
from prf_experiments.robot.findings import Expected, Finding, Heard, of_camera, of_topic
from prf_experiments.run import arguments as args
from prf_experiments.run import names

JOINT_STATE, IMAGE, CAMERA_INFO = "sensor_msgs/JointState", "sensor_msgs/Image", "sensor_msgs/CameraInfo"
CLASSES = {JOINT_STATE: sensor_msgs.msg.JointState, IMAGE: sensor_msgs.msg.Image,
           CAMERA_INFO: sensor_msgs.msg.CameraInfo}
ROBOT = robots.load()  # the one that is checked
AGAIN = 2.0  # s between two checks while something is red


def topic():
    def parse(text):
        if not text or not all(letter.isalnum() or letter in "_/~" for letter in text):
            raise ValueError
        return text
    return {"valid": "name of ROS", "parse": parse}


ARGUMENTS = {
    "driver": args.Argument("", **args.choice("", *names.driver_names()),
                            meaning="of the arm; the parameters `driver` of the launch file come first"),
    "joint_states": args.Argument("joint_states", **topic(), meaning="topic of the control ticks"),
    "camera": args.Argument("camera", **topic(), meaning="namespace of image_raw and camera_info"),
    "seconds": args.Argument(3.0, **args.number(0.5, 60.0), meaning="s to listen"),
    "announce": args.Argument(False, **args.boolean(),
                              meaning="true: check until all is green, and let driver_adapter move the arm then"),
}


class Listener:
    """Keeps what comes on the topics until it is closed."""

    def __init__(self, expected: list[Expected], types: dict[str, str]):
        self.heard = {one.topic: Heard(kind=types.get(one.topic, "")) for one in expected}
        self.newest: dict[str, genpy.Message] = {}
        self._subscribers = [
            rospy.Subscriber(one.topic, CLASSES[one.kind], self._receive, one.topic, queue_size=1000)
            for one in expected if types.get(one.topic) == one.kind]

    def _receive(self, message, topic):
        heard = self.heard[topic]
        heard.arrivals.append(rospy.get_time())
        heard.stamps.append(message.header.stamp.to_sec())
        heard.frames.add(message.header.frame_id)
        heard.joints.update(getattr(message, "name", ()))
        heard.publishers = sorted({*heard.publishers, message._connection_header["callerid"]})
        self.newest[topic] = message

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()


def expectations(values: dict, driver: dict) -> list[Expected]:
    rate = 1.0 / float(driver.get("period", names.driver_period(values["driver"])))
    joints = tuple(str(driver.get("joints", "")).split()) or ROBOT.joints
    camera = rospy.resolve_name(values["camera"])
    return [Expected(rospy.resolve_name(values["joint_states"]), JOINT_STATE, rate, 0.05, joints=joints),
            Expected(camera + "/image_raw", IMAGE, 30.0, 0.15, frame=ROBOT.camera_frame),
            Expected(camera + "/camera_info", CAMERA_INFO, 30.0, 0.15, frame=ROBOT.camera_frame)]


def of_driver(master: rosgraph.Master, driver: dict) -> list[Finding]:
    """Whether somebody takes the commands, and whether the driver can be stopped."""
    if not driver:
        return []
    _, subscribers, services = master.getSystemState()
    topic, service = driver["command_topic"], driver["stop_service"]
    takers = dict(subscribers).get(topic, [])
    found = [Finding(topic, bool(takers), f"taken by {', '.join(takers)}" if takers else "nobody takes the commands",
                     "start the driver; ros_control: switch to the controller of this topic")]
    if service:
        offered = service in dict(services)
        found.append(Finding(service, offered, "offered" if offered else "not offered",
                             "start the driver; without it ~stop can only hold the arm"))
    return found


def of_frames(patience: float) -> Finding:
    """Whether tf leads from the arm's base to the camera."""
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    try:
        buffer.lookup_transform(ROBOT.base_link, ROBOT.camera_frame, rospy.Time(0), rospy.Duration(patience))
        return Finding("tf", True, f"{ROBOT.base_link} to {ROBOT.camera_frame}")
    except tf2_ros.TransformException as error:
        return Finding("tf", False, str(error).splitlines()[0][:120],
                       "robot_state_publisher needs joint_states with the arm's joints, and robot_description")
    finally:
        listener.unregister()


def driver_of(master: rosgraph.Master) -> dict:
    """The block `driver` of the launch file. rospy would take the argument driver:= for a remapping."""
    try:
        return dict(master.getParam(rospy.get_namespace() + "driver"))
    except rosgraph.MasterException:
        return {}


def check(values: dict) -> list[Finding]:
    """Listens, and says of each thing whether it is as it must be."""
    master = rosgraph.Master(rospy.get_name())
    driver = driver_of(master)
    expected = expectations(values, driver)
    listener = Listener(expected, dict(master.getTopicTypes()))
    rospy.sleep(values["seconds"])
    listener.close()
    found = [finding for one in expected
             for finding in of_topic(one, listener.heard[one.topic], values["seconds"])]
    image, info = (listener.newest.get(one.topic) for one in expected[1:])
    if image is not None and info is not None:
        found.append(of_camera(info.K, info.D, (info.width, info.height), (image.width, image.height)))
    return [*found, *of_driver(master, driver), of_frames(2.0)]


def told(found: list[Finding]) -> bool:
    """Prints the findings. Whether all are green."""
    print("\n".join(finding.line() for finding in found))
    red = sum(not finding.green for finding in found)
    print(f"{red} of {len(found)} are red: nothing shall move" if red else f"all {len(found)} are green", flush=True)
    return red == 0


def announce(values: dict) -> int:
    """Checks until all is green; driver_adapter holds the arm until then."""
    publisher = rospy.Publisher("driver_adapter/check", std_msgs.msg.String, queue_size=1, latch=True)
    while not rospy.is_shutdown():
        found = check(values)
        red = [finding for finding in found if not finding.green]
        publisher.publish("; ".join(f"{finding.about}: {finding.text}" for finding in red)[:200])
        if told(found):
            rospy.spin()  # the message is latched
            return 0
        time.sleep(AGAIN)
    return 1


def main(words: list[str]) -> int:
    words = [word for word in words if not word.startswith("__")]  # of roslaunch
    if any(word in ("-h", "--help") for word in words):
        print("usage: check_robot [name:=value ...]\n" + args.usage(ARGUMENTS))
        return 0
    try:
        values = args.parse(words, ARGUMENTS)
    except args.ArgumentError as error:
        print(f"check_robot: {error}", file=sys.stderr)
        return 2
    if not rosgraph.is_master_online():
        print("check_robot: no ROS master: start roscore, or set ROS_MASTER_URI", file=sys.stderr)
        return 1
    rospy.init_node("check_robot", anonymous=not values["announce"], argv=["check_robot"])
    if values["announce"]:
        return announce(values)
    return 0 if told(check(values)) else 1
