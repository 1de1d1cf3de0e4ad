# SPDX-License-Identifier: BSD-3-Clause
"""The verdict of a trial, from its bag alone.

The rules (fixed; they measure the framework and are not to be tuned):

  Reached    The tag's centre is within 100 mm of the camera's optical axis and its distance along
             the axis within 100 mm of the stand-off, continuously for 1.0 s, by ground truth,
             within 60 s.
  Inspected  The same with 40 mm and 2.0 s; reported beside the verdict.
  S          Reached, and no issue.
  P          Reached, with an issue: contact of arm, hand or camera with box, panel, platform or
             body above 1 N, or the tag out of view for more than 1.0 s after it was first seen.
  F          Not reached, or such a contact above 50 N, or the robot fell, or the arm stopped for
             an error.
  INVALID    The recording or a process failed; never S, P or F.

Where faults were injected, gaps in what the framework says are part of the trial; what the
simulator says must be whole all the same. A robot's bag, of real_robot.launch or of a replay, has no
ground truth: hand and target are then what its sensors say, and the reason says so.
"""
from dataclasses import dataclass, field

import numpy as np

from prf_experiments import geometry
from prf_experiments.judge import smoothness, target
from prf_experiments.record.recording import Contact, Recording
from prf_msgs import enums, interfaces
from prf_msgs.msg import ControlStatus, ExecutionProgress

SECOND = 1_000_000_000  # ns

STAND_OFF = 0.30  # m, camera to tag along the optical axis, as demonstrated
REACHED_BOUND = 0.100  # m, across and along the axis
REACHED_HOLD = 1 * SECOND
INSPECTED_BOUND = 0.040  # m
INSPECTED_HOLD = 2 * SECOND
TIME_LIMIT = 60 * SECOND
CONTACT_ISSUE = 1.0  # N
EMERGENCY_STOP = 50.0  # N
OUT_OF_VIEW_LIMIT = 1 * SECOND

FALLEN_HEIGHT = interfaces.load().fallen_height  # m, body above the deck along the deck's normal
FALLEN_TILT = interfaces.load().fallen_tilt  # rad, body's z axis to the deck's normal
OBSTACLE = "obstacle"  # the link that the simulator puts in the way
LYING = ("body", "platform")  # links whose contact means the same

LONGEST_GAP = SECOND // 2  # of a robot's joint_states
ESTIMATED = "by the robot's own sensors: no ground truth, contacts not known"
MAX_IMAGES_IN_FLIGHT = 3  # in flight when the trial ends

STATES = enums.names(ExecutionProgress)
EXECUTION = (ExecutionProgress.FORWARD, ExecutionProgress.PAUSE, ExecutionProgress.REVERSE)
TRACKING = (ExecutionProgress.TRACKING,)


@dataclass
class Verdict:
    verdict: str  # S, P, F or INVALID
    inspected: bool
    reason: str
    figures: dict = field(default_factory=dict)

    def as_json(self) -> dict:
        return {"verdict": self.verdict, "inspected": self.inspected, "reason": self.reason,
                "figures": self.figures}


def invalid(reason: str) -> Verdict:
    return Verdict("INVALID", False, reason)


def tag_in_camera(camera: np.ndarray, tag: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance of the tag's centre from the optical axis and along it, (n,) and (n,) m."""
    position = geometry.compose(geometry.inverse(camera), tag)[:, :3]
    return np.hypot(position[:, 0], position[:, 1]), position[:, 2]


def held(stamps: np.ndarray, inside: np.ndarray, hold: int) -> int | None:
    """First stamp at which `inside` has lasted `hold` ns without a break, or None."""
    since = None
    for stamp, good in zip(stamps, inside):
        since = (stamp if since is None else since) if good else None
        if since is not None and stamp - since >= hold:
            return int(stamp)
    return None


def longest_out_of_view(stamps: np.ndarray, seen: np.ndarray) -> int:
    """Longest time in ns between two detections of the tag, or the last one and the last image."""
    if not np.any(seen):
        return 0
    first = int(np.argmax(seen))
    detected = np.append(stamps[first:][seen[first:]], stamps[-1])
    return int(np.max(np.diff(detected)))


def arm_contacts(recording: Recording) -> list[Contact]:
    """Contacts of arm, hand or camera with anything that is not part of them.

    The arm's base is bolted to the body and counts as body.
    """
    moves = recording.robot.moves
    return [contact for contact in recording.contacts
            if moves(contact.links[0]) != moves(contact.links[1])]


def strongest_by_pair(contacts: list[Contact]) -> dict[str, float]:
    strongest: dict[str, float] = {}
    for contact in contacts:
        pair = " | ".join(contact.links)
        strongest[pair] = max(strongest.get(pair, 0.0), contact.force)
    return strongest


def obstacle_contact(recording: Recording) -> float | None:
    """Largest force of arm, hand or camera on the obstacle, N; None when none stood there."""
    if recording.description.get("arguments", {}).get("obstacle", "none") == "none":
        return None
    return max((contact.force for contact in arm_contacts(recording)
                if OBSTACLE in contact.links), default=0.0)


def posture(platform: np.ndarray, base: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Height of the body above the deck, m, and its tilt against the deck, rad."""
    relative = geometry.compose(geometry.inverse(platform), base)
    up = geometry.rotation(relative).apply([0.0, 0.0, 1.0])
    return relative[:, 2], np.arccos(np.clip(up[:, 2], -1.0, 1.0))


def _gap(recording):
    """Of a robot's bag, whose stamps jitter: a gap that hides what happened; "" when there is none."""
    for name, stamps in (("joint_states", recording.ticks), ("execution/progress", recording.progress.stamps)):
        lost = np.flatnonzero(np.diff(stamps) > LONGEST_GAP)
        if lost.size:
            return (f"{name} breaks off {recording.seconds(stamps[lost[0]]):.2f} s into the run: next stamp "
                    f"{(stamps[lost[0] + 1] - stamps[lost[0]]) * 1e-9:.3f} s later")
    return ""


def defect(recording: Recording) -> str:
    """Why the recording is no evidence, or an empty string."""
    if len(recording.ticks) < 2:
        return "no two ticks of joint_states were recorded"
    if recording.is_estimated:
        return _gap(recording)
    series = {"joint_states": recording.ticks, "ground_truth/tag": recording.tag.stamps,
              "ground_truth/camera": recording.camera.stamps,
              "ground_truth/base": recording.base.stamps,
              "ground_truth/platform": recording.platform.stamps,
              "ground_truth/contacts": recording.contact_stamps}
    arguments = recording.description.get("arguments", {})
    injected = bool(arguments.get("fault"))
    if not injected:
        series["execution/progress"] = recording.progress.stamps
    for name, stamps in series.items():
        lost = np.flatnonzero(np.diff(stamps) != recording.tick)
        if lost.size:
            return (f"{name} breaks off {recording.seconds(stamps[lost[0]]):.2f} s into the trial: "
                    f"next stamp {(stamps[lost[0] + 1] - stamps[lost[0]]) * 1e-9:.3f} s later")
        if (abs(stamps[0] - recording.ticks[0]) > recording.tick
                or abs(stamps[-1] - recording.ticks[-1]) > recording.tick):
            return (f"{name} covers {recording.seconds(stamps[0]):.2f} to "
                    f"{recording.seconds(stamps[-1]):.2f} s of a trial of "
                    f"{recording.seconds(recording.ticks[-1]):.2f} s")
    for name in ("tag", "camera", "base", "platform"):
        if not np.all(np.isfinite(getattr(recording, name).values)):
            return f"ground_truth/{name} is not finite"
    in_flight = recording.images - len(recording.detection_stamps)
    if not injected and not 0 <= in_flight <= MAX_IMAGES_IN_FLIGHT:
        return f"{recording.images} images but {len(recording.detection_stamps)} tag_detections"
    # After its end the execution may leave the target again.
    finished = (np.isin(recording.progress.states,
                        (ExecutionProgress.DONE, ExecutionProgress.STOPPED)).any()
                or _fall(recording)[0] is not None)
    duration = recording.ticks[-1] - recording.ticks[0]
    limit = min(TIME_LIMIT, round(SECOND * float(arguments.get("time_limit", TIME_LIMIT / SECOND))))
    if not finished and duration < limit - 2 * recording.tick:
        return (f"the trial ends after {duration * 1e-9:.2f} s in state "
                f"{STATES[recording.progress.states[-1]]}, before its time")
    return ""


def distances(recording: Recording) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stamps that camera and tag share, with the tag's distance off the axis and along it, m."""
    stamps, at_camera, at_tag = np.intersect1d(recording.camera.stamps, recording.tag.stamps,
                                               return_indices=True)
    lateral, along = tag_in_camera(recording.camera.values[at_camera],
                                   recording.tag.values[at_tag])
    return stamps, lateral, along


def _reached(stamps, lateral, along, bound, hold, deadline):
    inside = (lateral <= bound) & (np.abs(along - STAND_OFF) <= bound) & (stamps <= deadline)
    return held(stamps, inside, hold)


def _fall(recording):
    """(stamp or None, lowest height, largest tilt) of the body against the deck; one bolted to it does not fall."""
    stamps, at_platform, at_base = np.intersect1d(recording.platform.stamps, recording.base.stamps,
                                                  return_indices=True)
    height, tilt = posture(recording.platform.values[at_platform], recording.base.values[at_base])
    fallen = list(stamps[(height < FALLEN_HEIGHT) | (tilt > FALLEN_TILT)]) if recording.robot.on_legs else []
    fallen += [contact.stamp for contact in recording.contacts if contact.links == LYING]
    return int(min(fallen)) if fallen else None, float(np.min(height)), float(np.max(tilt))


def _lateral_statistics(recording, states, stamps, lateral):
    """Mean and standard deviation of the lateral distance in some states, mm, or two None."""
    chosen = lateral[np.isin(stamps, recording.progress.stamps[
        np.isin(recording.progress.states, states)])]
    if not chosen.size:
        return None, None
    return 1e3 * float(np.mean(chosen)), 1e3 * float(np.std(chosen))


def _following(recording):
    """Mean and largest distance of the measured hand from the set-point, mm, or two None."""
    stamps, errors = recording.following()
    moving = recording.control.stamps[np.isin(
        recording.control.codes, (ControlStatus.FOLLOWING, ControlStatus.LIMITED))]
    errors = 1e3 * errors[np.isin(stamps, moving), 0]
    errors = errors[np.isfinite(errors)]
    return {"following_error_mean_mm": float(np.mean(errors)) if len(errors) else None,
            "following_error_largest_mm": float(np.max(errors)) if len(errors) else None}


def judge(recording: Recording) -> Verdict:
    """Verdict of a complete recording."""
    broken = defect(recording)
    if broken:
        return invalid(broken)

    stamps, lateral, along = distances(recording)
    deadline = recording.start + TIME_LIMIT
    reached = _reached(stamps, lateral, along, REACHED_BOUND, REACHED_HOLD, deadline)
    inspected = _reached(stamps, lateral, along, INSPECTED_BOUND, INSPECTED_HOLD, deadline)
    seen = np.isfinite(recording.detections[:, 0])
    out_of_view = longest_out_of_view(recording.detection_stamps, seen)
    touching = arm_contacts(recording)
    pairs = strongest_by_pair(touching)
    force = max(pairs.values(), default=0.0)
    fall, height, tilt = _fall(recording)
    stopped = np.flatnonzero(recording.progress.states == ExecutionProgress.STOPPED)

    failures, issues = [], []
    if stopped.size:
        when = recording.seconds(recording.progress.stamps[stopped[0]])
        failures.append(f"the arm stopped at {when:.2f} s: "
                        + (recording.progress.reasons[stopped[0]] or "no reason given"))
    failures += harm(recording)
    if CONTACT_ISSUE < force <= EMERGENCY_STOP:
        issues.append(_contact_sentence(recording, touching, CONTACT_ISSUE))
    if reached is None:
        failures.append(_not_reached_sentence(lateral, along))
    if out_of_view > OUT_OF_VIEW_LIMIT:
        issues.append(f"tag out of view for {out_of_view * 1e-9:.2f} s")

    reach = "" if reached is None else f"reached at {recording.seconds(reached):.2f} s"
    verdict = "F" if failures else "P" if issues else "S"
    reasons = failures + issues if failures else [reach] + (issues or ["no issue"])
    if recording.is_estimated:
        reasons.append(ESTIMATED)
    execution_mean, execution_deviation = _lateral_statistics(recording, EXECUTION, stamps, lateral)
    tracking_mean, tracking_deviation = _lateral_statistics(recording, TRACKING, stamps, lateral)
    horizon, forecast_error = target.forecast_error(recording)
    figures = {
        "duration_s": float(recording.seconds(recording.ticks[-1])),
        "reached_s": None if reached is None else float(recording.seconds(reached)),
        "inspected_s": None if inspected is None else float(recording.seconds(inspected)),
        "first_seen_s": (float(recording.seconds(recording.detection_stamps[np.argmax(seen)]))
                         if np.any(seen) else None),
        "longest_out_of_view_s": out_of_view * 1e-9,
        "images_seen_fraction": float(np.mean(seen)),
        "largest_contact_n": force,
        "largest_contact_by_pair_n": pairs,
        "largest_obstacle_contact_n": obstacle_contact(recording),
        "smallest_lateral_mm": 1e3 * float(np.min(lateral)),
        "smallest_along_error_mm": 1e3 * float(np.min(np.abs(along - STAND_OFF))),
        "final_lateral_mm": 1e3 * float(lateral[-1]),
        "final_along_error_mm": 1e3 * float(along[-1] - STAND_OFF),
        "execution_lateral_mean_mm": execution_mean,
        "execution_lateral_deviation_mm": execution_deviation,
        "tracking_lateral_mean_mm": tracking_mean,
        "tracking_lateral_deviation_mm": tracking_deviation,
        "holdable_mm": _holdable(recording),
        **_following(recording),
        **smoothness.figures(recording),
        "forecast_horizon_s": horizon,
        "forecast_error_rms_mm": forecast_error,
        "fallen_s": None if fall is None else float(recording.seconds(fall)),
        "lowest_body_height_mm": 1e3 * height,
        "largest_body_tilt_deg": float(np.degrees(tilt)),
        "final_state": STATES[recording.progress.states[-1]],
    }
    return Verdict(verdict, inspected is not None, "; ".join(reasons), figures)


def _holdable(recording):
    known = recording.progress.holdable[np.isfinite(recording.progress.holdable)]
    return 1e3 * float(known.max()) if len(known) else None


def harm(recording: Recording) -> list[str]:
    """What fails a trial whatever else happens: a fall, a contact above EMERGENCY_STOP."""
    found = []
    fall, _, _ = _fall(recording)
    if fall is not None:
        found.append(f"the robot fell at {recording.seconds(fall):.2f} s")
    touching = arm_contacts(recording)
    if any(contact.force > EMERGENCY_STOP for contact in touching):
        found.append(_contact_sentence(recording, touching, EMERGENCY_STOP))
    return found


def _contact_sentence(recording, contacts, threshold):
    first = next(contact for contact in contacts if contact.force > threshold)
    strongest = max(contacts, key=lambda contact: contact.force)
    return (f"contact above {threshold:g} N at {recording.seconds(first.stamp):.2f} s "
            f"({first.links[0]} with {first.links[1]}), at most {strongest.force:.1f} N")


def _not_reached_sentence(lateral, along):
    worst = np.maximum(lateral, np.abs(along - STAND_OFF))
    best = int(np.argmin(worst))
    return (f"not reached: at best {1e3 * lateral[best]:.0f} mm beside the axis and "
            f"{1e3 * (along[best] - STAND_OFF):+.0f} mm along it")
