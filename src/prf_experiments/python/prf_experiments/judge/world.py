# SPDX-License-Identifier: BSD-3-Clause
"""What happened to a trial from outside: events of the world and injected faults.

FINDERS is the one list of them: timeline, figures, the sentence of the cause and the pages take
what it finds. A new disturbance gets a finder there and its words with it.
"""
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from prf_experiments import geometry
from prf_experiments.faults import catalogue, disturbances
from prf_experiments.judge import reaction, target
from prf_experiments.record.recording import Recording

SPEED_WINDOW = 10  # ticks over which a speed is taken
MOVING = 0.01  # m/s of the box over what carries it
MOVED = 0.01  # m, less is no event


@dataclass(frozen=True)
class Happening:
    begin: int  # ns
    end: int  # ns
    short: str  # for a label in a figure
    text: str  # a clause in the past tense, without its time: "the cart was pushed 0.14 m"
    injected: bool = False  # a fault of the chain, not of the world


def spans(stamps: np.ndarray, true: np.ndarray) -> Iterator[slice]:
    """Slices of neighbouring rows at which `true` (n,) holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], true, [False]]).astype(int)))
    for first, last in zip(edges[::2], edges[1::2]):
        yield slice(int(first), int(min(last, len(stamps))))


def box_pushed(data: Recording) -> Iterator[Happening]:
    """The box stands still on the platform; what moves it over the floor is a push. Ashore nothing
    pushes it, and without ground truth nobody knows the floor."""
    if data.is_estimated or data.description.get("arguments", {}).get("scenario") == "quay":
        return
    stamps, floor, box = target.matched(data.platform, data.tag)
    if len(stamps) <= SPEED_WINDOW:
        return
    positions = geometry.compose(geometry.inverse(floor), box)[:, :3]
    step = positions[SPEED_WINDOW:] - positions[:-SPEED_WINDOW]
    seconds = 1e-9 * (stamps[SPEED_WINDOW:] - stamps[:-SPEED_WINDOW])
    moving = np.linalg.norm(step, axis=1) > MOVING * seconds
    name = "cart" if data.description.get("arguments", {}).get("scenario") == "cart" else "box"
    for rows in spans(stamps, moving):
        last = rows.stop - 1 + SPEED_WINDOW
        way = float(np.linalg.norm(positions[last] - positions[rows.start]))
        if way > MOVED:
            half = SPEED_WINDOW // 2  # a window that moves begins and ends so far outside of it
            begin, end = stamps[rows.start + half], stamps[last - half]
            yield Happening(int(begin), int(end), f"{name} pushed",
                            f"the {name} was pushed {way:.2f} m")


def disturbed(data: Recording) -> Iterator[Happening]:
    """What the simulator did to the robot. Pushes of the cart are seen by its way, above."""
    for word, first, last, _, told in reaction.episodes(data):
        if is_disturbance(word) and not word.startswith("cart"):
            name = word.partition(":")[0]
            did = ("a foot was drawn aside with" if name == "stumble" else "the robot was pushed with")
            yield Happening(first, last, name.replace("_", " "), f"{did} {told[0] if told else word}")


def is_disturbance(word: str) -> bool:
    """Whether an event of a bag is the simulator's, not of the fault injector."""
    return word.partition(":")[0] in disturbances.KINDS


CAMERA = {"occlude": "something passed before the camera", "dark": "the exposure failed"}


def camera_words(data: Recording) -> dict[str, str]:
    """{fault: what it stands for} of the disturbances of the camera, which the injector acts on."""
    arguments = data.description.get("arguments", {})
    try:
        asked, seed = str(arguments.get("disturb") or ""), int(arguments.get("seed") or 0)
        return {word: CAMERA[one.name] for one in disturbances.parse(asked) if one.name in CAMERA
                for word in disturbances.as_faults(asked, seed).split(",")
                if word.startswith(one.kind.fault + "@")}
    except (disturbances.DisturbanceError, ValueError):  # of another version
        return {}


def camera_disturbed(data: Recording) -> Iterator[Happening]:
    words = camera_words(data)
    for word, first, last, _, _ in reaction.episodes(data):
        if word in words:
            yield Happening(first, last, "camera covered" if "passed" in words[word] else "dark", words[word])


def faults(data: Recording) -> Iterator[Happening]:
    """Injected ones; what is done and undone, as kill and start again, is one."""
    found: dict[str, list[tuple[int, int]]] = {}
    for word, first, last, _, _ in reaction.episodes(data):
        if not is_disturbance(word) and word not in camera_words(data):
            found.setdefault(word, []).append((first, last))
    for word, times in found.items():
        try:
            fault = catalogue.parse_one(word)
        except catalogue.FaultError:  # of another version
            short, text, lasts = word, f"injected fault {word}", True
        else:
            short, lasts = f"{fault.name} {fault.target}".strip(), fault.kind.lasts
            text = f"injected fault {word}, {fault.kind.meaning},"
        for first, last in times if lasts else [(times[0][0], times[-1][1])]:
            yield Happening(first, last, short, text, injected=True)


FINDERS: tuple[Callable[[Recording], Iterator[Happening]], ...] = (box_pushed, disturbed,
                                                               camera_disturbed, faults)


def events(data: Recording) -> list[Happening]:
    """Everything, in the order of time."""
    return sorted((event for find in FINDERS for event in find(data)),
                  key=lambda event: (event.begin, event.text))


def when(data: Recording, begin: int, end: int) -> str:
    """"at 7.2 s" or "from 7.0 to 8.1 s"."""
    first, last = float(data.seconds(begin)), float(data.seconds(end))
    return f"at {first:.1f} s" if last - first < 0.1 else f"from {first:.1f} to {last:.1f} s"
