# SPDX-License-Identifier: BSD-3-Clause
"""Files that appear whole or not at all."""
import contextlib
import json
import os
from typing import Any


def write(path: str, text: str) -> None:
    """Writes a file under another name, brings it to the disk and then gives it its name.

    Raises OSError; nothing of the new content and nothing but it is then at `path`.
    """
    if os.path.exists(path) and not os.path.isfile(path):  # a device or a pipe
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
        return
    path = os.path.realpath(path)  # what a link leads to, not the link
    part = f"{path}.{os.getpid()}.part"
    try:
        with open(part, "w", encoding="utf-8") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(part, path)
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(part)
        raise


def write_json(path: str, content: Any) -> None:
    write(path, json.dumps(content, indent=2) + "\n")
