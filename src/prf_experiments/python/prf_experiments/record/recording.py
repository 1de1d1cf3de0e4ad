# SPDX-License-Identifier: BSD-3-Clause
"""A trial's bag as arrays. Stamps are integer nanoseconds, taken from the messages' headers."""
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import rosgraph_msgs.msg
from numpy.typing import ArrayLike

from prf_experiments import geometry, robots
from prf_experiments.record import estimated, topics
from prf_experiments.record.poses import Joints, Poses
from prf_msgs import bags

# Of the default robot, for bags of something else than trials.
PLANNING_FRAME, ARM_JOINTS = robots.load().base_link, list(robots.load().joints)
TICK = 10_000_000  # ns, of the simulator; a driver may have another one
NEEDED = topics.SENSORS + topics.GROUND_TRUTH + topics.OUTPUTS  # of a trial's bag
RecordingError = bags.BagError  # also: the bag does not hold a trial


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
    # (n, 2) measured hand from the set-point, m and rad; NaN where it is unknown or was not told
    following: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    # (n,) m, what the arm can hold of the target's motion; NaN where it is unknown or was not told
    holdable: np.ndarray = field(default_factory=lambda: np.empty(0))


@dataclass
class Forecasts:
    stamps: np.ndarray  # (n,) ns
    statuses: np.ndarray  # (n,) TargetForecast constants
    horizons: list  # n arrays (h,) s
    positions: list  # n arrays (h, 3) m, planning frame


@dataclass
class Plan:
    stamp: int
    status: int
    message: str
    kkt_residual: float
    positions: np.ndarray  # (nodes, 3)
    forecast_stamp: int = 0  # ns, of the forecast that it is for


@dataclass
class Control:
    stamps: np.ndarray  # (n,) ns
    codes: np.ndarray  # (n,) ControlStatus constants
    reasons: list
    position_errors: np.ndarray = field(default_factory=lambda: np.empty(0))  # (n,) m
    orientation_errors: np.ndarray = field(default_factory=lambda: np.empty(0))  # (n,) rad


@dataclass
class FaultEvent:
    stamp: int  # ns, of the message or tick that it is done to
    fault: str
    what: str  # may be empty


@dataclass
class LoggedWarning:
    stamp: int  # ns
    node: str
    text: str


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
    detection_stamps: np.ndarray  # stamp of each TagDetectionArray, ns
    detections: np.ndarray  # (n, 7) tag in the camera's optical frame, NaN where it was not seen
    images: int  # camera/image_raw messages
    progress: Progress
    forecasts: Forecasts
    plans: list
    control: Control
    arm_base_in_body: np.ndarray  # (7,), from tf_static
    robot: robots.Robot = field(default_factory=robots.load)
    warnings: list = field(default_factory=list)  # warnings and worse of rosout
    diagnostics: dict = field(default_factory=dict)  # {node: {key: [text of each report]}}
    description: dict = field(default_factory=dict)
    measured: Joints | None = None
    commands: Joints | None = None
    fault_events: list = field(default_factory=list)
    is_estimated: bool = False  # no ground truth: target and hand by the robot's own sensors

    def following(self) -> tuple[np.ndarray, np.ndarray]:
        """(stamps ns, (n, 2) m and rad) of the measured hand against the set-point.

        By the decision, which tells it at every tick; else by the controller.
        """
        if np.any(np.isfinite(self.progress.following)):
            return self.progress.stamps, self.progress.following
        errors = [self.control.position_errors, self.control.orientation_errors]
        return self.control.stamps[:len(errors[0])], np.column_stack(errors)

    @property
    def tick(self) -> int:
        """Period of joint_states and everything published with them, ns; the arm's driver has it."""
        return round(1e9 * self.description.get("tick_s", 1e-9 * TICK))

    @property
    def start(self) -> int:
        return int(self.ticks[0])

    def seconds(self, stamps: ArrayLike) -> np.ndarray:
        """Time since the first tick, s."""
        return (np.asarray(stamps) - self.start) * 1e-9


def pose_values(pose: Any) -> tuple[float, ...]:
    p, q = pose.position, pose.orientation
    return (p.x, p.y, p.z, q.x, q.y, q.z, q.w)


def transform_values(transform: Any) -> tuple[float, ...]:
    t, r = transform.translation, transform.rotation
    return (t.x, t.y, t.z, r.x, r.y, r.z, r.w)


def read_object(text: str, what: str) -> dict:
    """A JSON object. Raises ValueError."""
    content = json.loads(text)
    if not isinstance(content, dict):
        raise ValueError(f"{what} is a JSON {type(content).__name__}, must be an object")
    return content


def read_description(text: str) -> dict:
    """What trial/description holds, with arguments as a trial has them. Raises ValueError."""
    content = read_object(text, topics.DESCRIPTION)
    for part in ("arguments", "versions"):
        if not isinstance(content.get(part, {}), dict):
            raise ValueError(f"{part} of {topics.DESCRIPTION} must be an object")
    for name in ("demonstration", "fault", "robot"):
        if not isinstance(content.get("arguments", {}).get(name) or "", str):
            raise ValueError(f"argument {name} of {topics.DESCRIPTION} must be a text")
    return content


def read_event(text: str) -> FaultEvent:
    """What a message of fault/events holds. Raises ValueError."""
    content = read_object(text, topics.EVENTS)
    stamp, fault, what = (content.get(name) for name in ("stamp", "fault", "what"))
    if not isinstance(stamp, int) or not isinstance(fault, str) or not isinstance(what, str):
        raise ValueError(f"{topics.EVENTS} must tell a stamp in ns, a fault and what it does")
    return FaultEvent(stamp, fault, what)


def description(path: str) -> dict:
    """What a trial's bag says about itself: command, arguments, versions; {} when nothing."""
    with bags.opened(path) as bag:
        for _, message, _ in bag.read_messages(topics=["/" + topics.DESCRIPTION]):
            return read_description(message.data)
    return {}


def tag_row(message: Any, tag_id: int) -> tuple[float, ...]:
    """Pose of a tag in a TagDetectionArray as 7 numbers, NaN when it was not found."""
    for detection in message.detections:
        if detection.id == tag_id:
            return pose_values(detection.pose.pose)
    return (np.nan,) * 7


class _Reader:
    """Collects what one pass through the bag gives: stamps and rows of each topic."""

    def __init__(self, tag_id, robot):
        self._tag_id = tag_id
        self.robot = robot
        self._stamps, self._rows = {}, {}
        self._fixed = {}  # child: (parent, pose of child in parent)
        self._names: list | None = None
        self._at: list = []
        self.contacts, self.plans, self.horizons, self.positions = [], [], [], []
        self.fault_events: list = []
        self.warnings, self.diagnostics, self.description = [], {}, {}
        self._kept = {topics.DESCRIPTION: self._keep_description, "tf_static": self._keep_transforms,
                      topics.EVENTS: self._keep_event, "rosout": self._keep_warning,
                      "diagnostics": self._keep_diagnostics}
        self._rows_of = {
            "joint_states": self._arm,
            estimated.STAND_IN: self._arm,
            "joint_command": self._command,
            "ground_truth/platform": lambda message: pose_values(message.pose.pose),
            "ground_truth/base": lambda message: pose_values(message.pose.pose),
            "ground_truth/tag": lambda message: pose_values(message.pose),
            "ground_truth/camera": lambda message: pose_values(message.pose),
            "ground_truth/end_effector": lambda message: pose_values(message.pose),
            "ground_truth/contacts": self._keep_contacts,
            "tag_detections": lambda message: tag_row(message, self._tag_id),
            "target/forecast": self._keep_forecast,
            "skill/trajectory": self._keep_plan,
            "execution/progress": lambda message: (
                message.state, message.cursor, message.reason,
                getattr(message, "following_error", -1.0),  # not in older bags
                getattr(message, "following_rotation", -1.0), getattr(message, "holdable", -1.0),
                *message.posterior),
            "control/status": lambda message: (message.code, message.reason,
                                               message.position_error,
                                               message.orientation_error),
        }

    @property
    def topics(self):
        return ["/" + name for name in [*self._rows_of, *self._kept]]

    def take(self, topic, message):
        name = topic[1:]
        if name in self._kept:
            self._kept[name](message)
        else:
            self._stamps.setdefault(name, []).append(message.header.stamp.to_nsec())
            self._rows.setdefault(name, []).append(self._rows_of[name](message))

    def _arm(self, message):
        """Positions and velocities of the arm; NaN for a joint that the message does not name."""
        if message.name != self._names:
            self._names = list(message.name)
            self._at = [self._names.index(name) if name in self._names else None
                        for name in self.robot.joints]
        return tuple(values[at] if at is not None and at < len(values) else np.nan
                     for values in (message.position, message.velocity) for at in self._at)

    def _command(self, message):
        if len(message.points) != 1:
            return (np.nan,) * (2 * len(self.robot.joints))
        point = message.points[0]
        at = {name: row for row, name in enumerate(message.joint_names)}
        return tuple(values[at[name]] if at.get(name, len(values)) < len(values) else np.nan
                     for values in (point.positions, point.velocities) for name in self.robot.joints)

    def _keep_event(self, message):
        self.fault_events.append(read_event(message.data))

    def _keep_description(self, message):
        self.description = read_description(message.data)

    def _keep_transforms(self, message):
        for item in message.transforms:
            self._fixed[item.child_frame_id] = (item.header.frame_id,
                                                transform_values(item.transform))

    def _keep_warning(self, message):
        if message.level >= rosgraph_msgs.msg.Log.WARN:
            self.warnings.append(LoggedWarning(message.header.stamp.to_nsec(),
                                             message.name.lstrip("/"), message.msg.strip()))

    def _keep_diagnostics(self, message):
        for status in message.status:
            values = self.diagnostics.setdefault(status.name.partition(":")[0], {})
            for item in status.values:
                values.setdefault(item.key, []).append(item.value)

    def _keep_contacts(self, message):
        stamp = message.header.stamp.to_nsec()
        self.contacts += [Contact(stamp, (contact.link_a, contact.link_b), contact.force)
                          for contact in message.contacts]

    def _keep_forecast(self, message):
        self.horizons.append(np.array([p.horizon.to_sec() for p in message.predictions]))
        self.positions.append(np.array([pose_values(p.pose)[:3]
                                        for p in message.predictions]).reshape(-1, 3))
        return message.status

    def _keep_plan(self, message):
        positions = np.array([pose_values(pose)[:3] for pose in message.poses]).reshape(-1, 3)
        self.plans.append(Plan(message.header.stamp.to_nsec(), message.status,
                               message.message, message.kkt_residual, positions,
                               message.forecast_stamp.to_nsec()))

    def stamps(self, topic):
        return np.array(self._stamps[topic], dtype=np.int64)

    def poses(self, topic):
        values = np.array(self._rows[topic], dtype=float).reshape(-1, 7)
        if np.any(np.all(values[:, 3:] == 0.0, axis=1)):
            raise ValueError(f"{topic} has a pose without orientation: its quaternion is 0, must have length 1")
        return Poses(self.stamps(topic), values)

    def progress(self):
        states, cursors, reasons, metres, radians, holdable, *posteriors = zip(
            *self._rows["execution/progress"])
        following = np.column_stack([metres, radians]).astype(float)
        following[following < 0.0] = np.nan
        held = np.array(holdable, dtype=float)
        held[held < 0.0] = np.nan
        return Progress(self.stamps("execution/progress"), np.array(states, dtype=int),
                        np.array(posteriors, dtype=float).T, np.array(cursors, dtype=float),
                        list(reasons), following, held)

    def control(self):
        codes, reasons, positions, orientations = zip(*self._rows["control/status"])
        return Control(self.stamps("control/status"), np.array(codes, dtype=int), list(reasons),
                       np.array(positions, dtype=float), np.array(orientations, dtype=float))

    def has(self, topic):
        return topic in self._rows

    def joints(self, topic):
        values = np.array(self._rows[topic], dtype=float).reshape(-1, 2 * len(self.robot.joints))
        return Joints(self.stamps(topic), *np.hsplit(values, 2))

    def forecasts(self):
        return Forecasts(self.stamps("target/forecast"),
                         np.array(self._rows["target/forecast"], dtype=int),
                         self.horizons, self.positions)

    def fixed_pose(self, child, parent):
        """Pose of child in parent along fixed transforms; None when they do not say."""
        pose = geometry.IDENTITY
        while child != parent:
            if child not in self._fixed:
                return None
            child, step = self._fixed[child]
            pose = geometry.compose(step, pose)
        return pose


def read(path: str, tag_id: int = 0, without: Sequence[str] = (), moved: str = "") -> Recording:
    """Reads a trial's bag. Raises RecordingError when it is broken or a topic is missing.

    Of the topics `without` it need not have a message. Where there is no ground truth, `moved` are the joints whose
    hand is looked at; else a stand-in's, if there is one.
    """
    try:
        robot = robots.load(description(path).get("arguments", {}).get("robot", robots.DEFAULT))
        reader = _Reader(tag_id, robot)
    except robots.RobotError as error:
        raise RecordingError(f"{path}: {error}") from None
    with bags.opened(path) as bag:
        found = bags.counts(bag)
        absent = () if any(found.get(name) for name in topics.GROUND_TRUTH) else tuple(topics.GROUND_TRUTH)
        without = (*without, *absent, *(("camera/image_raw", "camera/camera_info") if absent else ()))
        bags.require_messages(bag, [name for name in NEEDED if name not in without])
        bags.require_types(bag, {name.lstrip("/") for name in reader.topics})
        images = found.get("camera/image_raw", 0)
        for topic, message, _ in bag.read_messages(topics=reader.topics):
            reader.take(topic, message)
        return _recording(path, reader, images, moved)


def _recording(path, reader, images, moved):
    base, body = reader.robot.base_link, reader.robot.root_link
    arm_base_in_body = reader.fixed_pose(base, body)
    if arm_base_in_body is None:
        raise RecordingError(f"{path}: tf_static does not place {base} in {body}, must: is it the bag of a trial?")
    is_estimated = not reader.has("ground_truth/tag")
    moved = moved or (estimated.STAND_IN if reader.has(estimated.STAND_IN) else "joint_states")
    if is_estimated:
        world = estimated.world(path, reader.joints(moved), reader.joints("joint_states"),
                                reader.poses("tag_detections"), reader.fixed_pose, arm_base_in_body)
    else:
        world = estimated.World(*(reader.poses("ground_truth/" + name)
                                  for name in ("tag", "camera", "end_effector", "base", "platform")))
    ticks = world.hand.stamps if is_estimated else reader.stamps("joint_states")
    return Recording(
        ticks=ticks,
        tag=world.tag, camera=world.camera, end_effector=world.hand, base=world.base, platform=world.platform,
        contact_stamps=ticks if is_estimated else reader.stamps("ground_truth/contacts"),
        contacts=reader.contacts,
        is_estimated=is_estimated,
        detection_stamps=reader.stamps("tag_detections"),
        detections=reader.poses("tag_detections").values,
        images=images,
        progress=reader.progress(),
        forecasts=reader.forecasts(),
        plans=reader.plans,
        control=reader.control(),
        arm_base_in_body=arm_base_in_body, robot=reader.robot,
        measured=reader.joints(moved), commands=reader.joints("joint_command"),
        fault_events=reader.fault_events,
        warnings=reader.warnings, diagnostics=reader.diagnostics,
        description=reader.description)
