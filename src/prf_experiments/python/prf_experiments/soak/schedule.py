# SPDX-License-Identifier: BSD-3-Clause
"""Faults at random, from a seed, over a long time. Imports no ROS."""
import random

from prf_experiments.faults import catalogue

FIRST, LAST_REST = 20.0, 30.0  # s without faults at the begin and at the end
BETWEEN = (15.0, 45.0)  # s from one fault to the next
# What can happen, as words with a time and an end to come.
ONCE = ["respawn/decision:1", "respawn/target_predictor:1", "respawn/skill_planner:1",
        "respawn/tag_detector:1", "respawn/arm_controller:0.5", "stop/decision:0.5",
        "stop/target_predictor:1", "stop/skill_planner:1", "stop/tag_detector:1",
        "stop/arm_controller:0.3", "old/joint_states:1", "old/tag_detections:2",
        "ahead/target/forecast:5", "ahead/joint_states:100"]
LASTING = ["drop/camera/image_raw:0.5", "drop/tag_detections:0.5", "drop/target/forecast:0.3",
           "drop/execution/setpoint:0.2", "drop/joint_command:0.2", "delay/tag_detections:0.1",
           "duplicate/joint_states", "reorder/target/forecast:0.3", "nan/tag_detections:0.5",
           "huge/tag_detections:0.5", "bits/target/forecast:0.3", "false_tag:0.5", "flip:0.5",
           "occlusion:0.9", "exposure:20", "foreign_tf:-1.5"]
SPAN = (1.0, 4.0)  # s that a lasting one lasts


def draw(seed: int, duration: float) -> list[catalogue.Fault]:
    """Faults within `duration` s, in the order of time."""
    source, at, faults = random.Random(f"soak {seed}"), FIRST, []
    while at < duration - LAST_REST:
        if source.random() < 0.5:
            word = f"{source.choice(ONCE)}@{at:.1f}"
        else:
            word = f"{source.choice(LASTING)}@{at:.1f}-{at + source.uniform(*SPAN):.1f}"
        faults.append(catalogue.parse_one(word))
        at += source.uniform(*BETWEEN)
    return faults
