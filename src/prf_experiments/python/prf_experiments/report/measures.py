# SPDX-License-Identifier: BSD-3-Clause
"""Figures of merit in words and with their units, for people; files keep the keys."""
from collections.abc import Iterable
from typing import Any

from prf_experiments.report.page import shown

# {key of verdict.json: (words, unit, factor to that unit)}
WORDS: dict[str, tuple[str, str, float]] = {
    "duration_s": ("length of the trial", "s", 1.0),
    "reached_s": ("reached: within 100 mm for 1.0 s by", "s", 1.0),
    "inspected_s": ("inspected: within 40 mm for 2.0 s by", "s", 1.0),
    "first_seen_s": ("tag seen for the first time at", "s", 1.0),
    "longest_out_of_view_s": ("longest time without a detection", "s", 1.0),
    "images_seen_fraction": ("images in which the tag was detected", "%", 100.0),
    "largest_contact_n": ("largest contact of arm, hand or camera", "N", 1.0),
    "largest_obstacle_contact_n": ("largest contact with an obstacle", "N", 1.0),
    "smallest_lateral_mm": ("tag off the optical axis, at best", "mm", 1.0),
    "smallest_along_error_mm": ("tag from the stand-off along the axis, at best", "mm", 1.0),
    "final_lateral_mm": ("tag off the optical axis, at the end", "mm", 1.0),
    "final_along_error_mm": ("tag from the stand-off along the axis, at the end", "mm", 1.0),
    "execution_lateral_mean_mm": ("tag off the optical axis while the skill is executed, mean", "mm", 1.0),
    "execution_lateral_deviation_mm": ("the same, standard deviation", "mm", 1.0),
    "tracking_lateral_mean_mm": ("tag off the optical axis while the target is tracked, mean", "mm", 1.0),
    "tracking_lateral_deviation_mm": ("the same, standard deviation", "mm", 1.0),
    "holdable_mm": ("what this arm can hold of the target's motion: 95 % of 4 s, at worst", "mm", 1.0),
    "following_error_mean_mm": ("hand from its set-point while it moves, mean", "mm", 1.0),
    "following_error_largest_mm": ("the same, largest", "mm", 1.0),
    "joint_acceleration_rms_rad_s2": ("acceleration of the commanded joints, rms", "rad/s²", 1.0),
    "joint_jerk_rms_rad_s3": ("jerk of the commanded joints, rms", "rad/s³", 1.0),
    "approach_path_ratio": ("path of the hand over its net way on the last 0.2 m, seen from the tag", "", 1.0),
    "approach_shake_rms_mm": ("shake of the hand above 1.5 Hz there, rms", "mm", 1.0),
    "forecast_horizon_s": ("forecasts are compared with the truth so far ahead", "s", 1.0),
    "forecast_error_rms_mm": ("distance of these forecasts from the truth, rms", "mm", 1.0),
    "fallen_s": ("robot fell at", "s", 1.0),
    "lowest_body_height_mm": ("lowest height of the body above the deck", "mm", 1.0),
    "largest_body_tilt_deg": ("largest tilt of the body against the deck", "°", 1.0),
    "final_state": ("state of the execution at the end", "", 1.0),
    "largest_joint_step_rad": ("largest step between two joint commands", "rad", 1.0),
    "largest_velocity_share": ("largest joint velocity, of its limit", "%", 100.0),
    "largest_acceleration_share": ("largest joint acceleration, of its limit", "%", 100.0),
    "largest_lag_rad": ("largest distance of a command from the measured joint", "rad", 1.0),
    "commands_count": ("joint commands", "", 1.0),
    "fault_begin_s": ("first injected fault at", "s", 1.0),
    "fault_end_s": ("last injected fault at", "s", 1.0),
    "time_to_hold_s": ("from the first fault until the execution held", "s", 1.0),
    "time_to_recover_s": ("from there until it went on", "s", 1.0),
    "fault_events_count": ("messages or acts of injected faults", "", 1.0),
    "wall_time_s": ("wall-clock time of the simulation", "s", 1.0),
    "simulated_per_real_time": ("simulated per real time", "", 1.0),
}
GROUPS = ("figures", "invariants", "reaction")
TOLD_ELSEWHERE = ("largest_contact_by_pair_n", "violations")


def row(name: str, value: Any) -> tuple[str, Any, str]:
    """(words, value, unit); a figure without words keeps its key."""
    words, unit, factor = WORDS.get(name, (name, "", 1.0))
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        value = factor * value if factor != 1.0 else value
    return words, shown(value) if isinstance(value, float) else value, unit


def rows(content: dict) -> Iterable[tuple[str, Any, str]]:
    """Of what verdict.json holds; what does not apply is left out."""
    named = [(name, value) for group in GROUPS for name, value in content.get(group, {}).items()
             if name not in TOLD_ELSEWHERE]
    named += [(name, content.get(name)) for name in ("wall_time_s", "simulated_per_real_time")]
    return [row(name, value) for name, value in named if value is not None]
