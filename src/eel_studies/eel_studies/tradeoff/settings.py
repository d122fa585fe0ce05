# SPDX-License-Identifier: Apache-2.0
"""The settings of the trade-off: points along the body, method and steps in time."""

from dataclasses import replace
from typing import Any

from eel_dynamics.accuracy.accuracy import PRESETS, Accuracy
from eel_dynamics.runs.swim import Swim

RESOLUTIONS = (6.0, 8.0, 11.0, 16.0, 24.0, 36.0, 60.0, 110.0)  # points per body length
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10)  # relative error per adaptive step
STEPS = (0.1, 0.05, 0.02, 0.01, 0.005)  # s, of the classical method
ADAMS_ORDERS = (3, 4, 5, 6)
COARSE_POINTS, COARSE_TOLERANCE = 24.0, 1e-5  # at most and at least, for settings without kinks
ASKED_FOR = {name: name for name in PRESETS} | {f"target {text}": text for text in ("1e-3", "1e-5", "1e-7")}
REFERENCE = Accuracy(name="reference run", resolution=240.0, tolerance=1e-12)
METHODS = {  # name in `Accuracy`: in words; of a robot the last two
    "adams": "Adams-Bashforth, adaptive steps",
    "dormand_prince": "Dormand-Prince, adaptive steps",
    "classical": "Runge-Kutta, fixed steps",
    "dormand_prince of robots": "Rosenbrock, adaptive steps",
    "classical of robots": "Rosenbrock, fixed steps",
}


def settings(swim: Swim, quick: bool = False) -> list[Accuracy]:
    """Every combination of points and steps, and what is `ASKED_FOR`, as it applies to `swim`.

    quick: every third value of points and of steps only.
    """
    every, scene = 3 if quick else 1, swim.scene
    orders = ADAMS_ORDERS if swim.robot is None else ()  # a robot has one method
    rows = []
    for resolution in RESOLUTIONS[::every]:
        nodes = f"{resolution:g} points"
        for tolerance in TOLERANCES[::every]:
            common: dict[str, Any] = {"resolution": resolution, "tolerance": tolerance}
            rows.append(Accuracy(name=f"{nodes}, tolerance {tolerance:g}", **common))
            for order in orders[::every]:
                name = f"{nodes}, tolerance {tolerance:g}, Adams {order}"
                rows.append(Accuracy(name=name, method="adams", order=order, **common))
                if resolution <= COARSE_POINTS and tolerance >= COARSE_TOLERANCE and scene.resistive:
                    rows.append(replace(rows[-1], name=f"{name}, no kinks", kinks="none"))
        for step in STEPS[::every]:
            rows.append(Accuracy(name=f"{nodes}, step {step:g} s", resolution=resolution, step=step))
    # They lose their target: every run then takes these settings as they are.
    asked = [replace(Accuracy.of(text).in_scene(scene), name=name) for name, text in ASKED_FOR.items()]
    return rows + [each.as_it_is() for each in asked]
