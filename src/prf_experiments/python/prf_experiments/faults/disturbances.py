# SPDX-License-Identifier: BSD-3-Clause
"""What is done to a trial's world from outside: names, levels, times. Imports no ROS.

    disturb:=NAME:LEVEL[@TIME][,...]

Those on robot and cart are the simulator's (platform_sim/README.md); those on the camera are the
fault injector's. A time that is not given is drawn from the trial's seed, as all else is.
"""
import random
import re
from dataclasses import dataclass

from prf_experiments.faults import catalogue
from prf_experiments.run import names
from prf_experiments.run.arguments import meant

FIRST, LAST = 3.0, 9.0  # s, of a time that is drawn
LONGEST = 86400.0  # s, of any trial
LOSES_NOTHING = ("occlusion", "exposure")  # faults that take no message away


class DisturbanceError(ValueError):
    """This is no disturbance; the message says what is valid."""


@dataclass(frozen=True)
class Kind:
    highest: float
    unit: str
    meaning: str
    fault: str = ""  # of the camera: what the fault injector does meanwhile; LEVEL is how long, s


_MEANINGS = {
    "push": ("N", "on hand or body, for 0.2..0.5 s in any direction"),
    "push_hand": ("N", "on the hand"),
    "push_body": ("N", "on the body"),
    "stumble": ("times what friction holds", "a foot is drawn aside; above 1 it slips"),
    "cart": ("m", "scenario:=cart: it is pushed aside, at most at 0.75..1.5 m/s per m"),
    "cart_toward": ("m", "scenario:=cart: it is pushed toward the robot"),
}
KINDS = {
    **{name: Kind(float(highest), *_MEANINGS[name])
       for name, highest in zip(names.of_worlds("disturbances"), names.of_worlds("highest_levels"))},
    "occlude": Kind(3.0, "s", "something passes before the camera", "occlusion:0.95"),
    "dark": Kind(3.0, "s", "the exposure fails", "exposure:0.02"),
}


@dataclass(frozen=True)
class Disturbance:
    word: str  # as it was asked for
    name: str
    level: float
    time: float | None  # s

    @property
    def kind(self) -> Kind:
        return KINDS[self.name]


_WORD = re.compile(r"(?P<name>[a-z_]+):(?P<level>[.\de-]+)(@(?P<time>[.\de]+))?")


def _number(text, word, high, what):
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= high:
        raise DisturbanceError(f"{word}: {what} = {text}, must be 0 .. {high:g}")
    return value


def parse_one(word: str) -> Disturbance:
    """Raises DisturbanceError."""
    match = _WORD.fullmatch(word)
    if not match or match["name"] not in KINDS:
        raise DisturbanceError(f"'{word}' is no disturbance, valid: NAME:LEVEL[@TIME] with NAME "
                               + "|".join(KINDS) + meant(re.split(r"[:@]", word)[0], *KINDS))
    kind = KINDS[match["name"]]
    time = _number(match["time"], word, LONGEST, "time (s)") if match["time"] else None
    return Disturbance(word, match["name"],
                       _number(match["level"], word, kind.highest, f"level ({kind.unit})"), time)


def parse(text: str) -> list[Disturbance]:
    """The disturbances of an argument; none for an empty one. Raises DisturbanceError."""
    return [parse_one(word) for word in re.split(r"[,+]", text)] if text else []


def simulated(text: str) -> str:
    """The words that the simulator acts on."""
    return ",".join(one.word for one in parse(text) if not one.kind.fault)


def moves_cart(text: str) -> bool:
    return any(one.name.startswith("cart") for one in parse(text))


def as_faults(text: str, seed: int) -> str:
    """The words that the fault injector acts on, with their times."""
    found = []
    for number, one in enumerate(parse(text)):
        if one.kind.fault and one.level > 0.0:
            drawn = random.Random(f"{seed} {number} {one.name}").uniform(FIRST, LAST)
            begin = round(drawn if one.time is None else one.time, 3)
            found.append(f"{one.kind.fault}@{begin:g}-{round(begin + one.level, 3):g}")
    return ",".join(found)


def all_faults(values: dict) -> list[catalogue.Fault]:
    """Of a trial: its faults, and what its disturbances do to the camera. Raises FaultError."""
    words = [values.get("fault") or "", as_faults(values.get("disturb") or "", values.get("seed") or 0)]
    return catalogue.parse(",".join(word for word in words if word))


def launched(values: dict) -> dict:
    """What trial.launch gets in place of `fault` and `disturb`."""
    faults = all_faults(values)
    given: dict[str, str | float] = {"fault": ",".join(fault.word for fault in faults),
                                     "disturb": simulated(values["disturb"])}
    if all(fault.name in LOSES_NOTHING for fault in faults):
        given["patience"] = 0.0  # every response comes
    return given


def usage() -> str:
    return "\n".join([
        "disturbances: disturb:=NAME:LEVEL[@TIME][,...], s of the trial's data; without TIME the seed draws it,",
        "in a sweep commas part values, and + the disturbances of one value",
        *(f"  {name:<16} {kind.meaning}; 0..{kind.highest:g} {kind.unit}" for name, kind in KINDS.items())])
