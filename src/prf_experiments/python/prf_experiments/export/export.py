# SPDX-License-Identifier: BSD-3-Clause
"""A ROS 1 bag as an MCAP file that today's viewers open: Foxglove, Lichtblick, PlotJuggler, Rerun.

Each message of the bag is there, in ROS 2's encoding (CDR) and at its time of receipt; beside ours
stand standard messages (additions.py). One pass through the bag, one message in memory at a time,
and nothing of the clock or the machine: the same bag gives the same file.
"""
import contextlib
import os
import stat
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

from mcap.writer import CompressionType, Writer
from rosbags.rosbag1 import Reader, ReaderError

from prf_experiments.export import additions
from prf_experiments.export.types import DAMAGES, Source, Standard

CHUNK = 4 << 20  # bytes, what a viewer reads at once
ROBOT_TOPIC = "/robot_description"


class ExportError(Exception):
    """The bag cannot be exported; the message says why, in one line."""


@dataclass
class Counts:
    messages: int = 0  # of the bag
    added: int = 0
    topics: set[str] = field(default_factory=set)
    alone: dict[str, str] = field(default_factory=dict)  # topic without companions: why


class _File:
    """An MCAP file: schemas and channels are written when the first message needs them."""

    def __init__(self, stream: BinaryIO):
        self._writer = Writer(stream, chunk_size=CHUNK, compression=CompressionType.ZSTD)
        self._schemas: dict[tuple[str, str], int] = {}
        self._channels: dict[tuple[str, int], int] = {}
        self._sequence: dict[int, int] = {}
        self._writer.start(profile="ros2", library="prf_experiments export")

    def write(self, topic: str, kind: str, definition: str, data: bytes, time: int) -> None:
        schema = self._schemas.get((kind, definition))
        if schema is None:
            schema = self._schemas[kind, definition] = self._writer.register_schema(
                kind, "ros2msg", definition.encode())
        channel = self._channels.get((topic, schema))
        if channel is None:
            channel = self._channels[topic, schema] = self._writer.register_channel(
                topic, "cdr", schema)
        sequence = self._sequence[channel] = self._sequence.get(channel, -1) + 1
        self._writer.add_message(channel, time, data, time, sequence)

    def finish(self) -> None:
        self._writer.finish()


class _Export:
    def __init__(self, reader: Reader, stream: BinaryIO):
        self._standard = Standard()
        self._definitions: dict[str, str] = {}
        self._file = _File(stream)
        self._sources = {connection.id: self._source(connection)
                         for connection in reader.connections}
        self.counts = Counts()

    def _source(self, connection: Any) -> Source:
        try:
            return Source(connection.msgtype, connection.msgdef.data, self._standard)
        except DAMAGES as error:
            raise ExportError(f"{connection.topic}: the definition of {connection.msgtype} in the "
                              f"bag cannot be read: {_line(error)}") from None

    def add(self, topic: str, kind: str, message: Any, time: int) -> None:
        """Writes a standard message that the bag does not have."""
        if kind not in self._definitions:
            self._definitions[kind] = self._standard.definition(kind)
        self._file.write(topic, kind, self._definitions[kind],
                         self._standard.serialize(kind, message), time)
        self.counts.added += 1
        self.counts.topics.add(topic)

    def take(self, connection: Any, time: int, data: bytes) -> None:
        """Writes one message of the bag, and its companions."""
        source, topic = self._sources[connection.id], connection.topic
        try:
            encoded = source.cdr(data)
        except DAMAGES as error:
            raise ExportError(f"{topic}: message at {time * 1e-9:.3f} s cannot be read as "
                              f"{source.kind}: {_line(error)}") from None
        self._file.write(topic, source.target, source.definition, encoded, time)
        self.counts.messages += 1
        self.counts.topics.add(topic)
        for each in self._companions(topic, source, data):
            self.add(f"{topic}/{each.suffix}", each.kind, each.message, time)

    def _companions(self, topic: str, source: Source, data: bytes) -> list[additions.Companion]:
        """None when the bag's definition of the message is of another version without a field."""
        make = additions.maker(topic, source.kind)
        if make is None or topic in self.counts.alone:
            return []
        try:
            return list(make(topic, source.decode(data), self._standard))
        except (AttributeError, ValueError) as error:
            self.counts.alone[topic] = _line(error)
            return []

    def finish(self) -> Counts:
        self._file.finish()
        return self.counts


def _line(error: BaseException) -> str:
    return " ".join(str(error).split()) or type(error).__name__


def _opened(path: str) -> Reader:
    """Raises ExportError. Only a file is opened: a device or a pipe may have no end."""
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise ExportError(f"{path}: is no file, must be a ROS 1 bag")
        if not os.path.getsize(path):
            raise ExportError(f"{path}: is empty, must be a ROS 1 bag")
    except OSError as error:
        raise ExportError(f"{path}: cannot be read: {error.strerror}") from None
    return Reader(Path(path))


def _nothing(_: float) -> None:
    pass


def export(bag: str, stream: BinaryIO, robot: str | None = None,
           progress: Callable[[float], None] = _nothing) -> Counts:
    """Writes the bag to a stream that can be written to from its start on; `robot` is a URDF as text.

    progress(share) is called with 0 .. 1 as the export goes on. Raises ExportError, OSError.
    """
    with contextlib.ExitStack() as stack:
        try:
            reader = stack.enter_context(_opened(bag))
        except ReaderError as error:
            hint = ("; it was not closed or not indexed, `rosbag reindex` mends that"
                    if "index" in str(error) else "")
            raise ExportError(f"{bag}: cannot be read as a ROS 1 bag: {_line(error)}{hint}") from None
        if not reader.message_count:
            raise ExportError(f"{bag}: holds no message")
        try:
            return _run(reader, stream, robot, progress)
        except (ExportError, ReaderError, *DAMAGES) as error:
            raise ExportError(f"{bag}: {_line(error)}") from None


def _run(reader, stream, robot, progress):
    written = _Export(reader, stream)
    if robot and ROBOT_TOPIC not in reader.topics:
        text = written._standard.make(additions.TEXT, data=robot)
        written.add(ROBOT_TOPIC, additions.TEXT, text, reader.start_time)
    for number, (connection, time, data) in enumerate(reader.messages()):
        written.take(connection, time, data)
        if number % 500 == 0:
            progress(number / reader.message_count)
    return written.finish()
