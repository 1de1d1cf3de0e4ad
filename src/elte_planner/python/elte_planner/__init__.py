# SPDX-License-Identifier: BSD-3-Clause
"""Elastic Laplacian trajectory editing (ELTE) and its rivals: numpy in, numpy out. Rows are nodes.

`Planner` is what most need: fit demonstrations, plan to a goal. Below it are the solvers with all their constraints
(`solve`, `avoid`, `EndpointSolver`), demonstrations with orientations and target (`Demonstration`,
`load_demonstration`), `confidence_radius`, and the modules `plotting` and `measures`.
"""
from pkgutil import extend_path

# A sourced ROS workspace comes first on the path, but its compiled part is for the system's Python and numpy: where the
# package is installed, too, the installed parts are taken.
__path__ = extend_path(__path__, __name__)[::-1]

from elte_planner._core import (
    AvoidanceSolution,
    Demonstration,
    EndpointSolver,
    Obstacle,
    PlanResult,
    PointConstraint,
    SkillPlanner,
    Solution,
    avoid,
    ball,
    blend_orientations,
    box,
    box_obstacle,
    combine,
    confidence_radius,
    disc_obstacle,
    equality,
    half_space,
    load_demonstration,
    planner_names,
    polyline_clearance,
    require_executable,
    save_demonstration,
    shape_loss,
    solve,
)
from elte_planner.bag import load_bag
from elte_planner.planner import Plan, Planner, Session, Via

__all__ = [
    "AvoidanceSolution", "Demonstration", "EndpointSolver", "Obstacle", "Plan", "PlanResult", "Planner",
    "PointConstraint", "Session", "SkillPlanner", "Solution", "Via", "avoid", "ball", "blend_orientations", "box",
    "box_obstacle", "combine", "confidence_radius", "disc_obstacle", "equality", "half_space", "load_bag",
    "load_demonstration", "planner_names", "polyline_clearance", "require_executable",
    "save_demonstration", "shape_loss", "solve",
]
