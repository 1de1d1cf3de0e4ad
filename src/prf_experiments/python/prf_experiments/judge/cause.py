# SPDX-License-Identifier: BSD-3-Clause
"""Why a trial came out as it did, in one sentence from its bag; the verdict is the judge's alone.

Three parts: what the world did, what the chain did, and where it was lost. At the moment that
decides, the hand is away from where it should be by the sum of three: how wrong the framework's
belief in the target was, how far the hand was from its set-point, and the plan's share, the rest.
"""
from dataclasses import dataclass

import numpy as np

from prf_experiments import geometry
from prf_experiments.judge import judge, target, timeline, world
from prf_experiments.record.recording import Recording
from prf_msgs.msg import ExecutionProgress, SkillTrajectory

LONG_VIEW_GAP = judge.SECOND // 2  # shorter ones are no cause
MOST_EVENTS = 3  # named in one sentence
LARGE_SHARE = 0.5  # of the whole error: there it was lost
USABLE = (SkillTrajectory.SOLVED, SkillTrajectory.RELAXED, SkillTrajectory.KEPT)


@dataclass(frozen=True)
class Shares:
    """Distances at one moment, mm; None where the bag does not tell."""

    whole: float  # tag from where the camera should have it
    belief: float | None  # target as it was believed from where it was
    arm: float | None  # hand from its set-point


def _blind(data):
    return data.description.get("arguments", {}).get("framework") is False


def gaps(data: Recording, least: int = LONG_VIEW_GAP) -> list[tuple[int, int]]:
    """[(ns, ns)] between which the tag was not seen for longer than `least`, after it once was."""
    seen = data.detection_stamps[np.isfinite(data.detections[:, 0])]
    until = np.append(seen[1:], data.detection_stamps[-1:])
    return [(int(lost), int(found)) for lost, found in zip(seen, until) if found - lost > least]


def believed(data: Recording, stamp: int) -> np.ndarray | None:
    """Where the framework believed the target at a stamp, (3,) m in the arm's base; None: nowhere.

    Blindly, by the forecast of the first plan; else by the latest one.
    """
    plans = [plan for plan in data.plans if plan.status in USABLE and plan.stamp <= stamp]
    made = data.forecasts.stamps
    latest = plans[0].forecast_stamp if _blind(data) and plans else stamp
    rows = [row for row in np.flatnonzero(made <= latest) if len(data.forecasts.horizons[row])]
    if not rows or (_blind(data) and not plans):
        return None
    row = rows[-1]
    ahead = 1e-9 * (stamp - int(made[row]))
    return np.array([np.interp(ahead, data.forecasts.horizons[row], column)
                     for column in data.forecasts.positions[row].T])


def shares(data: Recording, stamp: int) -> Shares:
    stamps, camera, tag = target.matched(data.camera, data.tag)
    row = min(int(np.searchsorted(stamps, stamp)), len(stamps) - 1)
    seen_at = geometry.compose(geometry.inverse(camera[row]), tag[row])[:3]
    whole = 1e3 * float(np.linalg.norm(seen_at - [0.0, 0.0, judge.STAND_OFF]))
    true_stamps, true = target.true(data)
    place = believed(data, int(stamps[row]))
    at = min(int(np.searchsorted(true_stamps, stamp)), len(true_stamps) - 1)
    belief = None if place is None else 1e3 * float(np.linalg.norm(place - true[at]))
    arm = float(timeline.following_at(data, stamps[row:row + 1])[0])
    return Shares(whole, belief, arm if np.isfinite(arm) else None)


def _number(value):
    return "unknown" if value is None else f"{value:.0f} mm"


def _where(found: Shares) -> str:
    """Where most of an error was, with the other shares."""
    told = {"forecast": found.belief, "arm": found.arm}
    worst = max(told, key=lambda name: told[name] or 0.0)
    where = worst if (told[worst] or 0.0) >= LARGE_SHARE * found.whole else "plan"
    return (f"lost in the {where}: target believed {_number(found.belief)} from where it was, hand "
            f"{_number(found.arm)} from its set-point")


def _world(data, until):
    """[(stamp, clause)] of what happened before a stamp, and of when the tag was out of view."""
    found = [event for event in world.events(data) if event.begin <= until]
    told = [(event.begin, f"{event.text} {world.when(data, event.begin, event.end)}")
            for event in found]
    if len(told) > MOST_EVENTS:
        more = len(told) - MOST_EVENTS
        told = [*told[:MOST_EVENTS], (told[MOST_EVENTS][0], f"{more} more events")]
    hidden = [gap for gap in gaps(data) if gap[0] <= until]
    if not hidden:
        return told
    first, last = max(hidden, key=lambda gap: gap[1] - gap[0])
    view = f"the tag was out of view {world.when(data, first, last)}"
    overlaps = [min(event.end, last) - max(event.begin, first) for event in found[:MOST_EVENTS]]
    most = int(np.argmax(overlaps)) if overlaps else 0
    if overlaps and overlaps[most] >= 0:
        told[most] = (told[most][0], f"{told[most][1]}, while {view}")
        return told
    return [*told, (first, view)]


def _waits(data):
    """How long the execution stood or went back, and what for; "" when not."""
    progress = data.progress
    told = []
    for state, words in ((ExecutionProgress.WAITING, "waited"), (ExecutionProgress.PAUSE, "stood still"),
                         (ExecutionProgress.REVERSE, "went back"),
                         (ExecutionProgress.SEARCH, "searched the target")):
        rows = np.flatnonzero(progress.states == state)
        seconds = 1e-9 * data.tick * len(rows)
        if seconds >= 1.0:
            reasons = [progress.reasons[row] for row in rows if progress.reasons[row]]
            why = max(set(reasons), key=lambda reason: (reasons.count(reason), reason), default="")
            told.append(f"{words} for {seconds:.1f} s" + (f" ({why})" if why else ""))
    return "the skill " + ", ".join(told) if told else ""


def _adapted(data):
    plans = [plan for plan in data.plans if plan.status in USABLE]
    if not plans:
        last = next((plan.message for plan in reversed(data.plans) if plan.message), "")
        return "no plan was made" + (f": {last}" if last else "")
    if _blind(data):
        return (f"the skill was adapted once, at {float(data.seconds(plans[0].stamp)):.1f} s, and "
                "executed blindly")
    return ""


def _lost(data):
    """Why the target was not reached."""
    if not np.isfinite(data.detections[:, 0]).any():
        return ["the tag was never seen, so there was nothing to go to"]
    tracked = data.progress.stamps[data.progress.states == ExecutionProgress.TRACKING]
    clauses = [_adapted(data)]
    if not len(tracked):
        clauses += ["it did not come to the end of the skill", _waits(data)]
        return clauses
    clauses.append(_waits(data))
    stamp = int(tracked[-1])
    found = shares(data, stamp)
    clauses.append(f"at the end of the skill, at {float(data.seconds(stamp)):.1f} s, the tag was "
                   f"{found.whole:.0f} mm from where the camera should have it, " + _where(found))
    return clauses


def _touched(data):
    """[(stamp, clause)] of the first contact that counts."""
    first = next((contact for contact in judge.arm_contacts(data)
                  if contact.force > judge.CONTACT_ISSUE), None)
    if first is None:
        return []
    row = max(0, int(np.searchsorted(data.progress.stamps, first.stamp, side="right")) - 1)
    state = judge.STATES[data.progress.states[row]]
    found = shares(data, first.stamp)
    return [(first.stamp, f"contact of {first.links[0]} and {first.links[1]} at "
             f"{float(data.seconds(first.stamp)):.1f} s in {state}, with the target believed "
             f"{_number(found.belief)} from where it was and the hand {_number(found.arm)} from its "
             "set-point")]


def _quiet(data, figures):
    """What the chain did in a trial that nothing disturbed."""
    told = [_adapted(data), _waits(data)]
    if figures.get("forecast_error_rms_mm") is not None:
        told.append(f"forecasts {figures['forecast_horizon_s']:.1f} s ahead were "
                    f"{figures['forecast_error_rms_mm']:.0f} mm off (rms)")
    if figures.get("following_error_mean_mm") is not None:
        told.append(f"the hand was {figures['following_error_mean_mm']:.0f} mm from its set-point "
                    "on average")
    return told


def sentence(data: Recording, verdict: judge.Verdict) -> str:
    """The cause; "" for a trial that is no evidence."""
    if verdict.verdict == "INVALID":
        return ""
    figures = verdict.figures
    reached = figures.get("reached_s")
    # Of a success the world matters until it was reached, of anything else until the end.
    until = int(data.ticks[-1]) if verdict.verdict != "S" or reached is None else (
        data.start + int(1e9 * reached))
    in_time = _world(data, until)
    if verdict.verdict == "S":
        rest = _quiet(data, figures)
    else:
        in_time += _touched(data)
        rest = _lost(data) if reached is None else [_adapted(data), _waits(data)]
    clauses = [clause for _, clause in sorted(in_time)] + [clause for clause in rest if clause]
    text = "; ".join(clauses)
    return text[:1].upper() + text[1:] + "." if text else ""
