# SPDX-License-Identifier: BSD-3-Clause
"""The command `calibrate`: a bag of one minute of motion to the file that real_robot.launch reads."""
import math
import sys
import warnings
import xml.etree.ElementTree as ElementTree

import numpy as np
import yaml

from prf_experiments import files, geometry, robots
from prf_experiments.record import recording
from prf_experiments.robot import arm, calibration, description, efforts, made_motion
from prf_experiments.run import arguments as args
from prf_experiments.run import session
from prf_msgs import bags

ROBOT = robots.load()  # the one that is calibrated
HAND, OPTICAL, MOUNT = ROBOT.tip_link, ROBOT.camera_frame, "camera_mount"
SEEN_WITHIN = (1e-3, np.radians(0.2), 2e-3)  # m, rad, s: what --seeds must keep
TOPICS = ("joint_states", "joint_command", "tag_detections")


def _fixed(urdf: str, base: str, tip: str) -> np.ndarray:
    return arm.Chain(urdf, base, tip).poses(np.zeros((1, 0)))[0]


def with_camera(urdf: str, camera_in_hand: np.ndarray) -> str:
    """The robot description with the camera's optical frame at `camera_in_hand` (7,)."""
    robot = ElementTree.fromstring(urdf)
    joint = next(one for one in robot.findall("joint") if one.attrib["name"] == MOUNT)
    parent, link = joint.find("parent"), joint.find("child")
    place = joint.find("origin")
    if parent is None or link is None or place is None:
        raise calibration.CalibrationError(f"the joint {MOUNT} of the robot description has no parent, child or origin")
    hand_in_parent = geometry.inverse(_fixed(urdf, HAND, parent.attrib["link"])) \
        if parent.attrib["link"] != HAND else geometry.IDENTITY
    optical_in_link = _fixed(urdf, link.attrib["link"], OPTICAL)
    mount = geometry.compose(geometry.compose(hand_in_parent, camera_in_hand), geometry.inverse(optical_in_link))
    place.set("xyz", " ".join(f"{one:.9g}" for one in mount[:3]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a pitch of 90 degrees: then yaw is 0
        angles = geometry.rotation(mount).as_euler("xyz")
    place.set("rpy", " ".join(f"{one:.12g}" for one in angles))
    return ElementTree.tostring(robot, encoding="unicode")


def _of_arm(names, positions) -> list[float] | None:
    """Positions of the arm's joints; None: not all are there and finite."""
    found = dict(zip(names, positions))
    values = [found.get(name, math.nan) for name in ROBOT.joints]
    return values if all(map(math.isfinite, values)) else None


def read(path: str, tag_id: int):
    """Joints, commands and detections of a bag: stamps in s from its first joints on."""
    rows: dict[str, list] = {topic: [] for topic in TOPICS}
    with bags.opened(path) as bag:
        bags.require_messages(bag, ["joint_states", "tag_detections"])
        bags.require_types(bag, TOPICS)
        for topic, message, _ in bag.read_messages(topics=["/" + topic for topic in TOPICS]):
            stamp = message.header.stamp.to_nsec()
            if topic == "/joint_states" and (joints := _of_arm(message.name, message.position)):
                rows["joint_states"].append((stamp, joints))
            elif topic == "/joint_command" and message.points \
                    and (joints := _of_arm(message.joint_names, message.points[0].positions)):
                rows["joint_command"].append((stamp, joints))
            elif topic == "/tag_detections":
                rows["tag_detections"] += [
                    (stamp, [*(getattr(one.pose.pose.position, axis) for axis in "xyz"),
                             *(getattr(one.pose.pose.orientation, axis) for axis in "xyzw")])
                    for one in message.detections if one.id == tag_id]
    if len(rows["joint_states"]) < 2:
        raise bags.BagError(f"{path}: {len(rows['joint_states'])} joint_states with the joints "
                            f"{ROBOT.joints[0]} .. {ROBOT.joints[-1]}, must be at least 2")
    start = rows["joint_states"][0][0]

    def arrays(topic):
        found = sorted(dict(rows[topic]).items())
        return (np.array([1e-9 * (stamp - start) for stamp, _ in found]),
                np.array([values for _, values in found], float).reshape(len(found), 7))
    return tuple(arrays(topic) for topic in TOPICS)


def read_efforts(path: str) -> np.ndarray:
    """Efforts (n, 7), N m, of a bag's joint_states that tell those of the arm."""
    rows = []
    with bags.opened(path) as bag:
        bags.require_messages(bag, ["joint_states"])
        bags.require_types(bag, ["joint_states"])
        for _, message, _ in bag.read_messages(topics=["/joint_states"]):
            if set(recording.ARM_JOINTS) <= set(message.name) and len(message.effort) == len(message.name):
                rows.append([message.effort[message.name.index(name)] for name in recording.ARM_JOINTS])
    return np.array(rows, float).reshape(-1, len(recording.ARM_JOINTS))


def loaded_offset(path: str) -> float:
    """s, that tag_detector took off the stamps with this file of calibrate."""
    try:
        with open(path, encoding="utf-8") as stream:
            return float(yaml.safe_load(stream)["tag_detector"]["stamp_offset"])
    except (yaml.YAMLError, KeyError, TypeError, ValueError) as error:
        raise calibration.CalibrationError(f"{path} was not written by calibrate: {bags.one_line(error)}") from None


def _told(found: calibration.Calibration, delay: float | None) -> str:
    place = found.camera_in_hand
    lines = [f"camera in hand   {1e3 * place[0]:.2f} {1e3 * place[1]:.2f} {1e3 * place[2]:.2f} mm, quaternion "
             + " ".join(f"{one:.5f}" for one in place[3:])
             + f"   (+- {1e3 * found.deviations[0]:.2f} mm, {np.degrees(found.deviations[1]):.3f} deg)",
             f"image stamps     {1e3 * found.offset:.1f} ms after the exposure (+- {1e3 * found.deviations[2]:.2f})",
             "arm              " + ("no commands in the bag" if delay is None else f"{1e3 * delay:.1f} ms behind"),
             f"residuals        {1e3 * found.residuals[0]:.2f} mm, {np.degrees(found.residuals[1]):.3f} deg rms of "
             f"{found.detections} detections; began with {found.method}'s method",
             "verdict          " + (found.complaint or "good")]
    return "\n".join(lines)


def of_bag(path: str, out: str, tag_id: int, loaded: str | None, with_efforts: bool) -> int:
    before = loaded_offset(loaded) if loaded else 0.0
    (stamps, joints), (command_stamps, commands), (image_stamps, detections) = read(path, tag_id)
    chain = arm.Chain(description.text(), ROBOT.base_link, HAND)
    found = calibration.calibrate(calibration.hand_of(chain, stamps, joints), (stamps[0], stamps[-1]),
                                  image_stamps, detections)
    delay = (calibration.arm_delay(command_stamps, commands, stamps, joints) if len(command_stamps) > 1 else None)
    print(_told(found, delay))
    if found.complaint:
        return 1
    content: dict = {"calibration": {
        "camera_in_hand": [round(float(one), 9) for one in found.camera_in_hand],
        "residual_mm": round(1e3 * found.residuals[0], 4)},
        "tag_detector": {"stamp_offset": round(before + found.offset, 6)}}
    if delay is not None:
        content |= {"decision": {"lead": round(delay, 4)}, "driver_adapter": {"delay": round(delay, 4)}}
    if with_efforts:
        lower, upper = efforts.bounds(read_efforts(path))
        content["guards"] = {"effort_lower": [round(float(one), 2) for one in lower],
                             "effort_upper": [round(float(one), 2) for one in upper]}
        print("efforts          " + ", ".join(f"{low:.1f} to {high:.1f}" for low, high in zip(lower, upper)) + " N m")
    files.write(out, "# Written by calibrate, read by real_robot.launch calibration:=FILE. m, s; quaternion x y z w.\n"
                + yaml.safe_dump(content, sort_keys=False))
    print(out)
    return 0


def of_seeds(count: int) -> int:
    """Made motions with known truth: 20 mm, 3 deg and 30 ms off. Prints the errors."""
    urdf, worst = description.text(), np.zeros(4)
    chain, nominal = arm.Chain(urdf, ROBOT.base_link, HAND), _fixed(urdf, HAND, OPTICAL)
    print("seed  camera mm   deg      image ms  arm ms   verdict")
    for seed in range(count):
        motion = made_motion.make(chain, nominal, seed)
        found = calibration.calibrate(calibration.hand_of(chain, motion.stamps, motion.measured),
                                      (motion.stamps[0], motion.stamps[-1]), motion.image_stamps, motion.detections)
        off = geometry.compose(geometry.inverse(motion.camera_in_hand), found.camera_in_hand)
        delay = calibration.arm_delay(motion.stamps, motion.commands, motion.stamps, motion.measured)
        errors = np.array([np.linalg.norm(off[:3]), geometry.rotation(off).magnitude(),
                           abs(found.offset - motion.offset), abs(delay - motion.delay)])
        worst = np.maximum(worst, errors)
        print(f"{seed:4d}  {1e3 * errors[0]:9.3f}  {np.degrees(errors[1]):7.4f}  {1e3 * errors[2]:8.3f}  "
              f"{1e3 * errors[3]:6.3f}   {found.complaint or 'good'}", flush=True)
    within = bool(np.all(worst <= [*SEEN_WITHIN, SEEN_WITHIN[2]]))
    print(f"worst {1e3 * worst[0]:9.3f}  {np.degrees(worst[1]):7.4f}  {1e3 * worst[2]:8.3f}  {1e3 * worst[3]:6.3f}   "
          + ("within" if within else "NOT within") + " 1 mm, 0.2 deg, 2 ms")
    return 0 if within else 1


def describe(path: str) -> int:
    with open(path, encoding="utf-8") as stream:
        try:
            place = np.array(yaml.safe_load(stream)["calibration"]["camera_in_hand"], float)
        except (yaml.YAMLError, KeyError, TypeError, ValueError) as error:
            raise calibration.CalibrationError(f"{path}: no calibration.camera_in_hand of 7 numbers, must be a file "
                                               f"that calibrate wrote: {bags.one_line(error)}") from None
    if place.shape != (7,) or not np.all(np.isfinite(place)) or abs(np.linalg.norm(place[3:]) - 1.0) > 1e-3 \
            or np.linalg.norm(place[:3]) > 1.0:
        raise calibration.CalibrationError(f"{path}: camera_in_hand is {place.tolist()}, must be x y z within 1 m and "
                                           "a unit quaternion x y z w")
    print(with_camera(description.text(), place))
    return 0


def main(words: list[str]) -> int:
    parser = args.Parser(prog="calibrate", description="Finds where the camera sits on the hand and how late camera "
                         "and arm are, from a bag of one minute in which the hand moves and turns before a fixed tag.")
    parser.add_argument("bag", nargs="?", help="with joint_states, tag_detections and, for the arm, joint_command")
    parser.add_argument("--out", default="calibration.yaml", help="file for real_robot.launch calibration:=")
    parser.add_argument("--tag", type=int, default=0, help="id of the tag")
    parser.add_argument("--loaded", metavar="FILE", help="the calibration that was loaded while the bag was recorded: "
                        "its shift of the stamps is added to what is found")
    parser.add_argument("--efforts", action="store_true", help="learns bounds of the efforts, too: the motion must be "
                        "free, and go where the skill will go")
    parser.add_argument("--seeds", type=int, help="measures itself on so many made motions instead")
    parser.add_argument("--description", metavar="FILE", help="prints the robot description with a file's camera")
    options = parser.parse_args(words)
    if sum(one is not None for one in (options.bag, options.seeds, options.description)) != 1:
        parser.error("give one of BAG, --seeds and --description")

    def run():
        try:
            if options.description is not None:
                return describe(options.description)
            if options.seeds is not None:
                return of_seeds(options.seeds)
            return of_bag(options.bag, options.out, options.tag, options.loaded, options.efforts)
        except (calibration.CalibrationError, efforts.EffortError) as error:
            print(f"calibrate: {error}", file=sys.stderr)
            return 1
    return session.guarded("calibrate", run)
