# SPDX-License-Identifier: Apache-2.0
"""The base class of the environments: control steps of one swimmer, or of many in parallel."""

import copy
import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Self

import gymnasium
import numpy as np
from eel_common.head_motion import HeadMotion
from eel_common.quantity import checked_instance, number
from eel_common.wording import not_one_of, one_line, shown
from eel_dynamics.accuracy.accuracy import STANDARD, Accuracy
from eel_dynamics.batches.simulate_batch import MOST_THREADS
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.initial_state import level_orientation
from eel_dynamics.model.scene import Scene
from eel_dynamics.sensors.sensor import SensorSettings
from eel_dynamics.sensors.suite import check_settings, places_of
from eel_dynamics.simulation.commanded_robots import CommandedRobots
from eel_dynamics.simulation.sampled_swimmers import LEFT_OUT, Array, SampledSwimmers
from eel_dynamics.simulation.swimmer import Swimmer
from numpy.typing import NDArray

from eel_gym.episode_recording import EpisodeRecording
from eel_gym.joint_action import JointAction
from eel_gym.picture import picture
from eel_gym.sensing import Sensing, observed_by
from eel_gym.task import Action, MeanHeading, Start, Task


def checked_count(name: str, count: Any, most: float | None = None) -> int:
    """`count` as an int of at least 1, and at most `most`."""
    found = number(name, count, minimum=0.0, maximum=most, exclusive=True)
    if found != int(found):
        raise ValueError(f"{name} must be a whole number, got {shown(count)}")
    return int(count)


class SwimmerEnv(Task):
    """A swimmer, moved by actions in control steps. Derive your own task from it.

    A task has a `name`, its `Numbers` (a dataclass derived from `Episode`), `observed` (names, units and bounds), and
    the methods `begin`, `observe`, `reward` and `ended`. `default_scene` and `default_action` may be replaced.

    The observation is what the task observes, then the `readings` of sensors (`sensed`), then the state of the action
    (`action.names_of_state`), as float32, in the REP-103 axes of the topics. An action is clipped to its bounds. One
    that is not finite, or has another shape, raises `gymnasium.error.InvalidAction`, and nothing moves. An episode is
    truncated after `duration`. It is terminated when the task ends, or when the swimmer cannot go on; `info["stopped"]`
    then gives the reason.

    Args:
        body, scene, accuracy: as in `Simulation`.
        action: a `LawAction`, a `KnotAction`, or a `JointAction` of a robot; by default the task's.
        render_mode: with "rgb_array" `render` returns a picture of the present, from above and from the side; with
            "rerun" each episode is written to the folder `recordings`, in the form of the visualiser.
        flow: the water's motion, as in `Simulation`; or a function of the environment's random numbers
            (`numpy.random.Generator`) that draws the flow of an episode. None: still water.
        sensors: `eel_dynamics.Imu`, `Pressure`, `Velocity`, `Encoders`; each episode has its own noise.
        swimmers, threads: N swimmers in parallel, and the threads that march them: for `ThreadedVectorEnv`.
        numbers: the task's, see `Numbers`.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "rerun"], "render_fps": 50}  # noqa: RUF012  as gymnasium's

    def __init__(
        self,
        *,
        body: Body | None = None,
        scene: Scene | None = None,
        accuracy: str | float | Accuracy = STANDARD,
        action: Action | None = None,
        render_mode: str | None = None,
        recordings: Any = "recordings",
        swimmers: int | None = None,
        threads: int = 1,
        flow: Flow | Callable[[np.random.Generator], Flow | None] | None = None,
        sensors: Sequence[SensorSettings] = (),
        **numbers: Any,
    ):
        shape = () if swimmers is None else (checked_count("swimmers", swimmers),)
        sensors = [checked_instance("sensors", each, SensorSettings) for each in sensors]
        super().__init__(body, scene, action, shape, numbers, observed_by(sensors, getattr(action, "robot", None)))
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(not_one_of("render_mode", render_mode, self.metadata["render_modes"]))
        if not (flow is None or isinstance(flow, Flow) or callable(flow)):
            raise ValueError(f"flow must be a Flow, or a function of random numbers that draws one, got {shown(flow)}")
        self.render_mode, self.flow = render_mode, flow
        self.metadata = self.metadata | {"render_fps": round(1.0 / self.numbers.control_period)}
        threads = checked_count("threads", threads, MOST_THREADS)
        count, stations = math.prod(shape), 51 if render_mode else 2
        robot = getattr(self.action, "robot", None)
        for each in sensors:
            check_settings(each, self.body, robot, 1.0 / self.numbers.control_period)
        swimmer = Swimmer(
            body=self.body,
            scene=self.scene,
            robot=robot,
            accuracy=Accuracy.of(accuracy),
            stations=stations,
            sensors=places_of(sensors),
        )
        self._sensing = Sensing(sensors, swimmer, count)
        self.swimmers: SampledSwimmers | CommandedRobots
        if isinstance(self.action, JointAction):
            self.swimmers = CommandedRobots(count, self.action.names, self.action.kind, swimmer, threads)
        else:
            self.swimmers = SampledSwimmers(count, self.action.x, self.action.waves, swimmer, threads)
        self._recordings = [EpisodeRecording(recordings, self.name) for _ in range(count * (render_mode == "rerun"))]
        self._mean_heading = MeanHeading(max(1, round(self.action.period / self.numbers.control_period)), self.shape)
        self.ticks: np.ndarray = np.zeros(count, dtype=int)  #: (N,) control steps of the present episodes
        self._trim: Array = np.zeros((*self.shape, 1))  # rad/m
        self._status: NDArray[np.int64] = np.full(count, LEFT_OUT)  # 0 after `reset`, until a swimmer stops
        self.starts = [Start()] * count  #: of the present episodes
        self.restart(np.zeros(self.shape))
        if isinstance(self.swimmers, SampledSwimmers):
            rows = self.action.advance(np.full((*self.shape, self.action.size), 0.5), self.numbers.control_period)
            self.swimmers.check(rows.reshape(-1, *rows.shape[-2:])[0])
            self.restart(np.zeros(self.shape))

    # -- one swimmer: Gymnasium's interface

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin an episode. Returns the first observation."""
        super().reset(seed=seed)
        self.begin_episodes([0], options or {}, [self.np_random])
        return self.observation(), {}

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """One control step: observation, reward, terminated, truncated, info."""
        if self._status[0] == LEFT_OUT:
            raise gymnasium.error.ResetNeeded("the environment must be reset before step")
        observation, reward, terminated, truncated, stopped = self.march(self.checked_action(action))
        return observation, float(reward), bool(terminated), bool(truncated), {"stopped": stopped[0]} if stopped else {}

    def render(self) -> Any:
        """The picture (400, 800, 3) of the present with rgb_array; None with rerun."""
        return self.picture_of(0)

    def close(self) -> None:
        """End the episode. With rerun, write its recording."""
        for index in range(len(self.ticks)):
            self._end(index)

    def restart(self, own_time: Any = 0.0) -> Array:
        """Restart the observation and the action. Returns the first curvature, as `action.advance` does.

        A controller of the dynamics node calls it at the start of a run.
        """
        self._mean_heading.clear()
        return self.action.begin(own_time)

    def see(self, head: HeadMotion) -> np.ndarray:
        """Take the motion of the head at the end of a control step. Returns the observation.

        A controller of the dynamics node calls it with the motion from a message.
        """
        self.head, self.head_heading = head, head.heading
        self.heading = self._mean_heading.add(self.head_heading)
        return self.observation()

    def __copy__(self) -> Self:
        """An independent copy, identical to the bit. `copy.deepcopy` and pickles give the same."""
        return copy.deepcopy(self)

    # -- one swimmer or many

    def begin_episodes(
        self, swimmers: list[int], options: dict[str, Any], draws: Sequence[np.random.Generator]
    ) -> None:
        """Begin an episode for each of these `swimmers`, drawn from its own entry of the random numbers `draws`.

        If one of them cannot begin, none does.
        """
        for index in swimmers:
            self._end(index)
            if self.np_random is not draws[index]:  # setting it discards its seed
                self.np_random = draws[index]
            self.starts[index] = start = self.begin(options)
            if len(start.goal) != len(self.goal):
                self.goal = np.zeros((len(start.goal), *self.shape))
            self.goal.reshape(len(start.goal), len(self.ticks))[:, index] = start.goal
        begun = [self.starts[index] for index in swimmers]
        self._trim.reshape(-1, 1)[swimmers, 0] = trims = np.array([start.left_trim for start in begun])
        if self.shape:
            rows = self.action.begin_some(swimmers, np.array([start.own_time for start in begun]))
        else:
            rows = self.restart(begun[0].own_time)[None]
        self._add_trim(rows, trims[:, None])
        for index, start, row in zip(swimmers, begun, rows, strict=True):
            twist = (start.roll_rate, 0.0, 0.0, start.speed, 0.0, 0.0)
            flow = self.flow if self.flow is None or isinstance(self.flow, Flow) else self.flow(draws[index])
            self.swimmers.start(index, start.position, level_orientation(start.heading), twist, row, flow)
            self._sensing.begin(index, draws[index], flow)
        self.ticks[swimmers] = self._status[swimmers] = 0
        self._look()
        if self.shape:
            self.heading[swimmers] = self._mean_heading.begin_some(swimmers, self.head_heading[swimmers])
        else:
            self.heading = self._mean_heading.add(self.head_heading)
        for index in swimmers:
            self._record(index)

    def march(self, actions: Array) -> tuple[np.ndarray, Any, Any, Any, dict[int, str]]:
        """March all active swimmers through a control step with their `actions`.

        Returns the observation, the reward, whether the episode is terminated, and whether truncated, each for one
        swimmer or (N,); and by index the reasons why swimmers could not go on. These have no reward.
        """
        if self.shape:
            self.swimmers.wake()
        rows = self.action.advance(actions, self.numbers.control_period)
        self._add_trim(rows, self._trim)
        self.ticks += 1
        elapsed = self.ticks / (1.0 / self.numbers.control_period)  # to the bit the instants of a node with this rate
        reasons = self.swimmers.advance(elapsed, rows if self.shape else rows[None], self._status)
        self._look()
        self.heading = self._mean_heading.add(self.head_heading)
        stopped = {index: one_line(reason) for index, reason in reasons.items()}
        for index in stopped:
            self._end(index)
        for index in range(len(self._recordings)):
            self._record(index)
        observation = self.observation()  # before the reward, which may change the goal
        reward, terminated = self.reward(), self.ended()
        truncated = (elapsed if self.shape else elapsed[0]) >= self.numbers.duration * (1.0 - 1e-9)
        if stopped:
            here = np.isin(np.arange(len(self.ticks)), list(stopped)).reshape(self.shape)
            reward, terminated, truncated = np.where(here, 0.0, reward), here | terminated, truncated & ~here
        return observation, reward, terminated, truncated, stopped

    def one(self, index: int) -> Self:
        """Swimmer `index` as an environment of its own, as far as tasks see it."""
        if not self.shape:
            return self
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.shape, other.heading = (), float(self.heading[index])
        if self.head is not None:  # after the first reset
            other.head = HeadMotion(*(part[:, index] for part in self.head))
            other.head_heading = float(self.head_heading[index])
        other.goal, other.readings = self.goal[:, index], self.readings[:, index]
        return other

    def picture_of(self, index: int) -> Any:
        """The result of `render` for swimmer `index`."""
        if self._status[index] == LEFT_OUT:
            raise gymnasium.error.ResetNeeded("the environment must be reset before render")
        if self.render_mode != "rgb_array":
            return None
        return picture(self.swimmers.observe(index, wrench=False, load=False), self.body, self.one(index).marks())

    def _look(self) -> None:
        """Take the motion of the heads, and of the joints."""
        heads = self.swimmers.heads.reshape(13, *self.shape).copy()
        self.head = HeadMotion(heads[:3], heads[3:7], heads[7:10], heads[10:])
        self.head_heading = self.head.heading
        if isinstance(self.swimmers, CommandedRobots) and isinstance(self.action, JointAction):
            self.action.see(self.swimmers.joints.reshape(2, -1, *self.shape).copy())
        for index in np.flatnonzero(self._status != LEFT_OUT).tolist() if self.sensed else ():
            self._sensing.look(index, partial(self.swimmers.observe, index, wrench=False, load=False))
        self.readings = self._sensing.values.reshape(-1, *self.shape)

    def _add_trim(self, rows: Array, left_trim: Array | float) -> None:
        """Add the bend `left_trim` [rad/m], one or (N, 1), to the action's curvature in `rows`, of one body or N."""
        if not isinstance(self.action, JointAction):
            yaw = rows[..., 3, :]
            yaw -= left_trim
        elif self.action.kind == "position":
            rows += left_trim * self.body.length / self.action.size

    def _record(self, index: int) -> None:
        if self._recordings and self._status[index] != LEFT_OUT:
            self._recordings[index].add(self.swimmers.observe(index, load=False))

    def _end(self, index: int) -> None:
        if self._recordings and self._status[index] != LEFT_OUT:
            self._recordings[index].finish(self.swimmers)
        self._status[index] = LEFT_OUT
