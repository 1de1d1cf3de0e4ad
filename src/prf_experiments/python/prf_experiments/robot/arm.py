# SPDX-License-Identifier: BSD-3-Clause
"""Where a link of a robot is, from its URDF and joint positions."""
import xml.etree.ElementTree as ElementTree

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from prf_experiments import geometry


class Chain:
    """Joints from `base` to `tip`; `joints` are those that move, in that order."""

    def __init__(self, urdf: str, base: str, tip: str):
        robot = ElementTree.fromstring(urdf)
        above = {_link(joint, "child"): joint for joint in robot.findall("joint")}
        self._parts: list[tuple[np.ndarray, np.ndarray | None]] = []
        self.joints: list[str] = []
        link = tip
        while link != base:
            if link not in above:
                raise ValueError(f"the URDF has no joints from link {base} to link {tip}, must have: link {link} "
                                 "has no parent; see what check_urdf says")
            joint = above[link]
            moves = joint.attrib["type"] in ("revolute", "continuous")
            if moves:
                self.joints.insert(0, joint.attrib["name"])
            self._parts.insert(0, (origin(joint), _numbers(joint.find("axis"), "xyz", "1 0 0") if moves else None))
            link = _link(joint, "parent")

    def poses(self, positions: ArrayLike) -> np.ndarray:
        """Poses (n, 7) of the tip in the base at joint positions (n, joints), rad."""
        positions = np.asarray(positions, float)
        pose, column = np.tile(geometry.IDENTITY, (len(positions), 1)), 0
        for at_zero, axis in self._parts:
            pose = geometry.compose(pose, np.broadcast_to(at_zero, pose.shape))
            if axis is not None:
                turned = Rotation.from_rotvec(positions[:, column, None] * axis)
                pose = geometry.compose(pose, geometry.make(np.zeros((len(positions), 3)), turned))
                column += 1
        return pose


def _link(joint: ElementTree.Element, role: str) -> str:
    element = joint.find(role)
    if element is None:
        raise ValueError(f"joint {joint.attrib.get('name')} of the URDF has no <{role}>; see what check_urdf says")
    return element.attrib["link"]


def _numbers(element, name: str, default: str) -> np.ndarray:
    return np.array((default if element is None else element.attrib.get(name, default)).split(), float)


def origin(joint: ElementTree.Element) -> np.ndarray:
    """Pose (7,) of the child at joint position 0 in the parent."""
    element = joint.find("origin")
    turned = Rotation.from_euler("xyz", _numbers(element, "rpy", "0 0 0"))
    return geometry.make(_numbers(element, "xyz", "0 0 0"), turned)
