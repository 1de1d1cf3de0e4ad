# SPDX-License-Identifier: BSD-3-Clause
"""Any robot's bag made one that the framework can be played: names, rates, encodings, clock.

Images, compressed or not, keep the time at which they were recorded, as they came then; each gets the
camera_info nearest to it. Joint states become ticks of 10 ms, interpolated; a gap stays a gap. Messages
without a stamp get the time of their recording.
"""
import re
from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import genpy
import numpy as np
import rosbag
import yaml
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image, JointState

from prf_experiments.record import recording
from prf_experiments.run import arguments as args
from prf_msgs import bags

IMAGE, INFO, JOINTS = "camera/image_raw", "camera/camera_info", "joint_states"
TYPES = {IMAGE: ("sensor_msgs/Image", "sensor_msgs/CompressedImage"), INFO: ("sensor_msgs/CameraInfo",),
         JOINTS: ("sensor_msgs/JointState",)}
OPTICAL = "camera_optical_frame"
LONGEST_GAP = 0.5  # s, between two joint_states that are interpolated
ENCODINGS = re.compile(r"(mono|bgr|rgb|bgra|rgba|bayer_[a-z]{4})(8|16)|yuv422(_yuy2)?|8UC1")  # of tag_detector


@dataclass(frozen=True)
class Source:
    """Where a robot's bag has what the framework needs."""
    names: dict[str, str]  # ours: theirs
    camera_info: CameraInfo | None = None  # where the bag has none


def parse_map(words: list[str]) -> dict[str, str]:
    """{ours: theirs} of OURS:=THEIRS; what is not named has our name. Raises ArgumentError."""
    names = {name: "/" + name for name in TYPES}
    for word in words:
        ours, separator, theirs = word.partition(":=")
        ours = ours.lstrip("/")
        if not separator or not theirs:
            raise args.ArgumentError(f"'{word}' is not of the form OURS:=THEIRS, as camera/image_raw:=/cam/image_raw")
        if ours not in TYPES:
            raise args.ArgumentError(f"'{ours}' is not mapped, must be one of {', '.join(TYPES)}"
                                     + args.meant(ours, *TYPES))
        names[ours] = "/" + theirs.lstrip("/")
    return names


def read_camera_info(path: str) -> CameraInfo:
    """Of a file as camera_calibration writes it. Raises BagError."""
    try:
        with open(path, encoding="utf-8") as stream:
            content = yaml.safe_load(stream)
        info = CameraInfo(width=int(content["image_width"]), height=int(content["image_height"]),
                          distortion_model=str(content["distortion_model"]),
                          D=[float(one) for one in content["distortion_coefficients"]["data"]],
                          K=[float(one) for one in content["camera_matrix"]["data"]])
    except (yaml.YAMLError, KeyError, TypeError, ValueError) as error:
        raise bags.BagError(f"{path}: no file of camera_calibration: {bags.one_line(error)}") from None
    if len(info.K) != 9:
        raise bags.BagError(f"{path}: camera_matrix has {len(info.K)} numbers, must have 9")
    return info


def check(bag: rosbag.Bag, source: Source) -> None:
    """Raises BagError, in one line, for a topic that is not there or holds something else."""
    found = bag.get_type_and_topic_info().topics
    for ours, theirs in source.names.items():
        info = found.get(theirs)
        if info is None or not info.message_count:
            if ours == INFO and source.camera_info is not None:
                continue
            alike = [name for name, one in found.items() if one.msg_type in TYPES[ours]]
            raise bags.BagError(f"{bag.filename}: no message of {theirs} for {ours}; "
                                + (f"--map {ours}:={alike[0]} takes one that there is" if alike
                                   else f"it has no {' or '.join(TYPES[ours])} at all"))
        if info.msg_type not in TYPES[ours]:
            raise bags.BagError(f"{bag.filename}: {theirs} holds {info.msg_type}, must hold "
                                f"{' or '.join(TYPES[ours])} for {ours}")


def _stamp(message, recorded):
    return message.header.stamp if message.header.stamp else recorded


def decoded(message) -> Image:
    """An image as it is, or decompressed. Raises ValueError."""
    if message._type.endswith("/Image"):
        if not ENCODINGS.fullmatch(message.encoding):
            raise ValueError(f"encoding '{message.encoding}', must be mono, bgr, rgb, bayer of 8 or 16 bits or yuv422")
        return message
    if "compressedDepth" in message.format:
        raise ValueError(f"format '{message.format}' is of depth, must be an image")
    pixels = cv2.imdecode(np.frombuffer(message.data, np.uint8), cv2.IMREAD_UNCHANGED)
    if pixels is None or pixels.dtype != np.uint8:
        raise ValueError(f"format '{message.format}' cannot be decompressed to 8 bits")
    channels = 1 if pixels.ndim == 2 else pixels.shape[2]
    return Image(header=message.header, height=pixels.shape[0], width=pixels.shape[1],
                 encoding={1: "mono8", 3: "bgr8", 4: "bgra8"}[channels], step=pixels.shape[1] * channels,
                 data=pixels.tobytes())


def ticks(stamps: np.ndarray, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(stamps ns, positions, velocities) every 10 ms of joints (n,) ns and (n, joints) rad."""
    order = np.argsort(stamps, kind="stable")
    stamps, first = np.unique(stamps[order], return_index=True)
    positions = np.unwrap(positions[order][first], axis=0)
    at = np.arange(stamps[0], stamps[-1] + 1, recording.TICK)
    after = np.clip(np.searchsorted(stamps, at), 1, len(stamps) - 1)
    at = at[stamps[after] - stamps[after - 1] <= 1e9 * LONGEST_GAP]
    # In s from the first one: doubles have not the digits of a stamp.
    seconds, wanted = 1e-9 * (stamps - stamps[0]), 1e-9 * (at - stamps[0])
    found = np.column_stack([np.interp(wanted, seconds, column) for column in positions.T])
    return at, found, np.gradient(found, 1e-9 * recording.TICK, axis=0)


def _joints(bag, topic):
    stamps, rows = [], []
    for _, message, recorded in bag.read_messages(topics=[topic]):
        if not set(recording.ARM_JOINTS) <= set(message.name) or len(message.position) != len(message.name):
            continue
        values = [message.position[message.name.index(name)] for name in recording.ARM_JOINTS]
        if np.all(np.isfinite(values)):
            stamps.append(_stamp(message, recorded).to_nsec())
            rows.append(values)
    if len(set(stamps)) < 2:
        raise bags.BagError(f"{bag.filename}: {topic} has no two messages with {recording.ARM_JOINTS[0]} ... "
                            f"{recording.ARM_JOINTS[-1]}")
    return np.array(stamps, np.int64), np.array(rows, float)


def _images(bag, source) -> Iterator[tuple[Image, CameraInfo, genpy.Time]]:
    infos = [(_stamp(message, recorded).to_nsec(), message)
             for _, message, recorded in bag.read_messages(topics=[source.names[INFO]])]
    known = np.array([stamp for stamp, _ in infos], np.int64)
    for _, message, recorded in bag.read_messages(topics=[source.names[IMAGE]]):
        stamp = _stamp(message, recorded)
        try:
            image = decoded(message)
        except ValueError as error:
            raise bags.BagError(f"{bag.filename}: {source.names[IMAGE]}: {error}") from None
        nearest = infos[int(np.argmin(np.abs(known - stamp.to_nsec())))][1] if infos else source.camera_info
        plain = not nearest.roi.width and nearest.binning_x <= 1
        if plain and (nearest.width, nearest.height) != (image.width, image.height):
            raise bags.BagError(f"{bag.filename}: images have {image.width} x {image.height} pixels, camera_info is "
                                f"for {nearest.width} x {nearest.height}")
        info = CameraInfo(**{name: getattr(nearest, name) for name in nearest.__slots__})
        for one in (image, info):
            one.header = type(one.header)(stamp=stamp, frame_id=OPTICAL)
        yield image, info, recorded


def convert(path: str, out: str, source: Source) -> int:
    """Writes what `replay` plays. Returns the number of images. Raises BagError."""
    with bags.opened(path) as bag:
        check(bag, source)
        stamps, positions, velocities = ticks(*_joints(bag, source.names[JOINTS]))
        with rosbag.Bag(out, "w") as made:
            for stamp, position, velocity in zip(stamps, positions, velocities):
                time = genpy.Time(0, int(stamp))
                states = JointState(name=recording.ARM_JOINTS, position=list(position), velocity=list(velocity))
                states.header.stamp = time
                made.write("/clock", Clock(clock=time), time)
                made.write("/" + JOINTS, states, time)
            count = 0
            for image, info, recorded in _images(bag, source):
                made.write("/" + IMAGE, image, recorded)
                made.write("/" + INFO, info, recorded)
                count += 1
    return count
