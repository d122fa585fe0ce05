# SPDX-License-Identifier: Apache-2.0
"""Environments whose actions are commands for the joints of a robot."""

import gymnasium
import numpy as np
import pytest
from eel_gym.vector_env import HeadingVectorEnv
from gymnasium.utils.env_checker import check_env

from eel_dynamics import Joint, PassiveTail, Robot, Scene, Servo, Simulation
from eel_gaits import Law, straight
from eel_gym import HeadingEnv, JointAction, KnotAction, LawAction, ThreadedVectorEnv, WayPointsEnv

MODES = {"position": "position", "velocity": "velocity", "torque": "effort"}
GREATEST = {"position": 0.3, "velocity": 2.0, "torque": 0.2}


def actions(steps, joints=8):
    k = np.arange(steps)[:, None]
    return np.sin(2.0 * np.pi * (0.03 * k - np.arange(joints) / joints))


@pytest.mark.parametrize("kind", MODES)
def test_a_step_is_that_of_the_simulation_with_these_commands(kind):
    env = WayPointsEnv(action=JointAction("eight_servos", kind, GREATEST[kind]), control_period=0.02)
    env.reset(seed=1)
    start, robot = env.starts[0], Robot.named("eight_servos")
    twist = (start.roll_rate, 0.0, 0.0, start.speed, 0.0, 0.0)
    half = 0.5 * start.heading
    alone = Simulation(
        scene=Scene(planar=True, internal_wrench=False, ledger=False), robot=robot, stations=2, twist=twist,
        position=start.position, orientation=(0.0, 0.0, np.sin(half), np.cos(half)), law=Law(name="none"),
    )  # fmt: skip
    for step, action in enumerate(actions(25)):
        observation, *_ = env.step(action)
        for joint, value in zip(robot.joints, action, strict=True):
            trim = start.left_trim / 8 if kind == "position" else 0.0
            alone.command(joint.name, **{MODES[kind]: value * GREATEST[kind] + trim})
        alone.advance((step + 1) / 50)
        assert env.head.position == pytest.approx(alone.head.position, abs=1e-12)
        seen = alone.observe().joints
        told = env.scales * observation
        assert told[-16:-8] == pytest.approx(seen["joint_angle"], abs=1e-6)
        assert told[-8:] == pytest.approx(seen["joint_rate"], abs=1e-5)
    assert np.abs(env.head.velocity).max() > 0.01


def test_many_at_once_are_as_each_alone_to_the_last_bit():
    settings = {"action": JointAction("eight_servos", "torque", 0.1)}
    alone = WayPointsEnv(**settings)
    seen = [alone.reset(seed=3)[0]]
    seen += [alone.step(action)[0] for action in actions(10)]
    for threads in (1, 2):
        envs = ThreadedVectorEnv(3, task=WayPointsEnv, threads=threads, **settings)
        found = [envs.reset(seed=1)[0]]
        found += [envs.step(np.tile(action, (3, 1)))[0] for action in actions(10)]
        np.testing.assert_array_equal([each[2] for each in found], seen)


def test_the_environment_is_one_of_gymnasium_and_a_joint_without_servo_is_seen(tmp_path):
    robot = Robot([Joint(0.3, actuator=Servo(torque_limit=0.5)), Joint(0.7, stiffness=1.0, damping=0.1)])
    env = gymnasium.make("Eel/Heading-v0", action=JointAction(robot, "torque")).unwrapped
    check_env(env, skip_render_check=True)
    assert env.action_space.shape == (1,) and env.action.greatest.tolist() == [0.5]
    told = env.describe()
    assert "torque of joint_1 [N m], -0.5 to 0.5" in told and "rate of joint_2 [rad/s]" in told
    env.reset(seed=1)
    for _ in range(20):
        observation, *_ = env.step([1.0])
    assert observation[5] > 0.1 and observation[6] != 0.0  # the water bends the passive joint


def test_an_episode_of_a_robot_is_recorded(tmp_path):
    pytest.importorskip("rerun")
    settings = {"render_mode": "rerun", "recordings": tmp_path}
    env = WayPointsEnv(action=JointAction("eight_servos"), **settings)
    env.reset(seed=1)
    for action in actions(5):
        env.step(action)
    env.close()
    assert (tmp_path / "WayPoints-0.rrd").stat().st_size > 1000


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: KnotAction(length=np.inf), "length must be finite, got inf"),
        (lambda: KnotAction(axes=1), "axes must be pitch, yaw or both, got 1"),
        (
            lambda: LawAction(straight(), {"left_bend": (-1.0, 1.0)}, length="long"),
            "length must be a number, got 'long'",
        ),
        (lambda: HeadingEnv(threads=1e20), "threads must be <= 1000, got 1e"),
        (lambda: HeadingVectorEnv(task=HeadingEnv()), "task must be a class of SwimmerEnv, got"),
        (lambda: HeadingVectorEnv(max_episode_steps="ten"), "max_episode_steps must be a number, got 'ten'"),
        (lambda: HeadingVectorEnv(num_envs=2).reset(seed=0.5), "seed must be one, or 2, got 0.5"),
        (lambda: HeadingVectorEnv(num_envs=2).reset(seed=[1]), "seed must be one, or 2, got 1"),
    ],
)
def test_what_is_no_argument_of_environments_is_refused_by_name(make, told):
    with pytest.raises(ValueError, match=told):
        make()


@pytest.mark.fault("parameters", "an action for joints that a robot does not have, or of no kind", "refused by name")
@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: JointAction("ten_servos"), "robot must be one of eight_servos"),
        (lambda: JointAction("eight_servos", "power"), "kind must be one of position, velocity, torque, got 'power'"),
        (lambda: JointAction(Robot([PassiveTail(0.6, 0.3)])), "robot must have a joint with a servo"),
        (lambda: JointAction(Robot([Joint(0.4, actuator=Servo())]), "torque"), "servo has no torque_limit, got None"),
        (lambda: JointAction("eight_servos", greatest=-1.0), "greatest must be > 0 rad, got -1"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(make, told):
    with pytest.raises(ValueError, match=told):
        make()


def test_a_robot_that_stops_ends_its_episode_alone():
    env = ThreadedVectorEnv(2, task=WayPointsEnv, action=JointAction("eight_servos", "torque", 3.0))
    env.reset(seed=1)
    wild = np.where(np.arange(2)[:, None] == 0, np.sign(actions(1)), 0.0)
    for _ in range(30):
        observations, _, terminated, _, _ = env.step(wild)
        assert np.isfinite(observations).all() and not terminated[1]
