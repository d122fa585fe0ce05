# SPDX-License-Identifier: Apache-2.0
"""The greatest values of a run, between its samples and stations."""

from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.analysis.peaks import peak_along, peaks

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
    size, place = peaks(time, time**2, start=0.2, end=0.75)
    assert size == pytest.approx(0.75**2) and place == pytest.approx(0.75)
    assert peaks(np.array([2.0]), np.array([-3.0])) == (3.0, 2.0)
    assert peaks(np.array([0.0, 1.0]), np.array([0.0, -3.0]))[0] == 3.0
    size, place = peaks(np.arange(3.0), np.array([0.0, 1.0, 0.5]))
    assert size == pytest.approx(49.0 / 48.0, rel=1e-3) and place == pytest.approx(7.0 / 6.0, rel=1e-2)


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
