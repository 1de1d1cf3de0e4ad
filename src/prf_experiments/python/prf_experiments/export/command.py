# SPDX-License-Identifier: BSD-3-Clause
"""The command export."""
import os

from prf_experiments import files, python_packages, robots
from prf_experiments.record import recording
from prf_experiments.run import arguments as args
from prf_experiments.run import session
from prf_experiments.run.arguments import ArgumentError


def _libraries():
    """What writes MCAP, from the Python environment that ./run_experiment sets up when it is not elsewhere.

    Raises SessionError.
    """
    python_packages.reach()
    try:
        from prf_experiments.export import export
    except ImportError as error:
        raise session.SessionError(
            f"{error}; {python_packages.how_to_get('rosbags', 'mcap')}") from None
    return export


def _robot(path, bag):
    """URDF of the bag's robot as text, or that of the file."""
    if path is None:
        try:
            path = robots.load(recording.description(bag).get("arguments", {}).get("robot", robots.DEFAULT)).urdf_file
        except robots.RobotError:
            return None
    with open(path, encoding="utf-8") as stream:
        return stream.read()


def export_main(words: list[str]) -> int:
    parser = args.Parser(
        prog="export", description="Writes a bag as MCAP with ROS 2's encodings (CDR), which Foxglove, Lichtblick, "
        "PlotJuggler and Rerun open without ROS 1. Every message is there; forecast, plan, state, posterior and "
        "errors also as standard messages, under the topic's own name. Layouts: "
        "src/prf_experiments/viewers.")
    parser.add_argument("bag")
    parser.add_argument("out", metavar="OUT.mcap")
    parser.add_argument("--robot", metavar="URDF", help="robot that the viewer draws; else the one of the trials")
    options = parser.parse_args(words)

    def action():
        if not options.out.endswith(".mcap"):
            raise ArgumentError(f"{options.out}: the file to write must end with .mcap, by which viewers know it")
        export = _libraries()
        line = session.ProgressLine()
        try:
            robot = _robot(options.robot, options.bag)
            with files.appearing(options.out) as stream:
                counts = export.export(
                    options.bag, stream, robot,
                    lambda share: line.show(f"exporting {options.bag}: {share:.0%}"))
        except (export.ExportError, UnicodeDecodeError) as error:
            raise session.SessionError(error) from None
        except OSError as error:
            name = options.robot if error.filename == options.robot else options.out
            raise session.SessionError(f"{name}: {error.strerror}") from None
        finally:
            line.close()
        print(f"{options.out}: {counts.messages} messages and {counts.added} beside them, "
              f"{len(counts.topics)} topics, {os.path.getsize(options.out) / 1e6:.1f} MB")
        for topic, reason in counts.alone.items():
            print(f"  no standard messages beside {topic}, which the bag defines otherwise: {reason}")
        return 0
    return session.guarded("export", action)
