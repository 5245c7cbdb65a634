"""Reads a recording by rosbags and by mcap, and writes its messages once more by rosbags: `who what seconds` for each.

Seconds are those of the processor, the best of three rounds in turns.
"""

import sys
import tempfile
import time
from pathlib import Path

from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

FILE = Path(sys.argv[1])
STORE = get_typestore(Stores.ROS2_JAZZY)


def rosbags_read():
    with AnyReader([FILE], default_typestore=STORE) as reader:
        return [(connection.topic, at, bytes(raw)) for connection, at, raw in reader.messages()]


def mcap_read():
    with open(FILE, "rb") as file:
        return sum(1 for _ in make_reader(file).iter_messages())


def rosbags_written(messages, folder):
    name = "std_msgs/msg/String"
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        topics = {topic: writer.add_connection(topic, name, typestore=STORE) for topic in {one[0] for one in messages}}
        for topic, at, raw in messages:
            writer.write(topics[topic], at, raw)


best = {}


def timed(who, what, run):
    begin = time.process_time()
    got = run()
    spent = time.process_time() - begin
    best[who, what] = min(spent, best.get((who, what), spent))
    return got


with tempfile.TemporaryDirectory() as room:
    for turn in range(3):
        messages = timed("rosbags", "read", rosbags_read)
        timed("mcap", "read", mcap_read)
        timed("rosbags", "written", lambda: rosbags_written(messages, Path(room) / str(turn)))
for (who, what), seconds in best.items():
    print(who, what, seconds)
