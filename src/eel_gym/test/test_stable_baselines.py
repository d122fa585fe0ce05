# SPDX-License-Identifier: Apache-2.0
"""The environments in Stable-Baselines3, where that is installed: its check, its interface, its processes, seeds."""

import copy
import pickle
import warnings
from functools import partial

import gymnasium
import numpy as np
import pytest

from eel_gym import DepthEnv, HeadingEnv, JointAction, WayPointsEnv

REASON = "stable_baselines3 is missing (pip install -r docs/examples/ppo/requirements.txt)"
stable_baselines3 = pytest.importorskip("stable_baselines3", reason=REASON)
from eel_gym.stable_baselines import SwimmersVecEnv, make_vec  # noqa: E402
from stable_baselines3.common.env_checker import check_env  # noqa: E402
from stable_baselines3.common.env_util import make_vec_env  # noqa: E402
from stable_baselines3.common.vec_env import SubprocVecEnv  # noqa: E402

ENVIRONMENTS = {
    "heading": HeadingEnv,
    "depth": DepthEnv,
    "way points": WayPointsEnv,
    "joints": partial(HeadingEnv, action=JointAction("eight_servos")),
}
SHORT = {"duration": 0.5}  # 5 control steps


def actions_of(steps, swimmers):
    return np.random.default_rng(4).uniform(-1.0, 1.0, (steps, swimmers, 1)).astype(np.float32)


def swum(envs, steps=12):
    """Observations, rewards, ends and last observations of `steps` control steps."""
    envs.seed(7)
    seen = [envs.reset()]
    for action in actions_of(steps, envs.num_envs):
        observations, rewards, over, infos = envs.step(action)
        last = [info.get("terminal_observation", np.zeros(1)) for info in infos]
        seen += [observations, rewards.astype(np.float32), over, *last]
        assert [info.get("TimeLimit.truncated", False) for info in infos] == over.tolist()
    envs.close()
    return [each.tobytes() for each in seen]


@pytest.mark.parametrize("make", ENVIRONMENTS.values(), ids=ENVIRONMENTS)
def test_its_check_finds_nothing(make):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(make())


def test_swimmers_together_are_as_each_in_an_environment_of_its_own_and_in_processes_to_the_bit():
    """Episodes that begin anew among them: their first observations come from the same seeds."""
    together = swum(make_vec("Eel/Heading-v0", num_envs=3, threads=2, **SHORT))
    own = {"env_kwargs": SHORT, "n_envs": 3}
    assert swum(make_vec_env(HeadingEnv, **own)) == together
    spawned = {"vec_env_cls": SubprocVecEnv, "vec_env_kwargs": {"start_method": "spawn"}}
    assert swum(make_vec_env(HeadingEnv, **own, **spawned)) == together


def test_a_task_that_ends_is_no_limit_of_time():
    envs = make_vec("Eel/WayPoints-v0", num_envs=2, points=1, distance=0.5, reach=0.4, greatest_turn=0.0)
    envs.reset()
    over = np.zeros(2, dtype=bool)
    while not over.any():
        _, rewards, over, infos = envs.step(np.zeros((2, 1)))
    info = infos[int(np.argmax(over))]
    assert rewards[over].min() > 0.9 and not info["TimeLimit.truncated"] and info["episode"]["r"] > 0.9


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda envs: pickle.loads(pickle.dumps(envs))])
def test_copies_go_on_by_themselves_to_the_bit(copied):
    envs = make_vec("Eel/Heading-v0", num_envs=2, **SHORT).venv
    envs.seed(3), envs.reset(), envs.step(actions_of(1, 2)[0])
    other = copied(envs)
    for action in actions_of(8, 2):
        one, two = envs.step(action), other.step(action)
        assert one[0].tobytes() == two[0].tobytes() and one[1].tobytes() == two[1].tobytes()


def test_learning_from_one_seed_gives_the_same_policy_to_the_bit():
    def learned(seed):
        model = stable_baselines3.PPO(
            "MlpPolicy", make_vec("Eel/Heading-v0", num_envs=2), n_steps=64, n_epochs=2, seed=seed, device="cpu"
        )
        model.learn(256)
        return [values.numpy().tobytes() for values in model.policy.state_dict().values()]

    first = learned(1)
    assert learned(1) == first != learned(2)


def test_what_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="envs must have the autoreset_mode SameStep, got NextStep"):
        SwimmersVecEnv(gymnasium.make_vec("Eel/Heading-v0", num_envs=2))
    with pytest.raises(AttributeError, match="'target' cannot be set: the environments of make_vec have it in common"):
        make_vec("Eel/Heading-v0", num_envs=2).set_attr("target", 1.0)
