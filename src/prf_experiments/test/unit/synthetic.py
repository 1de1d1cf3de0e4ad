# SPDX-License-Identifier: BSD-3-Clause
"""Made-up trials: as arrays for the judge, and as bags for what reads bags."""
import json

import diagnostic_msgs.msg
import geometry_msgs.msg
import nav_msgs.msg
import numpy as np
import rosbag
import rosgraph_msgs.msg
import rospy
import sensor_msgs.msg
import std_msgs.msg
import tf2_msgs.msg
import trajectory_msgs.msg
from prf_experiments.judge import judge
from prf_experiments.record import recording

import prf_msgs.msg
from prf_experiments import geometry

START = 1_000_000_000  # ns
STILL = geometry.IDENTITY
TAG = np.array([0.89, 0.0, 1.30, 0.0, 0.0, 0.0, 1.0])
BASE = np.array([-0.156, 0.0, 0.53, 0.0, 0.0, 0.0, 1.0])
ARM_BASE_IN_BODY = np.array([0.25, 0.0, 0.115, 0.0, 0.0, 0.0, 1.0])


def camera_pose(lateral, along):
    """Camera that has the tag of pose TAG so far off its axis and along it, m."""
    camera_in_tag = np.concatenate([[-lateral, 0.0, along], [1.0, 0.0, 0.0, 0.0]])
    return geometry.compose(TAG, camera_in_tag)


def still(stamps, pose):
    return recording.Poses(stamps, np.tile(np.asarray(pose, float), (len(stamps), 1)))


def make_recording(seconds=10.0, lateral=0.0, along=judge.STAND_OFF, state="DONE"):
    """A trial in which the camera rests at one place; tests change what they are about.

    `lateral` and `along` are numbers or arrays with one entry a tick.
    """
    count = int(round(seconds * 100)) + 1
    ticks = START + recording.TICK * np.arange(count, dtype=np.int64)
    lateral, along = (np.broadcast_to(value, count) for value in (lateral, along))
    camera = recording.Poses(ticks, np.array([camera_pose(*row) for row in zip(lateral, along)]))
    images = ticks[::3]
    states = np.full(count, judge.STATES.index("TRACKING"))
    states[: count // 2] = judge.STATES.index("FORWARD")
    states[-1] = judge.STATES.index(state)
    posteriors = np.tile([0.8, 0.15, 0.05], (count, 1))
    detections = np.tile([0.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0], (len(images), 1))
    return recording.Recording(
        ticks=ticks, tag=still(ticks, TAG), camera=camera,
        end_effector=still(ticks, camera_pose(0, 0.2)),
        base=still(ticks, BASE), platform=still(ticks, STILL), contact_stamps=ticks, contacts=[],
        detection_stamps=images, detections=detections, images=len(images),
        progress=recording.Progress(ticks, states, posteriors, np.zeros(count), [""] * count,
                                    holdable=np.zeros(count)),
        forecasts=recording.Forecasts(images, np.ones(len(images), dtype=int),
                                      [np.array([0.0, 0.5])] * len(images),
                                      [np.array([[0.8, 0.0, 0.65]] * 2)] * len(images)),
        plans=[], control=recording.Control(ticks, np.zeros(count, dtype=int), [""] * count,
                                            np.zeros(count), np.zeros(count)),
        arm_base_in_body=ARM_BASE_IN_BODY)


def _stamped(kind, stamp, frame=""):
    message = kind()
    message.header.stamp = rospy.Time(0, int(stamp))
    message.header.frame_id = frame
    return message


def _pose(values):
    return geometry_msgs.msg.Pose(geometry_msgs.msg.Point(*values[:3]),
                                  geometry_msgs.msg.Quaternion(*values[3:]))


def _transform(stamp, parent, child, values):
    message = _stamped(geometry_msgs.msg.TransformStamped, stamp, parent)
    message.child_frame_id = child
    message.transform.translation = geometry_msgs.msg.Vector3(*values[:3])
    message.transform.rotation = geometry_msgs.msg.Quaternion(*values[3:])
    return message


class _Writer:
    def __init__(self, bag, skipped):
        self._bag, self._skipped = bag, skipped

    def add(self, topic, message, stamp, publisher="/platform_sim"):
        if topic in self._skipped:
            return
        header = {"topic": "/" + topic, "type": message._type, "md5sum": message._md5sum,
                  "message_definition": message._full_text, "callerid": publisher}
        self._bag.write("/" + topic, message, rospy.Time(0, int(stamp)), connection_header=header)


def write_bag(path, data, skipped=(), hand=None, seed=0, description=None):
    """Bag of a made-up trial without the topics `skipped`; `hand` (n, 7) is in the arm's base."""
    noise = np.random.default_rng(seed).integers(0, 255, 16, dtype=np.uint8).tobytes()
    with rosbag.Bag(path, "w", compression="lz4") as bag:
        writer = _Writer(bag, skipped)
        writer.add("tf_static", tf2_msgs.msg.TFMessage([
            _transform(0, "base_link", "j2s7s300_link_base", ARM_BASE_IN_BODY),
            _transform(0, "j2s7s300_end_effector", "camera_optical_frame",
                       [0.0, 0.07, -0.12, 0.0, 0.0, 1.0, 0.0])]),
            START, "/robot_state_publisher")
        writer.add("trial/description", std_msgs.msg.String(json.dumps(
            {"command": "made up", **(description or {})})), START, "/observer")
        for warning in data.warnings:
            writer.add("rosout", rosgraph_msgs.msg.Log(
                level=rosgraph_msgs.msg.Log.WARN, name="/" + warning.node, msg=warning.text,
                header=std_msgs.msg.Header(stamp=rospy.Time(0, int(warning.stamp)))),
                warning.stamp, "/" + warning.node)
        _add_diagnostics(writer, data)
        for row, stamp in enumerate(data.ticks):
            _add_tick(writer, data, row, stamp, hand)
        for row, stamp in enumerate(data.detection_stamps):
            _add_image(writer, data, row, stamp, noise)


def _add_diagnostics(writer, data):
    for node, values in data.diagnostics.items():
        for row in range(len(next(iter(values.values())))):
            told = [diagnostic_msgs.msg.KeyValue(key, texts[row]) for key, texts in values.items()]
            message = _stamped(diagnostic_msgs.msg.DiagnosticArray, START)
            message.status = [diagnostic_msgs.msg.DiagnosticStatus(name=node + ": part",
                                                                   values=told)]
            writer.add("diagnostics", message, START, "/" + node)


def _add_tick(writer, data, row, stamp, hand):
    writer.add("clock", rosgraph_msgs.msg.Clock(rospy.Time(0, int(stamp))), stamp)
    writer.add("joint_states", _stamped(sensor_msgs.msg.JointState, stamp), stamp)
    for name in ("platform", "base"):
        message = _stamped(nav_msgs.msg.Odometry, stamp, "world")
        message.pose.pose = _pose(getattr(data, name).values[row])
        writer.add("ground_truth/" + name, message, stamp)
    for name in ("tag", "camera", "end_effector"):
        message = _stamped(geometry_msgs.msg.PoseStamped, stamp, "world")
        message.pose = _pose(getattr(data, name).values[row])
        writer.add("ground_truth/" + name, message, stamp)
    contacts = _stamped(prf_msgs.msg.ContactArray, stamp, "world")
    contacts.contacts = [prf_msgs.msg.Contact(link_a=c.links[0], link_b=c.links[1], force=c.force)
                         for c in data.contacts if c.stamp == stamp]
    writer.add("ground_truth/contacts", contacts, stamp)
    progress = _stamped(prf_msgs.msg.ExecutionProgress, stamp)
    progress.state = int(data.progress.states[row])
    progress.posterior = data.progress.posteriors[row]
    progress.reason = data.progress.reasons[row]
    writer.add("execution/progress", progress, stamp, "/decision")
    writer.add("execution/setpoint",
               _stamped(trajectory_msgs.msg.MultiDOFJointTrajectory, stamp), stamp, "/decision")
    writer.add("joint_command", _stamped(trajectory_msgs.msg.JointTrajectory, stamp), stamp,
               "/arm_controller")
    status = _stamped(prf_msgs.msg.ControlStatus, stamp)
    status.code, status.reason = int(data.control.codes[row]), data.control.reasons[row]
    writer.add("control/status", status, stamp, "/arm_controller")
    pose = [0.616, 0.0, 0.585, 0.5, 0.5, 0.5, 0.5] if hand is None else hand[row]
    writer.add("tf", tf2_msgs.msg.TFMessage([
        _transform(stamp, "j2s7s300_link_base", "j2s7s300_end_effector", pose)]), stamp,
        "/robot_state_publisher")


def _add_image(writer, data, row, stamp, noise):
    image = _stamped(sensor_msgs.msg.Image, stamp, "camera_optical_frame")
    image.height = image.width = image.step = 4
    image.encoding, image.data = "mono8", noise
    writer.add("camera/image_raw", image, stamp)
    writer.add("camera/camera_info", _stamped(sensor_msgs.msg.CameraInfo, stamp), stamp)
    detections = _stamped(prf_msgs.msg.TagDetectionArray, stamp, "camera_optical_frame")
    if np.isfinite(data.detections[row, 0]):
        detection = prf_msgs.msg.TagDetection(family="tag36h11", id=0)
        detection.pose.pose = _pose(data.detections[row])
        detections.detections = [detection]
    writer.add("tag_detections", detections, stamp, "/tag_detector")
    forecast = _stamped(prf_msgs.msg.TargetForecast, stamp, "j2s7s300_link_base")
    for horizon, position in zip(data.forecasts.horizons[row], data.forecasts.positions[row]):
        prediction = prf_msgs.msg.TargetPrediction(horizon=rospy.Duration.from_sec(horizon))
        prediction.pose = _pose([*position, 0.0, 0.0, 0.0, 1.0])
        forecast.predictions.append(prediction)
    writer.add("target/forecast", forecast, stamp, "/target_predictor")
    plan = _stamped(prf_msgs.msg.SkillTrajectory, stamp, "j2s7s300_link_base")
    plan.poses = [_pose([0.3 + 0.03 * node, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0]) for node in range(10)]
    writer.add("skill/trajectory", plan, stamp, "/skill_planner")
