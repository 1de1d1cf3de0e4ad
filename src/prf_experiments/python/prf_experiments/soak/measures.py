# SPDX-License-Identifier: BSD-3-Clause
"""What a long run shows: memory of each node, recoveries, drift of the estimate."""
from collections.abc import Sequence

import numpy as np

from prf_experiments.judge import judge, reaction, target
from prf_experiments.record.recording import Recording

Sample = tuple[float, float]  # s of data, MB
SETTLED = 0.2  # share of the samples in which a node still fills its buffers
GROWTH = 4.0  # MB/h that do not count as growth, beside a hundredth of the memory an hour
KEEPERS = ("recorder",)  # keeps an index entry for every message until the bag is closed
RECOVERY = 15.0  # s within which the execution must go on again after a fault


def growth(samples: Sequence[Sample]) -> float | None:
    """Slope of a straight line through the samples after the first ones, MB/h."""
    kept = np.array(samples[int(SETTLED * len(samples)):])
    if len(kept) < 4 or np.ptp(kept[:, 0]) <= 0.0:
        return None
    return 3600.0 * float(np.polyfit(kept[:, 0], kept[:, 1], 1)[0])


def memory(samples: dict[str, list[tuple[float, float, int]]]) -> list[dict]:
    """One row a node of samples (s, MB, process id): only those of its longest life count."""
    rows = []
    for node, found in sorted(samples.items()):
        lives = [pid for _, _, pid in found]
        longest = max(set(lives), key=lives.count)
        series = [(seconds, size) for seconds, size, pid in found if pid == longest]
        slope = growth(series)
        rows.append({"node": node, "lives_count": len(set(lives)), "first_mb": series[0][1],
                     "last_mb": series[-1][1], "most_mb": max(size for _, size in series),
                     "growth_mb_per_h": slope,
                     "observed_s": series[-1][0] - series[0][0]})
    return rows


def grows(row: dict) -> bool:
    """Whether a node's memory grows, told from at least ten minutes of one life."""
    return (row["node"] not in KEEPERS and row["growth_mb_per_h"] is not None
            and row["observed_s"] >= 600.0
            and row["growth_mb_per_h"] > GROWTH + 0.01 * row["last_mb"])


def recoveries(data: Recording, executing: np.ndarray) -> list[dict]:
    """For every episode of a fault: after how long the execution went on; None: it did not in time.

    `executing` tells for each tick whether an execution was asked for.
    """
    moving, ticks = reaction.going(data), data.ticks
    rows = []
    for fault, first, last, _, _ in reaction.episodes(data):
        after = np.flatnonzero((ticks >= last) & (ticks <= last + RECOVERY * judge.SECOND))
        run, found, idle = 0, None, True
        for row in after:
            idle = idle and not executing[row]
            run = run + 1 if moving[row] else 0
            if run == reaction.SETTLED:
                found = 1e-9 * float(ticks[row - reaction.SETTLED + 1] - last)
                break
        rows.append({"fault": fault, "at_s": float(data.seconds(first)), "recovered_s": found,
                     "idle": bool(idle)})
    return rows


def drift(data: Recording, parts: int = 10) -> list[float | None]:
    """Root mean square of the forecasts' error in each tenth of the time, mm."""
    stamps, positions, _ = target.forecast(data)
    truth = target.true(data)
    edges = np.linspace(data.ticks[0], data.ticks[-1], parts + 1)
    found: list[float | None] = []
    for begin, end in zip(edges, edges[1:]):
        chosen = (stamps >= begin) & (stamps < end)
        error = target.errors(stamps[chosen], positions[chosen], truth)
        found.append(1e3 * float(np.sqrt(np.median(np.sum(error**2, axis=1)))) if len(error)
                     else None)
    return found
