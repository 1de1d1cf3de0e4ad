# SPDX-License-Identifier: BSD-3-Clause
"""Who hears whom, and what is recorded, when faults stand between the nodes."""
from collections.abc import Sequence

from prf_experiments.faults import catalogue
from prf_experiments.faults.catalogue import Fault

INJECTOR, SECOND, SIMULATOR = "/fault_injector", "/second_publisher", "/platform_sim"
Link = tuple[str, str, str]  # topic, publisher, subscriber


def rewired(links: set[Link], faults: Sequence[Fault]) -> set[Link]:
    """The links of a trial with its faults: readers of a faulty topic hear the injector."""
    relayed = {"/" + topic for topic in catalogue.relayed(faults)}
    leaping = any(fault.name == "clock" for fault in faults)
    doubled = {"/" + fault.topic for fault in faults if fault.name == "second"}
    ours = [INJECTOR] + ([SECOND] if doubled else [])
    found: set[Link] = {("/joint_states", SIMULATOR, node) for node in ours}
    for topic, publisher, subscriber in links:
        to_simulator = subscriber == SIMULATOR
        if subscriber == "/recorder":
            found.add((topic, publisher, subscriber))
        elif topic in relayed and (not to_simulator or topic == "/joint_command"):
            for node in ours if topic in doubled else [INJECTOR]:
                found |= {(topic, publisher, node), ("/faulty" + topic, node, subscriber)}
        elif leaping and topic not in ("/tf", "/tf_static"):
            found.add(("/leapt" + topic, publisher, INJECTOR))
            found.add((topic, INJECTOR, subscriber) if to_simulator
                      else ("/leapt" + topic, publisher, subscriber))
        else:
            found.add((topic, publisher, subscriber))
    return found | {("/" + topic, INJECTOR, "/recorder") for topic in recorded(faults)}


def replayed(links: set[Link], faults: Sequence[Fault], player: str) -> set[Link]:
    """The links of a replay: faulty topics come from the bag, as they came in the trial."""
    relayed = {"/" + topic for topic in catalogue.relayed(faults)}
    return {("/faulty" + topic, player, subscriber) if topic in relayed
            else (topic, publisher, subscriber) for topic, publisher, subscriber in links}


def recorded(faults: Sequence[Fault]) -> list[str]:
    """Topics that a bag holds beside those of every trial."""
    return ["faulty/" + topic for topic in catalogue.relayed(faults)]
