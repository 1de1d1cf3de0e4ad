# SPDX-License-Identifier: BSD-3-Clause
"""Decodes every message of an MCAP file without ROS, by the definitions in the file, to JSON lines.

Usage: decode.py FILE.mcap     run by test_export.py in a Python that is kept from ROS
"""
import json
import sys

ROS = ("rospy", "genpy", "genmsg", "rosbag", "roslib", "std_msgs", "sensor_msgs", "prf_msgs", "tf2_msgs",
       "rosbags", "numpy")
for name in ROS:
    sys.modules[name] = None  # type: ignore[assignment]  # its import fails

from mcap.reader import make_reader  # noqa: E402
from mcap_ros2.decoder import DecoderFactory  # noqa: E402


def plain(value):
    if isinstance(value, bytes):
        return list(value)
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if hasattr(value, "__slots__"):
        return {name.lstrip("_"): plain(getattr(value, name)) for name in value.__slots__}
    return value


with open(sys.argv[1], "rb") as stream:
    reader = make_reader(stream, decoder_factories=[DecoderFactory()])
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        print(json.dumps([channel.topic, schema.name, message.log_time, plain(decoded)]))
