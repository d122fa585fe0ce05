# SPDX-License-Identifier: Apache-2.0
"""Many swimmers at once, in threads: the mechanics run without Python's lock."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ClassVar

import gymnasium
import numpy as np
from eel_base.quantity import positive
from eel_base.wording import shown
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from eel_gym.depth import DepthEnv
from eel_gym.heading import HeadingEnv
from eel_gym.swimmer_env import SwimmerEnv
from eel_gym.way_points import WayPointsEnv


class ThreadedVectorEnv(VectorEnv):
    """`num_envs` environments of one task, stepped in `threads`. Each behaves as it would alone, to the last bit.

    Derive a class with a `task`, or give one. An environment whose episode has ended begins another at the next step
    (`AutoresetMode.NEXT_STEP`), or in the same step (`SAME_STEP`: the last observation and info are in
    `infos["final_obs"]` and `infos["final_info"]`), or waits for `reset(options={"reset_mask": ...})` (`DISABLED`).

    Args:
        num_envs: how many.
        task: class of the environments.
        threads: how many. More than one gain only where a control step takes milliseconds of the mechanics.
        autoreset_mode: see above.
        max_episode_steps: control steps after which an episode is truncated; None: by the task's `duration` alone.
        settings: of each environment.
    """

    metadata: dict[str, Any] = {**SwimmerEnv.metadata, "autoreset_mode": AutoresetMode.NEXT_STEP}  # noqa: RUF012
    task: ClassVar[type[SwimmerEnv]] = SwimmerEnv

    def __init__(
        self,
        num_envs: int = 1,
        *,
        task: type[SwimmerEnv] | None = None,
        threads: int = 1,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        max_episode_steps: int | None = None,
        **settings,
    ):
        for name, count in (("num_envs", num_envs), ("threads", threads)):
            if positive(name, count) != int(count):
                raise ValueError(f"{name} must be a whole number, got {shown(count)}")
        try:
            self._mode = AutoresetMode(autoreset_mode)
        except ValueError:
            known = ", ".join(mode.value for mode in AutoresetMode)
            raise ValueError(f"autoreset_mode must be one of {known}, got {shown(autoreset_mode)}") from None
        self.num_envs, kind = int(num_envs), task or self.task
        self.envs: list[gymnasium.Env] = [kind(**settings) for _ in range(self.num_envs)]
        if max_episode_steps is not None:
            self.envs = [gymnasium.wrappers.TimeLimit(env, max_episode_steps) for env in self.envs]
        first = self.envs[0]
        self.metadata = {**first.metadata, "autoreset_mode": self._mode}
        self.render_mode = first.render_mode
        self.single_observation_space, self.single_action_space = first.observation_space, first.action_space
        self.observation_space = batch_space(first.observation_space, self.num_envs)
        self.action_space = batch_space(first.action_space, self.num_envs)
        self._threads = min(self.num_envs, int(threads))
        self._pool = ThreadPoolExecutor(self._threads)
        self._observations: np.ndarray = np.zeros(self.observation_space.shape or (), dtype=np.float32)
        self._over: np.ndarray = np.zeros(self.num_envs, dtype=bool)

    def reset(self, *, seed=None, options: dict | None = None) -> tuple[np.ndarray, dict]:
        """Begin an episode in each environment, or in those of `options["reset_mask"]` (num_envs,) bool.

        seed: None, one for all (environment i gets seed + i), or one each. `ValueError` for another number of them.
        """
        options = dict(options or {})
        mask = np.asarray(options.pop("reset_mask", np.ones(self.num_envs, dtype=bool)))
        if mask.shape != (self.num_envs,) or mask.dtype != bool or not mask.any():
            raise ValueError(
                f"reset_mask must hold {self.num_envs} truths, one of them true, got {shown(mask.tolist())}"
            )
        if seed is None or isinstance(seed, (int, np.integer)):
            seed = [None if seed is None else int(seed) + index for index in range(self.num_envs)]
        if len(seed) != self.num_envs:
            raise ValueError(f"seed must be one, or {self.num_envs}, got {len(seed)}")
        chosen = np.flatnonzero(mask).tolist()
        begun = self._each(lambda index: self.envs[index].reset(seed=seed[index], options=options), chosen)
        infos: dict = {}
        for index, (observation, info) in zip(chosen, begun, strict=True):
            self._observations[index] = observation
            infos = self._add_info(infos, info, index)
        self._over[chosen] = False
        return self._observations.copy(), infos

    def step(self, actions) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict]:
        """One control step of each: observations, rewards, terminations, truncations, infos."""
        if np.shape(actions) != self.action_space.shape or not np.isfinite(actions).all():
            shape = " x ".join(map(str, self.action_space.shape or ()))
            raise gymnasium.error.InvalidAction(f"actions must be {shape} finite numbers, got {shown(actions)}")
        if self._mode is AutoresetMode.DISABLED and self._over.any():
            raise gymnasium.error.ResetNeeded("environments whose episode has ended must be reset before step")
        rewards, over = np.zeros(self.num_envs), np.zeros((2, self.num_envs), dtype=bool)
        infos: dict = {}
        results = self._each(lambda index: self._step(index, actions[index]), range(self.num_envs))
        for index, (observation, reward, terminated, truncated, info) in enumerate(results):
            self._observations[index], rewards[index] = observation, reward
            over[:, index] = terminated, truncated
            infos = self._add_info(infos, info, index)
        self._over = np.asarray(over.any(axis=0))
        return self._observations.copy(), rewards, over[0], over[1], infos

    def render(self) -> tuple:
        """What each renders."""
        return tuple(env.render() for env in self.envs)

    def get_attr(self, name: str) -> tuple:
        """The attribute `name` of each."""
        return tuple(env.get_wrapper_attr(name) for env in self.envs)

    def call(self, name: str, *arguments, **keywords) -> tuple:
        """What the method `name` of each returns."""
        return tuple(method(*arguments, **keywords) for method in self.get_attr(name))

    def close_extras(self, **keywords) -> None:
        """Close the environments and end the threads."""
        for env in self.envs:
            env.close()
        self._pool.shutdown()

    def _step(self, index: int, action) -> tuple:
        env = self.envs[index]
        if self._mode is AutoresetMode.NEXT_STEP and self._over[index]:
            observation, info = env.reset()
            return observation, 0.0, False, False, info
        observation, reward, terminated, truncated, info = env.step(action)
        if self._mode is AutoresetMode.SAME_STEP and (terminated or truncated):
            final = {"final_obs": observation, "final_info": info}
            observation, info = env.reset()
            info = {**info, **final}
        return observation, reward, terminated, truncated, info

    def _each(self, act: Callable[[int], tuple], indices) -> list:
        """act(index) for each of the `indices`, in one run per thread."""
        indices = list(indices)
        if self._threads == 1:
            return [act(index) for index in indices]
        parts = [indices[start :: self._threads] for start in range(self._threads)]
        found: dict = {}
        for part, results in zip(
            parts, self._pool.map(lambda part: [act(index) for index in part], parts), strict=True
        ):
            found |= dict(zip(part, results, strict=True))
        return [found[index] for index in indices]


class HeadingVectorEnv(ThreadedVectorEnv):
    """Eel/Heading-v0, many at once."""

    task = HeadingEnv


class DepthVectorEnv(ThreadedVectorEnv):
    """Eel/Depth-v0, many at once."""

    task = DepthEnv


class WayPointsVectorEnv(ThreadedVectorEnv):
    """Eel/WayPoints-v0, many at once."""

    task = WayPointsEnv
