# SPDX-License-Identifier: Apache-2.0
"""Many swimmers of one task at once: array expressions, and one call of the core, over threads."""

from typing import Any, ClassVar

import gymnasium
import numpy as np
from eel_common.wording import shown
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from eel_gym.depth import DepthEnv
from eel_gym.heading import HeadingEnv
from eel_gym.swimmer_env import SwimmerEnv, checked_count
from eel_gym.way_points import WayPointsEnv


class ThreadedVectorEnv(VectorEnv[Any, Any, Any]):
    """`num_envs` environments of one task, stepped in `threads`. Each gives the same results as alone, to the last bit.

    Derive a class with a `task`, or give one. An environment whose episode has ended begins another at the next step
    (`AutoresetMode.NEXT_STEP`), or in the same step (`SAME_STEP`: the last observation and info are in
    `infos["final_obs"]` and `infos["final_info"]`), or waits for `reset(options={"reset_mask": ...})` (`DISABLED`).

    Args:
        num_envs: number of environments.
        task: class of the environments.
        threads: number of threads that march the swimmers.
        autoreset_mode: see above.
        max_episode_steps: control steps after which an episode is truncated; None: only the task's `duration` counts.
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
        **settings: Any,
    ):
        try:
            self._mode = AutoresetMode(autoreset_mode)
        except ValueError:
            known = ", ".join(mode.value for mode in AutoresetMode)
            raise ValueError(f"autoreset_mode must be one of {known}, got {shown(autoreset_mode)}") from None
        task = self.task if task is None else task
        if not callable(task) or (isinstance(task, type) and not issubclass(task, SwimmerEnv)):
            raise ValueError(f"task must be a class of SwimmerEnv, got {shown(task)}")
        if max_episode_steps is not None:
            checked_count("max_episode_steps", max_episode_steps)
        self.num_envs = checked_count("num_envs", num_envs)
        self.swimmers = task(swimmers=self.num_envs, threads=threads, **settings)
        first, self._limit = self.swimmers, max_episode_steps
        self.metadata = {**first.metadata, "autoreset_mode": self._mode}
        self.render_mode = first.render_mode
        self.single_observation_space, self.single_action_space = first.observation_space, first.action_space
        self.observation_space = batch_space(first.observation_space, self.num_envs)
        self.action_space = batch_space(first.action_space, self.num_envs)
        self._draws = [seeding.np_random()[0] for _ in range(self.num_envs)]
        self._over: np.ndarray = np.zeros(self.num_envs, dtype=bool)
        self._begun = False

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin an episode in each environment, or in those of `options["reset_mask"]` (num_envs,) bool.

        seed: None, one for all (environment i gets seed + i), or one each. `ValueError` for any other number of seeds.
        """
        options = dict(options or {})
        mask = np.asarray(options.pop("reset_mask", np.ones(self.num_envs, dtype=bool)))
        if mask.shape != (self.num_envs,) or mask.dtype != bool or not mask.any():
            raise ValueError(
                f"reset_mask must hold {self.num_envs} truths, one of them true, got {shown(mask.tolist())}"
            )
        if seed is None or isinstance(seed, (int, np.integer)):
            seed = [None if seed is None else int(seed) + index for index in range(self.num_envs)]
        if not hasattr(seed, "__len__") or len(seed) != self.num_envs:
            got = len(seed) if hasattr(seed, "__len__") else shown(seed)
            raise ValueError(f"seed must be one, or {self.num_envs}, got {got}")
        chosen = np.flatnonzero(mask).tolist()
        for index in chosen:
            if seed[index] is not None:
                self._draws[index] = seeding.np_random(seed[index])[0]
        self._begin(chosen, options)
        self._begun = True
        return self.swimmers.observation(), {}

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """One control step of each environment: observations, rewards, terminations, truncations, infos."""
        values, over = self.swimmers.checked_action(actions), self._over
        if not self._begun or (self._mode is AutoresetMode.DISABLED and over.any()):
            raise gymnasium.error.ResetNeeded("environments whose episode has ended must be reset before step")
        observations, rewards, terminated, truncated, stopped = self.swimmers.march(values)
        rewards, terminated = np.array(rewards), terminated | np.zeros(self.num_envs, dtype=bool)
        if self._limit is not None:
            truncated |= self.swimmers.ticks >= self._limit
        infos: dict[str, Any] = {}
        for index, reason in stopped.items():
            if not (self._mode is AutoresetMode.NEXT_STEP and over[index]):
                infos = self._add_info(infos, {"stopped": reason}, index)
        begun = over if self._mode is AutoresetMode.NEXT_STEP else terminated | truncated
        if np.count_nonzero(begun) and self._mode is not AutoresetMode.DISABLED:
            if self._mode is AutoresetMode.NEXT_STEP:
                rewards[over], terminated[over], truncated[over] = 0.0, False, False
            chosen = np.flatnonzero(begun).tolist()
            if self._mode is AutoresetMode.SAME_STEP:
                for index in chosen:
                    final = {"stopped": stopped[index]} if index in stopped else {}
                    infos = self._add_info(infos, {"final_obs": observations[index], "final_info": final}, index)
            self._begin(chosen, {})
            observations = np.where(begun[:, None], self.swimmers.observation(), observations)
        self._over = terminated | truncated
        return observations, rewards, terminated, truncated, infos

    def render(self) -> tuple[Any, ...]:
        """The results of `render` for all environments."""
        return tuple(map(self.swimmers.picture_of, range(self.num_envs)))

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """The attribute `name` of all environments."""
        return tuple(getattr(self.swimmers.one(index), name) for index in range(self.num_envs))

    def call(self, name: str, *arguments: Any, **keywords: Any) -> tuple[Any, ...]:
        """The results of the method `name` for all environments."""
        return tuple(method(*arguments, **keywords) for method in self.get_attr(name))

    def close_extras(self, **keywords: Any) -> None:
        """Close the environments."""
        self.swimmers.close()

    def _begin(self, chosen: list[int], options: dict[str, Any]) -> None:
        self.swimmers.begin_episodes(chosen, options, self._draws)
        self._over[chosen] = False


class HeadingVectorEnv(ThreadedVectorEnv):
    """Eel/Heading-v0, many at once."""

    task = HeadingEnv


class DepthVectorEnv(ThreadedVectorEnv):
    """Eel/Depth-v0, many at once."""

    task = DepthEnv


class WayPointsVectorEnv(ThreadedVectorEnv):
    """Eel/WayPoints-v0, many at once."""

    task = WayPointsEnv
