# SPDX-License-Identifier: Apache-2.0
"""Publishes what is in a bag, byte for byte and as fast as subscribers take it, and leaves: `ros2 bag play` in small.

Usage: bag_player.py FOLDER COUNT: so many messages of each topic. Publishers have the quality of service that the bag
tells, and wait for a subscriber each.
"""

import sys
import time
from collections import Counter
from pathlib import Path

import rclpy
from eel_viz.bags.definitions import message_class
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rosbags.interfaces import QosDurability
from rosbags.rosbag2 import Reader

UNPLAYED = (
    "/clock",
    "/tf",
    "/swim_state",
    "/joint_states",
    "/flow_at_head",
    "/robot_description",
)  # the visualiser does not subscribe to them
UNIQUE = ("/body", "/curvature_law")


def quality(connection) -> QoSProfile:
    latched = any(offer.durability == QosDurability.TRANSIENT_LOCAL for offer in connection.ext.offered_qos_profiles)
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def main() -> None:
    rclpy.init()
    node = rclpy.create_node("player")
    with Reader(Path(sys.argv[1])) as reader:
        played = [connection for connection in reader.connections if connection.topic not in UNPLAYED]
        publishers = {}
        for connection in played:
            kind = message_class(connection.msgtype)
            publishers[connection.topic] = node.create_publisher(kind, connection.topic, quality(connection))
        limit = time.monotonic() + 90
        while min(publisher.get_subscription_count() for publisher in publishers.values()) < 1:
            assert time.monotonic() < limit, "nobody listens"
            time.sleep(0.02)
        counts: Counter[str] = Counter()
        for connection, _, raw in reader.messages(played):
            counts[connection.topic] += 1
            while counts[connection.topic] <= int(sys.argv[2]):
                try:
                    publishers[connection.topic].publish(bytes(raw))
                    break
                except rclpy._rclpy_pybind11.RCLError:  # the history is full
                    assert time.monotonic() < limit + 60, f"{connection.topic} is stuck"
                    time.sleep(0.002)
            if connection.topic in UNIQUE:  # what the others need is there before them
                publishers[connection.topic].wait_for_all_acked(rclpy.duration.Duration(seconds=10))
    for publisher in publishers.values():
        publisher.wait_for_all_acked(rclpy.duration.Duration(seconds=90))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
