# SPDX-License-Identifier: BSD-3-Clause
"""The experiments by name: one trial, or a sweep of trials with its table and page.

Imports no ROS at the top: `--check` refuses bad arguments before anything is set up or built.
"""
import argparse
import importlib
import os
import sys
from collections.abc import Sequence

from prf_experiments.run import arguments as args
from prf_experiments.run import trial_arguments
from prf_experiments.sweep import severity

EXIT_OK, EXIT_USAGE, EXIT_INVALID = 0, 2, 3
STUDIES = {
    "table": "verdicts over motion, gait and framework on or off, as the paper's table of trials",
    "compare": "distances of ELTE, DMP, LTE and elastic maps, stepping, paired by seed",
    "ablate": "predictor, decision, planner and approach under heavy motion, stepping",
    "cart": "the box is pushed aside during the execution",
    "obstacles": "a post in the way of the demonstrated path, heeded or not",
    "faults": "every fault injected, standing and stepping: verdict, time to hold and to recover",
    "limits": "families of worlds with rising severity: where the framework breaks, and its parts",
    "robots": "the same skill with other arms, on legs and bolted to the deck",
    "reactive": "target measured, forecast and true, posterior and phase; light motion, stepping",
}
SOAK = ("executions again and again under heavy motion, stepping, with faults at random: memory, "
        "recoveries, drift")
SWEEP_ARGUMENTS = {**trial_arguments.LAUNCHED, **trial_arguments.RESULTS}


def families(text: str) -> list[str]:
    unknown = [name for name in text.split(",") if name not in severity.LEVELS]
    if unknown:
        guess = args.meant(unknown[0], *severity.LEVELS)
        raise argparse.ArgumentTypeError(f"'{unknown[0]}' is no family{guess}; valid: {', '.join(severity.LEVELS)}")
    return text.split(",")


def levels(text: str) -> list[float]:
    try:
        found = [float(word) for word in text.split(",")]
    except ValueError:
        found = [-1.0]
    if not all(0.0 <= level <= 200.0 for level in found):
        raise argparse.ArgumentTypeError(f"'{text}' must be levels 0 .. 200 with commas between, as 0.5,1,2")
    return found


def positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' must be a whole number, at least 1")
    return int(text)


def hours(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.02 <= value <= 24.0:
        raise argparse.ArgumentTypeError(f"'{text}' must be 0.02 .. 24 hours")
    return value


def plain_name(text: str) -> str:
    if not text or text != os.path.basename(text) or text.startswith("."):
        raise argparse.ArgumentTypeError(f"'{text}' must be the plain name of a folder, without / and not "
                                         "beginning with a dot")
    return text


def address(text: str) -> str:
    protocol, separator, place = text.partition("://")
    if not (protocol and separator and place):
        raise argparse.ArgumentTypeError(f"'{text}' must be an address, as tcp://host:8786")
    return text


def parser() -> args.Parser:
    result = args.Parser(
        prog="run_experiment", formatter_class=argparse.RawDescriptionHelpFormatter,
        usage="run_experiment [EXPERIMENT [--option ...]] [name:=value ...]",
        description="Without EXPERIMENT: one trial.",
        epilog="arguments of trials [default]; sweeps take lists, as in motion:=light,heavy:\n"
        + trial_arguments.usage())
    commands = result.add_subparsers(dest="experiment", metavar="EXPERIMENT")
    commands.add_parser("trial", help="one trial, as without any experiment")
    soak = commands.add_parser("soak", prog="run_experiment soak", help=SOAK, description=SOAK)
    soak.add_argument("--hours", type=hours, default=1.0, metavar="H", help="simulated [1]")
    soak.add_argument("--seed", type=positive, default=1, metavar="N", help="[1]")
    soak.add_argument("--keep-bag", action="store_true", help="it is large; kept anyway when something is not right")
    soak.add_argument("--json", metavar="FILE", help="writes the numbers there too")
    soak.add_argument("--results-page", metavar="FILE.md", help="writes the table there")
    for name, meaning in STUDIES.items():
        sweep = commands.add_parser(name, prog=f"run_experiment {name}", help=meaning,
                                    description=meaning,
                                    usage="%(prog)s [--option ...] [name:=value ...]")
        sweep.add_argument("--seeds", type=positive, metavar="N", help="seeds 1..N of each cell")
        sweep.add_argument("--jobs", type=positive, metavar="N", default=default_jobs(),
                           help="trials side by side on this machine [%(default)s]")
        sweep.add_argument("--keep-bags", choices=("failed", "all", "none"),
                           help="failed: of every trial that is not S [failed; reactive and cart: "
                           "all]")
        sweep.add_argument("--scheduler", type=address, metavar="ADDRESS",
                           help="sends the trials to a Dask cluster, as tcp://host:8786")
        sweep.add_argument("--name", type=plain_name, default=name, metavar="NAME",
                           help="folder in the results folder; the same name resumes [%(default)s]")
        sweep.add_argument("--any-version", action="store_true",
                           help="resumes also what another version of the code began")
        sweep.add_argument("--json", metavar="FILE", help="writes the numbers there too")
        sweep.add_argument("--results-page", metavar="FILE.md",
                           help="writes the table there with the command that gives it")
        if name == "limits":
            sweep.add_argument("--family", type=families, metavar="NAME,...",
                               help="[heavy,sea,bursts,cart,push]; or stop, cart_toward, push_hand, push_body, "
                               "stumble, occlude, dark")
            sweep.add_argument("--levels", type=levels, metavar="L,...",
                               help="of every family, in place of each one's own")
    return result


def default_jobs() -> int:
    """One more than there are processors: while it runs a trial uses about one, since its nodes take
    turns, and next to nothing while it starts and ends."""
    return len(os.sched_getaffinity(0)) + 1


def refuse_unknown(words: Sequence[str], experiment: str | None) -> None:
    """Raises ArgumentError for words that argparse left; `--seed 3` is `seed:=3` in another form."""
    name, separator, text = words[0].lstrip("-").partition("=")
    text = text if separator else " ".join(words[1:2])
    guesses = [f"{name}:={text}"] if name in SWEEP_ARGUMENTS else []
    if experiment in STUDIES and words[0].startswith("--"):
        near = args.meant(words[0], "--seeds", "--jobs", "--keep-bags", "--scheduler", "--name",
                          "--any-version", "--json", "--results-page", "--family", "--levels")
        guesses += [near[len("; did you mean "):-1] + (f" {text}" if text else "")] if near else []
    guess = f"; did you mean {' or '.join(guesses)}?" if guesses else args.meant(name, *SWEEP_ARGUMENTS)
    raise args.ArgumentError(f"unknown option {words[0]}{guess} (--help lists them)")


def parse(words: Sequence[str]) -> tuple[argparse.Namespace, list[str]]:
    """(options, name:=value words); raises ArgumentError or, from argparse, SystemExit."""
    named = [word for word in words if ":=" in word]
    for word in words:
        if (("=" in word and not word.startswith("-")) or word in SWEEP_ARGUMENTS) and word not in named:
            args.named_value(word, SWEEP_ARGUMENTS)  # says what was meant
    if words and words[0].startswith("--") and words[0] != "--help":
        refuse_unknown(words, None)
    options, unknown = parser().parse_known_args([word for word in words if ":=" not in word])
    if unknown:
        refuse_unknown(unknown, options.experiment)
    if options.experiment == "soak":
        options.results = args.parse(named, trial_arguments.RESULTS)["results"]
    elif options.experiment in STUDIES:
        options.values = args.parse_lists(named, SWEEP_ARGUMENTS)
        if options.seeds and "seed" in options.values:
            raise args.ArgumentError("--seeds and seed:= say the same, give one of them")
        if len(options.values.get("results", [""])) > 1:
            raise args.ArgumentError("results:= has several folders, must be one folder")
    else:
        options.values = trial_arguments.complete(args.parse(named, trial_arguments.TRIAL), named)
    return options, named


def main(words: list[str]) -> int:
    check = "--check" in words
    words = [word for word in words if word != "--check"]
    try:
        options, named = parse(words)
    except args.ArgumentError as error:
        print(f"run_experiment: {error}", file=sys.stderr)
        return EXIT_USAGE
    if check:
        return EXIT_OK
    if options.experiment in STUDIES:
        from prf_experiments.sweep import study
        described = importlib.import_module("prf_experiments.sweep." + options.experiment).STUDY
        shown = [word for word in words if not word.startswith("results:=")]
        return study.main(described, options, "./run_experiment " + " ".join(shown), named)
    if options.experiment == "soak":
        from prf_experiments.soak import soak
        return soak.main(options)
    from prf_experiments.run import trial
    return trial.main(named)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
