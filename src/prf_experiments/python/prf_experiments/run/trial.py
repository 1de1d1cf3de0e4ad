# SPDX-License-Identifier: BSD-3-Clause
"""Runs one closed-loop trial: launch, record, simulate, judge, report."""
import contextlib
import os
import subprocess
import sys

import rospkg

from prf_experiments import files, robots
from prf_experiments.faults import catalogue, disturbances, wiring
from prf_experiments.judge import cause, invariants, judge, reaction
from prf_experiments.record import recording, topics
from prf_experiments.run import arguments as args
from prf_experiments.run import (
    connections,
    isolation,
    names,
    processes,
    session,
    trial_arguments,
)
from prf_experiments.teach import demonstration

SIMULATOR = "platform_sim"
START_SERVICE = "/platform_sim/start"
EXIT_OK, EXIT_USAGE, EXIT_INVALID, EXIT_VIOLATION = 0, 2, 3, 4


def versions() -> dict[str, str]:
    """What ran, as far as it can be told."""
    stack = rospkg.RosPack()
    result = {"prf_experiments": stack.get_manifest("prf_experiments").version,
              "rosbag": stack.get_manifest("rosbag").version,
              "python": ".".join(map(str, sys.version_info[:3]))}
    with contextlib.suppress(OSError, subprocess.SubprocessError):
        result["commit"] = subprocess.run(
            ["git", "-C", session.packaged(), "describe", "--always", "--dirty"], check=True,
            capture_output=True, text=True, timeout=10).stdout.strip()
    return result


def describe(values: dict) -> dict:
    """What the bag says about itself."""
    words = ["rosrun prf_experiments run_trial", *trial_arguments.words(values)]
    return {"command": " ".join(words),
            "arguments": {name: values[name] for name in trial_arguments.LAUNCHED},
            "files": trial_arguments.contents(values),
            "tick_s": names.driver_period(values["driver"]),
            "versions": versions()}


def simulate(run: session.Session, description: dict) -> float:
    """Runs the trial to the simulator's end and leaves a closed bag. Returns the wall time, s."""
    with run.running() as launch, contextlib.ExitStack() as stack:
        # Imported here: rospy reads the environment that running() has set.
        from prf_experiments.run.observer import Observer
        observer = Observer(description)
        stack.callback(observer.close)
        recorder = stack.enter_context(run.recording())
        run.wait_until_connected(launch, recorder)
        run.save_parameters()
        observer.call(START_SERVICE)
        wall = run.wait_for_driver(launch, recorder, observer.status)
        run.close(launch, recorder)
        return wall


def checked(data: recording.Recording | None, verdict: judge.Verdict, folder: str) -> dict:
    """The cause, the invariants of every trial, and what the execution did about faults."""
    left_over = processes.left_over(os.path.join(folder, "log"))
    if data is None:
        found = invariants.Findings([f"process left over: {command}" for command in left_over])
        return {"cause": "", "invariants": found.as_json()}
    return {"cause": cause.sentence(data, verdict),
            "invariants": invariants.check(data, left_over=left_over).as_json(),
            "reaction": reaction.times(data)}


def _draw_report(folder, data, content, brief):
    from prf_experiments.report import pictures, report  # what they import takes its time
    bag = os.path.join(folder, "trial.bag")
    if brief and content["verdict"] == "S":
        report.write_brief(os.path.join(folder, "report.html"), bag, data, content)
        return
    scene = pictures.of(bag, data, content["figures"]) if content["figures"] else report.NOTHING
    report.write(os.path.join(folder, "report.html"), bag, data, content,
                 demonstration.read(skill(content["arguments"])), scene)


def evaluate(folder: str, description: dict, wall: float | None, failure: str,
             progress: session.ProgressLine, draw: str = "true") -> dict:
    """Judges the bag and writes verdict.json and report.html. Returns what verdict.json holds.

    `draw` is the trial's argument `report`.
    """
    bag, data = os.path.join(folder, "trial.bag"), None
    verdict = judge.invalid(failure)
    if not failure:
        progress.show("judging", always=True)
        try:
            data = recording.read(bag)
            verdict = judge.judge(data)
        except recording.RecordingError as error:
            verdict = judge.invalid(str(error))
    simulated = verdict.figures.get("duration_s")
    content = {**verdict.as_json(), **checked(data, verdict, folder), **description,
               "wall_time_s": wall,
               "simulated_per_real_time": simulated / wall if simulated and wall else None}
    try:  # the verdict comes last: where there is one, everything is there
        if draw != "false":
            progress.show("drawing the report", always=True)
            _draw_report(folder, data, content, draw == "brief")
        files.write_json(os.path.join(folder, "verdict.json"), content)
    except OSError as error:
        lost = judge.invalid(f"the results cannot be written: {error}"
                             + (f"; before that: {failure}" if failure else ""))
        content = {**content, **lost.as_json()}
        with contextlib.suppress(OSError):
            files.write_json(os.path.join(folder, "verdict.json"), content)
    progress.close()
    return content


def skill(values: dict) -> str:
    """The file of the skill: the one that the arguments name, else the package's own."""
    if values["demonstration"]:
        return values["demonstration"]
    stands = values.get("obstacle", "none") != "none"
    robot = values.get("robot", robots.DEFAULT)
    own = "inspect_box" if robot == robots.DEFAULT else os.path.basename(robot)
    return session.packaged("demonstrations",
                            ("inspect_box_from_the_right" if stands else own) + ".csv")


def skill_arguments(values: dict) -> list[str]:
    """For a launch file whose own default is the skill without an obstacle."""
    is_default = not values["demonstration"] and values.get("obstacle", "none") == "none"
    return [] if is_default else [f"demonstration:={skill(values)}"]


def session_of(values: dict, folder: str) -> session.Session:
    """The trial as a session that leaves its bag in `folder`."""
    faults = disturbances.all_faults(values)
    launched = {**{name: values[name] for name in trial_arguments.LAUNCHED},
                **disturbances.launched(values)}
    links = (connections.trial_links(SIMULATOR)
             | session.recorder_links(session.SENSOR_AND_TRUTH, SIMULATOR))
    if values["driver"]:
        links = connections.through_driver(links, SIMULATOR)
    return session.Session(
        folder=folder, bag="trial.bag", launch_file=session.packaged("launch", "trial.launch"),
        launch_arguments=[f"{name}:={args.show(value)}" for name, value in launched.items()
                          if value is not None and name != "demonstration"]
        + skill_arguments(values) + ["paused:=true"],
        topics=topics.TABLE.recorded + wiring.recorded(faults),
        links=wiring.rewired(links, faults) if faults else links,
        driver=SIMULATOR, may_end=tuple(catalogue.ended_nodes(faults)))


def check_time(values: dict) -> None:
    """Refuses a skill that no arm can execute, or not within the time limit."""
    times = demonstration.read_executable(skill(values)).times
    needed = float(times[-1] - times[0])
    if values["time_limit"] < needed:
        raise args.ArgumentError(f"time_limit:={values['time_limit']:g} is too short, the "
                                 f"demonstration takes {needed:g} s: give that or more")


def run(values: dict, folder: str | None = None) -> int:
    """Runs one trial and prints what people want to know. Returns the exit code.

    Without `folder` the trial gets a new one in the results folder.
    """
    check_time(values)
    description = describe(values)
    folder = (session.create_folder(values["results"], trial_arguments.name(values))
              if folder is None else session.use_folder(folder))
    trial = session_of(values, folder)
    print(description["command"], flush=True)
    failure, wall = "", None
    try:
        wall = simulate(trial, description)
    except (session.SessionError, processes.ProcessError, OSError) as error:
        failure = str(error)
    finally:
        trial.progress.close()

    content = evaluate(folder, description, wall, failure, trial.progress, values["report"])
    if not values["keep_bag"]:
        with contextlib.suppress(FileNotFoundError):
            os.remove(os.path.join(folder, "trial.bag"))
    print(f"verdict {content['verdict']}{' (inspected)' if content['inspected'] else ''}: "
          f"{content['reason']}")
    if content["cause"]:
        print(content["cause"])
    if content["simulated_per_real_time"]:
        print(f"simulated {content['figures']['duration_s']:.1f} s in {wall:.1f} s: "
              f"{content['simulated_per_real_time']:.2f} times real time")
    violations = content["invariants"]["violations"]
    for violation in violations:
        print(f"run_trial: INVARIANT BROKEN: {violation}", file=sys.stderr)
    print(folder)
    return (EXIT_INVALID if content["verdict"] == "INVALID"
            else EXIT_VIOLATION if violations else EXIT_OK)


def main(words: list[str]) -> int:
    valid, given = trial_arguments.TRIAL, words
    if any(word in ("-h", "--help") for word in words):
        print("usage: run_trial [--into FOLDER] [name:=value ...]\n" + trial_arguments.usage())
        return EXIT_OK
    folder = None
    if len(words) > 1 and words[0] == "--into":
        folder, words = os.path.abspath(words[1]), words[2:]
    try:
        values = trial_arguments.complete(args.parse(words, valid), words)
    except args.ArgumentError as error:
        print(f"run_trial: {error}", file=sys.stderr)
        return EXIT_USAGE
    if values["isolated"]:
        try:
            if isolation.is_inside():
                isolation.raise_loopback()
            else:
                isolation.enter("prf_experiments.run.trial", given)
        except (isolation.IsolationError, OSError) as error:
            print(f"run_trial: {error}", file=sys.stderr)
            return 1
    return session.guarded("run_trial", lambda: run(values, folder))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
