# SPDX-License-Identifier: Apache-2.0
"""A run of the three nodes and the recorder as processes over DDS, and what it leaves, read back."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

DURATION, RATE, STATIONS = 10.0, 100.0, 51  # s, Hz, [-]
SAMPLES = 1001


@dataclass(frozen=True)
class Results:
    """Where a run's two recordings lie."""

    bag: Path  # rosbag2 folder
    recording: Path  # .rrd

    def messages(self, topic: str) -> list:
        """All messages of a topic in the bag, in order."""
        return self._by_topic()[topic]

    @cache  # noqa: B019
    def _by_topic(self) -> dict[str, list]:
        from rosbags.highlevel import AnyReader

        found: dict[str, list] = {}
        with AnyReader([self.bag]) as reader:
            for connection, _, raw in reader.messages():
                found.setdefault(connection.topic, []).append(reader.deserialize(raw, connection.msgtype))
        return found

    def topics(self) -> dict[str, int]:
        """Topic: number of messages in the bag."""
        from rosbags.highlevel import AnyReader

        with AnyReader([self.bag]) as reader:
            return {topic: info.msgcount for topic, info in reader.topics.items()}

    def column(self, path: str, component: str) -> tuple[np.ndarray, list]:
        """Times [ns] and values (one flat array a row) of a component at an entity path of the Rerun recording."""
        from rerun.chunk import RrdReader

        rows = []
        for chunk in RrdReader(str(self.recording)).stream().filter(content=path):
            if chunk.is_static or chunk.entity_path != path:
                continue
            batch = chunk.to_record_batch()
            names = [name for name in batch.schema.names if name.split(":")[-1] == component]
            if names:
                times = batch.column("sim_time").cast("int64").to_numpy()
                values = [np.asarray(flat(row)) for row in batch.column(names[0])]
                rows += list(zip(times, values, strict=True))
        rows.sort(key=lambda row: row[0])
        return np.array([time for time, _ in rows]), [value for _, value in rows]


def flat(row):
    """All numbers of an Arrow list, whatever its nesting."""
    values = row.values
    while hasattr(values, "flatten") and hasattr(values.type, "value_type"):
        values = values.flatten()
    return values.to_numpy(zero_copy_only=False)


def stamps(messages: list) -> np.ndarray:
    """header.stamp of each [ns]."""
    return np.array([m.header.stamp.sec * 1_000_000_000 + m.header.stamp.nanosec for m in messages])


def swim(start, folder: Path, *, remap: tuple[str, ...] = ()) -> Results:
    """Start recorder, visualiser, gait generator and dynamics; wait until all that ends by itself has ended well.

    Where that fails all are ended, so that it can be tried again beside nobody.
    """
    nodes = []

    def begin(*words: str):
        nodes.append(start(*words))
        return nodes[-1]

    try:
        return _swim(begin, folder, remap)
    except BaseException:
        for node in reversed(nodes):
            node.end()
        raise


def _swim(start, folder: Path, remap: tuple[str, ...]) -> Results:
    recording, bag = folder / "swim.rrd", folder / "bag"
    recorder = start("record", "--out", str(bag), "--stop-with-publisher", *remap)
    visualiser = start(
        "visualiser",
        "--ros-args",
        "-p",
        "sink:=[save]",
        "-p",
        f"recording:={recording}",
        "-p",
        "stop_with_publisher:=true",
        *remap,
    )
    start("gait_generator", "--ros-args", "-p", "gait:=falling", *remap)
    dynamics = start(
        "dynamics", "--ros-args", "-p", f"duration:={DURATION}", "-p", f"rate:={RATE}", "-p", f"stations:={STATIONS}",
        "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=2", *remap,
    )  # fmt: skip
    for node in (dynamics, visualiser, recorder):
        assert node.wait(90.0) == 0, node.output()
    return Results(bag, recording)
