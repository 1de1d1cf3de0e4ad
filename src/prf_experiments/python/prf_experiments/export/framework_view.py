# SPDX-License-Identifier: BSD-3-Clause
"""Node framework_view: what the framework thinks, as messages that rviz draws.

Demonstration, plan, executed path, forecast with ellipsoids, state and reason, and the camera's image with the tags'
outlines.
"""
import contextlib

import geometry_msgs.msg
import nav_msgs.msg
import numpy as np
import rospy
import sensor_msgs.msg
import std_msgs.msg
import trajectory_msgs.msg
import visualization_msgs.msg
from PIL import Image, ImageDraw

import prf_msgs.msg
from prf_experiments.export import additions
from prf_experiments.teach import demonstration

NAME = "framework_view"
MODES = {"mono8": "L", "rgb8": "RGB", "bgr8": "RGB"}
EXECUTED = 2000  # set-points that are shown, 20 s
GREEN = (30, 220, 60)


def outlined(image: sensor_msgs.msg.Image, tags: list) -> sensor_msgs.msg.Image:
    """The image in colour with the tags' edges; as it is when its encoding is not among MODES."""
    if image.encoding not in MODES:
        return image
    picture = Image.frombytes(MODES[image.encoding], (image.width, image.height), image.data, "raw",
                              "BGR" if image.encoding == "bgr8" else MODES[image.encoding], image.step).convert("RGB")
    draw = ImageDraw.Draw(picture)
    for tag in tags:
        corners = [tuple(corner) for corner in np.reshape(tag.corners_px, (4, 2))]
        draw.line([*corners, corners[0]], fill=GREEN, width=3)
        draw.text(max(corners), f" {tag.id}", fill=GREEN)
    return sensor_msgs.msg.Image(header=image.header, height=image.height, width=image.width, encoding="rgb8",
                                 step=3 * image.width, data=picture.tobytes())


def path(header: std_msgs.msg.Header, poses: list) -> nav_msgs.msg.Path:
    return nav_msgs.msg.Path(header, [geometry_msgs.msg.PoseStamped(header, pose) for pose in poses])


def _pose(row: np.ndarray) -> geometry_msgs.msg.Pose:
    return geometry_msgs.msg.Pose(geometry_msgs.msg.Point(*row[:3]), geometry_msgs.msg.Quaternion(*row[3:]))


def ellipsoids(message: prf_msgs.msg.TargetForecast) -> visualization_msgs.msg.MarkerArray:
    """The forecast's positions with two standard deviations; what was drawn before is deleted."""
    kind = visualization_msgs.msg.Marker
    markers = [kind(header=message.header, action=kind.DELETEALL)]
    covariances = np.array([np.reshape(each.covariance, (6, 6))[:3, :3] for each in message.predictions])
    if len(covariances) and np.isfinite(covariances).all():
        for number, (size, turned) in enumerate(zip(*additions.ellipsoids(covariances))):
            marker = kind(header=message.header, ns="forecast", id=number, type=kind.SPHERE, action=kind.ADD)
            marker.pose.position = message.predictions[number].pose.position
            marker.pose.orientation = geometry_msgs.msg.Quaternion(*turned)
            marker.scale = geometry_msgs.msg.Vector3(*np.maximum(size, 1e-4))
            marker.color = std_msgs.msg.ColorRGBA(1.0, 0.55, 0.1, 0.2)
            markers.append(marker)
    return visualization_msgs.msg.MarkerArray(markers)


def state_text(message: prf_msgs.msg.ExecutionProgress) -> visualization_msgs.msg.Marker:
    kind = visualization_msgs.msg.Marker
    name = additions.constant_name(message, message.state, "state")
    marker = kind(header=message.header, ns="state", type=kind.TEXT_VIEW_FACING, action=kind.ADD)
    marker.text = f"{name}\n{message.reason}" if message.reason else name
    marker.pose.position.z, marker.pose.orientation.w = additions.STATE_HEIGHT, 1.0
    marker.scale.z, marker.color = 0.06, std_msgs.msg.ColorRGBA(0.1, 0.2, 0.5, 1.0)
    return marker


def _send(publisher: rospy.Publisher, message: object) -> None:
    with contextlib.suppress(rospy.ROSException):  # closed, while the node ends
        publisher.publish(message)


class FrameworkView:
    def __init__(self) -> None:
        def out(name, kind):
            return rospy.Publisher("~" + name, kind, queue_size=5, latch=True)
        self._plan, self._executed = out("plan", nav_msgs.msg.Path), out("executed", nav_msgs.msg.Path)
        self._demonstration = out("demonstration", nav_msgs.msg.Path)
        self._forecast = out("forecast", nav_msgs.msg.Path)
        self._ellipsoids = out("ellipsoids", visualization_msgs.msg.MarkerArray)
        self._state = out("state", visualization_msgs.msg.Marker)
        self._picture = out("image", sensor_msgs.msg.Image)
        self._tags: list = []
        self._done: list = []
        self._followed: str | None = None  # file of the demonstration that is shown
        for topic, kind, take in (
                ("skill/trajectory", prf_msgs.msg.SkillTrajectory, self._take_plan),
                ("target/forecast", prf_msgs.msg.TargetForecast, self._take_forecast),
                ("execution/progress", prf_msgs.msg.ExecutionProgress, self._take_progress),
                ("execution/setpoint", trajectory_msgs.msg.MultiDOFJointTrajectory, self._take_setpoint),
                ("tag_detections", prf_msgs.msg.TagDetectionArray, self._take_tags),
                ("camera/image_raw", sensor_msgs.msg.Image, self._take_image)):
            rospy.Subscriber(topic, kind, take, queue_size=5)

    def _take_plan(self, message):
        _send(self._plan, path(message.header, message.poses))
        if message.demonstration and message.demonstration != self._followed:
            self._followed = message.demonstration
            self._show_demonstration(message.header, message.demonstration)

    def _show_demonstration(self, header, file):
        """As it was recorded, in the planning frame."""
        try:
            shown = demonstration.read(file)
        except (demonstration.DemonstrationError, OSError) as error:
            rospy.logwarn("the demonstration is not shown: %s; the plan names that file, which must be there on this "
                          "machine, too", error)
            return
        _send(self._demonstration, path(header, [_pose(row) for row in shown.poses]))

    def _take_forecast(self, message):
        _send(self._forecast, path(message.header, [each.pose for each in message.predictions]))
        _send(self._ellipsoids, ellipsoids(message))

    def _take_progress(self, message):
        if message.header.stamp.nsecs // 10_000_000 % 5 == 0:  # 20 of 100 in a second
            _send(self._state, state_text(message))

    def _take_setpoint(self, message):
        """The way that the hand was sent, in the planning frame."""
        if message.points and message.points[0].transforms:
            move = message.points[0].transforms[0]
            pose = geometry_msgs.msg.Pose(orientation=move.rotation)
            pose.position = geometry_msgs.msg.Point(move.translation.x, move.translation.y, move.translation.z)
            self._done = [*self._done[1 - EXECUTED:], pose]
            if len(self._done) % 10 == 0 or len(self._done) == EXECUTED:
                _send(self._executed, path(message.header, self._done[::5]))

    def _take_tags(self, message):
        self._tags = message.detections

    def _take_image(self, message):
        if self._picture.get_num_connections():
            _send(self._picture, outlined(message, self._tags))


def main() -> int:
    rospy.init_node(NAME)
    FrameworkView()
    rospy.spin()
    return 0
