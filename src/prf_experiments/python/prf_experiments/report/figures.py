# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a trial as inline SVG.

Lines differ in colour (Okabe and Ito's palette), style and lightness, so that they can be told
apart in black and white and with colour-vision deficiency.
"""
import io
from typing import Any

import matplotlib
import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from prf_experiments.judge import judge, reaction
from prf_experiments.record.recording import Contact, Recording

TRUE = {"color": "black", "linewidth": 1.2}
MEASURED = {"color": "#E69F00", "linestyle": "none", "marker": "o", "markersize": 4.5,
            "markeredgewidth": 0.0, "alpha": 0.45}
PREDICTED = {"color": "#0072B2", "linewidth": 1.1, "linestyle": (0, (4, 2))}
PLANNED = {"color": "#0072B2", "linewidth": 2.6, "linestyle": (0, (3, 2)), "alpha": 0.7}
DEMONSTRATED = {"color": "#009E73", "linewidth": 1.4, "linestyle": (0, (1, 1.5))}
POSTERIORS: list[dict[str, Any]] = [  # in the order of judge.EXECUTION
    {"color": "#009E73", "linestyle": "-"},
    {"color": "#E69F00", "linestyle": (0, (5, 2))},
    {"color": "#000000", "linestyle": (0, (1, 1.5))}]
BOUND = {"color": "0.45", "linewidth": 0.8, "linestyle": (0, (6, 3))}
SEEN = {"color": "0.25", "linestyle": "none", "marker": "|", "markersize": 5}
BAR = "#56B4E9"
FAULTY: dict[str, Any] = {"color": "0.6", "alpha": 0.35, "linewidth": 0.0, "zorder": 0}
MAX_POINTS = 1500

BOX_SIDE, BOX_DEPTH, BOX_ABOVE_TAG = 0.30, 0.20, -0.07  # m; the tag hangs above the box's centre

Series = tuple[np.ndarray, np.ndarray]  # stamps (n,) ns, positions (n, 3) m


def thin(*arrays: np.ndarray) -> list[np.ndarray]:
    """Every n-th row of each array, so that about MAX_POINTS remain."""
    step = max(1, len(arrays[0]) // MAX_POINTS)
    return [array[::step] for array in arrays]


def svg(figure: Figure, description: str) -> Markup:
    """The figure as an SVG element with its description for those who cannot see it."""
    stream = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "prf"}):
        figure.savefig(stream, format="svg", metadata={"Date": None})
    text = stream.getvalue()
    text = text[text.index("<svg"):]
    return Markup(text.replace("<svg", f'<svg role="img" aria-label="{description}"', 1))


def _grid(axes):
    axes.grid(True, color="0.88", linewidth=0.6)
    axes.tick_params(labelsize=8)
    axes.margins(x=0.01)


def shade_faults(panels, recording: Recording) -> None:
    """Grey where faults were injected."""
    for _, first, last, _, _ in reaction.episodes(recording):
        begin, end = float(recording.seconds(first)), float(recording.seconds(last))
        for panel in panels:
            panel.axvspan(begin, max(end, begin + 0.05), **FAULTY)


def following(recording: Recording) -> Markup:
    """Position and rotation of the measured hand against its set-point, and the phase."""
    figure = Figure(figsize=(9.0, 4.6), layout="constrained")
    position, rotation, phase = figure.subplots(3, 1, sharex=True)
    stamps, errors = recording.following()
    for panel, values, label in ((position, 1e3 * errors[:, 0], "position, mm"),
                                 (rotation, np.degrees(errors[:, 1]), "rotation, °")):
        _grid(panel)
        panel.plot(*thin(recording.seconds(stamps), values), **TRUE)
        panel.set_ylabel(label, fontsize=9)
        panel.set_ylim(bottom=0.0)
    _grid(phase)
    _states_panel(phase, recording)
    phase.set_xlabel("time, s", fontsize=9)
    shade_faults((position, rotation, phase), recording)
    return svg(figure, "Following error in position and rotation, and phase, over time")


def _states_panel(axes, recording):
    times, states = thin(recording.seconds(recording.progress.stamps), recording.progress.states)
    axes.step(times, states, where="post", color="black", linewidth=1.2)
    used = sorted(set(recording.progress.states))
    axes.set_yticks(used, [judge.STATES[state].lower() for state in used])
    axes.set_ylim(used[0] - 0.5, used[-1] + 0.5)
    axes.set_ylabel("phase", fontsize=9)


def target_over_time(recording: Recording, truth: Series, measured: Series, predicted: Series,
                     horizon: float, shown: str = "xyz") -> Markup:
    """Target in the arm's base, the posterior of the HMM and the phase.

    truth, measured, predicted: (stamps ns, (n, 3) m) each; `shown` names the axes.
    """
    figure = Figure(figsize=(9.0, 3.2 + 1.8 * len(shown)), layout="constrained")
    *panels, posterior, phase = figure.subplots(
        len(shown) + 2, 1, sharex=True, height_ratios=[1] * len(shown) + [0.8, 0.8])
    for axis, panel in (("xyz".index(name), panel) for name, panel in zip(shown, panels)):
        _grid(panel)
        for (stamps, values), style, label in (
                (measured, MEASURED, "measured"), (truth, TRUE, "true"),
                (predicted, PREDICTED, f"predicted {horizon:.2f} s before")):
            times, column = thin(recording.seconds(stamps), 1e3 * values[:, axis])
            panel.plot(times, column, label=label, **style)
        panel.set_ylabel(f"target {'xyz'[axis]}, mm", fontsize=9)
        low, high = np.nanmin(1e3 * truth[1][:, axis]), np.nanmax(1e3 * truth[1][:, axis])
        slack = max(5.0, 0.25 * (high - low))
        panel.set_ylim(low - slack, high + slack)
    panels[0].legend(loc="upper right", fontsize=8, ncols=3)
    _grid(posterior)
    for index, (state, look) in enumerate(zip(judge.EXECUTION, POSTERIORS)):
        times, probability = thin(recording.seconds(recording.progress.stamps),
                                  recording.progress.posteriors[:, index])
        posterior.plot(times, probability, label=judge.STATES[state].lower(), linewidth=1.3,
                       **look)
    posterior.set_ylim(-0.05, 1.05)
    posterior.set_ylabel("HMM posterior", fontsize=9)
    posterior.legend(loc="center right", fontsize=8)
    _grid(phase)
    _states_panel(phase, recording)
    phase.set_xlabel("time, s", fontsize=9)
    shade_faults([*panels, posterior, phase], recording)
    return svg(figure, "Target position, HMM posterior and phase over time")


def distances(recording: Recording, stamps: np.ndarray, lateral: np.ndarray, along: np.ndarray,
              contacts: list[Contact]) -> Markup:
    """How far the tag is from where the camera should have it, and what was touched."""
    figure = Figure(figsize=(9.0, 6.2), layout="constrained")
    panels = figure.subplots(4, 1, sharex=True, height_ratios=[1, 1, 0.35, 0.7])
    times, across, error = thin(recording.seconds(stamps), 1e3 * lateral,
                                1e3 * (along - judge.STAND_OFF))
    for panel, values, label, sides in (
            (panels[0], across, "off the axis, mm", [1]),
            (panels[1], error, "along the axis\nto stand-off, mm", [-1, 1])):
        _grid(panel)
        panel.plot(times, values, **TRUE)
        for bound, name in ((judge.REACHED_BOUND, "reached"), (judge.INSPECTED_BOUND, "inspected")):
            for side in sides:
                panel.axhline(side * 1e3 * bound, **BOUND)
            panel.annotate(name, (1.0, 1e3 * bound), xycoords=("axes fraction", "data"),
                           ha="right", va="bottom", fontsize=8, color="0.35")
        panel.set_ylabel(label, fontsize=9)
    seen = np.isfinite(recording.detections[:, 0])
    panels[2].plot(recording.seconds(recording.detection_stamps[seen]), np.ones(seen.sum()), **SEEN)
    panels[2].set_yticks([1], ["seen"])
    panels[2].set_ylim(0.5, 1.5)
    panels[2].set_ylabel("tag", fontsize=9)
    _grid(panels[3])
    if contacts:
        panels[3].vlines([recording.seconds(contact.stamp) for contact in contacts], 0.0,
                         [contact.force for contact in contacts], color=BAR, linewidth=1.5)
    panels[3].axhline(judge.CONTACT_ISSUE, **BOUND)
    panels[3].set_yscale("symlog", linthresh=1.0)
    panels[3].set_ylim(0.0, max([60.0] + [1.2 * contact.force for contact in contacts]))
    panels[3].axhline(judge.EMERGENCY_STOP, **BOUND)
    panels[3].set_yticks([0, 1, 10, 50], ["0", "1", "10", "50"])
    panels[3].set_ylabel("contact, N", fontsize=9)
    panels[3].set_xlabel("time, s", fontsize=9)
    shade_faults(panels, recording)
    return svg(figure, "Distance of the tag from the optical axis and along it, contacts")


def _equal_axes(axes, points):
    low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
    centre, half = 0.5 * (low + high), 0.55 * np.max(high - low)
    axes.set_xlim(centre[0] - half, centre[0] + half)
    axes.set_ylim(centre[1] - half, centre[1] + half)
    axes.set_zlim(centre[2] - half, centre[2] + half)
    axes.set_box_aspect((1, 1, 1))


def paths_in_space(executed: np.ndarray, demonstrated: np.ndarray, planned: np.ndarray,
                   target: np.ndarray) -> Markup:
    """Hand paths (n, 3) in the arm's base frame; target (3,)."""
    figure = Figure(figsize=(6.4, 5.6), layout="constrained")
    axes = figure.add_subplot(projection="3d")
    for values, style, label in ((demonstrated, DEMONSTRATED, "demonstrated"),
                                 (planned, PLANNED, "last plan"), (executed, TRUE, "executed")):
        if len(values):
            axes.plot(*values.T, label=label, **style)
    axes.plot(*executed[:1].T, marker="o", color="black", markersize=4, linestyle="none",
              label="start")
    axes.plot(*target[:, None], marker="s", color="#D55E00", markersize=7, linestyle="none",
              label="tag")
    _equal_axes(axes, np.vstack([executed, demonstrated, target[None, :]]))
    for setter, name in ((axes.set_xlabel, "x, m"), (axes.set_ylabel, "y, m"),
                         (axes.set_zlabel, "z, m")):
        setter(name, fontsize=8)
    axes.tick_params(labelsize=7)
    axes.view_init(elev=22, azim=-120)
    axes.legend(fontsize=8, loc="upper left")
    return svg(figure, "Path of the hand in the arm's base frame: demonstrated, planned, executed")


def paths_before_box(executed: np.ndarray, demonstrated: np.ndarray) -> Markup:
    """Hand paths (n, 3) in the tag's frame (x right, y up, z toward the viewer), with the box."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    side, top = figure.subplots(1, 2)
    half = 0.5 * BOX_SIDE
    for axes, column, centre, label in ((side, 1, BOX_ABOVE_TAG, "above the tag, m"),
                                        (top, 0, 0.0, "right of the tag, m")):
        _grid(axes)
        axes.plot([BOX_DEPTH, 0, 0, BOX_DEPTH],
                  [centre - half, centre - half, centre + half, centre + half],
                  color="0.35", linewidth=2.5, solid_joinstyle="miter")
        axes.plot([0.004, 0.004], [-0.05, 0.05], color="#D55E00", linewidth=4,
                  solid_capstyle="butt")
        axes.plot(demonstrated[:, 2], demonstrated[:, column], label="demonstrated", **DEMONSTRATED)
        axes.plot(*thin(executed[:, 2], executed[:, column]), label="executed", **TRUE)
        axes.invert_xaxis()
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("in front of the tag, m", fontsize=9)
        axes.set_ylabel(label, fontsize=9)
    side.legend(fontsize=8, loc="best")
    side.set_title("from the side", fontsize=9)
    top.set_title("from above", fontsize=9)
    return svg(figure, "Path of the hand seen from the tag, with the walls of the box")
