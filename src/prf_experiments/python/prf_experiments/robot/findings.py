# SPDX-License-Identifier: BSD-3-Clause
"""What the bring-up check makes of what it heard. Imports no ROS; times in s."""
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

LEAST_MESSAGES = 3
RATE_BOUND = 0.2  # share by which a rate may be off
JITTER_BOUND = 0.3  # standard deviation of the intervals between stamps, as a share of the period
CLOCK_BOUND = 0.005  # s, that stamps may be ahead of their arrival, in the median


@dataclass(frozen=True)
class Expected:
    topic: str
    kind: str  # type of the message
    rate: float  # Hz
    most_age: float  # s, of a stamp when its message arrives
    frame: str = ""  # empty: any
    joints: tuple[str, ...] = ()


@dataclass
class Heard:
    """What came on one topic."""
    kind: str = ""  # as the master knows it; empty: nobody publishes
    publishers: list[str] = field(default_factory=list)
    arrivals: list[float] = field(default_factory=list)
    stamps: list[float] = field(default_factory=list)
    frames: set[str] = field(default_factory=set)
    joints: set[str] = field(default_factory=set)


@dataclass(frozen=True)
class Finding:
    about: str
    green: bool
    text: str
    advice: str = ""

    def line(self) -> str:
        return (f"{'green' if self.green else 'RED  '}  {self.about}: {self.text}"
                + (f"\n         -> {self.advice}" if self.advice and not self.green else ""))


def median(values: Sequence[float]) -> float:
    ordered = sorted(values)
    return ordered[len(ordered) // 2]


def of_topic(expected: Expected, heard: Heard, seconds: float) -> list[Finding]:
    """Of one topic that was listened to for `seconds`."""
    def red(text, advice):
        return [Finding(expected.topic, False, text, advice)]
    if not heard.kind:
        return red("nobody publishes it", "start the driver; another name is an argument of the launch file")
    if heard.kind != expected.kind:
        return red(f"is {heard.kind}, must be {expected.kind}", "name the right topic")
    if len(heard.publishers) > 1:
        return red(f"{len(heard.publishers)} publishers: {', '.join(sorted(heard.publishers))}", "stop all but one")
    if len(heard.stamps) < LEAST_MESSAGES:
        return red(f"{len(heard.stamps)} messages in {seconds:g} s, expected {expected.rate * seconds:.0f}",
                   "does the driver run, and is the network up?")
    return _of_stamps(expected, heard) + _of_content(expected, heard)


def _of_stamps(expected: Expected, heard: Heard) -> list[Finding]:
    steps = [later - earlier for earlier, later in zip(heard.stamps, heard.stamps[1:])]
    ages = [arrival - stamp for arrival, stamp in zip(heard.arrivals, heard.stamps)]
    if not all(math.isfinite(step) and step > 0.0 for step in steps):
        return [Finding(expected.topic, False, "stamps do not rise",
                        "the sender must stamp with the time of measurement")]
    mean = sum(steps) / len(steps)
    rate, period = 1.0 / mean, 1.0 / expected.rate
    jitter = math.sqrt(sum((step - mean) ** 2 for step in steps) / len(steps))
    age = median(ages)
    found = [Finding(f"{expected.topic} rate", abs(rate - expected.rate) <= RATE_BOUND * expected.rate,
                     f"{rate:.1f} Hz, expected {expected.rate:.1f}",
                     "set the rate of the driver (kinova-ros: feedback_publish_rate:=0.01), or `period` in its file"),
             Finding(f"{expected.topic} jitter", jitter <= JITTER_BOUND * period,
                     f"{1e3 * jitter:.1f} ms of {1e3 * period:.1f} ms",
                     "a driver that stamps on arrival, or a loaded computer"),
             Finding(f"{expected.topic} age", -CLOCK_BOUND <= age <= expected.most_age,
                     f"{1e3 * age:.1f} ms, at most {1e3 * expected.most_age:.0f}; least {1e3 * min(ages):.1f}",
                     "below 0 the sender's clock is ahead: run chrony on both computers; above, the network or the "
                     "driver is late")]
    return found


def _of_content(expected: Expected, heard: Heard) -> list[Finding]:
    found = []
    if expected.frame:
        found.append(Finding(f"{expected.topic} frame", heard.frames == {expected.frame},
                             ", ".join(sorted(heard.frames)) or "none",
                             f"header.frame_id must be {expected.frame}: set it at the camera's driver"))
    if expected.joints:
        missing = [joint for joint in expected.joints if joint not in heard.joints]
        found.append(Finding(f"{expected.topic} joints", not missing,
                             f"{len(expected.joints)} of the arm" if not missing else "lacks " + ", ".join(missing),
                             "`joints` of the driver's file are the names in this topic"))
    return found


def of_camera(matrix: Sequence[float], distortion: Sequence[float], size: tuple[int, int],
              image_size: tuple[int, int]) -> Finding:
    """Of camera_info: K row by row, D, width and height, and those of the image."""
    about, advice = "camera calibration", "calibrate the camera (camera_calibration) and give its driver the file"
    if len(matrix) != 9 or not all(map(math.isfinite, [*matrix, *distortion])):
        return Finding(about, False, "K or D is not finite", advice)
    focal, centre = (matrix[0], matrix[4]), (matrix[2], matrix[5])
    if not all(0.2 * max(size) < one < 20.0 * max(size) for one in focal):
        return Finding(about, False, f"focal lengths {focal[0]:g} and {focal[1]:g} px: not calibrated", advice)
    if not all(0.0 < one < extent for one, extent in zip(centre, size)):
        return Finding(about, False, f"principal point {centre[0]:g}, {centre[1]:g} is outside the image", advice)
    if image_size != size:
        return Finding(about, False, f"of {size[0]}x{size[1]}, the images are {image_size[0]}x{image_size[1]}", advice)
    return Finding(about, True, f"f = {focal[0]:.0f} px, {size[0]}x{size[1]}, {len(distortion)} of distortion")
