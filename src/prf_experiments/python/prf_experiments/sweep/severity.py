# SPDX-License-Identifier: BSD-3-Clause
"""Worlds of rising severity, by family and level. Imports no ROS and nothing that must be installed."""
from typing import Any

MOTION = (0.5, 1.0, 1.5, 2.0, 2.5)
CART = (0.0, 0.1, 0.2, 0.3, 0.4)  # m
PUSH = (0.0, 40.0, 80.0, 120.0, 160.0)  # N
LEVELS = {
    "heavy": MOTION, "sea": MOTION, "bursts": MOTION, "stop": MOTION, "cart": CART,
    "cart_toward": CART, "push": PUSH, "push_hand": PUSH, "push_body": PUSH,
    "stumble": (0.0, 1.0, 2.0, 3.0), "occlude": (0.0, 0.5, 1.0, 2.0, 3.0), "dark": (0.0, 0.5, 1.0, 2.0, 3.0)}
DEFAULT = ("heavy", "sea", "bursts", "cart", "push")


def world(family: str, level: float) -> dict[str, Any]:
    """The arguments that make a world of so much severity."""
    if family in ("heavy", "sea", "bursts", "stop"):
        return {"motion": f"{family}:{level:g}"}
    disturbed = {"disturb": f"{family}:{level:g}"}
    if family.startswith("cart"):
        return {"scenario": "cart", "motion": "none", **disturbed}
    return {"motion": "light", **disturbed}


def place(arguments: dict) -> tuple[str, float]:
    """(family, level) of a trial's world."""
    family, _, level = (arguments["disturb"] or arguments["motion"]).partition(":")
    return family, float(level or 0.0)
