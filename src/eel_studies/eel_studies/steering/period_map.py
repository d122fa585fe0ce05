# SPDX-License-Identifier: Apache-2.0
"""The map over one period of a gait, from the head's attitude, twist and fin servo angles at its start to those at its
end.

A settled motion repeats after a period, except its position and its heading. Without a righting moment no attitude is
preferred, and only the twist has to repeat. With a righting moment, or with fins that hold the roll, the attitude to
the vertical has to repeat too.
"""

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from eel_common.wording import shown
from eel_dynamics.analysis.averaging_window import common_period
from eel_dynamics.model.fins.fins import Fin, RollHold, checked_fins, servos_of

from eel_dynamics import Accuracy, Body, Scene, simulate, simulate_batch
from eel_gaits import Law

SETTLING = 12  # periods from rest before the search for the settled motion
CLOSE = 1e-9  # rad, and relative to the twist: a settled motion repeats within this
MOST_SEARCHES = 40
SLOW = 0.2  # if a Newton step leaves more of the defect, the derivative is renewed
DIFFERENCE = 1e-5  # rad, and relative to the twist: for the derivative
FARTHEST = 0.3  # likewise, the largest Newton step
UP = np.array([0.0, 0.0, 1.0])


class Motion(NamedTuple):
    """The head at the start or the end of a period. For several swims, arrays are (B, ...)."""

    position: np.ndarray  # (3,) m, world; 0 at the start
    orientation: np.ndarray  # (4,) x y z w, world from head
    twist: np.ndarray  # (6,) rad/s, m/s, head's axes
    servo: np.ndarray  # (S,) rad, angles of the fins' servos, in the order of their states

    @property
    def up(self) -> np.ndarray:
        """(3,) the vertical in the head's axes; (B, 3) for several swims."""
        return np.asarray(rotation(self.orientation).inv().apply(UP))


def rotation(quaternion: np.ndarray) -> Any:
    """The `scipy` rotation of a quaternion (4,), or of several (B, 4)."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(quaternion)


def turned_by(orientation: np.ndarray, by: np.ndarray) -> np.ndarray:
    """The `orientation` (4,) turned in the world by the rotation vectors `by` (B, 3) [rad]: (B, 4)."""
    from scipy.spatial.transform import Rotation

    return np.asarray((Rotation.from_rotvec(by) * rotation(orientation)).as_quat())


class PeriodMap:
    """One period of `law`, after all of its ramps, of a `body` in still water of the `scene`.

    law, period [s]. fins: fixed, commanded (0), or holding the roll. steps: per period. resolution: points along the
    body. `ValueError` for a law that does not repeat, and for a planar scene.

    Attributes:
        servos: (S,), for each servo with a state, the index of its first fin.
        upright: whether the attitude to the vertical matters.
    """

    def __init__(self, law: Law, body: Body, scene: Scene, steps: int, resolution: float, fins: Any = None):
        if scene.planar:
            raise ValueError("scene must not be planar: there is no roll to be linearised in the plane")
        self.fins = checked_fins(fins, body, scene)
        if given := next((fin for fin in self.fins if isinstance(fin.angle, tuple)), None):
            raise ValueError(f"fins must have an angle that stays for a period to repeat, got a table for {given.name}")
        own = [fin.servo for fin in self.fins]
        self.servos = [own.index(servo) for servo in servos_of(self.fins) if self.fins[own.index(servo)].time_constant]
        held = any(isinstance(fin.angle, RollHold) for fin in self.fins)
        self.upright = bool(scene.metacentric_height or scene.weight or held)
        ends = [ramp.end for term in law.terms for ramp in term.envelope]
        settled, longest = max([0.0, *ends]), max((term.period for term in law.terms), default=0.0)
        times = settled + np.linspace(0.0, longest, 65)
        self.period = common_period(law, np.linspace(0.0, body.length, 11), times)
        self._start = math.ceil(settled / self.period - 1e-9)  # periods
        self._whole, self.law, self.body = law, law.delayed(-self._start * self.period), body
        self.scene = replace(scene, current=(0.0, 0.0, 0.0), internal_wrench=False, ledger=False)
        self._accuracy = Accuracy(name="period", resolution=resolution, step=self.period / steps)

    def swim(
        self,
        orientations: np.ndarray,
        twists: np.ndarray,
        servos: np.ndarray | None = None,
        laws: list[Law] | None = None,
    ) -> Motion:
        """The ends (B, ...) of a period that begins with `orientations` (B, 4), `twists` (B, 6) and `servos` (B, S).
        laws: (B,), instead of the gait's. `SimulationStopped` if a swim cannot go on."""
        angles = np.zeros((len(np.atleast_2d(twists)), len(self.servos))) if servos is None else np.atleast_2d(servos)
        batch = simulate_batch(
            self.law if laws is None else laws,
            self.period,
            bodies=self.body,
            scenes=self.scene,
            accuracy=self._accuracy,
            sample_period=self.period,
            orientations=orientations,
            twists=twists,
            estimate=False,
            fins=[self._fins_at(each) for each in angles],
        )
        for error in batch.error:
            if error is not None:
                raise error
        ends = batch.position[:, -1], batch.orientation[:, -1], batch.twist[:, -1]
        return Motion(*ends, angles if batch.fin_angle is None else self._servos_at(batch.fin_angle[:, -1]))

    def _fins_at(self, angles: np.ndarray) -> list[Fin]:
        """The fins with servos at these `angles` (S,)."""
        at = {self.fins[first].servo: float(angle) for first, angle in zip(self.servos, angles, strict=True)}
        return [replace(fin, initial_angle=at[fin.servo]) if fin.servo in at else fin for fin in self.fins]

    def _servos_at(self, angles: np.ndarray) -> np.ndarray:
        """Angles (..., S) of the servos from the angles (..., F) of the fins."""
        return angles[..., self.servos] * [self.fins[first].sign for first in self.servos]

    def settled(self) -> tuple[Motion, Motion, float]:
        """Start and end of a period of the settled motion, and its distance from repeating (as `CLOSE`).

        It swims towards +x in the world, like the straight body. `ValueError` if none is found.
        """
        start, slope, before = self._guess(), None, np.inf
        for _ in range(MOST_SEARCHES):
            end = Motion(*(row[0] for row in self.swim(*start[1:])))
            defect = self._defect(start, end)
            size = float(np.abs(defect).max())
            if size < CLOSE:
                return *self._on_course(start, end), size
            if slope is None or size > SLOW * before:
                slope = self._slope(start)
            before = size
            change = np.linalg.lstsq(slope, -defect)[0]  # a step of Newton's method
            start = self._moved(start, change / max(1.0, np.abs(change).max() / FARTHEST))
        raise ValueError(
            f"law {shown(self.law.name)} leads to no settled motion: after {MOST_SEARCHES} searches a period still "
            f"ends {size:.1g} from where it began (rad, and relative to the twist)"
        )

    def _guess(self) -> Motion:
        """The head after some periods from rest; in the plane if the law bends only there."""
        scene = replace(self.scene, planar=self._whole.in_plane and not (self.fins or self.scene.weight))
        periods = self._start + SETTLING
        how: dict[str, Any] = {"accuracy": 1e-3, "stations": 2, "estimate": False}
        run = simulate(self._whole, periods * self.period, scene=scene, body=self.body, fins=self.fins, **how)
        servo = np.zeros(0) if run.fin_angle is None else self._servos_at(run.fin_angle[-1])
        return Motion(np.zeros(3), run.orientation[-1], run.twist[-1], servo)

    def _scale(self, start: Motion) -> np.ndarray:
        """(6,) scale of the twist: its size, with rotations divided by the body's length."""
        length = self.body.length
        size = np.linalg.norm(start.twist * np.repeat((length, 1.0), 3)) + 1e-6 * length / self.period
        return np.repeat((size / length, size), 3)

    def _defect(self, start: Motion, end: Motion) -> np.ndarray:
        """The defect of repetition: twist (6,) by its size, servos (S,), and if `upright` the vertical (3,)."""
        twist = (end.twist - start.twist) / self._scale(start)
        return np.concatenate([twist, end.servo - start.servo, *([end.up - start.up] if self.upright else [])])

    def _moved(self, start: Motion, change: np.ndarray) -> Motion:
        """The start with changes of the twist, relative to its size, of the servos, and if `upright` of the lean."""
        servos = 6 + len(self.servos)
        lean = np.append(change[servos:], np.zeros(3 + servos - len(change)))
        twist = start.twist + self._scale(start) * change[:6]
        turned = turned_by(start.orientation, lean[None])[0]
        return Motion(start.position, turned, twist, start.servo + change[6:servos])

    def _slope(self, start: Motion) -> np.ndarray:
        """The derivative of the defect with respect to those changes, by central differences."""
        changes = DIFFERENCE * np.eye(6 + len(self.servos) + 2 * self.upright)
        both = [self._moved(start, sign * change) for sign in (1.0, -1.0) for change in changes]
        _, orientations, twists, servos = map(np.array, zip(*both, strict=True))
        ends = self.swim(orientations, twists, servos)
        pairs = zip(both, map(Motion, *ends), strict=True)
        above, below = np.split(np.array([self._defect(first, last) for first, last in pairs]), 2)
        return np.asarray(((above - below) / (2.0 * DIFFERENCE)).T)

    def _on_course(self, start: Motion, end: Motion) -> tuple[Motion, Motion]:
        """Both motions, turned about the vertical so that the path of the period points to +x."""
        way = end.position[:2]
        if np.linalg.norm(way) < 1e-3 * self.body.length:  # without a path, the head points there
            way = rotation(start.orientation).apply([1.0, 0.0, 0.0])[:2]
        about = np.array([[0.0, 0.0, -math.atan2(way[1], way[0])]])
        turn = rotation(turned_by(np.array([0.0, 0.0, 0.0, 1.0]), about)[0])
        first, last = (
            Motion(turn.apply(each.position), turned_by(each.orientation, about)[0], each.twist, each.servo)
            for each in (start, end)
        )
        return first, last
