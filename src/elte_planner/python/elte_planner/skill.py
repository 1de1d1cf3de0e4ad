# SPDX-License-Identifier: BSD-3-Clause
"""From what a user has (arrays, files, Demonstrations; one or several) to the nodes that a planner edits."""
from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elte_planner._core import Demonstration, combine, load_demonstration

Array = NDArray[np.float64]
Source = Union[ArrayLike, Demonstration, "os.PathLike[str]", str]

MOST_SPATIAL = 3  # dimensions that a Demonstration has


@dataclass(frozen=True)
class Skill:
    """The nodes of one skill, made of one or several demonstrations."""

    positions: Array
    """(T, d), in the unit of what was given."""
    times: Array
    """(T,), s from the start; of arrays without times the share of the whole, 0 .. 1."""
    quaternions: Array | None
    """(T, 4), x y z w; None when positions alone were given."""
    demonstrations: tuple[Array, ...]
    """Positions as given, (N_i, d)."""


def rows_of(values: ArrayLike, what: str) -> Array:
    """values as (N, d) numbers; ValueError with the name otherwise."""
    rows = np.asarray(values, dtype=float)
    if rows.ndim != 2 or rows.shape[1] == 0:
        raise ValueError(f"{what} has shape {rows.shape}, must be (nodes, dimensions)")
    return rows


def _as_demonstration(rows: Array, times: Array, quaternions: Array | None) -> Demonstration:
    """Of up to three dimensions; the missing ones are 0, the target is the origin."""
    positions = np.zeros((len(rows), MOST_SPATIAL))
    positions[:, :rows.shape[1]] = rows
    if quaternions is None:
        quaternions = np.tile([0.0, 0.0, 0.0, 1.0], (len(rows), 1))
    return Demonstration(times, positions, quaternions, "given", "hand", np.array([0, 0, 0, 0, 0, 0, 1.0]))


def _even(count: int) -> Array:
    return np.linspace(0.0, 1.0, count, dtype=np.float64)


def _resampled(rows: Array, nodes: int) -> Array:
    """By arc length, for more dimensions than a Demonstration has."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(rows, axis=0), axis=1))])
    if not length[-1] > 0.0:
        raise ValueError("the demonstration does not move, must have two different positions")
    return np.column_stack([np.interp(np.linspace(0.0, length[-1], nodes), length, column) for column in rows.T])


def _many_dimensional(arrays: list[Array], nodes: int | None, thin: float | None, alignment: str) -> Skill:
    if thin is not None or alignment != "arc_length":
        raise ValueError(f"thin and alignment '{alignment}' need at most {MOST_SPATIAL} dimensions, "
                         f"not {arrays[0].shape[1]}")
    if nodes is None and len(arrays) > 1:
        raise ValueError("several demonstrations need a number of nodes: give nodes=")
    same = [array if nodes is None else _resampled(array, nodes) for array in arrays]
    mean: Array = np.asarray(np.mean(same, axis=0), dtype=np.float64)
    return Skill(mean, _even(len(mean)), None, tuple(arrays))


def _is_array(source: Source) -> bool:
    return not isinstance(source, (Demonstration, str, os.PathLike))


def _sources(given: Source | Sequence[Source]) -> list[Source]:
    """One demonstration or a list of them, as a list."""
    if isinstance(given, (Demonstration, str, os.PathLike)):
        return [given]
    if isinstance(given, (list, tuple)) and len(given) and (
            not _is_array(given[0]) or np.ndim(given[0]) == 2):
        return list(given)
    return [given]  # type: ignore[list-item]


def make_skill(given: Source | Sequence[Source], *, quaternions: ArrayLike | None, times: ArrayLike | None,
               nodes: int | None, thin: float | None, alignment: str) -> Skill:
    """See Planner.fit."""
    if nodes is not None and nodes < 3:
        raise ValueError(f"nodes is {nodes}, must be at least 3")
    sources = _sources(given)
    if quaternions is not None or times is not None:
        if len(sources) != 1 or not _is_array(sources[0]):
            raise ValueError("quaternions and times belong to one demonstration that is given as an array")
    arrays = [rows_of(source, "demonstration") for source in sources if _is_array(source)]  # type: ignore[arg-type]
    if arrays and len(arrays) != len(sources):
        raise ValueError("demonstrations are arrays and files or Demonstrations, must be of one kind")
    if any(array.shape[1] != arrays[0].shape[1] for array in arrays):
        raise ValueError("demonstrations have " + ", ".join(str(array.shape[1]) for array in arrays) +
                         " dimensions, must have as many")
    if arrays and arrays[0].shape[1] > MOST_SPATIAL:
        if quaternions is not None:
            raise ValueError("quaternions belong to positions of three dimensions")
        return _many_dimensional(arrays, nodes, thin, alignment)
    turns = None if quaternions is None else rows_of(quaternions, "quaternions")
    if arrays:
        demonstrations = [_as_demonstration(
            array, _even(len(array)) if times is None else np.asarray(times, dtype=np.float64), turns)
            for array in arrays]
    else:
        demonstrations = [source if isinstance(source, Demonstration) else
                          load_demonstration(os.fspath(source))  # type: ignore[arg-type]
                          for source in sources]
    one = _one(demonstrations, nodes, thin, alignment)
    dimensions = arrays[0].shape[1] if arrays else MOST_SPATIAL
    return Skill(one.positions[:, :dimensions], one.times, one.quaternions if turns is not None or not arrays else None,
                 tuple(demonstration.positions[:, :dimensions] for demonstration in demonstrations))


def _one(demonstrations: list[Demonstration], nodes: int | None, thin: float | None, alignment: str) -> Demonstration:
    if len(demonstrations) > 1:
        longest = max(len(demonstration.times) for demonstration in demonstrations)
        count = longest if thin is not None or nodes is None else nodes
        one = combine(demonstrations, count, alignment=alignment)
    elif nodes is None or thin is not None:
        one = demonstrations[0]
    else:
        one = demonstrations[0].resampled_by_arc_length(nodes)
    return one if thin is None else one.thinned_by_douglas_peucker(thin)
