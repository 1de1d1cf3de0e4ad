# SPDX-License-Identifier: BSD-3-Clause
"""Bags as people have them: the one way in which this project's tools open one.

Whatever is wrong with a bag becomes a BagError of one line: file, what was found, what is wanted.
"""
import contextlib
import os
import stat
import struct
from collections.abc import Collection, Iterator
from typing import Any

import genpy
import rosbag
import roslib.message

from prf_msgs import interfaces

TABLE = interfaces.load()
TYPES = {topic.bare_name: topic.type for topic in TABLE.topics}
# Fields that messages of earlier versions lack, and that readers do without.
LATER_FIELDS = {"prf_msgs/ExecutionProgress": {"following_error", "following_rotation"}}
# What reading a damaged bag may raise, in rosbag, in genpy and in the decompressors.
DAMAGES = (OSError, ValueError, EOFError, RuntimeError, KeyError, IndexError, AttributeError,
           TypeError, MemoryError, struct.error, genpy.MessageException, rosbag.ROSBagException)


class BagError(Exception):
    """A bag cannot be read or does not hold what is needed; the message says file and why."""


@contextlib.contextmanager
def opened(path: str) -> Iterator[rosbag.Bag]:
    """The bag, open. Only a file is opened: a device or a pipe may have no end.

    Also what damages raise while the bag is read within the `with` is a BagError.
    """
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise BagError(f"{path}: is no file, must be a bag")
    except FileNotFoundError:
        raise BagError(f"{path}: there is no such bag") from None
    except OSError as error:
        raise BagError(f"{path}: cannot be read: {error.strerror}") from None
    try:
        bag = rosbag.Bag(path)
    except rosbag.ROSBagUnindexedException:
        raise BagError(f"{path}: the bag was not closed; `rosbag reindex {path}` brings back what "
                       "was recorded until then") from None
    except DAMAGES as error:
        why = error.strerror if isinstance(error, OSError) and error.strerror else one_line(error)
        raise BagError(f"{path}: cannot be read: {why}") from None
    with bag:
        try:
            yield bag
        except DAMAGES as error:
            raise BagError(f"{path}: broken: {one_line(error)}") from None


def one_line(error: BaseException) -> str:
    """What an error says, without line breaks; of a file its name first, and in plain words."""
    if isinstance(error, OSError) and error.filename is not None and error.strerror:
        what = ("there is no such file or folder" if isinstance(error, FileNotFoundError)
                else error.strerror.lower())
        return f"{error.filename}: {what}"
    return " ".join(str(error).split()) or type(error).__name__


def publisher(header: dict[str, Any]) -> str:
    """Name of the node that sent a message, by its connection header; "" where it does not say:
    bags of rosbag's Python API and of programs that rewrite bags may have no `callerid`."""
    name = header.get("callerid", b"")
    return name.decode(errors="replace") if isinstance(name, bytes) else name


def counts(bag: rosbag.Bag) -> dict[str, int]:
    """{topic without leading slash: messages}."""
    return {name.lstrip("/"): info.message_count
            for name, info in bag.get_type_and_topic_info().topics.items()}


def require_messages(bag: rosbag.Bag, names: Collection[str]) -> None:
    """Raises BagError unless the bag has a message of every topic named."""
    found = counts(bag)
    missing = [name for name in names if not found.get(name.lstrip("/"))]
    if missing:
        raise BagError(f"{bag.filename}: no message of " + ", ".join(missing))


def _lacking(wanted: Any, text: str) -> set[str] | None:
    """Fields of `wanted` that the definition `text` of the same type lacks; None: all of them are
    there, and the difference is elsewhere."""
    import genpy.dynamic
    kind = wanted._type
    given = genpy.dynamic.generate_dynamic(kind, text)[kind]
    theirs = set(zip(given.__slots__, given._slot_types))
    ours = set(zip(wanted.__slots__, wanted._slot_types))
    return {name for name, _ in ours - theirs} or None


def require_types(bag: rosbag.Bag, names: Collection[str]) -> None:
    """Raises BagError when a topic of interfaces.yaml has another type or another definition than
    this version's. Topics that the bag lacks are none of its business."""
    for connection in bag._get_connections():
        name = connection.topic.lstrip("/")
        if name not in names or name not in TYPES:
            continue
        kind = TYPES[name]
        where = f"{bag.filename}: topic {connection.topic}"
        if connection.datatype != kind:
            raise BagError(f"{where} holds {connection.datatype}, must be {kind}")
        ours = roslib.message.get_message_class(kind)
        if ours is None:
            raise BagError(f"{where} holds {kind}, which is not built here: source the workspace that has it")
        if connection.md5sum == ours._md5sum:
            continue
        lacking = _lacking(ours, connection.msg_def)
        if lacking and lacking <= LATER_FIELDS.get(kind, set()):
            continue
        without = f" without {', '.join(sorted(lacking))}" if lacking else ""
        raise BagError(f"{where} holds another version's {kind}{without}: its md5 is "
                       f"{connection.md5sum}, must be {ours._md5sum}")
