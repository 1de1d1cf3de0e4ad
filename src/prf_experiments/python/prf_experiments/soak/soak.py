# SPDX-License-Identifier: BSD-3-Clause
"""A long run: executions begun again and again by the action, heavy stepping, faults at random."""
import argparse
import contextlib
import os
import re
import time
from collections import Counter

import numpy as np

from prf_experiments import files
from prf_experiments.faults import catalogue, wiring
from prf_experiments.judge import invariants, judge
from prf_experiments.record import recording, topics
from prf_experiments.report import charts, page
from prf_experiments.report.page import Section
from prf_experiments.run import connections, processes, session, trial
from prf_experiments.soak import measures, schedule
from prf_experiments.sweep.table import aligned

EXIT_OK, EXIT_FAILED, EXIT_VIOLATION = 0, 1, 4
LEFT_OUT = ["camera/image_raw", "camera/camera_info"]  # an hour of them is ten gigabytes
SAMPLE_PERIOD = 5.0  # s of wall time
PAGE = os.sysconf("SC_PAGE_SIZE")
MEGABYTE = 1e6
DRIFT_FACTOR, DRIFT_FLOOR = 2.0, 2.0  # of the first tenth's error, and mm beside


def node_processes(log_folder: str) -> dict[str, int]:
    """{node: process id} of a session's nodes, stopped ones included."""
    mark, found = b"ROS_LOG_DIR=" + os.fsencode(log_folder) + b"\0", {}
    for pid in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError):
            with open(f"/proc/{pid}/environ", "rb") as stream:
                if mark not in stream.read() + b"\0":
                    continue
            with open(f"/proc/{pid}/cmdline", "rb") as stream:
                name = re.search(rb"__name:=([^\0]+)", stream.read())
            if name:
                found[name[1].decode()] = int(pid)
    return found


def resident(pid: int) -> float:
    """Resident memory of a process, MB."""
    with open(f"/proc/{pid}/statm", encoding="ascii") as stream:
        return int(stream.read().split()[1]) * PAGE / MEGABYTE


class Watch:
    """Samples memory while it shows how the run goes."""

    def __init__(self, log_folder: str, observer, executions):
        self._log_folder, self._observer, self._executions = log_folder, observer, executions
        self._next = 0.0
        self.samples: dict[str, list[tuple[float, float, int]]] = {}

    def status(self, wall: float) -> str:
        import rospy  # after running() has set the environment
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + SAMPLE_PERIOD
            for node, pid in node_processes(self._log_folder).items():
                with contextlib.suppress(OSError):
                    self.samples.setdefault(node, []).append(
                        (rospy.Time.now().to_sec(), resident(pid), pid))
        return f"{self._observer.status(wall)}, {len(self._executions.done)} executions"


def session_of(options: argparse.Namespace, folder: str,
               faults: list[catalogue.Fault]) -> session.Session:
    wanted = [topic for topic in session.SENSOR_AND_TRUTH if topic not in LEFT_OUT]
    links = wiring.rewired(connections.trial_links(trial.SIMULATOR), faults) | \
        session.recorder_links(wanted, trial.SIMULATOR)
    links = {link for link in links if not (link[0].startswith("/faulty/")
                                            and link[2] == "/recorder")}
    return session.Session(
        folder=folder, bag="soak.bag", launch_file=session.packaged("launch", "trial.launch"),
        launch_arguments=["motion:=heavy", "gait:=step", f"seed:={options.seed}", "paused:=true",
                          "autostart:=false", f"time_limit:={3600.0 * options.hours}",
                          "end_delay:=86400",
                          "fault:=" + ",".join(fault.word for fault in faults)],
        topics=[topic for topic in topics.TABLE.recorded if topic not in LEFT_OUT], links=links,
        driver=trial.SIMULATOR, may_end=tuple(catalogue.ended_nodes(faults)))


def simulate(run: session.Session) -> tuple[Watch, list, float]:
    with run.running() as launch, contextlib.ExitStack() as stack:
        from prf_experiments.run.observer import Observer
        from prf_experiments.soak.executions import Executions
        observer = Observer({"command": "soak", "arguments": {"fault": "soak"}})
        stack.callback(observer.close)
        recorder = stack.enter_context(run.recording())
        run.wait_until_connected(launch, recorder)
        run.save_parameters()
        executions = Executions()
        watch = Watch(run.log("")[:-1], observer, executions)
        observer.call(trial.START_SERVICE)
        executions.start()
        wall = run.wait_for_driver(launch, recorder, watch.status)
        executions.stop()
        run.close(launch, recorder)
        return watch, executions.done, wall


def evaluate(data: recording.Recording, watch: Watch, executions: list, seconds: float,
             left_over: list[str]) -> dict:
    """All numbers, and under "failures" what should not be."""
    executing = np.zeros(len(data.ticks), dtype=bool)
    for execution in executions:
        executing |= (data.ticks >= execution.begin) & (data.ticks <= execution.end)
    found = invariants.check(data, left_over=left_over)
    memory = measures.memory(watch.samples)
    recovered = measures.recoveries(data, executing)
    drift = measures.drift(data)
    lasted = float(data.seconds(data.ticks[-1]))
    known = [value for value in drift if value is not None]
    failures = list(found.violations) + judge.harm(data)
    if lasted < seconds - 1.0:
        failures.append(f"the run ended after {lasted:.1f} of {seconds:.0f} s")
    if not executions:
        failures.append("no execution came to an end: there is nothing to say about them")
    failures += [f"memory of {row['node']} grows by {row['growth_mb_per_h']:.1f} MB/h"
                 for row in memory if measures.grows(row)]
    failures += [f"no recovery within {measures.RECOVERY:g} s of {row['fault']}"
                 for row in recovered if row["recovered_s"] is None and not row["idle"]]
    if len(known) > 1 and known[-1] > DRIFT_FACTOR * known[0] + DRIFT_FLOOR:
        failures.append(f"forecasts drift: error {known[0]:.1f} mm at first, {known[-1]:.1f} at last")
    return {"simulated_s": lasted, "failures": failures, "invariants": found.as_json(),
            "executions": dict(Counter(execution.result for execution in executions)),
            "memory": memory, "recoveries": recovered, "forecast_error_median_mm": drift}


def text(summary: dict) -> str:
    rows = [("node", "lives", "first, MB", "last, MB", "most, MB", "growth, MB/h", "over, s")]
    rows += [(row["node"], str(row["lives_count"]),
              *(f"{row[name]:.1f}" for name in ("first_mb", "last_mb", "most_mb")),
              "–" if row["growth_mb_per_h"] is None else f"{row['growth_mb_per_h']:+.1f}",
              f"{row['observed_s']:.0f}") for row in summary["memory"]]
    active = [row for row in summary["recoveries"] if not row["idle"]]
    after = [row["recovered_s"] for row in active if row["recovered_s"] is not None]
    told = [f"simulated {summary['simulated_s']:.0f} s; executions: "
            + (", ".join(f"{name} {count}" for name, count in sorted(summary["executions"].items()))
               or "none"),
            f"faults while an execution was asked for: {len(active)}, recovered from: {len(after)}"
            + (f", after {np.median(after):.2f} s in the median, {max(after):.2f} s at most"
               if after else ""),
            "forecast error, median of each tenth of the time, mm: "
            + " ".join("–" if value is None else f"{value:.1f}"
                       for value in summary["forecast_error_median_mm"]),
            *(f"NOT RIGHT: {failure}" for failure in summary["failures"])]
    return aligned(rows) + "\n" + "\n".join(told) + "\n"


def conclusion(summary: dict) -> str:
    """One sentence."""
    active = [row for row in summary["recoveries"] if not row["idle"]]
    after = [row["recovered_s"] for row in active if row["recovered_s"] is not None]
    wrong = len(summary["failures"])
    return (f"In {summary['simulated_s'] / 60.0:.1f} min {sum(summary['executions'].values())} executions and "
            f"{len(active)} faults while one was asked for, recovered from {len(after)}"
            + (f" after at most {max(after):.1f} s" if after else "")
            + (f"; {wrong} thing{'s are' if wrong > 1 else ' is'} NOT RIGHT, listed below." if wrong else
               "; nothing is wrong."))


def memory_figure(samples: dict) -> page.Markup:
    return charts.lines({node: ([entry[0] / 60.0 for entry in found], [entry[1] for entry in found])
                         for node, found in sorted(samples.items())},
                        "simulated time, min", "resident memory, MB",
                        "Resident memory of each node over time")


def write(folder: str, command: str, summary: dict, watch: Watch) -> None:
    faults = [(row["fault"], row["at_s"], "no execution" if row["idle"] else row["recovered_s"])
              for row in summary["recoveries"]]
    wrong = [Section("Not right", body=[page.table([(failure,) for failure in summary["failures"]])])]
    sections = [*(wrong if summary["failures"] else []),
                Section("Executions", body=[page.table(sorted(summary["executions"].items()), ("result", "count"))]),
                Section("Memory", "Every node's resident memory.",
                        [page.plotted(lambda: memory_figure(watch.samples))]),
                Section("Faults", "Recovered after so many s; –: not in time.",
                        [page.table(faults, ("fault", "at, s", "recovered after, s"))])]
    files.write_json(os.path.join(folder, "soak.json"), {"command": command, **summary})
    files.write(os.path.join(folder, "index.html"), page.whole(
        "study.html", title="Soak", command=command, conclusion=conclusion(summary), text=text(summary),
        sections=sections))


MEANING = ("Heavy stepping without a pause: executions begun again and again by the action, faults at random. Memory: "
           "of each node's\nlongest life, growth by a straight line after its first fifth.")


def run(options: argparse.Namespace) -> int:
    seconds = 3600.0 * options.hours
    faults = schedule.draw(options.seed, seconds)
    command = f"./run_experiment soak --hours {options.hours:g} --seed {options.seed}"
    folder = session.create_folder(options.results, f"soak_seed-{options.seed}")
    print(f"{command}: {len(faults)} faults", flush=True)
    soak = session_of(options, folder, faults)
    try:
        watch, executions, wall = simulate(soak)
    except (session.SessionError, processes.ProcessError) as error:
        soak.progress.close()
        print(f"INVALID: {error}\n{folder}")
        return EXIT_FAILED
    soak.progress.show("reading the bag", always=True)
    data = recording.read(os.path.join(folder, "soak.bag"), without=LEFT_OUT)
    summary = {**evaluate(data, watch, executions, seconds,
                          processes.left_over(soak.log("")[:-1])), "wall_time_s": wall}
    soak.progress.close()
    write(folder, command, summary, watch)
    if options.json:
        files.write_json(options.json, {"command": command, **summary})
    if options.results_page:
        files.write(options.results_page, f"# Soak\n\n{MEANING}\n\n```\n{command}\n```\n\n"
                    f"```text\n{text(summary)}```\n")
    if not (options.keep_bag or summary["failures"]):  # what went wrong is read in the bag
        os.remove(os.path.join(folder, "soak.bag"))
    print(text(summary) + "\n" + os.path.join(folder, "index.html"))
    return EXIT_VIOLATION if summary["failures"] else EXIT_OK


def main(options: argparse.Namespace) -> int:
    return session.guarded("run_experiment", lambda: run(options))
