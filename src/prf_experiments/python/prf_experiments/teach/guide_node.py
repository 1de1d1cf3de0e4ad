# SPDX-License-Identifier: BSD-3-Clause
"""Node teach_guide: one guide/wrench for every joint_states, with its stamp."""
from dataclasses import fields

import geometry_msgs.msg
import rospy
import sensor_msgs.msg

from prf_experiments.record import recording, topics
from prf_experiments.teach import guide

NAME = "teach_guide"
POSES = ["ground_truth/end_effector", "ground_truth/camera", "ground_truth/tag"]
QUEUE = 200


def read_parameters() -> guide.GuideParams:
    """GuideParams from the private namespace; ValueError names what is wrong."""
    given = {name: value for name, value in rospy.get_param("~", {}).items()
             if not name.startswith("__")}
    known = [entry.name for entry in fields(guide.GuideParams)]
    for name in known:
        if name not in given:
            raise ValueError(f"{name} is not set, must be: start the node by teach.launch")
    for name in given:
        if name not in known:
            raise ValueError(f"{name} is unknown, must be among those of config/teach_guide.yaml")
    parameters = guide.GuideParams(**given)
    parameters.validate()
    return parameters


class GuideNode:
    """Joins the tick and the poses by stamp, whatever order they arrive in."""

    def __init__(self, parameters: guide.GuideParams):
        self._parameters = parameters
        self._guide: guide.Guide | None = None
        self._waiting: dict[int, dict] = {}  # stamp: {topic: message}
        self._publisher = rospy.Publisher(topics.GUIDE, geometry_msgs.msg.WrenchStamped,
                                          queue_size=QUEUE, tcp_nodelay=True)
        for topic in POSES:
            rospy.Subscriber(topic, geometry_msgs.msg.PoseStamped, self._receive,
                             callback_args=topic, queue_size=QUEUE, tcp_nodelay=True)
        rospy.Subscriber("joint_states", sensor_msgs.msg.JointState, self._receive,
                         callback_args="joint_states", queue_size=QUEUE, tcp_nodelay=True)

    def _receive(self, message, topic):
        stamp = message.header.stamp
        together = self._waiting.setdefault(stamp.to_nsec(), {})
        together[topic] = message
        if len(together) <= len(POSES):
            return
        for older in [key for key in self._waiting if key <= stamp.to_nsec()]:
            del self._waiting[older]
        self._publish(stamp, together)

    def _publish(self, stamp, together):
        hand, camera, tag = (recording.pose_values(together[topic].pose) for topic in POSES)
        if self._guide is None:
            self._guide = guide.Guide(self._parameters, stamp.to_sec(), hand, camera, tag)
        force, torque = self._guide.wrench(stamp.to_sec(), hand)
        message = geometry_msgs.msg.WrenchStamped()
        message.header.stamp = stamp
        message.header.frame_id = together[POSES[0]].header.frame_id
        message.wrench.force = geometry_msgs.msg.Vector3(*force)
        message.wrench.torque = geometry_msgs.msg.Vector3(*torque)
        self._publisher.publish(message)


def main() -> int:
    rospy.init_node(NAME)
    try:
        node = GuideNode(read_parameters())
    except ValueError as error:
        rospy.logfatal("parameter %s", error)
        return 2
    rospy.spin()
    del node
    return 0
