# SPDX-License-Identifier: BSD-3-Clause
"""Which node publishes what to whom, and whether those pairs are really connected."""
import http.client
import xmlrpc.client
from typing import Any

import rosgraph

from prf_experiments.record.topics import TABLE

Link = tuple[str, str, str]  # topic, publisher, subscriber
CALLER = "/prf_experiments"
TIMEOUT = 5.0  # s for one answer of a node

def trial_links(source: str, simulated: bool = True) -> set[Link]:
    """(topic, publisher, subscriber) without which nothing goes.

    `source` is the node that publishes the sensor topics.
    """
    links = [(topic, publisher, subscriber)
             for topic, (publisher, subscribers) in TABLE.framework_flow.items()
             for subscriber in subscribers]
    links += [(topic, source, subscriber)
              for topic, subscribers in TABLE.sensor_readers.items() for subscriber in subscribers]
    if simulated:
        links += [(topic, TABLE.framework_flow[topic][0], source)
                  for topic in TABLE.simulator_inputs]
    return {(topic, "/" + publisher, "/" + subscriber) for topic, publisher, subscriber in links}


def through_driver(links: set[Link], source: str) -> set[Link]:
    """The links of a trial whose arm is moved by a driver: joint_states come from the joiner."""
    joint_states, command = "/joint_states", "/joint_command"
    changed = {(topic, "/joint_state_joiner" if topic == joint_states and publisher == "/" + source
                else publisher, subscriber) for topic, publisher, subscriber in links}
    return changed | {(command, "/" + TABLE.framework_flow[command][0], "/driver_adapter"),
                      (joint_states, "/joint_state_joiner", "/driver_adapter")}


def of_rehearsal(links: set[Link], source: str) -> set[Link]:
    """The links of a framework whose arm is a stand-in: decision and controller get its joint_states."""
    joint_states, readers = "/joint_states", ("/decision", "/arm_controller")
    kept = {link for link in links if not (link[0] == joint_states and link[2] in readers)}
    return (kept | {("/rehearsal/joint_states", "/stand_in_arm", reader) for reader in readers}
            | {(joint_states, "/" + source, "/stand_in_arm"), ("/joint_command", "/arm_controller", "/stand_in_arm")})


class _Transport(xmlrpc.client.Transport):
    def make_connection(self, host):
        return http.client.HTTPConnection(host, timeout=TIMEOUT)


def registered(master: rosgraph.Master) -> set[Link]:
    """(topic, publisher, subscriber) for every pair that the master knows."""
    publishers, subscribers, _ = master.getSystemState()
    publishing = dict(publishers)
    return {(topic, publisher, subscriber)
            for topic, listening in subscribers for subscriber in listening
            for publisher in publishing.get(topic, []) if publisher != subscriber}


def subscriptions(master: rosgraph.Master) -> dict[str, set[str]]:
    """{node: set of topics} of all subscribers that the master knows."""
    result: dict[str, set[str]] = {}
    for topic, nodes in master.getSystemState()[1]:
        for node in nodes:
            result.setdefault(node, set()).add(topic)
    return result


def established(master: rosgraph.Master, publishers: set[str]) -> set[Link]:
    """(topic, publisher, subscriber) for every link that one of the publishers really serves."""
    links = set()
    for publisher in publishers:
        node = xmlrpc.client.ServerProxy(master.lookupNode(publisher), transport=_Transport())
        connections: Any = node.getBusInfo(CALLER)[2]  # type: ignore[index]
        links |= {(entry[4], publisher, entry[1]) for entry in connections if entry[2] == "o"}
    return links


def missing(master: rosgraph.Master, required: set[Link]) -> set[Link]:
    """Links that are required or registered but not established; empty when all is connected."""
    wanted = set(required)
    try:
        wanted |= registered(master)
        publishers = {link[1] for link in wanted}
        known = {node for _, nodes in master.getSystemState()[0] for node in nodes}
        return wanted - established(master, publishers & known)
    except (OSError, rosgraph.MasterException, xmlrpc.client.Error, http.client.HTTPException):
        return wanted
