# SPDX-License-Identifier: BSD-3-Clause
"""One recorded run of a launch file: start the nodes, connect, simulate, close the bag.

Trials, teaching and replays are sessions that differ in what is launched and recorded.
"""
import contextlib
import os
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import rosgraph
import rospkg
import yaml

from prf_experiments import files
from prf_experiments.record import recording, topics
from prf_experiments.run import connections, processes
from prf_msgs import bags

CONNECT_TIMEOUT = 60.0  # s
NEEDED_SPACE = 800 * 1024**2  # bytes, a whole bag of 60 s


class SessionError(Exception):
    """The session could not be run; the message says why in one line."""


class Interrupted(BaseException):
    def __init__(self, number: int):
        super().__init__(signal.Signals(number).name)
        self.exit_code = 128 + number


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """SIGINT, SIGTERM and SIGHUP raise Interrupted once; during the clean-up they are ignored."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

    def interrupt(number, _):
        for other in numbers:
            signal.signal(other, signal.SIG_IGN)
        raise Interrupted(number)

    before = {number: signal.signal(number, interrupt) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def packaged(*parts: str) -> str:
    return os.path.join(rospkg.RosPack().get_path("prf_experiments"), *parts)


def check_space(folder: str) -> None:
    free = shutil.disk_usage(folder).free
    if free < NEEDED_SPACE:
        raise SessionError(f"disk full: {free >> 20} MiB are free in {folder}, "
                           f"a recording may need {NEEDED_SPACE >> 20}: make room, or give another folder "
                           "with results:=")


@contextlib.contextmanager
def _refused_in_one_line(results):
    try:
        yield
    except OSError as error:
        raise SessionError(f"results folder {results} cannot be written: "
                           f"{error.strerror}; give another with results:=") from None


def use_folder(folder: str) -> str:
    """The folder with a log folder in it, new, and with room for a bag."""
    with _refused_in_one_line(folder):
        os.makedirs(os.path.join(folder, "log"))
        check_space(folder)
    return folder


def create_folder(results: str, name: str) -> str:
    """results/<time>_<name>/ with a log folder, new, writable and with room for a bag."""
    stamp = time.strftime("%Y%m%d-%H%M%S")
    with _refused_in_one_line(results):
        os.makedirs(results, exist_ok=True)
        check_space(results)
        for suffix in [""] + [f"_{count}" for count in range(2, 100)]:
            folder = os.path.join(results, f"{stamp}_{name}{suffix}")
            with contextlib.suppress(FileExistsError):
                os.mkdir(folder)
                os.mkdir(os.path.join(folder, "log"))
                return folder
    raise SessionError(f"results folder {results} holds too many folders of this second")


class ProgressLine:
    """What is going on: one line rewritten on a terminal, a line every five seconds elsewhere."""

    def __init__(self) -> None:
        self._terminal = sys.stdout.isatty()
        self._period = 0.5 if self._terminal else 5.0
        self._next = time.monotonic()
        self._open = False

    def show(self, text: str, always: bool = False) -> None:
        now = time.monotonic()
        if now < self._next and not always:
            return
        self._next = now + self._period
        if self._terminal:
            sys.stdout.write("\r\x1b[K" + text)
            self._open = True
        else:
            sys.stdout.write(text + "\n")
        sys.stdout.flush()

    def close(self) -> None:
        if self._open:
            sys.stdout.write("\n")
            self._open = False


def waiting(text: str) -> None:
    """On a terminal, says on stderr what a command is at, in place of what it said before; "" ends that.

    Elsewhere nothing: what commands print is read by programs.
    """
    if sys.stderr.isatty():
        sys.stderr.write("\r\x1b[K" + text)
        sys.stderr.flush()


@dataclass
class Session:
    """What to launch and record; `driver` is the node whose end is the session's end."""

    folder: str
    bag: str  # file name in folder
    launch_file: str
    launch_arguments: list
    topics: list  # without leading slash
    links: set  # (topic, publisher, subscriber) without which nothing starts
    driver: str
    may_end: tuple = ()  # nodes whose end is wanted
    progress: ProgressLine = field(default_factory=ProgressLine)

    def log(self, name: str) -> str:
        return os.path.join(self.folder, "log", name)

    @contextlib.contextmanager
    def running(self) -> Iterator[processes.Launch]:
        """Master and nodes running, environment set. Everything is stopped at the end."""
        with contextlib.ExitStack() as stack:
            port = stack.enter_context(processes.reserved_port())
            os.environ.update(processes.master_environment(port, os.path.join(self.folder, "log")))
            launch = processes.Launch(port, self.launch_file, self.launch_arguments,
                                      os.path.join(self.folder, "log"))
            stack.callback(self._end, launch)
            self.progress.show(f"starting the nodes, master on port {port}", always=True)
            launch.wait_until_started()
            yield launch

    def _end(self, launch):
        self.progress.show("ending the nodes", always=True)
        launch.stop()
        self.progress.close()

    @contextlib.contextmanager
    def recording(self) -> Iterator[processes.Recorder]:
        """The recorder, running. What it wrote counts only once it was closed."""
        recorder = processes.Recorder(os.path.join(self.folder, self.bag), self.topics,
                                      self.log("recorder.log"))
        try:
            yield recorder
        finally:
            recorder.stop()

    def wait_until_connected(self, launch: processes.Launch, recorder: processes.Recorder) -> None:
        """Returns when every pair of publisher and subscriber is connected, and stays so."""
        master = rosgraph.Master(connections.CALLER)
        end = time.monotonic() + CONNECT_TIMEOUT
        quiet = 0
        while quiet < 2:
            launch.check()
            recorder.check()
            absent = connections.missing(master, self.links)
            quiet = 0 if absent else quiet + 1
            if absent and time.monotonic() > end:
                topic, publisher, subscriber = sorted(absent)[0]
                raise SessionError(f"not connected after {CONNECT_TIMEOUT:g} s: {topic} from "
                                   f"{publisher} to {subscriber} ({len(absent)} links missing); the nodes' "
                                   f"logs are in {self.log('')}")
            self.progress.show(f"connecting the nodes, {len(absent)} links missing")
            time.sleep(0.2)

    def save_parameters(self) -> None:
        tree = rosgraph.Master(connections.CALLER).getParam("/")
        for name in ("robot_description", "roslaunch", "run_id"):
            tree.pop(name, None)
        files.write(os.path.join(self.folder, "parameters.yaml"), yaml.safe_dump(tree))

    def wait_for_driver(self, launch: processes.Launch, recorder: processes.Recorder,
                        status: Callable[[float], str]) -> float:
        """Until the driver has ended well. Returns the wall time it took, s."""
        started = time.monotonic()
        while not launch.has_ended(self.driver):
            launch.check(may_end=[self.driver, *self.may_end])
            recorder.check()
            self.progress.show(status(time.monotonic() - started))
            time.sleep(0.1)
        wall = time.monotonic() - started
        if launch.exit_code(self.driver) != 0:
            raise SessionError(launch.describe_end(self.driver))
        return wall

    def close(self, launch: processes.Launch, recorder: processes.Recorder) -> None:
        """The closed bag, after every message under way has reached the recorder."""
        self.progress.show("waiting for the recorder to write the last messages", always=True)
        recorder.wait_until_idle()
        launch.check(may_end=[self.driver, *self.may_end])
        recorder.close()


def recorder_links(topics: list[str], publisher: str,
                   recorder: str = "recorder") -> set[connections.Link]:
    return {("/" + topic, "/" + publisher, "/" + recorder) for topic in topics}


SENSOR_AND_TRUTH = topics.SENSORS + topics.GROUND_TRUTH


def guarded(name: str, action: Callable[[], int]) -> int:
    """Runs action(); errors become one line on stderr. Returns the exit code."""
    from prf_experiments.run.arguments import ArgumentError
    from prf_experiments.teach.demonstration import DemonstrationError
    try:
        with interruptible():
            return action()
    except ArgumentError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    except Interrupted as interruption:
        print(f"\n{name}: stopped by {interruption}", file=sys.stderr)
        return interruption.exit_code
    except (SessionError, processes.ProcessError, DemonstrationError, recording.RecordingError,
            OSError) as error:
        print(f"{name}: {bags.one_line(error)}", file=sys.stderr)
        return 1
