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
from prf_experiments.report import page
from prf_experiments.report.page import Section
from prf_experiments.teach import demonstration

NOTHING = Markup()
NOT_DRAWN = Markup(
    "<p>Not drawn: a success among others of its kind. Where its bag was kept, <code>rosrun "
    "prf_experiments report trial.bag report.html</code> draws pictures and figures; else the "
    "command above runs the same trial again, bit for bit, and draws them.</p>")
MEANING = {"S": "success", "P": "partial success", "F": "failure", "INVALID": "no evidence"}


def target_figure(bag: str, data: recording.Recording, shown: str = "xyz") -> Markup:
    """The target over time; what was measured is placed with the encoders' transforms."""
    from prf_experiments.report import figures  # matplotlib takes its time
    camera = frames.lookup(frames.load(bag, "/robot_state_publisher"), recording.PLANNING_FRAME,
                           "camera_optical_frame", data.detection_stamps)
    measured = data.detection_stamps, geometry.compose(camera, data.detections)[:, :3]
    stamps, positions, horizon = target.forecast(data)
    return figures.target_over_time(data, target.true(data), measured, (stamps, positions), horizon,
                                    shown)


def draw(bag: str, data: recording.Recording,
         demonstrated: demonstration.Demonstration) -> list[tuple[str, str, Markup]]:
    """The figures of a trial: [(title, text, svg)]."""
    from prf_experiments.report import figures
    _, base_at, hand_at = target.matched(target.arm_base(data), data.end_effector)
    executed = target.relative_to(base_at, hand_at)
    _, tag_at, hand_at = target.matched(data.tag, data.end_effector)
    executed_before_tag = target.relative_to(tag_at, hand_at)
    demonstrated_before_tag = target.relative_to(demonstrated.target, demonstrated.poses)
    plans = [plan.positions for plan in data.plans if len(plan.positions)]
    last_plan = plans[-1] if plans else np.empty((0, 3))
    camera_stamps, camera_at, tag_at = target.matched(data.camera, data.tag)
    lateral, along = judge.tag_in_camera(camera_at, tag_at)
    return [
        ("Target, posterior and phase", "In the arm's base frame. Measured: detections placed "
         "with the transforms of the encoders. True: simulator.",
         target_figure(bag, data)),
        ("Distance to the target", "By ground truth; dashed lines are the bounds of the verdict.",
         figures.distances(data, camera_stamps, lateral, along,
                           judge.arm_contacts(data.contacts))),
        ("Following", "From the set-point to the measured hand; faults are shaded.",
         figures.following(data)),
        ("Path of the hand", "In the arm's base frame, which moves with the robot.",
         figures.paths_in_space(executed, demonstrated.poses[:, :3], last_plan,
                                target.true(data)[1][-1])),
        ("Path before the box", "The same seen from the tag: the box stands still.",
         figures.paths_before_box(executed_before_tag, demonstrated_before_tag)),
    ]


def fault_rows(data: recording.Recording) -> list[tuple]:
    """[(fault, first s, last s, count, what)] of every episode of a fault."""
    return [(fault, float(data.seconds(first)), float(data.seconds(last)), count, "; ".join(told))
            for fault, first, last, count, told in reaction.episodes(data)]


def sections(content: dict, data: recording.Recording | None,
             drawings: Sequence[tuple[str, str, Markup]], scene: Markup) -> list[Section]:
    """What a trial's page shows. `content` is what verdict.json holds."""
    pairs = content["figures"].get("largest_contact_by_pair_n", {})
    measures = [(name, value) for name, value in content["figures"].items()
                if name != "largest_contact_by_pair_n"]
    for part in ("invariants", "reaction"):
        measures += [(name, value) for name, value in content.get(part, {}).items()
                     if name != "violations"]
    measures += [(name, content.get(name)) for name in ("wall_time_s", "simulated_per_real_time")]
    if data is not None:
        measures += [(f"solve time of a plan, {name}, µs", value)
                     for name, value in timeline.solve_times(data).items()]
    violations = content.get("invariants", {}).get("violations", [])
    found = [Section("INVARIANTS BROKEN", "What must hold in every trial did not hold in this one.",
                     [page.table([(text,) for text in violations])])] if violations else []
    if data is not None and data.fault_events:
        found.append(Section("Faults", "Injected; shaded in the figures over time. Times in s.",
                             [page.table(fault_rows(data),
                                         ("fault", "from", "to", "messages or acts", "what"))]))
    found += [Section("Scene", body=[scene])] if scene else []
    found += [Section(title, text, [drawing]) for title, text, drawing in drawings]
    if data is not None:
        told = timeline.text(data, judge.Verdict(content["verdict"], content["inspected"],
                                                 content["reason"], content["figures"]))
        found.append(Section("Timeline", body=[Markup('<pre class="wide">{}</pre>').format(told)]))
    found.append(Section("Figures of merit", body=[page.table(measures)]))
    if pairs:
        found.append(Section("Contacts of the arm", body=[
            page.table(sorted(pairs.items()), ("links", "largest force, N"))]))
    found.append(Section("Arguments and versions", body=[
        page.table([*content.get("arguments", {}).items(), *content.get("versions", {}).items()])]))
    return found


def render(content: dict, data: recording.Recording | None,
           drawings: Sequence[tuple[str, str, Markup]], scene: Markup = NOTHING,
           parameters: str = "") -> str:
    """The page of a trial."""
    return page.render("report.html", title="Trial " + content["verdict"],
                       content={"command": "", **content}, meaning=MEANING[content["verdict"]],
                       sections=sections(content, data, drawings, scene), parameters=parameters)


def write(path: str, bag: str, data: recording.Recording | None, content: dict,
          demonstrated: demonstration.Demonstration, scene: Markup = NOTHING) -> None:
    """Writes the report of a trial; `data` is None when the recording could not be read."""
    drawings = []
    if data is not None and content["verdict"] != "INVALID":
        drawings = draw(bag, data, demonstrated)
    files.write(path, render(content, data, drawings, scene, _parameters(bag)))


def write_brief(path: str, bag: str, data: recording.Recording | None, content: dict) -> None:
    """Writes the report of a trial in words and numbers, without pictures and figures."""
    files.write(path, render(content, data, [], NOT_DRAWN, _parameters(bag)))


def _parameters(bag):
    with contextlib.suppress(OSError), \
            open(os.path.join(os.path.dirname(bag), "parameters.yaml"), encoding="utf-8") as stream:
        return stream.read()
    return ""
