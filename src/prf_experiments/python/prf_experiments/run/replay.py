# SPDX-License-Identifier: BSD-3-Clause
"""Plays a bag's sensor topics into the framework alone: a trial's, to compare its outputs with those that are in
the bag, or any robot's, to see what the framework would have done."""
import argparse
import contextlib
import os
import subprocess
import tempfile
import time
from collections.abc import Iterator

from prf_experiments import files
from prf_experiments.faults import catalogue, disturbances, wiring
from prf_experiments.judge import cause, invariants, judge, reaction
from prf_experiments.record import digest, estimated, recording, topics
from prf_experiments.robot import shadow
from prf_experiments.run import arguments as args
from prf_experiments.run import connections, foreign, processes, session, trial
from prf_experiments.teach import demonstration
from prf_msgs import bags

NEEDED = topics.CLOCK + topics.SENSORS
PLAYED = NEEDED + topics.SURROUNDINGS
COMPARED = ["/" + topic for topic in topics.OUTPUTS + topics.TRANSFORMS]
FRAMEWORK_ARGUMENTS = ["planner", "predictor", "framework", "decision", "hmm", "approach", "avoid"]


@contextlib.contextmanager
def player(bag: str, log_file: str, rate: float, played: list[str]) -> Iterator[subprocess.Popen]:
    """`rosbag play` of the sensor topics, paused before the first message."""
    with open(log_file, "w", encoding="utf-8") as log:
        process = subprocess.Popen(
            [processes.executable("rosbag", "play"), "--pause", "--queue=0", f"--rate={rate}",
             "--topics", *("/" + topic for topic in played), "--bags", bag, "__name:=player"],
            stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)
    try:
        yield process
    finally:
        if process.poll() is None:
            process.terminate()
            process.wait()


def repeatable(chosen: dict) -> list[catalogue.Fault]:
    """A trial's faults; SessionError when its topics do not determine what the nodes said."""
    faults = disturbances.all_faults(chosen)
    for fault in faults:
        if not fault.topic:
            raise session.SessionError(f"the bag has the fault {fault.word}, which is none of the messages: "
                                       "they alone do not give its outputs again; replay a bag without it")
        if fault.name == "second":
            raise session.SessionError(f"the bag has the fault {fault.word}, of two publishers: a replay "
                                       "has one; replay a bag without it")
    return faults


def check(bag: str) -> None:
    """Looks into the bag before a node starts: without sensors nothing can be played, without
    outputs nothing compared."""
    with bags.opened(bag) as content:
        bags.require_messages(content, NEEDED)
        bags.require_types(content, {*PLAYED, *topics.OUTPUTS, *topics.TRANSFORMS})
        found = bags.counts(content)
        if not any(found.get(name.lstrip("/")) for name in COMPARED):
            raise bags.BagError(f"{bag}: no message of any output, there is nothing to compare with: must "
                                "be a trial's bag")


def replay(bag: str, folder: str, rate: float) -> str:
    """Leaves folder/replay.bag with everything that the framework publishes."""
    chosen = recording.description(bag).get("arguments", {})
    faults = repeatable(chosen)
    faulty = wiring.recorded(faults)
    links = connections.trial_links("player", simulated=False)
    played_links = wiring.replayed(links, faults, "/player")
    return _play(bag, rate, PLAYED + faulty, None, session.Session(
        folder=folder, bag="replay.bag",
        launch_file=session.packaged("launch", "framework.launch"),
        launch_arguments=[f"{name}:={args.show(chosen[name])}" for name in FRAMEWORK_ARGUMENTS
                          if chosen.get(name) is not None]
        + (trial.skill_arguments(chosen) if "demonstration" in chosen else [])
        + ["relayed:=" + "".join(f"/{topic}:" for topic in catalogue.relayed(faults))],
        topics=topics.OUTPUTS + topics.TRANSFORMS, links=played_links, driver="player"))


def rehearse(bag: str, folder: str, rate: float, arguments: dict) -> str:
    """Leaves folder/replay.bag: what the framework and a stand-in for the arm do about a converted bag."""
    description = {"command": f"rosrun prf_experiments replay {bag}", "arguments": arguments,
                   "tick_s": 1e-9 * recording.TICK, "versions": trial.versions()}
    return _play(bag, rate, NEEDED, description, session.Session(
        folder=folder, bag="replay.bag", launch_file=session.packaged("launch", "framework.launch"),
        launch_arguments=["rehearsal:=true", *trial.skill_arguments(arguments)],
        topics=["joint_states", estimated.STAND_IN, *topics.OUTPUTS, *topics.TRANSFORMS, topics.DESCRIPTION,
                *topics.EXEMPT],
        links=connections.of_rehearsal(connections.trial_links("player", simulated=False), "player"),
        driver="player"))


def _play(bag: str, rate: float, played: list[str], description: dict | None, play: session.Session) -> str:
    with play.running() as launch, \
            player(bag, play.log("player.log"), rate, played) as playing, \
            contextlib.ExitStack() as stack:
        # Imported here: rospy reads the environment that running() has set.
        import std_srvs.srv

        from prf_experiments.run.observer import Observer
        observer = Observer(description)
        stack.callback(observer.close)
        recorder = stack.enter_context(play.recording())
        play.wait_until_connected(launch, recorder)
        observer.call("/player/pause_playback", std_srvs.srv.SetBool, data=False)
        while playing.poll() is None:
            launch.check()
            recorder.check()
            play.progress.show("playing")
            time.sleep(0.1)
        if playing.returncode != 0:
            raise session.SessionError(f"rosbag play of {bag} ended with exit code {playing.returncode}: "
                                       + processes.last_line(play.log("player.log")))
        play.close(launch, recorder)
    play.progress.close()
    return os.path.join(play.folder, play.bag)


def compare(bag: str, replayed: str) -> tuple[dict, dict, list[str]]:
    """(digests of the trial's outputs, of the replay's, lines of differences)."""
    ours, theirs = digest.digests(bag, COMPARED), digest.digests(replayed, COMPARED)
    return ours, theirs, digest.differences(ours, theirs)


def tell(bag: str, folder: str) -> int:
    """Judges and reports what a stand-in did about a robot's bag."""
    from prf_experiments.report import report  # takes its time
    data = recording.read(bag)
    verdict = judge.judge(data)
    content = {**data.description, **verdict.as_json(), "cause": cause.sentence(data, verdict),
               "invariants": invariants.check(data).as_json(), "reaction": reaction.times(data)}
    files.write_json(os.path.join(folder, "verdict.json"), content)
    report.write(os.path.join(folder, "report.html"), bag, data, content,
                 demonstration.read(trial.skill(data.description["arguments"])))
    print(f"would have been {verdict.verdict}: {verdict.reason}")
    if content["cause"]:
        print(content["cause"])
    print("\n".join(shadow.compared(bag)))
    print(folder)
    return 0


def of_robot(options: argparse.Namespace) -> int:
    """A bag with names, rates and encodings of its own."""
    source = foreign.Source(foreign.parse_map(options.map or []),
                            foreign.read_camera_info(options.camera_info) if options.camera_info else None)
    folder = os.path.abspath(options.folder or os.path.splitext(os.path.basename(options.bag))[0] + "_replayed")
    os.makedirs(os.path.join(folder, "log"), exist_ok=True)
    played = os.path.join(folder, "played.bag")
    session.waiting(f"converting {options.bag}")
    images = foreign.convert(options.bag, played, source)
    session.waiting("")
    print(f"{images} images")
    arguments = {"demonstration": options.demonstration, "rehearsal": True}
    return tell(rehearse(played, folder, options.rate, arguments), folder)


def run(options: argparse.Namespace) -> int:
    if options.map is not None or options.camera_info:
        return of_robot(options)
    check(options.bag)
    if options.folder:
        os.makedirs(options.folder, exist_ok=True)
    with contextlib.ExitStack() as stack:
        folder = options.folder or stack.enter_context(tempfile.TemporaryDirectory())
        os.makedirs(os.path.join(folder, "log"), exist_ok=True)
        ours, _, differences = compare(options.bag, replay(options.bag, folder, options.rate))
    if options.json:
        files.write_json(options.json, {
            "identical": not differences, "differences": differences,
            "compared_messages": sum(entry.messages for entry in ours.values())})
    for (topic, publisher), entry in ours.items():
        print(f"{entry.messages:7d}  {topic} [{publisher}]")
    print("\n".join(differences) if differences else "the replay gave identical messages")
    return 1 if differences else 0


def main(words: list[str]) -> int:
    parser = args.Parser(
        prog="replay", description="Plays the sensor topics of a trial's bag into the framework "
        "alone and compares its outputs with those in the bag. Exit 0: identical. With --map any robot's bag "
        "is played, and a stand-in for the arm shows what the framework would have done.")
    parser.add_argument("bag")
    parser.add_argument("--folder", help="keeps replay.bag and the logs there")
    parser.add_argument("--map", nargs="*", metavar="OURS:=THEIRS", help="topics of a robot's bag, such as "
                        "camera/image_raw:=/usb_cam/image_raw; Image or CompressedImage")
    parser.add_argument("--camera-info", metavar="FILE", help="of camera_calibration, where the bag has no camera_info")
    parser.add_argument("--demonstration", help="the skill; else the package's own")
    parser.add_argument("--rate", type=float, default=1.0, help="times real time")
    parser.add_argument("--json", metavar="FILE", help="writes the result there too")
    options = parser.parse_args(words)
    try:
        options.bag = args.plain_path(options.bag)
    except ValueError:
        parser.error(f"{options.bag}: ROS cannot be given a path with := or $(")
    return session.guarded("replay", lambda: run(options))
