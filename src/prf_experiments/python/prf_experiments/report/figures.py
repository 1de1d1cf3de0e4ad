# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a trial. Time is in seconds since its first tick."""
from typing import Any

import numpy as np
from markupsafe import Markup

from prf_experiments.judge import cause, judge, world
from prf_experiments.record.recording import Contact, Recording
from prf_experiments.report import plots

TRUE: dict[str, Any] = {"color": "black", "line_width": 1.5}
MEASURED: dict[str, Any] = {"color": "#E69F00", "size": 4, "alpha": 0.45, "line_color": None}
PREDICTED: dict[str, Any] = {"color": "#0072B2", "line_width": 1.3, "line_dash": [4, 2]}
PLANNED: dict[str, Any] = {"color": "#0072B2", "line_width": 3, "line_dash": [3, 2], "alpha": 0.7}
DEMONSTRATED: dict[str, Any] = {"color": "#009E73", "line_width": 1.6, "line_dash": [2, 3]}
POSTERIORS: list[dict[str, Any]] = [  # in the order of judge.EXECUTION
    {"color": "#009E73"}, {"color": "#E69F00", "line_dash": [5, 2]},
    {"color": "black", "line_dash": [2, 3]}]
COMPARED: list[dict[str, Any]] = [  # of several trials in one figure
    {"color": "#D55E00", "line_width": 1.8, "line_dash": [6, 2]},
    {"color": "#0072B2", "line_width": 1.8}, {"color": "black", "line_width": 1.8, "line_dash": [2, 3]}]
TAG = "#D55E00"
WORLD, INJECTED, HIDDEN = "#E69F00", "#808080", "#56B4E9"
SHADES = ("Orange: what the world did. Grey: injected faults. Blue: the tag was out of view. The "
          "buttons above move, zoom and reset; a click on a name hides its line.")
LABELS = 6  # of events in a figure; more would hide the lines

BOX_SIDE, BOX_DEPTH, BOX_ABOVE_TAG = 0.30, 0.20, -0.07  # m; the tag hangs above the box's centre

Series = tuple[np.ndarray, np.ndarray]  # stamps (n,) ns, positions (n, 3) m


def time_panels(recording: Recording, labels: list[tuple[str, int]], **named: Any) -> list[Any]:
    """Panels over the trial's time, one below the other; labels: [(text, height px)]."""
    span = plots.library().models.Range1d(0.0, float(recording.seconds(recording.ticks[-1])),
                                          bounds="auto")
    return [plots.panel(label, height, span, "time, s" if row == len(labels) - 1 else "", **named)
            for row, (label, height) in enumerate(labels)]


def mark_events(panels: list[Any], recording: Recording) -> None:
    """What happened from outside, behind the lines; its words in the first panel."""
    def seconds(stamp):
        return float(recording.seconds(stamp))
    for panel in panels:
        for lost, found in cause.gaps(recording):
            plots.shade(panel, seconds(lost), seconds(found), HIDDEN)
        for row, event in enumerate(world.events(recording)):
            text = event.short if panel is panels[0] and row < LABELS else ""
            plots.shade(panel, seconds(event.begin), max(seconds(event.end), seconds(event.begin) + 0.05),
                        INJECTED if event.injected else WORLD, text, row % 3)


def _states(panel, recording):
    used = sorted(set(recording.progress.states))
    times, states = plots.thin(recording.seconds(recording.progress.stamps),
                               recording.progress.states)
    plots.add_line(panel, times, states, step=True, **TRUE)
    plots.name_values(panel, {int(state): judge.STATES[state].lower() for state in used})
    panel.y_range = plots.library().models.Range1d(used[0] - 0.5, used[-1] + 0.5)


def following(recording: Recording) -> Markup:
    """Position and rotation of the measured hand against its set-point, and the phase."""
    panels = time_panels(recording, [("position, mm", 150), ("rotation, °", 150), ("phase", 140)])
    stamps, errors = recording.following()
    for panel, values, unit in ((panels[0], 1e3 * errors[:, 0], "mm"),
                                (panels[1], np.degrees(errors[:, 1]), "°")):
        line = plots.add_line(panel, recording.seconds(stamps), values, **TRUE)
        plots.values_on_hover(panel, [line], unit)
        panel.y_range.start = 0.0
    _states(panels[2], recording)
    mark_events(panels, recording)
    return plots.embedded([panels], "Following error in position and rotation, and phase, over time")


def target_over_time(recording: Recording, truth: Series, measured: Series, predicted: Series,
                     horizon: float, shown: str = "xyz") -> Markup:
    """Target in the arm's base, the posterior of the HMM and the phase.

    truth, measured, predicted: (stamps ns, (n, 3) m) each; `shown` names the axes.
    """
    panels = time_panels(recording, [
        *((f"target {name}, mm", 185 if row == 0 else 150) for row, name in enumerate(shown)),
        ("HMM posterior", 160), ("phase", 140)])
    posterior, phase = panels[-2:]
    for name, panel in zip(shown, panels):
        axis = "xyz".index(name)
        first = panel is panels[0]
        low, high = np.nanmin(1e3 * truth[1][:, axis]), np.nanmax(1e3 * truth[1][:, axis])
        slack = max(5.0, 0.25 * (high - low))
        panel.y_range = plots.library().models.Range1d(float(low - slack), float(high + slack))
        for add, (stamps, values), style, label in (
                (plots.add_points, measured, MEASURED, "measured"),
                (plots.add_line, truth, TRUE, "true"),
                (plots.add_line, predicted, PREDICTED, f"predicted {horizon:.1f} s before")):
            line = add(panel, recording.seconds(stamps), 1e3 * values[:, axis],
                       label if first else "", **style)
            if style is TRUE:
                plots.values_on_hover(panel, [line], "mm")
        if first:
            plots.legend_above(panel)
    for index, (state, look) in enumerate(zip(judge.EXECUTION, POSTERIORS)):
        plots.add_line(posterior, recording.seconds(recording.progress.stamps),
                       recording.progress.posteriors[:, index], judge.STATES[state].lower(),
                       line_width=1.5, **look)
    plots.legend_above(posterior)
    posterior.y_range = plots.library().models.Range1d(-0.05, 1.05)
    _states(phase, recording)
    mark_events(panels, recording)
    return plots.embedded([panels], "Target position, HMM posterior and phase over time")


def distances(recording: Recording, stamps: np.ndarray, lateral: np.ndarray, along: np.ndarray,
              contacts: list[Contact]) -> Markup:
    """How far the tag is from where the camera should have it, and what was touched."""
    panels = time_panels(recording, [("off the axis, mm", 180), ("to stand-off, mm", 180)])
    for panel, values, sides in ((panels[0], 1e3 * lateral, [1]),
                                 (panels[1], 1e3 * (along - judge.STAND_OFF), [-1, 1])):
        line = plots.add_line(panel, recording.seconds(stamps), values, **TRUE)
        plots.values_on_hover(panel, [line], "mm")
        for bound, name in ((judge.REACHED_BOUND, "reached"), (judge.INSPECTED_BOUND, "inspected")):
            for side in sides:
                plots.add_bound(panel, side * 1e3 * bound, name if side > 0 else "")
    models = plots.library().models
    bound, error = 1.15e3 * judge.REACHED_BOUND, 1e3 * (along - judge.STAND_OFF)
    panels[0].y_range = models.Range1d(0.0, float(max(bound, 1.05e3 * np.nanmax(lateral))))
    panels[1].y_range = models.Range1d(float(min(-bound, 1.05 * np.nanmin(error))),
                                       float(max(bound, 1.05 * np.nanmax(error))))
    if contacts:
        most = max(60.0, *(1.3 * contact.force for contact in contacts))
        touched = plots.panel("contact, N", 160, panels[0].x_range, "time, s", y_axis_type="log",
                              y_range=(0.1, most))
        panels[1].xaxis.axis_label = None
        touched.segment([float(recording.seconds(contact.stamp)) for contact in contacts], 0.1,
                        [float(recording.seconds(contact.stamp)) for contact in contacts],
                        [max(0.1, contact.force) for contact in contacts], color=TAG, line_width=2)
        plots.add_bound(touched, judge.CONTACT_ISSUE, "an issue")
        plots.add_bound(touched, judge.EMERGENCY_STOP, "a failure")
        panels.append(touched)
    mark_events(panels, recording)
    return plots.embedded([panels], "Distance of the tag from the optical axis and along it, contacts")


def compared_distances(trials: list[tuple[str, Recording]]) -> Markup:
    """The tag's distance off the optical axis in up to three trials."""
    longest = max((data for _, data in trials), key=lambda data: len(data.ticks))
    panel, = time_panels(longest, [("off the axis, mm", 300)])
    most = 1.15e3 * judge.REACHED_BOUND
    for (name, data), look in zip(trials, COMPARED):
        stamps, lateral, _ = judge.distances(data)
        line = plots.add_line(panel, data.seconds(stamps), 1e3 * lateral, name, **look)
        plots.values_on_hover(panel, [line], "mm")
        most = max(most, 1.05e3 * float(np.nanmax(lateral)))
        for event in world.events(data):
            plots.shade(panel, float(data.seconds(event.begin)), float(data.seconds(event.end)),
                        INJECTED if event.injected else WORLD)
    panel.y_range = plots.library().models.Range1d(0.0, most)
    for bound, name in ((judge.REACHED_BOUND, "reached"), (judge.INSPECTED_BOUND, "inspected")):
        plots.add_bound(panel, 1e3 * bound, name)
    plots.legend_above(panel, 1)
    return plots.embedded([[panel]], "Distance of the tag from the optical axis in several trials")


def _view(across, above, title):
    panel = plots.panel(above, 330, None, across, match_aspect=True, title=title,
                        tools="box_zoom,pan,wheel_zoom,reset,save")
    panel.title.text_font_size = plots.SIZE
    return panel


def paths_in_space(executed: np.ndarray, demonstrated: np.ndarray, planned: np.ndarray,
                   target: np.ndarray) -> Markup:
    """Hand paths (n, 3) in the arm's base frame from the side and from above; target (3,)."""
    columns = []
    for axis, title, above in ((2, "from the side", "z, m"), (1, "from above", "y, m")):
        panel = _view("x, m", above, title)
        for values, style, label in ((demonstrated, DEMONSTRATED, "demonstrated"),
                                     (planned, PLANNED, "last plan"), (executed, TRUE, "executed")):
            if len(values):
                plots.add_line(panel, values[:, 0], values[:, axis], label, **style)
        plots.add_points(panel, executed[:1, 0], executed[:1, axis], "start", color="black", size=7)
        plots.add_points(panel, target[:1], target[axis:axis + 1], "tag", color=TAG, size=9,
                         marker="square")
        plots.legend_above(panel)
        columns.append([panel])
    return plots.embedded(columns, "Path of the hand in the arm's base frame from the side and from "
                          "above: demonstrated, planned, executed")


def paths_before_box(paths: list[tuple[str, np.ndarray, dict[str, Any]]]) -> Markup:
    """Hand paths [(label, (n, 3) m, look)] in the tag's frame (x right, y up, z toward the viewer)
    with the walls of the box."""
    columns = []
    half = 0.5 * BOX_SIDE
    for column, centre, title, label in ((1, BOX_ABOVE_TAG, "from the side", "above the tag, m"),
                                         (0, 0.0, "from above", "right of the tag, m")):
        panel = _view("in front of the tag, m", label, title)
        panel.x_range.flipped = True
        panel.line([BOX_DEPTH, 0, 0, BOX_DEPTH],
                   [centre - half, centre - half, centre + half, centre + half], color="#707070",
                   line_width=3)
        panel.line([0.004, 0.004], [-0.05, 0.05], color=TAG, line_width=5)
        for name, values, look in paths:
            plots.add_line(panel, values[:, 2], values[:, column], name, **look)
        plots.legend_above(panel)
        columns.append([panel])
    return plots.embedded(columns, "Path of the hand seen from the tag, with the walls of the box")
