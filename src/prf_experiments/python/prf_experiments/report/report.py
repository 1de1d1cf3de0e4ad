# SPDX-License-Identifier: BSD-3-Clause
"""A trial's report: one HTML file that needs nothing else."""
import contextlib
import os
from collections.abc import Sequence

import numpy as np
from markupsafe import Markup

from prf_experiments import files, geometry
from prf_experiments.judge import judge, reaction, target, timeline
from prf_experiments.record import frames, recording
from prf_experiments.report import measures, page
from prf_experiments.report.page import Section
from prf_experiments.teach import demonstration

NOTHING = Markup()
NOT_DRAWN = Markup(
    "<p>Not drawn: a success among others of its kind. Where its bag was kept, <code>rosrun "
    "prf_experiments report trial.bag report.html</code> draws pictures and figures; else the "
    "command above runs the same trial again, bit for bit, and draws them.</p>")
MEANING = {"S": "success", "P": "partial success", "F": "failure", "INVALID": "no evidence"}
RULES = [
    ("reached", f"The tag's centre is within {1e3 * judge.REACHED_BOUND:.0f} mm of the camera's optical axis, and "
     f"within {1e3 * judge.REACHED_BOUND:.0f} mm of {judge.STAND_OFF:.1f} m along it, for "
     f"{judge.REACHED_HOLD / judge.SECOND:.1f} s without a break, by ground truth."),
    ("inspected", f"The same with {1e3 * judge.INSPECTED_BOUND:.0f} mm and "
     f"{judge.INSPECTED_HOLD / judge.SECOND:.1f} s; beside the verdict."),
    ("S, success", "Reached, and no issue."),
    ("P, partial success", f"Reached, with an issue: contact above {judge.CONTACT_ISSUE:.0f} N, or the tag out of view "
     f"for more than {judge.OUT_OF_VIEW_LIMIT / judge.SECOND:.0f} s."),
    ("F, failure", f"Not reached, contact above {judge.EMERGENCY_STOP:.0f} N, a fall, or an arm that stopped for an "
     "error."),
    ("INVALID", "The recording or a process failed: no evidence of anything.")]


def target_figure(bag: str, data: recording.Recording, shown: str = "xyz") -> Markup:
    """The target over time; what was measured is placed with the encoders' transforms."""
    from prf_experiments.report import figures  # its library takes its time
    camera = frames.lookup(frames.load(bag, "/robot_state_publisher"), data.robot.base_link,
                           "camera_optical_frame", data.detection_stamps)
    measured = data.detection_stamps, geometry.compose(camera, data.detections)[:, :3]
    stamps, positions, horizon = target.forecast(data)
    return page.plotted(lambda: figures.target_over_time(
        data, target.true(data), measured, (stamps, positions), horizon, shown))


def before_tag(data: recording.Recording) -> np.ndarray:
    """Path of the hand in the tag's frame, (n, 3) m."""
    _, tag_at, hand_at = target.matched(data.tag, data.end_effector)
    return target.relative_to(tag_at, hand_at)


def draw(bag: str, data: recording.Recording,
         demonstrated: demonstration.Demonstration) -> list[tuple[str, str, Markup]]:
    """The figures of a trial: [(title, text, html)]."""
    from prf_experiments.report import figures
    _, base_at, hand_at = target.matched(target.arm_base(data), data.end_effector)
    executed = target.relative_to(base_at, hand_at)
    demonstrated_before_tag = target.relative_to(demonstrated.target, demonstrated.poses)
    plans = [plan.positions for plan in data.plans if len(plan.positions)]
    last_plan = plans[-1] if plans else np.empty((0, 3))
    camera_stamps, camera_at, tag_at = target.matched(data.camera, data.tag)
    lateral, along = judge.tag_in_camera(camera_at, tag_at)
    return [
        ("Distance to the target", "By ground truth; dashed lines are the bounds of the verdict. "
         + figures.SHADES,
         page.plotted(lambda: figures.distances(data, camera_stamps, lateral, along,
                                                judge.arm_contacts(data)))),
        ("Target, posterior and phase", "In the arm's base frame. Measured: detections placed "
         "with the transforms of the encoders. True: simulator.",
         target_figure(bag, data)),
        ("Following", "From the set-point to the measured hand.",
         page.plotted(lambda: figures.following(data))),
        ("Path of the hand", "In the arm's base frame, which moves with the robot.",
         page.plotted(lambda: figures.paths_in_space(executed, demonstrated.poses[:, :3], last_plan,
                                                     target.true(data)[1][-1]))),
        ("Path before the box", "The same seen from the tag: the box stands still.",
         page.plotted(lambda: figures.paths_before_box([
             ("demonstrated", demonstrated_before_tag, figures.DEMONSTRATED),
             ("executed", before_tag(data), figures.TRUE)]))),
    ]


def fault_rows(data: recording.Recording) -> list[tuple]:
    """[(fault, first s, last s, count, what)] of every episode of a fault."""
    return [(fault, float(data.seconds(first)), float(data.seconds(last)), count, "; ".join(told))
            for fault, first, last, count, told in reaction.episodes(data)]


def timeline_tables(data: recording.Recording, figures: dict) -> list[Markup]:
    """Events, phases, and what was lost or refused."""
    events = [(event.kind, *line) for event, line in
              zip(timeline.events(data, figures), timeline.event_lines(data, figures))]
    parts = [page.render("timeline.html", events=events), Markup("<h3>Phases</h3>"),
             page.table(timeline.phase_lines(data),
                        ("phase", "spent, s", "off axis, mm: mean", "standard deviation", "largest",
                         "following error, mm: mean", "largest"))]
    losses = timeline.losses(data)
    if losses:
        parts += [Markup("<h3>Lost or refused</h3>"),
                  page.table(losses, ("node", "what", "count"))]
    return parts


def sections(content: dict, data: recording.Recording | None,
             drawings: Sequence[tuple[str, str, Markup]], scene: Markup) -> list[Section]:
    """What a trial's page shows. `content` is what verdict.json holds."""
    violations = content.get("invariants", {}).get("violations", [])
    found = [Section("INVARIANTS BROKEN", "What must hold in every trial did not hold in this one.",
                     [page.table([(text,) for text in violations])])] if violations else []
    found += [Section("Scene", body=[scene])] if scene else []
    if data is not None and data.fault_events:
        found.append(Section("Faults and disturbances", "Shaded in the figures over time. Times in s.",
                             [page.table(fault_rows(data),
                                         ("fault", "from", "to", "messages or acts", "what"))]))
    found += [Section(title, text, [drawing]) for title, text, drawing in drawings]
    if data is not None:
        found.append(Section("Timeline", "A click on a time shows that moment in the film.",
                             timeline_tables(data, content["figures"])))
    solved = timeline.solve_times(data) if data is not None else {}
    found.append(Section("Figures of merit", body=[page.table(
        [*measures.rows(content), *((f"solve time of a plan, {name}", value, "µs")
                                    for name, value in solved.items())],
        ("figure", "value", "unit"), "figures")]))
    pairs = content["figures"].get("largest_contact_by_pair_n", {})
    if pairs:
        found.append(Section("Contacts of the arm", body=[
            page.table(sorted(pairs.items()), ("links", "largest force, N"))]))
    found.append(Section("Arguments and versions", body=[
        page.table([*content.get("arguments", {}).items(), *content.get("versions", {}).items()])]))
    return found


def render(content: dict, data: recording.Recording | None,
           drawings: Sequence[tuple[str, str, Markup]], scene: Markup = NOTHING,
           parameters: str = "", back: str = "") -> str:
    """The page of a trial; `back` is the address of the table that it is part of."""
    inspected = ("Inspected: " if content["inspected"] else "Not inspected: ") + (
        f"within {1e3 * judge.INSPECTED_BOUND:.0f} mm for {judge.INSPECTED_HOLD / judge.SECOND:.1f} s"
        + (f" by {content['figures']['inspected_s']:.2f} s." if content["inspected"]
           else " did not happen."))
    return page.whole("report.html", title="Trial " + content["verdict"], back=back,
                      content={"command": "", "cause": "", **content},
                      meaning=MEANING[content["verdict"]], inspected=inspected,
                      rules=page.table(RULES), parameters=parameters,
                      sections=sections(content, data, drawings, scene))


def _back(path):
    """A sweep keeps trials/<name>/report.html below its table."""
    folder = os.path.dirname(os.path.dirname(os.path.abspath(path)))
    return "../../index.html" if os.path.basename(folder) == "trials" else ""


def write(path: str, bag: str, data: recording.Recording | None, content: dict,
          demonstrated: demonstration.Demonstration, scene: Markup = NOTHING) -> None:
    """Writes the report of a trial; `data` is None when the recording could not be read."""
    drawings = []
    if data is not None and content["verdict"] != "INVALID":
        drawings = draw(bag, data, demonstrated)
    files.write(path, render(content, data, drawings, scene, _parameters(bag), _back(path)))


def write_brief(path: str, bag: str, data: recording.Recording | None, content: dict) -> None:
    """Writes the report of a trial in words and numbers, without pictures and figures."""
    files.write(path, render(content, data, [], NOT_DRAWN, _parameters(bag), _back(path)))


def _parameters(bag):
    with contextlib.suppress(OSError), \
            open(os.path.join(os.path.dirname(bag), "parameters.yaml"), encoding="utf-8") as stream:
        return stream.read()
    return ""
