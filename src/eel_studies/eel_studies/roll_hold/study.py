# SPDX-License-Identifier: Apache-2.0
"""Fins that hold the roll: the range of their numbers, from the swim linearised over a period of its gait.

    window = roll_window(Swim(straight(), body, scene, 1e-3, fins=Fin.pair(...)), {"fins.area": (2e-4, 4e-3),
                                                                                  "fins.k_p": (0.5, 8.0)})
    window.growth               # (9, 9) growth of a disturbance per period; below 1: roll is held
    window.best                 # {"fins.area": ..., "fins.k_p": ...} with the fastest decay

No heading is preferred, so the multiplier of the heading, 1, is left out.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_common.attitude import roll

from eel_dynamics import Accuracy, Fin, RollHold, Swim
from eel_gaits import Law
from eel_studies.points import law_of_terms
from eel_studies.stability.maps import Axis, Map
from eel_studies.steering.linearisation import PeriodicLinearisation, periodic_linearisation
from eel_studies.varied import labelled

STEPS, RESOLUTION = 80, 26.0  # settings of a map's marches: multipliers are right to 1e-3
PAIR = "pair station=0.5 area=0.0015 aspect_ratio=2.5 k_p=4 k_d=0.5 time_constant=0.05"  # holds the paper's robot


@dataclass(frozen=True)
class RollWindow:
    """The greatest growth (len(y), len(x)) per period over two numbers of a swim; NaN without a settled motion."""

    map: Map
    growth: np.ndarray

    @property
    def held(self) -> np.ndarray:
        """(len(y), len(x)) bool: whether every disturbance decays."""
        return np.asarray(self.growth < 1.0)

    @property
    def best(self) -> dict[str, float]:
        """The two numbers, by name, with the fastest decay."""
        row, column = np.unravel_index(np.nanargmin(self.growth), self.growth.shape)
        return {self.map.across.name: float(self.map.x[column]), self.map.up.name: float(self.map.y[row])}


def linearised(swim: Swim, **how: Any) -> PeriodicLinearisation:
    """The linearisation of a `swim` with fins. how: further arguments of `periodic_linearisation`."""
    law = law_of_terms(swim.law)
    return periodic_linearisation(law, body=swim.body, scene=swim.scene, fins=swim.fins, **how)


def roll_window(
    swim: Swim, over: Mapping[str, tuple[float, float]], points: int = 9, title: str | None = None
) -> RollWindow:
    """The window of a `swim` over two of its numbers, each from its least to its greatest value, in geometric sequence.

    over: names of `varied`, such as "fins.area", "fins.k_p", "fins.k_d", "fins.time_constant". `ValueError` if no fins
    hold the roll, or unless there are two numbers.
    """
    if not any(isinstance(fin.angle, RollHold) for fin in swim.fins):
        raise ValueError(f"fins must hold the roll (k_p, k_d) in a window of it, got {len(swim.fins)} fins that do not")
    if len(over) != 2:
        raise ValueError(f"over must be two numbers of the swim, got {len(over)}")
    across, up = (Axis(labelled(name), name, *bounds) for name, bounds in over.items())
    item = Map("roll_hold", title or f"{swim.law.name}: growth in a period", across, up, points, swim)
    return RollWindow(item, item.values(_growth))


def _growth(swim_of: Callable[[], Swim]) -> float:
    try:
        return linearised(swim_of(), steps=STEPS, resolution=RESOLUTION, estimate=False).growth
    except ValueError as error:
        if "no settled motion" not in str(error):
            raise
        return math.nan


def holding(area: float, k_p: float) -> tuple[Fin, ...]:
    """A pair ahead of the middle, at X = 0.2 m: `area` [m^2] per fin, k_d = 0.15 s, servos of 0.05 s."""
    return Fin.pair(0.2, area, 2.5, angle=RollHold(k_p, 0.15), time_constant=0.05)


def swum(law: Law, duration: float, fins: tuple[Fin, ...], push: float = 0.0) -> tuple[float, float, float]:
    """Greatest roll [rad], range of the depth [m] and greatest drift sideways [m] of the paper's robot."""
    swim = Swim(law, accuracy=Accuracy.of(1e-3), fins=fins, duration=duration, sample_period=0.05, estimate=False)
    run = swim.run(twist=(push, 0.0, 0.0, 0.0, 0.0, 0.0))
    rolled = np.unwrap([roll(each) for each in run.orientation])
    return float(np.abs(rolled).max()), float(np.ptp(run.position[:, 2])), float(np.abs(run.center_of_mass[:, 1]).max())
