# SPDX-License-Identifier: BSD-3-Clause
"""A taught demonstration at a glance: its path from three sides, and its speed."""
import matplotlib
import numpy as np

from elte_planner import Demonstration

matplotlib.use("Agg")
from matplotlib import pyplot  # after the choice of Agg: there may be no display

VIEWS = (("from above", 0, 1), ("from the side", 0, 2), ("from the front", 1, 2))
AXES = "xyz"


def draw(path: str, shown: Demonstration, joint_share: np.ndarray) -> None:
    """Writes a picture. `joint_share` (n,): largest share of a joint's velocity limit, evenly over the time."""
    figure, parts = pyplot.subplots(1, 4, figsize=(16, 4.2), constrained_layout=True)
    hand, target = np.asarray(shown.poses)[:, :3], np.asarray(shown.target)[:3]
    for part, (title, across, up) in zip(parts, VIEWS):
        part.plot(hand[:, across], hand[:, up], ".-", label="hand")
        part.plot(*hand[0, [across, up]], "go", label="start")
        part.plot(*target[[across, up]], "r*", markersize=12, label="target")
        part.plot(0.0, 0.0, "ks", label="arm's base")
        part.set(title=title, xlabel=f"{AXES[across]} / m", ylabel=f"{AXES[up]} / m", aspect="equal")
    parts[0].legend()
    times = np.asarray(shown.times)
    speed = np.linalg.norm(np.gradient(hand, times, axis=0), axis=1)
    parts[3].plot(times, speed, label="hand, m/s")
    parts[3].plot(np.linspace(times[0], times[-1], len(joint_share)), joint_share,
                  label="fastest joint, share of its limit")
    parts[3].axhline(1.0, color="r", linestyle=":")
    parts[3].set(title="speed", xlabel="time / s", ylim=(0.0, None))
    parts[3].legend()
    figure.savefig(path, dpi=80)
    pyplot.close(figure)
