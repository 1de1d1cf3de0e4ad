# SPDX-License-Identifier: BSD-3-Clause
"""The session's own node: describes the run for the bag, starts it, watches it."""
import json
from typing import Any

import numpy as np
import rosgraph.xmlrpc
import roslib.message
import rospy
import std_msgs.msg
import std_srvs.srv

from prf_experiments.judge import judge
from prf_experiments.record import recording, topics
from prf_experiments.run.session import SessionError

NAME = "session_observer"
SHOWN = ("execution/progress", "ground_truth/tag", "ground_truth/camera")
TYPES = {"/" + name: roslib.message.get_message_class(topics.TABLE.type_of(name))
         for name in SHOWN}


class EndingServer(rosgraph.xmlrpc.ThreadingXMLRPCServer):
    """The server of rospy's node, whose loop ends when it is closed.

    rospy closes the socket only: the loop then polls what is no socket, and takes a whole processor
    until the process ends.
    """

    def server_close(self) -> None:
        super().server_close()
        self.shutdown()


rosgraph.xmlrpc.ThreadingXMLRPCServer = EndingServer


class Observer:
    def __init__(self, description: dict | None = None):
        rospy.init_node(NAME, disable_signals=True, log_level=rospy.ERROR)
        if description is not None:
            self._publisher = rospy.Publisher("/" + topics.DESCRIPTION, std_msgs.msg.String,
                                              latch=True, queue_size=1)
            self._publisher.publish(json.dumps(description, sort_keys=True))
        self._latest: dict[str, bytes] = {}
        self._start = None
        for topic in TYPES:  # kept raw, decoded only when a line is shown
            rospy.Subscriber(topic, rospy.AnyMsg, self._keep, callback_args=topic, queue_size=1)

    def _keep(self, message, topic):
        self._latest[topic] = message._buff

    def _decode(self, topic):
        return TYPES[topic]().deserialize(self._latest[topic]) if topic in self._latest else None

    def call(self, service: str, kind: type = std_srvs.srv.Trigger, **request: Any) -> None:
        """Calls a service that answers with success and message."""
        try:
            rospy.wait_for_service(service, timeout=20.0)
            response = rospy.ServiceProxy(service, kind)(**request)
        except (rospy.ROSException, rospy.ServiceException) as error:
            raise SessionError(f"{service} failed: {error}") from None
        if not response.success:
            raise SessionError(f"{service} refused: {response.message}")

    def status(self, wall: float) -> str:
        """One line of text on the run, `wall` s after its start."""
        progress, tag, camera = (self._decode(topic) for topic in TYPES)
        if tag is None or camera is None:
            return "waiting for the first tick"
        stamp = tag.header.stamp.to_sec()
        self._start = stamp if self._start is None else self._start
        lateral, along = judge.tag_in_camera(
            np.array([recording.pose_values(camera.pose)]),
            np.array([recording.pose_values(tag.pose)]))
        state = judge.STATES[progress.state] if progress else ""
        seconds = stamp - self._start
        return (f"{seconds:5.1f} s  {state:<8}  tag {1e3 * lateral[0]:4.0f} mm off the axis, "
                f"{1e3 * along[0]:4.0f} mm away  ({seconds / max(wall, 1e-3):.2f} x real time)")

    def close(self) -> None:
        rospy.signal_shutdown("session over")
