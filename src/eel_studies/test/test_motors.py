# SPDX-License-Identifier: Apache-2.0
"""Whether motors follow a gait: figures of joints, tables over a field of the robot, tails, and the command."""

import re

import numpy as np
import pytest
from eel_dynamics.runs.swim import Swim
from eel_studies.motors.command import main
from eel_studies.motors.motor_figures import comparison, motor_swim, references

from eel_dynamics import Accuracy, Body, Joint, PassiveTail, Robot, Scene, Servo, simulate
from eel_gaits import falling, straight

SERVOS = Robot.named("eight_servos")
SWIM = Swim(straight(), Body.boyer2010(), Scene(planar=True), Accuracy.of("draft"), duration=8.0)


def test_figures_are_those_of_the_run():
    figures = motor_swim(SERVOS, SWIM)
    run = figures.run
    steady = run.time >= 4.0 - 1e-9
    power = run.motor_power[steady]
    assert figures.power == pytest.approx(power.sum(axis=1).mean(), rel=1e-9)  # nothing is imposed
    assert (
        figures.drawn_power == pytest.approx(np.maximum(power, 0.0).sum(axis=1).mean())
        and figures.drawn_power > figures.power
    )
    asked = references(run, run.time[steady])
    error = run.joint_angle[steady] - asked
    assert figures.tracking_error == pytest.approx(np.sqrt(np.mean(error**2) / np.mean(asked**2)))
    for k, joint in enumerate(figures.joints):
        assert joint.torque == pytest.approx(np.abs(run.motor_torque[steady, k]).max())
        assert joint.at_limit == 0.0 and joint.torque_limit == 3.0
    # the joints together bend as the law does, from nose to tail
    bend = [np.trapezoid(SWIM.law.curvature(5.0, x := np.linspace(0.0, 1.0, 2001))[0][:, 2], x)]
    assert -references(run, np.array([5.0])).sum() == pytest.approx(bend[0], abs=1e-6)
    assert figures.speed == pytest.approx(0.7, abs=0.2)


def test_stiff_servos_swim_as_the_imposed_law_on_segments():
    """As the gains grow the error goes like 1/kp."""
    errors = [
        motor_swim(SERVOS.changed(kp=kp, kd=kp / 30.0, torque_limit=None, speed_limit=None), SWIM).tracking_error
        for kp in (100.0, 400.0)
    ]
    assert errors[1] < 0.03 and errors[0] / errors[1] == pytest.approx(4.0, rel=0.35)


def test_a_weaker_motor_follows_worse_and_is_longer_at_its_limit():
    found = comparison(SERVOS, SWIM, "torque_limit", (0.1, 0.3, 3.0))
    errors = [figures.tracking_error for _, figures in found]
    shares = [max(joint.at_limit for joint in figures.joints) for _, figures in found]
    assert errors[0] > errors[1] > errors[2] and shares[0] > shares[1] > shares[2] == 0.0
    for limit, figures in found:
        assert max(joint.torque for joint in figures.joints) <= limit * (1.0 + 1e-12)
    assert [row[0] for row in found.table().rows] == ["0.1", "0.3", "3"]


def test_a_series_spring_changes_what_the_motors_draw():
    found = dict(comparison(SERVOS, SWIM, "series_stiffness", (None, 20.0)))
    assert found[None].drawn_power != pytest.approx(found[20.0].drawn_power, rel=0.01)


@pytest.mark.soak
def test_the_best_tail_s_stiffness_goes_with_the_square_of_the_frequency():
    """Without friction the swims of three periods are similar: the same speeds in lengths a period, one peak each."""
    peaks, speeds = [], []
    for period in (0.5, 1.0, 2.0):
        scene = Scene(planar=True, friction="none")
        swim = SWIM.changed(law=straight(period=period), scene=scene, duration=12.0 * period)
        values = [0.075 * 2.0**k / period**2 for k in range(6)]
        tail = Robot([PassiveTail(0.6, 1.0, 0.01 / period)])
        row = [figures.speed * period for _, figures in comparison(tail, swim, "bending_stiffness", values)]
        rises = np.sign(np.diff(row))
        assert np.count_nonzero(np.diff(rises)) == 1 and rises[0] > 0 > rises[-1]
        peaks.append(values[int(np.argmax(row))] * period**2)
        speeds.append(row)
    assert peaks == pytest.approx([0.3] * 3) and np.ptp(speeds, axis=0).max() < 1e-3


def test_the_command_prints_a_row_for_each_joint_and_writes_the_table(capsys, tmp_path):
    out = tmp_path / "motors.csv"
    words = ["eight_servos", "straight", "--scene", "planar=true", "--duration", "4", "--accuracy", "draft"]
    assert main([*words, "--out", str(out)]) == 0
    told = capsys.readouterr().out
    assert len(re.findall(r"^joint_\d ", told, re.MULTILINE)) == 8 and "no motor comes to its torque limit" in told
    assert len(out.read_text().splitlines()) == 9
    assert main([*words, "--vary", "torque_limit=0.2,none"]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[0].startswith("torque_limit") and told[-1].split()[0] == "none"


def test_a_second_number_gives_a_curve_each_and_a_picture(capsys, tmp_path):
    """A tail swims fastest at a stiffness that goes with the square of the frequency."""
    words = ["passive_tail", "straight", "--scene", "planar=true", "--scene", "friction=none", "--accuracy", "1e-2"]
    words += ["--duration", "6", "--vary", "bending_stiffness=0.1,0.3,1.2,4.8", "--vary", "period=0.5,1"]
    assert main([*words, "--out", str(tmp_path / "tails.png"), "--out", str(tmp_path / "tails.csv")]) == 0
    rows = [line.split(",") for line in (tmp_path / "tails.csv").read_text().splitlines()]
    assert rows[0][:3] == ["period", "bending_stiffness", "speed [m/s]"] and len(rows) == 9
    best = {period: max((float(row[2]), row[1]) for row in rows[1:] if row[0] == period)[1] for period in ("0.5", "1")}
    assert best == {"0.5": "1.2", "1": "0.3"}
    assert (tmp_path / "tails.png").stat().st_size > 5000
    assert main([*words, "--vary", "density_ratio=1,2"]) == 2
    assert "--vary must be given 2 times at most, got 3" in capsys.readouterr().err


def test_motors_are_asked_to_swim_as_a_run_did(capsys, tmp_path):
    """The falling gait bends in pitch too: sixteen servos follow what a saved run of it swam."""
    imposed = simulate(falling(), 4.0, accuracy="draft", estimate=False)
    imposed.save(tmp_path / "swim.nc")
    words = ["sixteen_servos", str(tmp_path / "swim.nc"), "--accuracy", "draft", "--vary", "torque_limit=0.1,1"]
    assert main(words) == 0
    told = capsys.readouterr().out.splitlines()
    assert "the imposed swim takes at most" in told[0] and "N m in pitch of 8 joints an axis" in told[0]
    weak, strong = (float(line.split()[2]) for line in told[-2:])
    assert strong < 10.0 < 3.0 * strong + 10.0 < weak
    assert main(["eight_servos", str(tmp_path / "none.nc")]) == 2


@pytest.mark.fault(
    "parameters", "eel motors with a field that no part has, or values that are none", "status 2, one line"
)
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["eight_servos", "--vary", "stifness=1"], "no part of the robot has 'stifness'"),
        (["eight_servos", "--vary", "kp=1,x"], "--vary must be FIELD=NUMBER,NUMBER,..."),
        (["eight_servos", "--vary", "kp=-1"], "servo kp must be >= 0 N m/rad, got -1"),
        (["ten_servos"], "robot must be one of eight_servos, sixteen_servos, series_elastic, passive_tail, a file"),
        (["none.urdf"], "there is no such file"),
    ],
)
def test_what_does_not_fit_is_one_line(capsys, words, told):
    assert main([*words, "--scene", "planar=true", "--duration", "1"]) == 2
    error = capsys.readouterr().err
    assert told in error and len(error.splitlines()) == 1


def test_a_joint_without_a_servo_has_no_error():
    robot = Robot([Joint(0.4, actuator=Servo()), Joint(0.7, stiffness=1.0, damping=0.05)])
    figures = motor_swim(robot, SWIM.changed(duration=2.0))
    assert np.isnan(figures.joints[1].error_rms) and figures.joints[0].error_rms > 0.0
    assert figures.joints[1].torque == 0.0
