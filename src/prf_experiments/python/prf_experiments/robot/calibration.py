# SPDX-License-Identifier: BSD-3-Clause
"""Where the camera sits on the hand and how late camera and arm are, from one minute of motion.

The robot stands still and sees a fixed tag while the hand moves and turns. A detection stamped s is of
the instant s - offset, so that

    tag in camera (s) = inverse(hand(s - offset) camera_in_hand) tag_in_base .

OpenCV's hand-eye methods give a first answer with offset 0. camera_in_hand, tag_in_base and the offset
are then refined together by least squares over all detections, with a loss that outliers do not rule.
The delay of the arm is the shift at which the measured joints lie nearest to the commanded ones.
"""
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
import scipy.interpolate
import scipy.optimize
from scipy.spatial.transform import Rotation

from prf_experiments import geometry

LATERAL, DEPTH, TURN = 1e-4, 5e-4, 4e-3  # m, m, rad: weights, the noise of a tag of 100 mm at 0.8 m
MOST_POSES = 60  # for OpenCV
MOST_DETECTIONS = 500  # for the refinement: more take time and tell little
LONGEST_DELAY = 0.2  # s
WANTED = (1e-3, np.radians(0.2), 2e-3)  # m, rad, s: standard deviations that a good calibration keeps below
LARGEST_RESIDUAL = (3e-3, np.radians(1.0))  # m, rad, rms
LEAST_DETECTIONS = 100
METHODS = {"Tsai": cv2.CALIB_HAND_EYE_TSAI, "Park": cv2.CALIB_HAND_EYE_PARK,
           "Horaud": cv2.CALIB_HAND_EYE_HORAUD, "Daniilidis": cv2.CALIB_HAND_EYE_DANIILIDIS}

Hand = Callable[[np.ndarray], np.ndarray]  # times (n,) s -> poses (n, 7) in the arm's base


class CalibrationError(Exception):
    """The motion does not determine the calibration; the message says why in one line."""


@dataclass(frozen=True)
class Calibration:
    camera_in_hand: np.ndarray  # (7,) optical frame
    tag_in_base: np.ndarray  # (7,)
    offset: float  # s, by which stamps of images are later than their exposure
    deviations: tuple[float, float, float]  # m, rad, s: standard deviations of camera_in_hand and offset
    residuals: tuple[float, float]  # m, rad: rms of the detections
    method: str  # of OpenCV, that began nearest
    detections: int

    @property
    def complaint(self) -> str:
        """Why it is not to be used; empty: it is good."""
        if any(not one <= most for one, most in zip(self.deviations, WANTED)):
            return "the motion does not determine it: turn the hand about two axes, by 30 degrees and more"
        if any(not one <= most for one, most in zip(self.residuals, LARGEST_RESIDUAL)):
            return "the residuals are large: does the robot stand still, is tag_size right, is the lens calibrated?"
        return ""


def hand_of(chain, stamps: np.ndarray, positions: np.ndarray) -> Hand:
    """The hand at any time of measured joints: stamps (n,) s, positions (n, joints) rad."""
    spline = scipy.interpolate.CubicSpline(stamps, np.unwrap(positions, axis=0))
    return lambda times: chain.poses(spline(times))


def _matrices(poses):
    return list(geometry.rotation(poses).as_matrix()), [one[:, None] for one in poses[:, :3]]


def _errors(camera_in_hand, tag_in_base, hand, detections):
    """(n, 3) m and (n, 3) rad of the detections from where the tag must be in the camera."""
    camera = geometry.compose(hand, np.broadcast_to(camera_in_hand, hand.shape))
    expected = geometry.compose(geometry.inverse(camera), np.broadcast_to(tag_in_base, hand.shape))
    turned = (geometry.rotation(expected).inv() * geometry.rotation(detections)).as_rotvec()
    return detections[:, :3] - expected[:, :3], turned


def _first(hand, detections):
    """(cost, method, camera in hand, tag in base) of the method of OpenCV with the least cost."""
    some = np.unique(np.linspace(0, len(hand) - 1, MOST_POSES).astype(int))
    found = []
    for name, method in METHODS.items():
        turned, position = cv2.calibrateHandEye(*_matrices(hand[some]), *_matrices(detections[some]), method=method)
        if not (np.all(np.isfinite(turned)) and np.all(np.isfinite(position))):
            continue
        camera = geometry.make(position[:, 0], Rotation.from_matrix(turned))
        tags = geometry.compose(geometry.compose(hand, np.broadcast_to(camera, hand.shape)), detections)
        tag = geometry.make(np.median(tags[:, :3], axis=0), geometry.rotation(tags).mean())
        shift, turn = _errors(camera, tag, hand, detections)
        found.append((float(np.median(np.linalg.norm(shift, axis=1)) + 0.1 * np.median(np.linalg.norm(turn, axis=1))),
                      name, camera, tag))
    if not found:
        raise CalibrationError("no method of OpenCV finds a solution: turn the hand about two axes, by 30 degrees and "
                               "more")
    return min(found, key=lambda one: one[0])


def _moved(pose, step):
    return geometry.compose(pose, geometry.make(step[:3], Rotation.from_rotvec(step[3:6])))


def calibrate(hand: Hand, span: tuple[float, float], stamps: np.ndarray, detections: np.ndarray) -> Calibration:
    """From detections (n, 7) of one tag with stamps (n,) s; the hand is known within `span`, s."""
    inside = (stamps > span[0] + LONGEST_DELAY) & (stamps < span[1] - LONGEST_DELAY)
    usable = inside & np.all(np.isfinite(detections), axis=1)
    stamps, detections = stamps[usable], detections[usable]
    if len(stamps) < LEAST_DETECTIONS:
        raise CalibrationError(f"{len(stamps)} detections of the tag while the joints are known, must be at least "
                               f"{LEAST_DETECTIONS}: is it in view, and --tag its id?")
    some = np.unique(np.linspace(0, len(stamps) - 1, MOST_DETECTIONS).astype(int))
    stamps, detections = stamps[some], detections[some]
    _, method, camera, tag = _first(hand(stamps), detections)
    weights = np.array([LATERAL, LATERAL, DEPTH])

    def errors(values):
        return _errors(_moved(camera, values[:6]), _moved(tag, values[6:12]), hand(stamps - values[12]), detections)

    def residuals(values):
        shift, turn = errors(values)
        return np.concatenate([(shift / weights).ravel(), (turn / TURN).ravel()])
    bounds = np.full(13, np.inf)
    bounds[12] = LONGEST_DELAY
    found = scipy.optimize.least_squares(residuals, np.zeros(13), loss="soft_l1", x_scale="jac",
                                          bounds=(-bounds, bounds))
    free = max(1, 6 * len(stamps) - 13)
    covariance = np.linalg.pinv(found.jac.T @ found.jac) * max(1.0, 2.0 * found.cost / free)
    deviation = np.sqrt(np.diag(covariance))
    shift, turn = errors(found.x)
    return Calibration(_moved(camera, found.x[:6]), _moved(tag, found.x[6:12]), float(found.x[12]),
                       (float(np.linalg.norm(deviation[:3])), float(np.linalg.norm(deviation[3:6])),
                        float(deviation[12])),
                       (float(np.sqrt(np.mean(np.sum(shift**2, axis=1)))),
                        float(np.sqrt(np.mean(np.sum(turn**2, axis=1))))), method, len(stamps))


def arm_delay(command_stamps: np.ndarray, commands: np.ndarray, stamps: np.ndarray, measured: np.ndarray) -> float:
    """s from a command to the position that it asks for; (n,) s and (n, joints) rad of both."""
    spline = scipy.interpolate.CubicSpline(command_stamps, np.unwrap(commands, axis=0), extrapolate=False)
    inside = (stamps > command_stamps[0] + LONGEST_DELAY) & (stamps < command_stamps[-1])
    if np.count_nonzero(inside) < LEAST_DETECTIONS:
        raise CalibrationError(f"{np.count_nonzero(inside)} measured joints within the time of joint_command, must be "
                               f"at least {LEAST_DETECTIONS}: record both over the whole minute")
    times, joints = stamps[inside], np.unwrap(measured, axis=0)[inside]

    def off(delay):
        apart = joints - spline(times - delay)
        return float(np.sum((apart - np.mean(apart, axis=0)) ** 2))
    grid = np.linspace(0.0, LONGEST_DELAY - 1e-3, 41)
    costs = [off(one) for one in grid]
    if not min(costs) < 0.5 * max(costs):
        raise CalibrationError("the arm hardly moves while it is commanded, so its delay cannot be found: move it by "
                               "joint_command, not by hand")
    best = int(np.argmin(costs))
    return float(scipy.optimize.minimize_scalar(
        off, bounds=(grid[max(0, best - 1)], grid[min(len(grid) - 1, best + 1)]), method="bounded").x)
