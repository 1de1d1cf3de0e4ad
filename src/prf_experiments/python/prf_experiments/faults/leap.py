# SPDX-License-Identifier: BSD-3-Clause
"""A leap of the robot's clock: everything that the framework hears is stamped anew from then on.

The framework's nodes live in the leaping time: they hear faulty/TOPIC, and what they say goes to
leapt/TOPIC. From there it comes back to simulator, recorder and judge with the stamps of the data
that it is about, so that they need not know of the leap.
"""
import functools
import threading
from collections.abc import Callable
from typing import Any

import genpy
import rosgraph_msgs.msg
import roslib.message
import rospy

from prf_experiments.faults import effects
from prf_experiments.faults.catalogue import SENSED, Fault
from prf_experiments.record import topics

QUEUE = 1000
KEPT = 20000  # stamps, several minutes


def _time(stamp):
    return genpy.Time(stamp // effects.SECOND, stamp % effects.SECOND)


class Leap:
    def __init__(self, fault: Fault, tell: Callable[[Fault, int, str], None]):
        self._fault, self._tell = fault, tell
        self._lock = threading.Lock()
        self._start: int | None = None
        self._leapt = False
        self._true: dict[int, int] = {}  # {stamp after the leap: stamp of the data}
        for topic in SENSED:
            kind = roslib.message.get_message_class(topics.TABLE.type_of(topic))
            out = rospy.Publisher("faulty/" + topic, kind, queue_size=QUEUE, tcp_nodelay=True)
            rospy.Subscriber(topic, kind, functools.partial(self._sensed, out), queue_size=QUEUE,
                             tcp_nodelay=True)
        self._clock = rospy.Publisher("/faulty/clock", rosgraph_msgs.msg.Clock, queue_size=QUEUE)
        rospy.Subscriber("/clock", rosgraph_msgs.msg.Clock, self._time_of_day, queue_size=QUEUE)
        for topic in topics.OUTPUTS:
            kind = roslib.message.get_message_class(topics.TABLE.type_of(topic))
            out = rospy.Publisher(topic, kind, queue_size=QUEUE, tcp_nodelay=True)
            rospy.Subscriber("leapt/" + topic, kind, functools.partial(self._said, out),
                             queue_size=QUEUE, tcp_nodelay=True)

    def _moved(self, stamp: int) -> int:
        """The stamp as the framework gets it; in the trial's first tick nothing has leapt yet."""
        with self._lock:
            if self._start is None:
                self._start = stamp
            if (stamp - self._start) / effects.SECOND < self._fault.begin:
                moved = stamp
            else:
                if not self._leapt:
                    self._leapt = True
                    self._tell(self._fault, stamp, f"clocks leap by {self._fault.amount:g} s")
                moved = max(1, stamp + round(effects.SECOND * self._fault.amount))
            self._true[moved] = stamp
            while len(self._true) > KEPT:
                del self._true[next(iter(self._true))]
            return moved

    def _sensed(self, out, message):
        message.header.stamp = _time(self._moved(message.header.stamp.to_nsec()))
        out.publish(message)

    def _time_of_day(self, message):
        self._clock.publish(_time(self._moved(message.clock.to_nsec())))

    def _said(self, out, message: Any):
        with self._lock:
            stamp = self._true.get(message.header.stamp.to_nsec())
        if stamp is not None:
            message.header.stamp = _time(stamp)
            out.publish(message)
