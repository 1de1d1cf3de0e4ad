# SPDX-License-Identifier: BSD-3-Clause
"""From a guided hand to a demonstration file: records the teaching, converts its bag."""
import argparse
import contextlib
import os
import tempfile

import numpy as np
from scipy.spatial.transform import Slerp

from prf_experiments import geometry
from prf_experiments.record import frames, recording, topics
from prf_experiments.run import session
from prf_experiments.teach import demonstration

RATE = 20.0  # Hz, of the demonstration
MOVING_SPEED = 0.01  # m/s, slower the hand counts as still
MOVING_RATE = 0.01  # rad/s
TARGET_WINDOW = 1.0  # s at the end of the bag over which the target's pose is averaged
LINKS = {("/joint_states", "/platform_sim", "/robot_state_publisher"),
         ("/joint_states", "/platform_sim", "/teach_guide"),
         ("/camera/image_raw", "/platform_sim", "/tag_detector"),
         ("/" + topics.GUIDE, "/teach_guide", "/platform_sim")}
RECORDED = (topics.CLOCK + topics.SENSORS + topics.GROUND_TRUTH + ["tag_detections"]
            + topics.TRANSFORMS + topics.EXEMPT + [topics.GUIDE])


def moving_part(times: np.ndarray, poses: np.ndarray) -> slice:
    """Slice of the rows from the first to the last motion of the hand."""
    steps = np.diff(times)
    speed = np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1) / steps
    rate = (geometry.rotation(poses[1:]) * geometry.rotation(poses[:-1]).inv()).magnitude() / steps
    moving = np.flatnonzero((speed > MOVING_SPEED) | (rate > MOVING_RATE))
    if not moving.size:
        raise demonstration.DemonstrationError("the hand never moves")
    return slice(int(moving[0]), int(moving[-1]) + 2)


def resample(times: np.ndarray, poses: np.ndarray, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Poses at even times from the first to the last row, both of them included."""
    count = max(2, int(round((times[-1] - times[0]) * rate)) + 1)
    at = np.linspace(times[0], times[-1], count)
    positions = np.column_stack([np.interp(at, times, column) for column in poses[:, :3].T])
    result = geometry.make(positions, Slerp(times, geometry.rotation(poses))(at))
    flip = np.sum(result[1:, 3:] * result[:-1, 3:], axis=1) < 0.0
    result[1:, 3:] *= np.where(np.cumsum(flip) % 2 == 1, -1.0, 1.0)[:, None]
    return at - times[0], result


def _stamps(path, topic):
    with recording.open_bag(path) as bag:
        return np.array([message.header.stamp.to_nsec()
                         for _, message, _ in bag.read_messages(topics=["/" + topic])],
                        dtype=np.int64)


def _target(path, tag_id):
    """Mean pose of the tag in the planning frame over the bag's last detections."""
    buffer = frames.load(path)
    stamps = _stamps(path, "tag_detections")
    stamps = stamps[stamps >= stamps[-1] - int(1e9 * TARGET_WINDOW)] if stamps.size else stamps
    with recording.open_bag(path) as bag:
        rows = {message.header.stamp.to_nsec(): recording.tag_row(message, tag_id)
                for _, message, _ in bag.read_messages(topics=["/tag_detections"])}
    camera = frames.lookup(buffer, recording.PLANNING_FRAME, "camera_optical_frame", stamps)
    detected = np.array([rows[stamp] for stamp in stamps]).reshape(-1, 7)
    known = np.all(np.isfinite(camera) & np.isfinite(detected), axis=1)
    if not known.any():
        raise demonstration.DemonstrationError(
            f"{path}: the tag is not seen in the last {TARGET_WINDOW:g} s")
    seen = geometry.compose(camera[known], detected[known])
    return geometry.make(np.mean(seen[:, :3], axis=0), geometry.rotation(seen).mean())


def convert(path: str, command: str, tag_id: int = 0) -> demonstration.Demonstration:
    """Demonstration from a bag of joint_states, tf and tag_detections."""
    target = _target(path, tag_id)
    stamps = _stamps(path, "joint_states")
    hand = frames.lookup(frames.load(path, "/robot_state_publisher"), recording.PLANNING_FRAME,
                         demonstration.HAND_FRAME, stamps)
    known = np.all(np.isfinite(hand), axis=1)
    if known.sum() < 2:
        raise demonstration.DemonstrationError(f"{path}: tf has no pose of {demonstration.HAND_FRAME}")
    times, hand = 1e-9 * (stamps[known] - stamps[known][0]), hand[known]
    part = moving_part(times, hand)
    times, poses = resample(times[part], hand[part], RATE)
    return demonstration.make(times, poses, target, command)


def teach(folder: str, seed: int) -> str:
    """Records folder/teach.bag with the arm led to the target."""
    lesson = session.Session(
        folder=folder, bag="teach.bag", launch_file=session.packaged("launch", "teach.launch"),
        launch_arguments=[f"seed:={seed}", "paused:=true"], topics=RECORDED,
        links=LINKS | session.recorder_links(topics.SENSORS, "platform_sim"),
        driver="platform_sim")
    with lesson.running() as launch, contextlib.ExitStack() as stack:
        # Imported here: rospy reads the environment that running() has set.
        from prf_experiments.run.observer import Observer
        observer = Observer()
        stack.callback(observer.close)
        recorder = stack.enter_context(lesson.recording())
        lesson.wait_until_connected(launch, recorder)
        observer.call("/platform_sim/start")
        lesson.wait_for_driver(launch, recorder, observer.status)
        lesson.close(launch, recorder)
    lesson.progress.close()
    return os.path.join(folder, "teach.bag")


def teach_main(words: list[str]) -> int:
    parser = argparse.ArgumentParser(
        prog="run_teach", description="Leads the simulated arm to the target by the hand and "
        "writes the demonstration.")
    parser.add_argument("out", help="demonstration file to write")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", help="keeps teach.bag and the logs there")
    options = parser.parse_args(words)

    def action():
        with contextlib.ExitStack() as stack:
            folder = os.path.abspath(
                options.folder or stack.enter_context(tempfile.TemporaryDirectory()))
            os.makedirs(os.path.join(folder, "log"), exist_ok=True)
            command = f"rosrun prf_experiments run_teach --seed {options.seed} OUT"
            result = convert(teach(folder, options.seed), command)
        demonstration.write(options.out, result)
        print(f"{len(result.times)} poses over {result.times[-1]:.1f} s: {options.out}")
        return 0
    return session.guarded("run_teach", action)
