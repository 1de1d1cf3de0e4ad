# SPDX-License-Identifier: BSD-3-Clause
"""The arguments of a trial, in one place. Imports no ROS: checked before anything is built."""
import hashlib
import os
import re
from collections.abc import Sequence

from prf_experiments import robots
from prf_experiments.faults import catalogue, disturbances
from prf_experiments.run import names
from prf_experiments.run.arguments import (
    Argument,
    ArgumentError,
    boolean,
    choice,
    choice_or_file,
    integer,
    number,
    path,
    show,
)
from prf_experiments.run.arguments import usage as arguments_usage

LONGEST_NAME = 200  # characters; a file system takes 255


def faults():
    def parse(text):
        try:
            catalogue.parse(text)
        except catalogue.FaultError as error:
            raise ArgumentError(f"invalid fault:={text}: {error}") from None
        return text
    return {"valid": "NAME[/TARGET][:AMOUNT][@TIME]", "parse": parse}


def disturbed():
    def parse(text):
        try:
            disturbances.parse(text)
        except disturbances.DisturbanceError as error:
            raise ArgumentError(f"invalid disturb:={text}: {error}") from None
        return text
    return {"valid": "NAME:LEVEL[@TIME]", "parse": parse}


def known_robots():
    def parse(text):
        try:
            robots.load(text)
        except robots.RobotError as error:
            raise ArgumentError(str(error)) from None
        return text
    return {"valid": "|".join([*robots.names(), "FOLDER"]), "parse": parse}


def motions():
    """A preset, FAMILY:LEVEL, or a file."""
    preset = choice_or_file(*names.motion_names(), endings=(".yaml", ".csv"))
    families = names.of_worlds("motion_families")
    level = number(0.0, float(names.of_worlds("highest_motion_level")[0]))

    def parse(text):
        family, colon, amount = text.partition(":")
        if not colon or family not in families:
            return preset["parse"](text)
        return f"{family}:{level['parse'](amount):g}"
    words = [*names.motion_names(), *(f"{family}:LEVEL" for family in families)]
    return {"valid": "|".join([*words, "FILE.yaml|FILE.csv"]), "parse": parse}


# Given to trial.launch, and part of every result's name.
NAMED = {
    "motion": Argument("light", **motions(),
                       meaning="how the platform moves; LEVEL 0 to "
                       f"{names.of_worlds('highest_motion_level')[0]}, 1 as fast as heavy; with "
                       "scenario:=cart none"),
    "gait": Argument("stand", **choice(*names.of_worlds("gaits")), meaning="what the legs do"),
    "planner": Argument("elte", **choice(*names.planner_names(), *names.SERVOS),
                        meaning="how the skill is adapted; servo, servo_fast: visual servoing in place of "
                        "skill and decision"),
    "framework": Argument(True, **boolean(),
                          meaning="false: adapt once, to the first forecast, execute blindly"),
    "seed": Argument(1, **integer(0, 2**31 - 1), meaning="of every random draw"),
}
# Given to trial.launch, and named where they are not the default.
LAUNCHED = {
    **NAMED,
    "robot": Argument(robots.DEFAULT, **known_robots(),
                      meaning="one of prf_robots, or the path of a folder like those; without legs it is bolted to "
                      "the deck, and the box stands ashore (scenario:=quay) unless told"),
    "scenario": Argument("treadmill", **choice(*names.of_worlds("scenarios")),
                         meaning="cart: the box is on a cart that a hand pushes aside; quay: it "
                         "stands ashore"),
    "disturb": Argument("", **disturbed(),
                        meaning="what is done to robot, cart or camera, listed below; several with "
                        "commas"),
    "obstacle": Argument("none", **choice("none", "post"),
                         meaning="post: stands before the box, at its right, in the way of "
                         "demonstration:=inspect_box_from_the_right, which it makes the default"),
    "avoid": Argument(True, **boolean(), meaning="false: the planner does not heed the obstacle"),
    "body_motion": Argument("", **choice_or_file("", endings=(".csv",)),
                            meaning="recorded motion of the body over the deck"),
    "method": Argument("default", **choice("default", "paper"),
                       meaning="paper: as printed; sets predictor:=paper hmm:=paper approach:=false where "
                       "they are not given"),
    "approach": Argument(True, **boolean(),
                         meaning="false: the target binds the skill at its end point alone, not on "
                         "the approach"),
    "decision": Argument("hmm", **choice("hmm", "forward"),
                         meaning="forward: never waits or goes back for the target's motion"),
    "hmm": Argument("trained", **choice_or_file("paper", "trained", endings=(".yaml",)),
                    meaning="model of the target's motion: by hand as in the paper, learnt from what the "
                    "arm can do, or a file"),
    "predictor": Argument("periodic", **choice(*names.predictor_names()),
                          meaning="how the target's motion is predicted"),
    "variation": Argument(1.0, **number(0.0, 1.0),
                          meaning="how much the seed changes box, placement, friction, noise"),
    "time_limit": Argument(60.0, **number(1.0, 600.0), meaning="simulated s"),
    "real_time_factor": Argument(0.0, **number(0.0, 100.0),
                                 meaning="at most so fast, 0: as fast as it goes"),
    "driver": Argument("", **choice("", *names.driver_names()),
                       meaning="of the arm, as the simulator offers it; none: joint_command itself"),
    "fault": Argument("", **faults(), meaning="what goes wrong, listed below; several with commas"),
    "demonstration": Argument(None, **path(), meaning="CSV file of the skill"),
}
RESULTS = {"results": Argument(os.path.abspath("results"), **path(),
                               meaning="folder that gets the results")}
TRIAL = {
    **LAUNCHED, **RESULTS,
    "isolated": Argument(False, **boolean(),
                         meaning="true: in a network namespace of its own, which nobody can reach"),
    "report": Argument("true", **choice("true", "brief", "false"),
                       meaning="brief: words and numbers alone when the verdict is S; false: none"),
    "keep_bag": Argument(True, **boolean(), meaning="false: delete the bag at the end"),
}


# The parts of method:=paper.
PAPER = {"predictor": "paper", "hmm": "paper", "approach": False}


def of_method(values: dict) -> dict:
    """`values` with the parts of the method in place of the defaults."""
    if values["method"] != "paper":
        return values
    return {**values, **{key: part for key, part in PAPER.items()
                         if values[key] == LAUNCHED[key].default}}


def of_robot(values: dict, words: Sequence[str]) -> dict:
    """`values` of a robot without legs: the box stands ashore unless `words` say another scenario."""
    name = values["robot"]
    if values["driver"] and name != robots.DEFAULT:
        raise ArgumentError(f"driver:={values['driver']} does not go with robot:={name}, valid: "
                            f"robot:={robots.DEFAULT}")
    if robots.load(name).on_legs:
        return values
    if values["gait"] != "stand":
        raise ArgumentError(f"gait:={values['gait']} does not go with robot:={name}, which has no legs, valid: "
                            "gait:=stand")
    asked = any(word.startswith("scenario:=") for word in words)
    return values if asked else {**values, "scenario": "quay"}


def complete(values: dict, words: Sequence[str]) -> dict:
    """`values` with the parts of the method; the floor under the cart does not move: with motion none
    unless `words` say it."""
    values = of_robot(of_method(values), words)
    if values["scenario"] != "cart":
        if disturbances.moves_cart(values["disturb"]):
            raise ArgumentError(f"disturb:={values['disturb']} pushes a cart, valid: scenario:=cart")
        return values
    if values["obstacle"] != "none":
        raise ArgumentError("obstacle:=post does not go with scenario:=cart, valid: obstacle:=none")
    asked = [word for word in words if word.startswith("motion:=")]
    if asked and values["motion"] != "none":
        raise ArgumentError(f"{asked[-1]} does not go with scenario:=cart, valid: motion:=none")
    return {**values, "motion": "none"}


def words(values: dict) -> list[str]:
    """The launched arguments that say more than their defaults, as name:=value."""
    return [f"{name}:={show(values[name])}" for name, argument in LAUNCHED.items()
            if name in NAMED or values[name] != argument.default]


def contents(values: dict) -> dict[str, str]:
    """{argument: SHA-256 of the file that it names}: what a trial is depends on the content."""
    found = {}
    for key in ("motion", "body_motion", "hmm", "demonstration"):
        if values.get(key) and os.path.isfile(values[key]):
            with open(values[key], "rb") as stream:
                found[key] = hashlib.sha256(stream.read()).hexdigest()
    return found


def same(values: dict, verdict: dict) -> bool:
    """Whether a verdict is of the trial `values`; files count by their content."""
    asked = contents(values)
    return asked == verdict.get("files", {}) and all(
        key in asked or verdict["arguments"].get(key) == values[key] for key in LAUNCHED)


def name(values: dict) -> str:
    """Name of a trial, the same for the same arguments; good for a folder."""
    files = contents(values)

    def short(key):
        base = os.path.basename(values[key] or "")
        return f"{base}-{files[key][:8]}" if key in files else base or (values[key] and base)
    brief = {**values, **{key: short(key) for key in ("motion", "body_motion", "hmm", "demonstration")}}
    full = "_".join(re.sub(r"[^\w.@+-]", "-", word.replace(":=", "-")) for word in words(brief))
    if len(full) <= LONGEST_NAME:
        return full
    return full[:LONGEST_NAME] + "-" + hashlib.sha256(full.encode()).hexdigest()[:8]


def usage() -> str:
    """All arguments, disturbances and faults, for people."""
    return "\n".join([arguments_usage(TRIAL), disturbances.usage(), catalogue.usage()])
