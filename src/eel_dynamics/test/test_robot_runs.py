# SPDX-License-Identifier: Apache-2.0
"""Runs of robots have a summary; the command simulate takes a robot."""

import pytest
from eel_dynamics.commands.simulate import main

from eel_dynamics import Joint, PassiveTail, Robot, Scene, Torque, simulate
from eel_gaits import straight

PLANE = Scene(planar=True)
ROBOTS = {
    "servos": Robot.named("eight_servos"),
    "springs": Robot.named("series_elastic"),
    "mixed": Robot([Joint(0.3, actuator=Torque([0.0, 0.05], time=[0.0, 1.0])), PassiveTail(0.6, 0.3, 0.01, modes=3)]),
}


def run_of(robot, **options):
    return simulate(
        straight(), 2.0, robot=robot, scene=PLANE, accuracy="draft", sample_period=0.05, stations=9, **options
    )


@pytest.mark.parametrize("name", ROBOTS)
def test_a_robot_s_run_has_a_summary(name):
    run = run_of(ROBOTS[name])
    text = run.summary()
    assert "motors              greatest torque" in text and "at the limit for up to 0% of the time" in text
    assert "axial friction -" in text and "cost of transport" in text


def test_the_command_simulate_takes_a_robot(capsys):
    words = ["straight", "--robot", "eight_servos", "--scene", "planar=true", "--duration", "2", "--accuracy", "draft"]
    assert main(words) == 0
    assert "motors              greatest torque" in capsys.readouterr().out
    assert main(["straight", "--robot", "ten_servos"]) == 2
    assert (
        "robot must be one of eight_servos, sixteen_servos, series_elastic, passive_tail, a file"
        in capsys.readouterr().err
    )
