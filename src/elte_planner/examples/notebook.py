# SPDX-License-Identifier: BSD-3-Clause
"""ELTE in cells, to be run as a script or cell by cell in an editor that knows `# %%`."""
# %% A demonstration: (T, d) positions, here a drawn wave of 50 nodes in the plane.
import numpy as np

import elte_planner

s = np.linspace(0.0, 1.0, 50)
zeta = np.column_stack([s, 0.2 * np.sin(2.0 * np.pi * s)])

# %% Half of it is executed, the rest shall end elsewhere, within 2 cm.
executed = 25
goal = zeta[-1] + [0.1, 0.15]
solver = elte_planner.EndpointSolver(zeta)
plan = solver.solve(zeta, executed, goal, radius=0.02)
print("end missed by", np.abs(plan[-1] - goal).sum())
assert np.array_equal(plan[:executed], zeta[:executed])

# %% Any constraints: through a window at node 35, and what that costs.
constraints = [elte_planner.equality(49, goal),
               elte_planner.box(35, np.array([0.7, -0.05]), np.array([np.inf, 0.02]))]
solution = elte_planner.solve(zeta, constraints, zeta[:executed])
print(solution.status, "energy", solution.energy, "forces", solution.forces, sep="\n")
assert solution.status == "solved"

# %% How uncertain the goal is decides how large its ball may be.
radius = elte_planner.confidence_radius(np.diag([1e-4, 4e-4]), 0.9)
print("l1 ball that holds 90 %:", radius)

# %% Around an obstacle, the whole polyline.
obstacles = [elte_planner.disc_obstacle(np.array([0.75, -0.1]), 0.05)]
around = elte_planner.avoid(zeta, obstacles, 0.02, constraints[:1], zeta[:executed])
print(around.status, "clearance", around.clearance)
assert around.clearance >= 0.02 - 1e-12

# %% The rivals, on the same demonstration, and all of the above behind one class.
for name in elte_planner.planner_names():
    rival = elte_planner.Planner(name).fit(zeta).plan(goal, frozen=executed)
    print(f"{name:12} {rival.status:8} end missed by {rival.end_error:.3g}")
