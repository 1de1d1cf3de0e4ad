# SPDX-License-Identifier: BSD-3-Clause
"""Statistics of trials: intervals of rates, and comparisons paired by seed."""
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.stats


def wilson(successes: int, trials: int) -> tuple[float, float]:
    """(low, high) of a rate: Wilson's 95 % score interval; (0, 1) when there was no trial."""
    if not 0 <= successes <= trials:
        raise ValueError(f"successes = {successes}, must be in 0..{trials}")
    if trials == 0:
        return 0.0, 1.0
    found = scipy.stats.binomtest(successes, trials).proportion_ci(0.95, "wilson")
    return float(found.low), float(found.high)


@dataclass(frozen=True)
class Spread:
    """Mean and standard deviation (n - 1) of n numbers; None where they are not defined."""

    count: int
    mean: float | None = None
    deviation: float | None = None


def spread(values: Sequence[float | None]) -> Spread:
    known = np.array([value for value in values if value is not None], dtype=float)
    return Spread(len(known), float(known.mean()) if len(known) else None,
                  float(known.std(ddof=1)) if len(known) > 1 else None)


@dataclass(frozen=True)
class Paired:
    """first - second over the pairs that have both; p-values are two-sided, None below 2 pairs."""

    count: int
    difference: Spread
    t_p: float | None = None
    wilcoxon_p: float | None = None


def paired(first: Sequence[float | None], second: Sequence[float | None]) -> Paired:
    """Paired t-test and Wilcoxon's signed-rank test of two series; None marks a missing number."""
    if len(first) != len(second):
        raise ValueError(f"{len(first)} and {len(second)} numbers, must be pairs")
    pairs = np.array([pair for pair in zip(first, second) if None not in pair], dtype=float)
    if len(pairs) < 2:
        return Paired(len(pairs), spread(pairs[:, 0] - pairs[:, 1] if len(pairs) else []))
    differences = pairs[:, 0] - pairs[:, 1]
    if not np.any(differences):
        return Paired(len(pairs), spread(differences), 1.0, 1.0)
    if np.ptp(differences) == 0.0:  # the t statistic is infinite
        t_p = 0.0
    else:
        t_p = float(scipy.stats.ttest_rel(pairs[:, 0], pairs[:, 1]).pvalue)
    return Paired(len(pairs), spread(differences), t_p,
                  float(scipy.stats.wilcoxon(differences).pvalue))
