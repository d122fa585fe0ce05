# SPDX-License-Identifier: Apache-2.0
"""The made-up swimmer in a rosbag2 folder, in each of the ways in which bags come; written by `rosbags` alone."""

import pathlib

import made_up
from eel_common.topics import GLOBAL, OWN
from eel_viz.bags.definitions import definition, type_hash
from fake_swimmer import body_message, diagnostics, messages
from nav_msgs.msg import Path
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from eel_msgs.msg import CurvatureLaw

BEGAN = 1_800_000_000 * 10**9  # ns, wall time of the recording


def write_bag(
    folder: pathlib.Path,
    seconds: float = 1.0,
    rate: float = 100.0,
    *,
    stations: int = 21,
    namespaces: tuple[str, ...] = ("",),
    runs: int = 1,
    waiting: int = 0,
    storage: StoragePlugin = StoragePlugin.MCAP,
    compression: CompressionMode = CompressionMode.NONE,
    kinds: dict[str, str] | None = None,
    goal: Path | None = None,
    spoil=lambda topic, message: message,
) -> pathlib.Path:
    """Body and law first, then all samples; returns `folder`.

    goal: nav_msgs/Path. waiting: before each run, so many messages of stamp 0 with the numbers of another time.
    `spoil(topic, message)` is what is written instead, None: nothing; `kinds` are types given out for topics' own.
    """
    writer = Writer(folder, version=9, storage_plugin=storage)
    if compression is not CompressionMode.NONE:
        writer.set_compression(compression, CompressionFormat.ZSTD)
    connections, now = {}, BEGAN

    with writer:

        def add(topic: str, kind: str, message) -> None:
            nonlocal now
            message, kind = spoil(topic, message), (kinds or {}).get(topic, kind)
            if message is None:
                return
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, msgdef=definition(kind), rihs01=type_hash(kind))
            now += 1000
            writer.write(connections[topic], now, serialize_message(message))

        for space in namespaces:
            add(f"{space}/body", OWN["body"], body_message(made_up.STATIONS))
            if goal is not None:
                add(f"{space}/goal", OWN["goal"], goal)
            add(f"{space}/curvature_law", OWN["curvature_law"], CurvatureLaw(name="made up"))
        swimmer = made_up.Swimmer(stations)
        whole = [*[-1] * waiting, *(round(k * 1e9 / rate) for k in range(round(seconds * rate) + 1))]
        for stamp in whole * runs:
            sample = messages(swimmer, stamp if stamp >= 0 else 3 * 10**8)
            for message in sample.values() if stamp < 0 else ():
                message.header.stamp.nanosec = 0
            for space in namespaces:
                for topic, message in sample.items():
                    add(f"{space}/{topic}", OWN[topic], message)
            if stamp % 10**9 == 0:
                add("/diagnostics", GLOBAL["/diagnostics"], diagnostics(stamp))
    return folder
