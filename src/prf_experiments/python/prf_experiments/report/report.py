# SPDX-License-Identifier: BSD-3-Clause
"""A trial's report: one HTML file that needs nothing else."""
import contextlib
import html
import os

import numpy as np

from prf_experiments import geometry
from prf_experiments.judge import judge, target, timeline
from prf_experiments.record import frames, recording
from prf_experiments.report import figures, page

MEANING = {"S": "success", "P": "partial success", "F": "failure", "INVALID": "no evidence"}


def target_figure(bag, data, shown="xyz"):
    """The target over time; what was measured is placed with the encoders' transforms."""
    camera = frames.lookup(frames.load(bag, "/robot_state_publisher"), recording.PLANNING_FRAME,
                           "camera_optical_frame", data.sight_stamps)
    measured = data.sight_stamps, geometry.compose(camera, data.sights)[:, :3]
    *predicted, horizon = target.forecast(data)
    return figures.target_over_time(data, target.true(data), measured, predicted, horizon,
                                    shown)


def draw(bag, data, demonstrated):
    """The figures of a trial: [(title, text, svg)]."""
    _, base_at, hand_at = target.matched(target.arm_base(data), data.end_effector)
    executed = target.relative_to(base_at, hand_at)
    _, tag_at, hand_at = target.matched(data.tag, data.end_effector)
    executed_before_tag = target.relative_to(tag_at, hand_at)
    demonstrated_before_tag = target.relative_to(demonstrated.target_pose, demonstrated.poses)
    plans = [plan.positions for plan in data.plans if len(plan.positions)]
    last_plan = plans[-1] if plans else np.empty((0, 3))
    camera_stamps, camera_at, tag_at = target.matched(data.camera, data.tag)
    lateral, along = judge.tag_in_camera(camera_at, tag_at)
    return [
        ("Target, belief and phase", "In the arm's base frame. Measured: detections placed "
         "with the transforms of the encoders. True: simulator.",
         target_figure(bag, data)),
        ("Distance to the target", "By ground truth; dashed lines are the bounds of the verdict.",
         figures.distances(data, camera_stamps, lateral, along,
                           judge.arm_contacts(data.contacts))),
        ("Path of the hand", "In the arm's base frame, which moves with the robot.",
         figures.paths_in_space(executed, demonstrated.poses[:, :3], last_plan,
                                target.true(data)[1][-1])),
        ("Path before the box", "The same seen from the tag: the box stands still.",
         figures.paths_before_box(executed_before_tag, demonstrated_before_tag)),
    ]


def parts(content, data, drawings, scene="", parameters=""):
    """Body of a trial's page. `content` is what verdict.json holds, `scene` is HTML."""
    verdict = content["verdict"]
    pairs = content["figures"].get("largest_contact_by_pair_n", {})
    measures = [(name, value) for name, value in content["figures"].items()
                if name != "largest_contact_by_pair_n"]
    measures += [("wall_time_s", content.get("wall_time_s")),
                 ("simulated_per_real_time", content.get("simulated_per_real_time"))]
    inspected = " (inspected)" if content["inspected"] else ""
    body = [
        f"<p class=\"verdict\"><b>{verdict}</b> {MEANING[verdict]}{inspected}: "
        f"{html.escape(content['reason'])}</p>",
        f"<pre>{html.escape(content.get('command', ''))}</pre>",
    ]
    if scene:
        body += ["<h2>Scene</h2>", scene]
    for title, text, drawing in drawings:
        body += [f"<h2>{title}</h2><p>{text}</p>", drawing]
    if data is not None:
        told = timeline.text(data, judge.Verdict(verdict, content["inspected"], content["reason"],
                                                 content["figures"]))
        body += ["<h2>Timeline</h2>", f"<pre class=\"wide\">{html.escape(told)}</pre>"]
    body += ["<h2>Figures of merit</h2>", page.table(measures)]
    if pairs:
        body += ["<h2>Contacts of the arm</h2>",
                 page.table(sorted(pairs.items()), ("links", "largest force, N"))]
    body += ["<h2>Arguments and versions</h2>",
             page.table([*content.get("arguments", {}).items(),
                         *content.get("versions", {}).items()])]
    if parameters:
        body += ["<details><summary>Parameters of all nodes</summary><pre>"
                 f"{html.escape(parameters)}</pre></details>"]
    return body


def write(path, bag, data, content, demonstrated, scene=""):
    """Writes the report of a trial; `data` is None when the recording could not be read."""
    parameters = ""
    with contextlib.suppress(OSError), \
            open(os.path.join(os.path.dirname(bag), "parameters.yaml"), encoding="utf-8") as stream:
        parameters = stream.read()
    drawn = data is not None and content["verdict"] != "INVALID"
    with open(path, "w", encoding="utf-8") as stream:
        drawings = draw(bag, data, demonstrated) if drawn else []
        stream.write(page.whole("Trial " + content["verdict"],
                                parts(content, data, drawings, scene, parameters)))
