# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of plans with matplotlib, which is imported only here."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from elte_planner._core import Obstacle
from elte_planner.planner import Plan


def draw(plan: Plan, axes: Any = None, *, demonstrations: Sequence[ArrayLike] = (), dims: tuple[int, int] = (0, 1),
         unit: str = "m", label: str = "plan", color: str = "C0") -> Any:
    """Draw a plan with what it keeps: frozen nodes, goal with its ball, via-points, obstacles. Returns the axes.

    axes: of matplotlib; None makes them. demonstrations: (N, d) each, as Skill.demonstrations. dims: the two
    dimensions that are drawn.
    """
    if axes is None:
        import matplotlib.pyplot as plt
        axes = plt.subplots(layout="constrained")[1]
    i, j = dims
    for number, given in enumerate(demonstrations):
        path = np.asarray(given)
        axes.plot(path[:, i], path[:, j], color="0.6",
                  label=None if number else "demonstration" + "s" * (len(demonstrations) > 1))
    for obstacle in plan.obstacles:
        axes.add_patch(_patch(obstacle, i, j))
    axes.plot(plan.positions[:, i], plan.positions[:, j], ".-", markersize=3, color=color, label=label)
    if plan.frozen > 2:
        axes.plot(plan.positions[:plan.frozen, i], plan.positions[:plan.frozen, j], "k", linewidth=2.5,
                  label="executed")
    axes.plot(plan.goal[i], plan.goal[j], "x", color="C1", label="goal")
    _ball(axes, plan.goal[[i, j]], plan.radius, "C1")
    for number, via in enumerate(plan.via):
        point = np.asarray(via.point)[[i, j]]
        axes.plot(*point, "s", markersize=5, color="C2", label=None if number else "via-point")
        _ball(axes, point, via.radius, "C2")
    axes.set_xlabel(_name(i, unit))
    axes.set_ylabel(_name(j, unit))
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_axisbelow(True)
    axes.grid(color="0.9")
    once = dict(zip(*reversed(axes.get_legend_handles_labels())))  # of several plans in one picture
    axes.legend(once.values(), once.keys(), fontsize="small")
    return axes


def _name(dimension: int, unit: str) -> str:
    return f"{'xyz'[dimension] if dimension < 3 else f'dimension {dimension}'} [{unit}]"


def _ball(axes: Any, centre: np.ndarray, radius: float, color: str) -> None:
    """An l1 ball seen along the other dimensions is a square on its corner."""
    if radius > 0.0:
        from matplotlib.patches import Polygon
        corners = radius * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
        axes.add_patch(Polygon(centre + corners, fill=False, color=color))


def _patch(obstacle: Obstacle, i: int, j: int) -> Any:
    from matplotlib.patches import Circle, Rectangle
    x, y = obstacle.centre[[i, j]]
    if not len(obstacle.half_widths):
        return Circle((x, y), obstacle.radius, color="C3", alpha=0.4)
    w, h = obstacle.half_widths[[i, j]]
    return Rectangle((x - w, y - h), 2 * w, 2 * h, color="C3", alpha=0.4)
