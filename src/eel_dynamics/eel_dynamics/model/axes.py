# SPDX-License-Identifier: Apache-2.0
"""Converts between axes: the library's, the sections', the paper's, and the half turn between them.

World and head have REP-103 axes: the eel swims towards +x, y is left, z up. Section quantities (curvature, internal
wrench, loads) have the paper's section axes: 1 along the body towards the tail, 2 to the right, 3 up. These are -x, -y
and +z of the section turned as the head. In the paper's world the eel swims towards -x. `eel_core` turns its inputs and
outputs by `half_turn` in eel_core/march/axes.hpp.
"""

import numpy as np
from numpy.typing import ArrayLike

REP103, PAPER = CONVENTIONS = ("rep103", "paper")  # axes of world and head; the first are the library's
VECTOR, QUATERNION = np.array([-1.0, -1.0, 1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
SIGNS = {  # signs of the components of observations under the half turn
    **dict.fromkeys(("position", "center_of_mass", "backbone"), VECTOR),
    **dict.fromkeys(("orientation", "section_orientation"), QUATERNION),
    **dict.fromkeys(("twist", "head_acceleration"), np.tile(VECTOR, 2)),
}


def turn_vector(vector: ArrayLike) -> np.ndarray:
    """Components (-x, -y, z) of `vector`, shape (..., 3), after a half turn of its axes about z. Its own inverse."""
    return np.asarray(np.asarray(vector, dtype=float) * VECTOR + 0.0)  # + 0.0: no minus zero


def turn_quaternion(quaternion: ArrayLike) -> np.ndarray:
    """Orientation `quaternion`, (..., 4) x y z w, after a half turn of the axes of world and body. Its own inverse."""
    return np.asarray(np.asarray(quaternion, dtype=float) * QUATERNION + 0.0)


def with_section_axes(orientation: np.ndarray) -> np.ndarray:
    """World from the paper's section axes. orientation (..., 4) x y z w: of a section turned as the head."""
    x, y, z, w = np.moveaxis(np.asarray(orientation, dtype=float), -1, 0)
    return np.stack([y, -x, w, -z], axis=-1)


def turned(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The `arrays`, by their names in a run, converted to the other axes if they have axes of world or head."""
    return {name: values * SIGNS[name] + 0.0 for name, values in arrays.items() if name in SIGNS}
