# SPDX-License-Identifier: Apache-2.0
"""Joint angles in a bag come out as they went in."""

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from eel_viz.bags.definitions import definition, type_hash
from eel_viz.bags.swimmer_messages import JOINTS, joint_states
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import StoragePlugin, Writer
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

TIMES = 0.02 * np.arange(30)
ANGLES = 0.3 * np.sin(6.0 * TIMES[:, None] - np.arange(3))


def write_bag(folder, *topics, storage=StoragePlugin.MCAP):
    with Writer(folder, version=9, storage_plugin=storage) as writer:
        for topic in topics:
            connection = writer.add_connection(topic, JOINTS, msgdef=definition(JOINTS), rihs01=type_hash(JOINTS))
            for index, (t, angles) in enumerate(zip(TIMES, ANGLES, strict=True)):
                names = [f"joint_{place}" for place in range(3)]
                if index % 2:  # a message may list them in another order
                    names, angles = names[::-1], angles[::-1]
                stamp = Time(sec=5, nanosec=round(1e9 * t))
                message = JointState(header=Header(stamp=stamp), name=names, position=angles.tolist())
                writer.write(connection, 10**9 + index, serialize_message(message))
    return folder


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_joints_of_a_bag_stand_in_the_order_of_the_first_message(tmp_path, storage):
    time, angles, names = joint_states(write_bag(tmp_path / "bag", "/joint_states", storage=storage))
    assert names == ["joint_0", "joint_1", "joint_2"]
    assert np.allclose(time, 5.0 + TIMES) and np.allclose(angles, ANGLES)


def test_one_topic_of_joints_must_be_chosen(tmp_path):
    bag = write_bag(tmp_path / "bag", "/a/joints", "/b/joints")
    assert len(joint_states(bag, "b/joints")[0]) == len(TIMES)
    for topic, words in ((None, "several topics.*/a/joints, /b/joints"), ("c", "no such topic")):
        with pytest.raises(ValueError, match=words):
            joint_states(bag, topic)
