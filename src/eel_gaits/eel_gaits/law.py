# SPDX-License-Identifier: Apache-2.0
"""Curvature laws: the commanded curvature of the body, with exact first and second time derivatives.

A law is a sum of terms. Each term is a wave in pitch (K2) or yaw (K3) of the backbone:

    K(t, X) = sum over terms of  envelope(t) amplitude(X) sin(2 pi (X / wavelength - t / period) + phase)

A quotient is dropped where its divisor is 0. An envelope is a sum of ramps. Equations (62) to (66) of Boyer, Porez and
Leroyer, J. Nonlinear Sci. 20 (2010), 47-79, doi:10.1007/s00332-009-9050-5, are such a sum.

Section axes (the paper's): 1 along the backbone from head to tail, 2 lateral, 3 up. K2 > 0 bends the tail down,
K3 > 0 bends it towards +2. X runs from 0 at the nose to the body's length at the tail.
"""

import math
from dataclasses import dataclass

import numpy as np

from eel_gaits.quantity import number, numbers
from eel_gaits.spline import natural_spline
from eel_gaits.wording import shown

AXES = {"pitch": 1, "yaw": 2}  # name of the axis: its column in a curvature array
MAXIMUM_TERMS = 1000
MAXIMUM_VALUES = 1000  # coefficients or knots of a term, ramps of an envelope
MAXIMUM_NAME = 200  # characters


@dataclass(frozen=True)
class Ramp:
    """`delta` times the C2 ramp f_r(t; start, end) of eq. (64), which is 0 before `start` and 1 after `end`, in s.

    `ValueError` where `end` does not lie after `start`, or where a rate would not be finite.
    """

    start: float
    end: float
    delta: float

    def __post_init__(self):
        for field in ("start", "end", "delta"):
            object.__setattr__(self, field, number(field, getattr(self, field)))
        if not self.end > self.start:
            raise ValueError(f"end must be > start ({self.start} s), got {self.end}")
        duration = self.end - self.start
        if not math.isfinite(duration) or not math.isfinite(10.0 * self.delta / duration / duration):
            raise ValueError(f"end must lie so after start ({self.start} s) that rates are finite, got {self.end}")

    def value(self, t):
        """The ramp and its first and second time derivatives at `t` [s]: three arrays of the shape of `t`."""
        duration = self.end - self.start
        s = np.clip((np.asarray(t, dtype=float) - self.start) / duration, 0.0, 1.0)
        moving = (s > 0.0) & (s < 1.0)  # the derivatives are exactly zero outside
        angle = 2.0 * math.pi * s
        value = self.delta * (s - np.sin(angle) / (2.0 * math.pi))
        rate = np.where(moving, self.delta * (1.0 - np.cos(angle)) / duration, 0.0)
        acceleration = np.where(moving, self.delta * 2.0 * math.pi * np.sin(angle) / duration / duration, 0.0)
        return value, rate, acceleration


@dataclass(frozen=True, kw_only=True)
class Term:
    """One wave or bend: envelope(t) amplitude(X) sin(2 pi (X / wavelength - t / period) + phase).

    `ValueError` names an attribute that does not fit.

    Attributes:
        axis: "yaw" (K3) or "pitch" (K2).
        amplitude: at most 1000 values. Without knots, these are the coefficients of a polynomial in X [rad/m, rad/m^2,
            ...]. With knots, they are the values [rad/m] at the knots of a natural cubic spline. Beyond the end knots
            the spline continues as a straight line.
        knots: [m], strictly increasing; none, or as many as amplitudes and at least 2.
        wavelength: [m]; 0 for a standing term; negative for a wave that runs towards the head.
        period: [s]; 0 for a term that is constant in time except for its envelope.
        phase: [rad]; pi/2 for a constant bend.
        envelope: ramps, whose sum starts from 0; without ramps the envelope is 1 at all times.
    """

    axis: str = "yaw"
    amplitude: tuple[float, ...]
    knots: tuple[float, ...] = ()
    wavelength: float = 0.0
    period: float = 0.0
    phase: float = 0.0
    envelope: tuple[Ramp, ...] = ()

    def __post_init__(self):
        if not isinstance(self.axis, str) or self.axis not in AXES:
            raise ValueError(f"axis must be one of {', '.join(AXES)}, got {shown(self.axis)}")
        for field in ("amplitude", "knots"):
            object.__setattr__(self, field, _numbers(field, getattr(self, field)))
        for field in ("wavelength", "period", "phase"):
            object.__setattr__(self, field, number(field, getattr(self, field)))
        object.__setattr__(self, "envelope", _row("envelope", "Ramps", self.envelope))
        self._check_amplitude()
        self._check_wave()

    def _check_amplitude(self):
        if not self.knots:
            if not self.amplitude:
                raise ValueError("amplitude must have at least 1 coefficient, got none")
            return
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

    def _check_wave(self):
        if self.period < 0.0:
            raise ValueError(f"period must be >= 0 s, got {self.period}")
        if self.period and self.period < 1e-100:
            raise ValueError(f"period must be 0 or long enough for finite rates, got {self.period}")
        if self.wavelength and abs(self.wavelength) < 1e-100:
            raise ValueError(f"wavelength must be 0 or long enough for a finite wave number, got {self.wavelength}")
        for ramp in self.envelope:
            if not isinstance(ramp, Ramp):
                raise ValueError(f"envelope must hold Ramps, got {shown(ramp)}")

    @property
    def wave_number(self):
        """2 pi / wavelength [rad/m]; 0 for a standing term."""
        return 2.0 * math.pi / self.wavelength if self.wavelength else 0.0

    @property
    def angular_frequency(self):
        """2 pi / period [rad/s]; 0 for a term that is constant in time except for its envelope."""
        return 2.0 * math.pi / self.period if self.period else 0.0

    def amplitude_at(self, x):
        """The amplitude [rad/m], shape (len(x),), at the stations x [m], shape (len(x),)."""
        return amplitude_of(self.amplitude, self.knots, np.asarray(x, dtype=float))

    def envelope_at(self, t):
        """The envelope [1] and its first and second time derivatives at `t` [s]: three arrays of the shape of `t`."""
        if not self.envelope:
            zero = np.zeros_like(np.asarray(t, dtype=float))
            return zero + 1.0, zero, zero
        return tuple(np.sum([ramp.value(t) for ramp in self.envelope], axis=0))

    def curvature(self, time, x):
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


@dataclass(frozen=True, init=False)
class Law:
    """A curvature law: the sum of its terms. A law without terms is the straight body.

    Law(one, two) and Law([one, two]) are the same law of two terms. `ValueError` names an attribute that does not fit.

    Attributes:
        terms: at most 1000.
        name: the law's name in messages and plots, at most 200 characters.
        transition: [s], duration of the blend from a swimmer's present motion to the law; 0 for the receiver's default.
    """

    terms: tuple[Term, ...]
    name: str
    transition: float

    def __init__(self, *terms, name="law", transition=0.0):
        if len(terms) == 1 and isinstance(terms[0], (list, tuple)):
            (terms,) = terms
        if len(terms) > MAXIMUM_TERMS:
            raise ValueError(f"terms must be at most {MAXIMUM_TERMS}, got {len(terms)}")
        for index, term in enumerate(terms):
            if not isinstance(term, Term):
                raise ValueError(f"terms[{index}] must be a Term, got {shown(term)}")
        transition = number("transition", transition)
        if transition < 0.0:
            raise ValueError(f"transition must be >= 0 s, got {transition}")
        object.__setattr__(self, "terms", tuple(terms))
        object.__setattr__(self, "name", _name(name))
        object.__setattr__(self, "transition", transition)

    def __hash__(self):  # kept: tables are looked up by it
        found = self.__dict__.get("_hash")
        if found is None:
            found = hash((self.terms, self.name, self.transition))
            object.__setattr__(self, "_hash", found)
        return found

    def __getstate__(self):
        return {name: value for name, value in self.__dict__.items() if name != "_hash"}  # of this process's strings

    def __repr__(self):
        count = f"{len(self.terms)} term{'' if len(self.terms) == 1 else 's'}"
        return f"Law({shown(self.name)}, {count}{f', transition={self.transition:g} s' if self.transition else ''})"

    @property
    def in_plane(self) -> bool:
        """Whether the body bends only in yaw."""
        return all(term.axis == "yaw" for term in self.terms)

    def curvature(self, time, x):
        """Curvature, its rate and its acceleration at one time. `ValueError` names an argument that is not finite.

        Args:
            time: [s], the law's own time.
            x: [m], shape (M,), arc length from the nose.

        Returns:
            value [rad/m], rate [rad/m/s], acceleration [rad/m/s^2], each of shape (M, 3), in section axes. Column 0 is
            zero, column 1 is pitch (K2), column 2 is yaw (K3).
        """
        x = np.atleast_1d(numbers("x", x))
        if not np.all(np.isfinite(x)):
            raise ValueError(f"x must be finite, got {shown(x)}")
        time = number("time", time)
        total = np.zeros((3, x.size, 3))
        for term in self.terms:
            total[:, :, AXES[term.axis]] += term.curvature(time, x)
        return total[0], total[1], total[2]


def amplitude_of(amplitude, knots, x):
    """The amplitude [rad/m], shape (len(x),), at the stations x [m], of a term with this `amplitude` and `knots`."""
    if knots:
        return natural_spline(knots, amplitude, x)
    return np.polynomial.polynomial.polyval(x, amplitude)


def _numbers(name, values):
    return tuple(number(f"{name}[{index}]", value) for index, value in enumerate(_row(name, "numbers", values)))


def _row(name, kind, values):
    try:
        values = tuple(values)
    except TypeError:
        raise ValueError(f"{name} must be a row of {kind}, got {shown(values)}") from None
    if len(values) > MAXIMUM_VALUES:
        raise ValueError(f"{name} must have at most {MAXIMUM_VALUES} {kind}, got {len(values)}")
    return values


def _name(value):
    if not isinstance(value, str):
        raise ValueError(f"name must be a text, got {shown(value)}")
    if len(value) > MAXIMUM_NAME:
        raise ValueError(f"name must have at most {MAXIMUM_NAME} characters, got {len(value)}")
    return str(value)
