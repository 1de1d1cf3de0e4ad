# SPDX-License-Identifier: BSD-3-Clause
"""Runs one trial of a sweep into a folder of its own, here or on a worker elsewhere.

A trial is worked on in FOLDER.part and gets its name only when it is complete, so that a folder is
either evidence or to be repeated. What fails is tried once more; FOLDER.failed keeps the first
attempt's logs.
"""
import ctypes
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Callable

from prf_experiments import files
from prf_experiments.run import trial_arguments

ATTEMPTS = 2
TIMEOUT = 1800.0  # s of wall time; a trial has its own, shorter limits
STOP_TIMEOUT = 60.0  # s
PARTS = {"verdict": str, "inspected": bool, "figures": dict, "arguments": dict}  # of every verdict.json
KEEP_BAGS = ("failed", "all", "none")
PR_SET_PDEATHSIG = 1
LIBC = ctypes.CDLL(None)

_running: set[subprocess.Popen] = set()  # processes of this process's trials
_lock = threading.Lock()
_stopping = threading.Event()


class Stopped(Exception):
    """The trial was ended because the sweep is."""


def _end_with_parent():
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGINT)


def stop_running() -> None:
    """Ends this process's trials; each stops its nodes. No other begins afterwards."""
    with _lock:
        _stopping.set()
        processes = list(_running)
        for process in processes:
            process.send_signal(signal.SIGINT)
    for process in processes:
        try:
            process.wait(STOP_TIMEOUT)
        except subprocess.TimeoutExpired:
            process.kill()


def run_process(values: dict, folder: str) -> dict:
    """One attempt by `run_trial`. Returns what verdict.json holds, or None if there is none."""
    words = [sys.executable, "-m", "prf_experiments.run.trial", "--into", folder,
             *trial_arguments.words(values), f"report:={values.get('report', 'true')}"]
    with _lock:
        if _stopping.is_set():
            raise Stopped
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True, start_new_session=True,
                                   preexec_fn=_end_with_parent)
        _running.add(process)
    try:
        error = process.communicate(timeout=TIMEOUT)[1]
    except subprocess.TimeoutExpired:
        process.kill()
        error = f"run_trial did not end within {TIMEOUT:g} s"
    finally:
        with _lock:
            _running.discard(process)
    if _stopping.is_set():
        raise Stopped
    content = read(folder)
    return content or invalid(values, folder, error)


def invalid(values: dict, folder: str, error: str) -> dict:
    """A verdict for a trial that left none."""
    lines = error.strip().splitlines()
    os.makedirs(folder, exist_ok=True)
    return {"verdict": "INVALID", "inspected": False, "figures": {},
            "reason": lines[-1] if lines else "run_trial left no verdict",
            "arguments": {name: values[name] for name in trial_arguments.LAUNCHED},
            "files": trial_arguments.contents(values)}


def read(folder: str) -> dict | None:
    """Content of a folder's verdict.json, None when there is none that is whole."""
    try:
        with open(os.path.join(folder, "verdict.json"), encoding="utf-8") as stream:
            content = json.load(stream)
    except (OSError, ValueError, RecursionError):
        return None
    whole = isinstance(content, dict) and all(
        isinstance(content.get(name), kind) for name, kind in PARTS.items())
    return content if whole else None


def size(folder: str) -> int:
    """Bytes of all files below a folder."""
    return sum(os.lstat(os.path.join(place, name)).st_size
               for place, _, names in os.walk(folder) for name in names)


def keeps(keep_bags: str, verdict: str) -> bool:
    return keep_bags == "all" or (keep_bags == "failed" and verdict != "S")


def execute(values: dict, folder: str, keep_bags: str,
            attempt: Callable[[dict, str], dict] = run_process) -> dict:
    """The trial `values` into `folder`, repeated once when INVALID. Returns its verdict.json."""
    part, failed, reasons = folder + ".part", folder + ".failed", []
    for number in range(1, ATTEMPTS + 1):
        shutil.rmtree(part, ignore_errors=True)
        content = attempt(values, part)
        if content["verdict"] != "INVALID" or number == ATTEMPTS:
            break
        reasons.append(content["reason"])
        shutil.rmtree(failed, ignore_errors=True)
        os.rename(part, failed)
    bag = os.path.join(part, "trial.bag")
    if os.path.exists(bag) and not keeps(keep_bags, content["verdict"]):
        os.remove(bag)
    content = {**content, "failed_attempts": reasons, "disk_bytes": size(part)}
    files.write_json(os.path.join(part, "verdict.json"), content)
    shutil.rmtree(folder, ignore_errors=True)
    os.rename(part, folder)
    return content
