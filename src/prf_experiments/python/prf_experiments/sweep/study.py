# SPDX-License-Identifier: BSD-3-Clause
"""What all experiments share: axes, sweep, numbers as text, JSON and page."""
import argparse
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from prf_experiments import files
from prf_experiments.record import recording
from prf_experiments.report import page
from prf_experiments.report.page import Markup, Section
from prf_experiments.run import arguments as args
from prf_experiments.run import session, trial, trial_arguments
from prf_experiments.sweep import sweep

EXIT_OK, EXIT_INVALID, EXIT_VIOLATION = 0, 3, 4
FIRST_SEEDS = 3  # as many as the paper's trials of a cell


@dataclass(frozen=True)
class Study:
    """One experiment. `results` are the verdicts of all trials, in the order of the axes."""

    title: str
    meaning: str  # what the columns are, for the results page
    axes: dict  # {argument: values}, the seed is added as the last one
    fixed: dict  # {argument: value} that is not the default
    summarise: Callable  # results -> {key: ...}, goes into the JSON file
    text: Callable  # summary -> what the terminal shows
    sections: Callable  # summary, results, folder -> [Section] of the page
    seeds: int = FIRST_SEEDS
    keep_bags: str = "failed"
    may_be_invalid: Callable = lambda arguments: False  # where INVALID is what should come out
    conclude: Callable = lambda summary: ""  # summary -> one sentence for the page
    # options -> [{argument: value}]: what goes together, where the axes' product is not what is meant
    conditions: Callable = lambda options: [{}]


def trials(study: Study, options: argparse.Namespace) -> list[dict]:
    """The trials of a study as the options restrict or extend it."""
    axes = {**study.axes, "seed": list(range(1, (options.seeds or study.seeds) + 1))}
    values = {name: chosen for name, chosen in options.values.items() if name != "results"}
    fixed = {**args.parse([], trial_arguments.LAUNCHED), **study.fixed}
    unknown = (set(fixed) | set(axes)) - set(trial_arguments.LAUNCHED)
    if unknown:
        raise session.SessionError("this version's trials know no argument " + ", ".join(unknown))
    for name, chosen in values.items():
        if name in axes or len(chosen) > 1:
            axes[name] = chosen
        else:
            fixed[name] = chosen[0]
    found: list[dict] = []
    chosen = [values for condition in study.conditions(options)
              for values in sweep.product({**fixed, **condition}, axes)]
    told = ["scenario:="] if "scenario" in {**axes, **study.fixed, **values} else []
    for one in chosen:
        trial_values = trial_arguments.of_robot(trial_arguments.of_method(one), told)
        if trial_values not in found:  # method:=paper may make two of them the same
            found.append(trial_values)
    return found


def link(arguments: dict, folder: str = ".") -> str:
    """Relative address of a trial's report as seen from the study's page."""
    return os.path.relpath(
        os.path.join(sweep.trial_folder(folder, arguments), "report.html"), folder)


def verdict_link(result: dict) -> Markup:
    """A trial's verdict as a link to its report."""
    return page.render("verdict_link.html", result=result, address=link(result["arguments"]),
                       letter=letters([result]))


def verdict_links(results: list[dict]) -> Markup:
    """The verdicts of some trials, each a link."""
    return Markup(" ").join(map(verdict_link, results))


def letters(results: list[dict]) -> str:
    """The verdicts of some trials as one word."""
    return "".join("×" if result["verdict"] == "INVALID" else result["verdict"]
                   for result in results)


def read_bag(folder: str, result: dict) -> tuple[str, recording.Recording | None]:
    """(path, recording) of a trial's bag; the recording is None when the bag was not kept."""
    bag = os.path.join(sweep.trial_folder(folder, result["arguments"]), "trial.bag")
    try:
        return bag, recording.read(bag)
    except recording.RecordingError:
        return bag, None


def first_bag(folder: str, results: list[dict]) -> tuple[str, recording.Recording | None]:
    """(path, recording) of the first trial whose bag was kept, as `read_bag`."""
    for result in results:
        bag, data = read_bag(folder, result)
        if data is not None:
            return bag, data
    return "", None


def broken(result: dict) -> list[str]:
    """The invariants that did not hold in a trial."""
    return result.get("invariants", {}).get("violations", [])


NO_BAG = "Its bag is not there; keep it with --keep-bags all."


def cell(results: list[dict], **chosen: Any) -> list[dict]:
    """Those results whose arguments have the chosen values."""
    return [result for result in results
            if all(result["arguments"][name] == value for name, value in chosen.items())]


def values(results: list[dict], name: str) -> list:
    """Values of an argument in the order in which they occur."""
    return list(dict.fromkeys(result["arguments"][name] for result in results))


def write_page(path: str, study: Study, command: str, versions: dict, results: list[dict],
               summary: dict) -> None:
    """The page of a study; links are relative to its folder."""
    shared = {name: found[0] for name in trial_arguments.LAUNCHED
              if len(found := values(results, name)) == 1}

    def apart(arguments):
        return ", ".join(f"{name} {args.show(value) or 'none'}" for name, value in arguments.items()
                         if name in trial_arguments.LAUNCHED and name not in shared) or "the only one"
    took = sum(result.get("disk_bytes", 0) for result in results)
    sections = [
        *study.sections(summary, results, os.path.dirname(path)),
        Section("Trials", body=[page.table(
            [(verdict_link(result), apart(result["arguments"]), result["inspected"],
              "; ".join([result["reason"], *("INVARIANT BROKEN: " + text
                                             for text in broken(result))]),
              result.get("cause", ""))
             for result in results],
            ("verdict", "trial", "inspected", "reason", "why"))]),
        Section("Arguments that all trials share, and versions", body=[page.table(
            [*((name, args.show(value) or "none") for name, value in shared.items()), *versions.items(),
             ("disk, MB", took / sweep.MEGABYTE)])])]
    files.write(path, page.whole("study.html", title=study.title, command=command,
                                 conclusion=study.conclude(summary), text=study.text(summary),
                                 sections=sections))


def reproducing(options: argparse.Namespace, named: Sequence[str]) -> str:
    """The command with what its numbers depend on, and nothing else."""
    chosen = [f"--seeds {options.seeds}"] if options.seeds else []
    for name in ("family", "levels"):
        if given := getattr(options, name, None):
            chosen.append(f"--{name} " + ",".join(f"{one:g}" if name == "levels" else one for one in given))
    return " ".join(["./run_experiment", options.experiment, *chosen,
                     *(word for word in named if not word.startswith("results:="))])


def results_page(study: Study, command: str, text: str) -> str:
    """The table as the terminal shows it, for docs/results. The same numbers give the same page."""
    return f"# {study.title}\n\n{study.meaning}\n\n```\n{command}\n```\n\n```text\n{text}```\n"


def run(study: Study, options: argparse.Namespace, command: str, named: Sequence[str]) -> int:
    """Runs the trials, writes and prints their numbers. Returns the exit code."""
    folder = os.path.join(options.values.get("results", [os.path.abspath("results")])[0],
                          options.name)
    versions = trial.versions()
    chosen = sweep.SweepParams(options.jobs, options.keep_bags or study.keep_bags,
                               options.scheduler, options.any_version)
    results = sweep.run(trials(study, options), folder, chosen, versions)
    summary = {"command": command, "versions": versions, **study.summarise(results),
               "trials": [{**result, "report": link(result["arguments"])} for result in results]}
    for path in filter(None, (os.path.join(folder, "summary.json"), options.json)):
        files.write_json(path, summary)
    if options.results_page:
        files.write(options.results_page,
                    results_page(study, reproducing(options, named), study.text(summary)))
    index = os.path.join(folder, "index.html")
    session.waiting("drawing the page")
    write_page(index, study, command, versions, results, summary)
    session.waiting("")
    print(study.text(summary) + "\n" + index)
    if any(result["verdict"] == "INVALID" and not study.may_be_invalid(result["arguments"])
           for result in results):
        return EXIT_INVALID
    return EXIT_VIOLATION if any(broken(result) for result in results) else EXIT_OK


def main(study: Study, options: argparse.Namespace, command: str, named: Sequence[str]) -> int:
    return session.guarded("run_experiment", lambda: run(study, options, command, named))
