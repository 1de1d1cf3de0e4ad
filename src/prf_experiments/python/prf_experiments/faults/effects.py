# SPDX-License-Identifier: BSD-3-Clause
"""What the faults do to messages. All draws are from the trial's seed, the fault and the stamp.

An effect takes a message and gives the messages that come instead of it: [(delay s, message)].
"""
import copy
import math
import random
import struct
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import genpy
import numpy as np
from scipy.spatial.transform import Rotation

from prf_experiments.faults.catalogue import Fault

SECOND = 1_000_000_000  # ns
LAST = (1 << 32) * SECOND - 1  # ns, the end of ROS time
FLOATS = {"float32": "f", "float64": "d"}
INTEGERS = {"uint8": "B", "int8": "b", "uint16": "H", "int16": "h", "uint32": "I", "int32": "i",
            "uint64": "Q", "int64": "q"}
TAG = 0  # id of the target's tag

Effect = Callable[[Any, random.Random], list[tuple[float, Any]]]
Place = tuple[Any, str, int | None, str]  # object, field, index in it, type


def _stamped_parts(message: Any) -> Sequence[Any]:
    """The transforms of tf, the markers of obstacles: each has a header of its own."""
    return getattr(message, "transforms", None) or getattr(message, "markers", None) or ()


def stamp_of(message: Any) -> int:
    """ns; of the first transform or marker, 0 where there is none."""
    if hasattr(message, "header"):
        return message.header.stamp.to_nsec()
    if hasattr(message, "clock"):
        return message.clock.to_nsec()
    parts = _stamped_parts(message)
    return parts[0].header.stamp.to_nsec() if parts else 0


def shifted(message: Any, shift: int) -> Any:
    """The message with all its header stamps moved by so many ns, within ROS time."""
    message = copy.deepcopy(message)
    for part in [message, *_stamped_parts(message)]:
        if hasattr(part, "header"):
            moved = min(max(part.header.stamp.to_nsec() + shift, 0), LAST)
            part.header.stamp = genpy.Time(moved // SECOND, moved % SECOND)
    return message


def places(message: Any, types: dict[str, str]) -> Iterator[Place]:
    """Every number of the message that has one of the types, except those of headers."""
    for name, kind in zip(message.__slots__, message._slot_types):
        base, array, _ = kind.partition("[")
        value = getattr(message, name)
        if base in types:
            for index in range(len(value)) if array else [None]:
                yield message, name, index, base
        elif base == "std_msgs/Header" or base in ("string", "time", "duration", "bool", *FLOATS,
                                                   *INTEGERS):
            continue
        else:
            for part in value if array else [value]:
                yield from places(part, types)


def _change(place: Place, change: Callable[[Any], Any]) -> None:
    owner, name, index, _ = place
    if index is None:
        setattr(owner, name, change(getattr(owner, name)))
        return
    values: Any = getattr(owner, name)
    values = bytearray(values) if isinstance(values, bytes) else list(values)
    values[index] = change(values[index])
    setattr(owner, name, bytes(values) if isinstance(values, bytearray) else values)


def _one_number(message, types, draw, change):
    message = copy.deepcopy(message)
    found = list(places(message, types))
    if found:
        place = draw.choice(found)
        _change(place, lambda value: change(value, place[3]))
    return message


def flipped_bit(value: float | int, kind: str, bit: int) -> float | int:
    code = {**FLOATS, **INTEGERS}[kind]
    raw = bytearray(struct.pack("<" + code, value))
    raw[bit // 8 % len(raw)] ^= 1 << bit % 8
    return struct.unpack("<" + code, raw)[0]


def _bits(message, draw):
    bit = draw.randrange(64)
    return _one_number(message, {**FLOATS, **INTEGERS}, draw,
                       lambda value, kind: flipped_bit(value, kind, bit))


def _detections(message, change):
    message = copy.deepcopy(message)
    for detection in message.detections:
        if detection.id == TAG:
            change(detection.pose.pose)
    return message


def _move_aside(pose, metres):
    pose.position.x += metres


def mirrored(orientation: np.ndarray, position: np.ndarray) -> np.ndarray:
    """The other solution of a plane square's pose: its normal mirrored at the line of sight."""
    sight = -position / np.linalg.norm(position)
    turn = Rotation.from_quat(orientation)
    normal = turn.apply([0.0, 0.0, 1.0])
    other = 2.0 * (normal @ sight) * sight - normal
    axis = np.cross(normal, other)
    length = np.linalg.norm(axis)
    if length < 1e-12:
        return orientation
    angle = math.atan2(length, normal @ other)
    return (Rotation.from_rotvec(axis / length * angle) * turn).as_quat()


def _flip(pose):
    q, p = pose.orientation, pose.position
    q.x, q.y, q.z, q.w = mirrored(np.array([q.x, q.y, q.z, q.w]), np.array([p.x, p.y, p.z]))


def _picture(message, change):
    message = copy.copy(message)
    grey = np.frombuffer(message.data, dtype=np.uint8).reshape(message.height, message.step).copy()
    message.data = change(grey).tobytes()
    return message


def _occluded(grey, share):
    rows, columns = (round(share * size) for size in grey.shape)
    top, left = (grey.shape[0] - rows) // 2, (grey.shape[1] - columns) // 2
    grey[top:top + rows, left:left + columns] = 20
    return grey


def _exposed(grey, gain):
    return np.clip(gain * grey.astype(float), 0.0, 255.0).astype(np.uint8)


def _shares(change: Callable[[Any, random.Random], list[tuple[float, Any]]], share: float) -> Effect:
    return lambda message, draw: (change(message, draw) if draw.random() < share
                                  else [(0.0, message)])


def effect_of(fault: Fault) -> Effect:
    """What the fault makes of a message while it acts."""
    amount = fault.amount
    instead: dict[str, Callable[[Any, random.Random], Any]] = {
        "nan": lambda message, draw: _one_number(message, FLOATS, draw, lambda *_: math.nan),
        "huge": lambda message, draw: _one_number(
            message, FLOATS, draw, lambda _, kind: 1e300 if kind == "float64" else 1e38),
        "bits": _bits,
        "flip": lambda message, _: _detections(message, _flip)}
    if fault.name in instead:
        return _shares(lambda message, draw: [(0.0, instead[fault.name](message, draw))], amount)
    effects: dict[str, Effect] = {
        "drop": _shares(lambda *_: [], amount),
        "delay": lambda message, _: [(amount, message)],
        "duplicate": _shares(lambda message, _: [(0.0, message)] * 2, amount),
        "old": lambda message, _: [(0.0, message), (0.0, shifted(message, -int(SECOND * amount)))],
        "ahead": lambda message, _: [(0.0, message), (0.0, shifted(message, int(SECOND * amount)))],
        "false_tag": lambda message, _: [(0.0, _detections(message, lambda p: _move_aside(p, amount)))],
        "occlusion": lambda message, _: [
            (0.0, _picture(message, lambda grey: _occluded(grey, amount)))],
        "exposure": lambda message, _: [
            (0.0, _picture(message, lambda grey: _exposed(grey, amount)))]}
    return effects[fault.name]


class Channel:
    """The messages of one topic on their way through its faults."""

    def __init__(self, faults: list[Fault], seed: int, tell: Callable[[Fault, int], None]):
        self._faults = [fault for fault in faults if fault.name not in ("reorder", "second")]
        self._effects = {fault: effect_of(fault) for fault in self._faults}
        self._reorder = [fault for fault in faults if fault.name == "reorder"]
        self._seed, self._tell = seed, tell
        self._done: set[Fault] = set()  # of those that happen once
        self._held: list[tuple[int, int, Any]] = []  # (due ns, order, message)
        self._late: list[Any] = []  # reordered, until the next message
        self._count = 0

    def _draw(self, fault, stamp):
        return random.Random(f"{self._seed} {fault.word} {stamp}")

    def take(self, message: Any, start: int) -> list[Any]:
        """What comes out when the message comes in; `start` is the stamp of the first tick, ns."""
        stamp = stamp_of(message)
        seconds = (stamp - start) / SECOND
        coming: list[tuple[float, Any]] = [(0.0, message)]
        for fault in self._faults:
            once = not fault.kind.lasts
            if not fault.acts_at(seconds) or (once and fault in self._done):
                continue
            before, coming = coming, []
            for delay, one in before:
                coming += [(delay + more, result)
                           for more, result in self._effects[fault](one, self._draw(fault, stamp))]
            if once:
                self._done.add(fault)
            if len(coming) != len(before) or any(a[0] != b[0] or a[1] is not b[1]
                                                 for a, b in zip(coming, before)):
                self._tell(fault, stamp)
        for delay, one in coming:
            if delay > 0.0:
                self._count += 1
                self._held.append((stamp + round(SECOND * delay), self._count, one))
        now = [one for delay, one in coming if delay == 0.0]
        return self.due(stamp) + self._reordered(now, seconds, stamp)

    def _reordered(self, now, seconds, stamp):
        late, self._late = self._late, []
        for fault in self._reorder:
            if now and fault.acts_at(seconds) and not late and (
                    self._draw(fault, stamp).random() < fault.amount):
                self._tell(fault, stamp)
                self._late, now = now, []
        return now + late

    def due(self, stamp: int) -> list[Any]:
        """Delayed messages whose time has come at a stamp."""
        ready = sorted(entry[:2] for entry in self._held if entry[0] <= stamp)
        found = {entry[:2]: entry[2] for entry in self._held}
        self._held = [entry for entry in self._held if entry[0] > stamp]
        return [found[key] for key in ready]
