# SPDX-License-Identifier: BSD-3-Clause
"""Plots that a page carries with it: as wide as the screen, to zoom and to read values from.

They are Bokeh's; a page holds its library and each plot's data compressed, so that it needs nothing else.
Lines differ in colour (Okabe and Ito's palette), style and lightness, so that they can be told apart
in black and white and with colour-vision deficiency.
"""
import base64
import gzip
import json
import os
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

from prf_experiments import python_packages

MAX_POINTS = 1000  # of a line
SIZE = "12px"
HEIGHT = 150  # px of a panel
PHONE = 55  # characters of a legend's row on a phone
GRID, INK, FAINT = "#e0e0e0", "#222222", "#707070"
TOOLS = "xbox_zoom,xpan,xwheel_zoom,reset,save"


class Missing(Exception):
    """Bokeh is not installed; the message says what to do."""


def library() -> Any:
    """The package bokeh with what is used of it."""
    python_packages.reach()
    try:
        import bokeh.embed
        import bokeh.layouts
        import bokeh.models
        import bokeh.plotting
    except ImportError as error:
        raise Missing(f"{error}; {python_packages.how_to_get('bokeh')}") from None
    return bokeh


def thin(*arrays: ArrayLike) -> list[np.ndarray]:
    """Every n-th row of each array, so that about MAX_POINTS remain."""
    rows = [np.asarray(array) for array in arrays]
    step = max(1, len(rows[0]) // MAX_POINTS)
    return [array[::step] for array in rows]


def panel(label: str, height: int = HEIGHT, x_range: Any = None, x_label: str = "", **named: Any) -> Any:
    """An empty plot with a label at its y axis; panels with one `x_range` move together."""
    if x_range is not None:
        named["x_range"] = x_range
    made = library().plotting.figure(height=height, min_width=240, sizing_mode="stretch_width",
                                     toolbar_location=None, **{"tools": TOOLS, **named})
    made.toolbar.active_scroll = None
    made.yaxis.axis_label, made.xaxis.axis_label = label, x_label or None
    for axis in (*made.xaxis, *made.yaxis):
        axis.axis_label_text_font_style, axis.axis_label_text_font_size = "normal", SIZE
        axis.major_label_text_font_size, axis.minor_tick_line_color = SIZE, None
        axis.axis_line_color, axis.major_tick_line_color = FAINT, FAINT
    made.grid.grid_line_color, made.outline_line_color = GRID, None
    made.min_border_right = 12
    return made


def add_line(to: Any, x: ArrayLike, y: ArrayLike, label: str = "", step: bool = False, **look: Any) -> Any:
    x, y = (np.asarray(values, np.float32) for values in thin(x, y))
    named = {"legend_label": label} if label else {}
    if step:
        return to.step(x, y, mode="after", **named, **look)
    return to.line(x, y, **named, **look)


def add_points(to: Any, x: ArrayLike, y: ArrayLike, label: str = "", **look: Any) -> Any:
    x, y = (np.asarray(values, np.float32) for values in thin(x, y))
    return to.scatter(x, y, **({"legend_label": label} if label else {}), **look)


def add_bound(to: Any, value: float, name: str = "") -> None:
    """A dashed line across, with its name at its right end."""
    models = library().models
    to.add_layout(models.Span(location=value, dimension="width", line_color=FAINT, line_dash=[6, 4],
                              line_width=1))
    if name:
        to.add_layout(models.Label(x=0, x_units="screen", x_offset=4, y=value, text=name,
                                   text_font_size="11px", text_color=FAINT, text_baseline="bottom"))


def shade(to: Any, begin: float, end: float, colour: str, text: str = "", row: int = 0) -> None:
    """A coloured span of the x axis; its text stands `row` lines below the top."""
    models = library().models
    to.add_layout(models.BoxAnnotation(left=begin, right=end, fill_color=colour, fill_alpha=0.25,
                                       line_color=colour, line_alpha=0.6, level="underlay"))
    if text:
        to.add_layout(models.Label(
            x=begin, y=to.height - 50 - 14 * row, y_units="screen", x_offset=2, text=text, text_font_size="11px",
            text_color=INK, text_baseline="top", background_fill_color="white",
            background_fill_alpha=0.6))


def name_values(to: Any, names: dict[int, str]) -> None:
    """Words in place of numbers at the y axis."""
    to.yaxis.ticker = sorted(names)
    to.yaxis.major_label_overrides = names


def legend_above(to: Any, columns: int = 3) -> None:
    """Moves the legend out of the plot, with fewer columns where they would not fit on a phone; a
    click on an entry hides its line."""
    if not to.legend:  # nothing is drawn
        return
    legend = to.legend[0]
    lengths = [5 + len(item.label.value) for item in legend.items]
    while columns > 1 and max(sum(lengths[row:row + columns])
                              for row in range(0, len(lengths), columns)) > PHONE:
        columns -= 1
    to.add_layout(legend, "above")
    legend.ncols, legend.orientation, legend.click_policy = columns, "horizontal", "hide"
    legend.label_text_font_size, legend.border_line_color = SIZE, None
    legend.margin = legend.padding = 0
    legend.spacing, legend.glyph_width, legend.label_standoff = 10, 18, 4


def values_on_hover(to: Any, renderers: Sequence[Any], unit: str, across: str = "s") -> None:
    """Shows the values under the finger or the mouse."""
    to.add_tools(library().models.HoverTool(
        renderers=list(renderers), mode="vline", point_policy="snap_to_data",
        tooltips=[("", f"@y{{0.0}} {unit}"), ("at", f"@x{{0.00}} {across}")]))


def compressed(data: bytes) -> str:
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


def _renumbered(item: str) -> str:
    """Bokeh numbers what a process makes; from 1 in each plot, so that the same plot is the same text."""
    numbers: dict[str, str] = {}
    return re.sub(r'"p[0-9]{4,}"', lambda found: numbers.setdefault(found[0], f'"p{len(numbers) + 1}"'),
                  item)


def embedded(columns: Sequence[Sequence[Any]], description: str) -> Markup:
    """Columns of panels as HTML, side by side where the screen is wide enough."""
    bokeh = library()
    parts = []
    for panels in columns:
        layout = bokeh.layouts.gridplot([[one] for one in panels], sizing_mode="stretch_width",
                                        toolbar_location="above", merge_tools=True,
                                        toolbar_options={"logo": None})
        item = json.dumps(bokeh.embed.json_item(layout), separators=(",", ":"))
        parts.append(Markup('<div class="plot" style="min-height: {}px" data-plot="{}"></div>').format(
            30 + sum(one.height for one in panels), compressed(_renumbered(item).encode())))
    return (Markup('<div class="plots" role="img" aria-label="{}">').format(description)
            + Markup("").join(parts) + Markup("</div>"))


def script() -> str:
    """Bokeh's library, compressed, for the page's own script."""
    bokeh = library()
    path = os.path.join(os.path.dirname(bokeh.__file__), "server", "static", "js", "bokeh.min.js")
    with open(path, "rb") as stream:
        return compressed(stream.read())
