# SPDX-License-Identifier: BSD-3-Clause
"""What the execution does about injected faults: how soon it holds, and how soon it goes on."""
from collections.abc import Sequence

import numpy as np

from prf_experiments.judge import judge
from prf_experiments.record.recording import Recording
from prf_msgs.msg import ExecutionProgress

GOING = (ExecutionProgress.FORWARD, ExecutionProgress.TRACKING, ExecutionProgress.DONE)
COMMAND_AGE = judge.SECOND // 20  # older: the arm stands where it was sent last
SETTLED = 30  # ticks that count as going on again
WINDOW = 5 * judge.SECOND  # after the last event in which a hold is put down to the fault
EPISODE = judge.SECOND // 2  # events of one fault that are closer are one


def latest(ticks: np.ndarray, stamps: np.ndarray) -> np.ndarray:
    """Row of the last stamp at or before each tick, -1 where there is none."""
    return np.searchsorted(stamps, ticks, side="right") - 1


def going(data: Recording) -> np.ndarray:
    """Whether the execution goes on at each tick: by its state, and by commands that come."""
    ticks, progress = data.ticks, data.progress
    row = latest(ticks, progress.stamps)
    told = (row >= 0) & (ticks - progress.stamps[row] <= COMMAND_AGE)
    moving = told & np.isin(progress.states[row], GOING)
    if data.commands is not None and len(data.commands.stamps):
        command = latest(ticks, data.commands.stamps)
        moving &= (command >= 0) & (ticks - data.commands.stamps[command] <= COMMAND_AGE)
    return moving


def episodes(data: Recording) -> list[tuple[str, int, int, int, Sequence[str]]]:
    """[(fault, first stamp, last stamp, events, what was told)] in the order of time."""
    found: list = []
    by_fault: dict[str, list] = {}
    for event in data.fault_events:
        by_fault.setdefault(event.fault, []).append(event)
    for fault, events in by_fault.items():
        events.sort(key=lambda event: event.stamp)
        part = [events[0]]
        for event in [*events[1:], None]:
            if event is None or event.stamp - part[-1].stamp > EPISODE:
                found.append((fault, part[0].stamp, part[-1].stamp, len(part),
                              [one.what for one in part if one.what]))
                part = []
            if event is not None:
                part.append(event)
    return sorted(found, key=lambda entry: entry[1])


def times(data: Recording) -> dict:
    """s from the first fault to a hold, and from there until the execution goes on; None: never."""
    figures: dict = {"fault_begin_s": None, "fault_end_s": None, "time_to_hold_s": None,
                     "time_to_recover_s": None, "fault_events_count": len(data.fault_events)}
    if not data.fault_events:
        return figures
    stamps = [event.stamp for event in data.fault_events]
    begin, end = min(stamps), max(stamps)
    figures["fault_begin_s"] = float(data.seconds(begin))
    figures["fault_end_s"] = float(data.seconds(end))
    moving, ticks = going(data), data.ticks
    held = np.flatnonzero(~moving & (ticks >= begin) & (ticks <= end + WINDOW))
    if not len(held):
        return figures
    figures["time_to_hold_s"] = 1e-9 * float(ticks[held[0]] - begin)
    run = 0
    for row in range(held[0], len(ticks)):
        run = run + 1 if moving[row] else 0
        if run == SETTLED:
            figures["time_to_recover_s"] = 1e-9 * float(ticks[row - SETTLED + 1] - ticks[held[0]])
            break
    return figures
