# SPDX-License-Identifier: Apache-2.0
"""The definition of a task: its numbers, observation, reward and end, and the state on which they depend."""

import inspect
import math
from dataclasses import dataclass, fields
from typing import Any, ClassVar, NamedTuple

import gymnasium
import numpy as np
from eel_common.head_motion import wrapped
from eel_common.quantity import Quantities, checked_instance, described_fields, quantity
from eel_common.wording import shown
from eel_dynamics.model.body.body import Body, checked_body
from eel_dynamics.model.scene import Scene
from eel_dynamics.simulation.sampled_swimmers import Array
from eel_gaits.gaits.swimming import straight

from eel_gym.joint_action import JointAction
from eel_gym.knot_action import KnotAction
from eel_gym.law_action import LawAction

Action = LawAction | KnotAction | JointAction
ANGLE, SPEED, SPIN = 0.5, 0.5, 1.0  # rad, m/s, rad/s: scales of observed values, near those of straight()
MOST = 10.0  # greatest magnitude of an observed number, in its scale
LOW, HIGH = np.array(-1.0), np.array(1.0)  # bounds of an action, as arrays, which are faster than floats
GREATEST_START_SPEED = 0.5  # m/s: greatest start speed that tasks draw, near that of straight()


class Observed(NamedTuple):
    """A number in the observation, which holds value / scale, at most 10 in magnitude."""

    name: str
    unit: str
    scale: float  #: typical magnitude of the value


class Start(NamedTuple):
    """The state at the start of an episode, with a level head, in REP-103 axes."""

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: m, world
    heading: float = 0.0  #: rad, positive: left
    speed: float = 0.0  #: m/s, forward
    roll_rate: float = 0.0  #: rad/s
    own_time: float = 0.0  #: s, of the law
    left_trim: float = 0.0  #: rad/m, the body's own bend, which the policy does not see
    goal: tuple[float, ...] = ()  #: the task's numbers for the episode


@dataclass(frozen=True, kw_only=True)
class Episode(Quantities):
    """The numbers common to all tasks."""

    control_period: float = quantity(0.1, unit="s", description="length of a control step", minimum=1e-3, maximum=1.0)
    duration: float = quantity(
        20.0, unit="s", description="length of an episode, at which it is truncated", minimum=0.1, maximum=1e5
    )


class Task(gymnasium.Env[Any, Any]):
    """A task for one swimmer, or for N in parallel.

    `head` is the motion of the head, `head_heading` and `heading` its direction, and `goal` (G,) the numbers of the
    episode (`Start.goal`), which a task may change in `reward`. For N swimmers the headings are (N,), `goal` is (G, N),
    and the parts of `head` are (., N). So the same array expressions serve one swimmer and many.
    """

    name: ClassVar[str] = ""
    Numbers: ClassVar[type[Episode]] = Episode
    observed: ClassVar[tuple[Observed, ...]] = ()

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        cls.__doc__ = described_task(cls)

    def __init__(
        self,
        body: Body | None,
        scene: Scene | None,
        action: Action | None,
        shape: tuple[int, ...],
        numbers: dict[str, Any],
        sensed: tuple[Observed, ...] = (),
    ):
        self.numbers = checked_numbers(self.name, self.Numbers, numbers)
        self.scene = self.default_scene() if scene is None else checked_instance("scene", scene, Scene)
        self.body = checked_body(action.robot.body if body is None and isinstance(action, JointAction) else body)
        if action is not None and not isinstance(action, Action):
            raise ValueError(f"action must be a LawAction, a KnotAction or a JointAction, got {shown(action)}")
        self.action = self.default_action() if action is None else action
        self.sensed = sensed  #: what sensors tell
        seen = (*self.observed, *sensed, *self.action.names_of_state)
        self.observation_space = gymnasium.spaces.Box(-MOST, MOST, (len(seen),), np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (self.action.size,), np.float32)
        self.shape = shape  #: () for one swimmer, or (N,)
        self._shape_of_action = (*shape, self.action.size)
        self._seen: Array = np.empty((len(seen), *shape))
        self.scales: Array = np.array([each[2] for each in seen])  #: (D,) of the numbers of the observation
        self._by_scale = np.full_like(self._seen.T, 1.0 / self.scales).T
        self.head: Any = None  #: a HeadMotion after the first reset
        self.head_heading: Any = None  #: rad, of the head at present; positive: left
        self.heading: Any = np.zeros(shape) if shape else 0.0  #: rad, the same averaged over the gait's period
        self.goal: Array = np.zeros((0, *shape))
        self.readings: Array = np.zeros((len(sensed), *shape))  #: of `sensed`

    # -- a task defines these

    def default_scene(self) -> Scene:
        """The default scene: motion only, without internal wrench and energy ledger."""
        return Scene(internal_wrench=False, ledger=False)

    def default_action(self) -> Action:
        """The default action."""
        bends = {"left_bend": (-0.5, 0.5)} if self.scene.planar else {"left_bend": (-0.5, 0.5), "up_bend": (-0.5, 0.5)}
        return LawAction(straight(), bends, length=self.body.length)

    def begin(self, options: dict[str, Any]) -> Start:
        """Draw the random numbers of a swimmer's episode from `self.np_random`. options: those of `reset`."""
        return Start()

    def observe(self) -> list[Any]:
        """The numbers of `observed`, from `self.head`, `self.heading` and `self.goal`."""
        return []

    def reward(self) -> Any:
        """The reward of the control step that has just ended."""
        raise NotImplementedError(f"{type(self).__name__} must define reward")

    def ended(self) -> Any:
        """Whether the episode is over: the task is done, or a limit is exceeded."""
        return False

    def marks(self) -> list[tuple[float, float, float]]:
        """Points [m], in the world, for pictures of one swimmer."""
        return []

    # -- results

    def observation(self) -> np.ndarray:
        """(D,) or (N, D) float32: what the task observes, readings and the state of the action, each by its scale."""
        for row, value in enumerate((*self.observe(), *self.readings, *self.action.state)):
            self._seen[row] = value
        return (self._seen * self._by_scale).T.clip(-MOST, MOST).astype(np.float32, order="C")

    def checked_action(self, action: Any) -> Array:
        """The action of each swimmer, clipped to the bounds. `InvalidAction` for an unsuitable one."""
        shape = self._shape_of_action
        try:
            values = np.asarray(action, dtype=float)
        except (TypeError, ValueError):
            values = np.empty(0)
        if values.shape != shape or not all(map(math.isfinite, values.ravel().tolist())):
            wanted = f"{'actions' if self.shape else 'action'} must be {' x '.join(map(str, shape))} finite numbers"
            raise gymnasium.error.InvalidAction(f"{wanted}, got {shown(action)}")
        return np.asarray(np.minimum(np.maximum(values, LOW), HIGH))

    def describe(self) -> str:
        """One line for each number of the observation, with unit and scale, and of the action, with unit and bounds."""
        seen = [*self.observed, *self.sensed, *self.action.names_of_state]
        lines = [f"  {name} [{unit or '1'}] / {scale:g}" for name, unit, scale in seen]
        return "\n".join(
            ["observation:", *lines, "action, each from -1 to 1:", *(f"  {each}" for each in self.action.described())]
        )


class MeanHeading:
    """The mean of the last `count` headings [rad], also across the jump from pi to -pi, as the head swings with the
    gait. For one swimmer or for the `swimmers` (N,)."""

    def __init__(self, count: int, swimmers: tuple[int, ...] = ()):
        self._count, self._swimmers, self._place = count, swimmers, 0  # place: index of the last heading
        # rad, each within half a turn of the previous one; 0 without one
        self._headings: Any = np.zeros((count, *swimmers)) if swimmers else [0.0] * count
        begun: Any = np.zeros((3, *swimmers)) if swimmers else (0.0, 0.0, 0.0)
        self._last, self._sum, self._known = begun

    def clear(self) -> None:
        """Discard all headings."""
        self.__init__(self._count, self._swimmers)  # type: ignore[misc]

    def add(self, heading: Any) -> Any:
        """Add a `heading` [rad]. Returns the mean [rad], from -pi to pi."""
        self._place = (self._place + 1) % self._count
        self._last = self._last + wrapped(heading - self._last)
        self._sum = self._sum + self._last - self._headings[self._place]
        self._headings[self._place] = self._last
        self._known = self._known + (self._known < self._count)
        return wrapped(self._sum / self._known)

    def begin_some(self, swimmers: list[int], headings: Array) -> Array:
        """The means [rad] of K of N swimmers whose only headings are these."""
        begun: Array = wrapped(headings)
        self._headings[:, swimmers] = 0.0
        for each in (self._headings[self._place], self._last, self._sum):
            each[swimmers] = begun
        self._known[swimmers] = 1.0
        return begun


def described_task(task: type[Task]) -> str:
    """The docstring of a task, with its observation and its numbers."""
    seen = "\n".join(f"    {each.name} [{each.unit or '1'}] / {each.scale:g}" for each in task.observed)
    observed = f"Observed, by its scale, before the state of the action:\n{seen}"
    text = inspect.cleandoc(task.__doc__ or "A task.")
    return f"{text}\n\n{observed}\n\nNumbers:\n{described_fields(task.Numbers)}\n"


def checked_numbers(task: str, kind: type[Episode], given: dict[str, Any]) -> Episode:
    """The numbers of a task. `ValueError` names an unknown or unsuitable one."""
    known = [item.name for item in fields(kind)]
    for name in given:
        if name not in known:
            others = "body, scene, accuracy, action, flow, render_mode, recordings"
            raise ValueError(f"task {shown(task)} has no parameter {shown(name)}, it has: {', '.join(known)}, {others}")
    return kind(**given)
