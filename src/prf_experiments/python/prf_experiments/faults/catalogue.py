# SPDX-License-Identifier: BSD-3-Clause
"""The faults that a trial can be given: names, amounts, times. Imports no ROS.

    fault:=NAME[/TARGET][:AMOUNT][@TIME[-END]][,...]

TIME and END are seconds of the trial's data. What lasts begins at TIME (0) and ends at END (with the
trial); what happens once happens at TIME (5). `+` separates faults, too, where a comma separates
values.
"""
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from prf_experiments.run.arguments import meant

TOPICS = ("joint_states", "camera/image_raw", "camera/camera_info", "tag_detections", "tf",
          "target/forecast", "obstacles", "skill/trajectory", "execution/progress",
          "execution/setpoint", "joint_command", "control/status", "speed_scale")
NODES = ("robot_state_publisher", "tag_detector", "target_predictor", "decision", "skill_planner",
         "arm_controller", "platform_sim", "recorder")
SENSED = ("joint_states", "camera/image_raw", "camera/camera_info")
ONCE_AT = 5.0  # s
LONGEST = 86400.0  # s, of any trial
END_OF_TIME = 4294967295.0  # s, the last second that a ROS time can hold


class FaultError(ValueError):
    """This is no fault; the message says what is valid."""


@dataclass(frozen=True)
class Kind:
    amount: float
    low: float
    high: float
    unit: str
    meaning: str
    target: Sequence[str] = ()  # what it can be done to, empty: nothing to choose
    topic: str = ""  # the topic that it is done to, where there is nothing to choose
    lasts: bool = True


def _share(amount: float, meaning: str) -> Kind:
    return Kind(amount, 0.0, 1.0, "share of the messages", meaning, TOPICS)


KINDS = {
    "drop": _share(1.0, "messages are lost"),
    "delay": Kind(0.1, 0.001, 60.0, "s of data time", "messages come later", TOPICS),
    "duplicate": _share(1.0, "messages come twice"),
    "reorder": _share(0.2, "messages come after the next one"),
    "nan": _share(1.0, "one number of a message is not a number"),
    "huge": _share(1.0, "one number of a message is 1e300"),
    "bits": _share(1.0, "one bit of one number of a message is flipped"),
    "old": Kind(1.0, 0.001, END_OF_TIME, "s", "a copy of one message comes, stamped so much earlier",
                TOPICS, lasts=False),
    "ahead": Kind(1.0, 0.001, END_OF_TIME, "s",
                  "a copy of one message comes, stamped so much later", TOPICS, lasts=False),
    "second": Kind(0.0, -10.0, 10.0, "s, on the copies' stamps",
                   "a second node publishes a copy of each message", TOPICS),
    "kill": Kind(0.0, 0.0, 0.0, "", "the node is killed and stays away", NODES, lasts=False),
    "respawn": Kind(1.0, 0.05, 60.0, "s of data time away", "the node is killed and started again",
                    NODES, lasts=False),
    "stop": Kind(1.0, 0.05, 60.0, "s of data time", "the node is stopped, then goes on", NODES,
                 lasts=False),
    "clock": Kind(-2.0, -60.0, 3600.0, "s", "all clocks and stamps of the robot leap",
                  lasts=False),
    "false_tag": Kind(0.5, -5.0, 5.0, "m sideways", "the tag is detected elsewhere",
                  topic="tag_detections"),
    "flip": Kind(0.3, 0.0, 1.0, "share of the detections",
                 "the tag's orientation is the mirrored one", topic="tag_detections"),
    "occlusion": Kind(0.6, 0.0, 1.0, "share of the picture's width and height",
                      "something dark is before the lens", topic="camera/image_raw"),
    "exposure": Kind(10.0, 0.0, 255.0, "times the grey level", "the exposure fails",
                     topic="camera/image_raw"),
    "disk": Kind(0.0, 0.0, 0.0, "", "no file of the recorder can grow any more", lasts=False),
    "foreign_tf": Kind(-1.5, -END_OF_TIME, 10.0, "s, on its stamps",
                       "an unrelated node publishes map -> odom at 33 Hz"),
}


@dataclass(frozen=True)
class Fault:
    word: str  # as it was asked for
    name: str
    target: str
    amount: float
    begin: float  # s since the first tick
    end: float  # s, infinite: with the trial

    @property
    def kind(self) -> Kind:
        return KINDS[self.name]

    @property
    def topic(self) -> str:
        """The topic that it is done to, or an empty string."""
        return self.target if self.target in TOPICS else self.kind.topic

    @property
    def node(self) -> str:
        return self.target if self.target in NODES else ""

    def acts_at(self, seconds: float) -> bool:
        return self.begin <= seconds < self.end


_WORD = re.compile(r"(?P<name>[a-z_]+)(/(?P<target>[a-z_/]+))?(:(?P<amount>[-+.e\d]+))?"
                   r"(@(?P<begin>[.e\d]+)(-(?P<end>[.e\d]+))?)?")


def _number(text, word, low, high, what):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise FaultError(f"{word}: {what} = {text}, must be {low:g} .. {high:g}")
    return value


def parse_one(word: str) -> Fault:
    """Raises FaultError."""
    match = _WORD.fullmatch(word)
    if not match or match["name"] not in KINDS:
        raise FaultError(f"'{word}' is no fault, valid: NAME[/TARGET][:AMOUNT][@TIME[-END]] with "
                         "NAME " + "|".join(KINDS) + meant(re.split(r"[/:@]", word)[0], *KINDS))
    kind, target = KINDS[match["name"]], match["target"] or ""
    if target not in (kind.target or ("",)):
        raise FaultError(f"{word}: '{target}' is no target of {match['name']}, valid: "
                         + ("|".join(kind.target) or "none"))
    amount = kind.amount
    if match["amount"]:
        amount = _number(match["amount"], word, kind.low, kind.high,
                         "amount" + (f" ({kind.unit})" if kind.unit else ""))
    begin = 0.0 if kind.lasts else ONCE_AT
    if match["begin"]:
        begin = _number(match["begin"], word, 0.0, LONGEST, "time (s)")
    end = math.inf
    if match["end"]:
        if not kind.lasts:
            raise FaultError(f"{word}: {match['name']} happens once, it has no end")
        end = _number(match["end"], word, begin, LONGEST, "end (s)")
    return Fault(word, match["name"], target, amount, begin, end)


def parse(text: str) -> list[Fault]:
    """The faults of an argument; none for an empty one. Raises FaultError."""
    faults = [parse_one(word) for word in re.split(r"[,+](?=[a-z_])", text)] if text else []
    words = [fault.word for fault in faults]
    if len(set(words)) < len(words):
        raise FaultError(f"{text} says a fault twice")
    if any(fault.name == "clock" for fault in faults) and any(fault.topic for fault in faults):
        raise FaultError(f"{text}: clock does not go with a fault on a topic")
    return faults


def relayed(faults: Sequence[Fault]) -> list[str]:
    """Topics whose readers get them from the injector, as faulty/TOPIC."""
    if any(fault.name == "clock" for fault in faults):
        return list(SENSED)
    return [topic for topic in TOPICS if any(fault.topic == topic for fault in faults)]


def ended_nodes(faults: Sequence[Fault]) -> list[str]:
    """Nodes whose end is wanted."""
    return [fault.node for fault in faults if fault.name in ("kill", "respawn")]


def usage() -> str:
    lines = []
    for name, kind in KINDS.items():
        target = "/TOPIC" if kind.target == TOPICS else "/NODE" if kind.target else ""
        amount = (f"{kind.low:g}..{kind.high:g} {kind.unit} [{kind.amount:g}]" if kind.unit else "")
        lines.append(f"  {name + target:<16} {kind.meaning}" + (f"; {amount}" if amount else ""))
    return "\n".join([
        "faults: fault:=NAME[/TARGET][:AMOUNT][@TIME[-END]][,...], times in s of the trial's data;",
        "in a sweep commas part values, and + the faults of one value",
        *lines, "  TOPIC: " + ", ".join(TOPICS), "  NODE: " + ", ".join(NODES)])
