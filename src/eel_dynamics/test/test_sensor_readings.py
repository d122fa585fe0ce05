# SPDX-License-Identifier: Apache-2.0
"""Readings of sensors: noise, bias and walk, seeds, rate, what does not fit."""

import numpy as np
import pytest
from eel_dynamics.model.robot.robot import robot_of
from eel_dynamics.sensors.noise import Errors, Spread
from eel_dynamics.sensors.timing import Timing

from eel_dynamics import Encoders, Imu, Pressure, SensorSuite, Simulation, simulate
from eel_gaits import backward, falling

NOISY = {"accelerometer_noise": 0.02, "gyroscope_walk": 1e-3, "gyroscope_bias": (0.01, 0.0, -0.01), "seed": 7}


@pytest.fixture(scope="module")
def run():
    return simulate(falling(), 1.0, sample_period=0.01, estimate=False)


@pytest.fixture(scope="module")
def robot_run():
    return simulate(backward(), 0.5, robot=robot_of("sixteen_servos"), sample_period=0.01, estimate=False)


def allan_deviation(values, size):
    """Of readings (N,), over `size` of them each."""
    means = values[: len(values) // size * size].reshape(-1, size).mean(axis=1)
    return np.sqrt(0.5 * np.mean(np.diff(means) ** 2))


def test_white_noise_and_walk_have_their_variance_and_allan_slope():
    """Deviations of 2e5 readings: white n sqrt(T/tau), slope -1/2; walk w sqrt(tau/3), slope 1/2."""
    period, noise, walk, count = 0.01, 0.3, 0.05, 200_000
    gaps = np.full(count, period)
    white = Errors(Spread.of((noise, 2.0, 0.0, 1)), (1,)).all(gaps)[0]
    walked = Errors(Spread.of((0.0, 0.0, walk, 1)), (2,)).all(gaps)[0]
    assert white.std() == pytest.approx(noise, rel=0.01)  # 1/sqrt(2 N) is 0.16 %
    assert white.mean() == pytest.approx(2.0, abs=4.0 * noise / np.sqrt(count))
    sizes = np.array([10, 30, 100, 300])
    found = np.array([[allan_deviation(rows, size) for size in sizes] for rows in (white, walked)])
    tau = sizes * period
    expected = noise * np.sqrt(period / tau), walk * np.sqrt(tau / 3.0)
    np.testing.assert_allclose(found, expected, rtol=0.1)  # 660 clusters of the largest: 3 %; a walk's few readings
    slopes = np.polyfit(np.log(tau), np.log(found).T, 1)[0]
    assert slopes == pytest.approx([-0.5, 0.5], abs=0.05)
    ends = [Errors(Spread.of((0.0, 0.0, walk, 3)), (k,)).all(np.full(25, 0.04)) for k in range(400)]
    assert np.std(np.array(ends)[..., -1]) == pytest.approx(walk, rel=0.06)  # after 1 s; 1,200 numbers: 2 %


def test_readings_are_the_same_to_the_last_bit_with_a_seed_alone_or_together(run):
    first, again = (run.imu(0.3, **NOISY) for _ in range(2))
    other = run.imu(0.3, **NOISY | {"seed": 8})
    for name in ("specific_force", "angular_velocity"):
        assert np.array_equal(getattr(first, name), getattr(again, name))
        assert not np.any(getattr(first, name)[1:] == getattr(other, name)[1:])  # a walk begins at 0
    one = Errors(Spread.of((1.0, 0.0, 1.0, 3)), (3, 4))
    many = Errors(Spread.of((1.0, 0.0, 1.0, 3)), (3, 4)).all(np.full(150, 0.02))
    assert np.array_equal(np.transpose([one.one(0.02) for _ in range(150)]), many)
    elsewhere = run.imu(0.31, **NOISY).specific_force - run.imu(0.31).specific_force
    assert not np.allclose(elsewhere, first.specific_force - run.imu(0.3).specific_force)  # noise of its own


def test_errors_are_what_the_settings_say(run):
    exact, read = run.imu(0.5), run.imu(0.5, accelerometer_bias=(0.1, -0.2, 0.3), gyroscope_bias=(0.0, 0.0, 0.05))
    np.testing.assert_allclose(read.specific_force - exact.specific_force, np.tile([0.1, -0.2, 0.3], (101, 1)))
    np.testing.assert_allclose(read.angular_velocity - exact.angular_velocity, np.tile([0, 0, 0.05], (101, 1)))
    pressure = run.pressure(0.5, bias=1000.0)
    np.testing.assert_allclose(pressure.pressure, 101325.0 + 9806.65 * pressure.depth)
    np.testing.assert_allclose(pressure.depth - run.depth(0.5), 1000.0 / 9806.65)
    turned = run.imu(orientation=True, orientation_noise=0.02).orientation
    true = run.imu(orientation=True).orientation
    np.testing.assert_allclose(np.linalg.norm(turned, axis=1), 1.0)
    angles = 2.0 * np.arccos(np.minimum(1.0, np.abs(np.sum(turned * true, axis=1))))
    assert np.sqrt(np.mean(angles**2) / 3.0) == pytest.approx(0.02, rel=0.2)  # of 101 readings


@pytest.mark.parametrize("rate, samples", [(100.0, range(101)), (50.0, range(0, 101, 2)), (30.0, None), (7.0, None)])
def test_a_sensor_reads_at_the_first_sample_of_each_period(run, rate, samples):
    time = run.imu(rate=rate).time
    wanted = run.time[np.ceil(np.arange(int(rate) + 1) / rate * 100.0 - 1e-6).astype(int)]
    np.testing.assert_array_equal(time, wanted if samples is None else run.time[list(samples)])
    alone, timing = [], Timing(rate)
    for sample in run.time.tolist():
        if (gap := timing.gap(sample)) is not None:
            assert gap == (sample - alone[-1] if alone else 0.0)
            alone.append(sample)
    np.testing.assert_array_equal(alone, time)


def test_encoders_tell_angles_in_steps_and_currents(robot_run):
    run = robot_run
    read = run.encoders(resolution=0.01)
    assert np.array_equal(read.angle, 0.01 * np.round(run.joint_angle / 0.01)) and np.isnan(read.current).all()
    noisy = run.encoders(rate=50.0, rate_noise=0.1)
    assert len(noisy.time) == 26 and (noisy.rate - run.joint_rate[::2]).std() == pytest.approx(0.1, rel=0.2)


def test_current_follows_from_the_torque_constant():
    from eel_dynamics import Joint, Robot, Servo

    joints = [Joint(position=0.4, actuator=Servo(kp=5.0, gear=50.0, torque_constant=0.02))]
    run = simulate(backward(), 0.3, robot=Robot(joints), sample_period=0.1, estimate=False)
    np.testing.assert_allclose(run.encoders().current, run.motor_torque / (50.0 * 0.02))


@pytest.mark.parametrize(
    "call, said",
    [
        (lambda run: run.imu(1.2), "imu stations must lie within 0 to 1 m, got 1.2 m"),
        (lambda run: run.imu(-0.1), "imu stations must lie within 0 to 1 m, got -0.1 m"),
        (lambda run: run.imu(np.nan), "imu stations must be a row of finite numbers, got (nan,)"),
        (lambda run: run.imu(rate=101.0), "imu rate must be at most the 100 Hz of the run, got 101 Hz"),
        (lambda run: run.imu(rate=-1.0), "imu rate must be >= 0 Hz, got -1.0"),
        (lambda run: run.imu(latency=-0.1), "imu latency must be >= 0 s, got -0.1"),
        (lambda run: run.pressure(noise=np.inf), "pressure noise must be finite, got inf"),
        (lambda run: run.velocity(seed=1.5), "velocity seed must be an integer, got 1.5"),
        (lambda run: run.encoders(), "encoders need a robot with joints"),
        (lambda run: run.imu(rate=0.0), "imu rate must be > 0 Hz, got 0"),
        (lambda run: run.imu(0.3, stations=(0.1,)), "stations must be one at a time, as station, got (0.1,)"),
    ],
)
def test_what_does_not_fit_is_one_error(run, call, said):
    with pytest.raises(ValueError) as caught:
        call(run)
    assert str(caught.value) == said


def test_a_run_from_elsewhere_says_that_it_cannot_be_sensed(run):
    from dataclasses import replace

    with pytest.raises(ValueError, match="run must be made by simulate for its sensors to be read"):
        replace(run, steps=0).imu()
    moved = replace(run, position=1.01 * run.position)
    with pytest.raises(ValueError, match="run must be one that simulate repeats"):
        moved.imu()


def test_a_suite_names_its_sensors_and_is_empty_without_rates():
    simulation = Simulation(law=falling(), sensors=[0.5, 0.0, 0.2])
    settings = Imu(rate=10.0, stations=(0.5, 0.2)), Pressure(rate=5.0), Encoders()
    assert list(SensorSuite(settings, simulation).sensors) == ["imu_1", "imu_2", "pressure"]
    assert not SensorSuite((Imu(), Pressure()), simulation).sensors
    with pytest.raises(ValueError, match=r"sensors of the simulation must have 0.3 m, for imu, got"):
        SensorSuite([Imu(rate=1.0, stations=(0.3,))], simulation)
    with pytest.raises(ValueError, match="encoders need a robot"):
        SensorSuite([Encoders(rate=1.0)], simulation)
    with pytest.raises(ValueError, match="one of each kind, with all its stations, got pressure twice"):
        SensorSuite([Pressure(rate=1.0), Pressure(rate=2.0)], simulation)


def test_a_suite_reads_a_march_as_a_run_is_read(run):
    """Sample by sample: the same noise, and motions to round-off."""
    simulation = Simulation(law=falling(), sensors=[0.3])
    suite, found = SensorSuite([Imu(rate=30.0, stations=(0.3,), **NOISY)], simulation), []
    for time in run.time:
        simulation.advance(time)
        found += [*suite.read(simulation.observe(wrench=False, load=False)).values()]
    read = run.imu(0.3, rate=30.0, **NOISY)
    for name in ("time", "specific_force", "angular_velocity"):
        rows = np.array([getattr(each, name) for each in found])
        np.testing.assert_allclose(rows, getattr(read, name), rtol=0.0, atol=1e-12)
