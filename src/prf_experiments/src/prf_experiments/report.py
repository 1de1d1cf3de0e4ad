# SPDX-License-Identifier: BSD-3-Clause
"""A trial's report: one HTML file that needs nothing else."""
import html

import numpy as np

from prf_experiments import figures, frames, geometry, judge, page, recording, timeline

SHOWN_HORIZON = 0.5  # s, of the forecasts in the figure
MEANING = {"S": "success", "P": "partial success", "F": "failure", "INVALID": "no evidence"}


def _matched(first, second):
    """Values of two pose series at the stamps that both have."""
    stamps, at_first, at_second = np.intersect1d(first.stamps, second.stamps, return_indices=True)
    return stamps, first.values[at_first], second.values[at_second]


def _predicted(forecasts):
    """(stamps ns, positions (n, 3), horizon s) of the horizon nearest to the shown one."""
    usable = [row for row, horizons in enumerate(forecasts.horizons) if len(horizons)]
    if not usable:
        return np.array([], dtype=np.int64), np.empty((0, 3)), SHOWN_HORIZON
    column = int(np.argmin(np.abs(forecasts.horizons[usable[0]] - SHOWN_HORIZON)))
    usable = [row for row in usable if len(forecasts.horizons[row]) > column]
    stamps = [forecasts.stamps[row] + int(1e9 * forecasts.horizons[row][column]) for row in usable]
    return (np.array(stamps, dtype=np.int64),
            np.array([forecasts.positions[row][column] for row in usable]),
            float(forecasts.horizons[usable[0]][column]))


def draw(bag, data, demonstrated):
    """The figures of a trial: [(title, text, svg)]."""
    arm_base = geometry.compose(data.base.values, data.arm_base_in_body)
    in_arm_base = recording.Poses(data.base.stamps, arm_base)
    stamps, base_at, tag_at = _matched(in_arm_base, data.tag)
    truth = stamps, figures.relative_to(base_at, tag_at)
    camera = frames.lookup(frames.load(bag, "/robot_state_publisher"), recording.PLANNING_FRAME,
                           "camera_optical_frame", data.sight_stamps)
    measured = data.sight_stamps, geometry.compose(camera, data.sights)[:, :3]
    predicted_stamps, predicted, horizon = _predicted(data.forecasts)

    _, base_at, hand_at = _matched(in_arm_base, data.end_effector)
    executed = figures.relative_to(base_at, hand_at)
    _, tag_at, hand_at = _matched(data.tag, data.end_effector)
    executed_before_tag = figures.relative_to(tag_at, hand_at)
    demonstrated_before_tag = figures.relative_to(demonstrated.target_pose, demonstrated.poses)
    plans = [plan.positions for plan in data.plans if len(plan.positions)]
    camera_stamps, camera_at, tag_at = _matched(data.camera, data.tag)
    lateral, along = judge.tag_in_camera(camera_at, tag_at)
    return [
        ("Target, belief and phase", "In the arm's base frame. Measured: detections placed with "
         "the transforms of the encoders. True: simulator.",
         figures.target_over_time(data, truth, measured, (predicted_stamps, predicted), horizon)),
        ("Distance to the target", "By ground truth; dashed lines are the bounds of the verdict.",
         figures.distances(data, camera_stamps, lateral, along,
                           judge.arm_contacts(data.contacts))),
        ("Path of the hand", "In the arm's base frame, which moves with the robot.",
         figures.paths_in_space(executed, demonstrated.poses[:, :3],
                                plans[-1] if plans else np.empty((0, 3)), truth[1][-1])),
        ("Path before the box", "The same seen from the tag: the box stands still.",
         figures.paths_before_box(executed_before_tag, demonstrated_before_tag)),
    ]


def parts(content, data, drawings):
    """Body of a trial's page. `content` is what verdict.json holds."""
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
    return body


def write(path, bag, data, content, demonstrated):
    """Writes the report of a trial; `data` is None when the recording could not be read."""
    drawn = data is not None and content["verdict"] != "INVALID"
    with open(path, "w", encoding="utf-8") as stream:
        drawings = draw(bag, data, demonstrated) if drawn else []
        stream.write(page.whole("Trial " + content["verdict"], parts(content, data, drawings)))
