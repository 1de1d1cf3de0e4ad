# SPDX-License-Identifier: BSD-3-Clause
"""Problems and solutions of elte_planner.solve() and avoid() as JSON.

A problem is an object, a list of them, or {"problems": [...]}:

  zeta                      demonstration, T rows of d numbers
  wE, wR                    weights of the squared first and second differences
  laplacian                 free_ends (default, also authors) or row_normalised
  n_fixed, y_fixed          number of leading rows that are given, and these rows (default none)
  constraints               list of {"j": node, "p": [...], "r": radius}     l1 ball, 0: equality
                            {"j", "p", "half_widths": [...]}                 box
                            {"j", "p", "normal": [...]}                      normal . (y_j - p) <= 0
  max_step, max_first_step  optional bounds on the l1 norm of the steps
  obstacles, clearance      optional list of {"centre": [...], "radius": r} and
                            {"centre", "half_widths": [...]}; the polyline keeps the clearance

A solution has name, status (solved, infeasible, ill_posed, iteration_limit; with obstacles also
not_found), message, y, objective, kkt_residual, solve_time_s, and forces and active of the
constraints or, with obstacles, the clearance found.
"""
import json
import time

import numpy as np

import elte_planner


def solve_text(text):
    """The solutions, as JSON, of the problems in a JSON text. Raises ValueError or TypeError with one
    line of reason, RecursionError for a text nested too deep."""
    content = json.loads(text)
    if isinstance(content, dict) and "problems" in content:
        content = content["problems"]
    many = isinstance(content, list)
    solutions = [_solve(problem) for problem in (content if many else [content])]
    return json.dumps({"problems": solutions} if many else solutions[0], allow_nan=False)


def _array(value, what, rows=False):
    array = np.array(value, dtype=float)
    if array.ndim != (2 if rows else 1):
        raise ValueError(f"{what} must be a list of " +
                         ("rows of equal length" if rows else "numbers"))
    return array


def _lacking(error, what):
    return ValueError(f"{what} lacks {error}")


def _constraint(entry, index):
    what = f"constraint {index}"
    if not isinstance(entry, dict):
        raise ValueError(f"{what} must be an object")
    try:
        node = entry["j"]
        if isinstance(node, bool) or not isinstance(node, int):
            raise ValueError(f"{what}: j is {node!r:.60}, must be a whole number")
        point = _array(entry["p"], f"{what}: p")
        if "half_widths" in entry:
            return elte_planner.box(node, point, _array(entry["half_widths"],
                                                        f"{what}: half_widths"))
        if "normal" in entry:
            return elte_planner.half_space(node, point, _array(entry["normal"], f"{what}: normal"))
        return elte_planner.ball(node, point, float(entry["r"]))
    except KeyError as error:
        raise _lacking(error, what) from None


def _obstacle(entry, index):
    what = f"obstacle {index}"
    if not isinstance(entry, dict):
        raise ValueError(f"{what} must be an object")
    try:
        centre = _array(entry["centre"], f"{what}: centre")
        if "half_widths" in entry:
            return elte_planner.box_obstacle(centre, _array(entry["half_widths"],
                                                            f"{what}: half_widths"))
        return elte_planner.disc_obstacle(centre, float(entry["radius"]))
    except KeyError as error:
        raise _lacking(error, what) from None


def _fixed(problem, dimensions):
    count = problem.get("n_fixed", 0)
    if isinstance(count, bool) or not isinstance(count, int) or count < 0:
        raise ValueError(f"n_fixed is {count!r:.60}, must be a whole number, at least 0")
    fixed = np.array(problem.get("y_fixed") or [], dtype=float).reshape(-1, dimensions)
    if len(fixed) != count:
        raise ValueError(f"y_fixed has {len(fixed)} rows, n_fixed is {count}")
    return fixed


def _solve(problem):
    if not isinstance(problem, dict):
        raise ValueError(f"a problem is {problem!r:.60}, must be an object")
    for key in ("zeta", "wE", "wR"):
        if key not in problem:
            raise ValueError(f"the problem lacks '{key}'")
    zeta = _array(problem["zeta"], "zeta", rows=True)
    laplacian = problem.get("laplacian", "free_ends")
    constraints = [_constraint(c, i) for i, c in enumerate(problem.get("constraints", []))]
    obstacles = [_obstacle(o, i) for i, o in enumerate(problem.get("obstacles", []))]
    given = {
        "constraints": constraints, "fixed": _fixed(problem, zeta.shape[1]),
        "w_elastic": float(problem["wE"]), "w_bending": float(problem["wR"]),
        "laplacian": "free_ends" if laplacian == "authors" else laplacian,
        "max_step": float(problem.get("max_step", "inf")),
        "max_first_step": float(problem.get("max_first_step", "inf"))}
    if obstacles and "clearance" not in problem:
        raise ValueError("the problem has obstacles and lacks 'clearance'")
    start = time.perf_counter()
    solution: elte_planner.Solution | elte_planner.AvoidanceSolution
    if obstacles:
        solution = elte_planner.avoid(zeta, obstacles, float(problem["clearance"]), **given)
    else:
        solution = elte_planner.solve(zeta, **given)
    seconds = time.perf_counter() - start
    solved = solution.status == "solved"
    result = {
        "name": problem.get("name", ""),
        "status": solution.status,
        "message": solution.message,
        "y": solution.y.tolist() if solved else None,
        "objective": solution.energy if solved else None,
        "kkt_residual": solution.kkt_residual if solved else None}
    if isinstance(solution, elte_planner.AvoidanceSolution):
        result["clearance"] = solution.clearance if solved else None
    else:
        result["forces"] = solution.forces.tolist() if solved else None
        result["active"] = solution.active
    result["solve_time_s"] = seconds
    return result
