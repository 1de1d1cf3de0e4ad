# SPDX-License-Identifier: BSD-3-Clause
"""Robots as folders of prf_robots, or of a path: robot.yaml says what of the URDF is the arm. Imports no ROS.

In the sources robot.yaml is read where it is written; robot.urdf is there once the workspace is built.
"""
import functools
import os
import re
import xml.etree.ElementTree
from dataclasses import dataclass

import yaml

DEFAULT = "jaco_v60"
_SOURCES = os.path.join(os.path.dirname(os.path.realpath(__file__)), *[".."] * 3, "prf_robots", "robots")


class RobotError(ValueError):
    """There is no such robot, or its files cannot be used; the message says which and why."""


@dataclass(frozen=True)
class Robot:
    name: str  # or path, as it was asked for
    on_legs: bool  # of the Vision 60; else bolted to the deck
    base_link: str  # the planning frame
    tip_link: str  # the hand
    camera_frame: str
    joints: tuple[str, ...]  # of the arm, from base to hand

    @functools.cached_property
    def urdf_file(self) -> str:
        """Raises RobotError."""
        if "/" in self.name:
            return os.path.join(self.name, "robot.urdf")
        from catkin.find_in_workspaces import find_in_workspaces
        found = find_in_workspaces(["share"], "prf_robots", f"robots/{self.name}/robot.urdf")
        if not found:
            raise RobotError(f"prf_robots has no robots/{self.name}/robot.urdf: is the workspace built and its "
                             "setup.bash sourced?")
        return found[0]

    @functools.cached_property
    def parents(self) -> dict[str, str]:
        """{link: the link that carries it}. Raises RobotError."""
        try:
            root = xml.etree.ElementTree.parse(self.urdf_file).getroot()
        except (OSError, xml.etree.ElementTree.ParseError) as error:
            raise RobotError(f"{self.urdf_file}: {error}") from None
        return {joint.find("child").get("link"): joint.find("parent").get("link")  # type: ignore[union-attr,misc]
                for joint in root.findall("joint")}

    @functools.cached_property
    def root_link(self) -> str:
        """The link that no other one carries."""
        link = self.base_link
        while link in self.parents:
            link = self.parents[link]
        return link

    def moves(self, link: str) -> bool:
        """Whether the arm moves that link: hand and camera too, but not the arm's base."""
        while link in self.parents:
            link = self.parents[link]
            if link == self.base_link:
                return True
        return False


def names() -> list[str]:
    """Of the robots of prf_robots, sorted."""
    return sorted(name for name in os.listdir(_folder())
                  if os.path.isfile(os.path.join(_folder(), name, "robot.yaml")))


def _folder():
    if os.path.isdir(_SOURCES):
        return _SOURCES
    import rospkg
    return os.path.join(rospkg.RosPack().get_path("prf_robots"), "robots")


@functools.cache
def load(name_or_path: str = DEFAULT) -> Robot:
    """A robot of prf_robots, or that of a folder (with a / in it). Raises RobotError.

    The nodes check the folder further: prf_robots' load_robot().
    """
    if "/" not in name_or_path and name_or_path not in names():
        raise RobotError(f"robot = {name_or_path}, must be {', '.join(names())} or the path of a folder, with a /")
    folder = name_or_path if "/" in name_or_path else os.path.join(_folder(), name_or_path)
    file = os.path.join(folder, "robot.yaml")
    try:
        with open(file, encoding="utf-8") as stream:
            values = yaml.safe_load(stream)
        base, joints = values["base"], values["joints"]
        texts = [values[key] for key in ("base_link", "tip_link", "camera_frame")]
    except (OSError, yaml.YAMLError) as error:
        raise RobotError(f"{file}: " + re.sub(r"\s+", " ", str(error))) from None
    except (KeyError, TypeError) as error:
        raise RobotError(f"{file}: {error} is missing, must be there") from None
    if base not in ("legs", "deck"):
        raise RobotError(f"{file}: base = {base}, must be legs or deck")
    if not isinstance(joints, list) or not all(isinstance(text, str) for text in [*joints, *texts]):
        raise RobotError(f"{file}: joints and links must be names")
    base_link, tip_link, camera_frame = texts
    return Robot(name_or_path, base == "legs", base_link, tip_link, camera_frame, tuple(joints))
