# SPDX-License-Identifier: BSD-3-Clause
"""Planners side by side: how far the tag is from the optical axis, paired by seed."""
from prf_experiments.report import charts, page, plots
from prf_experiments.report.page import Markup, Section
from prf_experiments.sweep import statistics
from prf_experiments.sweep.study import Study, cell, letters, values, verdict_links
from prf_experiments.sweep.table import aligned, grouped

AXES = {"motion": ["none", "light", "heavy"], "planner": ["elte", "dmp", "lte", "elastic_map", "servo"]}
FIXED = {"gait": "step"}
MEASURES = {"execution_lateral_mean_mm": "execution, mean",
            "execution_lateral_deviation_mm": "execution, sd",
            "tracking_lateral_mean_mm": "tracking, mean",
            "tracking_lateral_deviation_mm": "tracking, sd"}


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


MAIN, CHANCE = "execution_lateral_mean_mm", 0.05  # what the conclusion is drawn from


def conclusion(summary: dict) -> str:
    """One sentence: successes, and differences in `MAIN` that chance does not explain.

    All pairs are tested at once, so each one's p must be below CHANCE over their number (Bonferroni).
    """
    tests: dict[str, str] = {}
    for found in summary["cells"]:
        tests[found["planner"]] = tests.get(found["planner"], "") + found["tests"].replace("×", "")
    told = "S: " + ", ".join(f"{planner} {word.count('S')} of {len(word)}" for planner, word in tests.items())
    tested = [found for found in summary["pairs"] if found["measure"] == MAIN and found["t_test_p"] is not None]
    if not tested:
        return told + "."
    sure = [found for found in tested if found["t_test_p"] < CHANCE / len(tested)]
    nearer = [f"{abs(found['difference_mean_mm']):.1f} mm {'less' if found['difference_mean_mm'] < 0 else 'more'} than "
              f"with {found['second']} ({found['motion']})" for found in sure]
    chance = f"paired t-test, p < {CHANCE / len(tested):.2g}"
    return f"{told}; on the way the tag is " + (
        f"off the axis with {sure[0]['first']} by {', '.join(nearer)} ({chance})." if sure else
        f"off the axis by no more or less with {tested[0]['first']} than with the others (no {chance}).")


def distance_figure(summary: dict) -> Markup:
    """Bars of each measure with its spread over the seeds."""
    motions = list(dict.fromkeys(found["motion"] for found in summary["cells"]))
    planners = list(dict.fromkeys(found["planner"] for found in summary["cells"]))
    panels = [charts.bars(motions, {
        planner: {item["motion"]: (item[name]["mean"] or 0.0, item[name]["deviation"] or 0.0)
                  for item in summary["cells"] if item["planner"] == planner}
        for planner in planners}, "off the axis, mm", title) for name, title in MEASURES.items()]
    return plots.embedded([[panel] for panel in panels],
                          "Distance from the optical axis: " + ", ".join(MEASURES.values()))


def sections(summary: dict, results: list[dict], _folder: str) -> list[Section]:
    linked = [(motion, planner,
               verdict_links(cell(results, motion=motion, planner=planner)))
              for motion in values(results, "motion") for planner in values(results, "planner")]
    return [Section("Distances", "Bars: mean over the seeds; whiskers: standard deviation.",
                    [page.plotted(lambda: distance_figure(summary))]),
            Section("Each test", "Every letter leads to its trial.",
                    [page.table(linked, ("motion", "planner", "tests"))])]


MEANING = (
    "Planners compared on the same seeds, stepping. Tests: the verdict of each seed. The second table "
    "has what the first\nplanner has less than another one with the same seed, paired t-test and "
    "Wilcoxon's signed-rank test.")

STUDY = Study("Planners", MEANING, AXES, FIXED, summarise, text, sections, conclude=conclusion)
