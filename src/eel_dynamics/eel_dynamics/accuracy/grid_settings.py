# SPDX-License-Identifier: Apache-2.0
"""The fineness of the grid along the body: the needs of a law, and when another grid replaces the present one."""

from typing import NamedTuple

MUCH_FINER = 1.5  # times the needed resolution: a coarser grid replaces a finer one than this
ROUND_OFF = 1e-9  # relative difference of resolutions that count as equal


class ShapeNeeds(NamedTuple):
    """The properties of a curvature that its grid must fit: waves on the body, and knots [m] of splines."""

    waves: float = 1.0
    knots: tuple[float, ...] = ()


class GridSettings(NamedTuple):
    """Points per body length, the kinks of the drag that are integrated exactly, and additional ends of panels: knots
    [m] of a law, and edges [m] of a robot's modes."""

    resolution: float
    kinks: str
    knots: tuple[float, ...]
    edges: tuple[float, ...]

    def at_least(self, wanted: "GridSettings") -> "GridSettings":
        """These settings if they are fine enough for the `wanted`; otherwise the wanted ones, but no coarser."""
        resolution = max(self.resolution, wanted.resolution)
        fine_enough = resolution <= self.resolution * (1.0 + ROUND_OFF) and set(wanted.knots) <= set(self.knots)
        return self if fine_enough and self.kinks == wanted.kinks else wanted._replace(resolution=resolution)

    def fitted(self, wanted: "GridSettings") -> "GridSettings":
        """As `at_least`, but the `wanted` settings if these are much finer than needed."""
        return wanted if self.resolution > MUCH_FINER * wanted.resolution else self.at_least(wanted)
