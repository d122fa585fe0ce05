# SPDX-License-Identifier: Apache-2.0
"""Fields of a robot from measured joint angles."""

import numpy as np
import pytest
from eel_studies.motors.fit_robot import fit_robot

from eel_dynamics import Joint, Robot, Scene, Servo, simulate
from eel_gaits import straight

PLANE = Scene(planar=True)
SERVO = Servo(kp=6.0, kd=0.15, gear=200.0, rotor_inertia=4e-7)
TRUE = Robot(
    [*(Joint(x, actuator=SERVO) for x in (0.3, 0.5, 0.7)), Joint(0.85, width=0.06, stiffness=1.5, damping=0.05)]
)


def measured(robot, noise=0.0):
    run = simulate(straight(), 2.0, robot=robot, scene=PLANE, accuracy=1e-6, sample_period=0.02, stations=2)
    return run.time, run.joint_angle + noise * np.random.default_rng(7).standard_normal(run.joint_angle.shape)


def test_gains_stiffness_and_damping_are_found_again():
    true = {"kp": 6.0, "kd": 0.15, "joint_4.stiffness": 1.5, "joint_4.damping": 0.05}
    begin = {"kp": 9.0, "kd": 0.08, "joint_4.stiffness": 1.0, "joint_4.damping": 0.1}
    fitted = fit_robot(TRUE, straight(), *measured(TRUE), begin, scene=PLANE)
    assert fitted.values == pytest.approx(true, rel=2e-3) and fitted.misfit < 1e-4
    assert fitted.robot.joint("joint_4").stiffness == fitted.values["joint_4.stiffness"]
    assert fitted.robot.joint("joint_1").stiffness == 0.0


def test_noise_shows_in_the_standard_errors():
    time, angles = measured(TRUE, noise=0.02)
    angles[5, 1] = np.nan
    fitted = fit_robot(TRUE, straight(), time, angles, ["kp", "kd"], scene=PLANE)
    for name, true in (("kp", 6.0), ("kd", 0.15)):
        assert abs(fitted.values[name] - true) < 4.0 * fitted.errors[name] < 0.4 * true
    assert fitted.misfit == pytest.approx(0.02, rel=0.1)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"fields": ["kq"]}, "no part of the robot has 'kq'"),
        ({"fields": ["joint_9.kp"]}, "no part of the robot has 'joint_9.kp'"),
        ({"fields": ["stiffness"]}, "stiffness must be > 0, got 0.0"),
        ({"fields": {"kp": -1.0}}, "kp must be > 0, got -1.0"),
        ({"time": [1.0, 2.0]}, r"time must rise from 0 over 2 instants or more, got \[1.0, 2.0\]"),
        ({"angles": [[0.0], [0.0]]}, r"angles must have a row for each of 2 instants and 4 joints, got \(2, 1\)"),
    ],
)
def test_what_does_not_fit_is_said(change, told):
    given = {"time": [0.0, 1.0], "angles": np.zeros((2, 4)), "fields": ["kp"]} | change
    with pytest.raises(ValueError, match=told):
        fit_robot(TRUE, straight(), **given)
