# SPDX-License-Identifier: BSD-3-Clause
"""Commands that work on bags: judge, inspect, report, bag_digest."""
import argparse

from prf_experiments import files
from prf_experiments.judge import cause, invariants, judge, reaction, timeline
from prf_experiments.record import digest, recording
from prf_experiments.robot import shadow
from prf_experiments.run import arguments as args
from prf_experiments.run import session, trial
from prf_experiments.teach import demonstration

EXIT_INVALID, EXIT_VIOLATION = 3, 4


def _checked(data):
    """(verdict, what the invariants say) of a recording."""
    session.waiting("judging")
    try:
        return judge.judge(data), invariants.check(data)
    finally:
        session.waiting("")


def _read(bag):
    """The recording in a bag."""
    session.waiting(f"reading {bag}")
    try:
        return recording.read(bag)
    finally:
        session.waiting("")


def _exit_code(verdict, found):
    return (EXIT_INVALID if verdict.verdict == "INVALID"
            else EXIT_VIOLATION if found.violations else 0)


def judge_main(words: list[str]) -> int:
    parser = args.Parser(
        prog="judge", description=judge.__doc__, epilog="Exit 0 for S, P and F, 3 for INVALID, "
        "4 for S, P and F with a broken invariant.",
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("--json", metavar="FILE", help="writes verdict and figures there")
    options = parser.parse_args(words)

    def action():
        why = ""
        try:
            data = _read(options.bag)
            verdict, found = _checked(data)
            why = cause.sentence(data, verdict)
        except recording.RecordingError as error:
            verdict, found = judge.invalid(str(error)), invariants.Findings()
        if options.json:
            files.write_json(options.json, {**verdict.as_json(), "cause": why,
                                            "invariants": found.as_json()})
        print(f"{verdict.verdict}{' (inspected)' if verdict.inspected else ''}: {verdict.reason}")
        if why:
            print(f"  {why}")
        for name, value in verdict.figures.items():
            print(f"  {name}: {value:.4g}" if isinstance(value, float) else f"  {name}: {value}")
        for violation in found.violations:
            print(f"  INVARIANT BROKEN: {violation}")
        return _exit_code(verdict, found)
    return session.guarded("judge", action)


def inspect_main(words: list[str]) -> int:
    parser = args.Parser(
        prog="inspect", description="Prints a trial as a timeline: phases and reasons, detections, "
        "contacts, what the arm could not do, solve times, drops.")
    parser.add_argument("bag")
    parser.add_argument("--json", metavar="FILE", help="writes the events there too")
    options = parser.parse_args(words)

    def action():
        data = _read(options.bag)
        verdict = judge.judge(data)
        if options.json:
            names = ("time_s", "off_axis_mm", "to_stand_off_mm", "following_mm", "event")
            lines = timeline.event_lines(data, verdict.figures)
            files.write_json(options.json, [dict(zip(names, line)) for line in lines])
        print(timeline.text(data, verdict, cause.sentence(data, verdict)), end="")
        if data.is_estimated:
            print("\n".join(shadow.compared(options.bag)))
        return 0
    return session.guarded("inspect", action)


def report_main(words: list[str]) -> int:
    from prf_experiments.report import pictures, report  # takes its time
    parser = args.Parser(prog="report", description="Draws the report of a trial.")
    parser.add_argument("bag")
    parser.add_argument("out", help="HTML file to write")
    parser.add_argument("--demonstration", default=None,
                        help="file of the skill; else the one that the bag names")
    options = parser.parse_args(words)

    def action():
        data = _read(options.bag)
        verdict, found = _checked(data)
        description = data.description
        skill = options.demonstration or trial.skill(
            {"demonstration": None, **description.get("arguments", {})})
        content = {**description, **verdict.as_json(), "cause": cause.sentence(data, verdict),
                   "invariants": found.as_json(), "reaction": reaction.times(data)}
        session.waiting("drawing film, key frames and figures")
        report.write(options.out, options.bag, data, content, demonstration.read(skill),
                     pictures.of(options.bag, data, verdict.figures) if verdict.figures
                     else report.NOTHING)
        session.waiting("")
        print(options.out)
        return _exit_code(verdict, found)
    return session.guarded("report", action)


def digest_main(words: list[str]) -> int:
    parser = args.Parser(
        prog="bag_digest", description=digest.__doc__,
        epilog="With two bags: exit 0 when they are identical, 1 when they are not.",
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("other", nargs="?", help="compares the two topic by topic")
    parser.add_argument("--json", metavar="FILE", help="writes digests and differences there")
    options = parser.parse_args(words)

    def action():
        session.waiting("reading every message")
        ours = digest.digests(options.bag)
        differences = (digest.differences(ours, digest.digests(options.other))
                       if options.other else None)
        session.waiting("")
        if options.json:
            files.write_json(options.json, {"differences": differences, "streams": [
                {"topic": topic, "publisher": publisher, "messages_count": entry.messages,
                 "sha256": entry.sha256} for (topic, publisher), entry in ours.items()]})
        if differences is None:
            for (topic, publisher), entry in ours.items():
                print(f"{entry.sha256} {entry.messages:7d} {topic} [{publisher}]")
            return 0
        print("\n".join(differences) if differences else f"identical: {len(ours)} streams")
        return 1 if differences else 0
    return session.guarded("bag_digest", action)
