# SPDX-License-Identifier: Apache-2.0
"""The tendon fish: the films of its hinges, and its body by its published sections, masses and appendages.

The added mass of its tail is exact potential flow over the flat planform, vortex rings with the film of 1.00 Hz; the
sections of slender theory are its own. Slender theory gives 21 kg/m at the rear edge, where the fin's tips are round,
and 31 kg/m at its whole span just ahead.
"""

from pathlib import Path

import numpy as np
from eel_common.files.tables import read_table
from eel_dynamics.model.body.text import appendages_from_file
from eel_gaits.film.beat import Beat, beat_of
from eel_gaits.film.film import read_film

from eel_dynamics import Body

DATA = Path(__file__).resolve().parents[2] / "docs" / "data"
FILMS = ("0.50", "1.00", "1.50", "2.00")  # Hz, as their names say
RIGID = 0.64  # of the length
STEPS = 281  # along the body, 2 mm apart
LATTICE = np.array([[0.36, 7.8], [0.378, 6.3], [0.445, 4.0], [0.482, 4.1], [0.501, 2.8], [0.52, 7.3], [0.54, 10.3],
                    [0.5594, 7.9]])  # fmt: skip
"""X [m], and the added mass [kg/m] of the tail of finite height."""
WATER = 1000.0  # kg/m^3


def beat(frequency: str) -> Beat:
    """The mean beat of a film."""
    return beat_of(read_film(DATA / f"tendon_fish_hinges_{frequency}Hz.csv"), rigid=RIGID)


def tendon_fish(*, hung: bool = True, finite: bool = True, appendage_factor: float = 1.0) -> Body:
    """Its body, with appendages if `hung`, their areas times a factor, and with a tail of `finite` height."""
    sections, masses = (read_table(DATA / f"tendon_fish_{name}.csv") for name in ("true_body", "masses"))
    places, *axes = (sections.column(name, "m") for name in ("x", "half_width", "half_height"))
    x = np.linspace(0.0, places[-1], STEPS)
    width, height = (np.interp(x, places, axis) for axis in axes)
    mass = np.zeros(STEPS)
    for start, end, part in zip(*(masses.column(name) for name in ("from", "to", "mass")), strict=True):
        mass[(x >= start) & (x <= end)] += part / (end - start)
    factor = np.where(x < LATTICE[0, 0], 1.0, np.interp(x, *LATTICE.T) / (WATER * np.pi * height**2))
    return Body(
        x=x, half_width=width, half_height=height, mass_per_length=mass, blunt_nose=True, nose_drag=0.0,
        nose_added_mass=0.0, lateral_added_mass=factor if finite else 1.0, name="tendon fish",
        appendages=appendages_from_file(DATA / "tendon_fish_parts.csv") if hung else (),
        appendage_factor=appendage_factor,
    )  # fmt: skip
