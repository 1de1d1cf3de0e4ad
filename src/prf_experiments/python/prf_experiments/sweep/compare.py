# SPDX-License-Identifier: BSD-3-Clause
"""Planners side by side: how far the tag is from the optical axis, paired by seed."""
from matplotlib.figure import Figure

from prf_experiments.report import figures, page
from prf_experiments.report.page import Markup, Section
from prf_experiments.sweep import statistics
from prf_experiments.sweep.study import Study, cell, letters, values, verdict_links
from prf_experiments.sweep.table import aligned, grouped

AXES = {"motion": ["none", "light", "heavy"], "planner": ["elte", "dmp", "lte", "elastic_map"]}
FIXED = {"gait": "step"}
MEASURES = {"execution_lateral_mean_mm": "execution, mean",
            "execution_lateral_deviation_mm": "execution, sd",
            "tracking_lateral_mean_mm": "tracking, mean",
            "tracking_lateral_deviation_mm": "tracking, sd"}
SHADES = ["0.25", "0.55", "0.8", "1.0"]
HATCHES = ["", "///", "...", "xxx"]


def measured(results: list[dict], name: str) -> list:
    return [result["figures"].get(name) for result in results]


def as_json(found: statistics.Spread) -> dict:
    return {"count": found.count, "mean": found.mean, "deviation": found.deviation}


def pair(results: list[dict], motion: str, first: str, second: str, name: str) -> dict:
    """first - second of a measure, over the seeds of one motion."""
    of = [cell(results, motion=motion, planner=planner) for planner in (first, second)]
    seeds = sorted(set(values(of[0], "seed")) & set(values(of[1], "seed")))
    series = [measured([cell(found, seed=seed)[0] for seed in seeds], name) for found in of]
    found = statistics.paired(*series)
    return {"motion": motion, "first": first, "second": second, "measure": name,
            "pairs": found.count, "difference_mean_mm": found.difference.mean,
            "difference_deviation_mm": found.difference.deviation, "t_test_p": found.t_p,
            "wilcoxon_p": found.wilcoxon_p}


def summarise(results: list[dict]) -> dict:
    planners = values(results, "planner")
    cells = [{"motion": motion, "planner": planner,
              "tests": letters(found),
              **{name: as_json(statistics.spread(measured(found, name))) for name in MEASURES}}
             for motion in values(results, "motion") for planner in planners
             if (found := cell(results, motion=motion, planner=planner))]
    pairs = [pair(results, motion, planners[0], other, name)
             for motion in values(results, "motion") for other in planners[1:] for name in MEASURES]
    return {"cells": cells, "pairs": pairs}


def number(value: float | None, form: str = ".1f") -> str:
    return "–" if value is None else format(value, form)


def with_spread(found: dict, form: str = ".1f") -> str:
    """Mean ± standard deviation, as far as they are defined."""
    spread = "" if found["deviation"] is None else f" ± {found['deviation']:.1f}"
    return number(found["mean"], form) + spread


def probability(value: float | None) -> str:
    return "–" if value is None else "< 0.001" if value < 0.001 else f"{value:.3f}"


def text(summary: dict) -> str:
    rows = [("motion", "planner", "tests", *(f"{name}, mm" for name in MEASURES.values()))]
    rows += [(found["motion"], found["planner"], grouped(found["tests"]),
              *(with_spread(found[name]) for name in MEASURES)) for found in summary["cells"]]
    lines = [("motion", "difference", "of", "pairs", "mean ± sd, mm", "p (t)", "p (Wilcoxon)")]
    lines += [(found["motion"], f"{found['first']} − {found['second']}",
               MEASURES[found["measure"]], str(found["pairs"]),
               f"{number(found['difference_mean_mm'], '+.1f')} ± "
               f"{number(found['difference_deviation_mm'])}",
               probability(found["t_test_p"]), probability(found["wilcoxon_p"]))
              for found in summary["pairs"]]
    return ("Distance of the tag's centre from the optical axis: mean and standard deviation (sd) "
            "within a trial,\nmean ± sd over the seeds.\n\n" + aligned(rows)
            + ("\n" + aligned(lines) if len(lines) > 1 else ""))


def distance_figure(summary: dict, name: str) -> Markup:
    """Bars of a measure with its spread over the seeds, told apart by lightness and hatching."""
    motions = list(dict.fromkeys(found["motion"] for found in summary["cells"]))
    planners = list(dict.fromkeys(found["planner"] for found in summary["cells"]))
    figure = Figure(figsize=(4.6, 3.3), layout="constrained")
    axes = figure.subplots()
    width = 0.8 / len(planners)
    for column, planner in enumerate(planners):
        found = [item for item in summary["cells"] if item["planner"] == planner]
        axes.bar([motions.index(item["motion"]) + (column - 0.5 * (len(planners) - 1)) * width
                  for item in found], [item[name]["mean"] or 0.0 for item in found], width,
                 yerr=[item[name]["deviation"] or 0.0 for item in found], label=planner,
                 color=SHADES[column % 4], hatch=HATCHES[column % 4], edgecolor="black",
                 linewidth=0.8, error_kw={"linewidth": 0.9, "capsize": 2.5})
    axes.set_xticks(range(len(motions)), motions)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("off the axis, mm", fontsize=9)
    axes.tick_params(labelsize=8)
    axes.legend(fontsize=7, ncols=4, loc="lower left", bbox_to_anchor=(0.0, 1.0),
                title=MEASURES[name], title_fontsize=9, columnspacing=1.0)
    return figures.svg(figure, f"Distance from the optical axis: {MEASURES[name]}")


def sections(summary: dict, results: list[dict], _folder: str) -> list[Section]:
    linked = [(motion, planner,
               verdict_links(cell(results, motion=motion, planner=planner)))
              for motion in values(results, "motion") for planner in values(results, "planner")]
    return [Section("Distances", "Bars: mean over the seeds; whiskers: standard deviation.",
                    [distance_figure(summary, name) for name in MEASURES]),
            Section("Each test", "Every letter leads to its trial.",
                    [page.table(linked, ("motion", "planner", "tests"))])]


MEANING = (
    "Planners compared on the same seeds, stepping. Tests: the verdict of each seed. The second table "
    "has what the first\nplanner has less than another one with the same seed, paired t-test and "
    "Wilcoxon's signed-rank test.")

STUDY = Study("Planners", MEANING, AXES, FIXED, summarise, text, sections)
