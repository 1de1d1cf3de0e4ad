# SPDX-License-Identifier: BSD-3-Clause
"""The command teach_robot: leads a real arm by the hand and makes a demonstration of it.

The driver's own service makes the arm back-drivable and stiff again, whatever happens in between. The
recording is trimmed to the motion, checked for reach and for the joints' speed, drawn, and written.
"""
import contextlib
import os
import select
import sys
import tempfile
import time
from collections.abc import Iterator

import numpy as np
import rosgraph

from prf_experiments import robots
from prf_experiments.judge import invariants
from prf_experiments.record import recording
from prf_experiments.run import arguments as args
from prf_experiments.run import names, processes, session
from prf_experiments.teach import demonstration, teaching
from prf_msgs import bags

# Services of the drivers that let an arm be led, and end that; "": by the arm's own panel or switch.
LED = {"kinova": ("/j2s7s300_driver/in/start_force_control", "/j2s7s300_driver/in/stop_force_control")}
RECORDED = ["joint_states", "tag_detections", "tf", "tf_static"]
SMOOTHED = 0.1  # s, over which the joints' speed is taken: encoders are noisy
USED = 0.95  # share of the velocity limits, velocity_scale of arm_controller


def joint_share(path: str) -> tuple[np.ndarray, np.ndarray]:
    """(stamps s, largest share of a joint's velocity limit) while the arm was led."""
    stamps, rows = [], []
    with bags.opened(path) as bag:
        bags.require_messages(bag, ["joint_states"])
        bags.require_types(bag, ["joint_states"])
        for _, message, _ in bag.read_messages(topics=["/joint_states"]):
            if set(recording.ARM_JOINTS) <= set(message.name):
                stamps.append(message.header.stamp.to_nsec())
                rows.append([message.position[message.name.index(name)] for name in recording.ARM_JOINTS])
    if len(stamps) < 3:
        raise bags.BagError(f"{path}: no joint_states with the joints of the arm")
    at, positions = 1e-9 * (np.array(stamps) - stamps[0]), np.unwrap(np.array(rows), axis=0)
    width = max(1, round(SMOOTHED / max(1e-3, float(np.median(np.diff(at))))))
    width = min(width, len(at) - 1)
    speed = np.abs(positions[width:] - positions[:-width]) / np.maximum(at[width:] - at[:-width], 1e-9)[:, None]
    return at[width:], np.max(speed / invariants.limits(robots.load()).velocity, axis=1)


def make(path: str, command: str, tag_id: int, cut: tuple[float, float], stretch: float, picture: str
         ) -> demonstration.Demonstration:
    """The demonstration in a bag, `cut` s at both ends less; draws it. Raises DemonstrationError."""
    made = teaching.convert(path, command, tag_id, cut, stretch)
    _, share = joint_share(path)
    fastest = float(np.max(share)) / stretch
    if picture:
        from prf_experiments.teach import preview  # takes its time
        preview.draw(picture, made, share / stretch)
    if fastest > USED:
        raise demonstration.DemonstrationError(
            f"too fast for the arm: a joint was led at {100 * fastest:.0f} % of its velocity limit, must be at most "
            f"{100 * USED:.0f} %; --stretch {np.ceil(10.0 * fastest / USED) / 10.0 * stretch:g} makes it slower")
    return made


def _call(service):
    import rosservice
    try:
        kind = rosservice.get_service_class_by_name(service)
        import rospy
        rospy.wait_for_service(service, timeout=5.0)
        rospy.ServiceProxy(service, kind)()
    except Exception as error:  # rosservice, rospy and the messages' package raise what they like
        raise session.SessionError(f"{service} failed: {bags.one_line(error)}") from None


@contextlib.contextmanager
def led(driver: str) -> Iterator[None]:
    """The arm can be led by the hand; it is made stiff again whatever happens."""
    begin, end = LED.get(driver, ("", ""))
    if begin:
        _call(begin)
    else:
        print("now make the arm back-drivable by its own panel or switch")
    try:
        yield
    finally:
        if end:
            _call(end)
        else:
            print("now make the arm stiff again")


def _wait(seconds, recorder):
    """Until that time is over, or Enter is pressed where there is a keyboard."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        recorder.check()
        if sys.stdin.isatty() and select.select([sys.stdin], [], [], 0.2)[0]:
            sys.stdin.readline()
            return
        if not sys.stdin.isatty():
            time.sleep(0.2)


def record(path: str, driver: str, seconds: float) -> None:
    """Records the arm while it is led. Raises SessionError and ProcessError."""
    if not rosgraph.is_master_online():
        raise session.SessionError("no ROS master: start teach_robot.launch first")
    import rospy
    rospy.init_node("teach_robot", anonymous=True, argv=["teach_robot"], disable_signals=True)
    with tempfile.TemporaryDirectory() as logs:
        recorder = processes.Recorder(path, RECORDED, os.path.join(logs, "recorder.log"), "teach_recorder")
        try:
            with led(driver):
                print(f"lead the hand to the target, then hold still with the tag in view; ends with Enter or after "
                      f"{seconds:g} s", flush=True)
                _wait(seconds, recorder)
            recorder.close()
        finally:
            recorder.stop()


def main(words: list[str]) -> int:
    parser = args.Parser(prog="teach_robot", description="Records a real arm that is led by the hand, beside "
                         "teach_robot.launch, or takes a bag of it, and makes a demonstration.")
    parser.add_argument("out", help="demonstration file to write")
    parser.add_argument("--driver", default="", choices=["", *names.driver_names()], help="of the arm")
    parser.add_argument("--bag", help="a recording of joint_states, tag_detections and tf; else one is made")
    parser.add_argument("--keep", metavar="BAG", help="keeps the recording there")
    parser.add_argument("--seconds", type=float, default=120.0, help="longest recording")
    parser.add_argument("--tag", type=int, default=0, help="id of the tag")
    parser.add_argument("--cut", type=float, nargs=2, default=(0.0, 0.0), metavar=("BEGIN", "END"),
                        help="s that are left out at both ends of the motion")
    parser.add_argument("--stretch", type=float, default=1.0, help="makes it so many times slower")
    parser.add_argument("--picture", metavar="PNG", help="preview; default: beside the demonstration")
    options = parser.parse_args(words)
    if not (0.0 <= min(options.cut) and max(options.cut) < 600.0):
        parser.error("--cut must be from 0 to 600 s")
    if not 0.1 <= options.stretch <= 20.0:
        parser.error("--stretch must be from 0.1 to 20")
    if not 1.0 <= options.seconds <= 600.0:
        parser.error("--seconds must be from 1 to 600")

    def action():
        with contextlib.ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            bag = options.bag or os.path.abspath(options.keep or os.path.join(folder, "teach.bag"))
            if not options.bag:
                record(bag, options.driver, options.seconds)
            picture = options.picture or os.path.splitext(options.out)[0] + ".png"
            result = make(bag, "rosrun prf_experiments teach_robot", options.tag, tuple(options.cut),
                          options.stretch, picture)
        demonstration.write(options.out, result)
        print(f"{len(result.times)} poses over {result.times[-1]:.1f} s: {options.out}, {picture}")
        return 0
    return session.guarded("teach_robot", action)
