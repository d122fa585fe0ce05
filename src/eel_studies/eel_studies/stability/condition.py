# SPDX-License-Identifier: Apache-2.0
"""Condition number of the 6 x 6 inertia matrix: the factor by which a solution magnifies round-off.

Rotations are scaled by the body's length. One map is of the straight body, over its density and slenderness. The other
is of the paper's robot, over its density and the amplitude of its wave, with the worst of some instants of a period.
Singular bodies are refused beforehand (`inertia.py`).
"""

import numpy as np
from eel_base.files.markdown import table
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.simulate import simulate
from eel_dynamics.simulation.simulation import Simulation, SimulationStopped
from eel_model.body.body import Body
from eel_model.inertia import condition_of, straight_inertia
from eel_model.scene import Scene
from eel_model.section_data import nose_of

import eel_core
from eel_gaits import falling, straight
from eel_studies.stability.extremes import DENSITY, SLENDERNESS, sized
from eel_studies.stability.maps import Map

INSTANTS = 8  # per period, after the ramps of the gait
NEEDLES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)  # greatest half-axes [m] of a round needle of 1 m


def maps_of(points: int = 13) -> tuple[Map, Map]:
    """Two maps of `points` by `points` matrices each: of straight bodies, and of the swimming robot."""
    return (
        Map(
            "condition", "condition of the 6 x 6 matrix: straight bodies", DENSITY, SLENDERNESS, points, at=of_straight
        ),
        Map(
            "bent",
            "condition of the 6 x 6 matrix: the robot as it swims",
            DENSITY,
            sized(1e-3, 4.0),
            points,
            at=of_bent,
        ),
    )


def of_straight(ratio: float, slenderness: float) -> float:
    """Condition number for a straight spindle of 1 m, of `ratio` times the density of the water."""
    return of_body(Body.spindle(1.0, slenderness), ratio)


def of_body(body: Body, ratio: float) -> float:
    """Condition number for the straight `body` of `ratio` times the density of the water."""
    scene = _water(ratio)
    here = Simulation(body, scene, "draft", [0.0]).discretisation
    return condition_of(straight_inertia(here.grid, here.sections, nose_of(body, scene)[0], body.length))


def of_bent(ratio: float, size: float) -> float:
    """Greatest condition number for the robot over a period of its wave, of `size` times the paper's amplitude."""
    law = straight(amplitude_0=size, amplitude_1=0.5 * size, amplitude_2=2.0 * size)
    swimmer = Simulation(Body.boyer2010(), _water(ratio), "draft", [0.0], law=law)
    return max(condition_of(inertia_at(swimmer, time)) for time in 2.0 + np.arange(INSTANTS) / INSTANTS)


def inertia_at(swimmer: Simulation, time: float) -> np.ndarray:
    """Inertia matrix (6, 6) about the head, in the paper's axes, at `time` [s]. The body is 1 m long."""
    return np.array(eel_core.Instant(swimmer.discretisation.swimmer).inertia(swimmer.law_on_grid, time))


def needles() -> str:
    """The outcome of runs of thinner and thinner needles, as a Markdown table."""
    rows = []
    for thickness in NEEDLES:
        try:
            run = simulate(falling(), 2.0, body=needle(thickness), accuracy=1e-3, stations=2, estimate=False)
            outcome = f"swims {run.path_length:.3g} m, greatest residual of the ledger {_open(run):.1g} of what passed"
        except SimulationStopped as error:
            outcome = str(error)
        except ValueError as error:
            outcome = f"refused: {error}"
        rows.append((f"{thickness:g}", outcome))
    return table(("half-axes of a needle of 1 m (m)", "what happens to it in the falling gait"), rows)


def needle(thickness: float) -> Body:
    """A round body of 1 m, pointed at both ends, with half-axes of `thickness` [m] in the middle."""

    def half_axis(x: np.ndarray) -> np.ndarray:
        return np.asarray(2.0 * thickness * np.sqrt(x * (1.0 - x)))

    return Body(length=1.0, half_width=half_axis, half_height=half_axis)


def _water(ratio: float) -> Scene:
    return Scene(density=1000.0 * ratio, internal_wrench=False, ledger=False)


def _open(run: Run) -> float:
    energy = run.energy
    assert energy is not None
    works = energy.actuator_work, energy.wake_work, energy.nose_work, energy.drag_work
    passed = energy.kinetic_body + energy.kinetic_fluid + sum(np.abs(work) for work in works)
    return float(np.abs(energy.residual).max() / passed.max())
