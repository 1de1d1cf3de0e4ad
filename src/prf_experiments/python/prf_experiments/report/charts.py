# SPDX-License-Identifier: BSD-3-Clause
"""Figures of many trials: counts, marks, bars, lines. Rows and bars are named by words."""
from collections.abc import Sequence
from typing import Any

from markupsafe import Markup

from prf_experiments.report import plots

VERDICTS = {"S": ("#1b7837", ""), "P": ("#f0c75e", "right_diagonal_line"), "F": ("#b2182b", ""),
            "INVALID": ("#ffffff", "cross")}  # colour and hatching, as on the pages
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7")
HATCHES = ("", "right_diagonal_line", "dot", "cross")
DASHES: tuple[list[int], ...] = ([], [5, 2], [2, 3], [6, 2, 1, 2])
ROW = 24  # px


def _rows(labels, x_label):
    """A panel with a row for each label, the first one on top."""
    made = plots.panel("", 90 + ROW * len(labels), None, x_label, y_range=list(reversed(labels)),
                       tools="save")
    made.x_range.start = 0.0
    made.ygrid.grid_line_color = None
    return made


def stacked_counts(labels: Sequence[str], counts: Sequence[dict[str, int]], description: str) -> Markup:
    """How many trials of each row came to each verdict."""
    panel = _rows(labels, "trials")
    left = [0] * len(labels)
    for verdict, (colour, hatch) in VERDICTS.items():
        found = [row.get(verdict, 0) for row in counts]
        if any(found):
            right = [before + count for before, count in zip(left, found)]
            panel.hbar(y=list(labels), left=left, right=right, height=0.75, color=colour,
                       line_color="#222222", hatch_pattern=hatch or None, hatch_alpha=0.5,
                       legend_label=verdict)
            left = right
    panel.xaxis.ticker = plots.library().models.BasicTicker(min_interval=1)
    plots.legend_above(panel, 4)
    return plots.embedded([[panel]], description)


def marks(labels: Sequence[str], values: Sequence[Sequence[float]], x_label: str,
          description: str) -> Markup:
    """One mark for each value of a row."""
    panel = _rows(labels, x_label)
    pairs = [(value, label) for label, found in zip(labels, values) for value in found]
    panel.scatter([value for value, _ in pairs], [label for _, label in pairs], marker="dash",
                  angle=1.5708, size=14, line_width=2, color="#222222", alpha=0.8)
    return plots.embedded([[panel]], description)


def bars(groups: Sequence[str], series: dict[str, dict[str, tuple[float, float]]], y_label: str,
         title: str) -> Any:
    """A panel of bars with whiskers: {series: {group: (mean, deviation)}}."""
    bokeh = plots.library()
    factors = [(group, name) for group in groups for name in series if group in series[name]]
    panel = plots.panel(y_label, 260, bokeh.models.FactorRange(*factors), title=title, tools="save")
    panel.xgrid.grid_line_color = None
    panel.xaxis.major_label_text_alpha = 0.0  # the legend has the names of the bars
    for row, (name, found) in enumerate(series.items()):
        places = [(group, name) for group in groups if group in found]
        panel.vbar(x=places, top=[found[group][0] for group, _ in places], width=0.85,
                   color=COLOURS[row % 4], hatch_pattern=HATCHES[row % 4] or None, hatch_alpha=0.5,
                   line_color="#222222", legend_label=name)
        panel.segment(places, [max(0.0, found[group][0] - found[group][1]) for group, _ in places],
                      places, [found[group][0] + found[group][1] for group, _ in places],
                      color="black", line_width=1.5)
    panel.y_range.start = 0.0
    plots.legend_above(panel, 4)
    return panel


def lines(series: dict[str, tuple[Sequence[float], Sequence[float]]], x_label: str, y_label: str,
          description: str, from_zero: bool = True) -> Markup:
    """A line for each name: {name: (x, y)}."""
    panel = plots.panel(y_label, 330 + 15 * len(series), None, x_label)  # the legend has two columns
    for row, (name, (x, y)) in enumerate(series.items()):
        if len(x):
            plots.add_line(panel, x, y, name, color=COLOURS[row % 4],
                           line_dash=DASHES[row // 4 % 4], line_width=1.6)
    if from_zero:
        panel.y_range.start = 0.0
    plots.legend_above(panel, 2)
    return plots.embedded([[panel]], description)


def rates(panels: dict[str, dict[str, list[tuple[float, float, float, float]]]], x_label: str,
          description: str) -> Markup:
    """A panel for each y label: {y label: {name: [(x, rate, low, high)]}}, with whiskers."""
    made = []
    for y_label, series in panels.items():
        panel = plots.panel(y_label, 260, None, x_label)
        for row, (name, points) in enumerate(series.items()):
            x, y, low, high = (list(column) for column in zip(*points))
            plots.add_line(panel, x, y, name, line_width=1.8, color=COLOURS[row % 4],
                           line_dash=DASHES[row % 4])
            panel.segment(x, low, x, high, color=COLOURS[row % 4], line_width=1.0, alpha=0.6)
        panel.y_range.start, panel.y_range.end = -0.02, 1.02
        plots.legend_above(panel, 4)
        made.append([panel])
    return plots.embedded(made, description)
