# SPDX-License-Identifier: BSD-3-Clause
"""Names of predictors and planners, from where they are defined.

In the sources they are read without ROS, so that arguments are checked before anything is built;
once installed, the packages say them.
"""
import os
import re

_SOURCES = os.path.join(os.path.dirname(os.path.realpath(__file__)), *[".."] * 4)


def predictor_names() -> list[str]:
    """One for each file of prf_predictor/config/predictors, sorted."""
    folder = os.path.join(_SOURCES, "prf_predictor", "config", "predictors")
    if not os.path.isdir(folder):
        import rospkg
        folder = os.path.join(rospkg.RosPack().get_path("prf_predictor"), "config", "predictors")
    return sorted(name[:-5] for name in os.listdir(folder) if name.endswith(".yaml"))


def planner_names() -> list[str]:
    """Those that the factory of elte_planner makes, in its order."""
    factory = os.path.join(_SOURCES, "elte_planner", "src", "planners", "skill_planner.cpp")
    if not os.path.isfile(factory):
        import elte_planner
        return elte_planner.planner_names()
    with open(factory, encoding="utf-8") as stream:
        table = re.search(r"kFactories\[\] = \{$(.*?)^\};", stream.read(), re.M | re.S)
    return re.findall(r'^    \{"(\w+)",$', table[1], re.M) if table else []
