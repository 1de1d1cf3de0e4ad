# SPDX-License-Identifier: BSD-3-Clause
"""Demonstrations recorded elsewhere: tables, bags and HDF5 files as demonstration files.

CSV    columns time, x, y, z, qx, qy, qz, qw in any order, others are ignored; `#` begins a comment.
       Commas, semicolons or tabs between the cells; decimal commas where it is not the comma.
bag    joint_states, tf and tag_detections; the target is where the tag is seen at the end.
HDF5   what the authors' public recorders write: the group `toolpose_info` or `transform_info` with
       <name>_positions (n, 3) m, <name>_orientations (n, 4) x y z w and <name>_time, else joint_time
       of the group `joint_state_info`, row by row: seconds and nanoseconds (n, 2), or seconds (n,).

Positions are in m. Times are in s; stamps since 1970 may be in ms, us or ns. What the arm cannot do
is refused, with the row: farther away than it reaches, or faster.

CSV and HDF5 files do not say where the target was: tell it with --target-pose, else it is taken to
be where the camera on the hand would have it at the end of the skill, at the stand-off on its axis.
"""
import argparse
import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import prf_core
from prf_experiments import geometry, robots
from prf_experiments.judge import judge
from prf_experiments.run import arguments as args
from prf_experiments.run import session
from prf_experiments.teach import demonstration, teaching
from prf_experiments.teach.demonstration import DemonstrationError
from prf_msgs import bags

COLUMNS = ["time", "x", "y", "z", "qx", "qy", "qz", "qw"]
CAMERA_IN_HAND = [0.0, 0.07, -0.12, 0.0, 0.0, 1.0, 0.0]
TAG_BEFORE_CAMERA = [0.0, 0.0, judge.STAND_OFF, 1.0, 0.0, 0.0, 0.0]  # upright, facing the camera
# The arm's recording of the ELTE repository (github.com/brenhertel/ELTE, scripts/elte_3d_box.py reads
# its joint_state_info and toolpose_info), and the recorders of github.com/brenhertel/pearl_ur5e
# (src/scripts/demo_record_*.py: transform_info). toolpose_time is named after the others' pattern;
# neither repository shows a recorder that writes it.
HAND_GROUPS = ("toolpose", "transform")
SECONDS_OF_2001 = 1e9  # since 1970
LONGEST = 600.0  # s; longer is in another unit
MIN_NORM = 0.5  # of a recorded quaternion; what is shorter says nothing


def target_at_stand_off(hand: np.ndarray) -> np.ndarray:
    """Pose of the tag that the camera sees as demonstrated from this pose of the hand."""
    return geometry.compose(geometry.compose(hand, CAMERA_IN_HAND), TAG_BEFORE_CAMERA)


def read_csv(path: str) -> tuple[np.ndarray, np.ndarray]:
    """(times (n,) s, poses (n, 7)) of a table with named columns."""
    try:
        table = prf_core.read_table(path, COLUMNS)
    except ValueError as error:
        raise DemonstrationError(str(error)) from None
    rows = np.array([table[name] for name in COLUMNS], dtype=float).T.reshape(-1, len(COLUMNS))
    return seconds(rows[:, 0]), rows[:, 1:]


def seconds(stamps: ArrayLike) -> np.ndarray:
    """Times in s of a recording's stamps: seconds, or rows of seconds and nanoseconds.

    Stamps since 1970, from 2001 on, tell by their size whether they are in s, ms, us or ns.
    """
    stamps = np.asarray(stamps)
    if stamps.ndim == 2 and stamps.shape[1] == 2:
        stamps = stamps.astype(float)
        return (stamps[:, 0] - stamps[0, 0]) + 1e-9 * stamps[:, 1]
    stamps = stamps.reshape(-1)
    if not stamps.size or not np.isfinite(first := float(stamps[0])):
        return stamps.astype(float)
    exponent = next((power for power in (9, 6, 3) if first >= SECONDS_OF_2001 * 10.0**power), 0)
    if exponent == 0:
        return stamps.astype(float)
    return (stamps - stamps[0]).astype(float) / 10.0**exponent  # as integers they lose nothing


def dataset(file: Any, path: str, names: list[str], columns: int | None) -> np.ndarray:
    """The first of the named data sets (n, columns) that the file has."""
    for name in names:
        if name in file:
            values = np.asarray(file[name])
            if values.dtype.kind not in "iuf":
                raise DemonstrationError(f"{path}: {name} holds {values.dtype}, must hold numbers")
            if columns and (values.ndim != 2 or values.shape[1] != columns):
                raise DemonstrationError(
                    f"{path}: {name} has shape {values.shape}, must be (n, {columns})")
            return values
    raise DemonstrationError(f"{path}: no data set {' or '.join(names)}, must have it; it holds "
                             f"{', '.join(sorted(file)) or 'nothing'}")


def read_hdf5(path: str) -> tuple[np.ndarray, np.ndarray]:
    """(times (n,) s, poses (n, 7)) of a recording in HDF5."""
    import h5py  # a tenth of a second, and only needed here
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise DemonstrationError(f"{path}: cannot be read as HDF5: {bags.one_line(error)}") from None
    with file:
        group = next((each for each in HAND_GROUPS if f"{each}_info" in file), HAND_GROUPS[0])
        hand = f"{group}_info/{group}"
        positions = dataset(file, path, [f"{hand}_positions"], 3)
        orientations = dataset(file, path, [f"{hand}_orientations"], 4)
        times = seconds(dataset(file, path, [f"{hand}_time", "joint_state_info/joint_time"], None))
    if not len(times) == len(positions) == len(orientations):
        raise DemonstrationError(f"{path}: {len(times)} times, {len(positions)} positions and "
                                 f"{len(orientations)} orientations, must be as many")
    return times, np.hstack([positions, orientations]).astype(float)


def clean(times: np.ndarray, poses: np.ndarray, path: str) -> tuple[np.ndarray, np.ndarray]:
    """Rows in rising time with unit quaternions; a row of the same time as the one before goes."""
    finite = np.isfinite(times) & np.all(np.isfinite(poses), axis=1)
    if not np.all(finite):
        raise DemonstrationError(f"{path}: row {int(np.argmin(finite)) + 1} has a number that is "
                                 "not finite")
    if np.any(np.diff(times) < 0.0):
        row = int(np.argmax(np.diff(times) < 0.0)) + 2
        raise DemonstrationError(f"{path}: time goes back at row {row}, must rise")
    kept = np.append(True, np.diff(times) > 0.0)[:len(times)]
    times, poses = times[kept], poses[kept].copy()
    norms = np.linalg.norm(poses[:, 3:], axis=1, keepdims=True)
    if np.any(norms < MIN_NORM):
        raise DemonstrationError(f"{path}: row {int(np.argmin(norms)) + 1} has no orientation: its "
                                 "quaternion must have a length above 0")
    poses[:, 3:] /= norms
    if len(times) < 2:
        raise DemonstrationError(f"{path}: {len(times)} rows are no motion, must be at least 2")
    span = times[-1] - times[0]
    if span > LONGEST:
        unit = next((unit for unit, scale in (("ms", 1e3), ("us", 1e6), ("ns", 1e9))
                     if span / scale <= LONGEST), "ns")
        raise DemonstrationError(f"{path}: time spans {span:.4g} s, must be at most {LONGEST:g} s; "
                                 f"is it in {unit}?")
    return times - times[0], poses


def require_reach(poses: np.ndarray, path: str) -> None:
    """By the row of the file; demonstration.make() checks the rest."""
    distances = np.linalg.norm(poses[:, :3], axis=1)
    reach = demonstration.reach()
    row = int(np.argmax(distances > reach))
    if distances[row] > reach:
        hint = "; is it in mm?" if distances[row] / 1000.0 <= reach else ""
        raise DemonstrationError(
            f"{path}: row {row + 1} is {distances[row]:.4g} m from the base of the arm, which reaches "
            f"{reach:g} m{hint}")


READERS = {".csv": read_csv, ".h5": read_hdf5, ".hdf5": read_hdf5}


def convert(path: str, target: np.ndarray | None, command: str) -> demonstration.Demonstration:
    """Demonstration of a file; `target` is the tag's pose (7,) in the arm's base, or None."""
    kind = os.path.splitext(path)[1].lower()
    if kind not in (".bag", *READERS):
        raise DemonstrationError(f"{path}: must end with .bag, " + ", ".join(READERS))
    if not os.path.exists(path):
        raise DemonstrationError(f"{path}: there is no such file")
    if kind == ".bag":
        return teaching.convert(path, command)
    times, poses = READERS[kind](path)
    times, poses = clean(times, poses, path)
    require_reach(poses, path)
    part = teaching.moving_part(times, poses)
    times, poses = teaching.resample(times[part], poses[part], teaching.RATE)
    if target is None:
        target = target_at_stand_off(poses[-1])
    return demonstration.make(times, poses, target, command, robots.load())


def pose(text: str) -> np.ndarray:
    try:
        numbers = np.array([float(word) for word in text.split()])
    except ValueError:
        numbers = np.empty(0)
    if numbers.shape != (7,) or not np.all(np.isfinite(numbers)):
        raise argparse.ArgumentTypeError(f"'{text}' must be seven numbers: x y z qx qy qz qw")
    norm = np.linalg.norm(numbers[3:])
    if norm < MIN_NORM:
        raise argparse.ArgumentTypeError("its quaternion is no orientation, must have a length above 0")
    return np.append(numbers[:3], numbers[3:] / norm)


def main(words: list[str]) -> int:
    parser = args.Parser(
        prog="import_demonstration", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", help="file that ends with .bag, " + ", ".join(READERS))
    parser.add_argument("out", help="demonstration file to write (CSV)")
    parser.add_argument("--target-pose", type=pose, metavar='"x y z qx qy qz qw"',
                        help="of the tag in " + robots.load().base_link)
    options = parser.parse_args(words)

    def action():
        if options.target_pose is not None and options.source.lower().endswith(".bag"):
            raise DemonstrationError("a bag's detections tell the target, --target-pose cannot")
        result = convert(options.source, options.target_pose,
                         "rosrun prf_experiments import_demonstration "
                         + os.path.basename(options.source))
        demonstration.write(options.out, result)
        print(f"{len(result.times)} poses over {result.times[-1]:.1f} s: {options.out}")
        return 0
    return session.guarded("import_demonstration", action)
