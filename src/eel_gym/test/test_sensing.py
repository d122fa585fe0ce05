# SPDX-License-Identifier: Apache-2.0
"""Environments whose policy has sensors: readings as in the library, noise of each episode, latency, many at once."""

import numpy as np
import pytest

from eel_dynamics import Encoders, Imu, Pressure, Robot, Velocity, Wave
from eel_gym import HeadingEnv, JointAction, SwimmerEnv, ThreadedVectorEnv

NOISY = Imu(rate=50.0, stations=(0.0, 0.4), accelerometer_noise=0.1, orientation=True)


class BySensors(SwimmerEnv):
    """A task without numbers of its own."""

    name = "BySensors"

    def __init__(self, **settings):
        super().__init__(control_period=0.02, **settings)

    def reward(self):
        return np.zeros(self.shape) if self.shape else 0.0


def stepped(env, steps, seed=3):
    """The readings (steps + 1, n) of an episode under actions that repeat."""
    env.reset(seed=seed)
    rows, actions = [env.readings.copy()], np.random.default_rng(1)
    for _ in range(steps):
        env.step(actions.uniform(-1.0, 1.0, env.action_space.shape))
        rows.append(env.readings.copy())
    return np.array(rows)


def test_readings_follow_what_the_task_observes():
    plain = HeadingEnv(control_period=0.02)
    sensed = HeadingEnv(sensors=[NOISY, Pressure(rate=10.0), Velocity(rate=50.0)], control_period=0.02)
    before, after = plain.reset(seed=2)[0], sensed.reset(seed=2)[0]
    count, own = len(sensed.sensed), len(HeadingEnv.observed)
    assert count == 10 + 10 + 1 + 3 and len(after) == len(before) + count
    assert sensed.sensed[0].name == "imu_1 specific force x" and "imu_2 orientation w" in sensed.describe()
    np.testing.assert_array_equal(np.delete(after, slice(own, own + count)), before)
    told = (sensed.scales * after)[own : own + count]
    np.testing.assert_allclose(told, sensed.readings, rtol=1e-6)
    assert sensed.observation_space.contains(after)
    for _ in range(3):
        action = np.full(plain.action_space.shape, 0.7)
        before, after = plain.step(action)[0], sensed.step(action)[0]
        np.testing.assert_array_equal(np.delete(after, slice(own, own + count)), before)


def test_they_are_those_of_the_motion():
    env = BySensors(sensors=[Imu(rate=50.0), Velocity(rate=50.0), Pressure(rate=50.0)])
    found = stepped(env, 5)
    seen = env.swimmers.observe(0)
    assert found[-1, 3:6] == pytest.approx(seen.twist[:3]) and found[-1, 6:9] == pytest.approx(seen.twist[3:])
    assert found[-1, 9] == pytest.approx(-seen.position[2]) and found[0, :3] == pytest.approx([0, 0, 9.80665], abs=0.5)


def test_each_episode_has_noise_of_its_own_and_seeds_repeat():
    env = BySensors(sensors=[NOISY])
    first, again, other = stepped(env, 4), stepped(env, 4), stepped(env, 4, seed=4)
    assert np.array_equal(first, again)
    exact = stepped(BySensors(sensors=[Imu(rate=50.0, stations=(0.0, 0.4), orientation=True)]), 4)
    assert (first - exact)[:, :3].std() == pytest.approx(0.1, rel=0.5)
    assert not np.any((first - exact)[:, 0] == (other - exact)[:, 0])


def test_a_late_reading_comes_later():
    at_once, late = (stepped(BySensors(sensors=[Imu(rate=50.0, latency=t)]), 6) for t in (0.0, 0.04))
    assert np.array_equal(late[2:], at_once[:-2]) and not late[:2].any()


def test_many_sense_as_each_would_alone():
    one = BySensors(sensors=[NOISY])
    many = ThreadedVectorEnv(3, task=BySensors, threads=2, sensors=[NOISY])
    many.reset(seed=7)
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (4, 3, *one.action_space.shape))
    together = [many.swimmers.readings.copy()] + [
        (many.step(rows), many.swimmers.readings.copy())[1] for rows in actions
    ]
    for index in range(3):
        one.reset(seed=7 + index)
        alone = [one.readings.copy()] + [(one.step(rows[index]), one.readings.copy())[1] for rows in actions]
        assert np.array_equal(np.array(alone), np.array(together)[:, :, index])


def test_joints_are_sensed_by_encoders():
    robot = Robot.named("eight_servos")
    env = BySensors(action=JointAction(robot), sensors=[Encoders(rate=50.0, resolution=0.01)])
    found, joints = stepped(env, 5), env.swimmers.joints[:, :, 0]
    assert found[-1, :8] == pytest.approx(0.01 * np.round(joints[0] / 0.01)) and found[-1, 8:] == pytest.approx(
        joints[1]
    )


@pytest.mark.parametrize(
    "sensors, said",
    [
        ([Imu(rate=51.0)], "imu rate must be at most the 50 Hz of the run, got 51 Hz"),
        ([Imu(rate=50.0, stations=(2.0,))], "imu stations must lie within 0 to 1 m, got 2 m"),
        ([Encoders(rate=50.0)], "encoders need a robot with joints"),
        (["imu"], "sensors must be a SensorSettings, got 'imu'"),
    ],
)
def test_what_does_not_fit_is_one_error(sensors, said):
    with pytest.raises(ValueError) as caught:
        BySensors(sensors=sensors)
    assert str(caught.value) == said


def test_what_is_off_is_left_out_and_a_kind_comes_once():
    env = BySensors(sensors=[Imu(), Pressure(rate=50.0)])
    assert [each.name for each in env.sensed] == ["pressure depth"]
    with pytest.raises(ValueError, match="one of each kind"):
        BySensors(sensors=[Pressure(rate=50.0), Pressure(rate=10.0)])


def test_the_depth_is_below_the_surface_of_an_episodes_flow():
    sensors = [Pressure(rate=50.0)]
    still = stepped(BySensors(sensors=sensors), 1)
    below = stepped(BySensors(sensors=sensors, flow=Wave(amplitude=0.01, wavelength=2.0, surface=1.0)), 1)
    assert below[0, 0] == pytest.approx(still[0, 0] + 1.0, abs=1e-9)
