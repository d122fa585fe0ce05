# SPDX-License-Identifier: Apache-2.0
"""Torques and flows that change suddenly after a long rest: no step passes over what begins and ends within it."""

import numpy as np
import pytest
from eel_dynamics.accuracy.sudden_changes import changes_of
from eel_dynamics.model.flow.functions import FlowField
from eel_dynamics.model.robot.actuators import Torque
from eel_dynamics.model.robot.continuous import Muscle, PassiveTail
from eel_dynamics.model.robot.joint import Joint
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.simulation.swimmer import Swimmer

from eel_dynamics import Body, Scene, Simulation, simulate
from eel_gaits import Law, Ramp, Term

PLANE, STILL = Scene(planar=True), Law(name="still")


def bump(time, at, half):
    """From 0 to 1 and back, over 2 `half` [s] around `at` [s]."""
    return (1.0 - min(((time - at) / half) ** 2, 1.0)) ** 4


def over(function):
    return lambda times: np.array([[function(time)] for time in times])


def pushed(torque):
    return Robot([Joint(0.5, stiffness=1.0, damping=0.05, actuator=torque)])


def test_sudden_changes_lie_between_the_times_that_are_found():
    for at, half in ((7.31, 0.1), (3.3, 0.01), (9.0, 0.006)):
        found = np.sort([*changes_of(over(lambda t, at=at, half=half: bump(t, at, half)), 0.0, 10.0)])
        before, after = found[found < at], found[found > at]
        assert before[0] > at - 1.0 and before[-1] > at - half - 0.2
        assert after[0] < at + half + 0.2 and after[-1] < at + 1.0
    jump = np.sort([*changes_of(over(lambda t: float(t > 4.0)), 0.0, 10.0)])
    assert jump[jump < 4.0][-1] > 3.98 and jump[jump > 4.0][0] < 4.02


def test_what_is_smooth_or_fast_all_along_changes_nowhere_suddenly():
    for rate in (1.0, 5.0, 300.0):
        assert not changes_of(lambda t, rate=rate: np.sin(rate * t)[:, None], 0.0, 10.0)
    assert not changes_of(over(lambda t: (1.0 - np.exp(-(t**3))) * np.sin(6.0 * t)), 0.0, 4.0)
    assert not changes_of(lambda t: 0.0 * t[:, None], 0.0, 10.0) and not changes_of(over(float), 0.0, 0.0)


@pytest.mark.parametrize("given", ["function", "table"])
def test_a_short_torque_after_a_long_rest_moves_the_joint_as_after_a_short_one(given):
    def greatest(at, duration):
        if given == "function":
            torque = Torque(lambda t: 0.2 * bump(t, at, 0.02))
        else:
            time = np.union1d(np.linspace(0.0, duration, round(duration / 0.05)), np.linspace(at - 0.04, at + 0.04, 33))
            torque = Torque([0.2 * bump(t, at, 0.02) for t in time], time=time)
        run = simulate(STILL, duration, robot=pushed(torque), scene=PLANE, accuracy=1e-2, sample_period=0.01)
        return np.abs(run.joint_angle).max()

    short = greatest(0.53, 0.8)
    assert short > 1e-3 and greatest(7.33, 7.6) == pytest.approx(short, rel=2e-2)


def test_a_simulation_whose_end_is_not_known_sees_a_short_torque():
    simulation = Simulation(
        law=STILL, robot=pushed(Torque(lambda t: 0.2 * bump(t, 5.03, 0.03))), scene=PLANE, accuracy=1e-2
    )
    simulation.advance(5.1)
    assert abs(simulation.observe().joints["joint_angle"][0]) > 1e-3


def test_a_gust_that_is_a_function_moves_a_body_that_has_long_lain_still():
    def moved(at, duration):
        flow = FlowField(lambda x, t: 0.0 * x + [0.0, 0.5 * bump(t, at, 0.04), 0.0])
        run = simulate(STILL, duration, flow=flow, scene=PLANE, accuracy=1e-2, sample_period=0.01)
        return run.position[-1, 1]

    short = moved(0.4, 0.6)
    assert short > 1e-3 and moved(6.83, 7.03) == pytest.approx(short, rel=2e-2)


def test_a_ramp_of_a_muscle_ends_a_step():
    moment = Law(Term(amplitude=(0.1,), envelope=(Ramp(3.0, 3.01, 1.0),)))
    robot = Robot([Muscle(0.3, 0.8, 1.0, 0.1, moment)])
    assert set(Swimmer(robot=robot).breakpoints) == {3.0, 3.01}


def test_a_stiffness_that_is_high_on_a_short_part_counts():
    def profile(x):
        return 0.1 + 50.0 * np.exp(-(((x - 0.7113) / 0.001) ** 2))

    swimmer = Swimmer(robot=Robot([PassiveTail(0.6, profile, 0.01)]))
    wanted = 0.1 * 0.4 + 50.0 * 0.001 * np.sqrt(np.pi)
    assert swimmer.modes.stiffness[0, 0] == pytest.approx(wanted, rel=1e-6)


def test_a_detail_of_a_body_between_its_kinks_is_told():
    def half_axis(x):
        return 0.05 * np.sqrt(x * (1.001 - x))

    Body(length=1.0, half_width=half_axis, half_height=half_axis)
    with pytest.warns(UserWarning, match=r"body half_width is not smooth near X = 0\.6"):
        Body(length=1.0, half_width=lambda x: half_axis(x) * (1.0 + bump(x, 0.612, 0.005)), half_height=half_axis)
    with pytest.warns(UserWarning, match=r"body mass_per_length is not smooth near X = 0\.3"):
        Body(length=1.0, half_width=half_axis, half_height=half_axis, mass_per_length=lambda x: 1.0 + (x > 0.3))


def test_a_torque_is_asked_once_for_each_instant():
    asked = []

    def torque(time):
        asked.append(time)
        return 0.05 * np.sin(4.0 * time)

    march_of = simulate(STILL, 1.0, robot=pushed(Torque(torque)), scene=PLANE, accuracy=1e-2, estimate=False)
    inside = asked[-march_of.evaluations :]
    assert all(one != other for one, other in zip(inside[1:], inside, strict=False))
