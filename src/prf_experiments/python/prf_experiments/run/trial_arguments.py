# SPDX-License-Identifier: BSD-3-Clause
"""The arguments of a trial, in one place. Imports no ROS: checked before anything is built."""
import os
from collections.abc import Sequence

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

# Given to trial.launch, and part of every result's name.
NAMED = {
    "motion": Argument("light", **choice_or_file("none", "light", "heavy", "as_printed",
                                                 endings=(".yaml", ".csv")),
                       meaning="how the platform moves; with scenario:=cart none"),
    "gait": Argument("stand", **choice("stand", "stand_stiff", "step"), meaning="what the legs do"),
    "planner": Argument("elte", **choice(*names.planner_names()),
                        meaning="how the skill is adapted"),
    "framework": Argument(True, **boolean(),
                          meaning="false: adapt once, to the first forecast, execute blindly"),
    "seed": Argument(1, **integer(0, 2**31 - 1), meaning="of every random draw"),
}
# Given to trial.launch, and named where they are not the default.
LAUNCHED = {
    **NAMED,
    "scenario": Argument("treadmill", **choice("treadmill", "cart"),
                         meaning="cart: the box is on a cart that a hand pushes aside"),
    "body_motion": Argument("", **choice_or_file("", endings=(".csv",)),
                            meaning="recorded motion of the body over the deck"),
    "decision": Argument("hmm", **choice("hmm", "forward"),
                         meaning="forward: never waits or goes back for the target's motion"),
    "predictor": Argument("periodic", **choice(*names.predictor_names()),
                          meaning="how the target's motion is predicted"),
    "variation": Argument(1.0, **number(0.0, 1.0),
                          meaning="how much the seed changes box, placement, friction, noise"),
    "time_limit": Argument(60.0, **number(1.0, 600.0), meaning="simulated s"),
    "real_time_factor": Argument(0.0, **number(0.0, 100.0),
                                 meaning="at most so fast, 0: as fast as it goes"),
    "demonstration": Argument(None, **path(), meaning="CSV file of the skill"),
}
RESULTS = {"results": Argument(os.path.abspath("results"), **path(),
                               meaning="folder that gets the results")}
TRIAL = {
    **LAUNCHED, **RESULTS,
    "keep_bag": Argument(True, **boolean(), meaning="false: delete the bag at the end"),
}


def complete(values: dict, words: Sequence[str]) -> dict:
    """The floor under the cart does not move: `values` with motion none unless `words` say it."""
    if values["scenario"] != "cart":
        return values
    asked = [word for word in words if word.startswith("motion:=")]
    if asked and values["motion"] != "none":
        raise ArgumentError(f"{asked[-1]} does not go with scenario:=cart, valid: motion:=none")
    return {**values, "motion": "none"}


def words(values: dict) -> list[str]:
    """The launched arguments that say more than their defaults, as name:=value."""
    return [f"{name}:={show(values[name])}" for name, argument in LAUNCHED.items()
            if name in NAMED or values[name] != argument.default]


def name(values: dict) -> str:
    """Name of a trial, the same for the same arguments; good for a folder."""
    short = {**values, "demonstration": os.path.basename(values["demonstration"] or "") or None,
             **{key: os.path.basename(values[key]) for key in ("motion", "body_motion")}}
    return "_".join(word.replace(":=", "-") for word in words(short))
