# SPDX-License-Identifier: Apache-2.0
"""How fine the grid along the body is: what a law needs of it, and when another grid replaces the present one."""

from typing import NamedTuple

MUCH_FINER = 1.5  # times the resolution that is needed: a coarser grid replaces such a grid
ROUND_OFF = 1e-9  # relative, between two resolutions that count as equal


class ShapeNeeds(NamedTuple):
    """The properties of a curvature that its grid must fit: waves on the body, and knots [m] of splines."""

    waves: float = 1.0
    knots: tuple[float, ...] = ()


class GridSettings(NamedTuple):
    """Points per body length, the kinks of the drag that are integrated exactly, and where panels end besides: at the
    knots [m] of a law, and at the edges [m] of a robot's modes."""

    resolution: float
    kinks: str
    knots: tuple[float, ...]
    edges: tuple[float, ...]

    def at_least(self, wanted: "GridSettings") -> "GridSettings":
        """These settings where they are fine enough for the `wanted`. Else those, but no coarser than these."""
        resolution = max(self.resolution, wanted.resolution)
        fine_enough = resolution <= self.resolution * (1.0 + ROUND_OFF) and set(wanted.knots) <= set(self.knots)
        return self if fine_enough and self.kinks == wanted.kinks else wanted._replace(resolution=resolution)

    def fitted(self, wanted: "GridSettings") -> "GridSettings":
        """As `at_least`, but the `wanted` settings where these are much finer."""
        return wanted if self.resolution > MUCH_FINER * wanted.resolution else self.at_least(wanted)
