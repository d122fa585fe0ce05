# SPDX-License-Identifier: Apache-2.0
"""Signs of joints in topics: the shape is that which a URDF's kinematics give of the published angles, by matrices."""

import math
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from eel_dynamics.model.robot.joint_signs import message_sign, sense_of
from eel_dynamics.ros.messages import SampleMessages
from eel_dynamics.ros.parameters import DynamicsParameters
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from swim_client import LIMIT, LOSSLESS, nanoseconds

from eel_dynamics import Simulation
from eel_gaits import Law, Term

FAST = ("-p", "real_time_factor:=0", "-p", "rate:=50", "-p", "duration:=1.5", "-p", "estimate_error:=false")
LINK, AXES = 0.1, ("0 1 0", "0 0 1", "0 -1 0", "0 0 -1")  # m; of joints j1 to j4
END = 1_500_000_000  # ns


def link(name, side):
    return f"""<link name="{name}"><inertial><origin xyz="{0.5 * side * LINK} 0 0"/><mass value="0.25"/>
      <inertia ixx="1e-4" iyy="2e-4" izz="3e-4" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="{0.5 * side * LINK} 0 0"/><geometry><box size="{LINK} 0.04 0.06"/></geometry></collision>
    </link>"""


def chain(side):
    """A URDF of five links, whose base link is the head (side -1) or the tail (1)."""
    text = link("link_0", side)
    for k, axis in enumerate(AXES, start=1):
        text += link(f"link_{k}", side)
        text += f"""<joint name="j{k}" type="revolute"><parent link="link_{k - 1}"/><child link="link_{k}"/>
          <origin xyz="{side * LINK} 0 0"/><axis xyz="{axis}"/>
          <limit lower="-1" upper="1" effort="5" velocity="8"/></joint>"""
    return f"<robot name='chain'>{text}</robot>"


def turned(axis, angle):
    """The rotation (3, 3) by an `angle` [rad] about a unit `axis` (3,), right-handed (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


def matrix(quaternion):
    x, y, z, w = quaternion
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def frames_of_urdf(text, angles):
    """Rotations (3, 3) of the links and the middles (3,) [m] of their shapes, in the base link, from the text alone."""
    root, frame, place, found = ET.fromstring(text), np.eye(3), np.zeros(3), {}
    shapes = {each.get("name"): each.find("collision/origin").get("xyz") for each in root.findall("link")}
    joints = {each.find("parent").get("link"): each for each in root.findall("joint")}
    name = "link_0"
    while True:
        found[name] = frame, place + frame @ np.array([float(word) for word in shapes[name].split()])
        if name not in joints:
            return found
        joint = joints[name]
        place = place + frame @ [float(word) for word in joint.find("origin").get("xyz").split()]
        axis = [float(word) for word in joint.find("axis").get("xyz").split()]
        frame, name = frame @ turned(axis, angles[joint.get("name")]), joint.find("child").get("link")


def swim(start, client, robot, angles, stations):
    """The last samples of joint_states and backbone, and the body, of a robot commanded to `angles` by name."""
    seen = client(topics=("joint_states", "backbone"))
    words = ("--ros-args", "-p", f"robot:={robot}", "-p", f"stations:={stations}", *FAST)
    node = start("dynamics", *words, "-p", "wait_for_subscribers:=1")
    commands = seen.node.create_publisher(JointState, "joint_commands", LOSSLESS)
    seen.until(lambda: commands.get_subscription_count() == 1, "the node's subscription")
    commands.publish(JointState(name=[*angles], position=[*angles.values()]))
    assert node.wait(LIMIT) == 0 and "ERROR" not in node.output(), node.output()
    received = seen.received["joint_states"], seen.received["backbone"]
    seen.until(lambda: all(each and nanoseconds(each[-1].header.stamp) == END for each in received), "the last sample")
    states, line = (each[-1] for each in received)
    rotations = [matrix(each) for each in np.reshape(line.orientation, (-1, 4))]
    return dict(zip(states.name, states.position, strict=True)), np.reshape(line.position, (-1, 3)), rotations, seen


@pytest.mark.parametrize("side", [-1, 1])
def test_a_robot_from_a_urdf_has_the_shape_that_its_kinematics_give_of_the_angles(start, client, tmp_path, side):
    """By tf's rule: the child turns about the axis of its joint by the right-hand rule, whichever end is the base."""
    (tmp_path / "chain.urdf").write_text(text := chain(side))
    asked = dict.fromkeys(("j1", "j2", "j3", "j4"), 0.3)
    angles, places, rotations, _ = swim(start, client, f"{tmp_path / 'chain.urdf'} joints=flush", asked, stations=11)
    assert [angles[name] for name in asked] == pytest.approx([0.3] * 4, abs=0.05)
    wanted = frames_of_urdf(text, angles)
    middles = range(1, 11, 2) if side < 0 else range(9, 0, -2)  # stations at the middles of link_0 to link_4
    base, origin = rotations[middles[0]], places[middles[0]]
    for k, station in enumerate(middles):
        frame, middle = wanted[f"link_{k}"]
        assert base.T @ rotations[station] == pytest.approx(frame, abs=1e-5), k
        assert base.T @ (places[station] - origin) == pytest.approx(middle - wanted["link_0"][1], abs=4e-3), (
            k
        )  # joints have a width
    if side < 0:  # the first joint: pitch about +y, by 0.3 rad: the part behind points its x axis down, its tail rises
        behind = base.T @ rotations[middles[1]]
        assert behind[2, 0] < -0.25 and (base.T @ (places[middles[1]] - origin))[2] > 0.01


@pytest.mark.parametrize(("name", "direction"), [("pitch_4", (0.0, 1.0, 0.0)), ("yaw_4", (0.0, 0.0, 1.0))])
def test_joints_of_a_ready_robot_turn_about_plus_y_and_plus_z(start, client, name, direction):
    """And `body` tells axis and sense, from which the whole chain follows."""
    angles, places, rotations, seen = swim(start, client, "sixteen_servos", {name: 0.3}, stations=51)
    assert angles[name] == pytest.approx(0.3, abs=0.05)
    body = seen.received["body"][-1]
    frame, place, before = np.eye(3), np.zeros(3), 0.0
    for joint in body.joints:
        assert joint.sense == joint.RIGHT_HAND
        place = place - (joint.station - before) * frame[:, 0]
        before = joint.station
        frame = frame @ turned(
            {joint.PITCH: (0.0, 1.0, 0.0), joint.YAW: (0.0, 0.0, 1.0)}[joint.axis], angles[joint.name]
        )
    place = place - (body.length - before) * frame[:, 0]
    head = rotations[0]
    assert head.T @ rotations[-1] == pytest.approx(frame, abs=2e-3)
    assert head.T @ (places[-1] - places[0]) == pytest.approx(place, abs=5e-3)
    assert frame == pytest.approx(turned(direction, 0.3), abs=0.1)
    tail = head.T @ (places[-1] - places[0])
    assert tail[2] > 0.1 if name == "pitch_4" else tail[1] < -0.1  # the tail rises, or goes to the right


@pytest.mark.parametrize("axis", ["pitch", "yaw"])
def test_joints_of_an_imposed_shape_turn_about_plus_y_and_plus_z(axis):
    """Twenty joints of a body that is an arc, in planes through its head: the turns add up to that of the tail."""
    law = Law(Term(axis=axis, amplitude=(0.8,), phase=math.pi / 2))
    simulation = Simulation(law=law, accuracy="draft")
    simulation.advance(0.1)
    now, count = simulation.observe(), 20
    sample = SampleMessages(simulation, DynamicsParameters(**{f"{axis}_joints": count}))
    message = deserialize_message(sample.fill("joint_states", now), sample.kinds["joint_states"])
    about = (0.0, 1.0, 0.0) if axis == "pitch" else (0.0, 0.0, 1.0)
    found = matrix(now.section_orientation[0]).T @ matrix(now.section_orientation[-1])
    assert found == pytest.approx(turned(about, sum(message.position)), abs=0.02)
    assert abs(sum(message.position)) > 0.7


def test_a_sense_tells_what_a_turned_sign_or_a_urdf_means():
    senses = {"yaw": 1, "-yaw": -1, "pitch": 1, "-pitch": -1, "z": 1, "-z": -1, "y": 1, "-y": -1}
    assert {axis: sense_of(axis) for axis in senses} == senses
    assert {axis for axis in senses if message_sign(axis) < 0} == {"yaw", "-yaw"}
