# SPDX-License-Identifier: BSD-3-Clause
"""Runs the package's commands as people do, and looks for what they leave behind."""
import os
import signal
import subprocess
from dataclasses import dataclass


@dataclass
class Run:
    code: int
    out: str
    error: str

    @property
    def folder(self):
        """Last line printed."""
        return self.out.rstrip("\n").rpartition("\n")[2]


def start(command, *words):
    return subprocess.Popen(["rosrun", "prf_experiments", command, *words], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def finish(process, timeout=170.0):
    try:
        out, error = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60.0)
        raise
    return Run(process.returncode, out, error)


def run(command, *words):
    return finish(start(command, *words))


def processes_of(folder):
    """Command lines of the processes whose environment names the folder, as its logs' place."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/environ", "rb") as stream:
                if folder.encode() not in stream.read():
                    continue
            with open(f"/proc/{pid}/cmdline", "rb") as stream:
                found.append(stream.read().replace(b"\0", b" ").decode())
        except OSError:
            continue
    return [line for line in found if line]
