# SPDX-License-Identifier: BSD-3-Clause
"""What a bag says, topic by topic, as SHA-256.

A digest covers the serialised messages of one publisher on one topic in their order, every field
including header.seq; receipt times in the bag are not covered. Publishers are kept apart because
the order between two of them (on tf) is left to the network. Exempt are diagnostics and rosout,
which carry wall-clock figures, fault/events, and the trial's description of itself (command, versions).
"""
import hashlib
from dataclasses import dataclass
from typing import Any

from prf_experiments.record import topics
from prf_msgs import bags

EXEMPT = {"/" + name for name in ["rosout_agg", topics.DESCRIPTION, *topics.EXEMPT]}


@dataclass
class Digest:
    messages: int
    sha256: str


def digests(path: str, topics: list[str] | None = None) -> dict[tuple[str, str], Digest]:
    """{(topic, publisher): Digest} of a bag; `topics` restricts it to those names.

    Raises RecordingError when there is nothing of them: nothing is not the same as nothing.
    """
    hashes: dict[tuple[str, str], Any] = {}
    numbers: dict[tuple[str, str], int] = {}
    with bags.opened(path) as bag:
        present = [name for name in bag.get_type_and_topic_info().topics
                   if name not in EXEMPT and (topics is None or name in topics)]
        for topic, raw, _, header in bag.read_messages(topics=present, raw=True,
                                                       return_connection_header=True) if present else ():
            key = topic, bags.publisher(header)
            hashes.setdefault(key, hashlib.sha256()).update(raw[1])
            numbers[key] = numbers.get(key, 0) + 1
    if not numbers:
        raise bags.BagError(f"{path}: no message" + (" of " + ", ".join(topics) if topics else
                                                     " that could be compared"))
    return {key: Digest(numbers[key], hashes[key].hexdigest()) for key in sorted(hashes)}


def differences(ours: dict, theirs: dict) -> list[str]:
    """One line for every topic and publisher that is not the same in both."""
    lines = []
    for key in sorted(set(ours) | set(theirs)):
        a, b = ours.get(key), theirs.get(key)
        if a == b:
            continue
        name = f"{key[0]} [{key[1] or 'no name'}]"
        if a is None or b is None:
            lines.append(f"{name}: only in the {'second' if a is None else 'first'} bag")
        elif a.messages != b.messages:
            lines.append(f"{name}: {a.messages} and {b.messages} messages")
        else:
            lines.append(f"{name}: {a.messages} messages that differ")
    return lines
