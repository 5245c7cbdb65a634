"""Reads a recording by mcap with mcap-ros2-support, or by rosbags, and tells what is in it: topics, counts, some last values.

With rosbags every message of a standard type is also serialized again, and must be the same bytes.
"""

import sys

FIELDS = {
    "/code": ["data"],
    "/faults": ["name", "msg", "level", "line"],
    "/log": ["name", "msg", "level", "line"],
    "/node/raw": ["data"],
    "/sensors/A1": ["x", "x2", "y", "class"],
}


def by_mcap(path):
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        names = [one.name for one in reader.iter_attachments()]
        assert names == ["config.lua"], names
        for _, channel, _, message in reader.iter_decoded_messages():
            yield channel.topic, message


def by_rosbags(path):
    from pathlib import Path

    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    jazzy = get_typestore(Stores.ROS2_JAZZY)
    with AnyReader([Path(path)], default_typestore=jazzy) as reader:
        for connection, _, raw in reader.messages():
            name = connection.msgtype
            if not name.startswith("trik_msgs/"):
                again = bytes(jazzy.serialize_cdr(jazzy.deserialize_cdr(raw, name), name))
                assert again == bytes(raw), f"{name}: {bytes(raw).hex()} {again.hex()}"
            yield connection.topic, reader.deserialize(raw, name)


def value(message, name):
    # A name that is a word of the language has something after it in some of them.
    found = getattr(message, name, None)
    if found is None:
        found = getattr(message, name + "_")
    if isinstance(found, (str, int, float)):
        return str(found)
    return ",".join(str(int(one)) for one in found)


counts, last = {}, {}
for topic, message in {"mcap": by_mcap, "rosbags": by_rosbags}[sys.argv[1]](sys.argv[2]):
    counts[topic] = counts.get(topic, 0) + 1
    last[topic] = message
for topic in sorted(counts):
    values = [f"{name}={value(last[topic], name)}" for name in FIELDS.get(topic, [])]
    print(" ".join([topic, str(counts[topic]), *values]))
