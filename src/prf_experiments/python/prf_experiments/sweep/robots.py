# SPDX-License-Identifier: BSD-3-Clause
"""The same skill with other arms, on legs or bolted to the deck: verdicts over robot and motion."""
from prf_experiments.robots import load, names
from prf_experiments.sweep import statistics
from prf_experiments.sweep.compare import with_spread
from prf_experiments.sweep.study import Study, cell, letters, values
from prf_experiments.sweep.table import aligned, grouped

AXES = {"robot": names(), "motion": ["none", "light", "heavy", "ship_sea_state"]}
NUMBERS = {"tracking_lateral_mean_mm": "off axis while tracking, mm",
           "largest_contact_n": "largest contact, N"}


def spread(results: list[dict], name: str) -> dict:
    found = statistics.spread([result["figures"].get(name) for result in results])
    return {"mean": found.mean, "deviation": found.deviation}


def summarise(results: list[dict]) -> dict:
    return {"cells": [{"robot": robot, "base": "legs" if load(robot).on_legs else "deck", "motion": motion,
                       "tests": letters(found), **{name: spread(found, name) for name in NUMBERS}}
                      for robot in values(results, "robot") for motion in values(results, "motion")
                      for found in [cell(results, robot=robot, motion=motion)] if found]}


def text(summary: dict) -> str:
    return aligned([("robot", "base", "motion", "tests", *NUMBERS.values())]
                   + [(found["robot"], found["base"], found["motion"], grouped(found["tests"]),
                       *(with_spread(found[name], "+.1f") for name in NUMBERS))
                      for found in summary["cells"]])


def conclusion(summary: dict) -> str:
    """One sentence."""
    told = []
    for robot in dict.fromkeys(found["robot"] for found in summary["cells"]):
        tests = "".join(found["tests"] for found in summary["cells"] if found["robot"] == robot)
        told.append(f"{robot} {tests.count('S')} of {len(tests)}")
    return "Trials that succeed: " + ", ".join(told) + "."


MEANING = (
    "Robots of `prf_robots` with the same box and stand-off, each with its own demonstration. One on legs stands on\n"
    "the platform with the box; one bolted to the deck has the box ashore (`scenario:=quay`).")

STUDY = Study("Robots", MEANING, AXES, {}, summarise, text, lambda *_: [], keep_bags="failed", conclude=conclusion)
