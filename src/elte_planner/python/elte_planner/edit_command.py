# SPDX-License-Identifier: BSD-3-Clause
"""Edit demonstrated trajectories by ELTE, from the shell.

  elte_edit demo.csv --end 0.4 0.1 0.3 --radius 0.02 --executed 30 --out plan.csv --plot plan.png
  elte_edit first.csv second.csv --thin 0.002 --sphere 0.5 0 0.3 0.05 --clearance 0.03
  elte_edit demo.bag --topic hand_pose --end 0.4 0.1 0.3
  elte_edit --problem problem.json --out solution.json

Several demonstrations are combined to their mean. Exit code 1: no plan was found.
"""
import argparse
import sys

import numpy as np

import elte_planner
from elte_planner import problem_json


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"elte_edit: {message}\n")


def arguments():
    parser = Parser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demonstrations", nargs="*", metavar="DEMO",
                        help="CSV files of timed poses, or bags")
    parser.add_argument("--problem", help="JSON file with one or many problems, see elte_planner.problem_json")
    parser.add_argument("--out", help="plan as CSV (time,x,y,z) or solutions as JSON")
    parser.add_argument("--plot", help="PNG of demonstrations and plan")
    bags = parser.add_argument_group("bags")
    bags.add_argument("--topic", help="PoseStamped of the hand, or SkillTrajectory (last plan)")
    bags.add_argument("--target-topic", help="PoseStamped of the target (default: it is where the "
                                             "demonstration ends)")
    nodes = parser.add_argument_group("nodes").add_mutually_exclusive_group()
    nodes.add_argument("--nodes", type=int, metavar="N",
                       help="resample by arc length (default: 50)")
    nodes.add_argument("--thin", type=float, metavar="TOLERANCE",
                       help="by Douglas-Peucker, until a sample would be farther than this, m")
    nodes.add_argument("--thin-to", type=int, metavar="N", help="N nodes by Douglas-Peucker")
    parser.add_argument("--align", default="arc_length",
                        help="of several: arc_length (default) or dynamic_time_warping")
    plan = parser.add_argument_group("plan")
    plan.add_argument("--end", nargs=3, type=float, metavar=("X", "Y", "Z"),
                      help="where the last node shall be, m (default: as demonstrated)")
    plan.add_argument("--radius", type=float, default=0.0, help="of the end's l1 ball, m")
    plan.add_argument("--executed", type=int, default=2, help="leading nodes to keep, >= 2")
    plan.add_argument("--max-step", type=float, default=float("inf"),
                      help="greatest l1 distance of consecutive nodes, m")
    plan.add_argument("--planner", default="elte", help=", ".join(elte_planner.planner_names()))
    plan.add_argument("--w-elastic", type=float, default=0.001)
    plan.add_argument("--w-bending", type=float, default=0.001)
    around = parser.add_argument_group("obstacles, kept at a distance by the whole polyline")
    around.add_argument("--sphere", nargs=4, type=float, action="append", default=[],
                        metavar=("X", "Y", "Z", "R"), help="may be repeated, m")
    around.add_argument("--box", nargs=6, type=float, action="append", default=[],
                        metavar=("X", "Y", "Z", "HX", "HY", "HZ"),
                        help="centre and half widths, may be repeated, m")
    around.add_argument("--clearance", type=float, help="to keep from them, m")
    options = parser.parse_args()
    if bool(options.demonstrations) == (options.problem is not None):
        parser.error("give either demonstrations or --problem")
    if (options.clearance is not None) != bool(options.sphere or options.box):
        parser.error("--clearance belongs to --sphere or --box")
    if options.clearance is not None and options.planner != "elte":
        parser.error(f"obstacles need --planner elte, not {options.planner}")
    return options


def load(path, options):
    if not path.endswith(".bag"):
        return elte_planner.load_demonstration(path)
    if options.topic is None:
        raise ValueError(f"{path}: a bag needs --topic")
    return elte_planner.load_bag(path, options.topic, options.target_topic)


def fitted(demonstrations, options):
    """The planner of what was given."""
    count = 50 if options.nodes is None else options.nodes
    if not 3 <= count <= 100000:
        raise ValueError(f"nodes is {count}, must be within [3, 100000]")
    if options.thin_to is not None:
        longest = max(len(d.times) for d in demonstrations)
        one = demonstrations[0] if len(demonstrations) == 1 else \
            elte_planner.combine(demonstrations, longest, alignment=options.align)
        demonstrations, count = [one.resampled_by_douglas_peucker(options.thin_to)], None
    return elte_planner.Planner(
        options.planner, w_elastic=options.w_elastic, w_bending=options.w_bending,
        max_step=options.max_step).fit(demonstrations, nodes=count, thin=options.thin, alignment=options.align)


def edit_demonstrations(options):
    demonstrations = [load(path, options) for path in options.demonstrations]
    planner = fitted(demonstrations, options)
    obstacles = [elte_planner.disc_obstacle(np.array(s[:3]), s[3]) for s in options.sphere]
    obstacles += [elte_planner.box_obstacle(np.array(b[:3]), np.array(b[3:])) for b in options.box]
    plan = planner.plan(options.end, frozen=options.executed, obstacles=obstacles,
                        clearance=options.clearance, radius=options.radius)
    if not plan.found:
        print(f"elte_edit: {plan.status}: {plan.message}", file=sys.stderr)
        return 1
    detail = f"clearance {plan.clearance:.6g} m" if obstacles else f"slack {plan.slack:.3g} m"
    loss = planner.shape_loss
    if loss > 0.5:
        print(f"elte_edit: warning: w_elastic {options.w_elastic} costs {100 * loss:.0f} % of the "
              f"shape of {len(plan.positions)} nodes without any editing", file=sys.stderr)
    if options.out:
        np.savetxt(options.out, np.column_stack([plan.times, plan.positions]), delimiter=",",
                   header="time,x,y,z", comments="", fmt="%.17g")
    if options.plot:
        plot(plan, [d.positions for d in demonstrations], options.plot)
    print(f"{plan.status}: {len(plan.positions)} nodes, end {plan.end_error:.3g} m from the goal "
          f"(l1), {detail}")
    return 0


def plot(plan, demonstrations, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    from elte_planner import plotting
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained")
    for axis, dims in zip(axes, ((0, 1), (0, 2))):
        plotting.draw(plan, axis, demonstrations=demonstrations, dims=dims)
    figure.savefig(path, dpi=150)


def solve_problems(options):
    with open(options.problem, encoding="utf-8") as file:
        text = problem_json.solve_text(file.read())
    if options.out:
        with open(options.out, "w", encoding="utf-8") as file:
            file.write(text + "\n")
    else:
        print(text)
    return 0


def main():
    options = arguments()
    try:
        return solve_problems(options) if options.problem is not None else \
            edit_demonstrations(options)
    except (ValueError, TypeError, OSError, ImportError, RecursionError) as error:
        line = str(error).replace("\n", " ")
        print(f"elte_edit: {line}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
