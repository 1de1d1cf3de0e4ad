# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a trial's scene for its report: key frames and a film."""
import base64
import contextlib
import os
import subprocess
import tempfile

import PIL.Image
from markupsafe import Markup

from prf_experiments.judge import judge, world
from prf_experiments.record.recording import Recording
from prf_experiments.report import page
from prf_experiments.run import processes

WIDTH = 640  # px of a key frame
TIMEOUT = 120.0  # s for one program
MOST_PICTURES, FASTEST = 60, 4  # of a film; pictures a second of the trial
MOST_EVENTS = 3  # of the world that get a key frame


def moments(data: Recording, figures: dict) -> list[tuple[float, str]]:
    """[(s since the first tick, what is to be seen)], in the order of time."""
    end = float(data.seconds(data.ticks[-1]))
    found = [(0.0, "the start"), (end, "the end")]
    if figures.get("reached_s") is not None:
        found.append((figures["reached_s"], "reached"))
    touching = judge.arm_contacts(data)
    if touching:
        worst = max(touching, key=lambda contact: contact.force)
        if worst.force > judge.CONTACT_ISSUE:
            found.append((float(data.seconds(worst.stamp)),
                          f"largest contact, {worst.force:.1f} N"))
    if figures.get("fallen_s") is not None:
        found.append((figures["fallen_s"], "fallen"))
    happened = [event for event in world.events(data) if not event.injected]
    found += [(float(data.seconds(event.end)), event.text) for event in happened[:MOST_EVENTS]]
    return sorted(found)


def _run(words):
    done = subprocess.run(words, check=False, timeout=TIMEOUT, stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        said = done.stderr.strip().splitlines()
        raise processes.ProcessError(said[-1] if said else
                                     f"{os.path.basename(words[0])} ended with {done.returncode}")


def _encoded(path):
    with open(path, "rb") as stream:
        return base64.b64encode(stream.read()).decode("ascii")


def frames(bag: str, data: Recording, wanted: list[tuple[float, str]]) -> Markup:
    """HTML of the scene at some moments [(s since the first tick, words)]."""
    program, first = processes.executable("scene_drawing", "scene_picture"), 1e-9 * data.start
    parts = []
    with tempfile.TemporaryDirectory() as folder:
        names = [os.path.join(folder, f"{row}.png") for row in range(len(wanted))]
        times = [f"{first + time:.3f}" for time, _ in wanted]
        _run([program, data.robot.urdf_file, bag, *(word for pair in zip(times, names) for word in pair)])
        small = os.path.join(folder, "frame.webp")
        for (time, text), name in zip(wanted, names):
            with PIL.Image.open(name) as picture:
                picture.thumbnail((WIDTH, WIDTH))
                picture.save(small, quality=80)
            parts.append(page.render("picture.html", text=f"{time:.1f} s: {text}",
                                     content=_encoded(small)))
    return Markup('<div class="pictures">') + Markup("\n").join(parts) + Markup("</div>")


def film(bag: str, data: Recording) -> Markup:
    """HTML of the whole trial as a film, whose time is the trial's."""
    seconds = max(float(data.seconds(data.ticks[-1])), 0.1)
    rate = min(FASTEST, max(1, int(MOST_PICTURES / seconds)))
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "trial.mp4")
        _run([processes.executable("scene_drawing", "scene_film"), data.robot.urdf_file, bag, out, str(rate)])
        return page.render("film_figure.html", content=_encoded(out))


def of(bag: str, data: Recording | None, figures: dict) -> Markup:
    """HTML of what could be drawn; why not, where something could not."""
    if data is None:
        return Markup("<p>Not drawn: the bag could not be read.</p>")
    parts = []
    for draw in (lambda: film(bag, data), lambda: frames(bag, data, moments(data, figures))):
        try:
            parts.append(draw())
        except (processes.ProcessError, OSError, subprocess.SubprocessError) as error:
            parts.append(Markup("<p>Not drawn: {}.</p>").format(str(error).splitlines()[0]))
    return Markup("\n").join(parts)


def scene_of(bag: str, data: Recording | None) -> Markup:
    """HTML of the scene in the middle of a trial, for the page of many; nothing when it cannot be drawn."""
    if data is None:
        return Markup()
    middle = 0.5 * float(data.seconds(data.ticks[-1]))
    with contextlib.suppress(processes.ProcessError, OSError, subprocess.SubprocessError):
        return frames(bag, data, [(middle, "the scene")])
    return Markup()
