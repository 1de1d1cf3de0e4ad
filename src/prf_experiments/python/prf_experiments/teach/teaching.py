# SPDX-License-Identifier: BSD-3-Clause
"""From a guided hand to a demonstration file: records the teaching, converts its bag."""
import contextlib
import os
import tempfile
from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import Slerp

from prf_experiments import geometry, robots
from prf_experiments.record import frames, recording, topics
from prf_experiments.run import arguments as args
from prf_experiments.run import session
from prf_experiments.teach import demonstration
from prf_msgs import bags

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
        raise demonstration.DemonstrationError(
            f"the hand never moves: over {times[-1] - times[0]:.3g} s its speed is at most "
            f"{np.max(speed):.2g} m/s and {np.max(rate):.2g} rad/s, must be above {MOVING_SPEED:g} "
            f"m/s or {MOVING_RATE:g} rad/s")
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


def _messages(path, topic):
    with bags.opened(path) as bag:
        bags.require_messages(bag, [topic])
        bags.require_types(bag, {topic})
        return [message for _, message, _ in bag.read_messages(topics=["/" + topic])]


def _stamp(message):
    return message.header.stamp.to_nsec()


def _camera(path, buffer, detections, robot):
    """Poses (n, 7) of the camera in the planning frame, each in the frame that its message names."""
    stamps = [_stamp(message) for message in detections]
    poses = np.full((len(detections), 7), np.nan)
    for frame in dict.fromkeys(message.header.frame_id for message in detections):
        rows = [row for row, message in enumerate(detections) if message.header.frame_id == frame]
        found = frames.lookup(buffer, robot.base_link, frame, [stamps[row] for row in rows])
        if not np.any(np.isfinite(found)):
            raise demonstration.DemonstrationError(
                f"{path}: tag_detections are in frame '{frame}': "
                + frames.why_not(buffer, robot.base_link, frame, stamps[rows[-1]]))
        poses[rows] = found
    return poses


def _target(path, tag_id, robot):
    """Mean pose of the tag in the planning frame over the bag's last detections."""
    detections = _messages(path, "tag_detections")
    end = _stamp(detections[-1]) - int(1e9 * TARGET_WINDOW)
    detections = [message for message in detections if _stamp(message) >= end]
    camera = _camera(path, frames.load(path), detections, robot)
    detected = np.array([recording.tag_row(message, tag_id) for message in detections])
    known = np.all(np.isfinite(camera) & np.isfinite(detected), axis=1)
    if not known.any():
        ids = sorted({found.id for message in detections for found in message.detections})
        raise demonstration.DemonstrationError(
            f"{path}: tag {tag_id} is not seen in the last {TARGET_WINDOW:g} s, "
            + ("no other either" if not ids else "but " + ", ".join(map(str, ids))))
    seen = geometry.compose(camera[known], detected[known])
    return geometry.make(np.mean(seen[:, :3], axis=0), geometry.rotation(seen).mean())


def convert(path: str, command: str, tag_id: int = 0, cut: tuple[float, float] = (0.0, 0.0),
            stretch: float = 1.0, robot: robots.Robot | None = None) -> demonstration.Demonstration:
    """Demonstration from a bag of joint_states, tf and tag_detections: the motion less `cut` s at its ends,
    `stretch` times as slow. Of the default robot unless told."""
    robot = robot or robots.load()
    target = _target(path, tag_id, robot)
    stamps = np.array([_stamp(message) for message in _messages(path, "joint_states")], dtype=np.int64)
    buffer = frames.load(path, "/robot_state_publisher")
    hand = frames.lookup(buffer, robot.base_link, robot.tip_link, stamps)
    known = np.all(np.isfinite(hand), axis=1)
    if known.sum() < 2:
        raise demonstration.DemonstrationError(
            f"{path}: tf has no pose of {robot.tip_link} at the stamps of joint_states: "
            + frames.why_not(buffer, robot.base_link, robot.tip_link, stamps[-1]))
    times, hand = 1e-9 * (stamps[known] - stamps[known][0]), hand[known]
    part = moving_part(times, hand)
    times, hand = times[part], hand[part]
    kept = (times >= times[0] + cut[0]) & (times <= times[-1] - cut[1])
    if kept.sum() < 2:
        raise demonstration.DemonstrationError(
            f"{path}: nothing is left of {times[-1] - times[0]:.3g} s of motion, {cut[0] + cut[1]:g} s are cut off")
    times, poses = resample(stretch * times[kept], hand[kept], RATE)
    return demonstration.make(times, poses, target, command, robot)


def teach(folder: str, seed: int, detour: Sequence[float] = (0.0, 0.0),
          robot: str = robots.DEFAULT) -> str:
    """Records folder/teach.bag with the arm led to the target, by a detour to the right and forward, m."""
    lesson = session.Session(
        folder=folder, bag="teach.bag", launch_file=session.packaged("launch", "teach.launch"),
        launch_arguments=[f"robot:={robot}", f"seed:={seed}", "paused:=true", f"detour_right:={detour[0]}",
                          f"detour_forward:={detour[1]}"], topics=RECORDED,
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
    parser = args.Parser(
        prog="run_teach", description="Leads the simulated arm to the target by the hand and "
        "writes the demonstration.")
    parser.add_argument("out", help="demonstration file to write")
    parser.add_argument("--robot", default=robots.DEFAULT, metavar="NAME|FOLDER",
                        help="one of " + ", ".join(robots.names()) + ", or the path of a folder like those")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--detour", type=float, nargs=2, default=(0.0, 0.0), metavar=("RIGHT", "FORWARD"),
                        help="bends the way out to the right and toward the tag, m")
    parser.add_argument("--folder", help="keeps teach.bag and the logs there")
    options = parser.parse_args(words)

    def action():
        try:
            robot = robots.load(options.robot)
        except robots.RobotError as error:
            raise args.ArgumentError(str(error)) from None
        with contextlib.ExitStack() as stack:
            folder = os.path.abspath(
                options.folder or stack.enter_context(tempfile.TemporaryDirectory()))
            os.makedirs(os.path.join(folder, "log"), exist_ok=True)
            detour = "".join(f" {length:g}" for length in options.detour) if any(options.detour) else ""
            command = ("rosrun prf_experiments run_teach"
                       + (f" --robot {robot.name}" if robot.name != robots.DEFAULT else "")
                       + f" --seed {options.seed}"
                       + (f" --detour{detour}" if detour else "") + " OUT")
            result = convert(teach(folder, options.seed, options.detour, robot.name), command, robot=robot)
        demonstration.write(options.out, result)
        print(f"{len(result.times)} poses over {result.times[-1]:.1f} s: {options.out}")
        return 0
    return session.guarded("run_teach", action)
