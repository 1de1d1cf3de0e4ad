# SPDX-License-Identifier: BSD-3-Clause
"""Names of worlds, predictors and planners, from where they are defined.

In the sources they are read without ROS, so that arguments are checked before anything is built;
once installed, the packages say them.
"""
import os
import re

import yaml

_SOURCES = os.path.join(os.path.dirname(os.path.realpath(__file__)), *[".."] * 4)


def _in_package(package: str, *parts: str) -> str:
    path = os.path.join(_SOURCES, package, *parts)
    if os.path.exists(path):
        return path
    import rospkg
    return os.path.join(rospkg.RosPack().get_path(package), *parts)


def _files(package: str, *folder: str) -> list[str]:
    found = os.listdir(_in_package(package, *folder))
    return sorted(name[:-5] for name in found if name.endswith(".yaml"))


def predictor_names() -> list[str]:
    """One for each file of prf_predictor/config/predictors, sorted."""
    return _files("prf_predictor", "config", "predictors")


def motion_names() -> list[str]:
    """Presets of the platform's motion: none, and the files of platform_sim/config/profiles."""
    return ["none", *_files("platform_sim", "config", "profiles")]


def of_worlds(key: str) -> list[str]:
    """The values of a line of platform_sim/config/worlds.yaml. YAML's reader may not be there yet."""
    with open(_in_package("platform_sim", "config", "worlds.yaml"), encoding="utf-8") as stream:
        line = re.search(rf"^{key}: \[?([^\]#\n]*)", stream.read(), re.M)
    if line is None:
        raise KeyError(key)
    return [word.strip() for word in line[1].split(",")]


def _driver_folder() -> str:
    folder = os.path.join(_SOURCES, "prf_drivers", "config")
    if not os.path.isdir(folder):
        import rospkg
        folder = os.path.join(rospkg.RosPack().get_path("prf_drivers"), "config")
    return folder


def driver_names() -> list[str]:
    """One for each file of prf_drivers/config, sorted."""
    return sorted(name[:-5] for name in os.listdir(_driver_folder()) if name.endswith(".yaml"))


def driver_period(driver: str) -> float:
    """s, of the control ticks with a driver; without one those of the simulator."""
    if not driver:
        return 0.01
    with open(os.path.join(_driver_folder(), driver + ".yaml"), encoding="utf-8") as stream:
        return float(yaml.safe_load(stream)["driver"]["period"])


# In place of a planner and of the decision: rivals/pose_servo.py.
SERVOS = ("servo", "servo_fast")


def planner_names() -> list[str]:
    """Those that the factory of elte_planner makes, in its order."""
    factory = os.path.join(_SOURCES, "elte_planner", "src", "planners", "skill_planner.cpp")
    if not os.path.isfile(factory):
        import elte_planner
        return elte_planner.planner_names()
    with open(factory, encoding="utf-8") as stream:
        table = re.search(r"kFactories\[\] = \{$(.*?)^\};", stream.read(), re.M | re.S)
    return re.findall(r'^    \{"(\w+)",$', table[1], re.M) if table else []
