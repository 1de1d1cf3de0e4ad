# SPDX-License-Identifier: BSD-3-Clause
"""Processes of a trial: a launch with its own master, and the recorder."""
import contextlib
import ctypes
import json
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence

import roslib.packages

PR_SET_PDEATHSIG = 1
LIBC = ctypes.CDLL(None)


def executable(package: str, name: str) -> str:
    """Path of a package's program, as rosrun finds it."""
    found = roslib.packages.find_node(package, name)
    if not found:
        raise ProcessError(f"{package} has no program {name}: is it built?")
    return found[0]


class ProcessError(Exception):
    """A process could not be started, died, or did not do its work; the message names it."""


@contextlib.contextmanager
def reserved_port() -> Iterator[int]:
    """A free port for a master that no other trial on this machine takes meanwhile."""
    for port in random.SystemRandom().sample(range(11500, 20000), 200):
        lock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        with lock:
            try:
                lock.bind(f"\0prf_experiments_master_{port}")
                with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
                    probe.bind(("", port))
            except OSError:
                continue
            yield port
            return
    raise ProcessError("no free port for a ROS master between 11500 and 20000: end masters that are no longer needed")


def master_environment(port: int, log_folder: str) -> dict[str, str]:
    """Environment variables of every process of a trial: all of it stays on this machine."""
    values = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_LOG_DIR": log_folder,
              "ROSCONSOLE_FORMAT": "[${severity}] [${node}] ${message}"}
    if "ROS_IP" not in os.environ:
        values["ROS_IP"] = "127.0.0.1"
        values["ROS_HOSTNAME"] = "127.0.0.1"  # it would win over ROS_IP
    return values


def last_line(log_file: str) -> str:
    """Last line of a log that says anything."""
    with contextlib.suppress(OSError), open(log_file, encoding="utf-8", errors="replace") as log:
        for line in reversed(log.read().splitlines()):
            if line.strip():
                return line.strip()
    return "it says nothing"


def last_error(log_file: str, node: str) -> str:
    """Last FATAL line of a node, else its last ERROR line, else an empty string."""
    pattern = re.compile(r"\[(FATAL|ERROR)\] \[/?" + re.escape(node) + r"\] (.*?)(\x1b\[0m)?$")
    found = {}
    with contextlib.suppress(OSError), open(log_file, encoding="utf-8", errors="replace") as log:
        for line in log:
            match = pattern.search(line.rstrip("\n"))
            if match:
                found[match.group(1)] = match.group(2).strip()
    return found.get("FATAL") or found.get("ERROR") or ""


class Launch:
    """A launch file running with its own master, in a process of its own."""

    def __init__(self, port: int, launch_file: str, arguments: list[str], log_folder: str):
        self._log_file = os.path.join(log_folder, "launch.log")
        self._died: dict[str, int] = {}
        self._error = None
        self._started = threading.Event()
        read_end, write_end = os.pipe()
        with open(self._log_file, "w", encoding="utf-8") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "prf_experiments.run.launcher", str(write_end), str(port),
                 launch_file, *arguments],
                stdin=subprocess.PIPE, stdout=log, stderr=log, pass_fds=[write_end],
                start_new_session=True)
        assert self._process.stdin is not None
        self._input = self._process.stdin  # its end ends the launch
        os.close(write_end)
        self._listener = threading.Thread(target=self._listen, args=[read_end], daemon=True)
        self._listener.start()

    def _listen(self, descriptor):
        with os.fdopen(descriptor) as stream:
            for line in stream:
                report = json.loads(line)
                if "died" in report:
                    self._died[report["died"]] = report["exit_code"]
                elif "error" in report:
                    self._error = report["error"]
                elif "started" in report:
                    self._started.set()

    def wait_until_started(self, timeout: float = 60.0) -> None:
        end = time.monotonic() + timeout
        while not self._started.wait(0.05):
            self.check()
            if time.monotonic() > end:
                raise ProcessError(f"the nodes did not start within {timeout:g} s, see {self._log_file}")

    def exit_code(self, node: str) -> int | None:
        """Exit code of a node that has ended, None while it runs."""
        return self._died.get(node)

    def has_ended(self, node: str) -> bool:
        return node in self._died

    def describe_end(self, node: str) -> str:
        error = last_error(self._log_file, node)
        return (f"{node} ended with exit code {self._died[node]}"
                + (f": {error}" if error else f", see {self._log_file}"))

    def check(self, may_end: Sequence[str] = ()) -> None:
        """Raises ProcessError when the launch failed or a node ended that should not have."""
        if self._error:
            raise ProcessError(f"launch failed: {self._error}")
        for node in list(self._died):
            if node not in may_end:
                raise ProcessError(self.describe_end(node))
        if self._process.poll() is not None:
            raise ProcessError(f"the launch process ended, see {self._log_file}")

    def stop(self, timeout: float = 60.0) -> None:
        with contextlib.suppress(BrokenPipeError):
            self._input.close()
        try:
            self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._listener.join(5.0)


def _end_with_parent():
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGINT)
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # a file that cannot grow is told as an error


def left_over(log_folder: str) -> list[str]:
    """Command lines of the processes of a session that are still there, by their ROS_LOG_DIR."""
    mark, found = b"ROS_LOG_DIR=" + os.fsencode(log_folder) + b"\0", []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError):
            with open(f"/proc/{pid}/environ", "rb") as stream:
                ours = mark in stream.read() + b"\0"
            with open(f"/proc/{pid}/cmdline", "rb") as stream:
                command = stream.read().replace(b"\0", b" ").decode(errors="replace").strip()
            if ours and command and int(pid) != os.getpid():
                found.append(command)
    return found


class Recorder:
    """The recorder of an explicit list of topics into one bag.

    With images it is not compressed: LZ4 finds 4 % in their noise, and every reader pays for it.
    """

    MIN_FREE = 100 * 1024**2  # bytes; below, the disk counts as full

    def __init__(self, bag: str, topics: list[str], log_file: str, name: str = "recorder"):
        self.bag = bag
        self._log_file = log_file
        options = [] if "camera/image_raw" in topics else ["--lz4"]
        with open(log_file, "w", encoding="utf-8") as log:
            self._process = subprocess.Popen(
                [executable("prf_ros", "recorder"), *options, bag,
                 *("/" + topic for topic in topics), f"__name:={name}"],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
                preexec_fn=_end_with_parent)

    def check(self) -> None:
        if self._process.poll() is not None:
            # On a full disk its log cannot be written either.
            why = "the bag cannot be written: " if self._process.returncode == 1 else ""
            raise ProcessError(f"the recorder ended with exit code {self._process.returncode}: "
                               + why + self._last_line())
        if shutil.disk_usage(os.path.dirname(self.bag)).free < self.MIN_FREE:
            raise ProcessError(f"disk full: less than {self.MIN_FREE >> 20} MiB are free for "
                               f"{self.bag}: make room, or give another folder with results:=")

    def _last_line(self):
        with open(self._log_file, encoding="utf-8", errors="replace") as log:
            lines = [line.strip() for line in log if line.strip()]
        return lines[-1] if lines else "no output"

    def _cpu_ticks(self):
        with open(f"/proc/{self._process.pid}/stat", encoding="ascii") as stat:
            fields = stat.read().rpartition(")")[2].split()
        return int(fields[11]) + int(fields[12])

    def wait_until_idle(self, quiet: float = 0.5, timeout: float = 60.0) -> None:
        """Returns when the recorder has used next to no processor time for `quiet` s."""
        end = time.monotonic() + timeout
        before = self._cpu_ticks()
        while time.monotonic() < end:
            time.sleep(quiet)
            self.check()
            now = self._cpu_ticks()
            if now - before <= 1:
                return
            before = now
        raise ProcessError(f"the recorder was still busy {timeout:g} s after the last message")

    def close(self, timeout: float = 60.0) -> None:
        """Ends the recording and waits for the closed bag."""
        self.check()
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            raise ProcessError(f"the recorder did not close its bag within {timeout:g} s") from None
        if not os.path.exists(self.bag):
            raise ProcessError("the recorder left no closed bag: " + self._last_line())

    def stop(self) -> None:
        """Ends the process whatever became of the bag."""
        if self._process.poll() is not None:
            return
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(10.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
