# SPDX-License-Identifier: BSD-3-Clause
"""Transforms of a bag's tf, looked up at any stamp, as the framework saw them."""
from collections.abc import Sequence

import genpy
import numpy as np
import tf2_msgs.msg
import tf2_ros

from prf_experiments.record import recording
from prf_msgs import bags

HISTORY = 3600.0  # s, longer than any trial


def load(path: str, publisher: str | None = None) -> tf2_ros.BufferCore:
    """tf2 buffer with tf and tf_static of a bag. `publisher` restricts it to one node's, where the
    bag has some of it: bags that were rewritten name no publishers, other robots' another one."""
    buffer = tf2_ros.BufferCore(genpy.Duration.from_sec(HISTORY))
    with bags.opened(path) as bag:
        bags.require_types(bag, {"tf", "tf_static"})
        messages = [(topic, raw[1], bags.publisher(header)) for topic, raw, _, header in
                    bag.read_messages(topics=["/tf", "/tf_static"], raw=True,
                                      return_connection_header=True)]
        known = publisher in {caller for _, _, caller in messages}
        for topic, content, caller in messages:
            if known and caller != publisher:
                continue
            store = buffer.set_transform if topic == "/tf" else buffer.set_transform_static
            for transform in tf2_msgs.msg.TFMessage().deserialize(content).transforms:
                store(transform, caller)
    return buffer


def lookup(buffer: tf2_ros.BufferCore, parent: str, child: str,
           stamps: Sequence[int] | np.ndarray) -> np.ndarray:
    """Poses (n, 7) of child in parent at stamps in ns; NaN where tf cannot tell."""
    poses = np.full((len(stamps), 7), np.nan)
    for row, stamp in enumerate(stamps):
        try:
            found = buffer.lookup_transform_core(parent, child, genpy.Time(0, int(stamp)))
        except tf2_ros.TransformException:
            continue
        poses[row] = recording.transform_values(found.transform)
    return poses


def why_not(buffer: tf2_ros.BufferCore, parent: str, child: str, stamp: int) -> str:
    """What tf2 says of a lookup that fails; "" when it does not."""
    try:
        buffer.lookup_transform_core(parent, child, genpy.Time(0, int(stamp)))
    except tf2_ros.TransformException as error:
        return bags.one_line(error)
    return ""
