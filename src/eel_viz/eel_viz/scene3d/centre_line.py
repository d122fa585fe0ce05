# SPDX-License-Identifier: Apache-2.0
"""The backbone between its stations, cubic Hermite in position with the exact slope dr/dX = t1; loads on it.

So the skin can have its own abscissae, finer at the nose, and keeps its mesh when the number of stations changes.
"""

import numpy as np
from eel_common.attitude import section_axes, world_from_section

from eel_viz.messages import Backbone, Load, same

ALONG = 24  # most forces shown between nose and tail


class Resampling:
    """Interpolates values from strictly increasing stations `x` (M,) [m] to abscissae `target` (R,) [m]."""

    def __init__(self, x: np.ndarray, target: np.ndarray) -> None:
        self.x, self.target = x, target
        self.left = np.clip(np.searchsorted(self.x, self.target, side="right") - 1, 0, len(self.x) - 2)
        self.span = self.x[self.left + 1] - self.x[self.left]
        self.fraction = np.clip((self.target - self.x[self.left]) / self.span, 0.0, 1.0)

    def linear(self, values: np.ndarray) -> np.ndarray:
        """Linear interpolation of `values`, shape (M,) or (M, n); returns (R,) or (R, n)."""
        values = np.asarray(values, dtype=float)
        weight = self.fraction if values.ndim == 1 else self.fraction[:, None]
        return np.asarray(values[self.left] * (1.0 - weight) + values[self.left + 1] * weight)

    def centre_line(self, position: np.ndarray, orientation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position [m], (R, 3), and section axes, (R, 3, 3) with columns t1, t2, t3, both in the world frame.

        `position` (M, 3) [m] and `orientation` (M, 4) are as in the message `Backbone` (REP-103 axes).
        """
        axes = section_axes(orientation)
        position = np.asarray(position, dtype=float)
        s = self.fraction[:, None]
        slope = axes[:, :, 0]
        points = (
            position[self.left] * (1 + 2 * s) * (1 - s) ** 2
            + position[self.left + 1] * s * s * (3 - 2 * s)
            + self.span[:, None] * (slope[self.left] * s * (1 - s) ** 2 - slope[self.left + 1] * s * s * (1 - s))
        )
        blended = axes[self.left] * (1 - s)[:, :, None] + axes[self.left + 1] * s[:, :, None]
        t1 = _unit(blended[:, :, 0])
        t2 = _unit(blended[:, :, 1] - t1 * np.sum(t1 * blended[:, :, 1], axis=1, keepdims=True))
        return points, np.stack([t1, t2, np.cross(t1, t2)], axis=2)


def forces_along(backbone: Backbone, load: Load) -> tuple[np.ndarray, np.ndarray]:
    """Places [m] and forces per length [N/m] at nearly even stations between the ends, each (n, 3), world."""
    wanted = np.linspace(backbone.x[0], backbone.x[-1], ALONG + 2)[1:-1]
    chosen = np.unique(np.searchsorted(backbone.x, wanted - 1e-9))
    force = load.profiles.together("force_1", "force_2", "force_3")
    alike = same(load.profiles.x, backbone.x)
    force = force[chosen] if alike else Resampling(load.profiles.x, backbone.x[chosen]).linear(force)
    return backbone.position[chosen], world_from_section(backbone.orientation[chosen], force)


def forces_at_ends(backbone: Backbone, load: Load) -> tuple[np.ndarray, np.ndarray]:
    """Places [m] and forces [N] at nose and tail, each (2, 3), world."""
    ends = [0, -1]
    return backbone.position[ends], world_from_section(backbone.orientation[ends], np.stack([load.nose, load.tail]))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))
