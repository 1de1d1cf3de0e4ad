# SPDX-License-Identifier: BSD-3-Clause
"""What each part is worth: predictor x decision x planner x approach under heavy motion, stepping."""
from functools import partial

from prf_experiments.sweep import table
from prf_experiments.sweep.study import Study

AXES = {"predictor": ["periodic", "ukf", "constant_velocity", "hold"],
        "decision": ["hmm", "forward"], "planner": ["elte", "dmp"], "approach": [True, False]}
FIXED = {"motion": "heavy", "gait": "step"}

STUDY = Study("Ablation", table.MEANING, AXES, FIXED, partial(table.summarise, axes=tuple(AXES)), table.text,
              table.sections, conclude=table.conclusion)
