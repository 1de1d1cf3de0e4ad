# SPDX-License-Identifier: BSD-3-Clause
"""Message types of a ROS 1 bag as ROS 2 has them: definitions, bytes, and new standard messages.

No ROS is needed: a bag brings the definitions of its messages with it, and rosbags those of ROS 2.
"""
import contextlib
import io
from collections.abc import Callable
from typing import Any

from rosbags.convert.converter import default_message, generate_message_converter
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

# What reading the bytes of a message may raise when its definition is not theirs.
DAMAGES = (SerdeError, TypesysError, AssertionError, KeyError, IndexError, ValueError,
           AttributeError)
LOG = "rcl_interfaces/msg/Log"
LOG_LEVELS = {1: 10, 2: 20, 4: 30, 8: 40, 16: 50}  # rosgraph_msgs/Log -> rcl_interfaces/Log


class Standard:
    """Makes messages of ROS 2's own types and tells their definitions."""

    def __init__(self) -> None:
        self._store = get_typestore(Stores.ROS2_JAZZY)
        self._defaults: dict[str, dict[str, Any]] = {}

    def make(self, kind: str, **fields: Any) -> Any:
        """A message with the fields given; the others are zero or empty, and shared: not to be changed."""
        if kind not in self._defaults:
            empty = default_message(self._store, kind)
            self._defaults[kind] = {name: getattr(empty, name)
                                    for name, _ in self._store.fielddefs[kind][1]}
        return self._store.types[kind](**{**self._defaults[kind], **fields})

    def definition(self, kind: str) -> str:
        return self._store.generate_msgdef(kind, ros_version=2)[0]

    def serialize(self, kind: str, message: Any) -> bytes:
        return bytes(self._store.serialize_cdr(message, kind, little_endian=True))


class Source:
    """One type as a connection of the bag defines it, with the way from its bytes to ROS 2."""

    def __init__(self, kind: str, definition: str, standard: Standard) -> None:
        """Raises TypesysError when the definition cannot be read."""
        self.kind = kind
        self._source = get_typestore(Stores.EMPTY)
        self._source.register(get_types_from_msg(definition, kind))
        self._standard = standard
        self.target = LOG if kind == "rosgraph_msgs/msg/Log" else kind
        self._convert: Callable[[Any], Any] | None = None
        if self.target == LOG:
            self.definition = standard.definition(LOG)
            return
        store = get_typestore(Stores.ROS2_JAZZY)
        # A type that ROS 2 has is ROS 2's (CameraInfo.D is d there); the others stay as they are.
        theirs = get_types_from_msg(self._source.generate_msgdef(kind, ros_version=2)[0], kind)
        store.register({name: fields for name, fields in theirs.items()
                        if name not in store.fielddefs})
        self.definition = store.generate_msgdef(kind, ros_version=2)[0]
        with contextlib.redirect_stdout(io.StringIO()):  # it tells which types it migrates
            self._convert = generate_message_converter(
                self._source, store, kind, kind, {}, src_is2=False, dst_is2=True)

    def decode(self, data: bytes) -> Any:
        """The message with its fields as attributes."""
        return self._source.deserialize_ros1(data, self.kind)

    def cdr(self, data: bytes) -> bytes:
        """The message in ROS 2's encoding."""
        if self._convert:
            return bytes(self._convert(data))
        log = self.decode(data)
        return self._standard.serialize(LOG, self._standard.make(
            LOG, stamp=log.header.stamp, level=LOG_LEVELS.get(log.level, log.level), name=log.name,
            msg=log.msg, file=log.file, function=log.function, line=log.line))
