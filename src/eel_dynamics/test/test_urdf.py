# SPDX-License-Identifier: Apache-2.0
"""Robots from URDF: chains become joints and a body, what is not kept is said, what cannot be is one line."""

import re

import numpy as np
import pytest
from eel_dynamics.model import Robot, Servo
from eel_dynamics.model.robot.compiled import mode_table
from scipy.spatial.transform import Rotation

LENGTH, MASS, SIZE = 0.1, 0.25, (0.1, 0.04, 0.06)


def link(name, centre, size=SIZE, mass=MASS, shape=None):
    shape = shape or f'<box size="{size[0]} {size[1]} {size[2]}"/>'
    return f"""
  <link name="{name}">
    <inertial><origin xyz="{centre} 0 0"/><mass value="{mass}"/>
      <inertia ixx="1e-4" iyy="2e-4" izz="3e-4" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="{centre} 0 0"/><geometry>{shape}</geometry></collision>
  </link>"""


def joint(name, parent, child, x, axis="0 0 1", kind="revolute", more="", rpy="0 0 0"):
    return f"""
  <joint name="{name}" type="{kind}">
    <parent link="{parent}"/><child link="{child}"/><origin xyz="{x} 0 0" rpy="{rpy}"/><axis xyz="{axis}"/>
    <limit lower="-0.8" upper="0.6" effort="3.0" velocity="8.0"/><dynamics damping="0.02" friction="0"/>{more}
  </joint>"""


def chain(links=5, sign=-1, axes=("0 0 1",), more=""):
    """A chain of boxes whose base is at the nose (sign -1) or at the tail (+1)."""
    text = link("link_0", sign * LENGTH / 2)
    for index in range(1, links):
        text += link(f"link_{index}", sign * LENGTH / 2)
        axis = axes[(index - 1) % len(axes)]
        text += joint(f"j{index}", f"link_{index - 1}", f"link_{index}", sign * LENGTH, axis)
    return f'<?xml version="1.0"?>\n<robot name="chain">{text}{more}\n</robot>\n'


def robot_of(tmp_path, text, **options):
    path = tmp_path / "eel.urdf"
    path.write_text(text)
    return Robot.from_file(path, **{"joints": "flush"} | options)


def test_a_chain_of_boxes_becomes_joints_and_a_body(tmp_path):
    robot = robot_of(tmp_path, chain(), servo=Servo(kp=20.0))
    assert [part.position for part in robot.joints] == pytest.approx([0.1, 0.2, 0.3, 0.4])
    first = robot.joints[0]
    assert (first.name, first.axis, first.limits, first.damping) == ("j1", "z", (-0.8, 0.6), 0.02)
    assert (first.actuator.kp, first.actuator.torque_limit, first.actuator.speed_limit) == (20.0, 3.0, 8.0)
    body = robot.body
    assert body.length == pytest.approx(0.5) and body.mass == pytest.approx(5 * MASS)
    assert body.half_width(0.25) == pytest.approx(0.02) and body.half_height(0.25) == pytest.approx(0.03)
    assert len(mode_table(robot, body)) == 4 and robot.name == "chain"
    assert all("becomes" in note for note in robot.notes)  # the rounded nose has less mass than its link


def test_a_chain_of_two_links_is_a_robot_of_one_joint(tmp_path):
    (only,) = robot_of(tmp_path, chain(links=2)).joints
    assert (only.name, only.position) == ("j1", pytest.approx(0.1))


def test_a_base_at_the_tail_keeps_the_sign_of_its_angles(tmp_path):
    """A positive turn about z of the part ahead bends the robot to the left, as one of the part behind to the right."""
    from_nose, from_tail = robot_of(tmp_path, chain()), robot_of(tmp_path, chain(sign=1))
    assert [part.name for part in from_tail.joints] == ["j4", "j3", "j2", "j1"]
    assert {part.axis for part in from_nose.joints} == {"z"} and {part.axis for part in from_tail.joints} == {"-z"}
    assert [part.position for part in from_tail.joints] == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert any("the base link is the tail" in note for note in from_tail.notes)


def test_axes_become_yaw_and_pitch_with_their_signs(tmp_path):
    axes = ("0 0 1", "0 0 -1", "0 1 0", "0 -1 0")
    robot = robot_of(tmp_path, chain(axes=axes))
    # behind the base at -x a positive turn about y lifts the tail
    assert [part.axis for part in robot.joints] == ["z", "-z", "y", "-y"]


def turned(axis, angle):
    return Rotation.from_rotvec(angle * np.asarray(axis, float)).as_matrix()


@pytest.mark.parametrize("sign", [-1, 1])
def test_the_shape_at_given_angles_is_that_of_the_urdf(tmp_path, sign):
    """Rigid links by the frames of the URDF, from the base on; and by the modes, from the nose to the tail."""
    axes, angles = ("0 0 1", "0 1 0", "0 0 -1", "0 -1 0"), (0.3, 0.5, -0.7, 0.4)
    robot = robot_of(tmp_path, chain(axes=axes, sign=sign))
    frame, ends = np.eye(3), [np.zeros(3)]  # base: from its own free end at 0 to the first joint
    for axis, angle in zip(axes, angles, strict=True):
        ends.append(ends[-1] + frame @ [sign * LENGTH, 0.0, 0.0])
        frame = frame @ turned([float(word) for word in axis.split()], angle)
    ends.append(ends[-1] + frame @ [sign * LENGTH, 0.0, 0.0])

    table = mode_table(robot, robot.body)
    by_name = {f"j{index + 1}": angle for index, angle in enumerate(angles)}
    section, places = np.diag([-1.0, -1.0, 1.0]), [np.zeros(3)]  # columns E1, E2, E3 in the head's REP-103 axes
    for name, axis, own in zip(table.name, table.axis, table.sign, strict=True):
        places.append(places[-1] + LENGTH * section[:, 0])
        section = section @ turned(np.eye(3)[axis], own * by_name[name])
    places.append(places[-1] + LENGTH * section[:, 0])
    if sign > 0:  # from the other end, in the axes of the link at the nose, which are turned by all joints
        ends = [(end - ends[-1]) @ frame for end in ends[::-1]]
    assert np.allclose(ends, places, atol=1e-12)


def moved(turn):
    """The chain with axes in yaw and pitch, and other half-axes, in a base whose axes are turned by `turn` (3, 3)."""

    def put(match):
        vector = turn @ np.array([float(word) for word in match[2].split()])
        size = np.abs(vector) if match[1] == "size" else vector
        return f'{match[1]}="{" ".join(f"{each:.17g}" for each in size)}"'

    return re.sub('(xyz|size)="([^"]+)"', put, chain(axes=("0 0 1", "0 -1 0", "0 0 -1", "0 1 0")))


@pytest.mark.parametrize(("along", "up"), [("y", "z"), ("-y", "z"), ("z", "x"), ("z", "y"), ("-z", "x"), ("-z", "y")])
def test_the_chain_may_lead_along_any_axis_of_the_base(tmp_path, along, up):
    """The same robot as along -x, but for the axes of its base: upright ones of which say which way is up."""
    axes = {name: np.eye(3)["xyz".index(name[-1])] * (-1.0 if name[0] == "-" else 1.0) for name in (along, up)}
    turn = np.column_stack([-axes[along], np.cross(axes[up], -axes[along]), axes[up]])
    robot, other = (robot_of(tmp_path, moved(each)) for each in (turn, np.eye(3)))
    assert [(part.name, part.axis) for part in robot.joints] == [(part.name, part.axis) for part in other.joints]
    assert [part.position for part in robot.joints] == pytest.approx([part.position for part in other.joints])
    x = np.linspace(0.0, 0.5, 11)
    assert np.allclose(robot.body.half_width(x), other.body.half_width(x), atol=1e-12)
    assert np.allclose(robot.body.half_height(x), other.body.half_height(x), atol=1e-12)
    told = [note for note in robot.notes if "stacked along the base link's z" in note]
    assert len(told) == (along[-1] == "z") and all(str(axes[up].tolist()) in note for note in told)


def test_a_chain_that_is_bent_at_rest_is_refused_with_what_to_do(tmp_path):
    within = chain().replace('<origin xyz="-0.1 0 0" rpy="0 0 0"', '<origin xyz="-0.1 0 0" rpy="0 0 0.4"', 2)
    at_the_end = 'rpy="0 0 0.9"'.join(chain(3).rsplit('rpy="0 0 0"', 1))
    for bent in (within, at_the_end):
        with pytest.raises(ValueError, match=r"must lie on the line of the joints.*at angles of 0 the robot must be"):
            robot_of(tmp_path, bent)


def test_frames_that_turn_along_the_chain_are_followed(tmp_path):
    """Each link's own frame is turned by a quarter about x: its z axis is the base's y, and its y the base's z."""
    text = link("a", -0.05) + link("b", -0.05, size=(0.1, 0.06, 0.04)) + link("c", -0.05, size=(0.1, 0.06, 0.04))
    text += joint("j1", "a", "b", -0.1, axis="0 1 0", rpy="1.5707963267948966 0 0")
    text += joint("j2", "b", "c", -0.1, axis="0 0 1")
    robot = robot_of(tmp_path, f"<robot name='turned'>{text}</robot>")
    assert [part.axis for part in robot.joints] == ["z", "-y"]  # y becomes z; z becomes -y
    assert robot.body.half_height(0.2) == pytest.approx(0.03)


def test_what_is_fixed_to_a_link_is_part_of_it(tmp_path):
    fin = '<link name="fin"><inertial><mass value="0.05"/></inertial></link>'
    fin += (
        '<joint name="glue" type="fixed"><parent link="link_4"/><child link="fin"/><origin xyz="-0.05 0 0.02"/></joint>'
    )
    robot = robot_of(tmp_path, chain(more=fin))
    assert robot.body.mass == pytest.approx(5 * MASS + 0.05) and len(robot.joints) == 4
    assert any("'link_4': centre of mass 0.00333 m off the line" in note for note in robot.notes)


def test_a_mesh_has_the_half_axes_of_its_inertia(tmp_path):
    """The moments of a homogeneous elliptic cylinder, half-axes 0.02 and 0.03, 0.1 m long."""
    a, b, m = 0.03, 0.02, 0.2
    mesh = '<mesh filename="package://eel/link.stl"/>'
    inertia = (m * (a * a + b * b) / 4, m * (a * a / 4 + 0.01 / 12), m * (b * b / 4 + 0.01 / 12))
    text = chain().replace('<box size="0.1 0.04 0.06"/>', mesh).replace(f'value="{MASS}"', f'value="{m}"')
    text = text.replace('ixx="1e-4" iyy="2e-4" izz="3e-4"', 'ixx="{}" iyy="{}" izz="{}"'.format(*inertia))
    robot = robot_of(tmp_path, text)
    assert robot.body.half_height(0.25) == pytest.approx(a, rel=1e-6)
    assert robot.body.half_width(0.25) == pytest.approx(b, rel=1e-6) and robot.body.length == pytest.approx(0.5)
    assert any("half-axes 0.02, 0.03 m from its inertia" in note for note in robot.notes)
    assert any("mesh 'package://eel/link.stl' is not read" in note for note in robot.notes)


def test_what_is_not_kept_is_said(tmp_path):
    gear = "<actuator name='m'><mechanicalReduction>50</mechanicalReduction></actuator>"
    gear = f"<transmission name='t'><joint name='j1'/>{gear}</transmission>"
    text = chain(more=f"{gear}<gazebo/>").replace('friction="0"', 'friction="0.1"')
    robot = robot_of(tmp_path, text)
    assert robot.joints[0].actuator.gear == 50.0 and robot.joints[1].actuator.gear == 1.0
    assert "joint 'j1': dry friction is not modelled" in robot.notes and "elements gazebo are not read" in robot.notes


@pytest.mark.fault(
    "parameters",
    "a URDF with entities, a document type, unknown or branching joints, numbers that are none, or no chain",
    "refused: one short line with file, line and element",
)
@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "line 1: no element found"),
        ("<robot name='a'", "line 1: unclosed token"),
        ("<sdf/>", "line 1, robot: must be the root, got 'sdf'"),
        ("<robot name='a' xmlns:xacro='x'><xacro:include/></robot>", "holds xacro: expand it with xacro first"),
        ("<robot name='a'><link name='b'/></robot>", "robot of 'a': must be a chain of revolute joints, got none"),
        ("<robot name='a'><link/></robot>", "line 1, link: must have a name"),
        (
            '<!DOCTYPE r [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]><robot name="a">&b;</robot>',
            "a document type is not read",
        ),
        ("<robot name='a'>" + "<x>" * 100, "line 1: too many levels"),
        ("<robot name='a'>" + "<x/>" * 30_000 + "</robot>", "line 1: more than 20000 elements"),
        (chain().replace("revolute", "prismatic", 1), "joint of 'j1': type must be revolute, continuous or fixed, got"),
        (chain().replace('<parent link="link_1"', '<parent link="link_0"'), "'link_0' has two that move"),
        (chain().replace('<parent link="link_1"', '<parent link="nobody"'), "must name a link, got 'nobody'"),
        (chain().replace('<child link="link_2"', '<child link="link_1"'), "child 'link_1' has two parents"),
        (
            chain().replace('xyz="-0.1 0 0"', 'xyz="-0.1 x 0"', 1),
            "xyz must be a number of at most 1e+06 in size, got 'x'",
        ),
        (chain().replace('xyz="-0.1 0 0"', 'xyz="-0.1 0"', 1), "xyz must be three numbers, got '-0.1 0'"),
        (chain().replace('xyz="-0.1 0 0"', 'xyz="-0.1 0.05 0"', 2), "must lie on the line of the joints, got"),
        (
            chain().replace('axis xyz="0 0 1"', 'axis xyz="1 0 0"'),
            "axis of 'j1': must point up (yaw) or to the side (pitch), across the line of joints",
        ),
        (chain().replace('axis xyz="0 0 1"', 'axis xyz="0 0 0"'), "axis of 'j1': must have a direction"),
        (chain().replace('upper="0.6"', 'upper="-0.9"'), "limit: lower must be < upper, got -0.8 and -0.9"),
        (chain().replace('effort="3.0"', 'effort="-1"'), "limit: effort must be >= 0, got -1"),
        (
            chain().replace('effort="3.0"', 'effort="inf"'),
            "effort must be a number of at most 1e+06 in size, got 'inf'",
        ),
        (
            chain().replace('effort="3.0"', 'effort="1e300"'),
            "effort must be a number of at most 1e+06 in size, got '1e300'",
        ),
        (
            chain().replace('size="0.1 0.04 0.06"', 'size="0.1 0 0.06"'),
            "box: must have a size > 0 m, got [0.1, 0.0, 0.06]",
        ),
        (chain().replace('box size="0.1 0.04 0.06"', "blob"), "blob: must be box, cylinder, capsule, sphere or mesh"),
        (chain().replace(f'mass value="{MASS}"', 'mass value="-1"'), "mass: must be >= 0 kg, got -1"),
    ],
)
def test_what_a_urdf_cannot_hold_is_one_short_line(tmp_path, text, told):
    with pytest.raises(ValueError) as refused:
        robot_of(tmp_path, text)
    said = str(refused.value)
    assert told in said and "\n" not in said and len(said) < 400


@pytest.mark.parametrize("seed", range(3))
def test_damaged_urdfs_end_in_one_line(tmp_path, seed):
    random = np.random.default_rng(seed)
    text = chain(links=3)
    for _ in range(60):
        cut = bytearray(text.encode())
        for place in random.integers(0, len(cut), 4):
            cut[place] = random.integers(32, 127)
        try:
            robot_of(tmp_path, cut.decode())
        except ValueError as error:
            assert "\n" not in str(error)
