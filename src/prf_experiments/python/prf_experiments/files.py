# SPDX-License-Identifier: BSD-3-Clause
"""Files that appear whole or not at all."""
import contextlib
import json
import os
from collections.abc import Iterator
from typing import Any, BinaryIO


def write(path: str, text: str) -> None:
    """Writes a file under another name, brings it to the disk and then gives it its name.

    Raises OSError; nothing of the new content and nothing but it is then at `path`.
    """
    if os.path.exists(path) and not os.path.isfile(path):  # a device or a pipe
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
        return
    with appearing(path) as stream:
        stream.write(text.encode("utf-8"))


@contextlib.contextmanager
def appearing(path: str) -> Iterator[BinaryIO]:
    """A stream into a file that gets its name when all is written and on the disk.

    When the block raises, nothing of the new content and nothing but it is at `path`.
    """
    path = os.path.realpath(path)  # what a link leads to, not the link
    part = f"{path}.{os.getpid()}.part"
    try:
        with open(part, "wb") as stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(part, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(part)
        raise


def write_json(path: str, content: Any) -> None:
    write(path, json.dumps(content, indent=2) + "\n")
