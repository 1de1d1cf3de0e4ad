# SPDX-License-Identifier: BSD-3-Clause
"""A post in the way of the demonstrated path: contact with it when the planner heeds it and when not."""
from prf_experiments.judge import judge
from prf_experiments.report import page
from prf_experiments.report.page import Section
from prf_experiments.sweep.study import Study, cell, letters, values, verdict_links
from prf_experiments.sweep.table import aligned, grouped

AXES = {"gait": ["stand", "step"], "avoid": [False, True]}
FIXED = {"obstacle": "post", "motion": "light"}
HEAD = ("gait", "avoid", "tests", "touched", "contact with the post, N: least", "most", "other contact, N")


def other_contact(figures: dict) -> float:
    """Largest force of arm, hand or camera on anything else, N."""
    return max((force for pair, force in figures.get("largest_contact_by_pair_n", {}).items()
                if judge.OBSTACLE not in pair.split(" | ")), default=0.0)


def row(gait: str, avoid: bool, results: list[dict]) -> dict:
    valid = [result["figures"] for result in results if result["verdict"] != "INVALID"]
    forces = [figures["largest_obstacle_contact_n"] for figures in valid]
    return {"gait": gait, "avoid": avoid, "tests": letters(results), "trials_count": len(valid),
            "touched_count": sum(force > judge.CONTACT_ISSUE for force in forces),
            "least_contact_n": min(forces, default=None), "largest_contact_n": max(forces, default=None),
            "other_contact_n": max(map(other_contact, valid), default=None)}


def summarise(results: list[dict]) -> dict:
    return {"cells": [row(gait, avoid, cell(results, gait=gait, avoid=avoid))
                      for gait in values(results, "gait") for avoid in values(results, "avoid")]}


def newton(force: float | None) -> str:
    return "–" if force is None else f"{force:.1f}"


def text(summary: dict) -> str:
    return aligned([HEAD] + [
        (found["gait"], "yes" if found["avoid"] else "no", grouped(found["tests"]),
         f"{found['touched_count']} of {found['trials_count']}",
         *(newton(found[name]) for name in ("least_contact_n", "largest_contact_n", "other_contact_n")))
        for found in summary["cells"]])


def conclusion(summary: dict) -> str:
    """One sentence."""
    parts = []
    for avoid, words in ((True, "heeded by the planner"), (False, "not heeded")):
        found = [one for one in summary["cells"] if one["avoid"] is avoid and one["trials_count"]]
        if found:
            parts.append(f"{words}, the post is touched in {sum(one['touched_count'] for one in found)} of "
                         f"{sum(one['trials_count'] for one in found)} trials, with up to "
                         f"{newton(max(one['largest_contact_n'] for one in found))} N")
    told = "; ".join(parts) or "no trial is valid"
    return told[:1].upper() + told[1:] + "."


def sections(_summary: dict, results: list[dict], _folder: str) -> list[Section]:
    linked = [(gait, avoid, verdict_links(cell(results, gait=gait, avoid=avoid)))
              for gait in values(results, "gait") for avoid in values(results, "avoid")]
    return [Section("Each test", "Every letter leads to its trial.",
                    [page.table(linked, ("gait", "avoid", "tests"))])]


MEANING = (
    "A post stands before the box, in the way of the demonstrated path "
    "(`demonstrations/inspect_box_from_the_right.csv`), and\nmoves with it. With `avoid:=true` the planner "
    "keeps the hand's path clear of it. Touched: trials where arm, hand or camera\npress on the post with "
    "more than 1 N; least and most over the seeds. Other contact: the largest on anything else.\nVerdicts "
    "by the rules of all trials: any such contact is an issue, above 50 N a failure.")

STUDY = Study("Post in the way", MEANING, AXES, FIXED, summarise, text, sections, conclude=conclusion)
