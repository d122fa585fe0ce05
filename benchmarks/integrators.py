# SPDX-License-Identifier: Apache-2.0
"""The library's methods of integration, measured: evaluations of the head's dynamics for an error of its position, in
10 s of the falling gait with laminar friction. The report of 2026-11-24 has 23 other methods.
"""

import contextlib
from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np
from measuring import MOTION, Lines

from eel_dynamics import Accuracy, Scene, SimulationStopped, simulate
from eel_gaits import falling

DURATION, RESOLUTION = 10.0, 30.0
TARGETS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
STEPS = (3, 4, 5, 6, 8, 10, 13, 16, 20, 25, 32, 40, 50, 64, 80, 100, 130, 160, 220, 320)  # per second
EXACT = Accuracy(name="exact", resolution=60.0, tolerance=1e-13)


def _fewest(points: Iterable[tuple[float, int]], target: float) -> str:
    """Fewest evaluations among (error, evaluations) from which on the error stays below `target`."""
    good = None
    for error, count in sorted(points, key=lambda point: -point[1]):
        if not error <= target:
            break
        good = count
    return f"{good:7d}" if good else "      -"


def integrators() -> Lines:
    """Evaluations for an error of the head's position after 10 s of falling, laminar friction, by the method."""
    swim = partial(simulate, falling(), DURATION, scene=Scene(friction="laminar", **MOTION), estimate=False)
    exact = swim(accuracy=EXACT, sample_period=0.1)
    yield "method" + " " * 36 + "".join(f"{target:8.0e}" for target in TARGETS), None, ""

    def row(name: str, settings: Iterable[Accuracy]) -> tuple[str, None, str]:
        points = []
        for accuracy in settings:
            with contextlib.suppress(SimulationStopped):  # at a step that is too long
                run = swim(accuracy=accuracy, sample_period=DURATION)
                apart = float(np.linalg.norm(run.position[-1] - exact.position[-1]))
                points.append((apart / exact.path_length, run.evaluations))
        return f"{name:42s}" + "".join(" " + _fewest(points, target) for target in TARGETS), None, ""

    study: dict[str, Any] = {"name": "study", "resolution": RESOLUTION}
    yield row("Runge-Kutta 4, classical", (Accuracy(step=1.0 / each, **study) for each in STEPS))
    for method, order in (*(("adams", order) for order in (3, 4, 5, 6)), ("dormand_prince", 5)):
        how = study | {"method": method, "order": order}
        yield row(f"adaptive: {method} {order}", (Accuracy(tolerance=each, **how) for each in np.logspace(-3, -10, 22)))
