# SPDX-License-Identifier: BSD-3-Clause
"""What forecast_error and consistency share: motions, and predictors that track them."""
import argparse
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile

import roslib.packages
import rospkg
import yaml

PREDICTOR, PACKAGE = "prf_predictor", "prf_studies"
SIMULATOR, RECORDER = "platform_sim", "record_motion"
MOTIONS, GAITS = ["none", "light", "heavy"], ["stand", "step"]
HORIZONS_S = [0.1, 0.25, 0.5, 1.0, 2.0]
COLUMNS = "time,tag_x,tag_y,tag_z"
EXIT_USAGE = 2


class EvaluationError(Exception):
    """Something that ends the command with one line."""


def config_file(*parts):
    return os.path.join(rospkg.RosPack().get_path(PREDICTOR), "config", *parts)


def predictor_file(name):
    return config_file("predictors", name + ".yaml")


def write_variant(folder, label, predictor, *changes):
    """File of a predictor with some parameters changed, each NAME=VALUE."""
    with open(predictor_file(predictor), encoding="utf-8") as file:
        values = yaml.safe_load(file)
    for change in changes:
        name, _, value = change.partition("=")
        if name not in values:
            raise EvaluationError(f"--variant {label}: {predictor} has no parameter {name}")
        try:
            values[name] = float(value)
        except ValueError:
            raise EvaluationError(f"--variant {label}: {change}, must be {name}=NUMBER") from None
    path = os.path.join(folder, label)
    with open(path, "w", encoding="utf-8") as file:
        yaml.safe_dump(values, file)
    return path


def predictor_names():
    folder = os.path.dirname(predictor_file(""))
    return sorted(name[:-len(".yaml")] for name in os.listdir(folder) if name.endswith(".yaml"))


def executable(package, name, why=""):
    try:
        found = roslib.packages.find_node(package, name)
    except rospkg.ResourceNotFound:
        found = []
    if not found:
        raise EvaluationError(f"{package}/{name} is not built{why}")
    return found[0]


class Progress:
    """One line on a terminal that says how far it is; nothing elsewhere."""

    def __init__(self, label, total):
        self.label, self.total, self.done = label, total, 0

    def step(self):
        self.done += 1
        if sys.stderr.isatty():
            end = "\n" if self.done == self.total else ""
            print(f"\r{self.label} {self.done}/{self.total}", end=end, file=sys.stderr, flush=True)


def side_by_side(function, tasks, label, jobs):
    """Results of function(*task), in the order of the tasks, on `jobs` cores."""
    progress = Progress(label, len(tasks))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        def run(task):
            result = function(*task)
            progress.step()
            return result
        return list(pool.map(run, tasks))


def run(words):
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        raise EvaluationError((done.stderr.strip() or f"{words[0]} failed").splitlines()[-1])
    return done.stdout


def record(folder, motion, gait, seed, duration):
    """File of the simulated motion, made anew when the simulator is newer. None: the robot fell."""
    recorder = executable(SIMULATOR, RECORDER, "; give recorded motions with --csv")
    path = os.path.join(folder, f"{motion}_{gait}_{seed}_{duration:g}s.csv")
    if os.path.exists(path) and os.path.getmtime(path) > os.path.getmtime(recorder):
        return path
    part = path + ".part"
    run([recorder, "--motion", motion, "--gait", gait, "--seed", str(seed),
         "--duration", f"{duration:g}", "--out", part])
    os.replace(part, path)
    return path


def track(predictor, files, options, columns=COLUMNS):
    """One dictionary of figures for each (seed, file), by the predictor of this file."""
    words = [executable(PACKAGE, "evaluate_predictor"), config_file("target_predictor.yaml"),
             predictor, *(file for _, file in files),
             f"--warm-up={options.warm_up}", f"--latency={options.latency}",
             "--horizons=" + ",".join(map(str, HORIZONS_S)), f"--columns={columns}",
             "--seeds=" + ",".join(str(seed) for seed, _ in files)]
    return [json.loads(line) for line in run(words).splitlines()]


def evaluate(options, variants=()):
    """{(condition, predictor): figures}; a condition is "heavy, step" or a file's name. `variants`:
    a label, a predictor and its changed parameters each."""
    with tempfile.TemporaryDirectory() as folder:
        predictors = {name: predictor_file(name) for name in options.predictors}
        for label, *changes in variants:
            predictors[label] = write_variant(folder, label, *changes)
        return evaluate_files(options, predictors)


def evaluate_files(options, predictors):
    if options.csv:
        conditions = {os.path.basename(path): [(1, path)] for path in options.csv}
        columns = options.columns
    else:
        os.makedirs(options.motions_folder, exist_ok=True)
        chosen = [(m, g, s) for m in options.motions for g in options.gaits
                  for s in range(1, options.seeds + 1)]
        paths = side_by_side(record, [(options.motions_folder, *c, options.duration)
                                      for c in chosen], "motions", options.jobs)
        conditions = {}
        for (motion, gait, seed), path in zip(chosen, paths):
            conditions.setdefault(f"{motion}, {gait}", []).append((seed, path))
        columns = COLUMNS
    # Slow predictors on few files each, so that all cores end together.
    tasks = [(predictor, [file], options, columns) for files in conditions.values()
             for predictor in predictors.values() for file in files]
    results = iter(side_by_side(track, tasks, "forecasts", options.jobs))
    figures = {}
    for condition, files in conditions.items():
        for name in predictors:
            figures[condition, name] = [one for _ in files for one in next(results)]
            if not any(sum(one["count"]) for one in figures[condition, name]):
                raise EvaluationError(f"{condition}: no forecast counts, the motion must be longer than --warm-up "
                                      f"{options.warm_up:g} s and the horizons, and its rows dense")
    return figures


def parser(name, description):
    result = argparse.ArgumentParser(prog=name, description=description, allow_abbrev=False)
    result.add_argument("--seeds", type=int, default=20, help="simulated motions 1 .. SEEDS")
    result.add_argument("--duration", type=float, default=40.0, help="of each, s")
    result.add_argument("--motions", nargs="+", choices=MOTIONS, default=MOTIONS)
    result.add_argument("--gaits", nargs="+", choices=GAITS, default=GAITS)
    result.add_argument("--csv", nargs="+", metavar="FILE",
                        help="recorded motions instead of simulated ones")
    result.add_argument("--columns", default=COLUMNS,
                        help="names of time (s), x, y and z (m) in these files")
    result.add_argument("--warm-up", type=float, default=3.0,
                        help="s seen before forecasts count")
    result.add_argument("--latency", type=float, default=0.04,
                        help="s between image and forecast; horizons count from the latter")
    result.add_argument("--motions-folder", metavar="FOLDER",
                        default=os.path.expanduser("~/.cache/prf_studies/motions"),
                        help="keeps simulated motions")
    result.add_argument("--jobs", type=int, default=os.cpu_count())
    result.add_argument("--json", metavar="FILE", help="write the table as JSON")
    return result


def check(options, cli):
    if options.seeds < 1 or options.jobs < 1:
        cli.error("--seeds and --jobs must be >= 1")
    if not 0 <= options.warm_up < options.duration:
        cli.error("--warm-up must be >= 0 and less than --duration")
    if not 0 <= options.latency <= 1:
        cli.error("--latency must be 0 .. 1")
    for path in [] if not options.csv else options.csv:
        if not os.path.isfile(path):
            cli.error(f"{path} is no file")


def finish(options, content):
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(content, file, indent=1)
            file.write("\n")


def guarded(main):
    """Exit code of main(); an EvaluationError becomes one line."""
    try:
        return main() or 0
    except (EvaluationError, OSError) as error:
        print(error, file=sys.stderr)
        return EXIT_USAGE
