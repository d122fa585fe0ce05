# SPDX-License-Identifier: Apache-2.0
"""Joints that are commanded: position, velocity and effort take effect at once, in the joint's sign, and hold."""

from copy import deepcopy

import numpy as np
import pytest

from eel_dynamics import Accuracy, Joint, Robot, Scene, Servo, Simulation, Torque
from eel_gaits import Law, straight

PLANE = Scene(planar=True)
STILL = Law(name="still")
SERVO = Servo(kp=8.0, kd=0.3, torque_limit=2.0, speed_limit=8.0, rotor_inertia=4e-7, gear=200.0)
PAIR = Robot([Joint(0.35, actuator=SERVO), Joint(0.65, "-yaw", actuator=SERVO)])


def swimming(robot=PAIR, law=STILL, **options):
    return Simulation(scene=PLANE, robot=robot, law=law, **options)


@pytest.mark.parametrize("joint", ["joint_1", "joint_2"])
def test_a_position_is_reached_and_held_in_the_joint_s_own_sign(joint):
    simulation = swimming()
    simulation.command(joint, position=0.3)
    simulation.advance(4.0)
    joints, index = simulation.observe().joints, int(joint[-1]) - 1
    wanted = np.where(np.arange(2) == index, 0.3, 0.0)
    assert joints["joint_angle"] == pytest.approx(wanted, abs=5e-3)  # some torque is left: the body turns yet
    # to the left is towards +y for the part behind
    backbone = simulation.observe().backbone
    ahead, behind = backbone[1] - backbone[0], backbone[-1] - backbone[-2]
    turn = np.arcsin((behind[0] * ahead[1] - behind[1] * ahead[0]) / np.linalg.norm(ahead) / np.linalg.norm(behind))
    assert turn == pytest.approx(0.3 * (1.0 if joint == "joint_1" else -1.0), abs=5e-3)


def test_a_velocity_moves_the_reference_of_the_position():
    simulation = swimming()
    simulation.command("joint_1", velocity=0.2)
    simulation.advance(3.0)
    joints = simulation.observe().joints
    assert joints["joint_rate"][0] == pytest.approx(0.2, abs=0.01)
    assert joints["joint_angle"][0] == pytest.approx(0.6, abs=0.03)
    simulation.command("joint_1", velocity=0.0)  # from the reference of that moment
    simulation.advance(5.0)
    assert simulation.observe().joints["joint_angle"][0] == pytest.approx(0.6, abs=5e-3)


@pytest.mark.parametrize(("effort", "given"), [(0.7, 0.7), (5.0, 2.0), (-5.0, -2.0)])
def test_an_effort_is_given_within_the_limit(effort, given):
    simulation = swimming()
    simulation.command("joint_2", effort=effort)
    simulation.advance(1e-6)
    assert simulation.observe().joints["motor_torque"] == pytest.approx([0.0, given], abs=2e-3)


@pytest.mark.parametrize("joint", ["joint_1", "joint_2"])
def test_with_a_position_the_velocity_is_the_rate_of_the_reference_and_the_effort_is_added(joint):
    """What the servo gives at the first instant, when the joint stands at 0; within its limit."""
    index = int(joint[-1]) - 1
    for position, velocity, effort in ((0.1, 0.5, None), (0.1, None, 0.3), (-0.1, 0.5, 0.3), (None, 0.5, 0.3)):
        simulation = swimming()
        simulation.command(joint, position=position, velocity=velocity, effort=effort)
        wanted = SERVO.kp * (position or 0.0) + SERVO.kd * (velocity or 0.0) + (effort or 0.0)
        assert simulation.observe().joints["motor_torque"][index] == pytest.approx(wanted, abs=1e-12)
        simulation.command(joint, position=0.1, velocity=0.0, effort=5.0)
        assert simulation.observe().joints["motor_torque"][index] == SERVO.torque_limit


def test_a_rate_that_belongs_to_the_reference_lets_the_joint_follow_it_closely():
    """Positions of a wave at 50 Hz: without the wave's rate the damping of the feedback holds the joint back."""
    errors = []
    for rate in (0.0, 1.0):
        simulation, error = swimming(), []
        for k in range(100):
            angle = 4.0 * 0.02 * k
            simulation.command("joint_1", position=0.3 * np.sin(angle), velocity=rate * 1.2 * np.cos(angle))
            simulation.advance(0.02 * (k + 1))
            error.append(simulation.observe().joints["joint_angle"][0] - 0.3 * np.sin(4.0 * 0.02 * (k + 1)))
        errors.append(np.abs(error[20:]).max())
    assert errors[1] < 0.75 * errors[0], errors


@pytest.mark.parametrize("axis", ["yaw", "-yaw"])
def test_a_velocity_moves_the_reference_no_further_than_the_stop(axis):
    """So that a joint at its stop turns back at once."""
    simulation = swimming(Robot([Joint(0.5, axis, limits=(-0.2, 0.3), actuator=SERVO)]))
    simulation.command("joint_1", velocity=1.0)
    simulation.advance(3.0)
    assert simulation.observe().joints["joint_angle"][0] == pytest.approx(0.3, abs=5e-3)
    simulation.command("joint_1", velocity=-1.0)
    simulation.advance(3.25)
    assert simulation.observe().joints["joint_angle"][0] == pytest.approx(0.05, abs=0.05)


def test_a_command_takes_effect_at_its_instant_and_not_before():
    simulation, silent = swimming(), swimming()
    for each in (simulation, silent):
        each.advance(0.123)
    assert np.array_equal(simulation.state, silent.state)
    before = simulation.observe().joints
    simulation.command("joint_1", position=0.1)
    now = simulation.observe().joints
    for name in ("joint_angle", "joint_rate"):  # the step under way is taken again, to end here
        assert now[name][0] == pytest.approx(before[name][0], abs=1e-7)
    assert now["motor_torque"][0] - before["motor_torque"][0] == pytest.approx(SERVO.kp * 0.1, abs=1e-6)


def test_commands_that_say_what_the_law_says_change_nothing():
    """Straight and at rest by the law, or by commands: the same motion but for where the steps end."""
    simulations = [swimming(accuracy=1e-6, twist=(0, 0, 0.5, 0.3, 0, 0)) for _ in range(2)]
    for joint in ("joint_1", "joint_2"):
        simulations[1].command(joint, position=0.0)
    for each in simulations:
        each.advance(1.0)
    one, other = (each.observe() for each in simulations)
    assert one.position == pytest.approx(other.position, abs=1e-8)


def test_without_a_command_the_joint_follows_the_law_again():
    simulation, silent = swimming(law=straight()), swimming(law=straight())
    simulation.advance(0.5)
    simulation.command("joint_1", position=0.5)
    simulation.advance(0.6)
    simulation.command("joint_1")
    for each in (simulation, silent):
        each.advance(4.0)
    angles = [each.observe().joints["joint_angle"] for each in (simulation, silent)]
    assert angles[0] == pytest.approx(angles[1], abs=2e-3)


def test_commands_hold_through_another_law_and_its_grid_and_end_with_a_reset():
    simulation = swimming()
    simulation.command("joint_1", position=0.3)
    simulation.advance(1.0)
    simulation.adopt(straight() * 0.1)
    simulation.advance(6.0)
    assert simulation.observe().joints["joint_angle"][0] == pytest.approx(0.3, abs=0.05)
    simulation.reset()
    assert simulation.observe().joints["motor_torque"][0] == pytest.approx(0.0, abs=0.1)


def test_copies_with_the_same_commands_move_alike_to_the_last_bit():
    simulation = swimming(law=straight())
    simulation.advance(0.3)
    simulation.command("joint_2", effort=0.4)
    other = deepcopy(simulation)
    for each in (simulation, other):
        each.advance(0.7)
    assert np.array_equal(simulation.state, other.state)


def test_the_error_is_measured_under_commands_too():
    simulation = swimming(measure_error=True)
    simulation.command("joint_1", position=0.4)
    simulation.advance(1.0)
    assert 0.0 < simulation.error_estimate.position < 1e-3


def test_the_error_under_steps_of_commands_is_not_underrated():
    """The joints' panels make grids of few settings alike: the companion has another one all the same."""
    runs = []
    for accuracy in (1e-3, Accuracy(name="exact", resolution=50.0, tolerance=1e-7)):
        simulation, torques = swimming(Robot.named("eight_servos"), accuracy=accuracy, measure_error=True), []
        for k in range(50):
            for joint in simulation.robot.joints:
                up = np.sin(2.0 * np.pi * (0.02 * k - joint.position)) > 0.0
                simulation.command(joint.name, position=0.006 * k * (1.0 if up else -1.0))
            simulation.advance(0.02 * (k + 1))
            torques.append(simulation.observe(load=False).torque)
        runs.append((simulation, np.array(torques)))
    (measured, torque), (_, exact) = runs
    apart, size = (np.linalg.norm(each, axis=2).max() for each in (torque - exact, exact))
    assert measured.error_estimate.torque > apart / size > 2e-5
    assert 0.0 < measured.error_estimate.joint_angle < 1e-3 and 0.0 < measured.error_estimate.joint_rate < 0.1


def test_series_springs_that_ring_after_each_command_keep_their_target():
    torques = []
    for accuracy in (1e-3, Accuracy(name="exact", resolution=40.0, tolerance=1e-6)):
        simulation, torque = swimming(Robot.named("series_elastic"), accuracy=accuracy, stations=11), []
        for k in range(25):
            for index, joint in enumerate(simulation.robot.joints):
                simulation.command(joint.name, position=0.3 * np.sin(2.0 * np.pi * (0.02 * k - index / 8.0)))
            simulation.advance(0.02 * (k + 1))
            torque.append(simulation.observe(load=False).torque)
        torques.append(np.array(torque))
    torque, exact = torques
    assert np.linalg.norm(torque - exact, axis=2).max() < 1e-3 * np.linalg.norm(exact, axis=2).max()


@pytest.mark.fault(
    "parameters",
    "a command for an unknown joint, one without a servo, or with NaN",
    "refused: one line with the joint and the value; the last command holds",
)
@pytest.mark.parametrize(
    ("joint", "given", "told"),
    [
        ("neck", {"position": 0.1}, "joint must be one of joint_1, joint_2, joint_3, got 'neck'"),
        (["neck"], {"position": 0.1}, "joint must be one of joint_1, joint_2, joint_3, got ['neck']"),
        ("joint_3", {"position": 0.1}, "joint 'joint_3' cannot be commanded: it has no servo"),
        ("joint_1", {"position": 0.1, "effort": np.inf}, "effort of joint 'joint_1' must be finite, got inf"),
        ("joint_1", {"velocity": np.nan}, "velocity of joint 'joint_1' must be finite, got nan"),
        ("joint_1", {"position": "up"}, "position of joint 'joint_1' must be a number, got 'up'"),
    ],
)
def test_a_command_that_does_not_fit_is_refused(joint, given, told):
    simulation = swimming(Robot([*PAIR.joints, Joint(0.85, width=0.05, actuator=Torque(np.sin))]))
    with pytest.raises(ValueError) as refused:
        simulation.command(joint, **given)
    assert told in str(refused.value)


def test_a_swimmer_without_a_robot_cannot_be_commanded():
    with pytest.raises(ValueError, match="joint 'joint_1' cannot be commanded: there is no robot"):
        Simulation(law=STILL).command("joint_1", position=0.1)
