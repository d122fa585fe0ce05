# SPDX-License-Identifier: Apache-2.0
"""The base class of the environments: one swimmer, control steps, and what a task adds to them."""

import math
from dataclasses import dataclass, fields
from typing import Any, ClassVar, NamedTuple

import gymnasium
import numpy as np
from eel_base.quantity import Quantities, checked_instance, described_fields, quantity
from eel_base.wording import not_one_of, one_line, shown
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.axes import turn_vector
from eel_dynamics.model.body import Body, checked_body
from eel_dynamics.model.scene import Scene
from eel_dynamics.simulation.head_motion import head_motion_of, level_orientation
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.stopping import SimulationStopped
from eel_gaits.gaits.swimming import straight
from eel_gaits.pilot.head_motion import HeadMotion

from eel_gym.episode_recording import EpisodeRecording
from eel_gym.knot_action import KnotAction
from eel_gym.law_action import LawAction
from eel_gym.mean_heading import MeanHeading
from eel_gym.picture import picture

FASTEST, SPIN, FARTHEST = 10.0, 50.0, 100.0  # m/s, rad/s, m: bounds of what is observed
GREATEST_START_SPEED = 0.5  # m/s, that the tasks draw: near that of straight()


class Observed(NamedTuple):
    """A number that the policy sees."""

    name: str
    unit: str
    bound: float  #: greatest size; a larger value is cut to it


class Start(NamedTuple):
    """The head at the start of an episode, level, in REP-103 axes."""

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: m, world
    heading: float = 0.0  #: rad, positive: left
    speed: float = 0.0  #: m/s, forward
    roll_rate: float = 0.0  #: rad/s
    own_time: float = 0.0  #: s, of the law
    left_trim: float = 0.0  #: rad/m, a bend that the body has by itself, and that the policy does not see


@dataclass(frozen=True, kw_only=True)
class Episode(Quantities):
    """The numbers that all tasks have."""

    control_period: float = quantity(0.02, unit="s", description="length of a control step", minimum=1e-3, maximum=1.0)
    duration: float = quantity(
        20.0, unit="s", description="length of an episode, at which it is truncated", minimum=0.1, maximum=1e5
    )


class SwimmerEnv(gymnasium.Env):
    """A swimmer, moved by actions in control steps. Derive a class from it for a task of your own.

    A task has a `name`, its `Numbers` (a dataclass derived from `Episode`), `observed` (names, units and bounds), and
    the methods `begin`, `observe`, `reward` and `ended`. `default_scene` and `default_action` may be replaced.

    The observation is what the task observes, then the state of the action (`action.names_of_state`), as float32. It
    has REP-103 axes, as the topics have. An action out of its bounds is cut to them; one that is not finite, or has
    another shape, raises `gymnasium.error.InvalidAction`, and nothing moves. An episode is truncated after `duration`.
    It is terminated where the task ends, or where the swimmer cannot go on; `info["stopped"]` then says why.

    Args:
        body, scene, accuracy: as of `Simulation`.
        action: a `LawAction` or a `KnotAction`; by default that of the task.
        render_mode: "rgb_array": `render` returns a picture of the present, from above and from the side. "rerun": each
            episode is written to the folder `recordings`, as the visualiser would show it.
        numbers: those of the task, see `Numbers`.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "rerun"], "render_fps": 50}  # noqa: RUF012  as gymnasium's
    name: ClassVar[str] = ""
    Numbers: ClassVar[type[Episode]] = Episode
    observed: ClassVar[tuple[Observed, ...]] = ()

    def __init_subclass__(cls, **keywords):
        super().__init_subclass__(**keywords)
        cls.__doc__ = described_task(cls)

    def __init__(
        self,
        *,
        body: Body | None = None,
        scene: Scene | None = None,
        accuracy="standard",
        action: LawAction | KnotAction | None = None,
        render_mode: str | None = None,
        recordings="recordings",
        **numbers,
    ):
        self.numbers = checked_numbers(self.name, self.Numbers, numbers)
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(not_one_of("render_mode", render_mode, self.metadata["render_modes"]))
        self.render_mode = render_mode
        self.metadata = self.metadata | {"render_fps": round(1.0 / self.numbers.control_period)}
        self.scene = self.default_scene() if scene is None else checked_instance("scene", scene, Scene)
        self.body = checked_body(body)
        if action is not None and not isinstance(action, (LawAction, KnotAction)):
            raise ValueError(f"action must be a LawAction or a KnotAction, got {shown(action)}")
        self.action = self.default_action() if action is None else action
        seen = (*self.observed, *self.action.names_of_state)
        self._bounds = np.array([bound for _, _, bound in seen], dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-self._bounds, self._bounds, dtype=np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (self.action.size,), np.float32)
        self._settings: dict[str, Any] = {"accuracy": Accuracy.of(accuracy), "stations": 51 if render_mode else 2}
        self._recording = EpisodeRecording(recordings, self.name) if render_mode == "rerun" else None
        self._simulation: Any = None  # a Simulation from `reset` on
        self._mean_heading = MeanHeading(max(1, round(self.action.period / self.numbers.control_period)))
        self._trim, self._tick = 0.0, 0
        self.head: Any = None  # a HeadMotion from `reset` on
        self.heading = 0.0

    # -- a task defines these

    def default_scene(self) -> Scene:
        """The scene where none is given: of the motion alone, without internal wrench and energy ledger."""
        return Scene(internal_wrench=False, ledger=False)

    def default_action(self) -> LawAction | KnotAction:
        """The action where none is given."""
        bends = {"left_bend": (-0.5, 0.5)} if self.scene.planar else {"left_bend": (-0.5, 0.5), "up_bend": (-0.5, 0.5)}
        return LawAction(straight(), bends, length=self.body.length)

    def begin(self, options: dict) -> Start:
        """Draw what is new in an episode from `self.np_random`, and return its start. options: those of `reset`."""
        return Start()

    def observe(self) -> list[float]:
        """The numbers of `observed`, from `self.head` and `self.heading`."""
        return []

    def reward(self) -> float:
        """The reward of the control step that has just ended."""
        raise NotImplementedError(f"{type(self).__name__} must define reward")

    def ended(self) -> bool:
        """Whether the episode is over: the task is done, or a limit is exceeded."""
        return False

    def marks(self) -> list[tuple[float, float, float]]:
        """Points [m], in the world, that the pictures show."""
        return []

    # -- Gymnasium's interface

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple[np.ndarray, dict]:
        """Begin an episode; the observation of its start."""
        super().reset(seed=seed)
        self._finish_recording()
        start = self.begin(options or {})
        simulation = Simulation(
            body=self.body,
            scene=self.scene,
            position=turn_vector(start.position),
            orientation=level_orientation(start.heading),
            twist=(-start.roll_rate, 0.0, 0.0, -start.speed, 0.0, 0.0),
            **self._settings,
        )
        self._trim, self._tick = start.left_trim, 0
        self._command(simulation, self.restart(start.own_time))
        self._simulation = simulation
        return self._look(), {}

    def step(self, action) -> tuple[np.ndarray, float, bool, bool, dict]:
        """One control step: observation, reward, terminated, truncated, info."""
        if self._simulation is None:
            raise gymnasium.error.ResetNeeded("the environment must be reset before step")
        values = self._checked(action)
        self._tick += 1
        self._command(self._simulation, self.action.advance(values, self.numbers.control_period))
        try:
            self._simulation.advance(self._tick * self.numbers.control_period)
            observation = self._look()
        except SimulationStopped as stopped:
            self._finish_recording()
            self._simulation = None
            return self._observation(), 0.0, True, False, {"stopped": one_line(stopped)}
        truncated = self._tick * self.numbers.control_period >= self.numbers.duration * (1.0 - 1e-9)
        return observation, float(self.reward()), bool(self.ended()), truncated, {}

    def render(self) -> np.ndarray | None:
        """The picture (400, 800, 3) of the present in the mode rgb_array; None in the mode rerun."""
        if self._simulation is None:
            raise gymnasium.error.ResetNeeded("the environment must be reset before render")
        if self.render_mode != "rgb_array":
            return None
        return picture(self._simulation.observe(wrench=False, load=False), self.body, self.marks())

    def close(self) -> None:
        """End the episode; in the mode rerun, write its recording."""
        self._finish_recording()
        self._simulation = None

    def restart(self, own_time: float = 0.0) -> np.ndarray:
        """Begin the observation and the action anew; the curvature at the start, as of `action.advance`.

        `reset` calls it, and so does a controller of the dynamics node at the start of a run.
        """
        self._mean_heading.clear()
        return self.action.begin(own_time)

    def see(self, head: HeadMotion) -> np.ndarray:
        """Take in the motion of the head at the end of a control step, and return the observation.

        `step` calls it with the simulation's head. A controller of the dynamics node calls it with that of a message.
        """
        self.head, self.heading = head, self._mean_heading.add(head.heading)
        return self._observation()

    def describe(self) -> str:
        """One line for each number of the observation and of the action, with unit and bounds."""
        seen = [*self.observed, *self.action.names_of_state]
        lines = [f"  {name} [{unit or '1'}], {-bound:g} to {bound:g}" for name, unit, bound in seen]
        return "\n".join(
            ["observation:", *lines, "action, each from -1 to 1:", *(f"  {each}" for each in self.action.described())]
        )

    # -- parts of a step

    def _command(self, simulation: Simulation, rows: np.ndarray) -> None:
        if self._trim:
            rows[3] -= self._trim
        time, (k2, k2_1, k2_2, k3, k3_1, k3_2) = self._tick * self.numbers.control_period, rows
        simulation.add_samples(time, self.action.x, k2, k2_1, k2_2, k3, k3_1, k3_2, waves=self.action.waves)

    def _look(self) -> np.ndarray:
        if self._recording is not None:
            self._recording.add(self._simulation.observe(load=False))
        return self.see(head_motion_of(self._simulation.head))

    def _observation(self) -> np.ndarray:
        values = np.array(self.observe() + self.action.state, dtype=np.float32)
        return np.minimum(np.maximum(values, -self._bounds), self._bounds)

    def _checked(self, action) -> np.ndarray:
        try:
            values = np.asarray(action, dtype=float)
        except (TypeError, ValueError):
            values = np.empty(0)
        if values.shape != (self.action.size,) or not all(map(math.isfinite, values.tolist())):
            raise gymnasium.error.InvalidAction(
                f"action must be {self.action.size} finite numbers, got {shown(action)}"
            )
        return np.minimum(np.maximum(values, -1.0), 1.0)

    def _finish_recording(self) -> None:
        if self._recording is not None and self._simulation is not None:
            self._recording.finish(self._simulation)


def described_task(task: type[SwimmerEnv]) -> str:
    """The docstring of a task, with what it observes and its numbers."""
    seen = "\n".join(f"    {each.name} [{each.unit or '1'}], at most {each.bound:g}" for each in task.observed)
    observed = f"Observed, before the state of the action:\n{seen}"
    text = (task.__doc__ or "A task.").rstrip()
    return f"{text}\n\n{observed}\n\nNumbers:\n{described_fields(task.Numbers)}\n"


def checked_numbers(task: str, kind: type[Episode], given: dict) -> Episode:
    """The numbers of a task. `ValueError` names one that there is not, or that does not fit."""
    known = [item.name for item in fields(kind)]
    for name in given:
        if name not in known:
            others = "body, scene, accuracy, action, render_mode, recordings"
            raise ValueError(f"task {shown(task)} has no parameter {shown(name)}, it has: {', '.join(known)}, {others}")
    return kind(**given)
