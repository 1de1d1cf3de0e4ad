# SPDX-License-Identifier: BSD-3-Clause
"""Made-up verdicts of trials, as sweeps give them to the tables."""
from prf_experiments.run import arguments as args
from prf_experiments.run import trial_arguments

DEFAULTS = args.parse([], trial_arguments.LAUNCHED)


def result(verdict="S", inspected=True, figures=None, **arguments):
    return {"verdict": verdict, "inspected": inspected, "reason": "made <up>",
            "figures": figures or {}, "arguments": {**DEFAULTS, **arguments},
            "failed_attempts": [], "disk_bytes": 1_000_000}
