# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a trial's scene for its report: key frames and a short animation."""
import base64
import os
import subprocess
import tempfile

import PIL.Image
from catkin.find_in_workspaces import find_in_workspaces
from markupsafe import Markup

from prf_experiments.judge import judge
from prf_experiments.record.recording import Recording
from prf_experiments.report import page
from prf_experiments.run import processes

WIDTH = 640  # px of a key frame
TIMEOUT = 120.0  # s for one program
ANIMATION = ["--seconds", "8", "--rate", "8", "--width", "440"]


def moments(data: Recording, figures: dict) -> list[tuple[float, str]]:
    """[(s since the first tick, what is to be seen)], in the order of time."""
    end = float(data.seconds(data.ticks[-1]))
    found = [(0.0, "the start"), (end, "the end")]
    if figures.get("reached_s") is not None:
        found.append((figures["reached_s"], "reached"))
    touching = judge.arm_contacts(data.contacts)
    if touching:
        worst = max(touching, key=lambda contact: contact.force)
        if worst.force > judge.CONTACT_ISSUE:
            found.append((float(data.seconds(worst.stamp)),
                          f"largest contact, {worst.force:.1f} N"))
    if figures.get("fallen_s") is not None:
        found.append((figures["fallen_s"], "fallen"))
    return sorted(found)


def _run(words):
    subprocess.run(words, check=True, timeout=TIMEOUT, stdin=subprocess.DEVNULL,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def _embedded(path, text):
    with open(path, "rb") as stream:
        content = base64.b64encode(stream.read()).decode("ascii")
    return page.render("picture.html", text=text, content=content)


def key_frames(bag: str, data: Recording, figures: dict) -> Markup:
    """HTML of the scene at the trial's moments."""
    urdf = find_in_workspaces(["share"], "jaco_v60_description", "urdf/jaco_v60.urdf")[0]
    program = processes.executable("scene_drawing", "scene_picture")
    first = 1e-9 * data.start
    parts = []
    with tempfile.TemporaryDirectory() as folder:
        out, small = os.path.join(folder, "frame.png"), os.path.join(folder, "frame.webp")
        for time, text in moments(data, figures):
            _run([program, urdf, bag, f"{first + time:.3f}", out])
            with PIL.Image.open(out) as picture:
                picture.thumbnail((WIDTH, WIDTH))
                picture.save(small, quality=80)
            parts.append(_embedded(small, f"{time:.1f} s: {text}"))
    return Markup("\n").join(parts)


def animation(bag: str) -> Markup:
    """HTML of the whole trial as an animation."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "trial.webp")
        _run([processes.executable("scene_drawing", "scene_animation"), bag, out, *ANIMATION])
        return _embedded(out, "the whole trial, shortened to 8 s")


def of(bag: str, data: Recording | None, figures: dict) -> Markup:
    """HTML of what could be drawn; why not, where something could not."""
    parts = []
    for draw, words in ((key_frames, (bag, data, figures)), (animation, (bag,))):
        try:
            parts.append(draw(*words))
        except (processes.ProcessError, OSError, IndexError, subprocess.SubprocessError) as error:
            parts.append(Markup("<p>Not drawn: {}.</p>").format(str(error).splitlines()[0]))
    return Markup("\n").join(parts)
