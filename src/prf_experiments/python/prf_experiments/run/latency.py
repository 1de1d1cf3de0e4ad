# SPDX-License-Identifier: BSD-3-Clause
"""How late the chain is in real time: from joint_states to joint_command, and from an image to the
first command that uses it, hop by hop.

Runs a trial in real time (no lockstep) without load, and again beside busy loops. Times are those at
which this program receives the messages, on one clock. An image's time is that of its camera_info,
which is published just before it. A hop of a tick is between messages with the stamp of the tick; an
image is used by the first execution/progress that names its forecast, and by the command of that
tick.
"""
import argparse
import contextlib
import json
import os
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import rosgraph

from prf_experiments import files
from prf_experiments.run import arguments as args
from prf_experiments.run import connections, session

TICKS = ("joint_states", "execution/progress", "execution/setpoint", "joint_command")
IMAGES = ("camera/camera_info", "tag_detections", "target/forecast")
PLANS = "skill/trajectory"
SETTLING = 3.0  # s at the start that do not count: the first plan, caches
CONNECT_TIMEOUT = 60.0  # s
PRIORITY = -10  # of this program, where it may: it is to see, not to wait


@dataclass
class Events:
    """When messages came, s: {topic: {stamp ns: time}}, and which forecast a tick names."""

    times: dict[str, dict[int, float]] = field(
        default_factory=lambda: {topic: {} for topic in (*TICKS, *IMAGES, PLANS)})
    forecast_of: dict[int, int] = field(default_factory=dict)  # stamp of the tick: of the forecast

    def add(self, topic: str, stamp: int, now: float) -> None:
        self.times[topic].setdefault(stamp, now)


def _between(first: dict[int, float], second: dict[int, float]) -> list[float]:
    return [second[stamp] - begin for stamp, begin in first.items() if stamp in second]


def hops(events: Events) -> dict[str, list[float]]:
    """Seconds of every hop; the first of each chain is the whole chain."""
    times = events.times
    ticks = [times[topic] for topic in TICKS]
    images = [times[topic] for topic in IMAGES]
    used: dict[int, int] = {}  # forecast: first tick that names it
    for tick in sorted(events.forecast_of):
        used.setdefault(events.forecast_of[tick], tick)
    named = {image: times["execution/progress"][tick] for image, tick in used.items()
             if tick in times["execution/progress"]}
    commanded = {image: times["joint_command"][tick] for image, tick in used.items()
                 if tick in times["joint_command"]}
    plans = {tick: times["execution/progress"][tick] for tick in used.values()
             if tick in times["execution/progress"]}
    return {
        "joint_states to joint_command": _between(ticks[0], ticks[3]),
        "  joint_states to execution/progress": _between(ticks[0], ticks[1]),
        "  execution/progress to execution/setpoint": _between(ticks[1], ticks[2]),
        "  execution/setpoint to joint_command": _between(ticks[2], ticks[3]),
        "image to first joint_command that uses it": _between(images[0], commanded),
        "  image to tag_detections": _between(images[0], images[1]),
        "  tag_detections to target/forecast": _between(images[1], images[2]),
        "  target/forecast to first execution/progress": _between(images[2], named),
        "  execution/progress to skill/trajectory": _between(plans, times[PLANS]),
    }


def summary(seconds: list[float]) -> dict[str, float]:
    milliseconds = 1e3 * np.array(seconds) if seconds else np.array([np.nan])
    return {"median_ms": float(np.median(milliseconds)),
            "p99_ms": float(np.percentile(milliseconds, 99)),
            "max_ms": float(np.max(milliseconds)), "count": len(seconds)}


def table(measured: dict[str, dict[str, float]]) -> str:
    lines = [f"{'ms':<50}{'median':>8}{'p99':>8}{'max':>8}{'count':>8}"]
    lines += [f"{hop:<50}{row['median_ms']:>8.2f}{row['p99_ms']:>8.2f}{row['max_ms']:>8.2f}"
              f"{row['count']:>8.0f}" for hop, row in measured.items()]
    return "\n".join(lines)


def key(hop: str) -> str:
    """A hop's name in JSON."""
    return hop.strip().replace("/", "_").replace(" ", "_")


class Probe:
    """Listens to the chain; the messages are not unpacked but for their stamps."""

    def __init__(self):
        import rospy  # reads the environment that the session has set

        from prf_msgs.msg import ExecutionProgress
        rospy.init_node("latency_probe", anonymous=True, disable_signals=True)
        self.events = Events()
        self._open = True
        self._lock = threading.Lock()
        for topic in (*TICKS, *IMAGES, PLANS):
            kind = ExecutionProgress if topic == "execution/progress" else rospy.AnyMsg
            rospy.Subscriber(topic, kind, self._take, callback_args=topic, tcp_nodelay=True)

    def _take(self, message, topic):
        now = time.monotonic()
        if topic == "execution/progress":
            stamp = message.header.stamp.to_nsec()
            if message.forecast_stamp.to_nsec() > 0:
                self.events.forecast_of.setdefault(stamp, message.forecast_stamp.to_nsec())
        else:
            _, seconds, nanoseconds = struct.unpack_from("<III", message._buff)
            stamp = seconds * 1_000_000_000 + nanoseconds
        if self._open:
            self.events.add(topic, stamp, now)

    def forget(self) -> None:
        self.events = Events()

    def close(self) -> Events:
        self._open = False
        return self.events


@contextlib.contextmanager
def busy_loops(count: int) -> Iterator[None]:
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def _wait_until_connected(links):
    master = rosgraph.Master(connections.CALLER)
    end = time.monotonic() + CONNECT_TIMEOUT
    while absent := connections.missing(master, links):
        if time.monotonic() > end:
            topic, publisher, subscriber = sorted(absent)[0]
            raise session.SessionError(f"not connected after {CONNECT_TIMEOUT:g} s: {topic} from "
                                       f"{publisher} to {subscriber}")
        time.sleep(0.2)


def measure(seconds: float, motion: str, gait: str, loops: int) -> dict[str, list[float]]:
    """Runs one trial in real time. Once in a process: rospy knows one master only."""
    with contextlib.suppress(PermissionError):
        os.setpriority(os.PRIO_PROCESS, 0, PRIORITY)
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, "log"))
        run = session.Session(
            folder=folder, bag="", launch_file=session.packaged("launch", "trial.launch"),
            launch_arguments=[f"motion:={motion}", f"gait:={gait}", "lockstep:=false", "paused:=true",
                              f"time_limit:={seconds + 60:.1f}", "end_delay:=60.0"],
            topics=[], links=connections.trial_links("platform_sim"), driver="platform_sim")
        with run.running() as launch:
            _wait_until_connected(run.links)
            probe = Probe()
            _wait_until_connected(run.links)
            _start()
            time.sleep(SETTLING)
            with busy_loops(loops):
                time.sleep(0.5)
                probe.forget()
                end = time.monotonic() + seconds
                while time.monotonic() < end:
                    launch.check()
                    run.progress.show(f"measuring, {end - time.monotonic():.0f} s to go")
                    time.sleep(0.5)
                events = probe.close()
        run.progress.close()
    return hops(events)


def _start():
    import rospy
    from std_srvs.srv import Trigger
    rospy.wait_for_service("platform_sim/start", timeout=CONNECT_TIMEOUT)
    rospy.ServiceProxy("platform_sim/start", Trigger)()


def _measure_apart(options, loops):
    """measure() in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "hops.json")
        done = subprocess.run(
            [sys.executable, "-m", "prf_experiments.run.latency", f"--seconds={options.seconds}",
             f"--motion={options.motion}", f"--gait={options.gait}", f"--loops={loops}",
             f"--hops={path}"], check=False)
        if done.returncode != 0:
            raise session.SessionError("the measurement failed, the lines above say why")
        with open(path, encoding="utf-8") as stream:
            return json.load(stream)


def main(words: list[str]) -> int:
    parser = args.Parser(prog="latency", description=__doc__,
                         formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=15.0, help="of each measurement [15]")
    parser.add_argument("--motion", default="heavy")
    parser.add_argument("--gait", default="stand")
    parser.add_argument("--loops", type=int, default=2, help="busy loops of the second measurement; "
                        "0: without it [2]")
    parser.add_argument("--json", metavar="FILE", help="writes the figures there, too")
    parser.add_argument("--hops", metavar="FILE", help=argparse.SUPPRESS)
    options = parser.parse_args(words)

    def action():
        if not 1.0 <= options.seconds <= 3600.0:
            raise session.SessionError(f"seconds = {options.seconds:g}, must be 1 .. 3600")
        if not 0 <= options.loops <= 64:
            raise session.SessionError(f"loops = {options.loops}, must be 0 .. 64")
        if options.hops:
            files.write_json(options.hops, measure(options.seconds, options.motion, options.gait,
                                                   options.loops))
            return 0
        figures = {}
        for name, loops in [("idle", 0), ("busy", options.loops)][:2 if options.loops else 1]:
            measured = {hop: summary(seconds)
                        for hop, seconds in _measure_apart(options, loops).items()}
            unmeasured = [hop for hop, row in measured.items() if not row["count"]]
            if unmeasured:
                raise session.SessionError(f"{name}: nothing to measure, no message came over " + "; ".join(unmeasured))
            print(f"\n{name}: {loops} busy loops, {os.cpu_count()} cores, load "
                  f"{os.getloadavg()[0]:.1f} at the end\n{table(measured)}")
            figures[name] = {key(hop): row for hop, row in measured.items()}
        if options.json:
            files.write_json(options.json, figures)
        return 0
    return session.guarded("latency", action)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
