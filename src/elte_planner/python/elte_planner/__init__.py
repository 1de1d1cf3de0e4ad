# SPDX-License-Identifier: BSD-3-Clause
"""Elastic Laplacian trajectory editing: numpy in, numpy out. Rows are nodes."""
from elte_planner._core import *  # noqa: F403
from elte_planner.bag import load_bag  # noqa: F401
