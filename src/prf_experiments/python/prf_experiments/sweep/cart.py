# SPDX-License-Identifier: BSD-3-Clause
"""The box is pushed aside while the skill is executed: demonstration and adapted path, and the
error at the end."""
from prf_experiments.judge import target
from prf_experiments.report import figures, page, pictures, report
from prf_experiments.report.page import Section
from prf_experiments.run import trial
from prf_experiments.sweep import statistics
from prf_experiments.sweep.compare import with_spread
from prf_experiments.sweep.study import NO_BAG, Study, cell, letters, read_bag, values
from prf_experiments.sweep.table import aligned, grouped, shown
from prf_experiments.teach import demonstration

AXES = {"framework": [False, True]}
FIXED = {"scenario": "cart", "motion": "none"}
NUMBERS = {"final_lateral_mm": "off axis at the end, mm",
           "final_along_error_mm": "from stand-off at the end, mm",
           "tracking_lateral_mean_mm": "off axis while tracking, mm"}


def spread(results: list[dict], name: str) -> dict:
    found = statistics.spread([result["figures"].get(name) for result in results])
    return {"mean": found.mean, "deviation": found.deviation}


def summarise(results: list[dict]) -> dict:
    return {"cells": [{"framework": framework, "tests": letters(found),
                       **{name: spread(found, name) for name in NUMBERS}}
                      for framework in values(results, "framework")
                      for found in [cell(results, framework=framework)]]}


def text(summary: dict) -> str:
    return aligned([("framework", "tests", *NUMBERS.values())]
                   + [(shown("framework", found["framework"]), grouped(found["tests"]),
                       *(with_spread(found[name], "+.1f") for name in NUMBERS))
                      for found in summary["cells"]])


def conclusion(summary: dict) -> str:
    """One sentence."""
    def told(found):
        tests = found["tests"]
        off = found["final_lateral_mm"]["mean"]
        return (f"{tests.count('S')} of {len(tests)} trials succeed"
                + ("" if off is None else f", the tag is {off:.1f} mm off the axis at the end"))
    by_framework = {found["framework"]: told(found) for found in summary["cells"]}
    parts = [f"{words} the framework {by_framework[value]}" for value, words in
             ((True, "with"), (False, "without")) if value in by_framework]
    return "When the box is pushed aside, " + "; ".join(parts) + "."


def sections(_summary: dict, results: list[dict], folder: str) -> list[Section]:
    """Each cell's first trial, all in one figure."""
    tried, missing = [], []
    for framework in values(results, "framework"):
        result = cell(results, framework=framework)[0]
        name = (f"framework {shown('framework', framework)}, seed {result['arguments']['seed']}: "
                + result["verdict"])
        bag, data = read_bag(folder, result)
        if data is None:
            missing.append(Section(name[:1].upper() + name[1:], NO_BAG))
        else:
            tried.append((name, bag, data, result))
    if not tried:
        return missing
    skill = demonstration.read(trial.skill(tried[0][3]["arguments"]))
    scene = pictures.scene_of(tried[0][1], tried[0][2])
    return [
        *([Section("Scene", body=[scene])] if scene else []),
        Section("Distance to the target", "How far the tag is off the camera's optical axis. Orange: the "
                "cart is pushed.",
                [page.plotted(lambda: figures.compared_distances(
                    [(name, data) for name, _, data, _ in tried]))]),
        Section("Path before the box", "Of the hand, seen from the tag.",
                [page.plotted(lambda: figures.paths_before_box([
                    ("demonstrated", target.relative_to(skill.target, skill.poses),
                     figures.DEMONSTRATED),
                    *((name, report.before_tag(data), look) for (name, _, data, _), look in
                      zip(tried, figures.COMPARED))]))]), *missing]


MEANING = (
    "The box is pushed aside by 0.10 to 0.15 m during the execution. Distances in mm, mean ± standard "
    "deviation over the\nseeds, with the framework and without (`framework:=false`).")

STUDY = Study("Moving box", MEANING, AXES, FIXED, summarise, text, sections, keep_bags="all",
              conclude=conclusion)
