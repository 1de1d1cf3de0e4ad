# SPDX-License-Identifier: BSD-3-Clause
"""The robot description of jaco_v60_description, as it is built or installed."""
import os

import rospkg


def text() -> str:
    path = os.path.join(rospkg.RosPack().get_path("jaco_v60_description"), "urdf", "jaco_v60.urdf")
    if not os.path.isfile(path):
        from catkin.find_in_workspaces import find_in_workspaces
        path = find_in_workspaces(["share"], "jaco_v60_description", "urdf/jaco_v60.urdf")[0]
    with open(path, encoding="utf-8") as stream:
        return stream.read()
