# SPDX-License-Identifier: BSD-3-Clause
"""Verdicts of the trials, motion x gait x framework, as the paper's table and as rates.

Other tables of verdicts differ in their axes only; a summary says which ones it has.
"""
import itertools
from collections.abc import Iterator, Sequence
from typing import Any

from prf_experiments.report import charts, page, pictures
from prf_experiments.report.page import Markup, Section
from prf_experiments.sweep import statistics
from prf_experiments.sweep.study import (
    Study,
    cell,
    first_bag,
    letters,
    values,
    verdict_links,
)

AXES = {"motion": ["none", "light", "heavy"], "gait": ["stand", "step"],
        "framework": [False, True]}
ORDER = ("framework", "motion", "gait")
VERDICTS = ("S", "P", "F", "INVALID")
SMOOTHNESS = {"jerk, rad/s³": "joint_jerk_rms_rad_s3", "path / way": "approach_path_ratio",
              "shake, mm": "approach_shake_rms_mm"}  # figures of a verdict, by heading


def cells(results: list[dict], axes: Sequence[str]) -> Iterator[tuple[dict, list[dict]]]:
    """(chosen arguments, results) of every cell, in the order of the table."""
    for chosen in itertools.product(*(values(results, name) for name in axes)):
        named = dict(zip(axes, chosen))
        yield named, cell(results, **named)


def rate(count: int, trials: int) -> dict:
    low, high = statistics.wilson(count, trials)
    return {"fraction": count / trials if trials else None, "fraction_low_95": low,
            "fraction_high_95": high}


def row(chosen: dict, results: list[dict]) -> dict:
    """The numbers of one cell. Trials that are INVALID count in no rate."""
    counts = {verdict: sum(result["verdict"] == verdict for result in results)
              for verdict in VERDICTS}
    valid = len(results) - counts["INVALID"]
    inspected = sum(result["inspected"] for result in results)

    def spread(name):
        found = statistics.spread([result["figures"].get(name) for result in results])
        return {"mean": found.mean, "deviation": found.deviation}
    return {**chosen, "tests": letters(results),
            "seeds": [result["arguments"]["seed"] for result in results],
            "counts": counts, "inspected_count": inspected,
            "success": rate(counts["S"], valid), "inspected": rate(inspected, valid),
            "tracking_lateral_mm": spread("tracking_lateral_mean_mm"),
            "smoothness": {name: spread(figure) for name, figure in SMOOTHNESS.items()},
            "largest_contact_n": max((result["figures"].get("largest_contact_n", 0.0)
                                      for result in results), default=0.0)}


def summarise(results: list[dict], axes: Sequence[str] = ORDER) -> dict:
    return {"axes": list(axes), "cells": [row(*found) for found in cells(results, axes)]}


def shown(name: str, value: Any) -> str:
    return ("on" if value else "off") if name == "framework" else str(value)


def percent(found: dict) -> str:
    if found["fraction"] is None:
        return "–"
    return (f"{100 * found['fraction']:3.0f} ({100 * found['fraction_low_95']:.0f}–"
            f"{100 * found['fraction_high_95']:.0f})")


def number(value: float | None) -> str:
    return "–" if value is None else f"{value:.1f}"


def grouped(text: str) -> str:
    """Verdicts in groups of ten; few of them apart, as in the paper's table."""
    if len(text) <= 10:
        return " ".join(text)
    return " ".join(text[first:first + 10] for first in range(0, len(text), 10))


def aligned(rows: Sequence[Sequence[str]]) -> str:
    """Lines of text with the words of each row under each other."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join("  ".join(word.ljust(width) for word, width in zip(line, widths)).rstrip()
                     for line in rows) + "\n"


def text(summary: dict) -> str:
    rows = [(*summary["axes"], "tests", "S", "P", "F", "inv", "success, % (95 %)",
             "inspected, % (95 %)", "off axis, mm", "contact, N", *SMOOTHNESS)]
    for found in summary["cells"]:
        off = found["tracking_lateral_mm"]["mean"]
        rows.append((*(shown(name, found[name]) for name in summary["axes"]),
                     grouped(found["tests"]), *(str(found["counts"][name]) for name in VERDICTS),
                     percent(found["success"]), percent(found["inspected"]),
                     number(off), f"{found['largest_contact_n']:.1f}",
                     *(number(found["smoothness"][name]["mean"]) for name in SMOOTHNESS)))
    return aligned(rows)


def side_by_side(summary: dict) -> list[dict]:
    """The cells in an order in which those that differ in the framework alone are neighbours."""
    others = [name for name in summary["axes"] if name != "framework"]
    places = {name: list(dict.fromkeys(item[name] for item in summary["cells"])) for name in others}
    return sorted(summary["cells"],
                  key=lambda item: [places[name].index(item[name]) for name in others])


def label_of(item: dict, axes: Sequence[str]) -> str:
    words = [shown(name, item[name]) for name in axes if name != "framework"]
    return ", ".join(words + [shown("framework", item["framework"])] * ("framework" in axes))


def distance_figure(summary: dict, results: list[dict]) -> Markup:
    """One mark for each trial: how far the tag was off the axis while tracking."""
    found = side_by_side(summary)
    measured = [[result["figures"].get("tracking_lateral_mean_mm")
                 for result in cell(results, **{name: item[name] for name in summary["axes"]})]
                for item in found]
    return charts.marks([label_of(item, summary["axes"]) for item in found],
                        [[value for value in row if value is not None] for row in measured],
                        "mean distance off the optical axis while tracking, mm",
                        "Distance of the tag from the optical axis in each trial")


def counts_figure(summary: dict) -> Markup:
    found = side_by_side(summary)
    return charts.stacked_counts(
        [label_of(item, summary["axes"]) for item in found], [item["counts"] for item in found],
        "Verdicts of each cell: success, partial success, failure, invalid")


def successes(found: list[dict]) -> str:
    """"S in 17 of 18 trials (95 %: 74–99 %)" of some cells."""
    count = sum(item["counts"]["S"] for item in found)
    valid = sum(sum(item["counts"].values()) - item["counts"]["INVALID"] for item in found)
    if not valid:
        return "no valid trial"
    low, high = statistics.wilson(count, valid)
    return f"S in {count} of {valid} trials (95 %: {100 * low:.0f} to {100 * high:.0f} %)"


def conclusion(summary: dict) -> str:
    """One sentence."""
    if "framework" not in summary["axes"]:
        return f"In all: {successes(summary['cells'])}."
    parts = [(words, [item for item in summary["cells"] if item["framework"] is value])
             for value, words in ((True, "with the framework"), (False, "without it"))]
    told = "; ".join(f"{words} {successes(found)}" for words, found in parts if found)
    return told[:1].upper() + told[1:] + "."


def sections(summary: dict, results: list[dict], folder: str) -> list[Section]:
    axes = summary["axes"]
    linked = [(*(shown(name, chosen[name]) for name in axes), verdict_links(found),
               percent(numbers["success"]), percent(numbers["inspected"]),
               number(numbers["tracking_lateral_mm"]["mean"]), numbers["largest_contact_n"],
               *(number(numbers["smoothness"][name]["mean"]) for name in SMOOTHNESS))
              for (chosen, found), numbers in zip(cells(results, axes), summary["cells"])]
    scene = pictures.scene_of(*first_bag(folder, results))
    return [
        Section("Each test", "Every letter leads to its trial. " + MEANING,
                [page.table(linked, (*axes, "tests", "success, % (95 %)", "inspected, % (95 %)",
                                     "off axis, mm", "contact, N", *SMOOTHNESS))]),
        *([Section("Scene", body=[scene])] if scene else []),
        Section("Counts", "Framework on and off side by side." if "framework" in axes else "",
                [page.plotted(lambda: counts_figure(summary))]),
        Section("Distances", body=[page.plotted(lambda: distance_figure(summary, results))])]


MEANING = (
    "S success, P partial success, F failure, inv no evidence; one letter for each seed. Rates are of "
    "the valid trials, with\nWilson's 95 % interval. Off axis: mean distance of the tag's centre from "
    "the camera's optical axis while tracking.\nContact: the largest force of arm, hand or camera. "
    "Jerk: rms of the commanded joints. On the last 0.2 m, seen from\nthe tag: path of the hand over "
    "its net way, and its shake above 1.5 Hz, rms.")

STUDY = Study("Trials", MEANING, AXES, {}, summarise, text, sections, conclude=conclusion)
