# SPDX-License-Identifier: Apache-2.0
"""The kinematics that biologists measure on a steady swimmer, from points along its body in a film or a run.

The path is a quadratic in time through the points' mean, fitted together with harmonics of the beat. Sideways means
across the path. The wavelength follows from the slope of the phase along the body, weighted by the square of the
amplitude.
"""

import math
from dataclasses import dataclass

import numpy as np

HARMONICS = 2  # of the beat, fitted with the path
STANDING = 1e-2  # of the length per beat: a slower swimmer has no direction


@dataclass(frozen=True)
class Kinematics:
    """Figures of a steady swimmer; lengths relative to its own."""

    length: float  # m
    period: float  # s
    speed: float  # m/s, speed of the points' mean along the path
    ahead: bool  # whether it moves head first
    excursion: np.ndarray  # (n,) L, peak-to-peak, of each point
    wavelength: float  # L, of the sideways motion; inf for a standing wave
    yaw: float  # rad, amplitude of the first segment

    @property
    def stride(self) -> float:
        """Distance per beat, in lengths."""
        return self.speed * self.period / self.length

    @property
    def slip(self) -> float:
        """Swimming speed divided by the wave's speed."""
        return self.stride / self.wavelength

    @property
    def strouhal(self) -> float:
        """Frequency times the tail's excursion, divided by the speed."""
        return float(self.excursion[-1]) / self.stride if self.stride else math.inf


def arc_of(points: np.ndarray, missing: np.ndarray | None = None) -> np.ndarray:
    """Mean arc lengths (n,) [m] of the points (N, n, 2) [m], from distances between points not `missing` (N, n)."""
    steps = np.linalg.norm(np.diff(points, axis=1), axis=2)
    if missing is not None:
        seen = ~(missing[:, 1:] | missing[:, :-1])
        steps = np.where(seen | ~seen.any(axis=0), steps, np.nan)
    return np.concatenate(([0.0], np.cumsum(np.nanmean(steps, axis=0))))


def kinematics(time: np.ndarray, points: np.ndarray, period: float) -> Kinematics:
    """Figures of the points (N, n, 2) [m] from head to tail at `time` (N,) [s], which beat with a `period` [s]."""
    time = time - time.mean()
    arc = arc_of(points)
    length = float(arc[-1])
    turns = 2.0 * math.pi / period * time
    powers = np.column_stack((np.ones_like(time), time, time**2))
    design = np.column_stack((powers, *harmonics(turns, HARMONICS)))
    found = np.linalg.lstsq(design, points.mean(axis=1), rcond=None)[0][:3]
    velocity = found[1] + 2.0 * time[:, None] * found[2]
    speed = float(np.mean(np.linalg.norm(velocity, axis=1)))
    axis = (points[:, 0] - points[:, -1]).mean(axis=0)
    ahead = float(np.mean(np.sum(velocity * (points[:, 0] - points[:, -1]), axis=1))) > 0.0
    along = velocity if speed * period > STANDING * length else np.broadcast_to(axis, velocity.shape)
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    across = np.column_stack((-along[:, 1], along[:, 0]))
    side = np.sum((points - (powers @ found)[:, None]) * across[:, None], axis=2)
    wave = _harmonic(turns, side)
    phase, weight = np.unwrap(np.angle(wave)), np.abs(wave)
    slope = float(np.polyfit(arc, phase, 1, w=weight)[0])  # negative for a wave towards the tail
    head = points[:, 0] - points[:, 1]
    angle = np.unwrap(np.arctan2(np.sum(head * across, axis=1), np.sum(head * along, axis=1)))
    return Kinematics(
        length=length,
        period=period,
        speed=speed,
        ahead=ahead,
        excursion=2.0 * np.abs(wave) / length,
        wavelength=-2.0 * math.pi / (slope * length) if slope else math.inf,
        yaw=float(np.abs(_harmonic(turns, angle[:, None])[0])),
    )


def harmonics(turns: np.ndarray, order: int) -> list[np.ndarray]:
    """cos and sin (N,) of 1 to `order` times the phase `turns` (N,) [rad]."""
    return [f(h * turns) for h in range(1, order + 1) for f in (np.cos, np.sin)]


def _harmonic(turns: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Complex amplitudes A (n,) of the `values` (N, n) = mean + trend + Re(A exp(i turns)) + a second harmonic."""
    columns = [np.ones_like(turns), turns, *harmonics(turns, HARMONICS)]
    found = np.linalg.lstsq(np.column_stack(columns), values, rcond=None)[0]
    return np.asarray(found[2] - 1j * found[3])
