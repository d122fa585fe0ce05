# SPDX-License-Identifier: Apache-2.0
"""The midlines of a run against the measured ones that it follows, without the rigid motion of either."""

from dataclasses import dataclass

import numpy as np
from eel_dynamics.runs.run import Run
from eel_gaits.sources.midlines import Midlines


@dataclass(frozen=True)
class MidlineComparison:
    """Midlines at T instants and n points, in the plane or in space. The run's are laid on the measured ones."""

    time: np.ndarray  # (T,) s
    measured: np.ndarray  # (T, n, 2 or 3) m
    found: np.ndarray  # (T, n, 2 or 3) m
    length: float  # m, of the body

    @property
    def distance(self) -> np.ndarray:
        """(T, n) relative to the body's length."""
        return np.asarray(np.linalg.norm(self.found - self.measured, axis=2) / self.length)

    @property
    def rms(self) -> float:
        """Root mean square of the distances, relative to the body's length."""
        return float(np.sqrt(np.mean(self.distance**2)))

    def __str__(self) -> str:
        worst = np.unravel_index(np.argmax(self.distance), self.distance.shape)
        return (
            f"{self.rms:.3%} of the body's length apart (RMS), {self.distance[worst]:.3%} at most, at point "
            f"{worst[1] + 1} at t = {self.time[worst[0]]:.3g} s; rigid motion removed"
        )


def compared(run: Run, midlines: Midlines) -> MidlineComparison:
    """Compare a `run`, whose stations are the measured points, with the `midlines` at its instants."""
    from scipy.interpolate import CubicSpline

    measured = CubicSpline(midlines.time, midlines.position)(run.time)
    assert run.backbone is not None  # it has stations
    found = run.backbone[..., : measured.shape[2]]
    return MidlineComparison(run.time, measured, laid_on(found, measured), run.body.length)


def laid_on(points: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The `points` (T, n, d) after the rotation and shift of each instant that brings them closest to the `others`.

    Kabsch, Acta Cryst. A32 (1976), doi:10.1107/S0567739476001873.
    """
    centre, other = points.mean(axis=1, keepdims=True), others.mean(axis=1, keepdims=True)
    left, _, right = np.linalg.svd((points - centre).swapaxes(1, 2) @ (others - other))
    sign = np.sign(np.linalg.det(left @ right))
    left[..., -1] *= sign[:, None]
    return np.asarray((points - centre) @ (left @ right) + other)
