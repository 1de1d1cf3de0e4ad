# SPDX-License-Identifier: BSD-3-Clause
"""The framework beside a person: a rehearsal's bag holds what both hands did before one target.

The framework moves a stand-in for the arm, the person the arm itself. For each hand: when it reached the
target, how near it came, its path and speed; and how far the two were apart.
"""
from dataclasses import dataclass

import numpy as np

from prf_experiments.judge import judge
from prf_experiments.record import estimated, recording
from prf_msgs import bags


@dataclass(frozen=True)
class Way:
    reached: float | None  # s from the start
    nearest: float  # m, of the camera from where the verdict wants it
    path: float  # m, of the hand
    fastest: float  # m/s, of the hand over a quarter of a second


def way_of(world: estimated.World, start: int) -> Way:
    stamps = world.hand.stamps
    lateral, along = judge.tag_in_camera(world.camera.values, world.tag.values)
    inside = (lateral <= judge.REACHED_BOUND) & (np.abs(along - judge.STAND_OFF) <= judge.REACHED_BOUND)
    reached = judge.held(stamps, inside, judge.REACHED_HOLD)
    hand = world.hand.values[:, :3]
    window = max(1, min(len(stamps) - 1, round(0.25 * 1e9 / np.median(np.diff(stamps)))))
    speed = np.linalg.norm(hand[window:] - hand[:-window], axis=1) / (1e-9 * (stamps[window:] - stamps[:-window]))
    return Way(None if reached is None else 1e-9 * (reached - start),
               float(np.min(np.hypot(lateral, along - judge.STAND_OFF))),
               float(np.sum(np.linalg.norm(np.diff(hand, axis=0), axis=1))), float(np.max(speed)))


def compared(bag: str) -> list[str]:
    """Lines of a table, for people; none for a bag without a stand-in."""
    with bags.opened(bag) as content:
        if not bags.counts(content).get(estimated.STAND_IN):
            return []
    framework, person = (recording.read(bag, moved=topic) for topic in (estimated.STAND_IN, "joint_states"))
    worlds = [estimated.World(data.tag, data.camera, data.end_effector, data.base, data.platform)
              for data in (framework, person)]
    lines = ["hand         reached s  nearest mm  path m  fastest m/s"]
    for name, world in zip(("framework", "arm itself"), worlds):
        way = way_of(world, framework.start)
        lines.append(f"{name:<12} {'never' if way.reached is None else format(way.reached, '.1f'):>9}  "
                     f"{1e3 * way.nearest:10.0f}  {way.path:6.2f}  {way.fastest:11.2f}")
    _, ours, theirs = np.intersect1d(worlds[0].hand.stamps, worlds[1].hand.stamps, return_indices=True)
    apart = np.linalg.norm(worlds[0].hand.values[ours, :3] - worlds[1].hand.values[theirs, :3], axis=1)
    if len(apart):
        lines.append(f"apart        {1e3 * np.median(apart):.0f} mm in the median, at most {1e3 * np.max(apart):.0f}")
    return lines
