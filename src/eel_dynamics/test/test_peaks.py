# SPDX-License-Identifier: Apache-2.0
"""The greatest values of a run, between its samples and stations."""

from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.analysis.peaks import peak_along
from scipy.interpolate import CubicSpline, make_interp_spline

from eel_core import Spline, peaks
from eel_dynamics import Fin, Robot, Scene, Wave, simulate
from eel_gaits import gait


@pytest.mark.parametrize("count", [8, 20, 50])
def test_the_peak_of_a_wave_lies_between_its_samples(count):
    """The phase is such that no sample is at the peak."""
    time = np.arange(6 * count + 1) / count
    phases = np.array([0.3, 1.1, 2.0])
    sizes, times = peaks(time, 2.0 * np.sin(2.0 * np.pi * time[:, None] + phases))
    error = 30.0 * count**-4.0  # a parabola through instants of an eighth of a sample; the spline's is of order 6
    assert sizes == pytest.approx(2.0, rel=error)
    assert np.abs(np.sin(2.0 * np.pi * times + phases)) == pytest.approx(1.0, abs=error)


def test_a_window_and_short_records():
    time = np.linspace(0.0, 1.0, 200)  # three sets of intervals
    (size,), (place,) = peaks(time, time**2, start=0.2, end=0.75)
    assert size == pytest.approx(0.75**2) and place == pytest.approx(0.75)
    assert peaks([2.0], [-3.0]).tolist() == [[3.0], [2.0]]
    assert peaks([0.0, 1.0], [0.0, -3.0])[0] == 3.0 and peaks([0.0, 1.0], [-1.0, -3.0], with_sign=True)[0] == -1.0
    (size,), (place,) = peaks(np.arange(3.0), [0.0, 1.0, 0.5])
    assert size == pytest.approx(49.0 / 48.0, rel=1e-3) and place == pytest.approx(7.0 / 6.0, rel=1e-2)


def test_groups_and_instants_that_are_not_near_the_greatest_are_left_out():
    """The peak of the others is as if all counted, to what a spline changes by samples that are far from it."""
    time = np.arange(0.0, 20.0, 0.1)
    values = np.exp(-0.1 * (time - 7.03) ** 2)[:, None, None] * [[3.0, 4.0], [0.3, 0.4], [6.0, 0.0]]
    all_sizes, all_places = peaks(time, values, width=2)
    sizes, places = peaks(time, values, width=2, near=0.7, beside=6)
    assert all_sizes == pytest.approx([5.0, 0.5, 6.0], rel=1e-6) and all_places == pytest.approx(7.03, abs=1e-4)
    assert sizes == pytest.approx([5.0, 0.0, 6.0], rel=1e-6) and places[[0, 2]] == pytest.approx(7.03, abs=1e-4)


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6, 7, 8, 40])
def test_splines_are_those_of_scipy(count):
    rng = np.random.default_rng(count)
    x = np.cumsum(rng.uniform(0.5, 1.5, count))
    values, places = rng.normal(size=(count, 2, 3)), np.linspace(x[0] - 0.1, x[-1] + 0.1, 30).reshape(5, 6)
    cubic, quintic = Spline(x, values), Spline(x, values, 5)
    wanted = CubicSpline(x, values)
    assert np.allclose(cubic.at(places), wanted(places), rtol=1e-11, atol=1e-11)
    assert np.allclose(cubic.integral(places), wanted.antiderivative()(places), rtol=1e-11, atol=1e-11)
    assert np.allclose(quintic.at(x), values, rtol=1e-12, atol=1e-12)
    if count > 5:
        assert np.allclose(quintic.at(places), make_interp_spline(x, values, k=5)(places), rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize(
    ("x", "values", "degree", "message"),
    [
        ([0.0, 1.0, 1.0], np.zeros(3), 3, "points must rise"),
        ([0.0, 1.0, 2.0], [0.0, np.nan, 1.0], 3, "samples must be finite"),
        ([0.0, 1.0, 2.0], np.zeros(4), 3, "values must have a row for each of the 3 points"),
        ([0.0, 1.0, 2.0], np.zeros(3), 2, "degree must be 1, 3 or 5, got 2"),
    ],
)
def test_what_no_spline_goes_through_is_refused(x, values, degree, message):
    with pytest.raises(ValueError, match=message):
        Spline(x, values, degree)


@pytest.mark.parametrize("name", ["falling", "kern_fast", "rolling"])
def test_the_greatest_torque_does_not_depend_on_the_samples(name):
    """Within the run's own estimate of its error, which the samples alone miss by 100 times and more."""
    scene = Scene(friction="laminar")
    fine = {"sample_period": 2.5e-4, "stations": np.linspace(0.42, 0.56, 141), "estimate": False}
    exact = simulate(gait(name), 1.2, accuracy=1e-6, scene=scene, **fine)
    wanted = np.linalg.norm(exact.torque, axis=2).max()
    for sample_period, stations in ((0.05, 51), (0.04, 21), (0.01, 51)):
        run = simulate(gait(name), 1.2, sample_period=sample_period, stations=stations, scene=scene)
        size, x, time = run.greatest_torque()
        assert size == pytest.approx(wanted, rel=run.error_estimate.torque)
        sample, station = np.unravel_index(np.linalg.norm(exact.torque, axis=2).argmax(), exact.torque.shape[:2])
        assert x == pytest.approx(exact.x[station], abs=2e-3) and time == pytest.approx(exact.time[sample], abs=1e-3)
    assert f"greatest torque     {size:.4g} N m" in run.summary()


@pytest.mark.parametrize("name", ["rolling", "turning"])
def test_the_peaks_of_stations_joints_and_power_do_not_depend_on_the_samples(name):
    """Splines through the samples alone miss the power of a joint of the rolling gait by 2 %."""
    exact = simulate(gait(name), 3.0, sample_period=0.002, estimate=False)
    run = simulate(gait(name), 3.0)
    error = 2.0 * run.error_estimate.torque
    for of in ("peak_torque", "peak_actuator_power", "peak_positive_actuator_power"):
        found, wanted = getattr(run.analysis(), of), getattr(exact.analysis(), of)
        assert np.max(np.abs(found - wanted)) < error * np.max(wanted), of
    found, wanted = run.actuators(8).yaw.peak, exact.actuators(8).yaw.peak
    for of in found:
        assert np.max(np.abs(found[of] - wanted[of])) < error * np.max(wanted[of]), of


def test_splines_through_the_messages_of_a_node_give_the_same_peak():
    """A hundred messages in a second, as the node publishes them."""
    run = simulate(gait("falling"), 1.2, sample_period=0.01)
    from_messages = peak_along(run.time, run.x, run.torque)
    assert from_messages[0] == pytest.approx(run.greatest_torque()[0], rel=run.error_estimate.torque)
    recorded = replace(run, steps=0)  # as a run from a bag, whose physics is not told
    assert recorded.greatest_torque() == pytest.approx(from_messages)


def test_the_greatest_torque_in_waves_is_that_of_a_swim_in_the_same_waves():
    """At the time of the peak the water moves as it did there in the run. In still water the peak is 8 % elsewhere."""
    run = simulate(gait("straight"), 3.0, flow=Wave(amplitude=0.2, wavelength=2.0))
    size, _, time = run.greatest_torque()
    near = simulate(gait("straight"), 3.0, flow=run.flow, sample_period=5e-4, estimate=False)
    torque = np.linalg.norm(near.torque, axis=2).max(axis=1)
    assert size == pytest.approx(torque.max(), rel=3e-4)  # of 51 stations, none need lie at the peak
    assert time == pytest.approx(near.time[np.argmax(torque)], abs=1e-3)


@pytest.mark.parametrize(
    "swimmer", [{"fins": Fin.pair(0.2, 2e-3, 2.5, angle=0.4)}, {"robot": Robot.named("eight_servos")}], ids=str
)
def test_the_greatest_torque_is_that_of_the_whole_swimmer(swimmer):
    """With fins, and of a robot, as of ten times the samples."""
    run = simulate(gait("straight"), 2.0, accuracy=1e-3, estimate=False, **swimmer)
    fine = np.linalg.norm(run.finely_sampled().torque, axis=2).max()
    size, _, _ = run.greatest_torque()
    assert fine * (1.0 - 1e-9) <= size < fine * 1.002  # between samples and stations it may be a little more


def test_a_run_of_one_sample_has_its_torque():
    run = simulate(gait("falling"), 0.0, sample_period=0.1)
    assert run.greatest_torque()[0] == pytest.approx(np.linalg.norm(run.torque, axis=2).max(), rel=1e-2)
