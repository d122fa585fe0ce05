# SPDX-License-Identifier: Apache-2.0
"""What researchers read off a run, against the same figures computed here from the arrays, and what is undefined."""

from itertools import pairwise

import numpy as np
import pytest
from eel_dynamics.analysis.powers import drag_powers

from eel_dynamics import Body, Scene, Simulation, simulate, simulate_batch
from eel_gaits import Law, Ramp, Term, sequence, straight

pytestmark = pytest.mark.identity("Read off a run")


@pytest.fixture(scope="module")
def run():
    return simulate(straight(), 8.0, sample_period=0.02, stations=101)


def test_speed_power_and_efficiency(run):
    a = run.analysis(4)
    last = run.time >= 4.0 - 1e-9
    # The averaged centre of mass of a straight swimmer goes straight: its path is the way per period.
    way = run.center_of_mass[-1] - run.center_of_mass[200]
    assert a.mean_speed == pytest.approx(
        np.linalg.norm(way) / 4.0, rel=2e-2
    )  # still gaining speed, and turning a little
    assert a.stride == pytest.approx(a.mean_speed) and a.slip == pytest.approx(a.mean_speed)  # l = T = wavelength = 1
    assert a.reynolds == pytest.approx(a.mean_speed / 1e-6)
    e = run.energy
    work = e.actuator_work[-1] - e.actuator_work[200]
    assert a.actuator_power == pytest.approx(work / 4.0, rel=1e-9)
    assert a.actuator_power == pytest.approx(np.mean(e.actuator_power[last][:-1]), rel=1e-3)
    assert a.positive_actuator_power >= a.actuator_power
    assert a.cost_of_transport == pytest.approx(a.actuator_power / (run.body_mass * a.mean_speed))
    assert a.hydromechanical_efficiency == pytest.approx(1.0 + a.wake_power / a.actuator_power)
    assert 0.0 < a.propulsive_efficiency < a.hydromechanical_efficiency < 1.0
    assert 0.2 < a.strouhal < 0.5  # live eels: near 0.32 (Tytell 2004)
    assert np.all(a.peak_torque >= a.rms_torque - 1e-12)


def test_friction_power_is_what_the_load_along_the_body_says(measured):
    """Resistive force per length times the velocity of the backbone (central differences), along its tangent."""
    run = simulate(straight(), 4.0, sample_period=0.05)
    swimmer, step = Simulation(stations=401), 1e-4  # s
    swimmer.adopt(straight())
    backbones = []
    for time in (3.0 - step, 3.0, 3.0 + step):
        swimmer.advance(time)
        now = swimmer.observe(wrench=False)
        backbones.append(now.backbone.copy())
        if time == 3.0:
            axial = now.resistive_force[:, 0].copy()
    velocity, tangent = (backbones[2] - backbones[0]) / (2 * step), np.gradient(backbones[1], now.x, axis=0)
    expected = np.trapezoid(axial * np.sum(velocity * tangent, axis=1), now.x)
    powers = drag_powers(run)
    apart = abs(powers[60, 0] / expected - 1)
    measured("power of the axial friction against load and velocity along the body", apart, 2e-3)  # trapezoidal rule
    apart = np.abs(powers.sum(axis=1) - run.energy.drag_power)
    measured(
        "its sum with cross flow and roll against the ledger's drag", apart / np.abs(run.energy.drag_power).max(), 1e-9
    )


def test_samples_that_are_not_finite_have_no_spline(run):
    with pytest.raises(ValueError, match="nan"):
        run.analysis(4).window.spline(np.full(len(run.time), np.nan))


def test_motors_add_up_like_one_over_n_squared(measured, run):
    differences = [run.actuators(n).relative_difference for n in (8, 16, 32)]
    assert differences[2] < 0.02
    orders = [np.log2(coarse / fine) for coarse, fine in pairwise(differences)]
    measured("order in 1/n at which n joints' power meets the continuous body's", orders, 0.3, wanted=2.0)
    motors = run.actuators(10)
    assert motors.x[0] == pytest.approx(0.05) and motors.yaw.angle.shape == (401, 10)
    assert np.sum(motors.yaw.angle[-1]) == pytest.approx(
        np.sum(0.5 * (run.curvature[-1, 1:, 2] + run.curvature[-1, :-1, 2]) * np.diff(run.x)), abs=1e-3
    )
    assert np.all(motors.pitch.angle == 0.0)


def test_actuators_are_shown_in_a_line_and_tell_their_window(run):
    motors, window = run.actuators(8), f"{run.time[0]:g} to {run.time[-1]:g} s"
    assert repr(motors) == f"Actuators(8 joints, {len(run.time)} samples, {window})"
    assert motors.table().splitlines()[0].endswith(f"(peak, RMS over the whole run, {window})")


def test_an_analysis_is_shown_in_a_line(run):
    analysis = run.analysis(4)
    told = f"Analysis({run.law.name!r}, 4 periods of {analysis.window.period:g} s, {analysis.window.start:g} to "
    told += f"{analysis.window.end:g} s: mean speed {analysis.mean_speed:.4g} m/s, "
    assert repr(analysis).startswith(told) and "settled" in repr(analysis)
    assert repr(simulate(Law(Term(amplitude=(0.0,), wavelength=1.0, period=1.0)), 2.0).analysis()).endswith("at rest)")


def test_undefined_and_refused(run):
    still = simulate(Law(Term(amplitude=(0.0,), wavelength=1.0, period=1.0)), 2.0, sample_period=0.05)
    a = still.analysis()
    assert a.mean_speed == 0.0 and a.strouhal is None and a.cost_of_transport is None and a.slip is None
    assert a.hydromechanical_efficiency is None and "nan" not in still.summary() and "undefined" in still.summary()
    with pytest.raises(ValueError, match="whole period"):
        simulate(straight(), 0.5).analysis()
    with pytest.raises(ValueError, match="no periodic term"):
        simulate(Law(Term(amplitude=(1.0,), phase=np.pi / 2, envelope=(Ramp(0, 1, 1),))), 2.0).analysis()
    bare = simulate(straight(), 2.0, scene=Scene(ledger=False, internal_wrench=False), body=Body.kern2006())
    with pytest.raises(ValueError, match="ledger"):
        _ = bare.analysis().actuator_power
    with pytest.raises(ValueError, match="internal_wrench"):
        bare.actuators(4)
    with pytest.raises(ValueError, match="joints"):
        run.actuators(0)


def test_friction_power_of_a_function_of_time_is_that_of_its_law():
    law, powers = straight(), []
    for motion in (law, law.curvature):
        run = simulate(motion, 3.0, scene=Scene(friction="laminar"), accuracy="draft", estimate=False, stations=21)
        powers.append(drag_powers(run))
        np.testing.assert_allclose(powers[-1].sum(axis=1), run.energy.drag_power, atol=1e-12)
    np.testing.assert_allclose(powers[1], powers[0], atol=0.01 * np.abs(powers[0]).max())


def test_a_wave_that_has_died_out_is_not_the_gait():
    """The later half has the second gait alone, and its figures."""
    second = straight(period=0.5) * 0.6
    settings = {"accuracy": "draft", "estimate": False, "sample_period": 0.025, "stations": 21}
    found = simulate(sequence([(straight(), 6.0), (second, None)]), 14.0, **settings).analysis()
    alone = simulate(second, 14.0, **settings).analysis()
    assert found.window.period == alone.window.period == 0.5
    for name in ("frequency", "strouhal", "stride", "slip"):
        assert getattr(found, name) == pytest.approx(getattr(alone, name), rel=0.05)


def test_the_gait_s_period_does_not_depend_on_the_stations():
    """At the head, X = 0, the second wave is the stronger one."""
    grown = (Ramp(0.0, 1.0, 1.0),)
    law = Law(
        Term(axis="yaw", amplitude=(0.0, 5.0), wavelength=1.0, period=1.0, envelope=grown),
        Term(axis="yaw", amplitude=(0.01,), period=0.5, envelope=grown),
    )
    batch = simulate_batch([law], 6.0, accuracy="draft", estimate=False)
    run = simulate(law, 6.0, accuracy="draft", estimate=False, stations=21)
    assert batch[0].analysis().window.period == run.analysis().window.period == 1.0
