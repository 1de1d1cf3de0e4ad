# SPDX-License-Identifier: BSD-3-Clause
"""The node that gives a trial its faults.

It passes the faulty topics on to their readers as faulty/TOPIC, kills and stops nodes, and tells on
fault/events what it does, as JSON. When something happens follows from the stamps of the data.
"""
import functools
import json
import threading
from typing import Any

import genpy
import geometry_msgs.msg
import roslib.message
import rospy
import std_msgs.msg
import tf2_msgs.msg

from prf_experiments.faults import catalogue, effects, victims
from prf_experiments.record import topics

EVENTS = "fault/events"
QUEUE = 1000
FOREIGN_PERIOD = 3  # ticks


def faulty(topic: str) -> str:
    return "faulty/" + topic


def message_class(topic: str) -> Any:
    return roslib.message.get_message_class(topics.TABLE.type_of(topic))


def _name(topic):
    return "/" + topic if topic in ("tf", "clock") else topic


class Injector:
    def __init__(self, faults: list[catalogue.Fault], seed: int):
        self._lock = threading.RLock()
        self._start: int | None = None
        self._events = rospy.Publisher(EVENTS, std_msgs.msg.String, queue_size=QUEUE)
        self._nodes = victims.Victims(
            [fault for fault in faults if fault.node or fault.name == "disk"], self.tell)
        self._channels: dict[str, effects.Channel] = {}
        self._out: dict[str, rospy.Publisher] = {}
        self._foreign = [fault for fault in faults if fault.name == "foreign_tf"]
        self._ticks = 0
        if self._foreign:
            self._tf = rospy.Publisher("/tf", tf2_msgs.msg.TFMessage, queue_size=QUEUE)
        clock = next((fault for fault in faults if fault.name == "clock"), None)
        if clock is not None:
            from prf_experiments.faults.leap import Leap
            self._leap = Leap(clock, self.tell)
        else:
            for topic in catalogue.relayed(faults):
                self._relay(topic, [fault for fault in faults if fault.topic == topic], seed)
        # The relay of joint_states keeps the time itself, before it passes a tick on.
        rospy.Subscriber("joint_states", message_class("joint_states"), self._tick,
                         queue_size=QUEUE, tcp_nodelay=True)

    def _relay(self, topic, faults, seed):
        kind = message_class(topic)
        self._channels[topic] = effects.Channel(faults, seed, self.tell)
        self._out[topic] = rospy.Publisher(faulty(topic), kind, queue_size=QUEUE, tcp_nodelay=True,
                                            latch=topics.TABLE.named(topic).latched)
        if topic != "joint_states":
            rospy.Subscriber(_name(topic), kind, functools.partial(self._take, topic),
                             queue_size=QUEUE, tcp_nodelay=True)

    def tell(self, fault: catalogue.Fault, stamp: int, what: str = "") -> None:
        self._events.publish(json.dumps({"stamp": stamp, "fault": fault.word, "what": what}))

    def _take(self, topic, message):
        with self._lock:
            start = self._start if self._start is not None else effects.stamp_of(message)
            for one in self._channels[topic].take(message, start):
                self._out[topic].publish(one)

    def _tick(self, message):
        stamp = message.header.stamp.to_nsec()
        with self._lock:
            if self._start is None:
                self._start = stamp
            self._nodes.tick(stamp, (stamp - self._start) / effects.SECOND)
            for topic, channel in self._channels.items():
                if topic != "joint_states":
                    for one in channel.due(stamp):
                        self._out[topic].publish(one)
            if "joint_states" in self._channels:
                self._take("joint_states", message)
            self._ticks += 1
            if self._ticks % FOREIGN_PERIOD == 0:
                self._publish_foreign(stamp)

    def _publish_foreign(self, stamp):
        for fault in self._foreign:
            if not fault.acts_at((stamp - self._start) / effects.SECOND):
                continue
            moved = min(max(stamp + round(effects.SECOND * fault.amount), 0), effects.LAST)
            transform = geometry_msgs.msg.TransformStamped()
            transform.header.stamp = genpy.Time(moved // effects.SECOND, moved % effects.SECOND)
            transform.header.frame_id, transform.child_frame_id = "map", "odom"
            transform.transform.rotation.w = 1.0
            self._tf.publish(tf2_msgs.msg.TFMessage([transform]))
            self.tell(fault, stamp)

    def close(self) -> None:
        self._nodes.close()


class SecondPublisher:
    """Another node that publishes a copy of each message to the readers of a topic."""

    def __init__(self, faults: list[catalogue.Fault]):
        self._start: int | None = None
        for fault in faults:
            if fault.name == "second":
                kind = message_class(fault.topic)
                out = rospy.Publisher(faulty(fault.topic), kind, queue_size=QUEUE, tcp_nodelay=True)
                rospy.Subscriber(_name(fault.topic), kind, functools.partial(self._take, fault, out),
                                 queue_size=QUEUE, tcp_nodelay=True)
        self._events = rospy.Publisher(EVENTS, std_msgs.msg.String, queue_size=QUEUE)
        rospy.Subscriber("joint_states", message_class("joint_states"), self._tick,
                         queue_size=QUEUE, tcp_nodelay=True)

    def _tick(self, message):
        self._start = message.header.stamp.to_nsec() if self._start is None else self._start

    def _take(self, fault, out, message):
        stamp = effects.stamp_of(message)
        if self._start is not None and fault.acts_at((stamp - self._start) / effects.SECOND):
            out.publish(effects.shifted(message, round(effects.SECOND * fault.amount)))
            self._events.publish(json.dumps({"stamp": stamp, "fault": fault.word, "what": ""}))


def main(words: list[str]) -> int:
    second = "--second" in words
    rospy.init_node("second_publisher" if second else "fault_injector")
    try:
        faults = catalogue.parse(rospy.get_param("~fault"))
        seed = int(rospy.get_param("~seed"))
    except (catalogue.FaultError, KeyError, ValueError) as error:
        rospy.logfatal("%s", error)
        return 2
    if second:
        SecondPublisher(faults)
        rospy.spin()
        return 0
    injector = Injector(faults, seed)
    try:
        rospy.spin()
    finally:
        injector.close()
    return 0
