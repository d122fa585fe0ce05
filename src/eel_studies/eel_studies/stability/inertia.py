# SPDX-License-Identifier: Apache-2.0
"""The condition of the 6 x 6 inertia matrix, which magnifies round-off, and the effect of added mass treated
explicitly.

Rotations are scaled by the body's length. With the added mass on the right-hand side, as with a separate flow solver,
I_b a[n+1] = w - I_f a[n] multiplies an error in each step by the greatest eigenvalue of I_b^-1 I_f, however short the
step.
"""

import numpy as np
from eel_common.files.markdown import table
from eel_dynamics.model.inertia import MOST, condition_of, straight_inertia
from eel_dynamics.model.section_data import nose_of

import eel_core
from eel_dynamics import Body, Scene, Simulation
from eel_gaits import straight
from eel_studies.stability.extremes import DENSITY, SLENDERNESS, amplitudes
from eel_studies.stability.maps import Map

INSTANTS = 8  # per period, after the ramps of the gait
RATIOS = (1e-3, 1e-2, 1e-1, 0.5, 1.0, 10.0, 1e3)  # density of the body / density of the water


def maps_of(points: int) -> tuple[Map, Map]:
    """Maps of `points` by `points` condition numbers: of straight bodies, and of the swimming robot."""
    title, needles = "condition of the 6 x 6 matrix:", SLENDERNESS._replace(high=5e6)
    straight_bodies = Map("condition", f"{title} straight bodies", DENSITY, needles, points, at=of_straight)
    return straight_bodies, Map(
        "bent", f"{title} the robot as it swims", DENSITY, amplitudes(1e-3, 4.0), points, at=of_bent
    )


def of_straight(ratio: float, slenderness: float) -> float:
    """Condition number for a straight spindle of 1 m, of `ratio` times the water's density; NaN if it is refused as
    singular."""
    try:
        return condition_of(np.add(*inertias(Body.spindle(1.0, slenderness), ratio)))
    except ValueError:
        return np.nan


def of_bent(ratio: float, size: float) -> float:
    """Greatest condition number for the robot over a period, with a wave of `size` times the paper's amplitude."""
    swimmer = Simulation(scene=_water(ratio), accuracy="draft", stations=[0.0], law=straight() * size)
    return max(condition_of(inertia_at(swimmer, time)) for time in 2.0 + np.arange(INSTANTS) / INSTANTS)


def inertia_at(swimmer: Simulation, time: float) -> np.ndarray:
    """Inertia matrix (6, 6) about the head, in the paper's axes, at `time` [s]. The body is 1 m long."""
    return np.array(eel_core.Instant(swimmer.discretisation.swimmer).inertia(swimmer.law_on_grid, time))


def inertias(body: Body, ratio: float, accuracy: str | float = "draft") -> tuple[np.ndarray, np.ndarray]:
    """Inertia matrices (6, 6) [kg] about the head, rotation first, of the straight body of `ratio` times the water's
    density, and of its added mass."""
    scene = _water(ratio)
    here = Simulation(body=body, scene=scene, accuracy=accuracy, stations=[0.0]).discretisation
    none = np.zeros_like(here.sections.mass)
    dry = here.sections._replace(added2=none, added3=none, inertia1=here.sections.inertia1 - here.sections.added_roll)
    own = straight_inertia(here.grid, dry, 0.0, body.length)
    return own, straight_inertia(here.grid, here.sections, nose_of(body, scene)[0], body.length) - own


def growth_of_explicit(ratio: float) -> float:
    """The factor per step of an error in the robot's acceleration, with an explicit added mass."""
    own, added = inertias(Body.boyer2010(), ratio)
    return float(np.abs(np.linalg.eigvals(np.linalg.solve(own, added))).max())


def explicit() -> str:
    """Growth with explicit added mass over densities, as Markdown."""
    head = "density of the body, by water's", "error by that of the step before, with an explicit added mass"
    rows = [(f"{ratio:g}", f"{growth_of_explicit(ratio):.3g}") for ratio in RATIOS]
    return f"Bodies of a condition above {MOST:g} are refused as singular.\n\n{table(head, rows)}"


def _water(ratio: float) -> Scene:
    return Scene(density=1000.0 * ratio, internal_wrench=False, ledger=False)
