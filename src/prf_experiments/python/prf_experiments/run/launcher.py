# SPDX-License-Identifier: BSD-3-Clause
"""Runs a launch file with its own master and reports on it, one JSON object a line.

    python3 -m prf_experiments.run.launcher REPORT_FD PORT FILE [name:=value ...]

Lines: {"started": [nodes]}, {"died": node, "exit_code": code}, {"error": message}. Everything is
stopped when standard input is closed, so nothing outlives the process that started this one.
"""
import json
import os
import sys
import threading
from typing import Any

import roslaunch

STOP_TIMEOUT = 4.0  # s that a node gets for SIGINT, then again for SIGTERM


class Reporter(roslaunch.pmon.ProcessListener):
    def __init__(self, descriptor: int):
        self._stream = os.fdopen(descriptor, "w")
        self._lock = threading.Lock()
        self._reported: set[str] = set()

    def tell(self, **what: Any) -> None:
        with self._lock:
            try:
                self._stream.write(json.dumps(what) + "\n")
                self._stream.flush()
            except BrokenPipeError:
                pass

    def process_died(self, process_name: str, exit_code: int) -> None:
        name = process_name.rpartition("-")[0]  # roslaunch appends a running number
        with self._lock:
            if name in self._reported:
                return
            self._reported.add(name)
        self.tell(died=name, exit_code=exit_code)


class Parent(roslaunch.parent.ROSLaunchParent):
    """A launch that goes on when a required node has ended: its last messages are still wanted."""

    def _load_config(self):
        super()._load_config()
        for node in self.config.nodes:
            node.required = False


def not_launched(parent: Parent) -> list[str]:
    """package/program of the nodes that roslaunch could not find; it only logs that."""
    begun = [process.name.rpartition("-")[0]
             for process in [*parent.pm.procs, *parent.pm.dead_list]]
    return [f"{node.package}/{node.type}" for node in parent.config.nodes
            if node.name not in begun]


def main(words: list[str]) -> int:
    reporter = Reporter(int(words[0]))
    port, launch_file, arguments = int(words[1]), words[2], words[3:]
    parent = Parent(
        "nodes", [(launch_file, arguments)], is_core=True, port=port, force_log=True,
        show_summary=False, process_listeners=[reporter],
        sigint_timeout=STOP_TIMEOUT, sigterm_timeout=STOP_TIMEOUT)
    try:
        parent.start(auto_terminate=False)
        absent = not_launched(parent)
        if absent:
            reporter.tell(error="cannot start " + ", ".join(absent) + ": is it built?")
            return 1
        for process in list(parent.pm.dead_list):  # dead before the listener was heard
            reporter.process_died(process.name, process.exit_code)
        reporter.tell(started=[node.name for node in parent.config.nodes])
        sys.stdin.read()
    except Exception as error:  # whatever roslaunch raises ends the launch and is reported
        reporter.tell(error=(str(error).strip() or repr(error)).splitlines()[0])
        return 1
    finally:
        parent.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
