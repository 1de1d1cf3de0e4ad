# SPDX-License-Identifier: BSD-3-Clause
"""Many trials: side by side, on this machine or on a Dask cluster, resumable.

A sweep lives in one folder: `sweep.json` (what began it) and `trials/<name>/` for each trial. Only
this folder is shared with workers elsewhere; they have the same software installed.
"""
import concurrent.futures
import contextlib
import fcntl
import itertools
import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TextIO

from prf_experiments import files
from prf_experiments.run import trial_arguments
from prf_experiments.run.session import Interrupted, SessionError
from prf_experiments.sweep import trial_runner

BAR = 24  # characters
MEGABYTE = 1e6
CONNECT_TIMEOUT = 20.0  # s
WAITING_PERIOD = 30.0  # s between two lines that say what is waited for


@dataclass(frozen=True)
class SweepParams:
    jobs: int
    keep_bags: str = "failed"
    scheduler: str | None = None  # address of a Dask scheduler, None: this machine
    any_version: bool = False


def product(fixed: dict, axes: dict) -> list[dict]:
    """A trial {argument: value} for every combination of the axes {argument: values}."""
    return [{**fixed, **dict(zip(axes, values))} for values in itertools.product(*axes.values())]


def trial_folder(folder: str, values: dict) -> str:
    return os.path.join(folder, "trials", trial_arguments.name(values))


def finished(folder: str, values: dict) -> dict | None:
    """The verdict of a trial that needs no repetition, else None."""
    content = trial_runner.read(trial_folder(folder, values))
    if content is None or content["verdict"] == "INVALID":
        return None
    if not trial_arguments.same(values, content):
        return None
    # A file may lie elsewhere now; its content is the same.
    return {**content, "arguments": {name: values[name] for name in trial_arguments.LAUNCHED}}


@contextlib.contextmanager
def locked(folder: str) -> Iterator[None]:
    """The folder for one sweep at a time."""
    try:
        os.makedirs(os.path.join(folder, "trials"), exist_ok=True)
        stream = open(os.path.join(folder, ".lock"), "w", encoding="utf-8")
    except OSError as error:
        raise SessionError(f"{folder} cannot be written: {error.strerror}; give another folder with "
                           "results:=") from None
    with stream:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise SessionError(f"another sweep is at work in {folder}: wait for its end, or "
                               "give another --name") from None
        yield


def with_reports(trials: list[dict]) -> list[dict]:
    """The trials with what is drawn of them: the first of each cell always, of the others those that
    are not S. A cell's trials differ in their seed."""
    cells: list[dict] = []
    found = []
    for values in trials:
        shared = {name: value for name, value in values.items() if name != "seed"}
        found.append({**values, "report": "brief" if shared in cells else "true"})
        if shared not in cells:
            cells.append(shared)
    return found


def begin(folder: str, versions: dict, any_version: bool) -> None:
    """Notes what makes the sweep; refuses to mix trials of several versions."""
    path = os.path.join(folder, "sweep.json")
    with contextlib.suppress(OSError, ValueError, RecursionError), open(path, encoding="utf-8") as stream:
        content = json.load(stream)
        before = content.get("versions") if isinstance(content, dict) else None
        if isinstance(before, dict) and before != versions and not any_version:
            raise SessionError(
                f"{folder} holds trials of version {before.get('commit', before)}, this is "
                f"{versions.get('commit', versions)}: go on with --any-version, or afresh with "
                "another --name")
    files.write_json(path, {"versions": versions})


class Board:
    """What people see: a line for each finished trial, and on a terminal a bar below them."""

    def __init__(self, total: int, kept: int, stream: TextIO = sys.stdout,
                 clock: Callable[[], float] = time.monotonic):
        self._total, self._kept, self._stream, self._clock = total, kept, stream, clock
        self._started, self._done, self._waited = clock(), 0, -WAITING_PERIOD
        self._counts: dict[str, int] = {}
        self._terminal = stream.isatty()
        self._write(f"{total} trials" + (f", {kept} of them finished before" if kept else ""))

    def _write(self, text):
        self._stream.write(("\r\x1b[K" if self._terminal else "") + text + "\n")
        self._stream.flush()

    def left(self) -> float | None:
        """Seconds that the rest will take, None before the first trial is done."""
        if not self._done:
            return None
        waiting = self._total - self._kept - self._done
        return waiting * (self._clock() - self._started) / self._done

    def bar(self) -> str:
        done = self._kept + self._done
        filled = BAR * done // max(1, self._total)
        counts = "  ".join(f"{verdict} {count}" for verdict, count in sorted(self._counts.items()))
        left = self.left()
        return (f"[{'#' * filled}{'.' * (BAR - filled)}] {done}/{self._total}  {counts}  "
                + ("" if left is None else f"about {left / 60:.0f} min left" if left >= 90
                   else f"about {left:.0f} s left"))

    def tell(self, values: dict, content: dict) -> None:
        self._done += 1
        self._counts[content["verdict"]] = self._counts.get(content["verdict"], 0) + 1
        broken = len(content.get("invariants", {}).get("violations", []))
        if broken:
            self._write(f"{trial_arguments.name(values)}: {broken} INVARIANTS BROKEN")
        again = "".join(f", after {reason}" for reason in content["failed_attempts"])
        self._write(f"{self._kept + self._done}/{self._total} {content['verdict']:<7} "
                    f"{trial_arguments.name(values)}: {content['reason']} "
                    f"({content['disk_bytes'] / MEGABYTE:.0f} MB{again})")
        self.refresh()

    def refresh(self) -> None:
        if self._terminal:
            self._stream.write("\r\x1b[K" + self.bar())
            self._stream.flush()

    def wait_for(self, what: str) -> None:
        """Says what keeps the trials from being run, every WAITING_PERIOD s anew; "": nothing."""
        if not what:
            self._waited = -WAITING_PERIOD
        elif self._clock() - self._waited >= WAITING_PERIOD:
            self._waited = self._clock()
            self._write(what)

    def close(self, folder: str) -> None:
        used = trial_runner.size(os.path.join(folder, "trials")) / MEGABYTE
        self._write(f"{self._done} trials in {(self._clock() - self._started) / 60:.1f} min; "
                    f"{folder} takes {used:.0f} MB on disk")


@contextlib.contextmanager
def executor(options: SweepParams) -> Iterator[tuple[concurrent.futures.Executor, Callable[[], str]]]:
    """(where trials are sent: something with submit() that gives concurrent futures, what it waits
    for, "" when for nothing but the trials)."""
    if options.scheduler is None:
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            yield pool, lambda: ""
        return
    import distributed  # half a second, and only needed here
    try:
        client = distributed.Client(options.scheduler, timeout=CONNECT_TIMEOUT,
                                    set_as_default=False)
    except (OSError, ValueError, distributed.TimeoutError) as error:
        raise SessionError(f"no Dask scheduler answers at {options.scheduler}: {error}; start "
                           "one with `dask-scheduler`, or leave --scheduler out") from None

    def lacking():
        try:
            workers = client.scheduler_info()["workers"]
        except (OSError, distributed.TimeoutError) as error:
            raise SessionError(f"the Dask scheduler at {options.scheduler} no longer answers: "
                               f"{error}; when it is back, the same command goes on") from None
        return "" if workers else (f"no worker has joined {options.scheduler}, waiting; start one with "
                                   f"`dask-worker {options.scheduler}`")
    with client:
        yield client.get_executor(pure=False), lacking


def run(trials: list[dict], folder: str, options: SweepParams, versions: dict,
        attempt: Callable[[dict, str], dict] = trial_runner.run_process,
        board: Callable[[int, int], Board] = Board) -> list[dict]:
    """Verdicts of all trials in their order; those of an earlier, interrupted run are kept."""
    names = [trial_arguments.name(values) for values in trials]
    for row, name in enumerate(names):
        if name in names[:row]:
            raise SessionError(f"two trials are the same, both are called {name}: give each value once")
    with locked(folder):
        begin(folder, versions, options.any_version)
        results = {row: content for row, values in enumerate(trials)
                   if (content := finished(folder, values)) is not None}
        waiting = [row for row in range(len(trials)) if row not in results]
        shown = board(len(trials), len(trials) - len(waiting))
        drawn = with_reports(trials)
        with executor(options) as (pool, lacking):
            futures = {pool.submit(trial_runner.execute, drawn[row],
                                   trial_folder(folder, trials[row]), options.keep_bags,
                                   attempt): row for row in waiting}
            try:
                while futures:
                    done, _ = concurrent.futures.wait(
                        futures, timeout=1.0, return_when=concurrent.futures.FIRST_COMPLETED)
                    for future in done:
                        row = futures.pop(future)
                        results[row] = future.result()
                        shown.tell(trials[row], results[row])
                    shown.wait_for(lacking())
                    shown.refresh()
            except (Exception, Interrupted):
                for future in futures:
                    future.cancel()
                trial_runner.stop_running()
                raise
        shown.close(folder)
        return [results[row] for row in range(len(trials))]
