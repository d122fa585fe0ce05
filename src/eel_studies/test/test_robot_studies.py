# SPDX-License-Identifier: Apache-2.0
"""Studies of robots: sweeps, gradients, fits and optimal gaits over numbers of joints, motors and tails."""

import numpy as np
import pytest
from eel_studies.identification.command import main as identify_main
from eel_studies.sweeps.command import main as sweep_main

from eel_dynamics import Accuracy, Joint, PassiveTail, Robot, Scene, Servo, simulate
from eel_gaits import straight
from eel_studies import MeasuredAngles, MeasuredPath, gradient, identify, optimise, sweep

PLANE = Scene(planar=True, friction="blended")
SERVO = Servo(kp=6.0, kd=0.15, gear=200.0, rotor_inertia=4e-7)
MIXED = Robot(
    [*(Joint(x, actuator=SERVO) for x in (0.3, 0.5, 0.7)), Joint(0.85, width=0.06, stiffness=1.5, damping=0.05)]
)
FINE = Accuracy(name="fine", resolution=40.0, tolerance=1e-8)
MEASURES = "head_x", "actuator_work"


def swum(robot, law=None, duration=2.0, accuracy=1e-3, **more):
    return simulate(law or straight(), duration, robot=robot, scene=PLANE, accuracy=accuracy, estimate=False, **more)


def test_a_point_of_a_sweep_is_the_swim_of_that_robot():
    grid = {"robot.torque_limit": [0.2, 3.0], "robot.joint_3.kp": [5.0, 20.0], "period": [0.8]}
    data = sweep(grid, robot="eight_servos", scene=PLANE, duration=1.0, accuracy=1e-2, estimate=False, measure=MEASURES)
    robot = Robot.named("eight_servos").changed(torque_limit=0.2).changed("joint_3", kp=20.0)
    run = swum(robot, straight(period=0.8), 1.0, 1e-2, stations=51)
    point = data.sel({"robot.torque_limit": 0.2, "robot.joint_3.kp": 20.0, "period": 0.8})
    assert float(point.head_x) == run.position[-1, 0]
    assert float(point.actuator_work) == run.energy.actuator_work[-1]
    assert len(set(data.head_x.values.ravel().tolist())) == 4


def test_robots_are_an_axis_of_a_sweep_and_infinity_is_no_limit():
    robots = [Robot.named("eight_servos"), Robot.named("passive_tail")]
    data = sweep({"robot": robots}, scene=PLANE, duration=0.5, accuracy=1e-2, estimate=False, measure=("head_x",))
    assert data.robot.values.tolist() == ["eight_servos", "passive_tail"]
    assert float(data.head_x[1]) == swum(robots[1], None, 0.5, 1e-2, stations=51).position[-1, 0]
    unlimited = Robot.named("series_elastic").with_numbers(
        {"torque_limit": np.inf, "servos.speed_limit": np.inf, "series_stiffness": np.inf}
    )
    assert {(servo.torque_limit, servo.speed_limit, servo.series_stiffness) for servo in unlimited.servos} == {
        (None, None, None)
    }


@pytest.mark.parametrize(
    ("robot", "at"),
    [
        ("eight_servos", {"robot.kp": 13.8, "robot.kd": 0.372, "period": 1.0}),
        ("series_elastic", {"robot.series_stiffness": 50.0, "robot.joint_3.kp": 13.8}),
        ("passive_tail", {"robot.tail.bending_stiffness": 0.3, "robot.damping": 0.01}),
    ],
)
def test_gradients_are_differences_of_fine_swims(robot, at):
    found = gradient(MEASURES, at, robot=robot, scene=PLANE, duration=1.0, accuracy=1e-3)
    for index, (name, value) in enumerate(at.items()):
        step, ends = 1e-3 * value, []
        for each in (value + step, value - step):
            numbers = {**at, name: each}
            law = straight(period=numbers.get("period", 1.0))
            own = {key.removeprefix("robot."): number for key, number in numbers.items() if key != "period"}
            run = swum(Robot.named(robot).with_numbers(own), law, 1.0, FINE, stations=2)
            ends.append(np.array([run.position[-1, 0], run.energy.actuator_work[-1]]))
        plain = (ends[0] - ends[1]) / (2.0 * step)
        assert found.derivative[:, index] == pytest.approx(plain, rel=3e-3), name
        assert np.all(found.error[:, index] < 0.05 * np.abs(plain))


def test_gradients_tell_of_motors_at_their_limits_and_have_their_error():
    at = {"robot.torque_limit": 0.3}
    robot = Robot.named("eight_servos")
    with pytest.warns(UserWarning, match=r"motors reach their limits, which are kinks \(joint_3"):
        found = gradient(MEASURES, at, robot=robot.changed(torque_limit=0.3), scene=PLANE, duration=2.0, accuracy=1e-3)
    ends = [swum(robot.changed(torque_limit=each), accuracy=FINE, stations=2) for each in (0.303, 0.297)]
    plain = (ends[0].position[-1, 0] - ends[1].position[-1, 0]) / 0.006
    assert abs(found["head_x"]["robot.torque_limit"] - plain) < 0.1 * plain
    assert abs(found["head_x"]["robot.torque_limit"] - plain) < found.error[0, 0]


def measured(noise=0.0):
    run = swum(MIXED, accuracy=1e-6, sample_period=0.02, stations=2)
    return run.time, run.joint_angle + noise * np.random.default_rng(3).standard_normal(run.joint_angle.shape)


FIRST = {"robot.kp": 9.0, "robot.kd": 0.08, "robot.joint_4.stiffness": 1.0, "robot.joint_4.damping": 0.1}
TRUE = {"robot.kp": 6.0, "robot.kd": 0.15, "robot.joint_4.stiffness": 1.5, "robot.joint_4.damping": 0.05}


def test_gains_stiffness_and_damping_are_found_from_angles():
    found = identify(FIRST, MeasuredAngles(*measured()), robot=MIXED, scene=PLANE)
    assert found.numbers == pytest.approx(TRUE, rel=2e-3)


def test_noise_of_angles_shows_in_the_intervals():
    time, angles = measured(noise=0.02)
    angles[5, 1] = np.nan
    found = identify(FIRST, MeasuredAngles(time, angles), robot=MIXED, scene=PLANE, level=0.999)
    for name, true in TRUE.items():
        value, low, high = found[name]
        assert low < true < high and high - low < 1.5 * value
    assert found.noise == pytest.approx(0.02, rel=0.1) and np.isnan(found.residuals[0][5, 1])


def test_a_tail_is_found_from_a_path():
    run = swum(Robot.named("passive_tail"), None, 4.0, 1e-6, sample_period=0.05, stations=2)
    path = MeasuredPath(run.time, run.position[:, :2])
    first = {"robot.bending_stiffness": 0.5, "robot.tails.damping": 0.02}
    found = identify(first, path, robot="passive_tail", scene=PLANE)
    assert found.value == pytest.approx([0.3, 0.01], rel=5e-3)


def test_the_commands_take_robots_and_files_of_angles(tmp_path, capsys):
    time, angles = measured()
    table, (first, *_) = tmp_path / "angles.csv", MIXED.joints
    names = ",".join(["time", *(joint.name for joint in MIXED.joints)])
    np.savetxt(table, np.column_stack((time, angles)), delimiter=",", header=names, comments="")
    robot = tmp_path / "mixed.yaml"
    robot.write_text(
        "joints:\n  - {position: [0.3, 0.5, 0.7], servo: {kp: 6, kd: 0.15, gear: 200, rotor_inertia: 4.0e-7}}\n"
        "  - {position: 0.85, width: 0.06, stiffness: 1.5, damping: 0.05}\n"
    )
    words = ["--gait", "straight", "--scene", "planar=true", "--robot", str(robot), "--first", "robot.kp=8"]
    assert identify_main([str(table), *words, "--accuracy", "1e-3", "--out", str(tmp_path / "fit.png")]) == 0
    assert float(capsys.readouterr().out.split()[1].rstrip(",")) == pytest.approx(6.0, rel=0.01)
    run = swum(MIXED, accuracy=1e-4, sample_period=0.02, stations=2)
    run.save(tmp_path / "run.nc")
    assert identify_main([str(tmp_path / "run.nc"), "--first", "robot.servos.kp=8", "--accuracy", "1e-3"]) == 0
    assert float(capsys.readouterr().out.split()[1].rstrip(",")) == pytest.approx(6.0, rel=0.01)
    vary = ["straight", "--robot", "passive_tail", "--vary", "robot.bending_stiffness=0.2,0.4", "--duration", "1"]
    assert sweep_main([*vary, "--accuracy", "1e-2", "--out", str(tmp_path / "tails.nc")]) == 0
    assert "2, of which 0 stopped" in capsys.readouterr().out
    assert first.name == "joint_1"


@pytest.mark.soak
def test_the_best_tail_at_a_speed_is_within_its_bounds():
    bounds = {"robot.bending_stiffness": (0.1, 1.0), "amplitude_2": (0.5, 3.0)}
    front = optimise(
        bounds, [0.6], robot="passive_tail", numbers={"amplitude_0": 1.0}, scene=PLANE, accuracy=1e-2, periods=8
    )
    stiffness, amplitude = front.values[0]
    run = front.runs[0]
    assert run.robot.parts[0].bending_stiffness == stiffness and front.speed[0] == pytest.approx(0.6, rel=0.01)
    for factor in (0.8, 1.25):  # at the same speed other tails cost more
        other = optimise(
            {"amplitude_2": (0.5, 4.0)}, [0.6], robot=run.robot.changed(bending_stiffness=factor * stiffness),
            numbers={"amplitude_0": 1.0}, scene=PLANE, accuracy=1e-2, periods=8,
        )  # fmt: skip
        assert other.cost[0] > front.cost[0]
    assert amplitude > 0.5


@pytest.mark.fault("parameters", "a study with a number that the robot does not have", "refused by name, with a hint")
@pytest.mark.parametrize(
    ("grid", "robot", "told"),
    [
        (
            {"robot.stifness": [1.0]},
            "eight_servos",
            r"no part of the robot has 'stifness' \(did you mean 'stiffness'\?\)",
        ),
        ({"kp": [1.0]}, "eight_servos", r"that of the robot is robot.kp"),
        ({"tail.damping": [1.0]}, "passive_tail", r"that of the robot is robot.tail.damping"),
        ({"robot.kp": [1.0]}, None, "robot must be given for robot.kp to change, got none"),
        ({"robot.joint_9.kp": [1.0]}, "eight_servos", "part must be one of joint_1.*, got 'joint_9'"),
        ({"robot.torque_limit": [0.0]}, "eight_servos", "servo torque_limit must be > 0 N m, got 0"),
        ({"robot": ["ten_servos"]}, None, "robot must be one of eight_servos"),
    ],
)
def test_what_no_robot_has_is_refused_by_name(grid, robot, told):
    with pytest.raises(ValueError, match=told):
        sweep(grid, robot=robot, duration=1.0)


def test_angles_must_fit_the_robot():
    time = np.linspace(0.0, 1.0, 9)
    with pytest.raises(ValueError, match="angles must have a column for each of the robot's 4 joints, got 3"):
        identify(FIRST, MeasuredAngles(time, np.zeros((9, 3))), robot=MIXED)
    with pytest.raises(ValueError, match="angles must have 4 samples or more, got 2"):
        MeasuredAngles([0.0, 1.0], np.zeros((2, 3)))
    with pytest.raises(ValueError, match="robot's 0 joints"):
        identify({"robot.damping": 0.1}, MeasuredAngles(time, np.zeros((9, 1))), robot=Robot([PassiveTail(0.6, 0.3)]))
