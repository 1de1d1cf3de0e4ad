# SPDX-License-Identifier: BSD-3-Clause
"""Nodes that are killed, stopped and started again at given times of the data."""
import contextlib
import ctypes
import os
import resource
import signal
import subprocess
import xmlrpc.client
from collections.abc import Callable
from typing import Any

import rosgraph

from prf_experiments.faults.catalogue import Fault

CALLER = "/fault_injector"
PR_SET_PDEATHSIG = 1
LIBC = ctypes.CDLL(None)
STOP_TIMEOUT = 5.0  # s


def process_of(node: str) -> int:
    """Process id of a node, found as ROS finds it."""
    address = rosgraph.Master(CALLER).lookupNode("/" + node)
    answer: Any = xmlrpc.client.ServerProxy(address).getPid(CALLER)
    return int(answer[2])


def _end_with_parent():
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGINT)


def _read(pid, name):
    with open(f"/proc/{pid}/{name}", "rb") as stream:
        return [os.fsdecode(part) for part in stream.read().split(b"\0") if part]


def command_of(pid: int) -> tuple[list[str], dict[str, str]]:
    """Command line and environment with which a process was started."""
    variables = dict(entry.partition("=")[::2] for entry in _read(pid, "environ"))
    return _read(pid, "cmdline"), variables


class Victims:
    """`tell(fault, stamp, text)` hears of everything that is done."""

    def __init__(self, faults: list[Fault], tell: Callable[[Fault, int, str], None]):
        self._waiting = sorted(faults, key=lambda fault: fault.begin)
        self._tell = tell
        self._later: list[tuple[float, Fault, Callable[[], str]]] = []
        self._children: list[subprocess.Popen] = []
        self._stopped: set[int] = set()

    def tick(self, stamp: int, seconds: float) -> None:
        """Does what is due `seconds` after the first tick."""
        for child in self._children:
            child.poll()
        due = [entry for entry in self._later if entry[0] <= seconds]
        self._later = [entry for entry in self._later if entry[0] > seconds]
        for _, fault, action in due:
            self._attempt(fault, stamp, action)
        while self._waiting and self._waiting[0].begin <= seconds:
            fault = self._waiting.pop(0)
            self._attempt(fault, stamp, lambda fault=fault: self._begin(fault, seconds))

    def _attempt(self, fault, stamp, action):
        try:
            self._tell(fault, stamp, action())
        except (OSError, rosgraph.MasterException, xmlrpc.client.Error) as error:
            self._tell(fault, stamp, f"cannot be done: {error}")

    def _begin(self, fault, seconds):
        if fault.name == "disk":
            pid = process_of("recorder")
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
            return "the recorder's files cannot grow any more"
        pid = process_of(fault.node)
        if fault.name == "stop":
            os.kill(pid, signal.SIGSTOP)
            self._stopped.add(pid)
            self._later.append((seconds + fault.amount, fault,
                                lambda: self._go_on(fault.node, pid)))
            return f"{fault.node} is stopped"
        command, variables = command_of(pid)
        os.kill(pid, signal.SIGKILL)
        if fault.name == "respawn":
            self._later.append((seconds + fault.amount, fault,
                                lambda: self._start(fault.node, command, variables)))
        return f"{fault.node} is killed"

    def _go_on(self, node, pid):
        os.kill(pid, signal.SIGCONT)
        self._stopped.discard(pid)
        return f"{node} goes on"

    def _start(self, node, command, variables):
        self._children.append(subprocess.Popen(command, env=variables, stdin=subprocess.DEVNULL,
                                               preexec_fn=_end_with_parent))
        return f"{node} is started again"

    def close(self) -> None:
        """Leaves no process behind that was started or stopped here."""
        for pid in self._stopped:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGCONT)
        for child in self._children:
            if child.poll() is None:
                child.send_signal(signal.SIGINT)
        for child in self._children:
            try:
                child.wait(STOP_TIMEOUT)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()
