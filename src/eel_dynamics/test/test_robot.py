# SPDX-License-Identifier: Apache-2.0
"""Robots: parts and their bounds, and what the mechanics get of them."""

import copy
import pickle
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np
import pytest
from eel_dynamics.model import Body, Joint, Muscle, PassiveTail, Robot, Servo, Torque
from eel_dynamics.model.robot.compiled import HINGE, mode_table
from eel_dynamics.model.robot.kinds import KINDS
from eel_dynamics.model.robot.ready import READY
from scipy.integrate import quad

from eel_dynamics import simulate
from eel_gaits import Law, Term, falling, straight

BODY = Body.boyer2010()
NAN, INF = float("nan"), float("inf")
MOMENT = Law(Term(axis="yaw", amplitude=(0.1,), period=1.0))


def servo(**fields):
    return Servo(**fields)


@pytest.mark.fault(
    "parameters",
    "a part of a robot with a number that is negative, zero, not finite or no number, or with an unknown axis",
    "refused: one line with part, field, rule and value",
)
@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: Joint(0.3, stiffness=-1.0), "joint stiffness must be >= 0 N m/rad, got -1.0"),
        (lambda: Joint(0.3, damping=NAN), "joint damping must be finite, got nan"),
        (lambda: Joint(0.3, damping=-0.1), "joint damping must be >= 0 N m s/rad, got -0.1"),
        (lambda: Joint(0.3, width=0.0), "joint width must be > 0 m, got 0.0"),
        (lambda: Joint(0.3, width=-INF), "joint width must be finite, got -inf"),
        (lambda: Joint("0.3"), "joint position must be a number, got '0.3'"),
        (lambda: Joint(0.3, "roll"), "joint axis must be one of yaw, -yaw, pitch, -pitch, z, -z, y, -y, got 'roll'"),
        (lambda: Joint(0.3, limits=(0.4, -0.4)), "joint limits must be two numbers that rise, got [0.4, -0.4]"),
        (lambda: Joint(0.3, limits=0.4), "joint limits must be two numbers that rise, got 0.4"),
        (lambda: Joint(0.3, limits=(0.0, NAN)), "joint limits must be finite, got nan"),
        (lambda: Joint(0.3, actuator="servo"), "joint actuator must be a Servo or a Torque, got 'servo'"),
        (lambda: Joint(0.3, name=3), "joint name must be a text of at most 100 characters, got 3"),
        (lambda: Joint(0.3, armature=-1e-3), "joint armature must be >= 0 kg m^2, got -0.001"),
        (lambda: servo(kp=-1.0), "servo kp must be >= 0 N m/rad, got -1.0"),
        (lambda: servo(kd=INF), "servo kd must be finite, got inf"),
        (lambda: servo(torque_limit=0.0), "servo torque_limit must be > 0 N m, got 0.0"),
        (lambda: servo(speed_limit=0), "servo speed_limit must be > 0 rad/s, got 0"),
        (lambda: servo(gear=0.5), "servo gear must be >= 1, got 0.5"),
        (lambda: servo(rotor_inertia=-1e-6), "servo rotor_inertia must be >= 0 kg m^2, got -1e-06"),
        (lambda: servo(series_stiffness=50.0), "servo rotor_inertia must be > 0 kg m^2 with a series spring, got 0.0"),
        (lambda: servo(series_damping=0.1), "servo series_damping goes with series_stiffness, got 0.1 alone"),
        (lambda: Torque(1.0), "torque must be a function of the time, or values with time=, got 1.0"),
        (lambda: Torque([1.0, 2.0], [0.0, 0.0]), "torque time must be two instants or more that rise, got [0.0, 0.0]"),
        (lambda: Torque([1.0, NAN], [0.0, 1.0]), "torque must be finite, got nan at index 1"),
        (lambda: Torque([1.0], [0.0, 1.0]), "torque must have as many values as time, 2, got 1"),
        (lambda: Torque(lambda time: "x").at(1.5), "torque must give one finite number, got 'x' at 1.5 s"),
        (lambda: PassiveTail(0.6, -1.0), "passive tail bending_stiffness must be >= 0 N m^2, got -1.0"),
        (lambda: PassiveTail(0.6, 1.0, NAN), "passive tail damping must be finite, got nan"),
        (lambda: PassiveTail(0.6, 1.0, modes=0), "passive tail modes must be >= 1, got 0"),
        (lambda: PassiveTail(0.6, 1.0, modes=2.5), "passive tail modes must be a whole number, got 2.5"),
        (lambda: PassiveTail(0.6, 1.0, end=0.5), "passive tail end must be > start (0.6 m), got 0.5"),
        (lambda: PassiveTail(0.6, 1.0, axis="-yaw"), "passive tail axis must be yaw or pitch, got '-yaw'"),
        (lambda: Muscle(0.1, 0.9, 1.0, 0.1, 3.0), "muscle moment must be a Law, got 3.0"),
        (
            lambda: Muscle(0.1, 0.9, 1.0, 0.1, MOMENT, axis="pitch"),
            "muscle moment must have terms in pitch alone, got yaw",
        ),
        (lambda: Robot("joints"), "robot parts must be joints, passive tails and muscles, got 'joints'"),
        (lambda: Robot([Joint(0.3), 3]), "a robot's part must be a Joint or a PassiveTail or a Muscle, got 3"),
        (lambda: Robot([Joint(0.3, name="a"), Joint(0.5, name="a")]), "must have a name of its own, got 'a' twice"),
        (lambda: Robot([Joint(0.3)]).joint("joint_2"), "joint must be one of joint_1, got 'joint_2'"),
        (lambda: Robot([Joint(0.3)]).changed(torque_limit=1.0), "no part of the robot has 'torque_limit'"),
        (lambda: Robot([Joint(0.3)]).changed("joint_1", kp=1.0), "'joint_1' has no 'kp'"),
        (
            lambda: Robot([Joint(0.3)]).changed("neck", width=0.1),
            "part must be one of joint_1, joints, servos, tails, muscles, got 'neck'",
        ),
        (
            lambda: Robot.named("ten_servos"),
            "robot must be one of eight_servos, sixteen_servos, series_elastic, passive_tail, a file",
        ),
    ],
)
def test_what_a_part_cannot_be_is_refused_by_field_and_value(make, told):
    with pytest.raises(ValueError) as refused:
        make()
    assert told in str(refused.value) and "\n" not in str(refused.value)


@pytest.mark.fault(
    "parameters",
    "a robot that does not fit its body: a support outside, in the nose, or twice; pitch in a planar scene; modes that "
    "are not independent",
    "refused: one line with the part, the field and the values",
)
@pytest.mark.parametrize(
    ("parts", "told"),
    [
        ([Joint(0.99, width=0.04)], "joint 'joint_1' position and width must lie inside (0, 1) m, got 0.97 to 1.01 m"),
        ([Joint(1.5)], "joint 'joint_1' position and width must lie inside (0, 1) m"),
        ([Joint(0.06, width=0.04)], "must lie behind the nose's first panel, from 0.05 m on"),
        ([Joint(0.3), Joint(0.3)], "joints of one axis must have positions of their own, got 0.3 m twice"),
        (
            [Joint(0.3, width=0.1), Joint(0.3, width=0.1)],
            "joint 'joint_2' must have a support of its own, got 0.25 to 0.35 m, which is that of 'joint_1'",
        ),
        ([Joint(0.3, "pitch")], "joint 'joint_1' axis must be yaw in a planar scene, got pitch"),
        ([PassiveTail(0.6, 1.0, axis="pitch")], "passive tail 'tail' axis must be yaw in a planar scene, got pitch"),
        ([PassiveTail(0.6, 1.0, end=1.2)], "passive tail 'tail' start and end must lie in 0 to 1 m, got 0.6 to 1.2"),
        (
            [PassiveTail(0.6, lambda x: 0.9 - x)],
            "passive tail 'tail' bending_stiffness must be finite and >= 0, got -8.28052e-06 at X = 0.900008 m",
        ),
    ],
)
def test_what_does_not_fit_the_body_is_refused(parts, told):
    with pytest.raises(ValueError) as refused:
        mode_table(Robot(parts), BODY, planar=True)
    assert told in str(refused.value)


def test_robots_are_equal_by_value_and_survive_copies():
    for name in READY:
        robot = Robot.named(name)
        for other in (Robot.named(name), copy.deepcopy(robot), pickle.loads(pickle.dumps(robot))):
            assert robot == other and hash(robot) == hash(other)
        assert mode_table(robot, BODY) is mode_table(Robot.named(name), BODY)
    robot = Robot.named("eight_servos")
    weaker = robot.changed("joint_3", torque_limit=1.0)
    assert weaker != robot and weaker.joint("joint_3").actuator.torque_limit == 1.0
    assert weaker.joint("joint_2") == robot.joint("joint_2")
    assert repr(robot) == "Robot('eight_servos', 8 Joint)"
    assert repr(Joint(0.3, stiffness=2.0)) == "Joint(position=0.3, stiffness=2.0)"
    sampled = Torque([0.0, 1.0, 0.0], [0.0, 0.5, 1.0])
    assert sampled == pickle.loads(pickle.dumps(sampled)) and sampled.at(0.5) == 1.0 and sampled.at(9.0) == 0.0


def test_joints_are_ordered_and_named_along_the_body():
    robot = Robot([Joint(0.7), Joint(0.3, name="neck"), Joint(0.5, "pitch"), PassiveTail(0.8, 1.0)])
    assert [part.name for part in robot.parts] == ["neck", "joint_2", "joint_3", "tail"]


def test_modes_integrate_to_one_or_are_legendre_polynomials():
    robot = Robot([Joint(0.3, width=0.1), Joint(0.5, "pitch", width=0.02), PassiveTail(0.6, lambda x: x, 0.5, modes=3)])
    table = mode_table(robot, BODY)
    assert table.degree.tolist() == [HINGE, HINGE, 0, 1, 2] and table.axis.tolist() == [2, 1, 2, 2, 2]
    for mode in (0, 1):
        inside = (table.start[mode], table.end[mode])
        assert quad(lambda x, mode=mode: table.shape(np.array([x]))[mode, 0], *inside)[0] == pytest.approx(1.0, 1e-12)
    for m in range(2, 5):
        for n in range(2, 5):

            def product(x, m=m, n=n, weight=1.0):
                return weight * np.prod(table.shape(np.array([x]))[[m, n], 0])

            damping, stiffness = (quad(each, 0.6, 1.0)[0] for each in (product, lambda x, p=product: p(x, weight=x)))
            assert table.damping[m, n] == pytest.approx(0.5 * damping, abs=1e-12)
            assert table.stiffness[m, n] == pytest.approx(stiffness, abs=1e-12)
    assert table.edges == pytest.approx((0.25, 0.35, 0.49, 0.51, 0.6))


def test_widths_equal_to_the_spacing_share_their_edges():
    table = mode_table(Robot([Joint(0.1 + 0.1 * j, width=0.1) for j in range(9)]), BODY)
    assert len(table.edges) == 10 and set(table.start[1:]) == set(table.end[:-1])


def test_references_are_the_law_s_bend_from_midpoint_to_midpoint():
    law, time = falling(), 4.3
    robot = Robot.named("eight_servos")
    table = mode_table(robot, BODY)
    reference = table.projection @ law.curvature(time, table.points)[0][:, 2]
    ends = [0.0, *(0.16 + 0.12 * j for j in range(7)), 1.0]
    exact = [quad(lambda x: law.curvature(time, x)[0][0, 2], *pair)[0] for pair in pairwise(ends)]
    assert reference == pytest.approx(exact, abs=1e-12)
    # widths equal to the spacing: the reference is the integral over the joint's own support
    whole = mode_table(Robot([Joint(0.1 + 0.1 * j, width=0.1, actuator=Servo()) for j in range(9)]), BODY)
    reference = whole.projection @ law.curvature(time, whole.points)[0][:, 2]
    inner = [quad(lambda x: law.curvature(time, x)[0][0, 2], 0.05 + 0.1 * j, 0.15 + 0.1 * j)[0] for j in range(1, 8)]
    assert reference[1:-1] == pytest.approx(inner, abs=1e-12)


def test_the_law_is_imposed_where_no_motor_and_no_part_is():
    x = np.array([0.1, 0.3, 0.59, 0.61, 0.9])
    tail = mode_table(Robot.named("passive_tail"), BODY)
    assert tail.imposed(x).T.tolist() == [[True, True]] * 3 + [[True, False]] * 2
    servos = mode_table(Robot.named("eight_servos"), BODY)
    assert servos.imposed(x).T.tolist() == [[True, False]] * 5
    hinge = mode_table(Robot([Joint(0.6, "pitch", width=0.04, stiffness=1.0)]), BODY)
    assert hinge.imposed(x).T.tolist() == [[True, True]] * 2 + [[False, True]] * 2 + [[True, True]]
    both = mode_table(Robot([Joint(0.3, actuator=Servo()), PassiveTail(0.6, 1.0)]), BODY)
    assert both.projection[0].sum() == pytest.approx(0.6) and not both.projection[1:].any()


def test_angles_are_positive_to_the_left_and_up():
    given = {"rest_angle": 0.1, "limits": (-0.2, 0.5)}
    table = mode_table(Robot([Joint(0.3, **given), Joint(0.5, "-yaw", **given), Joint(0.7, "pitch", **given)]), BODY)
    assert table.sign.tolist() == [-1.0, 1.0, -1.0]  # K3 > 0 bends to the right, K2 > 0 down
    assert table.rest.tolist() == [-0.1, 0.1, -0.1]
    assert table.limits.tolist() == [[-0.5, 0.2], [-0.2, 0.5], [-0.5, 0.2]]


def test_a_stiff_gear_adds_rotor_and_friction_to_the_joint_and_a_series_spring_does_not():
    motor = {"gear": 100.0, "rotor_inertia": 1e-7, "friction": 0.02}
    stiff, soft = Servo(**motor), Servo(**motor, series_stiffness=50.0)
    table = mode_table(
        Robot([Joint(0.3, armature=1e-3, damping=0.1, actuator=stiff), Joint(0.5, armature=1e-3, actuator=soft)]), BODY
    )
    assert table.armature == pytest.approx([2e-3, 1e-3, 1e-3])
    assert np.diag(table.damping) == pytest.approx([0.12, 0.0, 0.02])
    assert table.stiffness == pytest.approx(50.0 * np.array([[0, 0, 0], [0, 1, -1], [0, -1, 1]]))
    assert table.motors == ((stiff, 0, 0), (soft, 1, 2)) and table.name == ("joint_1", "joint_2", "joint_2")
    assert [each.reflected_inertia for each in (stiff, soft)] == pytest.approx([1e-3, 1e-3])
    assert [each.has_spring for each in (stiff, soft)] == [False, True]


def test_the_moment_of_a_muscle_is_projected_on_its_modes():
    table = mode_table(Robot([Joint(0.2), Muscle(0.3, 0.9, 1.0, 0.1, MOMENT, modes=3)]), BODY)
    (muscle,) = table.muscles
    assert muscle.modes.tolist() == [1, 2, 3]
    moment = np.sin(3.0 * muscle.points)
    for row, mode in zip(muscle.projection, muscle.modes, strict=True):
        exact = quad(lambda x, mode=mode: table.shape(np.array([x]))[mode, 0] * np.sin(3.0 * x), 0.3, 0.9)[0]
        assert row @ moment == pytest.approx(exact, abs=1e-13)


def test_a_new_kind_of_part_needs_its_class_and_a_line_of_kinds(monkeypatch, tmp_path):
    """A keel: a passive tail of another kind, with a list of its own in files, and numbers by name."""

    @dataclass(frozen=True, repr=False)
    class Keel(PassiveTail):
        what: ClassVar[str] = "keel"
        key: ClassVar[str] = "keels"

    monkeypatch.setitem(KINDS, "keels", Keel)
    path = tmp_path / "keeled.yaml"
    path.write_text("body: boyer2010\nkeels: [{start: 0.6, bending_stiffness: 0.3, damping: 0.01, name: keel}]\n")
    keeled = Robot.from_file(path)
    assert type(keeled.parts[0]) is Keel and keeled.with_numbers({"keel.damping": 0.02}).parts[0].damping == 0.02
    tailed = Robot([PassiveTail(0.6, 0.3, 0.01, name="keel")])
    options = {"accuracy": "draft", "estimate": False}
    run, other = (simulate(straight(), 0.5, robot=robot, **options) for robot in (keeled, tailed))
    assert run.mode_amplitude.tobytes() == other.mode_amplitude.tobytes() and run.mode_amplitude.any()
