# SPDX-License-Identifier: Apache-2.0
"""The maps of `eel stability`, beyond the range of any swimmer."""

from typing import Any

import numpy as np
from eel_dynamics.accuracy.accuracy import ORDERS, PRESETS, Accuracy
from eel_dynamics.model.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.swim import AT_REST, Swim
from eel_gaits.laws.law import Law

from eel_gaits import straight
from eel_studies.stability.maps import TARGET, Axis, Cell, Map

LEAST_VISCOSITY = 1e-10  # m^2/s
METHODS = (*(("adams", order) for order in ORDERS["adams"]), ("dormand_prince", 5))
FIXED_RESOLUTION = 36.0  # points per body length with a fixed step: the error in space stays below the target
PERIOD = Axis("period (s)", 0.02, 50.0)
DENSITY = Axis("density of the body, by water's", 1e-3, 1e3)
SLENDERNESS = Axis("slenderness l / (2 max(a, b))", 5.0, 500.0)
ROBOT = Swim(None, Body.boyer2010(), Scene(), Accuracy.of(TARGET))


def sized(low: float, high: float) -> Axis:
    """The amplitude of the wave as an axis."""
    return Axis("amplitude, by the paper's", low, high)


def maps_of(points: int = 13) -> tuple[Map, ...]:
    """The maps, of `points` by `points` runs each. Maps over presets or methods have one row for each of them."""
    rows: list[tuple[Any, ...]] = [
        ("gait", "period and amplitude: 4 periods", PERIOD, sized(1e-12, 4.0),
         lambda period, size: _swim(_wave(period=period, size=size), 4.0 * period)),
        ("wave", "wavelength and amplitude: 4 periods",
         Axis("wavelength (body lengths)", 0.2, 100.0), sized(1e-3, 12.0),
         lambda wavelength, size: _swim(_wave(wavelength=wavelength, size=size), 4.0)),
        ("water", "density and viscosity: 4 periods", DENSITY, Axis("viscosity (m²/s)", 1e-9, 1.0),
         lambda ratio, viscosity: _swim(_wave(), 4.0, scene=Scene(density=1000.0 * ratio, viscosity=viscosity))),
        ("viscosity", "period and viscosity: 4 periods", PERIOD,
         Axis("viscosity (m²/s), the lowest row: 0", LEAST_VISCOSITY, 1.0),
         lambda period, viscosity: _swim(_wave(period=period), 4.0 * period,
                                         scene=Scene(viscosity=viscosity * (viscosity > LEAST_VISCOSITY)))),
        ("velocity", "initial velocity, and spin about three axes: 0.2 s",
         Axis("speed (m/s)", 1e-2, 100.0), Axis("spin (turns/s)", 1e-2, 100.0),
         lambda speed, turns: _swim(_wave(), 0.2, start=AT_REST._replace(
             twist=np.array([*np.full(3, 2.0 * np.pi * turns / np.sqrt(3.0)), speed, 0.0, 0.0])))),
        ("body", "length and slenderness: 4 periods", Axis("length (m)", 0.01, 100.0), SLENDERNESS,
         lambda length, slenderness: _swim(_wave(length=length), 4.0, body=Body.spindle(length, slenderness))),
        ("step", "a fixed step (classical Runge-Kutta): 4 periods", Axis("step (periods)", 1e-2, 1.0), DENSITY,
         lambda step, ratio: _swim(_wave(), 4.0, scene=Scene(density=1000.0 * ratio), accuracy=Accuracy(
             name=f"step {step:.3g}", resolution=FIXED_RESOLUTION, step=step))),
        ("preset", "the presets, each by its own target: 4 periods", PERIOD, _rows("preset", PRESETS),
         lambda period, row: _swim(_wave(period=period), 4.0 * period, list(PRESETS.values())[row],
                                   accuracy=Accuracy.of(list(PRESETS)[row])),
         tuple(PRESETS)),
        ("method", "every adaptive method: 4 periods", Axis("tolerance of a step", 1e-8, 1.0), _rows("method", METHODS),
         lambda tolerance, row: _swim(_wave(), 4.0, accuracy=_method(row, tolerance)),
         tuple(f"{method} {order}" for method, order in METHODS)),
    ]  # fmt: skip
    return tuple(Map(name, title, across, up, points, *at) for name, title, across, up, *at in rows)


def _rows(label: str, names: Any) -> Axis:
    return Axis(label, 1.0, 2.0 ** (len(names) - 1))


def _wave(period: float = 1.0, wavelength: float = 1.0, size: float = 1.0, length: float = 1.0) -> Law:
    """The paper's wave on a body of `length` [m]. period: [s]; wavelength: [body lengths]; size: amplitude ratio."""
    law: Law = straight(
        period=period,
        wavelength=wavelength * length,
        amplitude_0=size / length,
        amplitude_1=0.5 * size / length**2,
        amplitude_2=2.0 * size / length**3,
    )
    return law


def _method(row: int, tolerance: float) -> Accuracy:
    method, order = METHODS[row]
    name = f"{method} {order} {tolerance:.3g}"
    return Accuracy(name=name, resolution=FIXED_RESOLUTION, method=method, order=order, tolerance=tolerance)


def _swim(law: Law, duration: float, target: float = TARGET, **changes: Any) -> Cell:
    return Cell(ROBOT._replace(law=law, **changes), duration, target)
