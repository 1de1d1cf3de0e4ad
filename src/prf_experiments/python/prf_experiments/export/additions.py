# SPDX-License-Identifier: BSD-3-Clause
"""Standard messages beside ours, for viewers that do not know ours.

Each topic gets companions under its own name: `target/forecast` for instance `target/forecast/path`.
A companion carries the header of its message and is written at the same time.
"""
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from prf_experiments.export.types import Standard
else:
    Standard = Any  # framework_view uses what stands here without rosbags

NUMBER, TEXT = "std_msgs/msg/Float64", "std_msgs/msg/String"
PATH, POSE, POSES = "nav_msgs/msg/Path", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseArray"
MARKER, MARKERS = "visualization_msgs/msg/Marker", "visualization_msgs/msg/MarkerArray"
OUTLINE, COLOUR = "visualization_msgs/msg/ImageMarker", "std_msgs/msg/ColorRGBA"
TRANSFORM, TRANSFORMS = "geometry_msgs/msg/TransformStamped", "tf2_msgs/msg/TFMessage"
TIME, POINT, VECTOR = "builtin_interfaces/msg/Time", "geometry_msgs/msg/Point", "geometry_msgs/msg/Vector3"

SIGMAS = 2.0  # an ellipsoid holds the position with 74 % (chi-squared, three degrees of freedom)
STATE_HEIGHT = 1.1  # m above the arm's base, of the state's name in the scene
NANOSECONDS = 1_000_000_000
# Constants of visualization_msgs.
ADD, DELETE_ALL, SPHERE, TEXT_FACING, LINE_LIST = 0, 3, 2, 9, 3


@dataclass
class Companion:
    suffix: str  # of the topic, after a slash
    kind: str
    message: Any


Maker = Callable[[str, Any, Standard], Iterator[Companion]]


def seconds(duration: Any) -> float:
    return duration.sec + duration.nanosec * 1e-9


def later(stamp: Any, duration: Any, standard: Standard) -> Any:
    total = ((stamp.sec + duration.sec) * NANOSECONDS + stamp.nanosec + duration.nanosec)
    return standard.make(TIME, sec=total // NANOSECONDS, nanosec=total % NANOSECONDS)


def colour(standard: Standard, red: float, green: float, blue: float, alpha: float) -> Any:
    return standard.make(COLOUR, r=red, g=green, b=blue, a=alpha)


def path(header: Any, stamped: list, standard: Standard) -> Any:
    """Path through (stamp, pose) in the header's frame."""
    kind = "std_msgs/msg/Header"
    return standard.make(PATH, header=header, poses=[
        standard.make(POSE, header=standard.make(kind, stamp=stamp, frame_id=header.frame_id),
                      pose=pose) for stamp, pose in stamped])


def numbers(values: dict[str, float], standard: Standard) -> Iterator[Companion]:
    for name, value in values.items():
        yield Companion(name, NUMBER, standard.make(NUMBER, data=float(value)))


def constant_name(message: Any, value: int, first: str) -> str:
    """Name of a message's constant; constants begin with `first`, in their order of numbers."""
    names = {getattr(message, name): name for name in dir(message)
             if name.isupper() and isinstance(getattr(message, name), int)}
    return names.get(value, f"{first} {value}")


def ellipsoids(covariances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(diameters (n, 3) m, orientations (n, 4)) of the ellipsoids of positions' covariances (n, 3, 3).

    The principal axes are the eigenvectors, the half axes SIGMAS times the root of the eigenvalues.
    """
    variances, axes = np.linalg.eigh(covariances)
    axes[np.linalg.det(axes) < 0.0, :, 0] *= -1.0  # right-handed
    return (2.0 * SIGMAS * np.sqrt(np.maximum(variances, 0.0)),
            Rotation.from_matrix(axes).as_quat())


def forecast(_: str, message: Any, standard: Standard) -> Iterator[Companion]:
    header, predictions = message.header, message.predictions
    yield Companion("path", PATH, path(header, [
        (later(header.stamp, each.horizon, standard), each.pose) for each in predictions], standard))
    yield Companion("poses", POSES, standard.make(
        POSES, header=header, poses=[each.pose for each in predictions]))
    yield Companion("ellipsoids", MARKERS, standard.make(
        MARKERS, markers=[standard.make(MARKER, header=header, action=DELETE_ALL),
                          *_spheres(header, predictions, standard)]))
    yield from numbers({"status": message.status, "nis": message.nis,
                        "measured_speed": getattr(message, "measured_speed", np.nan)}, standard)


def _spheres(header: Any, predictions: list, standard: Standard) -> Iterator[Any]:
    covariances = np.array([np.reshape(each.covariance, (6, 6))[:3, :3] for each in predictions])
    covariances = covariances.reshape(-1, 3, 3)
    drawn = np.flatnonzero(np.isfinite(covariances).all(axis=(1, 2)))
    if not len(drawn):
        return
    diameters, orientations = ellipsoids(covariances[drawn])
    tint = colour(standard, 1.0, 0.55, 0.1, 0.15)
    for number, size, turned in zip(drawn, diameters, orientations):
        pose = standard.make("geometry_msgs/msg/Pose", position=predictions[number].pose.position,
                             orientation=standard.make("geometry_msgs/msg/Quaternion", **dict(
                                 zip("xyzw", map(float, turned)))))
        scale = standard.make(VECTOR, **dict(zip("xyz", map(float, np.maximum(size, 1e-4)))))
        yield standard.make(MARKER, header=header, ns="forecast", id=int(number), type=SPHERE,
                            action=ADD, pose=pose, scale=scale, color=tint)


def plan(_: str, message: Any, standard: Standard) -> Iterator[Companion]:
    stamp, times = message.header.stamp, message.time_from_start
    known = len(times) == len(message.poses)
    yield Companion("path", PATH, path(message.header, [
        (later(stamp, times[node], standard) if known else stamp, pose)
        for node, pose in enumerate(message.poses)], standard))
    yield from numbers({"status": message.status, "radius": message.radius,
                        "slack": message.slack}, standard)


def progress(_: str, message: Any, standard: Standard) -> Iterator[Companion]:
    name = constant_name(message, message.state, "state")
    told = f"{name}: {message.reason}" if message.reason else name
    yield Companion("text", TEXT, standard.make(TEXT, data=told))
    above = standard.make("geometry_msgs/msg/Pose", position=standard.make(POINT, z=STATE_HEIGHT))
    yield Companion("marker", MARKER, standard.make(
        MARKER, header=message.header, ns="state", type=TEXT_FACING, action=ADD, pose=above,
        scale=standard.make(VECTOR, z=0.08), color=colour(standard, 0.1, 0.5, 0.9, 1.0), text=name))
    posterior = dict(zip(("posterior/forward", "posterior/pause", "posterior/reverse"),
                         message.posterior))
    yield from numbers({
        "state": message.state, **posterior, "cursor": message.cursor,
        "time_to_go": seconds(message.time_to_go),
        "following_error": getattr(message, "following_error", -1.0)}, standard)


def control(_: str, message: Any, standard: Standard) -> Iterator[Companion]:
    name = constant_name(message, message.code, "code")
    told = f"{name}: {message.reason}" if message.reason else name
    yield Companion("text", TEXT, standard.make(TEXT, data=told))
    yield from numbers({"code": message.code, "position_error": message.position_error,
                        "orientation_error": message.orientation_error,
                        "deviation": message.deviation}, standard)


def outlines(_: str, message: Any, standard: Standard) -> Iterator[Companion]:
    """The tags' edges in the image, as pairs of points."""
    points = []
    for each in message.detections:
        corners = np.reshape(each.corners_px, (4, 2))
        for first, second in zip(corners, np.roll(corners, -1, axis=0)):
            points += [standard.make(POINT, x=float(x), y=float(y)) for x, y in (first, second)]
    yield Companion("outlines", OUTLINE, standard.make(
        OUTLINE, header=message.header, type=LINE_LIST, action=ADD, scale=2.0,
        outline_color=colour(standard, 0.1, 0.9, 0.2, 1.0), points=points))
    yield from numbers({"count": len(message.detections)}, standard)


def true_frame(topic: str, message: Any, standard: Standard) -> Iterator[Companion]:
    """The pose of a ground_truth topic as a transform; the framework's own tf does not reach the world."""
    pose = getattr(message.pose, "pose", message.pose)
    child = getattr(message, "child_frame_id", "") or "true_" + topic.rsplit("/", 1)[-1]
    move = standard.make(
        "geometry_msgs/msg/Transform", rotation=pose.orientation,
        translation=standard.make(VECTOR, x=pose.position.x, y=pose.position.y, z=pose.position.z))
    yield Companion("tf", TRANSFORMS, standard.make(TRANSFORMS, transforms=[standard.make(
        TRANSFORM, header=message.header, child_frame_id=child, transform=move)]))


MAKERS: dict[str, Maker] = {
    "prf_msgs/msg/TargetForecast": forecast,
    "prf_msgs/msg/SkillTrajectory": plan,
    "prf_msgs/msg/ExecutionProgress": progress,
    "prf_msgs/msg/ControlStatus": control,
    "prf_msgs/msg/TagDetectionArray": outlines,
}


def maker(topic: str, kind: str) -> Maker | None:
    """What makes a topic's companions; None when it has none."""
    if kind in ("nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped"):
        return true_frame if "ground_truth" in topic.split("/") else None
    return MAKERS.get(kind)
