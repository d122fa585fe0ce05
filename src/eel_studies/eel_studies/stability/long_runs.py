# SPDX-License-Identifier: Apache-2.0
"""Long runs: drift over decades of periods, and growth out of the plane of a planar swim.

The ledger's works are integrated along with the motion, and only samples are kept, so memory does not grow with time.
Out of the plane a disturbance grows by a multiplier of the settled swim (`periodic_linearisation`). That is a property
of the model: it depends on no accuracy.
"""

from typing import Any

import numpy as np
from eel_common.files.markdown import table

from eel_dynamics import Accuracy, Body, Scene, Simulation
from eel_gaits import helix, straight
from eel_studies.steering.linearisation import periodic_linearisation

PERIOD = 0.7  # s, its multiples are not exact in binary
DECADES, COMPARED = 5, 3  # decades of periods: of a run, and of the finer run for comparison
ACCURACY = "draft"
FIGURES = {  # of `drift_of`, all relative: in words
    "ledger": "ledger's residual, by the work",
    "norm": "norm of the quaternion, less 1",
    "phase": "curvature after whole periods, by the first",
    "beat": "velocity after whole periods, by the hundredth",
    "path": "place, by a finer run",
}
SWIMMERS: dict[str, dict[str, Any]] = {  # arguments of `Simulation`
    "straight, planar": {"law": straight(period=PERIOD), "scene": Scene(planar=True, internal_wrench=False)},
    "helix": {"law": helix(period=PERIOD), "scene": Scene(internal_wrench=False)},
}
ROBOT = Body.boyer2010()
SHAPE: dict[str, Any] = {"length": 1.0, "kinks": ROBOT.kinks, "half_width": ROBOT.half_height}
VARIANTS: dict[str, dict[str, Any]] = {  # arguments of `periodic_linearisation`
    "the paper's robot": {},
    "the same, with coarser settings": {"steps": 60, "resolution": 20.0},
    "without drag": {"scene": Scene(resistive=False)},
    "without wake": {"scene": Scene(wake=False)},
    "without inertia of the water": {"scene": Scene(reactive=False)},
    "sections round": {"body": Body(half_height=ROBOT.half_height, **SHAPE)},
    "sections wider than high": {"body": Body(half_height=ROBOT.half_width, **SHAPE)},
}


def drift_of(swimmer: dict[str, Any], decades: int = DECADES, compared: int = COMPARED) -> dict[str, np.ndarray]:
    """The `FIGURES` of a `swimmer` after 1, 10, ... 10^`decades` periods; "path" for at most 10^`compared`.

    NaN without a run for comparison. `SimulationStopped` if a run cannot go on.
    """
    times = PERIOD * np.concatenate(([0.0], 10.0 ** np.arange(decades + 1)))
    accuracy = Accuracy.of(ACCURACY).in_scene(swimmer["scene"])
    one, out, works = _recorded(times, accuracy=accuracy, **swimmer)
    _, finer, _ = _recorded(times[: compared + 2], accuracy=one.accuracy.tightened(0.1), **swimmer)
    residual = out.energies.sum(axis=1) - one.energy_at_start - works.sum(axis=1)
    bend, speed = out.curvature[1:], out.twist[1:, 3:]
    beat, path = np.full((2, decades + 1), np.nan)
    beat[2:] = np.linalg.norm(speed[2:] - speed[2], axis=1) / np.linalg.norm(speed[2])
    apart = np.linalg.norm(out.position[: compared + 2] - finer.position, axis=1)[1:]
    way = np.linalg.norm(out.position[1:], axis=1)
    path[: compared + 1] = apart / np.maximum(way[: compared + 1], one.body.length)
    return {
        "ledger": np.abs(residual[1:] / works[1:, 0]),
        "norm": np.abs(np.linalg.norm(out.orientation[1:], axis=1) - 1.0),
        "phase": np.abs(bend - bend[0]).max(axis=(1, 2)) / np.abs(bend[0]).max(),
        "beat": beat,
        "path": path,
        "way": way,
    }


def drifts() -> str:
    """The drifts of all swimmers, as Markdown."""
    rows = []
    for name, swimmer in SWIMMERS.items():
        found = drift_of(swimmer)
        for decade, way in enumerate(found["way"]):
            cells = ("" if np.isnan(found[each][decade]) else f"{found[each][decade]:.1e}" for each in FIGURES)
            rows.append((name, f"{10**decade:,}", *cells, f"{way:,.4g}"))
    head = ("swimmer", "periods", *FIGURES.values(), "way (m)")
    return f"{table(head, rows)}\n\nAccuracy `{ACCURACY}`, period {PERIOD} s."


def _recorded(times: np.ndarray, **swimmer: Any) -> tuple[Simulation, Any, np.ndarray]:
    simulation = Simulation(stations=5, **swimmer)
    out, works, _, stopped = simulation.record(times, False, False)
    if stopped is not None:
        raise stopped
    return simulation, out, works


def planes() -> str:
    """Growth out of the plane per period, as Markdown."""
    rows = []
    for name, swimmer in VARIANTS.items():
        found = periodic_linearisation(straight(), estimate=False, **swimmer)
        mode = int(np.argmax(np.where(found.neutral, 0.0, np.abs(found.multipliers))))
        rows.append((name, f"{found.growth:.3f}", found.motion_of(mode).replace("_", " ")))
    return table(("swimmer", "growth in a period", "mode"), rows)
