# SPDX-License-Identifier: Apache-2.0
"""Robots from YAML: what is meant is read, what cannot be is one line with file, line and key."""

import json
from pathlib import Path

import numpy as np
import pytest
from eel_dynamics.model import Body, Joint, Muscle, PassiveTail, Robot, Servo, Torque
from eel_dynamics.model.robot.ready import READY, XM430_W210
from eel_dynamics.model.robot.robot_file import plain_of_robot, robot_arguments

from eel_gaits import Law, Term

GOOD = """\
name: mine
joints:
  - position: [0.10, 0.22]
    servo: {kp: 13.8, kd: 0.37, torque_limit: 3, speed_limit: 8.06}
  - {position: 0.34, servo: xm430_w210, limits: [-0.8, 0.8], name: waist}
  - {position: 0.5, axis: pitch, torque: {time: [0, 1, 2], torque: [0, 0.5, 0]}}
tails:
  - {start: 0.8, bending_stiffness: {x: [0.8, 1.0], values: [1e-1, 1e-2]}}
muscles:
  - {start: 0.6, end: 0.8, bending_stiffness: 1, damping: 0.1,
     moment: [{amplitude: [0.5, 0.1], wavelength: 1, period: 1, envelope: [{start: 0, end: 1, delta: 1}]}]}
"""


def robot_of(tmp_path, text, name="eel.yaml"):
    path = tmp_path / name
    path.write_text(text)
    return Robot.from_file(path)


def test_every_part_is_read(tmp_path):
    robot = robot_of(tmp_path, GOOD)
    servo = Servo(kp=13.8, kd=0.37, torque_limit=3.0, speed_limit=8.06)
    assert robot.joints == (
        Joint(0.10, actuator=servo, name="joint_1"),
        Joint(0.22, actuator=servo, name="joint_2"),
        Joint(0.34, actuator=XM430_W210, limits=(-0.8, 0.8), name="waist"),
        Joint(0.5, "pitch", actuator=Torque((0.0, 0.5, 0.0), (0.0, 1.0, 2.0)), name="joint_4"),
    )
    muscle, tail = robot.parts[4:]
    assert muscle.moment.terms[0].envelope[0].end == 1.0 and muscle.moment.terms[0].amplitude == (0.5, 0.1)
    assert isinstance(tail, PassiveTail) and tail.bending_stiffness(np.array([0.8, 1.0])) == pytest.approx([0.1, 0.01])
    assert robot.name == "mine" and robot_of(tmp_path, "joints: [{position: 0.3}]").name == "eel"


def test_a_body_lies_beside_the_file_or_has_a_name(tmp_path):
    (tmp_path / "fish.csv").write_text("x,half_width,half_height\n0,0,0\n0.1,0.02,0.03\n0.2,0.02,0.03\n0.5,0.01,0.01\n")
    assert robot_of(tmp_path, "body: fish.csv\njoints: [{position: 0.3}]").body.length == 0.5
    assert robot_of(tmp_path, "body: boyer2010\njoints: [{position: 0.3}]").body == Body.boyer2010()


@pytest.mark.fault(
    "parameters",
    "a robot file with unknown keys, wrong kinds, values that no part takes, cuts, aliases without end, or 1 MB",
    "refused: one short line with file, line and key",
)
@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "line 1: a robot must have keys such as joints, got None"),
        ("joints: []", "must hold joints, or tails or muscles in their place, got none"),
        ("joints: 3", "line 1, key 'joints': must be a list, got 3"),
        ("joints: [3]", "line 1, key 'joints': must hold mappings of fields, got 3"),
        ("joints: [{axis: yaw}]", "line 1: joint position must be given"),
        (
            GOOD.replace("limits", "limit"),
            "line 5, key 'limit': joint has no field 'limit' (did you mean 'limits'?)",
        ),
        (
            GOOD.replace("[-0.8, 0.8]", "[0.8, -0.8]"),
            "line 5, key 'limits': joint limits must be two numbers that rise",
        ),
        (GOOD.replace("kd: 0.37", "kd: -1"), "line 4, key 'kd': servo kd must be >= 0 N m s/rad, got -1"),
        (GOOD.replace("kd: 0.37", "kd: .nan"), "line 4, key 'kd': servo kd must be finite, got nan"),
        (GOOD.replace("xm430_w210", "xl"), "line 5, key 'servo': must be one of xm430_w210, or a mapping, got 'xl'"),
        (GOOD.replace("torque: [0, 0.5, 0]", "torque: [0, 0.5]"), "torque must have as many values as time, 3, got 2"),
        (
            GOOD.replace("0.10, 0.22", "0.10, high"),
            "line 3, key 'position': joint position must be a number, got 'high'",
        ),
        (GOOD.replace("bending_stiffness: 1,", ""), "muscle bending_stiffness must be given"),
        (
            GOOD.replace("period: 1", "periods: 1"),
            "key 'periods': term has no field 'periods' (did you",
        ),
        (GOOD.replace("end: 1,", "stop: 1,"), "key 'stop': ramp has no field 'stop'"),
        (GOOD.replace("values: [1e-1, 1e-2]", "values: [1]"), "table values must be as many as x, 2, got 1"),
        (GOOD.replace("axis: pitch", "name: waist"), "eel.yaml': each part of a robot must have a name of its own"),
        ("body: fish\njoints: [{position: 0.3}]", "line 1, key 'body': body must be one of boyer2010, kern2006"),
        ("body: 3\njoints: [{position: 0.3}]", "line 1, key 'body': must be a name or a file, got 3"),
        ("joints: [{position: 0.3", "line 1"),
        ("a: &a [*a]\njoints: *a", "line"),
        ("joints:\n" + "  - {position: 0.3}\n" * 40_000, "must have at most 500000 bytes"),
    ],
)
def test_what_a_file_cannot_hold_is_one_short_line(tmp_path, monkeypatch, text, told):
    monkeypatch.chdir(tmp_path)  # a long path would have the line cut
    with pytest.raises(ValueError) as refused:
        robot_of(Path(), text)
    said = str(refused.value)
    assert told in said and "\n" not in said and len(said) < 400


@pytest.mark.parametrize("name", ["eel.txt", "eel"])
def test_other_kinds_of_files_are_refused(tmp_path, name):
    with pytest.raises(ValueError, match=r"robot file must be \.yaml, \.yml, \.urdf or \.xml, got"):
        robot_of(tmp_path, GOOD, name)


def test_a_robot_survives_plain_values():
    moment = Law(Term(amplitude=(0.5,), period=1.0), name="law")
    robots = [Robot.named(name) for name in READY]
    robots.append(
        Robot([Joint(0.2, "-yaw", actuator=Torque([0.0, 1.0], [0.0, 1.0])), Muscle(0.3, 0.8, 1.0, 0.1, moment)])
    )
    for robot in robots:
        plain = json.loads(json.dumps(plain_of_robot(robot, 1.0)))
        assert Robot(**robot_arguments(plain)) == robot
    sloped = Robot([PassiveTail(0.6, lambda x: 1.0 - 0.5 * x)])
    (tail,) = Robot(**robot_arguments(plain_of_robot(sloped, 1.0))).parts
    assert tail.bending_stiffness(0.77) == pytest.approx(1.0 - 0.5 * 0.77, abs=1e-6)
    with pytest.raises(ValueError, match="joint 'joint_1' torque is a function, which no file holds"):
        plain_of_robot(Robot([Joint(0.2, actuator=Torque(np.sin))]), 1.0)
