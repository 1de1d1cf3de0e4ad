# SPDX-License-Identifier: BSD-3-Clause
"""Verdicts of the trials, motion x gait x framework, as the paper's table and as rates."""
from matplotlib.figure import Figure

from prf_experiments import figures, page, statistics
from prf_experiments.study import Study, cell, test_link, values

AXES = {"motion": ["none", "light", "heavy"], "gait": ["stand", "step"],
        "framework": [False, True]}
VERDICTS = ("S", "P", "F", "INVALID")
SHADES = {"S": ("white", ""), "P": ("0.8", "///"), "F": ("0.15", ""), "INVALID": ("white", "xx")}


def cells(results):
    """(chosen arguments, results) of every cell, in the order of the table."""
    for framework in values(results, "framework"):
        for motion in values(results, "motion"):
            for gait in values(results, "gait"):
                chosen = {"motion": motion, "gait": gait, "framework": framework}
                yield chosen, cell(results, **chosen)


def rate(count, trials):
    low, high = statistics.wilson(count, trials)
    return {"fraction": count / trials if trials else None, "fraction_low_95": low,
            "fraction_high_95": high}


def row(chosen, results):
    """The numbers of one cell. Trials that are INVALID count in no rate."""
    counts = {verdict: sum(result["verdict"] == verdict for result in results)
              for verdict in VERDICTS}
    valid = len(results) - counts["INVALID"]
    inspected = sum(result["inspected"] for result in results)

    def spread(name):
        found = statistics.spread([result["figures"].get(name) for result in results])
        return {"mean": found.mean, "deviation": found.deviation}
    return {**chosen, "tests": "".join("×" if result["verdict"] == "INVALID" else result["verdict"]
                                       for result in results),
            "seeds": [result["arguments"]["seed"] for result in results],
            "counts": counts, "inspected_count": inspected,
            "success": rate(counts["S"], valid), "inspected": rate(inspected, valid),
            "tracking_lateral_mm": spread("tracking_lateral_mean_mm"),
            "largest_contact_n": max((result["figures"].get("largest_contact_n", 0.0)
                                      for result in results), default=0.0)}


def summarise(results):
    return {"cells": [row(*found) for found in cells(results)]}


def percent(found):
    if found["fraction"] is None:
        return "–"
    return (f"{100 * found['fraction']:3.0f} ({100 * found['fraction_low_95']:.0f}–"
            f"{100 * found['fraction_high_95']:.0f})")


def tests(text):
    """Verdicts in groups of ten; few of them apart, as in the paper's table."""
    if len(text) <= 10:
        return " ".join(text)
    return " ".join(text[first:first + 10] for first in range(0, len(text), 10))


def text(summary):
    rows = [("framework", "motion", "gait", "tests", "S", "P", "F", "inv", "success, % (95 %)",
             "inspected, % (95 %)", "off axis, mm", "contact, N")]
    for found in summary["cells"]:
        off = found["tracking_lateral_mm"]["mean"]
        rows.append(("on" if found["framework"] else "off", found["motion"], found["gait"],
                     tests(found["tests"]), *(str(found["counts"][name]) for name in VERDICTS),
                     percent(found["success"]), percent(found["inspected"]),
                     "–" if off is None else f"{off:.1f}", f"{found['largest_contact_n']:.1f}"))
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join("  ".join(word.ljust(width) for word, width in zip(line, widths)).rstrip()
                     for line in rows) + "\n"


def counts_figure(summary):
    """Stacked counts of each cell; told apart by lightness and hatching."""
    found = summary["cells"]
    figure = Figure(figsize=(9.0, 0.9 + 0.32 * len(found)), layout="constrained")
    axes = figure.subplots()
    labels = [f"{'on' if item['framework'] else 'off'}, {item['motion']}, {item['gait']}"
              for item in found]
    left = [0] * len(found)
    for verdict in VERDICTS:
        counts = [item["counts"][verdict] for item in found]
        shade, hatch = SHADES[verdict]
        axes.barh(labels, counts, left=left, color=shade, hatch=hatch, edgecolor="black",
                  linewidth=0.8, label=verdict)
        left = [before + count for before, count in zip(left, counts)]
    axes.invert_yaxis()
    axes.set_xlabel("trials", fontsize=9)
    axes.tick_params(labelsize=8)
    axes.legend(ncols=4, fontsize=8, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    return figures.svg(figure, "Verdicts of each cell: success, partial success, failure, invalid")


def parts(summary, results):
    linked = [("on" if chosen["framework"] else "off", chosen["motion"], chosen["gait"],
               page.Markup(" ".join(test_link(result) for result in found)),
               percent(numbers["success"]), percent(numbers["inspected"]))
              for (chosen, found), numbers in zip(cells(results), summary["cells"])]
    return ["<h2>Each test</h2><p>Every letter leads to its trial.</p>",
            page.table(linked, ("framework", "motion", "gait", "tests", "success, % (95 %)",
                                "inspected, % (95 %)")),
            "<h2>Counts</h2>", counts_figure(summary),
            "<p>S success, P partial success, F failure, × no evidence. Rates are of the valid "
            "trials, with Wilson's 95 % interval. Off axis: mean distance of the tag's centre from "
            "the optical axis while tracking. Contact: the largest of arm, hand or camera.</p>"]


STUDY = Study("Trials", AXES, {}, summarise, text, parts)
