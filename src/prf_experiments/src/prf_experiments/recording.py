# SPDX-License-Identifier: BSD-3-Clause
"""A trial's bag as arrays. Stamps are integer nanoseconds, taken from the messages' headers."""
import json
import os
from dataclasses import dataclass, field

import numpy as np
import rosbag

from prf_experiments import geometry

GROUND_TRUTH = ["ground_truth/platform", "ground_truth/base", "ground_truth/tag",
                "ground_truth/camera", "ground_truth/end_effector", "ground_truth/contacts"]
SENSORS = ["joint_states", "camera/image_raw", "camera/camera_info"]
OUTPUTS = ["tag_detections", "target/forecast", "skill/trajectory", "execution/progress",
           "execution/setpoint", "joint_command", "control/status"]
TRANSFORMS = ["tf", "tf_static"]
EXEMPT = ["diagnostics", "rosout"]
DESCRIPTION = "trial/description"
GUIDE = "guide/wrench"

# Everything a trial's bag holds; an explicit list, so that what is missing is noticed.
RECORDED = (["clock"] + SENSORS + GROUND_TRUTH + OUTPUTS + TRANSFORMS + EXEMPT + [DESCRIPTION])

PLANNING_FRAME = "j2s7s300_link_base"
BODY_FRAME = "base_link"


class RecordingError(Exception):
    """The bag does not hold a trial; the message says what is missing or broken."""


@dataclass
class Poses:
    stamps: np.ndarray  # (n,) ns
    values: np.ndarray  # (n, 7)


@dataclass
class Contact:
    stamp: int
    links: tuple  # two names in alphabetical order
    force: float  # N


@dataclass
class Progress:
    stamps: np.ndarray  # (n,) ns
    states: np.ndarray  # (n,) ExecutionProgress constants
    posteriors: np.ndarray  # (n, 3)
    cursors: np.ndarray  # (n,)
    reasons: list


@dataclass
class Forecasts:
    stamps: np.ndarray  # (n,) ns
    statuses: np.ndarray  # (n,)
    horizons: list  # n arrays (h,) s
    positions: list  # n arrays (h, 3) m, planning frame


@dataclass
class Plan:
    stamp: int
    status: int
    kkt_residual: float
    positions: np.ndarray  # (nodes, 3)


@dataclass
class Recording:
    ticks: np.ndarray  # joint_states stamps, ns
    tag: Poses
    camera: Poses
    end_effector: Poses
    base: Poses
    platform: Poses
    contact_stamps: np.ndarray
    contacts: list
    sight_stamps: np.ndarray  # stamp of each TagDetectionArray, ns
    sights: np.ndarray  # (n, 7) tag in the camera's optical frame, NaN where it was not seen
    images: int  # camera/image_raw messages
    progress: Progress
    forecasts: Forecasts = None
    plans: list = field(default_factory=list)
    control_codes: np.ndarray = None
    arm_base_in_body: np.ndarray = None  # (7,), from tf_static
    description: dict = field(default_factory=dict)

    @property
    def start(self):
        return int(self.ticks[0])

    def seconds(self, stamps):
        """Time since the first tick, s."""
        return (np.asarray(stamps) - self.start) * 1e-9


def pose_values(pose):
    p, q = pose.position, pose.orientation
    return (p.x, p.y, p.z, q.x, q.y, q.z, q.w)


def transform_values(transform):
    t, r = transform.translation, transform.rotation
    return (t.x, t.y, t.z, r.x, r.y, r.z, r.w)


def open_bag(path):
    try:
        return rosbag.Bag(path)
    except rosbag.ROSBagUnindexedException:
        raise RecordingError(f"{path}: the bag was not closed") from None
    except (OSError, rosbag.ROSBagException, ValueError) as error:
        raise RecordingError(f"{path}: cannot be read: {error}") from None


def description(path):
    """What a trial's bag says about itself: command, arguments, versions; {} when nothing."""
    with open_bag(path) as bag:
        for _, message, _ in bag.read_messages(topics=["/" + DESCRIPTION]):
            return json.loads(message.data)
    return {}


class _Columns:
    """Rows collected per topic while the bag is read once."""

    def __init__(self):
        self.stamps = {}
        self.rows = {}

    def add(self, topic, stamp, row=None):
        self.stamps.setdefault(topic, []).append(stamp)
        self.rows.setdefault(topic, []).append(row)

    def poses(self, topic):
        return Poses(np.array(self.stamps[topic], dtype=np.int64),
                     np.array(self.rows[topic], dtype=float).reshape(-1, 7))

    def ints(self, topic):
        return np.array(self.stamps.get(topic, []), dtype=np.int64)


def tag_row(message, tag_id):
    for detection in message.detections:
        if detection.id == tag_id:
            return pose_values(detection.pose.pose)
    return (np.nan,) * 7


def _static_chain(transforms, child, parent):
    """Pose of child in parent along fixed transforms {child: (parent, pose)}, or None."""
    pose = geometry.IDENTITY
    while child != parent:
        if child not in transforms:
            return None
        child, step = transforms[child]
        pose = geometry.compose(step, pose)
    return pose


def read(path, tag_id=0):
    """Reads a trial's bag. Raises RecordingError when it is broken or a topic is missing."""
    if not os.path.exists(path):
        raise RecordingError(f"{path}: there is no such bag")
    columns, contacts, plans, fixed, description = _Columns(), [], [], {}, {}
    horizons, positions = [], []
    wanted = ["/" + name for name in GROUND_TRUTH + OUTPUTS + [DESCRIPTION]
              if name not in ("execution/setpoint", "joint_command")]
    wanted += ["/joint_states", "/tf_static"]
    with open_bag(path) as bag:
        counts = {name.lstrip("/"): info.message_count
                  for name, info in bag.get_type_and_topic_info().topics.items()}
        missing = [name for name in SENSORS + GROUND_TRUTH + OUTPUTS if not counts.get(name)]
        if missing:
            raise RecordingError(f"{path}: no message of " + ", ".join(missing))
        try:
            for topic, message, _ in bag.read_messages(topics=wanted):
                name = topic[1:]
                if name == DESCRIPTION:
                    description = json.loads(message.data)
                    continue
                if name == "tf_static":
                    for item in message.transforms:
                        fixed[item.child_frame_id] = (item.header.frame_id,
                                                      transform_values(item.transform))
                    continue
                stamp = message.header.stamp.to_nsec()
                if name in ("ground_truth/platform", "ground_truth/base"):
                    columns.add(name, stamp, pose_values(message.pose.pose))
                elif name == "ground_truth/contacts":
                    columns.add(name, stamp)
                    contacts += [Contact(stamp, (c.link_a, c.link_b), c.force)
                                 for c in message.contacts]
                elif name in GROUND_TRUTH:
                    columns.add(name, stamp, pose_values(message.pose))
                elif name == "tag_detections":
                    columns.add(name, stamp, tag_row(message, tag_id))
                elif name == "target/forecast":
                    columns.add(name, stamp, message.status)
                    horizons.append(np.array([p.horizon.to_sec() for p in message.predictions]))
                    positions.append(np.array([pose_values(p.pose)[:3]
                                               for p in message.predictions]).reshape(-1, 3))
                elif name == "execution/progress":
                    columns.add(name, stamp, (message.state, message.cursor, message.reason,
                                              *message.posterior))
                elif name == "skill/trajectory":
                    plans.append(Plan(stamp, message.status, message.kkt_residual,
                                      np.array([pose_values(p)[:3]
                                                for p in message.poses]).reshape(-1, 3)))
                elif name == "control/status":
                    columns.add(name, stamp, message.code)
                else:
                    columns.add(name, stamp)
        except (rosbag.ROSBagException, OSError, ValueError, EOFError, RuntimeError) as error:
            raise RecordingError(f"{path}: broken: {error}") from None

    progress = columns.rows["execution/progress"]
    return Recording(
        ticks=columns.ints("joint_states"),
        tag=columns.poses("ground_truth/tag"),
        camera=columns.poses("ground_truth/camera"),
        end_effector=columns.poses("ground_truth/end_effector"),
        base=columns.poses("ground_truth/base"),
        platform=columns.poses("ground_truth/platform"),
        contact_stamps=columns.ints("ground_truth/contacts"),
        contacts=contacts,
        sight_stamps=columns.ints("tag_detections"),
        sights=columns.poses("tag_detections").values,
        images=counts["camera/image_raw"],
        progress=Progress(columns.ints("execution/progress"),
                          np.array([row[0] for row in progress], dtype=int),
                          np.array([row[3:] for row in progress], dtype=float),
                          np.array([row[1] for row in progress], dtype=float),
                          [row[2] for row in progress]),
        forecasts=Forecasts(columns.ints("target/forecast"),
                            np.array(columns.rows["target/forecast"], dtype=int),
                            horizons, positions),
        plans=plans,
        control_codes=np.array(columns.rows["control/status"], dtype=int),
        arm_base_in_body=_static_chain(fixed, PLANNING_FRAME, BODY_FRAME),
        description=description)
