# SPDX-License-Identifier: BSD-3-Clause
"""Starts a trial that was launched by hand, and ends it: the node trial_starter of trial.launch.

It starts the simulator when every publisher is connected to every subscriber, however busy the
machine is; what is published before is lost. When the simulator has ended, it has roslaunch end.
"""
import contextlib
import os
import signal
import time
import xmlrpc.client

import rosgraph
import rospy
import std_srvs.srv

from prf_experiments.faults import catalogue, wiring
from prf_experiments.run import connections

SIMULATOR = "platform_sim"
CONNECT_TIMEOUT = 60.0  # s
PERIOD = 0.2  # s
EXIT_FAILED = 1


def wait_until_connected(master: rosgraph.Master, links: set[connections.Link]) -> str:
    """Why it cannot begin, or an empty string. Returns when all links are there, and stay."""
    end, quiet = time.monotonic() + CONNECT_TIMEOUT, 0
    while quiet < 2:
        if rospy.is_shutdown():
            return "stopped before it began"
        absent = connections.missing(master, links)
        quiet = 0 if absent else quiet + 1
        if absent and time.monotonic() > end:
            topic, publisher, subscriber = sorted(absent)[0]
            return (f"not connected after {CONNECT_TIMEOUT:g} s: {topic} from {publisher} to "
                    f"{subscriber} ({len(absent)} links missing)")
        time.sleep(PERIOD)
    return ""


def is_there(master: rosgraph.Master, node: str) -> bool:
    try:
        address = master.lookupNode("/" + node)
        xmlrpc.client.ServerProxy(address).getPid(connections.CALLER)
    except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
        return False
    return True


def end_launch() -> None:
    """Has the roslaunch that started this process end as by Ctrl-C."""
    parent = os.getppid()
    with contextlib.suppress(OSError), open(f"/proc/{parent}/cmdline", "rb") as stream:
        if b"roslaunch" in stream.read():
            os.kill(parent, signal.SIGINT)


def main() -> int:
    rospy.init_node("trial_starter")
    faults = catalogue.parse(rospy.get_param("~fault", ""))
    links = connections.trial_links(SIMULATOR)
    master = rosgraph.Master(connections.CALLER)
    reason = wait_until_connected(master, wiring.rewired(links, faults) if faults else links)
    if not reason:
        try:
            answer = rospy.ServiceProxy(f"/{SIMULATOR}/start", std_srvs.srv.Trigger)()
            reason = "" if answer.success else answer.message
        except rospy.ServiceException as error:
            reason = str(error)
    if reason:
        rospy.logfatal("the trial does not begin: %s", reason)
        end_launch()
        return EXIT_FAILED
    while not rospy.is_shutdown() and is_there(master, SIMULATOR):
        time.sleep(PERIOD)
    if not rospy.is_shutdown():
        rospy.loginfo("the simulator has ended, and the trial with it")
        end_launch()
        rospy.spin()  # until roslaunch ends this node as it ends the others
    return 0
