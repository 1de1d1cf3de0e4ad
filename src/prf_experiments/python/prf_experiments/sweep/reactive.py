# SPDX-License-Identifier: BSD-3-Clause
"""A look at the reaction: target X and Y measured, forecast and true, posterior and phase below."""
import numpy as np

from prf_experiments.judge import judge, target
from prf_experiments.record.recording import Recording
from prf_experiments.report import page, report
from prf_experiments.report.page import Section
from prf_experiments.sweep import statistics
from prf_experiments.sweep.study import NO_BAG, Study, read_bag
from prf_experiments.sweep.table import aligned

FIXED = {"motion": "light", "gait": "step"}
AXES_SHOWN = "xy"
NUMBERS = {"forecast_error_rms_mm": "forecast error, rms", "reached_s": "reached, s",
           "tracking_lateral_mean_mm": "off axis while tracking, mean"}


def summarise(results: list[dict]) -> dict:
    found = {name: statistics.spread([result["figures"].get(name) for result in results])
             for name in NUMBERS}
    return {"trials_count": len(results),
            "forecast_horizon_s": next((result["figures"]["forecast_horizon_s"]
                                        for result in results if result["figures"]), None),
            **{name: {"mean": spread.mean, "deviation": spread.deviation}
               for name, spread in found.items()}}


def text(summary: dict) -> str:
    rows = [("trials", *NUMBERS.values()),
            (str(summary["trials_count"]),
             *("–" if summary[name]["mean"] is None else f"{summary[name]['mean']:.1f}"
               for name in NUMBERS))]
    return (aligned(rows) + f"Forecasts are {summary['forecast_horizon_s']} s ahead; distances in "
            "mm.\n")


def conclusion(summary: dict) -> str:
    """One sentence."""
    error, reached, off = (summary[name]["mean"] for name in NUMBERS)
    parts = ([] if error is None else
             [f"forecasts {summary['forecast_horizon_s']} s ahead are {error:.1f} mm off, rms"]) + [
        "the target is not reached" if reached is None else f"the target is reached after {reached:.1f} s"] + (
        [] if off is None else [f"while tracking the tag is {off:.1f} mm off the axis, on average"])
    told = "; ".join(parts)
    return told[:1].upper() + told[1:] + "."


def phase_shares(data: Recording) -> str:
    """Share of the time spent in each phase."""
    return ", ".join(f"{name.lower()} {100 * np.mean(data.progress.states == state):.0f} %"
                     for state, name in enumerate(judge.STATES)
                     if np.any(data.progress.states == state))


def axis_errors(data: Recording) -> list:
    """Root mean square of the forecast's error along each axis, mm."""
    stamps, positions, _ = target.forecast(data)
    found = target.errors(stamps, positions, target.true(data))
    return [float(error) for error in 1e3 * np.sqrt(np.mean(found**2, axis=0))] or [None] * 3


def sections(_summary: dict, results: list[dict], folder: str) -> list[Section]:
    found = []
    for result in results:
        bag, data = read_bag(folder, result)
        title = f"Seed {result['arguments']['seed']}: {result['verdict']}"
        if data is None:
            found.append(Section(title, NO_BAG))
            continue
        found.append(Section(
            title, f"In the arm's base frame; time spent: {phase_shares(data)}.",
            [report.target_figure(bag, data, AXES_SHOWN),
             page.table([axis_errors(data)], ("forecast error, rms: x, mm", "y, mm", "z, mm"))]))
    return found


MEANING = "One trial in detail: how far forecasts are from the target, and how well it is followed."

STUDY = Study("Reactive execution", MEANING, {}, FIXED, summarise, text, sections, seeds=1, keep_bags="all",
              conclude=conclusion)
