# SPDX-License-Identifier: Apache-2.0
"""Linearisation of a swim over one period of its gait: `periodic_linearisation`.

    found = periodic_linearisation(straight(), scene=Scene(metacentric_height=0.01))
    found.multipliers            # (n,) eigenvalues: growth factors of the modes per period
    found.growth                 # the greatest magnitude, without neutral modes (no heading is preferred)
    found.controllability()      # (n,) per mode, by bends in yaw and pitch; 0: no bend moves it

The matrices are central differences of swims over one period, about the settled motion.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from eel_common.quantity import checked_instance, checked_row, number, positive
from eel_common.wording import not_one_of, shown
from eel_dynamics.model.body.body import Body, checked_body
from eel_dynamics.model.scene import checked_scene
from eel_gaits.laws.steered_law import BENDS

from eel_dynamics import Fin, Scene
from eel_gaits import Law, Ramp, Term
from eel_studies.steering.period_map import Motion, PeriodMap, rotation, turned_by

STATES = ("roll", "pitch", "heading", "roll_rate", "pitch_rate", "yaw_rate", "surge", "sway", "heave")
OUT_OF_PLANE = ("roll", "pitch", "roll_rate", "pitch_rate", "heave")
PHASES = {"": (0.0, np.pi / 2), "_cos": (1.0, np.pi / 2), "_sin": (1.0, np.pi)}  # whether it beats (1), and its phase
BENT = {bend + beat: (axis, *wave) for bend, axis in BENDS.items() for beat, wave in PHASES.items()}
INPUTS = tuple(BENT)
STEP = 1e-5  # rad; a twist's is scaled, a bend's is divided by the body's length
STEPS, RESOLUTION = 160, 40.0  # steps per period, points along the body
COARSER = 0.7  # factor for the steps and points of the companion, which gives the error


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicLinearisation:
    """The effect of small changes of the head's motion at the start of a period, and of small bends, at its end.

    States: roll, pitch, heading [rad], a turn of the head about the axes of the course: x along the path of the period,
    z up. roll_rate ... heave: the twist (Omega, V) [rad/s, m/s] in the head's axes. Position is left out, as nothing
    depends on it. Inputs [rad/m]: bends, uniform along the body, added to the gait. They rise and fall within the
    period with the ramp f_r of eq. (64). "left_bend" is constant in between, positive to the left; "left_bend_cos" and
    "left_bend_sin" beat with the gait. "up_bend", "up_bend_cos" and "up_bend_sin" bend upwards. The angles of fins'
    servos are further states, n in all: `states` names them.
    """

    law: Law  #: t = 0 is the start of a period after all ramps
    body: Body
    scene: Scene
    period: float  #: s
    start: Motion  #: the settled motion at the start of a period; it swims towards +x
    end: Motion
    defect: float  #: rad, and relative to the twist: distance from an exact repetition
    rise: float  #: part of the period in which a bend rises, and in which it falls
    monodromy: np.ndarray  #: (n, n) d(states at the end) / d(states at the start)
    input_matrix: np.ndarray  #: (n, 6) d(states at the end) / d(inputs)
    error: float  #: greatest change of a multiplier with coarser settings; NaN without an estimate
    fins: tuple[Fin, ...] = ()
    upright: bool = False  #: whether the attitude matters: there is weight, or fins hold the roll
    servos: tuple[int, ...] = ()  #: for each servo with a state, the index of its first fin

    def __repr__(self) -> str:
        return f"PeriodicLinearisation({shown(self.law.name)}, {self.scene!r}, growth {self.growth:.4g} a period)"

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states."""
        return *STATES, *(f"fin {self.fins[first].name}" for first in self.servos)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the inputs."""
        return INPUTS

    @cached_property
    def _eigen(self) -> tuple[np.ndarray, np.ndarray]:
        values, vectors = np.linalg.eig(self.monodromy)
        order = np.argsort(-np.abs(values), kind="stable")
        return values[order], vectors[:, order]

    @property
    def multipliers(self) -> np.ndarray:
        """(n,) complex: eigenvalues of the monodromy matrix, the greatest first."""
        return self._eigen[0]

    @property
    def modes(self) -> np.ndarray:
        """(n, n) complex: the motion of each multiplier in a column."""
        return self._eigen[1]

    @cached_property
    def participation(self) -> np.ndarray:
        """(n, n) share of each state (row) in each mode (column); magnitudes add up to 1.

        It is the left times the right eigenvector, entry by entry, so it does not depend on units.
        """
        share = np.abs(np.linalg.inv(self.modes).T * self.modes)
        return np.asarray(share / share.sum(axis=0))

    def motion_of(self, mode: int) -> str:
        """The states with a share of a tenth or more in a `mode`, the greatest first."""
        share = self.participation[:, mode]
        return ", ".join(self.states[k] for k in np.argsort(-share) if share[k] >= 0.1)

    @cached_property
    def neutral(self) -> np.ndarray:
        """(n,) bool: modes of magnitude 1, as no heading is preferred, and unless `upright` no attitude."""
        free = [STATES.index("heading")] if self.upright else [0, 1, 2]
        return np.asarray(self.participation[free].sum(axis=0) > 0.5)

    @property
    def growth(self) -> float:
        """The greatest growth factor of a disturbance per period, without the neutral modes."""
        return float(np.abs(self.multipliers[~self.neutral]).max())

    def controllability(self, inputs: tuple[str, ...] = INPUTS) -> np.ndarray:
        """(n,) how strongly the `inputs` control each mode; 0: none of these bends moves it, with any controller.

        The least singular value of [A - multiplier, B] (Popov, Belevitch and Hautus), with time in periods and length
        in body lengths, so that a bend is the angle [rad] between head and tail. `ValueError` for an unknown input.
        """
        if unknown := [name for name in inputs if name not in INPUTS]:
            raise ValueError(not_one_of("inputs", unknown[0], INPUTS))
        columns = [INPUTS.index(name) for name in inputs]
        scale, length = self._scale, self.body.length
        a = self.monodromy * scale[:, None] / scale
        b = self.input_matrix[:, columns] * scale[:, None] / length
        one = np.eye(len(a))
        return np.array(
            [np.linalg.svd(np.hstack([a - each * one, b]), compute_uv=False)[-1] for each in self.multipliers]
        )

    def kick(self, mode: int, state: str = "roll") -> np.ndarray:
        """(6,) complex: the amplitude of a `mode` in its `state` after one period with an input of 1 rad/m."""
        left, row = np.linalg.inv(self.modes)[mode], STATES.index(state)
        pair = 1.0 if abs(self.multipliers[mode].imag) < 1e-9 else 2.0  # a mode and its conjugate
        return np.asarray(pair * (left @ self.input_matrix) * self.modes[row, mode])

    def feedback(self, bend: float = 1.0) -> np.ndarray:
        """(6, n) gain of the linear-quadratic regulator: inputs [rad/m] = - gain @ states, once per period.

        States are weighted with time in periods and length in body lengths. An input of `bend` [rad/m] has the weight
        of a state of 1. `ValueError` if the inputs cannot control a growing mode.
        """
        from scipy.linalg import solve_discrete_are

        bend = positive("bend", bend, "rad/m")
        a, b, cost = self.monodromy, self.input_matrix, np.eye(len(INPUTS)) / bend**2
        try:
            ahead = solve_discrete_are(a, b, np.diag(self._scale**2), cost)
        except np.linalg.LinAlgError as error:
            weakest = self.motion_of(int(np.argmin(self.controllability())))
            raise ValueError(f"no feedback of these bends is stable, {weakest} is held least ({error})") from None
        return np.asarray(np.linalg.solve(cost + b.T @ ahead @ b, b.T @ ahead @ a))

    def bent(self, inputs: Any) -> Law:
        """The gait with `inputs` (6,) [rad/m] in its first period; t = 0 is the start of that period."""
        sizes = checked_row("inputs", inputs, len(INPUTS))
        pairs = zip(INPUTS, sizes, strict=True)
        return _plus(self.law, *(_bend(name, size, self.period, self.rise) for name, size in pairs if size))

    @property
    def _scale(self) -> np.ndarray:
        length = self.body.length
        return np.append(np.repeat((1.0, self.period, self.period / length), 3), np.ones(len(self.servos)))


def periodic_linearisation(
    law: Law,
    *,
    body: Body | None = None,
    scene: Scene | None = None,
    rise: float = 0.25,
    steps: int = STEPS,
    resolution: float = RESOLUTION,
    estimate: bool = True,
    fins: Any = None,
) -> PeriodicLinearisation:
    """Linearise the settled swim of `law` over one period of the gait, after all of its ramps.

    A law may have several settled motions. The result is the one that a swim from rest approaches after some periods. A
    law with yaw only swims in the plane.

    body, scene, fins: as in `simulate`; a current is left out, as it carries everything alike, and no fin may follow a
    table. rise: part of the period in which a bend rises, and in which it falls, up to a half. steps: per period.
    resolution: points along the body. estimate: repeat with coarser settings, for the error. The matrices are central
    differences. `ValueError` names a bad argument, a law that does not repeat, or one whose motion does not settle.
    """
    checked_instance("law", law, Law)
    body = checked_body(body)
    scene = checked_scene(scene)
    if isinstance(steps, bool) or not isinstance(steps, (int, np.integer)) or steps < 20:
        raise ValueError(f"steps must be a whole number of 20 or more, got {shown(steps)}")
    rise = number("rise", rise)
    if not 0.0 < rise <= 0.5:
        raise ValueError(f"rise must be > 0 and at most 0.5 of the period, got {rise:g}")
    found = _linearised(PeriodMap(law, body, scene, steps, resolution, fins), scene, rise)
    if not estimate:
        return found
    coarser = PeriodMap(law, body, scene, round(COARSER * steps), COARSER * resolution, fins)
    other = _linearised(coarser, scene, rise)
    apart = np.abs(found.multipliers[:, None] - other.multipliers).min(axis=1)  # distance from the nearest
    return replace(found, error=float(apart.max()))


def _linearised(one: PeriodMap, scene: Scene, rise: float) -> PeriodicLinearisation:
    start, end, defect = one.settled()
    length, count = one.body.length, len(STATES) + len(one.servos)
    steps = STEP * np.append(np.repeat((1.0, 1.0 / one.period, length / one.period), 3), np.ones(len(one.servos)))
    bends = [_bend(name, STEP / length, one.period, rise) for name in INPUTS]

    def differences(changes: np.ndarray, above: list[Law], below: list[Law]) -> np.ndarray:
        both = np.concatenate([changes, -changes])
        turned = turned_by(start.orientation, both[:, :3])
        moved = one.swim(turned, start.twist + both[:, 3:9], start.servo + both[:, 9:], above + below)
        first, second = np.split(states_after(start, end, moved), 2)
        return np.asarray((first - second).T / 2.0)

    straight_on = [one.law] * count
    monodromy = differences(np.diag(steps), straight_on, straight_on) / steps
    more, less = ([_plus(one.law, term.scaled(sign)) for term in bends] for sign in (1.0, -1.0))
    inputs = differences(np.zeros((len(INPUTS), count)), more, less) / (STEP / length)
    settled = one.period, start, end, defect, rise
    of_fins = one.fins, one.upright, tuple(one.servos)
    return PeriodicLinearisation(one.law, one.body, scene, *settled, monodromy, inputs, np.nan, *of_fins)


def states_after(start: Motion, end: Motion, moved: Motion) -> np.ndarray:
    """(B, n) states of the motions `moved` at the end of a period, relative to the settled motion from `start` to
    `end`.

    The course turns with the settled motion.
    """
    settled = rotation(end.orientation)
    course = settled * rotation(start.orientation).inv()
    turn = course.inv().apply((rotation(moved.orientation) * settled.inv()).as_rotvec())
    return np.hstack([turn, moved.twist - end.twist, moved.servo - end.servo])


def _bend(name: str, size: float, period: float, rise: float) -> Term:
    """The input `name` of `size` [rad/m] during the first period."""
    axis, beats, phase = BENT[name]
    ramps = Ramp(0.0, rise * period, 1.0), Ramp((1.0 - rise) * period, period, -1.0)
    return Term(axis=axis, amplitude=(-size,), period=beats * period, phase=phase, envelope=ramps)


def _plus(law: Law, *terms: Term) -> Law:
    return Law(*law.terms, *terms, name=law.name)
