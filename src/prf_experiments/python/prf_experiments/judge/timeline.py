# SPDX-License-Identifier: BSD-3-Clause
"""A trial as a list of events and a few figures: text for people without a display."""
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from prf_experiments.judge import judge, reaction, world
from prf_experiments.record.recording import TICK, Recording
from prf_msgs import enums
from prf_msgs.msg import ControlStatus, SkillTrajectory, TargetForecast

FORECASTS, PLANS, CONTROLS = (
    [name.lower().replace("_", " ") for name in enums.names(message_type)]
    for message_type in (TargetForecast, SkillTrajectory, ControlStatus))
ORDINARY_CONTROLS = (ControlStatus.FOLLOWING, ControlStatus.HOLDING)
GAP = judge.SECOND // 2  # what happens again within it is one event
OUT_OF_VIEW = judge.SECOND // 5  # shorter gaps between detections are not told
MOST_OF_A_KIND = 25  # events; what exceeds it is counted only
COUNTS_OF_NO_LOSS = {"ticks", "images", "tags", "plans sent", "measurements accepted",
                     "starts from measured joints",
                     "answers"}  # plans sent, in older bags


@dataclass(frozen=True)
class Event:
    stamp: int  # ns
    kind: str
    text: str


def episodes(stamps: Sequence[int] | np.ndarray, gap: int = GAP) -> list[slice]:
    """Slices of rising `stamps` whose neighbours are at most `gap` apart."""
    if not len(stamps):
        return []
    cuts = np.flatnonzero(np.diff(stamps) > gap) + 1
    edges = [0, *(int(cut) for cut in cuts), len(stamps)]
    return [slice(first, last) for first, last in zip(edges, edges[1:])]


def changes(values: Sequence[int] | np.ndarray) -> list[int]:
    """Rows at which a new value begins, the first one included."""
    return [0, *(int(row) + 1 for row in np.flatnonzero(np.diff(values)))] if len(values) else []


def _lasting(stamps):
    return f"{1e-9 * (stamps[-1] - stamps[0] + TICK):.2f} s"


def _phases(data):
    progress = data.progress
    for row in changes(progress.states):
        reason = progress.reasons[row]
        yield Event(int(progress.stamps[row]), "phase",
                    judge.STATES[progress.states[row]] + (f": {reason}" if reason else ""))


def _detections(data):
    seen = data.detection_stamps[np.isfinite(data.detections[:, 0])]
    if not len(seen):
        yield Event(data.start, "detection", "the tag is never seen")
        return
    yield Event(int(seen[0]), "detection", "the tag is seen for the first time")
    until = np.append(seen[1:], data.detection_stamps[-1])
    for lost, found in zip(seen, until):
        if found - lost > OUT_OF_VIEW:
            yield Event(int(lost), "detection",
                        f"the tag is out of view for {1e-9 * (found - lost):.2f} s")


def _forecasts(data):
    for row in changes(data.forecasts.statuses):
        yield Event(int(data.forecasts.stamps[row]), "forecast",
                    "forecast: " + FORECASTS[data.forecasts.statuses[row]])


def _plans(data):
    for row in changes([plan.status for plan in data.plans]):
        plan = data.plans[row]
        yield Event(plan.stamp, "plan", "plan: " + PLANS[plan.status]
                    + (f", {plan.message}" if plan.message else ""))


def _control(data):
    control = data.control
    for code, name in enumerate(CONTROLS):
        if code in ORDINARY_CONTROLS:
            continue
        rows = np.flatnonzero(control.codes == code)
        for part in episodes(control.stamps[rows]):
            chosen = rows[part]
            stamps = control.stamps[chosen]
            yield Event(int(stamps[0]), "arm", f"arm: {name}, {len(chosen)} ticks within "
                        f"{_lasting(stamps)}: {control.reasons[chosen[0]]}")


def _contacts(data):
    by_pair: dict[tuple, list] = {}
    for contact in judge.arm_contacts(data):
        by_pair.setdefault(contact.links, []).append(contact)
    for links, contacts in by_pair.items():
        stamps = np.array([contact.stamp for contact in contacts])
        for part in episodes(stamps):
            force = max(contact.force for contact in contacts[part])
            yield Event(int(stamps[part][0]), "contact", f"contact: {links[0]} with {links[1]}, "
                        f"at most {force:.1f} N within {_lasting(stamps[part])}")


def _logged_warnings(data):
    told = set(data.control.reasons)  # these are told as what the arm could not do
    for warning in data.warnings:
        if warning.text not in told:
            yield Event(max(warning.stamp, data.start), "log",
                        f"log of {warning.node}: {warning.text}")


def _faults(data):
    for fault, first, last, count, told in reaction.episodes(data):
        if world.is_disturbance(fault) or fault in world.camera_words(data):  # told as the world's
            continue
        span = f", {count} times within {1e-9 * (last - first):.2f} s" if count > 1 else ""
        yield Event(first, "fault", f"FAULT {fault}{span}" + "".join(": " + what for what in told))


def _world(data):
    for event in world.events(data):
        if not event.injected:  # those are told as faults
            yield Event(event.begin, "world", f"WORLD: {event.text}, until "
                        f"{float(data.seconds(event.end)):.2f} s")


def _milestones(data, figures):
    for key, text in (("reached_s", "reached, for 1.0 s by now"),
                      ("inspected_s", "inspected, for 2.0 s by now"), ("fallen_s", "fallen")):
        if figures.get(key) is not None:
            yield Event(data.start + int(round(1e9 * figures[key])), "verdict", text)


def _limited(data, events):
    """At most MOST_OF_A_KIND of the events; the last one says how many were left out."""
    events = sorted(events, key=lambda event: event.stamp)
    if len(events) > MOST_OF_A_KIND:
        more = events[MOST_OF_A_KIND:]
        events = events[:MOST_OF_A_KIND] + [
            Event(more[0].stamp, more[0].kind, f"… and {len(more)} more events of this kind, the "
                  f"last at {data.seconds(more[-1].stamp):.2f} s: {more[-1].text}")]
    return events


def events(data: Recording, figures: dict) -> list[Event]:
    """All events in the order of time. `figures` are those of the verdict."""
    told = []
    for kind in (_phases(data), _detections(data), _forecasts(data), _plans(data), _control(data),
                 _contacts(data), _logged_warnings(data), _faults(data), _world(data),
                 _milestones(data, figures)):
        told += _limited(data, kind)
    return sorted(told, key=lambda event: event.stamp)


def following_at(data: Recording, stamps: np.ndarray) -> np.ndarray:
    """mm from the set-point to the measured hand at the stamps, NaN before the first status."""
    told, errors = data.following()
    row = np.searchsorted(told, stamps, side="right") - 1
    if not len(errors):
        return np.full(len(stamps), np.nan)
    return np.where(row >= 0, 1e3 * errors[np.maximum(row, 0), 0], np.nan)


def event_lines(data: Recording, figures: dict) -> list[tuple[float, float, float, float, str]]:
    """[(time s, mm off the axis, mm from the stand-off, mm following error, text)] of each event."""
    stamps, lateral, along = judge.distances(data)
    lines = []
    for event in events(data, figures):
        row = min(int(np.searchsorted(stamps, event.stamp)), len(stamps) - 1)
        lines.append((float(data.seconds(event.stamp)), 1e3 * float(lateral[row]),
                      1e3 * float(along[row] - judge.STAND_OFF),
                      float(following_at(data, stamps[row:row + 1])[0]), event.text))
    return lines


def phase_lines(data: Recording) -> list[tuple[str, float, float, float, float, float, float]]:
    """[(phase, s spent, mean, standard deviation and largest mm off the axis, and the mean and
    largest following error, mm)]."""
    stamps, lateral, _ = judge.distances(data)
    lines = []
    for state, name in enumerate(judge.STATES):
        rows = np.isin(stamps, data.progress.stamps[data.progress.states == state])
        if rows.any():
            millimetres = 1e3 * lateral[rows]
            lines.append((name, 1e-9 * data.tick * int(rows.sum()), float(millimetres.mean()),
                          float(millimetres.std()), float(millimetres.max()),
                          *_mean_and_most(following_at(data, stamps[rows]))))
    return lines


def _mean_and_most(values):
    values = values[np.isfinite(values)]
    return (float(values.mean()), float(values.max())) if len(values) else (np.nan, np.nan)


def solve_times(data: Recording) -> dict[str, float]:
    """{median, 99 %, most: wall-clock µs} of all plans, as the planner's diagnostics told at last;
    empty for a bag that has none."""
    told = data.diagnostics.get("skill_planner", {})
    keys = {"median": "median solve time, us", "99 %": "99th percentile of solve times, us",
            "most": "longest solve time, us"}
    return {name: float(told[key][-1]) for name, key in keys.items() if key in told}


def losses(data: Recording) -> list[tuple[str, str, int]]:
    """[(node, what, count)] of everything that a node's diagnostics count as lost or refused."""
    found = []
    for node, values in sorted(data.diagnostics.items()):
        for key, texts in values.items():
            if key in COUNTS_OF_NO_LOSS or key.endswith(" received"):
                continue
            if texts[-1].isdigit() and int(texts[-1]) > 0:
                found.append((node, key, int(texts[-1])))
    return found


def text(data: Recording, verdict: judge.Verdict, cause: str = "") -> str:
    """The whole timeline, for a terminal of 100 columns or more."""
    inspected = " (inspected)" if verdict.inspected else ""
    lines = [f"{verdict.verdict}{inspected}: {verdict.reason}", *([cause] if cause else []), "",
             "  time, s  off axis, mm  to stand-off, mm  following, mm  event"]
    lines += [f"{time:9.2f}  {off:12.0f}  {to:+16.0f}  {following:13.1f}  {what}"
              for time, off, to, following, what in event_lines(data, verdict.figures)]
    lines += ["", "phase      spent, s  off axis, mm: mean     sd    most  following, mm: mean   most"]
    lines += [f"{name:<9}  {spent:8.2f}  {mean:18.1f}  {deviation:5.1f}  {most:6.1f}"
              f"  {followed:19.1f}  {farthest:5.1f}"
              for name, spent, mean, deviation, most, followed, farthest in phase_lines(data)]
    times = solve_times(data)
    lines += [""]
    if times:
        lines += [f"plans: {len(data.plans)}; solve time, wall clock: "
                  + ", ".join(f"{name} {value:.0f} µs" for name, value in times.items())]
    error = verdict.figures.get("forecast_error_rms_mm")
    if error is not None:
        lines += [f"forecasts {verdict.figures['forecast_horizon_s']:.2f} s ahead: "
                  f"{error:.1f} mm rms from the truth"]
    lines += [""] + [f"{node}: {key}: {count}" for node, key, count in losses(data)]
    return "\n".join(lines).rstrip() + "\n"
