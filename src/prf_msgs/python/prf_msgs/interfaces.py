# SPDX-License-Identifier: BSD-3-Clause
"""The table of topics, interfaces.yaml, and the lists that follow from it."""
import math
import os
from dataclasses import dataclass
from typing import Any

import yaml

KINDS = ("clock", "sensor", "surroundings", "ground_truth", "output", "transform", "exempt",
         "description", "teaching")
PATH_IN_SOURCES = os.path.join(os.path.dirname(__file__), "..", "..", "interfaces.yaml")


class InterfaceError(ValueError):
    """The table is not well formed; the message says where and why."""


@dataclass(frozen=True)
class Topic:
    """One row; the meaning of the columns stands at the top of interfaces.yaml."""
    name: str  # as in the table, global names with their slash
    type: str
    kind: str
    senders: tuple
    readers: tuple
    unit: str
    frame: str
    meaning: str
    recorded: bool
    latched: bool
    simulator: str = ""
    also: tuple = ()

    @property
    def bare_name(self):
        """The name without a leading slash."""
        return self.name.lstrip("/")

    def __post_init__(self):
        def check(holds, what):
            if not holds:
                raise InterfaceError(f"{self.name}: {what}")
        check(self.kind in KINDS, f"kind = {self.kind}, must be one of {', '.join(KINDS)}")
        check(self.simulator in ("", "content", "stamp"),
              f"simulator = {self.simulator}, must be content or stamp")
        check(self.senders, "must have a sender")
        check(self.type.count("/") == 1, f"type = {self.type}, must be package/Type")
        check(self.meaning, "must have a meaning")


@dataclass(frozen=True)
class Node:
    """A step of the data flow, and the package where its node lives."""
    step: str
    name: str
    package: str
    shown: str = ""  # for people; empty: the name


def _with_tuples(row: dict[str, Any]) -> dict[str, Any]:
    return {key: tuple(value) if isinstance(value, list) else value for key, value in row.items()}


class Interfaces:
    """The whole table. Names in its lists have no leading slash unless a list says so."""

    def __init__(self, content: dict[str, Any]):
        try:
            self.topics = [Topic(**_with_tuples(row)) for row in content["topics"]]
            self.nodes = [Node(**row) for row in content["nodes"]]
        except TypeError as error:
            raise InterfaceError(f"interfaces.yaml: {error}") from None
        self.actions, self.services = content["actions"], content["services"]
        names = [topic.bare_name for topic in self.topics]
        doubled = sorted({name for name in names if names.count(name) > 1})
        if doubled:
            raise InterfaceError("interfaces.yaml has twice: " + ", ".join(doubled))
        self.fallen_height = float(content["fall"]["height"])  # m
        self.fallen_tilt = math.radians(content["fall"]["tilt_deg"])

    def of_kind(self, *kinds, recorded=True):
        """Names of the kinds; `recorded`: only of the topics in a trial's bag."""
        return [topic.bare_name for topic in self.topics
                if topic.kind in kinds and (topic.recorded or not recorded)]

    @property
    def recorded(self):
        """Everything in a trial's bag, in the order in which the recorder subscribes."""
        return [topic.bare_name for topic in self.topics if topic.recorded]

    @property
    def framework_flow(self):
        """{"/topic": (sender, readers)} of what the nodes of the framework send while they run."""
        return {"/" + topic.bare_name: (topic.senders[0], list(topic.readers))
                for topic in self.topics
                if topic.kind in ("output", "transform") and not topic.latched}

    @property
    def sensor_readers(self):
        """{"/topic": readers} of the sensors."""
        return {"/" + topic.bare_name: list(topic.readers) for topic in self.topics
                if topic.kind == "sensor"}

    @property
    def simulator_inputs(self):
        """"/topic" of the framework's outputs whose content the simulator uses."""
        return ["/" + topic.bare_name for topic in self.topics
                if topic.kind == "output" and topic.simulator == "content"]

    @property
    def framework_nodes(self):
        """Names of the nodes between world and recorder, in the order of the data."""
        return [node.name for node in self.nodes if node.name not in ("world", "recorder")]

    def named(self, name):
        return next(topic for topic in self.topics if topic.bare_name == name.lstrip("/"))

    def type_of(self, name):
        """package/Type of a topic."""
        return self.named(name).type


def load(path=None):
    """The table of this package, or of another file. Raises InterfaceError."""
    if path is None:
        path = PATH_IN_SOURCES
        if not os.path.exists(path):
            import rospkg  # the installed module lies elsewhere than the table
            path = os.path.join(rospkg.RosPack().get_path("prf_msgs"), "interfaces.yaml")
    with open(path, encoding="utf-8") as file:
        return Interfaces(yaml.safe_load(file))
