# SPDX-License-Identifier: Apache-2.0
"""Drift of long runs: of the energy ledger, the quaternion, the law's phase and the path, over decades of periods.

The works of the ledger are integrated along with the motion, and only the samples are kept: memory does not grow with
time. The drifts are:

phase: change of the law's curvature at t = n T since the first period, relative to the greatest curvature; an angle.
beat: change of the head's velocity at t = n T since 100 periods, relative to its magnitude.
path: distance of the head from that of a finer run, relative to its distance from the start.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_base.files.markdown import table as table_of
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.simulation.observations import Observations
from eel_dynamics.simulation.simulation import Simulation
from eel_gaits.laws.law import Law
from eel_model.scene import Scene

from eel_gaits import helix, straight

PERIOD = 0.7  # s, whose multiples are not exact in binary
DECADES = 5
PERIODIC_FROM = 2  # decade from which on the motion is periodic
COMPARED = 3  # decades over which a finer run is simulated as well
ACCURACY = "draft"
FIGURES = (  # columns
    *("ledger's residual, by the work", "norm of the quaternion, less 1", "phase of the law (rad)"),
    *("beat, by the hundredth", "path, by a finer run"),
)
STATIONS = 5  # at which the law's phase is evaluated


@dataclass(frozen=True)
class Drift:
    """The drift of one swimmer after (T,) numbers of periods; all arrays are (T,). path is NaN without a finer run."""

    name: str
    periods: np.ndarray
    ledger: np.ndarray  # residual relative to the work of the actuators
    norm: np.ndarray  # | |q| - 1 |
    phase: np.ndarray  # rad
    beat: np.ndarray  # relative; NaN before 100 periods
    path: np.ndarray  # relative to `way`, or to the body's length if longer
    way: np.ndarray  # m, distance of the head from the start
    steps: int


def swimmers() -> dict[str, tuple[Law, Scene]]:
    """Law and scene of each swimmer, by name: one in a planar scene and one in space."""
    return {
        "straight, planar": (straight(period=PERIOD), Scene(planar=True, internal_wrench=False)),
        "helix": (helix(period=PERIOD), Scene(internal_wrench=False)),
    }


def drift_of(name: str, law: Law, scene: Scene, decades: int = DECADES, compared: int = COMPARED) -> Drift:
    """Simulate 10^`decades` periods of `law`, and 10^`compared` of them again with finer settings.

    `SimulationStopped` where a run cannot go on.
    """
    periods = 10.0 ** np.arange(decades + 1)
    times = np.concatenate(([0.0], PERIOD * periods))
    swim: dict[str, Any] = {"law": law, "scene": scene, "stations": STATIONS}
    swimmer, out, works = recorded(times, **swim, accuracy=Accuracy.of(ACCURACY).in_scene(scene))
    residual = out.energies.sum(axis=1) - swimmer.energy_at_start - works.sum(axis=1)
    bend, speed = out.curvature[1:], out.twist[1:, 3:]
    beat = np.full(len(periods), np.nan)
    beat[PERIODIC_FROM:] = np.linalg.norm(speed[PERIODIC_FROM:] - speed[PERIODIC_FROM : PERIODIC_FROM + 1], axis=1)
    beat[PERIODIC_FROM:] /= np.linalg.norm(speed[PERIODIC_FROM : PERIODIC_FROM + 1])
    way = np.linalg.norm(out.position[1:], axis=1)
    _, finer, _ = recorded(times[: compared + 2], **swim, accuracy=swimmer.accuracy.tightened(0.1))
    apart = np.linalg.norm(out.position[: compared + 2] - finer.position, axis=1)[1:]
    path = np.full(len(periods), np.nan)
    path[: compared + 1] = apart / np.maximum(way[: compared + 1], swimmer.body.length)
    return Drift(
        name=name,
        periods=periods,
        ledger=np.abs(residual[1:] / works[1:, 0]),
        norm=np.abs(np.linalg.norm(out.orientation[1:], axis=1) - 1.0),
        phase=np.abs(bend - bend[0]).max(axis=(1, 2)) / np.abs(bend[0]).max(),
        beat=beat,
        path=path,
        way=way,
        steps=swimmer.evaluations[0],
    )


def table(found: list[Drift]) -> str:
    """The drifts as a Markdown table."""
    head = "swimmer", "periods", *FIGURES, "way (m)"
    rows = []
    for each in found:
        for index, periods in enumerate(each.periods):
            figures = (row[index] for row in (each.ledger, each.norm, each.phase, each.beat, each.path))
            cells = ("" if np.isnan(figure) else f"{figure:.1e}" for figure in figures)
            rows.append((each.name, f"{periods:,.0f}", *cells, f"{each.way[index]:,.4g}"))
    counts = ", ".join(f"{each.steps:,} of the {each.name}" for each in found)
    return f"{table_of(head, rows)}\n\nAccuracy `{ACCURACY}`, period {PERIOD} s; steps in time: {counts}."


def recorded(times: np.ndarray, **swimmer: Any) -> tuple[Simulation, Observations, np.ndarray]:
    """The simulation of a `swimmer` (keywords of `Simulation`), its profiles and its works at the `times` [s].

    `SimulationStopped` where it cannot go on.
    """
    simulation = Simulation(**swimmer)
    out, works, _, stopped = simulation.record(times, False, False)
    if stopped is not None:
        raise stopped
    return simulation, out, works
