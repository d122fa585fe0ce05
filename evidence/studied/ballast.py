# SPDX-License-Identifier: Apache-2.0
"""What the page of steering tells: multipliers over the metacentric height, the height that steadies a gait, the sway
of long swims, and how a controller that acts once a period brings a leaning swimmer back."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from eel_dynamics.model.section_data import GRAVITY, sections_of
from eel_studies.steering.linearisation import (
    RESOLUTION,
    STATES,
    STEPS,
    PeriodicLinearisation,
    periodic_linearisation,
    states_after,
)
from eel_studies.steering.period_map import PeriodMap, rotation, turned_by

from eel_dynamics import Body, Scene, simulate
from eel_gaits import Law, straight, turning

HIGHEST = 0.05  # m, half of the robot's greatest height: no ballast hangs lower
HALF = {"amplitude_0": 0.5, "amplitude_1": 0.25, "amplitude_2": 1.0}
GAITS = {  # name: a law of the paper's robot
    "straight, 1 Hz": straight(),
    "straight, 0.5 Hz": straight(period=2.0),
    "straight, 1 Hz, half the amplitude": straight(**HALF),
    "straight, 0.5 Hz, half the amplitude": straight(period=2.0, **HALF),
    "turning, 1 Hz": turning(),
}
BISECTIONS = 7
SWIM = 60  # periods of a long swim
SEEN = 10  # of its last ones
PUSH = np.radians(1.0)  # rad of roll, from which it begins
CONTROLLED = 12  # periods


@dataclass(frozen=True)
class Scan:
    """The linearisations of a gait over the metacentric heights (n,) [m]."""

    name: str
    law: Law
    heights: np.ndarray
    found: list[PeriodicLinearisation]

    @staticmethod
    def of(name: str, law: Law, points: int) -> "Scan":
        """Those of `law` at `points` heights from 0 to `HIGHEST`."""
        heights = np.linspace(0.0, HIGHEST, points)
        return Scan(name, law, heights, [linearised(law, height) for height in heights])

    @cached_property
    def growth(self) -> np.ndarray:
        """(n,) the greatest factor by which a disturbance grows in a period."""
        return np.array([each.growth for each in self.found])

    @cached_property
    def steady_from(self) -> float | None:
        """The least height [m] above which no disturbance grows; None where there is none up to `HIGHEST`."""
        growing = np.flatnonzero(self.growth > 1.0)
        if not len(growing):
            return 0.0
        if growing[-1] == len(self.heights) - 1:
            return None
        low, high = self.heights[growing[-1]], self.heights[growing[-1] + 1]
        for _ in range(BISECTIONS):
            middle = (low + high) / 2.0
            low, high = (middle, high) if linearised(self.law, middle).growth > 1.0 else (low, middle)
        return float(high)


def linearised(law: Law, height: float, *, estimate: bool = False) -> PeriodicLinearisation:
    """The linearisation of `law` at a metacentric `height` [m]."""
    return periodic_linearisation(law, scene=Scene(metacentric_height=height), estimate=estimate)


def sway(found: PeriodicLinearisation) -> float:
    """The greatest angle [rad] between the head's axis 3 and up in the last periods of a long swim, which begins with
    the settled motion and a little roll."""
    scene = replace(found.scene, internal_wrench=False, ledger=False)
    turned = turned_by(found.start.orientation, np.array([[PUSH, 0.0, 0.0]]))[0]
    run = simulate(
        found.law, SWIM * found.period, body=found.body, scene=scene, orientation=turned, twist=found.start.twist,
        accuracy=1e-4, sample_period=found.period / 16, stations=2, estimate=False,
    )  # fmt: skip
    last = run.orientation[-16 * SEEN :]
    return float(np.arccos(np.clip(rotation(last).apply([0.0, 0.0, 1.0])[:, 2], -1.0, 1.0)).max())


def recovery(found: PeriodicLinearisation, lean: float, bend: float) -> tuple[np.ndarray, float]:
    """Roll (n,) [rad] at the end of each period under the feedback, in the model itself, from a roll of `lean` [rad];
    and the greatest bend [rad/m] that it takes.

    bend: as in `PeriodicLinearisation.feedback`.
    """
    one = PeriodMap(found.law, found.body, found.scene, STEPS, RESOLUTION)
    gain, state, roll, greatest = found.feedback(bend), np.zeros(len(STATES)), [], 0.0
    state[0] = lean
    for _ in range(CONTROLLED):
        inputs = -gain @ state
        greatest = max(greatest, float(np.abs(inputs).max()))
        start = turned_by(found.start.orientation, state[None, :3]), (found.start.twist + state[3:])[None]
        state = states_after(found.start, found.end, one.swim(*start, laws=[found.bent(inputs)]))[0]
        roll.append(state[0])
    return np.array(roll), greatest


def radius_of_gyration(body: Body) -> float:
    """That of the straight `body` and its water in roll [m]."""
    x = body.length * np.linspace(0.0, 1.0, 2001) ** 2  # dense at the nose
    sections = sections_of(body, Scene(), x)
    return float(np.sqrt(np.trapezoid(sections.inertia1, x) / np.trapezoid(sections.mass, x)))


def sideways_acceleration(law: Law) -> tuple[float, float]:
    """The greatest sideways acceleration over g, of the centre of mass and of the tail, in the plane.

    It is to the roll that a low mass would bring, and that the model leaves out, what the lean [rad] is to the righting
    moment.
    """
    period = max(term.period for term in law.terms)
    run = simulate(law, 8 * period, body=Body.boyer2010(), scene=Scene(planar=True), sample_period=period / 64)
    last = slice(-65, None)
    found = []
    for path in (run.center_of_mass[last], run.backbone[last, -1]):
        way = path[-1, :2] - path[0, :2]
        across = path[:, :2] @ np.array([-way[1], way[0]]) / np.linalg.norm(way)
        found.append(float(np.abs(np.diff(across, 2)).max()) * (64 / period) ** 2 / GRAVITY)
    centre, tail = found
    return centre, tail
