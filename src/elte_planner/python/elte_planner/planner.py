# SPDX-License-Identifier: BSD-3-Clause
"""One class for all planners: fit demonstrations, plan to a goal, go on planning while the plan is executed."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from elte_planner._core import (
    Obstacle,
    SkillPlanner,
    avoid,
    ball,
    blend_orientations,
    planner_names,
    shape_loss,
)
from elte_planner.skill import Array, Skill, Source, make_skill, rows_of

WITH_CONSTRAINTS = ("elte", "lte")  # planners that keep via-points, obstacles and max_step


@dataclass(frozen=True)
class Via:
    """A point that the plan passes within `radius` (l1, unit of the positions; 0: through it).

    point: (d,). node: which one passes; None: the one of the plan without via-points that comes nearest.
    """

    point: ArrayLike
    node: int | None = None
    radius: float = 0.0


@dataclass(frozen=True)
class Plan:
    """What Planner.plan() found."""

    status: str
    """'solved'; 'relaxed': as near to the goal as possible, see slack; else no plan was found, see message."""
    message: str
    """Why it is not solved, one line."""
    positions: Array
    """(T, d), in the unit of the demonstration; (0, d) when no plan was found."""
    times: Array
    """(T,), s, as demonstrated."""
    quaternions: Array | None
    """(T, 4), x y z w; None when the demonstrations have no orientations."""
    frozen: int
    """Number of leading nodes that were kept as they were."""
    goal: Array
    """(d,)."""
    radius: float
    """l1, of the ball around the goal."""
    slack: float = 0.0
    """Added to the radius when relaxed."""
    kkt_residual: float = 0.0
    """Largest violation of the optimality conditions, in the unit of the positions; 0 for planners without one."""
    via: tuple[Via, ...] = ()
    """Each with its node."""
    obstacles: tuple[Obstacle, ...] = ()
    clearance: float | None = None
    """Least distance of the polyline, from the last frozen node on, from the obstacles; None without obstacles."""

    @property
    def found(self) -> bool:
        """There are positions to follow: solved or relaxed."""
        return len(self.positions) > 0

    @property
    def end_error(self) -> float:
        """l1 distance of the last node from the goal."""
        return float(np.abs(self.positions[-1] - self.goal).sum()) if self.found else float("inf")


class Planner:
    """A planner of trajectories that look like the demonstrated one.

    kind: 'elte' (keeps the shape, stays short and smooth), 'lte' (shape only), 'elastic_map' (keeps the positions) or
    'dmp' (approaches the goal, does not meet it). w_elastic, w_bending: weights of squared first and second
    differences, without unit; lte and dmp have none. A disturbance decays over sqrt(0.25 / w_elastic) nodes, 158 by
    default (the paper's 0.001: 16); a plan of many more nodes is pulled straight, see shape_loss. max_step: greatest
    l1 distance of consecutive nodes, in the unit of the demonstration; elte and lte keep it.
    """

    def __init__(self, kind: str = "elte", *, w_elastic: float = 1e-5, w_bending: float = 0.001,
                 max_step: float = float("inf")) -> None:
        if kind not in planner_names():
            raise ValueError(f"planner = {kind}, must be one of: {', '.join(planner_names())}")
        self.kind = kind
        self._w_elastic, self._w_bending, self._max_step = w_elastic, w_bending, max_step
        self._skill: Skill | None = None
        self._planner: SkillPlanner | None = None

    def fit(self, demonstrations: Source | Sequence[Source], *, quaternions: ArrayLike | None = None,
            times: ArrayLike | None = None, nodes: int | None = 50, thin: float | None = None,
            alignment: str = "arc_length") -> Planner:
        """Take one demonstration, or a list of several of one skill, which are aligned and averaged.

        Each is an array (N, d) of positions, a Demonstration, or the path of a CSV file (load_demonstration). Of one
        array there may be quaternions (N, 4), x y z w, and times (N,), s, which rise strictly. nodes: of the plan,
        equally spaced along the path; None: the samples as given. thin: instead of nodes, the fewest samples that
        leave none farther than this from the line between them (Douglas-Peucker). alignment of several: 'arc_length'
        or 'dynamic_time_warping'. Demonstrations with targets are moved so that their targets agree. Thinning, time
        warping and orientations need d <= 3. Returns self.
        """
        self._skill = make_skill(demonstrations, quaternions=quaternions, times=times, nodes=nodes, thin=thin,
                                 alignment=alignment)
        self._planner = SkillPlanner(self.kind, self._skill.positions, w_elastic=self._w_elastic,
                                     w_bending=self._w_bending, max_step=self._max_step)
        return self

    @property
    def skill(self) -> Skill:
        """The fitted nodes; ValueError before fit()."""
        if self._skill is None:
            raise ValueError("the planner has no demonstration yet, call fit() first")
        return self._skill

    @property
    def shape_loss(self) -> float:
        """How much of the shape the weights cost without any editing: 0 none, 1 a straight line."""
        if self.kind != "elte":
            return 0.0
        return shape_loss(self.skill.positions, w_elastic=self._w_elastic, w_bending=self._w_bending)

    def plan(self, goal: ArrayLike | None = None, *, start: ArrayLike | None = None,
             frozen: int | ArrayLike | None = None, via: Sequence[Via | ArrayLike] = (),
             obstacles: Sequence[Obstacle] = (), clearance: float | None = None, radius: float = 0.0) -> Plan:
        """A trajectory that ends within `radius` (l1) of goal.

        goal: (d,) position, or (7,) pose x y z qx qy qz qw when the demonstrations have orientations; None: where the
        demonstration ends. start: (d,), to which the first two nodes are moved. frozen: what is executed and stays:
        a number of nodes of the demonstration, or rows (k, d) or (k, 7), 2 <= k <= T. via: points (d,) or Via.
        obstacles: of disc_obstacle() and box_obstacle(), from which every segment that is not frozen keeps the
        distance `clearance` > 0. radius: for example confidence_radius(covariance, 0.9). Lengths in the unit of the
        demonstration. Raises ValueError for what contradicts itself; a problem without solution is a status.
        """
        previous, turns, count = self._frozen(start, frozen)
        return self._plan_from(previous, turns, count, self._goal(goal), via, obstacles, clearance, radius)

    def session(self) -> Session:
        """Planning anew while the plan is executed."""
        return Session(self)

    def _frozen(self, start: ArrayLike | None, frozen: int | ArrayLike | None) -> tuple[Array, Array | None, int]:
        """The plan so far with its orientations, and how many of its nodes stay."""
        skill = self.skill
        previous, turns = skill.positions.copy(), None if skill.quaternions is None else skill.quaternions.copy()
        if start is not None:
            if frozen is not None:
                raise ValueError("start and frozen contradict each other: give one of them")
            previous[:2] += self._point(start, "start") - previous[0]
        if frozen is None:
            return previous, turns, 2
        if isinstance(frozen, (int, np.integer)):
            return previous, turns, int(frozen)
        rows = rows_of(frozen, "frozen")
        dimensions = previous.shape[1]
        if len(rows) > len(previous):
            raise ValueError(f"frozen has {len(rows)} rows, must have at most {len(previous)}, the plan's nodes")
        if turns is not None and rows.shape[1] == 7:
            turns[:len(rows)] = rows[:, 3:]
        elif rows.shape[1] != dimensions:
            raise ValueError(f"frozen has {rows.shape[1]} columns, must have {dimensions}" +
                             ("" if turns is None else " or 7"))
        previous[:len(rows)] = rows[:, :dimensions]
        return previous, turns, len(rows)

    def _point(self, values: ArrayLike, what: str) -> Array:
        point = np.asarray(values, dtype=float)
        if point.shape != self.skill.positions[0].shape:
            raise ValueError(f"{what} has shape {point.shape}, must be {self.skill.positions[0].shape}")
        return point

    def _goal(self, goal: ArrayLike | None) -> tuple[Array, Array | None]:
        skill = self.skill
        turn = None if skill.quaternions is None else skill.quaternions[-1]
        if goal is None:
            return skill.positions[-1], turn
        values = np.asarray(goal, dtype=float)
        if turn is not None and values.shape == (7,):
            return values[:3], values[3:]
        return self._point(values, "goal"), turn

    def _plan_from(self, previous: Array, turns: Array | None, frozen: int, goal: tuple[Array, Array | None],
                   via: Sequence[Via | ArrayLike], obstacles: Sequence[Obstacle], clearance: float | None,
                   radius: float) -> Plan:
        if (via or obstacles) and self.kind not in WITH_CONSTRAINTS:
            raise ValueError(f"via-points and obstacles need the planner {' or '.join(WITH_CONSTRAINTS)}, "
                             f"not {self.kind}")
        if bool(obstacles) != (clearance is not None):
            raise ValueError("obstacles and clearance belong together: give both or neither")
        assert self._planner is not None
        position = goal[0]
        points = self._with_nodes(via, previous, frozen, position, radius)
        balls = [(point.node, np.asarray(point.point, float), point.radius) for point in points]
        clear: float | None = None
        if obstacles:
            status, message, y, residual, clear = self._around(
                previous, frozen, [*balls, (len(previous) - 1, position, radius)], obstacles, clearance)
            slack = 0.0
        else:
            result = self._planner.plan(previous, frozen, position, radius, balls)  # type: ignore[arg-type]
            status, message, y = result.status, result.message, result.positions
            residual, slack = result.kkt_residual, result.slack
        y = y if y.size else np.empty((0, previous.shape[1]))
        quaternions = None
        if turns is not None and len(y):
            quaternions = blend_orientations(self.skill.quaternions, turns, frozen, [goal[1]])  # type: ignore
        return Plan(status, message, y, self.skill.times, quaternions, frozen, position, radius, slack, residual,
                    points, tuple(obstacles), clear)

    def _around(self, previous, frozen, balls, obstacles, clearance):
        if not 2 <= frozen <= len(previous):
            raise ValueError(f"frozen is {frozen}, must be within [2, {len(previous)}]")
        shape_only = self.kind == "lte"
        solution = avoid(
            self.skill.positions, obstacles, clearance, [ball(*entry) for entry in balls], previous[:frozen],
            w_elastic=0.0 if shape_only else self._w_elastic, w_bending=0.0 if shape_only else self._w_bending,
            laplacian="row_normalised" if shape_only else "free_ends", max_step=self._max_step)
        return solution.status, solution.message, solution.y, solution.kkt_residual, solution.clearance

    def _with_nodes(self, via: Sequence[Via | ArrayLike], previous: Array, frozen: int, goal: Array,
                    radius: float) -> tuple[Via, ...]:
        """Each via-point with its node, which must be free and not the last."""
        points = [given if isinstance(given, Via) else Via(given) for given in via]
        if all(point.node is not None for point in points):
            return tuple(points)
        assert self._planner is not None
        without = self._planner.plan(previous, frozen, goal, radius).positions
        if not len(without):
            without = self.skill.positions
        free = without[frozen:-1]
        if not len(free):
            raise ValueError(f"no node is free for a via-point: {frozen} of {len(without)} are frozen")
        return tuple(
            point if point.node is not None else
            Via(point.point, frozen + int(np.argmin(np.linalg.norm(free - self._point(point.point, "via"), axis=1))),
                point.radius) for point in points)


class Session:
    """Plans during one execution: what is executed stays, the rest follows the goal.

    `current` is the last plan that was found, None before the first.
    """

    def __init__(self, planner: Planner) -> None:
        self._planner = planner
        self.current: Plan | None = None

    def plan(self, goal: ArrayLike | None = None, *, executed: int = 2, via: Sequence[Via | ArrayLike] = (),
             obstacles: Sequence[Obstacle] = (), clearance: float | None = None, radius: float = 0.0) -> Plan:
        """As Planner.plan(), with the first `executed` (2 .. T) nodes as in the current plan.

        A plan that is not found leaves the current one as it is, to be followed on.
        """
        planner = self._planner
        if self.current is None:
            previous, turns, _ = planner._frozen(None, None)
        else:
            previous, turns = self.current.positions, self.current.quaternions
        plan = planner._plan_from(previous, turns, executed, planner._goal(goal), via, obstacles, clearance, radius)
        if plan.found:
            self.current = plan
        return plan
