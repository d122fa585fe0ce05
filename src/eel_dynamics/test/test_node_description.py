# SPDX-License-Identifier: Apache-2.0
"""The topic robot_description over DDS: late subscribers get it, and with joint_states it is the body on backbone."""

from types import SimpleNamespace
from typing import ClassVar
from xml.etree import ElementTree

import numpy as np
import pytest
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.robot_description import RobotDescription
from eel_gaits.ros.messages import law_to_message
from scipy.spatial.transform import Rotation
from std_msgs.msg import String
from swim_client import LATCHED
from tf2_msgs.msg import TFMessage
from urdf_frames import frames

from eel_dynamics import Simulation
from eel_gaits import Law, Term, straight

BOTH = Law(
    Term(axis="yaw", amplitude=(0.5, 1.0), wavelength=1.0, period=1.0),
    Term(axis="pitch", amplitude=(0.5, 1.0), wavelength=1.0, period=1.3),
)
TOPICS = "joint_states", "backbone", "head_pose"


def pose_of(position, orientation):
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = Rotation.from_quat(orientation).as_matrix(), position
    return made


def errors(swim, text, stations):
    """Distance [m] and angle [rad] of each link's frame, moved along the link to its station, from the backbone there.

    stations: by joint, index on the backbone and distance [m] behind the joint.
    """
    joints, backbone, head = (swim.received[topic][-1] for topic in TOPICS)
    assert joints.header.stamp == backbone.header.stamp == head.header.stamp
    point, turn = head.pose.position, head.pose.orientation
    base = pose_of([point.x, point.y, point.z], [turn.x, turn.y, turn.z, turn.w])
    poses = frames(text, dict(zip(joints.name, joints.position, strict=True)), base)
    links = {
        joint.get("name"): joint.find("child").get("link") for joint in ElementTree.fromstring(text).findall("joint")
    }
    positions, orientations = np.reshape(backbone.position, (-1, 3)), np.reshape(backbone.orientation, (-1, 4))
    for name, (index, behind) in stations.items():
        pose, section = poses[links[name]], pose_of(positions[index], orientations[index])
        yield (
            np.linalg.norm(pose[:3, 3] - behind * pose[:3, 0] - section[:3, 3]),
            Rotation.from_matrix(pose[:3, :3].T @ section[:3, :3]).magnitude(),
            abs(joints.position[joints.name.index(name)]),
        )


def described(swim):
    """What a subscriber that comes now gets."""
    swim.listen("robot_description", String, LATCHED)
    return swim.latest("robot_description").data


def test_a_late_subscriber_gets_the_robot_as_it_swims_and_another_after_a_reset(start, client):
    swim = client(topics=TOPICS)
    start("dynamics", "--ros-args", "-p", "robot:=eight_servos", "-p", "stations:=101", "-p", "estimate_error:=false")
    swim.laws.publish(law_to_message(straight()))
    swim.until_time(0.6, *TOPICS)
    swim.stop_the_clock(*TOPICS)
    text = described(swim)
    stations = {f"joint_{k + 1}": (13 + 12 * k, 0.03) for k in range(8)}  # behind the arc, on the rigid link
    far, angle, bent = np.max([*errors(swim, text, stations)], axis=0)
    assert bent > 0.1 and far < 0.003 and angle < 1e-9
    assert len(ElementTree.fromstring(text).findall("joint")) == 9

    (answer,) = swim.set(robot="sixteen_servos")
    assert answer.successful, answer.reason
    assert swim.reset().success
    swim.until(lambda: len(swim.received["robot_description"]) == 2, "the other robot's description")
    assert len(ElementTree.fromstring(swim.received["robot_description"][-1].data).findall("joint")) == 17


def test_an_imposed_shape_is_a_chain_with_the_joints_of_joint_states_below_its_namespace(start, client):
    swim = client(topics=TOPICS, namespace="eel1")
    swim.listen("/tf", TFMessage)
    start(
        *("dynamics", "--ros-args", "-r", "__ns:=/eel1", "-p", "yaw_joints:=10", "-p", "pitch_joints:=5"),
        *("-p", "stations:=101", "-p", "estimate_error:=false"),
    )
    swim.laws.publish(law_to_message(BOTH))
    swim.until_time(1.2, *TOPICS)
    swim.stop_the_clock(*TOPICS)
    text = described(swim)
    names = {link.get("name") for link in ElementTree.fromstring(text).findall("link")}
    assert swim.latest("/tf").transforms[0].child_frame_id == "eel1/base_link"
    assert names == {"eel1/base_link", *(f"eel1/link_{k}" for k in range(16))}
    # up to there are all of a joint's parts, in yaw and pitch; the order of turns in yaw and pitch is another
    stations = {f"yaw_{k}": (10 * k, 0.05) for k in range(2, 11, 2)}
    far, angle, bent = np.max([*errors(swim, text, stations)], axis=0)
    assert bent > 0.05 and far < 0.01 and angle < 0.02
    joints = swim.received["joint_states"][-1]
    assert max(abs(joints.position[joints.name.index(f"pitch_{k + 1}")]) for k in range(5)) > 0.1


def test_without_a_description_there_is_no_such_topic(start, client):
    swim = client(topics=("head_pose",))
    start("dynamics", "--ros-args", "-p", "publish_robot_description:=false", "-p", "estimate_error:=false")
    swim.laws.publish(law_to_message(straight()))
    swim.until_time(0.1)
    assert swim.node.count_publishers("robot_description") == 0


@pytest.mark.fault(
    "parameters", "names of frames that no URDF can hold", "no robot_description, one WARN; the node goes on"
)
def test_a_swimmer_that_no_urdf_holds_is_told_of_once(start, client):
    swim = client(topics=("head_pose",))
    node = start("dynamics", "--ros-args", "-p", "head_frame:=link_0", "-p", "estimate_error:=false")
    swim.laws.publish(law_to_message(straight()))
    swim.until_time(0.1)
    assert swim.node.count_publishers("robot_description") == 0
    assert node.output().count("robot_description is not published: each link in a URDF must have a name") == 1


def test_the_description_of_the_swimmer_before_is_withdrawn_where_the_next_has_none():
    class Node:
        topics: ClassVar[list[str]] = []

        def create_publisher(self, kind, topic, quality):
            self.topics.append(topic)
            return SimpleNamespace(publish=lambda message: None)

        def destroy_publisher(self, publisher):
            self.topics.pop()

        def get_logger(self):
            return SimpleNamespace(warning=lambda text: None)

    description, swimmer = RobotDescription(Node()), Simulation(law=straight())
    description.publish(swimmer, DynamicsParameters())
    assert Node.topics == ["robot_description"]
    description.publish(swimmer, DynamicsParameters(head_frame="link_0"))
    assert Node.topics == []
    description.publish(swimmer, DynamicsParameters())
    assert Node.topics == ["robot_description"]
