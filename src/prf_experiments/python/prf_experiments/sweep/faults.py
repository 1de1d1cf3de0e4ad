# SPDX-License-Identifier: BSD-3-Clause
"""Every fault injected into a trial, standing and stepping: what the arm does, and how soon."""
from prf_experiments.faults import catalogue
from prf_experiments.report import page
from prf_experiments.report.page import Section
from prf_experiments.sweep.study import Study, broken, cell, letters, values, verdict_links
from prf_experiments.sweep.table import aligned, grouped

FRAMEWORK = ("robot_state_publisher", "tag_detector", "target_predictor", "decision",
             "skill_planner", "arm_controller")
CORRUPTED = ("joint_states", "tag_detections", "target/forecast", "skill/trajectory",
             "execution/setpoint", "joint_command")
LATE = (*CORRUPTED, "camera/image_raw", "execution/progress")
WORDS = [
    "",
    *(f"drop/{topic}:0.3@4-8" for topic in catalogue.TOPICS),
    *(f"delay/{topic}:0.1@4-8" for topic in LATE),
    *(f"duplicate/{topic}@4-8" for topic in LATE),
    *(f"reorder/{topic}:0.2@4-8" for topic in LATE),
    *(f"{name}/{topic}:0.2@4-8" for name in ("nan", "huge", "bits") for topic in CORRUPTED),
    *(f"{name}/{topic}@5" for name in ("old", "ahead") for topic in LATE),
    "ahead/tag_detections:4294967295@5", "ahead/joint_states:4294967295@5",
    "second/joint_states@4-8", "second/target/forecast:-0.05@4-8",
    *(f"{name}/{node}@5" for name in ("kill", "respawn", "stop") for node in FRAMEWORK),
    "clock:-2@5", "clock:10@5", "false_tag:0.5@4-6", "flip:0.3@3", "occlusion:0.8@4-6",
    "exposure:20@4-6", "foreign_tf:-1.5@2", "foreign_tf:2@2", "disk@5"]
AXES = {"fault": WORDS, "gait": ["stand", "step"]}
FIXED = {"motion": "light", "time_limit": 40.0}
NO_EVIDENCE = ("disk", "kill/recorder", "kill/platform_sim")  # faults after which INVALID is right

COLUMNS = {"time_to_hold_s": ("reaction", "held after, s"),
           "time_to_recover_s": ("reaction", "went on after, s"),
           "largest_joint_step_rad": ("invariants", "joint step, rad"),
           "largest_contact_n": ("figures", "contact, N")}


def may_be_invalid(arguments: dict) -> bool:
    return any(word.startswith(NO_EVIDENCE) for word in arguments["fault"].split(","))


def largest(results: list[dict], part: str, name: str) -> float | None:
    found = [result.get(part, {}).get(name) for result in results]
    return max((value for value in found if value is not None), default=None)


def summarise(results: list[dict]) -> dict:
    cells = [{"fault": fault, "gait": gait, "tests": letters(found),
              **{name: largest(found, part, name) for name, (part, _) in COLUMNS.items()},
              "final_states": sorted({result["figures"].get("final_state", "–")
                                      for result in found}),
              "violations": [text for result in found for text in broken(result)]}
             for fault in values(results, "fault") for gait in values(results, "gait")
             if (found := cell(results, fault=fault, gait=gait))]
    return {"cells": cells}


def _shown(value, form):
    return "–" if value is None else format(value, form)


def text(summary: dict) -> str:
    rows = [("fault", "gait", "tests", "at the end", *(words for _, words in COLUMNS.values()),
             "invariants")]
    rows += [(found["fault"] or "none", found["gait"], grouped(found["tests"]),
              ", ".join(found["final_states"]).lower(),
              *(_shown(found[name], ".4f" if name.endswith("_rad") else ".2f") for name in COLUMNS),
              f"{len(found['violations'])} BROKEN" if found["violations"] else "hold")
             for found in summary["cells"]]
    violations = [f"{found['fault']}, {found['gait']}: {violation}" for found in summary["cells"]
                  for violation in found["violations"]]
    return aligned(rows) + "".join(f"\nINVARIANT BROKEN: {line}" for line in violations) + (
        "\n" if violations else "")


def conclusion(summary: dict) -> str:
    """One sentence."""
    found = [one for one in summary["cells"] if one["fault"]]
    tests = "".join(one["tests"] for one in found)
    broken_in = [f"{one['fault']}, {one['gait']}" for one in summary["cells"] if one["violations"]]
    held = max((one["time_to_hold_s"] for one in found if one["time_to_hold_s"] is not None), default=None)
    told = ", ".join(f"{count} {verdict}" for verdict in "SPF×" if (count := tests.count(verdict)))
    return (f"{len(tests)} trials with a fault: {told or 'none'}; "
            + ("" if held is None else f"where the execution was held, it was so after at most {held:.2f} s; ")
            + ("the invariants of every command hold in all trials." if not broken_in else
               f"INVARIANTS BROKEN with {'; '.join(broken_in)}."))


def sections(_summary: dict, results: list[dict], _folder: str) -> list[Section]:
    linked = [(fault or "none", gait, verdict_links(found),
               "; ".join(dict.fromkeys(result["reason"] for result in found)))
              for fault in values(results, "fault") for gait in values(results, "gait")
              if (found := cell(results, fault=fault, gait=gait))]
    return [Section("Each test", "Every letter leads to its trial.",
                    [page.table(linked, ("fault", "gait", "tests", "reasons"))])]


MEANING = (
    "Faults injected into trials under light motion (`run_trial --help` says what each one is). Held after: from "
    "the first\ntime that the fault acts until the execution no longer goes on, –: it goes on all the while. Went on "
    "after: from there\nuntil it goes on again, –: it does not. Joint step: the largest one between two commands; "
    "contact: the largest force of\narm, hand or camera. Largest values over the seeds. Invariants: what must hold "
    "for every joint command of every trial.\n× (INVALID) is right where the recorder's disk is full.")

STUDY = Study("Faults", MEANING, AXES, FIXED, summarise, text, sections, seeds=1,
              may_be_invalid=may_be_invalid, conclude=conclusion)
