# SPDX-License-Identifier: Apache-2.0
"""Many swimmers of one task for Stable-Baselines3, which has an interface of its own for parallel environments.

    from stable_baselines3 import PPO
    from eel_gym.stable_baselines import make_vec

    PPO("MlpPolicy", make_vec("Eel/Heading-v0", num_envs=8)).learn(200_000)

`ImportError` without stable_baselines3. Nothing else in eel_gym needs it.
"""

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

from eel_gym.vector_env import ThreadedVectorEnv

try:
    from stable_baselines3.common.vec_env import VecEnv, VecMonitor
except ImportError as error:
    raise ImportError(
        f"eel_gym.stable_baselines needs stable_baselines3 ({error}); install it with: pip install stable-baselines3"
    ) from None


def make_vec(task: str, num_envs: int = 8, **settings: Any) -> VecMonitor:
    """`num_envs` environments of a `task`, as `gymnasium.make_vec` makes them, with the monitor of episodes.

    settings: of the environments, and `threads`.
    """
    made = gymnasium.make_vec(task, num_envs, autoreset_mode=AutoresetMode.SAME_STEP, **settings)
    assert isinstance(made, ThreadedVectorEnv)
    return VecMonitor(SwimmersVecEnv(made))


class SwimmersVecEnv(VecEnv):
    """The environments of `envs`, whose episodes begin anew in the step that ends them (`SAME_STEP`).

    `infos` have what Stable-Baselines3 reads: `terminal_observation`, and `TimeLimit.truncated` where an episode was
    truncated and not terminated, so that its value goes on.
    """

    def __init__(self, envs: ThreadedVectorEnv):
        if envs.metadata["autoreset_mode"] is not AutoresetMode.SAME_STEP:
            raise ValueError(f"envs must have the autoreset_mode SameStep, got {envs.metadata['autoreset_mode'].value}")
        self.envs = envs
        self._actions: Any = None
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)

    def reset(self) -> np.ndarray:
        """Begin an episode in each; those that `seed` has seeded begin with their seeds."""
        seeds = self._seeds if any(seed is not None for seed in self._seeds) else None
        observations, _ = self.envs.reset(seed=seeds)
        self.reset_infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        """Take the `actions` (N, A) of the next step."""
        self._actions = actions

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        """One control step of each: observations (N, D), rewards (N,), whether episodes are over, infos."""
        observations, rewards, terminated, truncated, found = self.envs.step(self._actions)
        over, reasons = terminated | truncated, found.get("stopped", np.full(self.num_envs, None))
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for index in np.flatnonzero(over).tolist():
            infos[index] = {
                "terminal_observation": found["final_obs"][index],
                "TimeLimit.truncated": bool(truncated[index] and not terminated[index]),
                "stopped": reasons[index],
            }
        return observations, rewards.astype(np.float32), over, infos

    def close(self) -> None:
        """Close the environments."""
        self.envs.close()

    def get_images(self) -> Sequence[Any]:
        """A picture of each, with the render mode rgb_array."""
        return self.envs.render()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """The attribute of these environments; None: of all."""
        found = self.envs.get_attr(attr_name)
        return [found[index] for index in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Refused with `AttributeError`: the environments have their attributes in common."""
        raise AttributeError(f"{attr_name!r} cannot be set: the environments of make_vec have it in common")

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """The results of the method of these environments; None: of all."""
        methods = self.get_attr(method_name, indices)
        return [method(*method_args, **method_kwargs) for method in methods]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """Whether each is in such a wrapper: none is."""
        return [False for _ in self._get_indices(indices)]
