# SPDX-License-Identifier: BSD-3-Clause
"""Where each part breaks: families of worlds with rising severity, without the framework, and with it
by each decision."""
import argparse
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from prf_experiments.report import charts, page
from prf_experiments.report.page import Section
from prf_experiments.run import trial_arguments
from prf_experiments.sweep.severity import DEFAULT, LEVELS, place, world
from prf_experiments.sweep.study import Study, letters, verdict_links
from prf_experiments.sweep.table import aligned, grouped, number, percent, rate

CONTACT, HARD_CONTACT = 1.0, 50.0  # N
# What is compared, by the arguments that make it. Those that this version does not know are left out.
VARIANTS: dict[str, dict[str, Any]] = {
    "off": {"framework": False, "planner": "elte"},
    "forward": {"framework": True, "planner": "elte", "decision": "forward"},
    "hmm paper": {"framework": True, "planner": "elte", "decision": "hmm", "hmm": "paper"},
    "hmm trained": {"framework": True, "planner": "elte", "decision": "hmm", "hmm": "trained"},
    "servo": {"framework": True, "planner": "servo"}}
CAUSES = ("fall", "view", "forecast", "arm", "plan", "decision", "contact")


def variants() -> dict[str, dict[str, Any]]:
    """Without hmm:= there is one HMM."""
    if "hmm" in trial_arguments.LAUNCHED:
        return VARIANTS
    return {**{name: made for name, made in VARIANTS.items() if "hmm" not in made},
            "hmm": {"framework": True, "decision": "hmm"}}


def variant(arguments: dict) -> str:
    return next((name for name, made in variants().items()
                 if all(arguments.get(key) == value for key, value in made.items())), "other")


def conditions(options: argparse.Namespace) -> list[dict[str, Any]]:
    families = options.family or DEFAULT
    return [{**world(family, level), **made} for family in families
            for level in options.levels or LEVELS[family] for made in variants().values()]


def cause_of(result: dict) -> str:
    """What a trial that is not S was lost in, by its figures and the sentence of its cause."""
    figures, told = result["figures"], result.get("cause", "")
    if figures.get("fallen_s") is not None:
        return "fall"
    if figures.get("reached_s") is not None and figures.get("largest_contact_n", 0.0) > CONTACT:
        return "contact"
    if "never seen" in told or figures.get("longest_out_of_view_s", 0.0) > 2.0:
        return "view"
    for name in ("forecast", "arm", "plan"):
        if f"lost in the {name}" in told:
            return name
    return "decision"


def _row(key, found):
    family, level, name, predictor = key
    valid = [result for result in found if result["verdict"] != "INVALID"]

    def share(holds):
        return rate(sum(bool(holds(result)) for result in valid), len(valid))

    def contact(bound):
        return share(lambda result: result["figures"].get("largest_contact_n", 0.0) > bound)
    times = [time for result in valid if (time := result["figures"].get("reached_s")) is not None]
    lost = [cause_of(result) for result in valid if result["verdict"] != "S"]
    return {"family": family, "level": level, "variant": name, "predictor": predictor,
            "tests": letters(found), "valid_count": len(valid),
            "success": share(lambda result: result["verdict"] == "S"),
            "inspected": share(lambda result: result["inspected"]),
            "contact": contact(CONTACT), "hard_contact": contact(HARD_CONTACT),
            "fallen": share(lambda result: result["figures"].get("fallen_s") is not None),
            "reached_median_s": float(np.median(times)) if times else None,
            "lost_in": {cause: lost.count(cause) for cause in CAUSES if cause in lost}}


def cells(results: list[dict]) -> Iterator[tuple[tuple, list[dict]]]:
    """((family, level, variant, predictor), results) in the order of the trials."""
    found: dict[tuple, list[dict]] = {}
    for result in results:
        arguments = result["arguments"]
        key = (*place(arguments), variant(arguments), arguments["predictor"])
        found.setdefault(key, []).append(result)
    yield from found.items()


def breaking_levels(rows: list[dict]) -> list[dict]:
    """Per family, variant and predictor: the first level at which less than half is S."""
    found: dict[tuple, float | None] = {}
    for row in sorted(rows, key=lambda row: row["level"]):
        key = (row["family"], row["variant"], row["predictor"])
        found.setdefault(key, None)
        if found[key] is None and (row["success"]["fraction"] or 0.0) < 0.5 and row["valid_count"]:
            found[key] = row["level"]
    return [{"family": family, "variant": name, "predictor": predictor, "breaks_at": level}
            for (family, name, predictor), level in found.items()]


def summarise(results: list[dict]) -> dict:
    rows = [_row(key, found) for key, found in cells(results)]
    return {"cells": rows, "breaking_levels": breaking_levels(rows)}


def _causes(row):
    return ", ".join(f"{name} {count}" for name, count in row["lost_in"].items()) or "–"


HEADER = ("family", "level", "variant", "predictor", "tests", "success, % (95 %)", "inspected, % (95 %)",
          "contact > 1 N, %", "> 50 N, %", "fallen, %", "reached, s", "lost in")


def _words(row, tests):
    return (row["family"], f"{row['level']:g}", row["variant"], row["predictor"], tests,
            percent(row["success"]), percent(row["inspected"]), percent(row["contact"]),
            percent(row["hard_contact"]), percent(row["fallen"]), number(row["reached_median_s"]), _causes(row))


def text(summary: dict) -> str:
    table = aligned([HEADER, *(_words(row, grouped(row["tests"])) for row in summary["cells"])])
    broken = aligned([("family", "variant", "predictor", "less than half S from level"),
                      *((row["family"], row["variant"], row["predictor"],
                         "–" if row["breaks_at"] is None else f"{row['breaks_at']:g}")
                        for row in summary["breaking_levels"])])
    return table + "\n" + broken


CURVES = {"success": "share of trials with S", "contact": "share with a contact above 1 N",
          "hard_contact": "share with a contact above 50 N"}


def _curves(summary, family):
    rows = sorted((row for row in summary["cells"] if row["family"] == family),
                  key=lambda row: row["level"])
    predictors = {row["predictor"] for row in rows}
    found: dict[str, dict[str, list]] = {name: {} for name in CURVES}
    for row in rows:
        label = row["variant"] + (f", {row['predictor']}" if len(predictors) > 1 else "")
        for name in CURVES:
            measured = row[name]
            if measured["fraction"] is not None:
                found[name].setdefault(label, []).append(
                    (row["level"], measured["fraction"], measured["fraction_low_95"],
                     measured["fraction_high_95"]))
    return charts.rates({CURVES[name]: series for name, series in found.items()}, f"level of {family}",
                        f"Rates against the level of {family}, with 95 % intervals")


def sections(summary: dict, results: list[dict], _folder: str) -> list[Section]:
    families = dict.fromkeys(row["family"] for row in summary["cells"])
    curves = [Section(family, "Whiskers are Wilson's 95 % intervals; a click on a name hides its line.",
                      [page.plotted(partial(_curves, summary, family))]) for family in families]
    linked = [_words(row, verdict_links(found))
              for row, (_, found) in zip(summary["cells"], cells(results))]
    return [*curves, Section("Each test", "Every letter leads to its trial. " + MEANING,
                             [page.table(linked, HEADER)])]


def conclusion(summary: dict) -> str:
    told = [f"{row['family']}, {row['variant']}: "
            + ("holds at every level" if row["breaks_at"] is None else f"from {row['breaks_at']:g}")
            for row in summary["breaking_levels"]]
    return "Less than half of the trials succeed: " + "; ".join(told) + "."


MEANING = (
    "Level of heavy, sea, bursts and stop: 1 is as fast as the paper's heavy motion; of cart and cart_toward: m "
    "of the push; of\npush: N; of occlude and dark: s. off: framework:=false; forward: decision:=forward. Rates "
    "are of the valid trials, with\nWilson's 95 % interval. Reached: median time of those that were. Lost in: of "
    "trials that are not S, by the sentence of their\ncause; decision: they did not come to the end of the skill "
    "in time.")

STUDY = Study("Limits", MEANING, {}, {"gait": "stand"}, summarise, text, sections, seeds=5, keep_bags="none",
              conclude=conclusion, conditions=conditions)
