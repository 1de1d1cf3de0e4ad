# SPDX-License-Identifier: BSD-3-Clause
"""The box is pushed aside while the skill is executed: demonstration and adapted path, and the
error at the end."""
from prf_experiments.report import report
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


def sections(_summary: dict, results: list[dict], folder: str) -> list[Section]:
    """Paths of each cell's first trial."""
    found = []
    for framework in values(results, "framework"):
        result = cell(results, framework=framework)[0]
        title = (f"Framework {shown('framework', framework)}, seed {result['arguments']['seed']}: "
                 + result["verdict"])
        bag, data = read_bag(folder, result)
        if data is None:
            found.append(Section(title, NO_BAG))
            continue
        skill = demonstration.read(trial.skill(result["arguments"]))
        found += [Section(f"{title}. {name}", words, [drawing])
                  for name, words, drawing in report.draw(bag, data, skill)[1:]]
    return found


MEANING = (
    "The box is pushed aside by 0.10 to 0.15 m during the execution. Distances in mm, mean ± standard "
    "deviation over the\nseeds, with the framework and without (`framework:=false`).")

STUDY = Study("Moving box", MEANING, AXES, FIXED, summarise, text, sections, keep_bags="all")
