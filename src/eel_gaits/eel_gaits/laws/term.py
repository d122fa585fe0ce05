# SPDX-License-Identifier: Apache-2.0
"""Terms of a curvature law: a wave or a bend in pitch (K2) or yaw (K3), with its time derivatives."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from eel_common.quantity import checked_choice, number
from eel_common.wording import shown

from eel_gaits.laws.ramp import Ramp, envelope_at
from eel_gaits.laws.spline import natural_spline

SECTION_COLUMN = {"pitch": 1, "yaw": 2}  # name of the axis: its column in a curvature array
LAW_ROW = {"pitch": 0, "yaw": 1}  # name of the axis: its index in the rows of a law
MAXIMUM_VALUES = 1000  # coefficients or knots of a term, ramps of an envelope


@dataclass(frozen=True, kw_only=True)
class Term:
    """One wave or bend: envelope(t) amplitude(X) sin(2 pi (X / wavelength - t / period) + phase).

    `ValueError` names a bad attribute.

    Attributes:
        axis: "yaw" (K3) or "pitch" (K2).
        amplitude: at most 1000 values. Without knots, these are the coefficients of a polynomial in X [rad/m, rad/m^2,
            ...]. With knots, they are the values [rad/m] at the knots of a natural cubic spline. Beyond the end knots
            the spline continues as a straight line.
        knots: [m], strictly increasing; none, or as many as amplitudes and at least 2.
        wavelength: [m]; 0 for a standing term; negative for a wave that runs towards the head.
        period: [s]; 0 for a term that is constant in time except for its envelope.
        phase: [rad]; pi/2 for a constant bend.
        envelope: ramps. Those of one factor add up from 0, and the factors multiply. Without ramps the envelope is 1 at
            all times.
    """

    axis: str = "yaw"
    amplitude: tuple[float, ...]
    knots: tuple[float, ...] = ()
    wavelength: float = 0.0
    period: float = 0.0
    phase: float = 0.0
    envelope: tuple[Ramp, ...] = ()

    def __post_init__(self) -> None:
        checked_choice("axis", self.axis, SECTION_COLUMN)
        for field in ("amplitude", "knots"):
            object.__setattr__(self, field, _numbers(field, getattr(self, field)))
        for field, least in (("wavelength", None), ("period", 0.0), ("phase", None)):
            object.__setattr__(self, field, number(field, getattr(self, field), "s", minimum=least))
        object.__setattr__(self, "envelope", _row("envelope", "Ramps", self.envelope))
        if self.knots:
            self._check_spline()
        elif not self.amplitude:
            raise ValueError("amplitude must have at least 1 coefficient, got none")
        if self.period and self.period < 1e-100:
            raise ValueError(f"period must be 0 or long enough for finite rates, got {self.period}")
        if self.wavelength and abs(self.wavelength) < 1e-100:
            raise ValueError(f"wavelength must be 0 or long enough for a finite wave number, got {self.wavelength}")
        for ramp in self.envelope:
            if not isinstance(ramp, Ramp):
                raise ValueError(f"envelope must hold Ramps, got {shown(ramp)}")

    def _check_spline(self) -> None:
        if len(self.knots) < 2:
            raise ValueError(f"knots must be none or at least 2, got {len(self.knots)}")
        if len(self.amplitude) != len(self.knots):
            raise ValueError(
                f"amplitude must have one value per knot ({len(self.knots)}), got {len(self.amplitude)} values"
            )
        if not np.all(np.diff(self.knots) > 0.0):
            raise ValueError(f"knots must be strictly increasing [m], got {shown(list(self.knots))}")
        with np.errstate(all="ignore"):
            if not np.all(np.isfinite(self.amplitude_at(self.knots))):
                raise ValueError(f"knots must lie far enough apart for a finite spline, got {shown(list(self.knots))}")

    @property
    def wave_number(self) -> float:
        """2 pi / wavelength [rad/m]; 0 for a standing term."""
        return 2.0 * math.pi / self.wavelength if self.wavelength else 0.0

    @property
    def angular_frequency(self) -> float:
        """2 pi / period [rad/s]; 0 for a term that is constant in time except for its envelope."""
        return 2.0 * math.pi / self.period if self.period else 0.0

    def amplitude_at(self, x: Any) -> np.ndarray:
        """The amplitude [rad/m], shape (len(x),), at the stations x [m], shape (len(x),)."""
        return amplitude_of(self.amplitude, self.knots, np.asarray(x, dtype=float))

    def envelope_at(self, t: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The envelope [1] and its first and second time derivatives at `t` [s]: three arrays of the shape of `t`."""
        return envelope_at(self.envelope, t)

    def curvature(self, time: float, x: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Curvature [rad/m], its rate [rad/m/s] and its acceleration [rad/m/s^2], each of shape (len(x),).

        time [s] is the law's own time. x [m], shape (len(x),): arc length from the nose.
        """
        x = np.asarray(x, dtype=float)
        amplitude = self.amplitude_at(x)
        envelope, envelope_rate, envelope_acceleration = self.envelope_at(time)
        frequency = self.angular_frequency
        angle = self.wave_number * x - frequency * time + self.phase
        sine, cosine = np.sin(angle), np.cos(angle)
        value = amplitude * envelope * sine
        rate = amplitude * (envelope_rate * sine - envelope * frequency * cosine)
        acceleration = amplitude * (
            (envelope_acceleration - envelope * frequency**2) * sine - 2.0 * envelope_rate * frequency * cosine
        )
        return value, rate, acceleration

    def scaled(self, scale: float) -> "Term":
        """The term with `scale` times its amplitude."""
        return replace(self, amplitude=tuple(scale * value for value in self.amplitude))

    def delayed(self, delay: float) -> "Term":
        """The same motion, later by `delay` [s]."""
        turns = math.remainder(delay / self.period, 1.0) if self.period else 0.0
        envelope = tuple(replace(ramp, start=ramp.start + delay, end=ramp.end + delay) for ramp in self.envelope)
        return replace(self, phase=self.phase + 2.0 * math.pi * turns, envelope=envelope)


def amplitude_of(amplitude: tuple[float, ...], knots: tuple[float, ...], x: Any) -> np.ndarray:
    """The amplitude [rad/m], shape (len(x),), at the stations x [m], of a term with this `amplitude` and `knots`."""
    if knots:
        return natural_spline(knots, amplitude, x)
    return np.asarray(np.polynomial.polynomial.polyval(x, amplitude))


def _numbers(name: str, values: Any) -> tuple[float, ...]:
    return tuple(number(f"{name}[{index}]", value) for index, value in enumerate(_row(name, "numbers", values)))


def _row(name: str, kind: str, values: Any) -> tuple[Any, ...]:
    try:
        row = tuple(values)
    except TypeError:
        raise ValueError(f"{name} must be a row of {kind}, got {shown(values)}") from None
    if len(row) > MAXIMUM_VALUES:
        raise ValueError(f"{name} must have at most {MAXIMUM_VALUES} {kind}, got {len(row)}")
    return row
